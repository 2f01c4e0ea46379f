//! Options that every program reading recordings takes.

use pam_core::recording::{Calibration, ColumnMap, Columns, FixedChannel, ReadOptions};

const HEADING: &str = "Reading recordings";

/// How to read recordings; flatten it into the program's own arguments.
#[derive(Debug, Clone, clap::Args)]
pub struct ReadArgs {
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

impl ReadArgs {
    /// What to read with; what no option speaks of is as by default.
    pub fn options(&self) -> ReadOptions {
        ReadOptions {
            columns: self.columns.clone(),
            map: self.map.clone(),
            fixed: self.fixed.clone(),
            calibrate: self.calibrate.clone(),
            skip_bad_rows: self.skip_bad_rows,
            ..ReadOptions::default()
        }
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
        let options = args.read.options();
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
