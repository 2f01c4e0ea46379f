//! Effects of a user's own, empirical terms, and what is explained.

use pam_artifact::DiagnosisArtifact;
use pam_artifact::diagnosis::Verdict;
use pam_report::number::significant;

use crate::desk::{Desk, HELD, LOGS};

const GUARD: &str = r#"
[[effect]]
id = "touching-guard"
name = "a guard that touches the muscle"
driver = "contraction"
shape = { bump = { center = [0.02, 0.25], width = [0.005, 0.05] } }
amplitude = [-300.0, 300.0]
"#;

#[test]
fn an_effect_of_a_users_own_is_named_and_its_model_works_without_its_file() {
    let desk = Desk::touched();
    desk.file("guard.toml", GUARD);
    let (diagnosis, model) = desk.diagnosed(
        &format!(
            "{LOGS} --model model.json {HELD} --effects guard.toml --out diagnosis.json --out-model augmented.json"
        ),
        0,
    );
    assert_eq!(diagnosis.effects[0].id, "touching-guard");
    assert!((diagnosis.effects[0].parameters[0].value - 0.1).abs() < 3e-3, "{:?}", diagnosis.effects[0]);
    let fit = diagnosis.fit.holdout.unwrap();
    assert!(fit.rmse_after_n < 0.5 * fit.rmse_before_n, "{fit:?}");
    assert!(model.effects.iter().any(|entry| entry.sentence.is_some()));
    let text = String::from_utf8(desk.run("--effects guard.toml --explain touching-guard").stdout).unwrap();
    assert!(text.starts_with("A guard that touches the muscle (touching-guard)\n"), "{text}");
}

#[test]
fn the_gain_of_an_empirical_term_is_one_number_in_artifact_statement_table_and_report() {
    let desk = Desk::touched();
    // What the catalogue has for a force over the length, so that it stays without a name.
    let excluded = "--exclude braid-lockup --exclude end-taper --exclude series-compliance";
    let output = desk.run(&format!("{LOGS} --model model.json {HELD} {excluded} --out terms.json --report terms.html"));
    let (diagnosis, _) = DiagnosisArtifact::read(&desk.path("terms.json")).unwrap();
    let statement = &diagnosis.statement;
    assert_eq!((diagnosis.verdict, diagnosis.effects.len()), (Verdict::Unexplained, 0), "{statement}");
    assert_eq!((output.status.code(), diagnosis.unexplained_share), (Some(1), 1.0));
    let (fit, term) = (diagnosis.fit.holdout.unwrap(), diagnosis.empirical.unwrap().holdout.unwrap());
    assert_eq!((term.rmse_without_n, term.rmse_with_n), (fit.rmse_before_n, fit.rmse_after_n));
    let [before, after] = [fit.rmse_before_n, fit.rmse_after_n].map(|rmse_n| format!("{rmse_n:.2}"));
    assert!(statement.contains(&format!("RMSE on held-out recordings from {before} to {after} N")), "{statement}");
    let table = String::from_utf8(output.stderr).unwrap();
    let [before, after] = [fit.rmse_before_n, fit.rmse_after_n].map(|rmse_n| significant(rmse_n, 3));
    assert!(table.contains(&format!("RMSE on held-out recordings: {before} → {after} N.")), "{table}");
    let report = std::fs::read_to_string(desk.path("terms.html")).unwrap();
    // A card shows two digits below 1 N, as many decimals as above it.
    let [before, after] =
        [fit.rmse_before_n, fit.rmse_after_n].map(|rmse_n| significant(rmse_n, if rmse_n < 0.995 { 2 } else { 3 }));
    let card = format!("{before} N → {after} N");
    assert!(report.contains(&format!(">{card}<")), "no card says {card}");
}

#[test]
fn a_file_of_effects_that_cannot_be_used_is_refused_with_the_place() {
    let desk = Desk::plain();
    let refusal = |text: &str| {
        desk.file("own.toml", text);
        let output = desk.run("--effects own.toml --explain all");
        assert_eq!(output.status.code(), Some(2), "{text}");
        String::from_utf8(output.stderr).unwrap()
    };
    let messages = [
        refusal(""),
        refusal("[[effect]]\nid = 3\n"),
        refusal(&GUARD.replace("touching-guard", "slack")),
        refusal(&GUARD.replace("[0.005, 0.05]", "[0.05, 0.005]")),
    ];
    insta::assert_snapshot!(messages.concat(), @r#"
    error: own.toml: it has no [[effect]]; configs/effects/touching-guard.toml shows one
    error: own.toml: line 2, column 6: invalid type: integer `3`, expected a string
    error: own.toml: effect "slack": the id is taken; give it another
    error: own.toml: effect "touching-guard": width is no range; give its ends as [low, high], both above zero
    "#);
}

#[test]
fn every_effect_is_explained_and_drawn() {
    let desk = Desk::plain();
    let list = String::from_utf8(desk.run("--explain all").stdout).unwrap();
    let ids: Vec<&str> = list.lines().skip(2).filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(ids.len(), pam_muscle::effects::CATALOGUE.len());
    for id in ids {
        let output = desk.run(&format!("--explain {id} --figure {id}.svg --quiet"));
        assert_eq!(output.status.code(), Some(0), "{id}");
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains(&format!("({id})")), "{text}");
        assert!(["Equation", "Signature", "Confused with", "Test"].iter().all(|title| text.contains(title)), "{text}");
        assert!(text.lines().filter(|line| !line.contains('─')).all(|line| line.chars().count() < 160), "{text}");
        assert!(std::fs::read_to_string(desk.path(&format!("{id}.svg"))).unwrap().starts_with("<svg"));
    }
}
