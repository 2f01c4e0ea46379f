//! The model as it was given, against the recordings.

use pam_artifact::DiagnosisArtifact;
use pam_artifact::diagnosis::Verdict;
use pam_virtual_bench::Concealed;

use crate::desk::{Desk, FITTED, HELD, LOGS, reworked};

/// Files with every row of the recordings that are fitted changed, as words of a command line.
fn all_reworked(desk: &Desk, tag: &str, change: impl Fn([f64; 4]) -> [f64; 4] + Copy) -> String {
    let names = FITTED.map(|name| {
        let changed = format!("{tag}-{name}.csv");
        desk.file(&changed, reworked(desk, &format!("{name}.csv"), change));
        changed
    });
    names.join(" ")
}

#[test]
fn a_model_that_was_fitted_to_the_recordings_follows_them_as_given() {
    for desk in [Desk::plain(), Desk::presliding()] {
        let files = "--out followed.json --out-model augmented.json --quiet";
        let output = desk.run(&format!("{LOGS} --model model.json {HELD} {files}"));
        assert!(matches!(output.status.code(), Some(0 | 1)));
        let (diagnosis, _) = DiagnosisArtifact::read(&desk.path("followed.json")).unwrap();
        let given = diagnosis.as_given.unwrap();
        assert!(!given.misses && given.instrument.is_none() && given.holdout_missed.is_empty(), "{given:?}");
        // The same fit over the same samples.
        assert!((given.estimation.rmse_n / given.refitted.rmse_n - 1.0).abs() < 0.01, "{given:?}");
        assert!(given.shifts.iter().all(|shift| shift.standard_errors.is_none_or(|errors| errors.abs() < 1.0)));
    }
}

#[test]
fn a_gain_that_changed_after_the_identification_is_said_first_and_named() {
    let desk = &Desk::with(&[]);
    let logs = all_reworked(desk, "gain", |[t, p, l, f]| [t, p, l, 1.15 * f]);
    let files = "--out diagnosis.json --out-model augmented.json";
    let (diagnosis, _) = desk.diagnosed(&format!("{logs} --model model.json --report gain.html {files}"), 1);
    assert_eq!(diagnosis.verdict, Verdict::Unexplained, "{}", diagnosis.statement);
    assert!(diagnosis.statement.starts_with("The model as given misses the recordings by "), "{}", diagnosis.statement);
    assert!(diagnosis.statement.contains("refitted by ") && diagnosis.statement.contains("k1 shifted by "));
    assert!(diagnosis.statement.contains("the force reads 1.150 times what it should"), "{}", diagnosis.statement);
    let given = diagnosis.as_given.unwrap();
    assert!(given.misses && given.estimation.rmse_n > 20.0 * given.refitted.rmse_n, "{given:?}");
    // Eq. 11 is linear in k1: it takes in the gain, and by far more than it is uncertain.
    let k1 = given.shifts.iter().find(|shift| shift.parameter == "k1").unwrap();
    assert!((k1.refitted / k1.given - 1.15).abs() < 5e-3 && k1.standard_errors.unwrap() > 40.0, "{k1:?}");
    let page = std::fs::read_to_string(desk.path("gain.html")).unwrap();
    assert!(page.contains("The model as given is not that of these recordings") && page.contains("standard errors"));
}

#[test]
fn an_effect_that_came_after_the_identification_is_no_other_muscle() {
    let desk = &Desk::with(&[Concealed::new("presliding-hysteresis", 1.0)]);
    desk.file("before.json", std::fs::read(Desk::plain().path("model.json")).unwrap());
    let files = "--out diagnosis.json --out-model augmented.json";
    let (diagnosis, _) = desk.diagnosed(&format!("{LOGS} --model before.json {files}"), 0);
    assert_eq!(diagnosis.effects[0].id, "presliding-hysteresis");
    assert!(!diagnosis.as_given.unwrap().misses, "{}", diagnosis.statement);
}

#[test]
fn recordings_of_another_muscle_are_refused_unless_they_are_accepted() {
    let desk = &Desk::with(&[]);
    let mut other: serde_json::Value =
        serde_json::from_slice(&std::fs::read(desk.path("model.json")).unwrap()).unwrap();
    other["geometry"]["rest_radius_m"] = 0.0135.into();
    desk.file("other.json", other.to_string());
    let said = desk.refusal(&format!("{LOGS} --model other.json --out refused.json"));
    assert!(said.contains("minor-loops.csv: the model as given misses the recordings by"), "{said}");
    assert!(said.contains("another muscle; identify a model from them with pam-identify"), "{said}");
    assert!(said.contains("--accept-implausible"), "{said}");
    let said = desk.refusal(&format!("{LOGS} --model other.json --check"));
    assert!(said.contains("another muscle"), "{said}");
    let files = "--out diagnosis.json --out-model augmented.json --accept-implausible";
    let (diagnosis, _) = desk.diagnosed(&format!("{LOGS} --model other.json {files}"), 1);
    assert!(diagnosis.statement.starts_with("The model as given misses the recordings"), "{}", diagnosis.statement);
    assert!(!matches!(diagnosis.verdict, Verdict::Consistent | Verdict::Explained));
}

/// Rows of a recording in which the length is within 0.3 mm of what it is for the longest.
fn at_one_length(desk: &Desk, name: &str) -> String {
    let text = std::fs::read_to_string(desk.path(name)).unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let length_mm = |row: &str| row.split(',').nth(2).unwrap().parse::<f64>().unwrap();
    let first_mm = rows.lines().map(length_mm).next().unwrap();
    let kept: Vec<&str> = rows.lines().take_while(|row| (length_mm(row) - first_mm).abs() < 0.3).collect();
    format!("{header}\n{}\n", kept.join("\n"))
}

#[test]
fn a_hold_out_far_from_what_was_fitted_is_of_no_other_muscle() {
    let desk = &Desk::with(&[]);
    let held = at_one_length(desk, "isometric-ramps.csv");
    desk.file("one-length.csv", held);
    desk.file("narrow.json", serde_json::to_vec(&desk.identified_from(&["one-length"])).unwrap());
    let files = "--out narrow-diagnosis.json --quiet";
    let output = desk.run(&format!("one-length.csv --model narrow.json {HELD} {files}"));
    assert_ne!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    let (diagnosis, _) = DiagnosisArtifact::read(&desk.path("narrow-diagnosis.json")).unwrap();
    assert!(!diagnosis.statement.contains("another muscle"), "{}", diagnosis.statement);
    assert!(diagnosis.warnings.iter().any(|words| words.contains("no fitted recording was near")));
    let held = diagnosis.fit.holdout.unwrap();
    if held.rmse_after_n > 10.0 * held.noise_floor_n {
        assert!(diagnosis.statement.contains("judges the extrapolation"), "{}", diagnosis.statement);
    }
}
