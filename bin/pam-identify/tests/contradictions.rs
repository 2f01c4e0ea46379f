//! Recordings that contradict one another, hide in noise or stand in their file twice: what is said, and what is accepted.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const HEADER: &str = "time_s,pressure_kPa,length_mm,force_N\n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// A shipped recording: time in s, pressure in kPa, length in mm, force in N.
fn rows(name: &str) -> Vec<[f64; 4]> {
    let text = std::fs::read_to_string(root().join(format!("datasets/bench-nominal/{name}.csv"))).unwrap();
    let parse = |line: &str| {
        let mut fields = line.split(',').map(|field| field.parse::<f64>().unwrap());
        [(); 4].map(|()| fields.next().unwrap())
    };
    text.lines().skip(1).map(parse).collect()
}

fn changed(name: &str, change: impl Fn(usize, [f64; 4]) -> [f64; 4]) -> Vec<[f64; 4]> {
    rows(name).into_iter().enumerate().map(|(row, values)| change(row, values)).collect()
}

/// Exit code and what is said of `bad` (and the shipped `others` beside it) by a fit with further `options`.
fn fitted(bad: &[[f64; 4]], others: &[&str], options: &[&str]) -> (i32, String) {
    let folder = tempfile::tempdir().unwrap();
    let text: String = bad.iter().map(|[t, p, l, f]| format!("{t},{p},{l},{f}\n")).collect();
    std::fs::write(folder.path().join("bad.csv"), HEADER.to_owned() + &text).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_pam-identify"))
        .arg("bad.csv")
        .args(others.iter().map(|name| root().join(format!("datasets/bench-nominal/{name}.csv"))))
        .arg("--muscle")
        .arg(root().join("configs/muscle-nominal.toml"))
        .args(["--out", "model.json", "--starts", "2"])
        .args(options)
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .output()
        .unwrap();
    assert_eq!(folder.path().join("model.json").exists(), output.status.code() != Some(2));
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn the_one_recording_whose_instrument_reads_otherwise_is_named_and_the_fit_rejected() {
    let others = ["isometric-ramps", "minor-loops"];
    type Change = fn(usize, [f64; 4]) -> [f64; 4];
    let faults: [(Change, &str); 5] = [
        (|_, [t, p, l, f]| [t, p + 101.3, l, f], "in bad.csv the pressure reads 101."),
        (|_, [t, p, l, f]| [t, p - 15.0, l, f], "in bad.csv the pressure reads 1"),
        (|_, [t, p, l, f]| [t, 1.1 * p, l, f], "in bad.csv the pressure reads 1."),
        (|_, [t, p, l, f]| [t, p, l, 1.3 * f], "in bad.csv the force reads 1."),
        (|_, [t, p, l, f]| [t, p, l, 0.8 * f], "in bad.csv the force reads 0."),
    ];
    for (change, words) in faults {
        let bad = changed("isobaric-triangles", change);
        let (code, said) = fitted(&bad, &others, &[]);
        assert_eq!(code, 1, "{words}: {said}");
        assert!(said.contains("the recordings contradict one another") && said.contains(words), "{words}: {said}");
        assert!(said.contains("rejected: one model cannot follow"), "{said}");
    }
    // Whoever wants it gets it, and is told all the same.
    let bad = changed("isobaric-triangles", |_, [t, p, l, f]| [t, p, l, 0.8 * f]);
    let (code, said) = fitted(&bad, &others, &["--accept-implausible"]);
    assert!(code == 0 && said.contains("the force reads 0."), "{said}");
    // A tare is set anew now and then: it is said, and no reason to reject.
    let tared = changed("isobaric-triangles", |_, [t, p, l, f]| [t, p, l, f + 30.0]);
    let (code, said) = fitted(&tared, &others, &[]);
    assert!(code == 0 && said.contains("in bad.csv the force reads") && said.contains("N too much"), "{said}");
    let (code, said) = fitted(&rows("isobaric-triangles"), &others, &[]);
    assert!(code == 0 && !said.contains("contradict"), "as they are: {said}");
}

#[test]
fn a_fit_that_explains_less_than_half_of_the_force_is_rejected() {
    let bad = changed("isobaric-triangles", |row, [t, p, l, f]| [t, if row < 5000 { p } else { p / 6.895 }, l, f]);
    let (code, said) = fitted(&bad, &[], &[]);
    assert!(code == 1 && said.contains("of a force that varies by"), "{said}");
}

#[test]
fn a_fit_that_leaves_far_more_than_noise_is_said_to_do_so() {
    let all = rows("isobaric-triangles");
    let late = changed("isobaric-triangles", |row, [t, p, l, _]| [t, p, l, all[row.saturating_sub(100)][3]]);
    let (_, said) = fitted(&late, &["isometric-ramps"], &[]);
    assert!(said.contains(" times what noise of the sensors alone would leave"), "{said}");
    let (_, said) = fitted(&all, &["isometric-ramps"], &[]);
    assert!(!said.contains(" times what noise of the sensors"), "{said}");
}

#[test]
fn noise_that_hides_everything_is_said_and_that_of_a_sensor_in_order_is_not() {
    let hum = changed("isobaric-triangles", |_, [t, p, l, f]| [t, p, l, f + 50.0 * (62.8 * t).sin()]);
    for others in [&[] as &[&str], &["isometric-ramps"]] {
        let (code, said) = fitted(&hum, others, &[]);
        assert!(code == 0 && said.contains("bad.csv: the noise of its sensors alone leaves"), "{said}");
    }
    let (_, said) = fitted(&rows("isobaric-triangles"), &["isometric-ramps", "minor-loops", "length-steps"], &[]);
    assert!(!said.contains("noise of its sensors"), "{said}");
    // Haste that looks like noise is followed by the model, and is none.
    let minutes = changed("isobaric-triangles", |_, [t, p, l, f]| [t / 60.0, p, l, f]);
    let (_, said) = fitted(&minutes, &["isometric-ramps"], &[]);
    assert!(!said.contains("noise of its sensors"), "{said}");
}

#[test]
fn a_stretch_that_stands_in_its_file_twice_is_said() {
    let mut bad = rows("isobaric-triangles");
    let again: Vec<[f64; 4]> = bad[1000..6000].iter().map(|&[t, p, l, f]| [t + 100.0, p, l, f]).collect();
    bad.extend(again);
    let (code, said) = fitted(&bad, &[], &[]);
    assert!(code == 0 && said.contains("stand there once more"), "{said}");
    let (_, said) = fitted(&rows("isobaric-triangles"), &[], &[]);
    assert!(!said.contains("once more"), "{said}");
}

#[test]
fn a_value_that_stands_for_no_value_is_said_with_its_size() {
    let gaps = changed("isobaric-triangles", |row, [t, p, l, f]| [t, p, l, if row / 20 == 150 { -999.0 } else { f }]);
    let (code, said) = fitted(&gaps, &[], &[]);
    assert!(code == 0 && said.contains("force is stuck at its low end (-999.0000 N)"), "{said}");
    assert!(said.contains("those samples are not counted"), "{said}");
}

#[test]
fn one_slow_recording_makes_no_lag_of_the_others() {
    let slow: Vec<[f64; 4]> = rows("isobaric-triangles").into_iter().step_by(100).collect();
    let (code, said) = fitted(&slow, &["isometric-ramps", "minor-loops"], &[]);
    assert!(code == 0 && !said.contains(" ms later than ") && !said.contains(" ms ahead of "), "{said}");
}
