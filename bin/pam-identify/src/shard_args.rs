//! Options of recordings whose rows are in several places.

use std::path::PathBuf;

/// Over these options in `--help`.
const HEADING: &str = "Shards of recordings";

/// Options of shards; flattened into the program's.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct ShardArgs {
    /// Write to --out what the rows of LOG say to the question of --agreement (pam-summary/1), and fit nothing.
    #[arg(
        long,
        help_heading = HEADING,
        requires = "out",
        conflicts_with_all = ["holdout", "figure", "compare_forms", "unbounded", "max_rmse_n", "from_summaries"]
    )]
    pub(crate) summary_only: bool,

    /// Which part of which recording LOG is: name of the recording, number of the part, and how many there are, as in run:2/3;
    /// without it, LOG is a whole recording.
    #[arg(long, help_heading = HEADING, value_name = "NAME:K/N", value_parser = place, requires = "summary_only")]
    pub(crate) shard: Option<ShardPlace>,

    /// What shards have agreed on, and what they are asked next (pam-agreement/1): written by --from-summaries, read by
    /// --summary-only. It is not there before the first pass.
    #[arg(long, help_heading = HEADING, value_name = "AGREED.json")]
    pub(crate) agreement: Option<PathBuf>,

    /// Merge summaries of all shards: write the next question to --agreement, or, once nothing is open, the model to --out.
    #[arg(
        long,
        help_heading = HEADING,
        value_name = "S.json",
        num_args = 1..,
        requires = "agreement",
        conflicts_with_all = ["logs", "holdout", "figure", "compare_forms", "unbounded"]
    )]
    pub(crate) from_summaries: Vec<PathBuf>,
}

/// A part of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ShardPlace {
    pub(crate) recording: String,
    pub(crate) number: usize,
    pub(crate) of: usize,
}

fn place(text: &str) -> Result<ShardPlace, String> {
    let expected = || "expected a name, a number and how many there are, as in run:2/3".to_owned();
    let (recording, part) = text.rsplit_once(':').ok_or_else(expected)?;
    let (number, of) = part.split_once('/').ok_or_else(expected)?;
    let (number, of): (usize, usize) = number.parse().ok().zip(of.parse().ok()).ok_or_else(expected)?;
    if recording.is_empty() || number == 0 || number > of {
        return Err(expected());
    }
    Ok(ShardPlace { recording: recording.to_owned(), number, of })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_has_a_name_a_number_and_a_count() {
        let expected = ShardPlace { recording: "day:1".to_owned(), number: 2, of: 3 };
        assert_eq!(place("day:1:2/3"), Ok(expected));
        for text in ["", "run", "run:2", "run:0/3", "run:4/3", ":1/2", "run:a/b", "run:1/2/3"] {
            assert!(place(text).is_err(), "{text}");
        }
    }
}
