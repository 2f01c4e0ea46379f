//! Files as loggers write them: LabVIEW's text, dates, a row of units, labels in German; and what is refused by name.

use insta::assert_snapshot;
use pam_recording::{Channels, Quantity, ReadOptions};

use super::{options, read, recording, refusal, rows};

/// As "Write To Measurement File" writes with a German Windows.
const LVM: &str = "LabVIEW Measurement\t\r\nWriter_Version\t2\r\nReader_Version\t2\r\nSeparator\tTab\r\n\
    Decimal_Separator\t,\r\nMulti_Headings\tYes\r\nX_Columns\tOne\r\nTime_Pref\tRelative\r\nOperator\tLab\r\n\
    Date\t2026/11/23\r\nTime\t10:15:02,1250000\r\n***End_of_Header***\t\r\n\t\r\n\
    Channels\t3\t\t\t\r\nSamples\t2\t2\t2\t\r\nDate\t2026/11/23\t2026/11/23\t2026/11/23\t\r\n\
    Time\t10:15:02,125\t10:15:02,125\t10:15:02,125\t\r\nY_Unit_Label\tbar\tmm\tN\t\r\nX_Dimension\tTime\tTime\tTime\t\r\n\
    X0\t0,0E+0\t0,0E+0\t0,0E+0\t\r\nDelta_X\t0,500000\t0,500000\t0,500000\t\r\n***End_of_Header***\t\t\t\t\r\n\
    X_Value\tDruck\tL\u{e4}nge\tKraft\tComment\r\n\
    0,000000\t1,000000\t200,000000\t10,000000\r\n0,500000\t2,005000\t199,500000\t-12,500000\r\n";

const ROWS: [[f64; 4]; 2] = [[0.0, 100e3, 0.2, 10.0], [0.5, 200.5e3, 0.1995, -12.5]];

fn assert_rows(what: &str, text: impl AsRef<[u8]>, options: &ReadOptions) {
    let found = rows(&read(text, options).unwrap_or_else(|error| panic!("{what}: {error}")));
    assert_eq!(found.len(), 2, "{what}");
    for (found, expected) in found.iter().flatten().zip(ROWS.iter().flatten()) {
        assert!((found - expected).abs() <= 1e-7 * expected.abs().max(1.0), "{what}: {found} for {expected}");
    }
}

#[test]
fn a_text_file_of_labview_is_read_as_it_is() {
    let plain = ReadOptions::default();
    assert_rows("UTF-8", LVM, &plain);
    // Latin-1, as Windows writes it.
    let latin: Vec<u8> = LVM.chars().map(|character| character as u8).collect();
    assert_rows("Latin-1", latin, &plain);
    let commas = LVM.replace("Separator\tTab", "Separator\tComma").replace(',', ".").replace('\t', ",");
    assert_rows("commas", commas, &plain);
    // A channel that is called otherwise has to be named.
    let volts = LVM.replace("Druck", "ai0").replace("\tbar\t", "\tVolts\t");
    assert_rows("volts", volts, &options(["--calibrate pressure_bar = 1 * ai0"]));
}

