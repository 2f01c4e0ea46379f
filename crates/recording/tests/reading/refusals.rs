//! Every message with which a file is refused.

use std::path::Path;

use insta::assert_snapshot;
use pam_recording::{ReadError, ReadErrorKind, ReadOptions, read_recording};

use super::{log_with_stamps, options, refusal};

const HEADER: &str = "time_s,pressure_kPa,length_mm,force_N\n";

fn plain(text: impl AsRef<[u8]>) -> String {
    refusal(text, &ReadOptions::default())
}

/// The message for rows below the usual header.
fn below_header(text: &str) -> String {
    plain(format!("{HEADER}{text}"))
}

#[test]
fn files_that_cannot_be_opened() {
    let message = |path: &Path| read_recording(path, &ReadOptions::default()).unwrap_err().to_string();
    assert_snapshot!(message(Path::new("no/such.csv")), @"no/such.csv: no such file; check the path");
    assert_snapshot!(message(Path::new("src")), @"src: is a directory; name the recordings in it");
}

#[cfg(unix)]
#[test]
fn a_file_without_permission() {
    use std::os::unix::fs::PermissionsExt;
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    std::fs::write(&path, HEADER).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o000)).unwrap();
    // An administrator may read anything.
    if std::fs::read(&path).is_err() {
        let message = read_recording(&path, &ReadOptions::default()).unwrap_err().to_string();
        assert!(message.ends_with("log.csv: permission denied; make the file readable"), "{message}");
    }
}

#[test]
fn files_that_are_no_text() {
    let utf_16: Vec<u8> = HEADER.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_snapshot!(plain(&utf_16), @"log.csv: the text is UTF-16; save it as UTF-8 (iconv -f UTF-16 -t UTF-8)");
    assert_snapshot!(plain([b"\xff\xfe".as_slice(), &utf_16].concat()), @"log.csv: the text is UTF-16; save it as UTF-8 (iconv -f UTF-16 -t UTF-8)");
    assert_snapshot!(plain(b"PK\x03\x04\x14\x00\x06\x00"), @"log.csv: this is a zip archive or a spreadsheet, not text; unpack it, or export the sheet as CSV");
    assert_snapshot!(plain(b"\x28\xb5\x2f\xfd\x14\x00\x06\x00"), @"log.csv: this is a file compressed with zstd, not text; decompress it, or compress with gzip instead");
    assert_snapshot!(plain([0_u8, 3, 255, 1].repeat(100)), @"log.csv: this is a binary file, not text; export the recording as CSV");
    assert_snapshot!(plain(b"\x1f\x8b\x08\x00\x00"), @"log.csv: the compressed data is damaged or cut off (unexpected end of file); copy the file anew, or test it with gzip -t");
    assert_snapshot!(plain(HEADER.replace('\n', "\r").repeat(2)), @r"log.csv: lines end with a carriage return alone; convert the file (tr '\r' '\n')");
}

