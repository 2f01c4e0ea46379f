//! Options that every program reading recordings takes.

use std::path::PathBuf;

use pam_artifact::{Input, InputRole};
use pam_recording::{Calibration, Channels, ChannelsError, ColumnMap, Columns, FixedChannel, ReadOptions};

const HEADING: &str = "Reading recordings";

/// How to read recordings; flatten it into the program's own arguments.
#[derive(Debug, Clone, clap::Args)]
pub struct ReadArgs {
    /// Columns, units, calibration and sensors of this bench, once for all programs (pam-channels/1); the options below win
    /// over it.
    #[arg(long, help_heading = HEADING, value_name = "BENCH.toml")]
    pub channels: Option<PathBuf>,
    /// Names of the columns of a file without a header, - to skip one: force_N,pressure_kPa,time_s,-
    #[arg(long, help_heading = HEADING, value_name = "NAMES", allow_hyphen_values = true)]
    pub columns: Option<Columns>,
    /// Other names for columns.
    #[arg(long, help_heading = HEADING, help = "Another name for a column: pressure_bar=\"P [V]\"", value_name = "NAME=COLUMN")]
    pub map: Vec<ColumnMap>,
    /// A channel that was constant and not recorded: length_mm=126.75
    #[arg(long, help_heading = HEADING, value_name = "NAME=VALUE")]
    pub fixed: Vec<FixedChannel>,
    /// A channel from a transducer's reading: 'pressure_kPa = 125 * ai0 - 12.5'
    #[arg(long, help_heading = HEADING, value_name = "NAME=LINE")]
    pub calibrate: Vec<Calibration>,
    /// Drop and count rows that cannot be used, instead of refusing the file.
    #[arg(long, help_heading = HEADING)]
    pub skip_bad_rows: bool,
}

/// How to read recordings, and what says so.
#[derive(Debug, Clone, Default)]
pub struct ReadAs {
    /// What to read with; what neither option nor file speaks of is as by default.
    pub options: ReadOptions,
    /// The file that says what columns mean, where there is one.
    pub channels: Option<Input>,
}

impl ReadArgs {
    /// The options with what the file of `--channels` adds to them.
    ///
    /// # Errors
    /// [`ChannelsError`] where that file cannot be used.
    pub fn resolve(&self) -> Result<ReadAs, ChannelsError> {
        let mut options = ReadOptions {
            columns: self.columns.clone(),
            map: self.map.clone(),
            fixed: self.fixed.clone(),
            calibrate: self.calibrate.clone(),
            skip_bad_rows: self.skip_bad_rows,
            ..ReadOptions::default()
        };
        let Some(path) = &self.channels else { return Ok(ReadAs { options, channels: None }) };
        let file = Channels::read(path)?;
        file.complete(&mut options);
        let input = Input { path: path.display().to_string(), sha256: file.sha256, role: InputRole::Configuration };
        Ok(ReadAs { options, channels: Some(input) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Args {
        #[command(flatten)]
        read: ReadArgs,
        logs: Vec<String>,
    }

    #[test]
    fn options_may_repeat_and_stand_before_the_logs() {
        let args = [
            "pam-x",
            "--columns",
            "-,force_N,time_s",
            "--map",
            "pressure_bar=\"P [V]\"",
            "--fixed",
            "length_mm=126.75",
            "--fixed",
            "temperature_C=21",
            "--calibrate",
            "pressure_kPa = 125 * ai0 - 12.5",
            "--skip-bad-rows",
            "a.csv",
            "b.csv",
        ];
        let args = Args::try_parse_from(args).unwrap();
        assert_eq!(args.logs, ["a.csv", "b.csv"]);
        let options = args.read.resolve().unwrap().options;
        assert_eq!(options.columns.unwrap().names.len(), 3);
        assert_eq!((options.map.len(), options.fixed.len(), options.calibrate.len()), (1, 2, 1));
        assert!(options.skip_bad_rows && options.force_required);
    }

    #[test]
    fn an_option_that_cannot_be_understood_is_refused_with_an_example() {
        let message = Args::try_parse_from(["pam-x", "--fixed", "length=126.75"]).unwrap_err().to_string();
        assert!(message.contains("length_mm"), "{message}");
    }
}