#[test]
fn a_row_that_is_wrong_in_a_file_of_labview_has_its_line() {
    let text = LVM.replace("2,005000", "x");
    assert_snapshot!(refusal(text, &ReadOptions::default()), @r#"log.csv:25:2: "x" in column "Druck [bar]" is not a number; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(refusal(&LVM[..200], &ReadOptions::default()), @"log.csv: the header of the LabVIEW file does not end (***End_of_Header*** twice); copy the file anew");
    assert_snapshot!(refusal(LVM.replace("X_Columns\tOne", "X_Columns\tNo"), &ReadOptions::default()), @r#"log.csv: the LabVIEW file has no single column of time (X_Columns No); choose one column for X values in Write To Measurement File, or write it as CSV: python3 -c 'import lvm_read, pandas, sys; s = lvm_read.read(sys.argv[1])[0]; d = pandas.DataFrame(s["data"], columns=s["Channel names"][:s["Channels"]]); d.insert(0, "time_s", d.index * s["Delta_X"][0]); d.to_csv(sys.argv[2], index=False)' log.lvm log.csv"#);
}

#[test]
fn dates_are_times_since_the_first_of_them() {
    let plain = ReadOptions::default();
    let log = |name: &str, first: &str, second: &str| {
        format!("{name};pressure_kPa;length_mm;force_N\n{first};100;200;10\n{second};200,5;199,5;-12,5\n")
    };
    for (name, first, second) in [
        ("time", "2026-11-23T10:15:02.125", "2026-11-23T10:15:02.625"),
        ("Zeit", "23.11.2026 23:59:59,750", "24.11.2026 00:00:00,250"),
        ("Timestamp", "2026-11-23 10:15:02+01:00", "2026-11-23 10:15:02.5+01:00"),
        ("Zeitstempel", "10:15:02,000", "10:15:02,500"),
        ("time_iso", "2026-11-23T10:15:02Z", "2026-11-23T10:15:02.5Z"),
    ] {
        assert_rows(name, log(name, first, second), &plain);
    }
    let named = log("Datum", "2026-11-23 10:15:02", "2026-11-23 10:15:02.5");
    assert_rows("mapped", named, &options(["--map time_iso=Datum"]));
    // Beside a clock of its own a stamp is one more column.
    let both = recording("time_s,timestamp,pressure_kPa,length_mm,force_N\n0,2026-11-23T10:15:02,1,2,3\n1,x,1,2,4\n");
    assert_eq!(both.ignored_columns, ["timestamp"]);
    let wrong = log("time", "2026-11-23T10:15:02", "soon");
    assert_snapshot!(refusal(wrong, &plain), @r#"log.csv:3:1: "soon" in column "time [iso]" is no time stamp as 2026-11-23T10:15:02.125; correct the row, or drop such rows with --skip-bad-rows"#);
    let american = log("time", "11/23/2026 10:15:02", "11/23/2026 10:15:03");
    assert_snapshot!(refusal(american, &plain), @r#"log.csv:1:1: column "time" has no unit; add it to the name (s, ms, us or iso) or give it on the command line, for example --map time_s=time"#);
}

#[test]
fn a_row_of_units_belongs_to_the_header() {
    let plain = ReadOptions::default();
    for (what, text) in [
        ("plain", "time,pressure,length,force,valve\ns,kPa,mm,N,V\n0,100,200,10,1\n0.5,200.5,199.5,-12.5,1\n"),
        ("brackets", "Zeit;Druck;Länge;Kraft\n[ms];[bar];[mm];[N]\n0;1;200;10\n500;2,005;199,5;-12,5\n"),
        ("blank", "time,pressure,length,force,n\n\n(s),(kPa),(mm),(N),\n0,100,200,10,1\n0.5,200.5,199.5,-12.5,1\n"),
        ("dates", "Time,pressure,length,force\n-,kPa,mm,N\n10:15:02,100,200,10\n10:15:02.5,200.5,199.5,-12.5\n"),
    ] {
        assert_rows(what, text, &plain);
    }
    let recording = recording("time,P,pressure,length,force\ns,V,kPa,mm,N\n0,1,100,200,10\n1,1,100,200,11\n");
    assert_eq!((recording.samples.n_rows(), recording.ignored_columns.as_slice()), (2, ["P".to_owned()].as_slice()));
    let wrong = "time,pressure,length,force\ns,atm,mm,N\n0,1,200,10\n1,1,200,11\n";
    assert_snapshot!(refusal(wrong, &plain), @r#"log.csv:1:2: unknown unit "atm" of column "pressure [atm]"; pressure can be in kPa, Pa, MPa, bar or psi, for example pressure_kPa (for other units see --calibrate)"#);
}

#[test]
fn a_travel_is_no_length() {
    let text = "Zeit [ms];Druck [bar];Weg [mm];Kraft [N]\n0;1;11;10\n500;2,005;11,5;-12,5\n";
    assert_snapshot!(refusal(text, &ReadOptions::default()), @r#"log.csv: no column gives length; name a column length_mm in the header or, as it seems to fit, give --map length_mm="Weg [mm]" (the file has Zeit [ms], Druck [bar], Weg [mm], Kraft [N])"#);
    assert_rows("calibrated", text, &options(["--calibrate length_mm = 211 - Weg [mm]"]));
}

/// The options with what a file of channels says.
fn channels(text: &str) -> ReadOptions {
    let mut options = ReadOptions::default();
    Channels::parse(text, "bench.toml".as_ref()).unwrap().complete(&mut options);
    options
}

const BENCH: &str = "columns = [\"t\", \"-\", \"ai0\", \"ai1\"]\n[time]\ncolumn = \"t\"\nunit = \"ms\"\n[pressure]\ncolumn = \"ai0\"\n\
    unit = \"bar\"\ngain = 2.0\noffset = -1.0\nrange = [0, 6]\n[length]\nvalue = 200.0\nunit = \"mm\"\n[force]\ncolumn = \"ai1\"\n\
    unit = \"kN\"\nrange = [-1, 1]\n";

#[test]
fn a_file_of_channels_says_what_columns_mean() {
    for text in ["0,9,1,0.01\n500,9,1.5025,-0.0125\n", "ai1,t,ai0,x\n0.01,0,1,7\n-0.0125,500,1.5025,7\n"] {
        let recording = read(text, &channels(BENCH)).unwrap();
        let found = rows(&recording);
        assert_eq!((found[0][1], found[0][2], found[1][0]), (100e3, 0.2, 0.5));
        assert!((found[1][1] - 200.5e3).abs() < 1e-6 && (found[1][3] + 12.5).abs() < 1e-12);
        assert_eq!(recording.samples.sensor_range(Quantity::Force), Some([-1e3, 1e3]));
    }
    let lacking = "t,ai0,force_N\n0,1,2\n1,1,3\n";
    assert_snapshot!(refusal(lacking, &channels(BENCH)), @r#"log.csv: bench.toml [force] names column "ai1", which the file lacks; did you mean "ai0"?"#);
    let twice = "t,ai0,ai1,length_mm\n0,1,2,200\n1,1,3,200\n";
    assert_snapshot!(refusal(twice, &channels(BENCH)), @r#"log.csv: bench.toml [length] contradicts column "length_mm", which gives length too; leave it away"#);
}

#[test]
fn formats_that_are_not_read_are_refused_with_a_line_that_converts_them() {
    let plain = ReadOptions::default();
    assert_snapshot!(refusal(b"TDSm\x0e\0\0\0\x69\x12\0\0", &plain), @r#"log.csv: this is a TDMS file of LabVIEW, which is not read; write it as CSV: python3 -c 'import nptdms, sys; f = nptdms.TdmsFile.read(sys.argv[1]); w = all("wf_increment" in c.properties for g in f.groups() for c in g.channels()); d = f.as_dataframe(time_index=w); d.columns = [c.split(chr(39))[-2] for c in d.columns]; d.rename_axis("time_s" if w else None).to_csv(sys.argv[2], index=w)' log.tdms log.csv"#);
    assert_snapshot!(refusal(b"\x89HDF\r\n\x1a\n", &plain), @r#"log.csv: this is an HDF5 file, which is not read; write it as CSV: python3 -c 'import h5py, pandas, sys; d = {}; h5py.File(sys.argv[1]).visititems(lambda n, o: d.update({n: pandas.Series(o[()].ravel())}) if isinstance(o, h5py.Dataset) and o.dtype.kind in "fiu" and o.size == max(o.shape or [0]) else None); pandas.DataFrame(d).to_csv(sys.argv[2], index=False)' log.h5 log.csv"#);
}
