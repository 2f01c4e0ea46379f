//! A muscle at two dates, as a person meets it: what has changed is named with its size, and nothing else is.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

mod desk;

use std::sync::OnceLock;

use pam_artifact::change::{ChangeArtifact, ChangeKind, ChangeVerdict, Compared};
use pam_virtual_bench::{Concealed, Parameters};

use desk::Desk;

const SCHEMA: &str = include_str!("../../../crates/artifact/schemas/pam-change-1.json");
const THEN: &str = "then-minor-loops.csv then-isobaric-triangles.csv then-isometric-ramps.csv";
const NOW: &str = "now-minor-loops.csv now-isobaric-triangles.csv now-isometric-ramps.csv";

/// Recordings of two dates, and the model of then: `then` and `now` are concealed; later the channel `shifted` reads so much
/// more, and parameters are `set`.
fn dates(then: &[Concealed], now: &[Concealed], shifted: Option<(&str, f64)>, set: fn(&mut Parameters)) -> Desk {
    let desk = Desk::empty();
    desk.record("then", then, None, 1, |_| {});
    desk.record("now", now, shifted, 101, set);
    desk.identify("then", "model.json");
    desk
}

fn plain() -> &'static Desk {
    static DESK: OnceLock<Desk> = OnceLock::new();
    DESK.get_or_init(|| dates(&[], &[], None, |_| {}))
}