#[test]
fn files_without_rows() {
    assert_snapshot!(plain(""), @"log.csv: the file holds no rows; record again, or check that the logger closed the file");
    assert_snapshot!(plain("\n\n# nothing\n"), @"log.csv: the file holds no rows; record again, or check that the logger closed the file");
    assert_snapshot!(plain(HEADER), @"log.csv: there are no rows; record again, or check that the logger closed the file");
    assert_snapshot!(below_header("0,1,2,3\n"), @"log.csv: there is only one row; at least 2 are needed: record for longer");
    assert_snapshot!(refusal(log_with_stamps([0.0, 1.0, 2.0]), &options(["--min-rows 100"])), @"log.csv: there are only 3 rows; at least 100 are needed: record for longer");
    assert_snapshot!(refusal(format!("{HEADER}a,b,c,d\n"), &options(["--skip-bad-rows"])), @r#"log.csv: there are no rows that can be used (1 skipped, the first at line 2: "a" in column "time_s" is not a number); check that the columns hold what the header says"#);
    assert_snapshot!(refusal(format!("{HEADER}a,b,c,d\n0,1,2,3\n1,1,1\n"), &options(["--skip-bad-rows"])), @r#"log.csv: there is only one row that can be used (2 skipped, the first at line 2: "a" in column "time_s" is not a number); at least 2 are needed: record for longer"#);
}

#[test]
fn channels_that_never_vary() {
    assert_snapshot!(below_header("1.5,1,2,3\n1.5,1,2,4\n1.5,1,2,5\n"), @"log.csv: time never varies (it is 1.5 s in every row); check the logger's clock and the column that holds it");
    assert_snapshot!(below_header("0,1,2,-9\n1,2,2,-9\n2,3,2,-9\n"), @"log.csv: force never varies (it is -9 N in every row); check the load cell and the column that holds it, or for a dead weight leave the column out and give --fixed force_N=-9");
    assert_snapshot!(plain(log_with_stamps(std::iter::repeat_n(7.0, 200_000))), @"log.csv: time stands at 7 s for more than 131072 rows; check the logger's clock, or cut the file where it stopped");
    assert_snapshot!(plain(log_with_stamps((0..6000).map(|row| 9e11 + f64::from(row / 3000) * 1e-3))), @"log.csv: the stamps around 900000000000 s are too large to tell rows apart; subtract the start from the time column");
}

#[test]
fn headers_with_a_wrong_name() {
    assert_snapshot!(plain("time_s,presure_kPa,length_mm,force_N\n0,1,2,3\n"), @r#"log.csv:1:2: unknown column "presure_kPa"; did you mean pressure_kPa?"#);
    assert_snapshot!(plain("# rig 3\n\ntime_s,pressure_kPa,length_mm,forze\n0,1,2,3\n"), @r#"log.csv:3:4: unknown column "forze"; did you mean force_N?"#);
    assert_snapshot!(plain("time_s,pressure_kPa,length_mm,force_Nm\n0,1,2,3\n"), @r#"log.csv:1:4: unknown unit "Nm" of column "force_Nm"; force can be in N, kN, lbf or kgf, for example force_N (for other units see --calibrate)"#);
    assert_snapshot!(plain("time_s,pressure,length_mm,force_N\n0,1,2,3\n"), @r#"log.csv:1:2: column "pressure" has no unit; add it to the name (kPa, Pa, MPa, bar or psi) or give it on the command line, for example --map pressure_kPa=pressure"#);
    assert_snapshot!(plain("time_s,pressure_kPa,length_mm,force_N,pressure_bar\n0,1,2,3,4\n"), @r#"log.csv:1:5: column "pressure_bar" gives pressure again after "pressure_kPa"; keep one of them, for example with --map pressure_kPa=pressure_kPa"#);
    assert_snapshot!(plain("time_s,pressure_bar,pressure_kPa,length_mm,force_N\n0,1,2,3,4\n"), @r#"log.csv:1:3: column "pressure_kPa" gives pressure again after "pressure_bar"; keep one of them, for example with --map pressure_bar=pressure_bar"#);
    assert_snapshot!(plain("time_s,pressure_kPa,length_mm,force_N,Force_N\n0,1,2,3,4\n"), @r#"log.csv:1:5: column "Force_N" gives force again after "force_N"; keep one of them, for example with --map force_N=force_N"#);
    assert_snapshot!(plain("time_s,pressure_kPa,length_mm,force_N,force_N\n0,1,2,3,4\n"), @r#"log.csv:1:5: column "force_N" gives force again after "force_N"; rename one of them in the header"#);
    assert_snapshot!(plain("time_s,pressure_kPa,force_N,valve\n0,1,2,3\n"), @"log.csv: no column gives length; name a column length_mm in the header, point to one with --map length_mm=COLUMN, or give a constant with --fixed length_mm=VALUE (the file has time_s, pressure_kPa, force_N, valve)");
    assert_snapshot!(plain("clock,pressure_kPa,length_mm,force_N\n0,1,2,3\n"), @"log.csv: no column gives time; name a column time_s in the header or point to one with --map time_s=COLUMN (the file has clock, pressure_kPa, length_mm, force_N)");
    assert_snapshot!(plain("time_s,P [bar],length_mm,force_N\n0,1,2,3\n"), @r#"log.csv: no column gives pressure; name a column pressure_kPa in the header or, as it seems to fit, give --map pressure_bar="P [bar]" (the file has time_s, P [bar], length_mm, force_N)"#);
    assert_snapshot!(plain("time_s,pressure_kPa,length_mm,F_N\n0,1,2,3\n"), @"log.csv: no column gives force; name a column force_N in the header or, as it seems to fit, give --map force_N=F_N (the file has time_s, pressure_kPa, length_mm, F_N)");
    assert_snapshot!(plain("a,b,c,d,e,f,g,h,i,j\n0,1,2,3,4,5,6,7,8,9\n"), @"log.csv: no column gives time; name a column time_s in the header or point to one with --map time_s=COLUMN (the file has a, b, c, d, e, f, g, h and 2 more)");
    assert_snapshot!(plain("time_s,\"pressure_kPa,length_mm,force_N\n0,1,2,3\n"), @"log.csv:1:2: a quote is not closed on its line; close it or remove it");
    assert_snapshot!(plain("time_s pressure_kPa length_mm force_N\n0 1 2 3\n"), @"log.csv:1:1: the columns are separated by spaces; separate them by comma, semicolon or tab");
    assert_snapshot!(plain("#\n# time_s,presure_kPa,length_mm,force_N\n0,1,2,3\n1,1,2,3\n"), @r#"log.csv:2:2: unknown column "presure_kPa"; did you mean pressure_kPa?"#);
    assert_snapshot!(plain("# made by hand\n0,1,2,3,4\n1,1,2,3,4\n"), @"log.csv:2:1: the file has no header; name its columns in their order, for example --columns time_s,pressure_kPa,length_mm,force_N,- (- skips one)");
    assert_snapshot!(plain(format!("time_s{}", "x".repeat(2 << 20))), @"log.csv:1:1: the line is longer than 1048576 bytes; check that lines end with a line feed");
}

#[test]
fn rows_that_cannot_be_used() {
    assert_snapshot!(below_header("0,1,2,3\n\n# stop\n1,one,2,3\n"), @r#"log.csv:5:2: "one" in column "pressure_kPa" is not a number; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(below_header("0,1,2,3\n1,1,2\n"), @"log.csv:3:4: 3 fields where the header has 4; correct the row, or drop such rows with --skip-bad-rows");
    assert_snapshot!(below_header("0,1,2,3\n1,1,2,3,4,5\n"), @"log.csv:3:5: 6 fields where the header has 4; correct the row, or drop such rows with --skip-bad-rows");
    assert_snapshot!(below_header("0,1,2,3\n1,,2,3\n"), @r#"log.csv:3:2: column "pressure_kPa" is empty; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(below_header("0,1,2,3\n1,1,2,nan\n"), @r#"log.csv:3:4: "nan" in column "force_N" is not finite; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(below_header("0,1,2,3\n1,1,2,-inf\n"), @r#"log.csv:3:4: "-inf" in column "force_N" is not finite; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(below_header("0,1,2,3\n1,1,2,1e400\n"), @r#"log.csv:3:4: "1e400" in column "force_N" is not finite; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(below_header("0,1,2,3\n1,1e11,2,3\n"), @r#"log.csv:3:2: 1e11 in column "pressure_kPa" is beyond anything a bench measures; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(below_header("0,1,2,3\n1,1,2,\"3\n"), @"log.csv:3:4: a quote is not closed on its line; correct the row, or drop such rows with --skip-bad-rows");
    assert_snapshot!(below_header("0,1,2,3\n1,1,2,3\n0.5,1,2,3\n"), @"log.csv:4:1: the clock runs back from 1 s to 0.5 s; cut the file there if the logger started anew, or drop such rows with --skip-bad-rows");
    assert_snapshot!(below_header(&format!("0,1,2,3\n1,1,2,{}\n", "9".repeat(2 << 20))), @"log.csv:3:1: the line is longer than 1048576 bytes; correct the row, or drop such rows with --skip-bad-rows");
    assert_snapshot!(below_header(&format!("0,1,2,3\n1,1,2,{}\n", "x".repeat(1000))), @r#"log.csv:3:4: "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx…" in column "force_N" is not a number; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(below_header("0,1,2,3\r\n1,1,2,3\u{7}\u{2028}x\r\n"), @r#"log.csv:3:4: "3\u{7}\u{2028}x" in column "force_N" is not a number; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(below_header("0,5,1,0,2,5,3,5\n"), @"log.csv:2:5: 8 fields where the header has 4; decimal commas need semicolons or tabs between columns; drop such rows with --skip-bad-rows");
    assert_snapshot!(plain([HEADER.as_bytes(), b"0,1,2,3\n1,1,2,3\xff\n"].concat()), @r#"log.csv:3:4: "3�" in column "force_N" is not a number; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(plain("force_N;pressure_kPa;time_ms;length_mm\n1;2;3;4\n1,5;2;1.000,5;4\n"), @r#"log.csv:3:3: "1.000,5" in column "time_ms" is not a number; correct the row, or drop such rows with --skip-bad-rows"#);
    assert_snapshot!(plain("valve;force_N;pressure_kPa;time_ms;length_mm\n\n0;1;2;3;4\n0;1;2;2,5;4\n"), @"log.csv:4:4: the clock runs back from 0.003 s to 0.0025 s; cut the file there if the logger started anew, or drop such rows with --skip-bad-rows");
}

#[test]
fn what_the_system_refuses() {
    use std::io::{Error, ErrorKind};
    let message = |path: &str, kind| ReadError { path: path.into(), place: None, kind: Box::new(kind) }.to_string();
    let full = Error::from(ErrorKind::StorageFull);
    let spill = ReadErrorKind::Spill { directory: "/tmp".into(), source: full };
    assert_snapshot!(message("-", spill), @"standard input: the recording is larger than memory and the temporary file in /tmp cannot be written: no storage space; set TMPDIR to a directory with space");
    let unreadable = ReadErrorKind::Unreadable { source: Error::from(ErrorKind::TimedOut) };
    assert_snapshot!(message("log.csv", unreadable), @"log.csv: cannot be read: timed out; check the disk or copy the file anew");
    assert_snapshot!(message("log.csv", ReadErrorKind::PermissionDenied), @"log.csv: permission denied; make the file readable");
}
