//! Options about columns: what they do, and what their messages say.

use insta::assert_snapshot;
use pam_recording::{Calibration, ColumnMap, Columns, FixedChannel};

use super::{options, read, refusal, rows};

const VOLTS: &str = "t [s],P [V],Length,ai1\n0,1.0,200,0.1\n0.5,2.0,199,0.2\n";

#[test]
fn columns_of_a_file_without_a_header_are_named() {
    let options = options(["--columns force_N, pressure_kPa,time_s,-", "--fixed length_mm=126.75"]);
    let recording = read("1,100,0,7\n2,101,0.5,x\n", &options).unwrap();
    assert_eq!(rows(&recording), [[0.0, 100e3, 0.12675, 1.0], [0.5, 101e3, 0.12675, 2.0]]);
    assert!(recording.ignored_columns.is_empty());
}

#[test]
fn columns_are_renamed_and_calibrated() {
    let options = options([
        "--map time_s=t [s]",
        "--map length_mm=length",
        "--calibrate pressure_kPa = 125 * P [V] - 12.5",
        "--calibrate force_N = ai1 / 0.002 - 1",
    ]);
    let recording = read(VOLTS, &options).unwrap();
    assert_eq!(rows(&recording), [[0.0, 112.5e3, 0.2, 49.0], [0.5, 237.5e3, 0.199, 99.0]]);
}

#[test]
fn an_option_wins_over_a_name() {
    let text = "time_s,pressure_kPa,pressure_bar,length_mm,force_N,force_N\n0,1,2,3,4,4\n1,1,2,3,5,5\n";
    let recording = read(
        text.replace("force_N\n", "force_kN\n"),
        &options(["--map pressure_bar=pressure_bar", "--map force_N=force_N"]),
    );
    let recording = recording.unwrap();
    assert_eq!(rows(&recording)[0], [0.0, 2e5, 0.003, 4.0]);
    assert_eq!(recording.ignored_columns, ["pressure_kPa", "force_kN"]);
}

#[test]
fn a_channel_may_be_recalibrated_from_itself() {
    let text = "time_s,pressure_kPa,length_mm,force_N\n0,100,200,1\n1,100,200,2\n";
    let recording = read(text, &options(["--calibrate force_N = 2 * force_N - 0.5"])).unwrap();
    assert_eq!(rows(&recording)[1][3], 3.5);
}

#[test]
fn a_dead_weight_may_be_given() {
    let text = "time_s,pressure_kPa,length_mm\n0,100,200\n1,110,199\n";
    let recording = read(text, &options(["--fixed force_kgf=10"])).unwrap();
    assert!((rows(&recording)[1][3] - 98.0665).abs() < 1e-12);
}

fn columns(text: &str) -> String {
    text.parse::<Columns>().unwrap_err().to_string()
}

fn map(text: &str) -> String {
    text.parse::<ColumnMap>().unwrap_err().to_string()
}

fn fixed(text: &str) -> String {
    text.parse::<FixedChannel>().unwrap_err().to_string()
}

fn calibrate(text: &str) -> String {
    text.parse::<Calibration>().unwrap_err().to_string()
}

