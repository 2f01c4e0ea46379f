//! Recordings of real muscles, where there are any: `PAM_RECORDINGS`, or `shared/recordings` beside the workspace.

use std::path::{Path, PathBuf};

use pam_recording::{ReadOptions, read_recording};

use super::{exists, options, stamps_s};

fn folder(name: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/recordings");
    let root = std::env::var_os("PAM_RECORDINGS").map_or(beside, PathBuf::from);
    let folder = root.join(name);
    if exists(&folder) {
        return Some(folder);
    }
    #[expect(clippy::print_stderr, reason = "a test that checks nothing should say so")]
    {
        eprintln!("skipped: no recordings of real muscles found (set PAM_RECORDINGS)");
    }
    None
}

#[test]
fn isometric_recordings_are_whole() {
    let Some(folder) = folder("festo-10mm-isometric") else { return };
    let mut n_files = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "csv") {
            continue;
        }
        n_files += 1;
        let recording = read_recording(&path, &ReadOptions::default()).unwrap();
        assert_eq!(recording.samples.n_rows(), 15_000, "{}", path.display());
        assert_eq!(recording.segments, vec![0..15_000], "{}", path.display());
        // One pair of rows shares a millisecond in each file.
        assert_eq!(recording.repairs.repeated_stamps_spread, 1, "{}", path.display());
        assert_eq!(recording.ignored_columns, ["state_1inflate_2deflate"], "{}", path.display());
        assert!(stamps_s(&recording).windows(2).all(|pair| pair[1] > pair[0]), "{}", path.display());
    }
    assert!(n_files > 0);
}

#[test]
fn a_logger_that_lost_its_framing_loses_two_rows() {
    let Some(folder) = folder("foreign-formats") else { return };
    let path = folder.join("headerless_broken_framing.csv");
    let message = |options: &ReadOptions| {
        let message = read_recording(&path, options).unwrap_err().to_string();
        message.rsplit_once("framing.csv").unwrap().1.to_owned()
    };
    let named = ["--columns force_N,pressure_kPa,time_s,-", "--fixed length_mm=126.75"];
    insta::assert_snapshot!(message(&ReadOptions::default()), @":1:1: the file has no header; name its columns in their order, for example --columns time_s,pressure_kPa,length_mm,force_N (- skips one)");
    insta::assert_snapshot!(message(&options(named)), @":4207:3: the clock runs back from 7.43 s to 0.695 s; cut the file there if the logger started anew, or drop such rows with --skip-bad-rows");

    let skipping = ReadOptions { skip_bad_rows: true, ..options(named) };
    let recording = read_recording(&path, &skipping).unwrap();
    assert_eq!(recording.samples.n_rows(), 14_998);
    assert_eq!(recording.segments, vec![0..14_998]);
    let notes = recording.repairs.notes();
    insta::assert_snapshot!(notes[0], @"1 row had the time stamp of the row above and was spread evenly up to the next stamp");
    insta::assert_snapshot!(notes[1], @"2 bad rows were dropped (line 4207: the clock runs back from 7.43 s to 0.695 s; line 4208: the clock runs back from 7.43 s to 0.695 s)");
}

#[test]
fn a_table_without_time_is_refused() {
    let Some(folder) = folder("festo-datasheet") else { return };
    let path = folder.join("festo_DMSP20_datasheet_readoff.csv");
    let message = read_recording(&path, &ReadOptions::default()).unwrap_err().to_string();
    let reason = message.rsplit_once("readoff.csv").unwrap().1;
    insta::assert_snapshot!(reason, @": no column gives time; name a column time_s in the header or point to one with --map time_s=COLUMN (the file has pressure_kPa, contraction, force_N)");
}