fn changes(desk: &Desk, arguments: &str) -> ChangeArtifact {
    let output = desk.run(&format!("{arguments} --out -"));
    assert!(output.stderr.is_empty() || output.status.code() != Some(2), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The only change, named without a rival.
fn only(found: &ChangeArtifact) -> (&str, &Compared) {
    assert_eq!(found.changes.len(), 1, "{}", found.statement);
    (&found.changes[0].id, &found.changes[0].differences[0])
}

/// Whether `compared` is `truth` within four standard errors, and is known to a tenth of it.
fn is_near(compared: &Compared, truth: f64) -> bool {
    let stderr = compared.stderr.unwrap();
    (compared.now - truth).abs() < 4.0 * stderr && stderr < 0.1 * truth.abs()
}

#[test]
fn nothing_is_said_of_recordings_in_which_only_the_noise_is_another() {
    let desk = plain();
    let output = desk.run(&format!("{NOW} --since model.json --out same.json --report same.html"));
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let found: ChangeArtifact = serde_json::from_slice(&std::fs::read(desk.path("same.json")).unwrap()).unwrap();
    assert_eq!(found.verdict, ChangeVerdict::Unchanged);
    assert!(found.changes.is_empty());
    assert!(found.unchanged.iter().all(|one| one.standard_errors.unwrap().abs() < 5.0), "{:?}", found.unchanged);
    assert!(std::fs::read_to_string(desk.path("same.html")).unwrap().contains("Unchanged"));
}

#[test]
fn a_zero_that_has_shifted_is_named_in_newtons_and_in_standard_errors() {
    let desk = dates(&[], &[], Some(("force_N", 5.0)), |_| {});
    let output = desk.run(&format!("{NOW} --since model.json --out zero.json"));
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let found: ChangeArtifact = serde_json::from_slice(&std::fs::read(desk.path("zero.json")).unwrap()).unwrap();
    let (id, zero) = only(&found);
    assert_eq!((id, zero.unit.as_str(), found.changes[0].kind), ("force-zero", "N", ChangeKind::Channel));
    assert!(is_near(zero, 5.0), "{zero:?}");
    assert!(found.statement.contains("zero of the load cell has shifted (+"), "{}", found.statement);
    assert!(found.statement.contains("standard errors"), "{}", found.statement);
}

#[test]
fn a_bladder_that_has_got_softer_is_named_with_its_modulus_then_and_now() {
    let soften = |parameters: &mut Parameters| {
        parameters.c10_pa *= 0.8;
        parameters.c01_pa *= 0.8;
    };
    let found = changes(&dates(&[], &[], None, soften), &format!("{NOW} --since model.json"));
    let (id, bladder) = only(&found);
    assert_eq!((id, bladder.unit.as_str()), ("c10 + c01", "Pa"));
    let nominal = Parameters::nominal();
    let then_pa = nominal.c10_pa + nominal.c01_pa;
    assert!(is_near(bladder, 0.8 * then_pa), "{bladder:?}");
    assert!((bladder.then.unwrap() / then_pa - 1.0).abs() < 0.05, "{bladder:?}");
}

#[test]
fn an_effect_that_was_there_then_is_part_of_the_base_and_one_that_was_not_is_new() {
    let damping = Concealed::new("viscous-damping", 2.0);
    let late = [damping.clone(), Concealed::new("channel-delay", 1.5)];
    let desk = dates(&[damping], &late, None, |_| {});
    let then = desk.run(&format!("{THEN} --model model.json --out then.json --out-model augmented.json"));
    assert_ne!(then.status.code(), Some(2), "{then:?}");
    let found = changes(&desk, &format!("{NOW} --since augmented.json --model model.json"));
    let (id, _) = only(&found);
    assert_eq!((id, found.changes[0].kind), ("channel-delay", ChangeKind::NewEffect));
}

#[test]
fn the_same_recordings_give_the_same_changes_on_any_number_of_threads() {
    let desk = plain();
    let one = desk.run(&format!("{NOW} --since model.json --out - --threads 1"));
    let two = desk.run(&format!("{NOW} --since model.json --out - --threads 2"));
    assert!(!one.stdout.is_empty() && one.stdout == two.stdout);
}

#[test]
fn a_baseline_of_another_muscle_is_refused_and_leaves_no_file() {
    let desk = plain();
    let mut other: serde_json::Value =
        serde_json::from_slice(&std::fs::read(desk.path("model.json")).unwrap()).unwrap();
    other["inputs"][0]["sha256"] = "1".repeat(64).into();
    std::fs::write(desk.path("other.json"), other.to_string()).unwrap();
    let refused = |arguments: &str, words: &str| {
        let output = desk.run(&format!("{arguments} --out refused.json"));
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(words) && message.contains("name the baseline of this"), "{message}");
        assert!(!desk.path("refused.json").exists());
    };
    refused(&format!("{NOW} --since model.json --model other.json"), "is of another muscle");
    // A muscle of another radius and braid: half the force.
    other["geometry"]["rest_radius_m"] = (0.7 * other["geometry"]["rest_radius_m"].as_f64().unwrap()).into();
    other["geometry"]["braid_angle_rad"] = (1.15 * other["geometry"]["braid_angle_rad"].as_f64().unwrap()).into();
    std::fs::write(desk.path("other.json"), other.to_string()).unwrap();
    refused(&format!("{NOW} --since other.json"), "it is of another muscle");
}

#[test]
fn recordings_that_the_baseline_was_made_from_are_no_later_ones() {
    let desk = plain();
    let output = desk.run(&format!("{THEN} --since model.json --out twice.json"));
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("the baseline was made from this very recording; name recordings that were made later"));
    assert!(!desk.path("twice.json").exists());
}

#[test]
fn a_diagnosis_in_the_place_of_its_model_is_refused_with_the_remedy() {
    let desk = plain();
    std::fs::write(desk.path("diagnosis.json"), "{\"schema\": \"pam-diagnosis/1\"}").unwrap();
    let output = desk.run(&format!("{NOW} --since diagnosis.json --out no.json"));
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("diagnosis.json: is a diagnosis; name the model that pam-diagnose --out-model wrote with it")
    );
}

#[test]
fn the_schema_is_published_and_obeyed() {
    let desk = plain();
    let output = desk.run("--schema=since");
    assert!(output.stdout == SCHEMA.as_bytes(), "the published schema is stale; run scripts/schemas");
    let artifact = serde_json::to_value(changes(desk, &format!("{NOW} --since model.json"))).unwrap();
    jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &artifact).unwrap();
    assert_eq!(artifact["schema"], "pam-change/1");
}