#[test]
fn options_that_cannot_be_understood_say_what_was_expected() {
    assert_snapshot!(columns("force_N,,time_s"), @"column 2 has no name; write - to skip a column, as in force_N,pressure_kPa,time_s,-");
    assert_snapshot!(columns("force_N,time_s,Force_N"), @r#""Force_N" is given twice; name each column once, as in force_N,pressure_kPa,time_s,-"#);
    assert_snapshot!(map("pressure_bar"), @r#""pressure_bar" is not of the form NAME=…; expected for example pressure_bar="P [V]""#);
    assert_snapshot!(map("pressure_bar="), @r#""pressure_bar=" is not of the form NAME=…; expected for example pressure_bar="P [V]""#);
    assert_snapshot!(map("P [V]=pressure_bar"), @r#""P [V]" is not a quantity with its unit; expected for example pressure_bar (time, pressure, length, force or temperature)"#);
    assert_snapshot!(map("presure_bar=P [V]"), @r#""presure_bar" is not a quantity with its unit; expected for example pressure_bar (time, pressure, length, force or temperature)"#);
    assert_snapshot!(map("pressure_atm=P [V]"), @r#""pressure_atm" has no unit that is known; write pressure_UNIT with kPa, Pa, MPa, bar or psi, for example pressure_kPa"#);
    assert_snapshot!(map("pressure=P [V]"), @r#""pressure" has no unit that is known; write pressure_UNIT with kPa, Pa, MPa, bar or psi, for example pressure_kPa"#);
    assert_snapshot!(fixed("length_mm"), @r#""length_mm" is not of the form NAME=…; expected for example length_mm=126.75"#);
    assert_snapshot!(fixed("length_mm=long"), @r#""long" is not a finite number; expected for example length_mm=126.75"#);
    assert_snapshot!(fixed("length_mm=126,75"), @r#""126,75" is not a finite number; expected for example length_mm=126.75"#);
    assert_snapshot!(fixed("length_mm=inf"), @r#""inf" is not a finite number; expected for example length_mm=126.75"#);
    assert_snapshot!(fixed("length=126.75"), @r#""length" has no unit that is known; write length_UNIT with mm, m, cm or in, for example length_mm"#);
    assert_snapshot!(fixed("time_s=1"), @"time cannot be fixed; fix for example length_mm=126.75");
    assert_snapshot!(calibrate("125 * ai0 - 12.5"), @r#""125 * ai0 - 12.5" is not of the form NAME=…; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("ai0 = pressure_kPa"), @r#""ai0" is not a quantity with its unit; expected for example pressure_kPa (time, pressure, length, force or temperature)"#);
    assert_snapshot!(calibrate("pressure_kPa = 125 *"), @r#"a number or a column is missing in "125 *"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = 125 ai0"), @r#"an operator is missing in "125 ai0"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = 125,5 * ai0"), @r#""125,5" is not a number in "125,5 * ai0"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = 125"), @r#"no column is named in "125"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = ai0 + ai1"), @r#"two columns are named, "ai0" and "ai1", in "ai0 + ai1"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = ai0 * ai0"), @r#"the column multiplies itself or stands below a fraction bar in "ai0 * ai0"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = 1 / ai0"), @r#"the column multiplies itself or stands below a fraction bar in "1 / ai0"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = 2 * (ai0 - 1)"), @r#"'(' cannot be used in "2 * (ai0 - 1)"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = 0 * ai0"), @r#"the column has no weight in "0 * ai0"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = ai0 / 0"), @r#"a number is not finite in "ai0 / 0"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
    assert_snapshot!(calibrate("pressure_kPa = 2 * \"ai0"), @r#"a quote is not closed in "2 * "ai0"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'"#);
}

#[test]
fn options_that_do_not_fit_the_file_are_refused() {
    let log = "time_s,pressure_kPa,length_mm,force_N\n0,100,200,1\n1,100,200,2\n";
    assert_snapshot!(refusal(log, &options(["--map force_N=forse_N"])), @r#"log.csv: --map names column "forse_N", which the file lacks; did you mean "force_N"?"#);
    assert_snapshot!(refusal(log, &options(["--map force_N=U12"])), @r#"log.csv: --map names column "U12", which the file lacks; it has time_s, pressure_kPa, length_mm, force_N"#);
    assert_snapshot!(refusal(log, &options(["--calibrate force_N = 2 * ai0"])), @r#"log.csv: --calibrate names column "ai0", which the file lacks; it has time_s, pressure_kPa, length_mm, force_N"#);
    assert_snapshot!(refusal("a,a\n1,2\n", &options(["--map force_N=a"])), @r#"log.csv: --map names column "a", which the file has more than once; rename one of them in the header"#);
    assert_snapshot!(refusal(log, &options(["--fixed length_mm=126.75"])), @r#"log.csv: --fixed length_mm contradicts column "length_mm", which gives length too; leave it away"#);
    assert_snapshot!(refusal(log, &options(["--map length_mm=length_mm", "--fixed length_mm=126.75"])), @"log.csv: --map length_mm and --fixed length_mm both supply length; leave one away");
    assert_snapshot!(refusal(log, &options(["--map force_N=force_N", "--calibrate force_N = length_mm"])), @"log.csv: --map force_N and --calibrate force_N both supply force; leave one away");
    assert_snapshot!(refusal("1,2\n", &options(["--fixed length_mm=1", "--fixed length_m=1", "--columns time_s,force_N"])), @"log.csv: --fixed length_mm and --fixed length_m both supply length; leave one away");
    assert_snapshot!(refusal("1,2,3\n", &options(["--columns time_s,pressure_kPa,length_mm,force_N"])), @"log.csv: --columns names 4 columns but the file has 3 columns; name each of them in its order, - skips one");
    assert_snapshot!(refusal("1,2,3,4\n", &options(["--columns time_s,presure_kPa,length_mm,force_N"])), @r#"log.csv: unknown column "presure_kPa"; did you mean pressure_kPa?"#);
    assert_snapshot!(refusal(log, &options(["--columns time_s,pressure_kPa,length_mm,force_N"])), @"log.csv:1:1: the file has a header of its own; leave --columns away and rename its columns with --map");
}
