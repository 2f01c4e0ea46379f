//! Muscles of one rig together, as a person meets it: what the rig does is named once, for all of them.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

mod desk;

use std::sync::OnceLock;

use pam_artifact::GroupArtifact;
use pam_artifact::group::Says;
use pam_virtual_bench::{Concealed, Parameters};

use desk::{Desk, logs};

const SCHEMA: &str = include_str!("../../../crates/artifact/schemas/pam-group-1.json");

/// Parameters that make a muscle of the nominal one.
type Change = fn(&mut Parameters);

/// Muscles, and how each differs from the nominal one.
const MUSCLES: [(&str, Change); 2] =
    [("soft", |parameters| parameters.c10_pa *= 0.8), ("stiff", |parameters| parameters.c10_pa *= 1.2)];

/// A rig with two muscles, in all of them `concealed`; where something is `held_out`, with that concealed instead.
fn rig(concealed: &[Concealed], held_out: Option<&[Concealed]>) -> Desk {
    let desk = Desk::empty();
    let mut text = String::new();
    let quoted = |series: &str| logs(series).replace(' ', "\", \"");
    for (index, (name, set)) in MUSCLES.into_iter().enumerate() {
        let seed = 1 + 10 * index as u64;
        desk.record(name, concealed, None, seed, set);
        desk.identify(name, &format!("{name}.json"));
        text += &format!("[[muscle]]\nname = \"{name}\"\nmodel = \"{name}.json\"\nlogs = [\"{}\"]\n", quoted(name));
        if let Some(held_out) = held_out {
            let later = format!("{name}-later");
            desk.record(&later, held_out, None, seed + 5, set);
            text += &format!("holdout = [\"{}\"]\n", quoted(&later));
        }
    }
    std::fs::write(desk.path("rig.toml"), text).unwrap();
    desk
}

fn plain() -> &'static Desk {
    static DESK: OnceLock<Desk> = OnceLock::new();
    DESK.get_or_init(|| rig(&[], None))
}

/// What is said of [`plain`], byte for byte.
fn said_of_plain() -> &'static [u8] {
    static SAID: OnceLock<Vec<u8>> = OnceLock::new();
    SAID.get_or_init(|| said(plain(), "--threads 2"))
}

fn said(desk: &Desk, arguments: &str) -> Vec<u8> {
    let output = desk.run(&format!("--group rig.toml --out - {arguments}"));
    assert_ne!(output.status.code(), Some(2), "{output:?}");
    output.stdout
}

fn found(said: &[u8]) -> GroupArtifact {
    serde_json::from_slice(said).unwrap()
}

#[test]
fn nothing_is_said_of_a_rig_that_does_nothing() {
    let found = found(said_of_plain());
    assert!(found.rig.is_empty(), "{}", found.statement);
    assert!(found.muscles.iter().all(|muscle| muscle.effects.is_empty()), "{}", found.statement);
    assert!(found.statement.starts_with("The 2 muscles together show no effect of the rig."), "{}", found.statement);
}

#[test]
fn a_delay_of_the_rig_is_named_once_with_one_value_for_all_muscles_and_confirmed_by_what_is_held_out() {
    let delay = [Concealed::new("channel-delay", 1.0)];
    let found = found(&said(&rig(&delay, Some(&delay)), ""));
    let [effect] = &found.rig[..] else { panic!("{}", found.statement) };
    assert_eq!(effect.id, "channel-delay", "{}", found.statement);
    assert!(effect.muscles.iter().filter(|one| one.says == Says::Shows).count() >= 2, "{}", found.statement);
    assert!(found.muscles.iter().all(|muscle| muscle.effects.is_empty()), "{}", found.statement);
    let held_out = effect.held_out.unwrap();
    assert!((held_out.share - 1.0).abs() < 0.3, "{held_out:?}");
    for muscle in &found.muscles {
        assert!(muscle.estimation.together_n < muscle.estimation.base_n, "{muscle:?}");
        let residual = muscle.holdout.unwrap();
        assert!(residual.together_n < 1.05 * residual.alone_n, "{residual:?}");
    }
}

#[test]
fn held_out_recordings_deny_an_effect_of_the_rig_that_they_do_not_have() {
    let denied = found(&said(&rig(&[Concealed::new("channel-delay", 1.0)], Some(&[])), ""));
    // A lag of the pressure is nearly what a delay is, and is denied with it.
    let is_late = |id: &String| ["channel-delay", "pressure-lag"].contains(&id.as_str());
    assert!(denied.rig.is_empty() && denied.denied.iter().all(is_late), "{}", denied.statement);
    assert!(denied.statement.contains("Held-out recordings do not show channel-delay"), "{}", denied.statement);
    assert!(denied.muscles.iter().all(|muscle| muscle.effects.is_empty()), "{}", denied.statement);
}

#[test]
fn a_group_gives_the_same_bytes_on_any_number_of_threads() {
    assert!(said(plain(), "--threads 1") == said_of_plain());
}

#[test]
fn a_group_that_cannot_be_is_refused_with_the_remedy_and_leaves_no_file() {
    let desk = plain();
    let text = std::fs::read_to_string(desk.path("rig.toml")).unwrap();
    let refused = |text: &str, arguments: &str, words: &str| {
        std::fs::write(desk.path("other.toml"), text).unwrap();
        let output = desk.run(&format!("{arguments} --group other.toml --out refused.json"));
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(words), "{message}");
        assert!(!desk.path("refused.json").exists());
    };
    refused(&text, "soft-minor-loops.csv", "give none on the command line");
    refused("", "", "other.toml: it has 0 [[muscle]]; a group has 2 muscles of one rig at least");
    refused(&text.replace("\"stiff\"", "\"soft\""), "", "two muscles are called \"soft\"");
    std::fs::copy(desk.path("soft-minor-loops.csv"), desk.path("copy.csv")).unwrap();
    refused(&text.replace("stiff-minor-loops.csv", "copy.csv"), "", "is the same recording as soft-minor-loops.csv");
    refused(&text.replace("logs", "files"), "", "unknown field `files`");
}

#[test]
fn the_schema_is_published_and_obeyed() {
    let output = plain().run("--schema=group");
    assert!(output.stdout == SCHEMA.as_bytes(), "the published schema is stale; run scripts/schemas");
    let artifact = serde_json::to_value(found(said_of_plain())).unwrap();
    jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &artifact).unwrap();
    assert_eq!(artifact["schema"], "pam-group/1");
}
