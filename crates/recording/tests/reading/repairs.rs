//! Repairs, rows dropped on request, and notes about both.

use insta::assert_snapshot;
use pam_recording::ReadOptions;

use super::{log_with_stamps, options, read, recording, stamps_s};

fn assert_stamps(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found_s, expected_s) in found.iter().zip(expected) {
        assert!((found_s - expected_s).abs() < 1e-12, "{found:?} for {expected:?}");
    }
}

fn notes(stamps: impl IntoIterator<Item = f64>) -> String {
    recording(log_with_stamps(stamps)).repairs.notes().join("\n")
}

#[test]
fn equal_stamps_are_spread_up_to_the_next() {
    let recording = recording(log_with_stamps([0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 3.0]));
    assert_stamps(&stamps_s(&recording), &[0.0, 0.5, 1.0, 1.25, 1.5, 1.75, 2.0, 3.0]);
    assert_eq!(recording.repairs.repeated_stamps_spread, 4);
    assert_eq!(recording.segments, vec![0..8]);
    assert_snapshot!(recording.repairs.notes().join("\n"), @"4 rows had the time stamp of the row above and were spread evenly up to the next stamp");
}

#[test]
fn equal_stamps_at_the_end_follow_the_typical_step() {
    let recording = recording(log_with_stamps([0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]));
    assert_stamps(&stamps_s(&recording), &[0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0]);
}

#[test]
fn equal_stamps_before_a_gap_follow_the_typical_step() {
    let stamps = [0.0, 0.1, 0.2, 0.2, 0.3, 0.4, 0.4, 50.0, 50.1, 50.2, 50.3];
    let recording = recording(log_with_stamps(stamps));
    assert_stamps(&stamps_s(&recording), &[0.0, 0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 50.0, 50.1, 50.2, 50.3]);
    assert_eq!(recording.segments, vec![0..7, 7..11]);
}

#[test]
fn a_gap_splits() {
    let stamps = (0..300).map(|row| f64::from(row) * 0.01 + f64::from(row / 100) * 7.0);
    let recording = recording(log_with_stamps(stamps.clone()));
    assert_eq!(recording.segments, vec![0..100, 100..200, 200..300]);
    assert_eq!(recording.repairs.gaps, 2);
    assert_snapshot!(notes(stamps), @"2 gaps in time of up to 7.01 s split the recording into 3 segments");
    assert_snapshot!(notes([0.0, 0.1, 0.2, 0.3, 0.4, 900.0, 900.1]), @"1 gap in time of 900 s splits the recording into 2 segments");
}

#[test]
fn a_few_lost_rows_are_no_gap() {
    let stamps = (0..1000).filter(|row| row % 50 > 15).map(|row| f64::from(row) * 0.002);
    assert_eq!(recording(log_with_stamps(stamps)).segments.len(), 1);
}

#[test]
fn slow_and_uneven_loggers_have_no_gaps() {
    let slow = (0..50).map(|row| f64::from(row) * 60.0 + f64::from(row % 3) * 20.0);
    assert_eq!(recording(log_with_stamps(slow)).segments.len(), 1);
    let by_hand = [0.0, 5.0, 65.0, 80.0, 200.0, 230.0, 500.0];
    assert_eq!(recording(log_with_stamps(by_hand)).segments.len(), 1);
    let two_rows = [0.0, 1000.0];
    assert_eq!(recording(log_with_stamps(two_rows)).segments.len(), 1);
}

#[test]
fn a_logger_that_slows_down_has_no_gap_at_every_row() {
    let fast = (0..20_000).map(|row| f64::from(row) * 1e-3);
    let slow = (0..5_000).map(|row| 20.0 + f64::from(row) * 0.5);
    let recording = recording(log_with_stamps(fast.chain(slow)));
    assert!(recording.segments.len() <= 2, "{}", recording.segments.len());
}

