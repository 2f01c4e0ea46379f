//! Spellings, separators, encodings and units that mean the same recording.

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;
use pam_recording::{CHUNK_ROWS, ReadOptions};

use super::{options, read, recording, rows};

/// Two rows, as each spelling below must give them.
const ROWS: [[f64; 4]; 2] = [[0.0, 100e3, 0.2, 10.0], [0.5, 200.5e3, 0.1995, -12.5]];

const PLAIN: &str = "time_s,pressure_kPa,length_mm,force_N\n0,100,200,10\n0.5,200.5,199.5,-12.5\n";

#[test]
fn one_recording_in_many_spellings() {
    for (what, text) in [
        ("plain", PLAIN.to_owned()),
        ("no line feed at the end", PLAIN.trim_end().to_owned()),
        ("CRLF", PLAIN.replace('\n', "\r\n")),
        ("byte order mark", format!("\u{feff}{PLAIN}")),
        ("case", PLAIN.replace("time_s,pressure_kPa", "Time_S,PRESSURE_KPA")),
        ("semicolons", PLAIN.replace(',', ";")),
        ("tabs", PLAIN.replace(',', "\t")),
        ("decimal commas and semicolons", PLAIN.replace(',', ";").replace('.', ",")),
        ("decimal commas and tabs", PLAIN.replace(',', "\t").replace('.', ",")),
        ("blanks", PLAIN.replace(',', " , ").replace('\n', "  \n")),
        ("quotes", format!("\"{}\"\n", PLAIN.trim_end().replace(',', "\",\"").replace('\n', "\"\n\""))),
        ("comments", format!("# rig 3\n#\n{}# end\n", PLAIN.replace("\n0.5,", "\n  # a, b\n0.5,"))),
        ("blank lines", format!("\n\n{}\n   \n", PLAIN.replace("\n0.5,", "\n\n0.5,"))),
        ("separator at every end", PLAIN.replace('\n', ",\n")),
        ("separator at the end of rows", PLAIN.replace('\n', ",\n").replacen(",\n", "\n", 1)),
        ("separator at the end of the header", PLAIN.replacen('\n', ",\n", 1)),
        ("exponents and signs", PLAIN.replace("200.5", "+2.005E2").replace("-12.5", "-.125e+2")),
        ("another order", "force_N,length_mm,time_s,pressure_kPa\n10,200,0,100\n-12.5,199.5,0.5,200.5\n".to_owned()),
        (
            "other columns",
            "note,time_s,pressure_kPa,valve,length_mm,force_N,\"x, y\"\n\
             a,0,100,,200,10,1\n\"b, c\",0.5,200.5,open,199.5,-12.5,\"say \"\"no\"\"\"\n"
                .to_owned(),
        ),
        ("other units", "time_ms,pressure_bar,length_m,force_kN\n0,1,0.2,0.01\n500,2.005,0.1995,-0.0125\n".to_owned()),
    ] {
        let recording = recording(&text);
        let found = rows(&recording);
        assert_eq!(found.len(), 2, "{what}");
        for (found, expected) in found.iter().flatten().zip(ROWS.iter().flatten()) {
            assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{what}: {found} for {expected}");
        }
        assert_eq!(recording.segments, vec![0..2], "{what}");
    }
}

#[test]
fn columns_kept_out_of_the_way_are_named() {
    let recording = recording(
        "time_s,valve,pressure_kPa,force_raw,length_mm,force_N,,presure_kPa\n0,1,2,3,4,5,6,7\n1,1,2,3,4,6,7,8\n",
    );
    assert_eq!(recording.ignored_columns, ["valve", "force_raw", "presure_kPa"]);
    assert!(recording.repairs.is_empty());
}

#[test]
fn bytes_that_are_not_utf_8_do_no_harm_in_columns_that_nothing_uses() {
    let text = b"time_s,pressure_kPa,length_mm,force_N,T [\xb0C]\n0,1,2,3,\xff\xfe\n1,1,2,4,\xb0\n";
    let recording = recording(text);
    assert_eq!(recording.samples.n_rows(), 2);
    assert_eq!(recording.ignored_columns, ["T [°C]"]);
}

#[test]
fn temperature_is_read_where_there_is_one() {
    let with = recording("time_s,pressure_kPa,length_mm,force_N,temperature_C\n0,1,2,3,20\n1,1,2,4,21.5\n");
    assert!(with.samples.has_temperature());
    assert_eq!(with.samples.chunk(0).unwrap().temperature_k(), [293.15, 294.65]);
    let without = recording(PLAIN);
    assert!(!without.samples.has_temperature());
    assert!(without.samples.chunk(0).unwrap().temperature_k().is_empty());
}

#[test]
fn force_may_be_missing_where_it_is_not_needed() {
    let text = "time_s,pressure_kPa,length_mm\n0,1,2\n1,1,2\n";
    let recording = read(text, &options(["--force-optional"])).unwrap();
    assert!(!recording.samples.has_force());
    assert!(recording.samples.chunk(0).unwrap().force_n().is_empty());
}

#[test]
fn compressed_files_are_read_as_they_are() {
    let compress = |text: &str| {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(text.as_bytes()).unwrap();
        encoder.finish().unwrap()
    };
    let (first, second) = PLAIN.split_at(50);
    let members = [compress(first), compress(second)].concat();
    let recording = recording(&members);
    assert_eq!(rows(&recording), ROWS);
    // Of the file as it lies on the disk.
    assert_eq!(recording.sha256, sha256(&members));
}

#[test]
fn the_digest_is_that_of_the_file() {
    assert_eq!(recording(PLAIN).sha256, sha256(PLAIN.as_bytes()));
}

fn sha256(bytes: &[u8]) -> String {
    use sha2::Digest;
    sha2::Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn a_line_of_absurd_length_in_a_comment_costs_only_itself() {
    let text = format!("{PLAIN}#{}\n1,1,1,1\n", "x".repeat(3 << 20));
    let recording = read(text, &options(["--skip-bad-rows"])).unwrap();
    assert_eq!(recording.samples.n_rows(), 3);
}

#[test]
fn what_is_written_is_read_back_to_the_last_bit() {
    let n_rows = 2 * CHUNK_ROWS + 321;
    let mut text = "time_s,pressure_Pa,length_m,force_N\n".to_owned();
    let mut written = Vec::new();
    for row in 0..n_rows {
        let phase = row as f64;
        let row = [phase * 1e-3, 1e5 * phase.sin(), 0.2 + 0.01 * phase.cos(), 100.0 * (phase / 7.0).sin()];
        text += &row.map(|value| value.to_string()).join(",");
        text.push('\n');
        written.push(row);
    }
    for memory_rows in [0, CHUNK_ROWS, usize::MAX] {
        let recording = read(&text, &ReadOptions { memory_rows, ..ReadOptions::default() }).unwrap();
        assert_eq!(rows(&recording), written);
        assert_eq!(recording.segments, vec![0..n_rows]);
        assert!(recording.repairs.is_empty());
    }
}

#[test]
fn a_header_behind_a_comment_mark_is_a_header() {
    let text = format!("# rig 3\n# {PLAIN}");
    assert_eq!(rows(&recording(text)), ROWS);
}