/// A tick of 1 s at 200 rows per second, jittering: gaps in rows are hidden, lost ticks are not.
#[test]
fn a_very_coarse_clock_is_spread_and_its_gap_found() {
    let stamps = (0..40_000).map(|row| ((f64::from(row) / 200.0).floor()) + if row >= 30_000 { 60.0 } else { 0.0 });
    let recording = recording(log_with_stamps(stamps));
    assert_eq!(recording.segments, vec![0..30_000, 30_000..40_000]);
    assert_eq!(recording.repairs.repeated_stamps_spread, 40_000 - 200);
    let found = stamps_s(&recording);
    for pair in found[..30_000].windows(2) {
        assert!((pair[1] - pair[0] - 0.005).abs() < 1e-9, "{pair:?}");
    }
}

/// A run of equal stamps may lie across the borders at which rows are put away.
#[test]
fn repairs_do_not_depend_on_where_chunks_end() {
    for shift in [0, 1, 2, 3, 4, 5, 6, 7] {
        let stamps = (0..40_000).map(|row| f64::from((row + shift) / 4) * 0.01);
        let recording = recording(log_with_stamps(stamps));
        assert_eq!(recording.segments.len(), 1);
        let found = stamps_s(&recording);
        let inner = &found[8..found.len() - 8];
        for pair in inner.windows(2) {
            assert!((pair[1] - pair[0] - 0.0025).abs() < 1e-9, "shift {shift}: {pair:?}");
        }
    }
}

#[test]
fn stamps_always_increase() {
    let stamps = (0..50_000).map(|row| (f64::from(row) / 540.0 * 1e3).floor() * 1e-3);
    let found = stamps_s(&recording(log_with_stamps(stamps)));
    assert!(found.windows(2).all(|pair| pair[1] > pair[0]));
}

const BAD: &str = "time_s,pressure_kPa,length_mm,force_N\n\
    0,1,2,3\n1,1,2,4\n2,x,2,5\n3,1,2\n4,1,nan,5\n0.5,1,2,5\n5,1,2,6\n900,1,2,6\n6,1,2,6\n7,1,,8\n8,1,2,9\n9,1,2,9\n";

#[test]
fn bad_rows_are_dropped_and_counted_on_request() {
    let recording = read(BAD, &options(["--skip-bad-rows"])).unwrap();
    assert_stamps(&stamps_s(&recording), &[0.0, 1.0, 5.0, 6.0, 8.0, 9.0]);
    assert_eq!(recording.repairs.rows_skipped, 6);
    assert_snapshot!(recording.repairs.notes().join("\n"), @r#"6 bad rows were dropped (line 4: "x" in column "pressure_kPa" is not a number; line 5: 3 fields where the header has 4; line 6: "nan" in column "length_mm" is not finite; line 7: the clock runs back from 1 s to 0.5 s; line 9: the clock jumps ahead to 900 s and back again; and 1 more)"#);
}

#[test]
fn blank_lines_between_rows_are_told() {
    let text = "time_s,pressure_kPa,length_mm,force_N\n0,1,2,3\n\n\n1,1,2,4\n\n";
    assert_snapshot!(recording(text).repairs.notes().join("\n"), @"2 blank lines between rows were passed over");
}

#[test]
fn repairs_are_the_same_after_a_turn_through_json() {
    let repairs = read(BAD, &options(["--skip-bad-rows"])).unwrap().repairs;
    let text = serde_json::to_string(&repairs).unwrap();
    assert_eq!(serde_json::from_str::<pam_recording::Repairs>(&text).unwrap(), repairs);
}

#[test]
fn skipping_changes_nothing_in_a_good_file() {
    let stamps = (0..40_000).map(|row| (f64::from(row) / 540.0 * 1e3).floor() * 1e-3);
    let text = log_with_stamps(stamps);
    let plain = read(&text, &ReadOptions::default()).unwrap();
    let skipping = read(&text, &options(["--skip-bad-rows"])).unwrap();
    assert_eq!(stamps_s(&plain), stamps_s(&skipping));
    assert_eq!(plain.repairs, skipping.repairs);
}
