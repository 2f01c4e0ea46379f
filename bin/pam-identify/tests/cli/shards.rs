//! Recordings in several files: the model of all, and what does not go together.

use pam_artifact::ModelArtifact;

use crate::bench::{Bench, TAIL, shipped};

const SUMMARY: &str = include_str!("../../../../crates/artifact/schemas/pam-summary-1.json");
const AGREEMENT: &str = include_str!("../../../../crates/artifact/schemas/pam-agreement-1.json");

/// The good recording in three files, and another one.
fn cut() -> Bench {
    let bench = Bench::new();
    let text = shipped("isobaric-triangles.csv");
    let mut lines = text.split_inclusive('\n');
    let header = lines.next().unwrap();
    let rows: Vec<&str> = lines.collect();
    for (name, part) in [("a", 0..1703), ("b", 1703..1709), ("c", 1709..rows.len())] {
        bench.file(&format!("{name}.csv"), format!("{header}{}", rows[part].concat()));
    }
    bench.file("ramps.csv", shipped("isometric-ramps.csv"));
    bench
}

const SHARDS: [(&str, &str); 4] =
    [("a", "--shard run:1/3"), ("b", "--shard run:2/3"), ("c", "--shard run:3/3"), ("ramps", "")];

fn summarize(bench: &Bench, options: &str) {
    for (name, shard) in SHARDS {
        let words =
            format!("{name}.csv {shard} --muscle m.toml --summary-only --agreement agreed.json --out {name}.json");
        let output = bench.run(&format!("{words} {options}"));
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

const MERGE: &str =
    "--from-summaries a.json b.json c.json ramps.json --agreement agreed.json --muscle m.toml --out model.json";

/// Runs passes until there is a model; gives its bytes and how many there were.
fn passes(bench: &Bench, options: &str) -> (Vec<u8>, usize) {
    let model = bench.folder.path().join("model.json");
    for pass in 1..=12 {
        summarize(bench, options);
        let output = bench.run(&format!("{MERGE} {options}"));
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        if model.exists() {
            return (std::fs::read(model).unwrap(), pass);
        }
    }
    panic!("no model after twelve passes");
}

#[test]
fn shards_give_the_model_of_the_whole_on_any_number_of_threads() {
    let bench = cut();
    assert_eq!(bench.run(&format!("good.csv ramps.csv {TAIL} --quiet")).status.code(), Some(0));
    let model = bench.folder.path().join("model.json");
    let (whole, _) = ModelArtifact::read(&model).unwrap();
    std::fs::remove_file(&model).unwrap();
    let (one_thread, n_passes) = passes(&bench, "--threads 1");
    assert!(n_passes <= 8, "{n_passes}");
    let (shards, _) = ModelArtifact::read(&model).unwrap();
    assert_eq!(shards.parameters, whole.parameters);
    assert_eq!(shards.composites, whole.composites);
    assert_eq!(shards.correlation, whole.correlation);
    assert_eq!(shards.domain, whole.domain);
    assert_eq!(shards.direction, whole.direction);
    assert!((shards.fit.estimation.rmse_n / whole.fit.estimation.rmse_n - 1.0).abs() < 1e-12);
    let schema = |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap();
    let file = |name: &str| schema(&std::fs::read_to_string(bench.folder.path().join(name)).unwrap());
    jsonschema::validate(&schema(SUMMARY), &file("a.json")).unwrap();
    jsonschema::validate(&schema(AGREEMENT), &file("agreed.json")).unwrap();
    for name in ["model.json", "agreed.json"] {
        std::fs::remove_file(bench.folder.path().join(name)).unwrap();
    }
    assert!(passes(&bench, "--threads 2").0 == one_thread, "threads change the model");
}

#[test]
fn published_schemas_of_shards_are_those_of_the_program() {
    let bench = Bench::new();
    assert!(bench.run("--schema=summary").stdout == SUMMARY.as_bytes(), "run scripts/schemas");
    assert!(bench.run("--schema=agreement").stdout == AGREEMENT.as_bytes(), "run scripts/schemas");
}

#[test]
fn what_does_not_go_together_is_one_line() {
    let bench = cut();
    summarize(&bench, "");
    let of = |names: &str| format!("--from-summaries {names} --agreement agreed.json --muscle m.toml --out model.json");
    let says = |arguments: &str, expected: &str| {
        let refused = bench.refusal(arguments);
        assert!(refused.contains(expected), "{refused}\nexpected: {expected}");
    };
    says(&of("a.json c.json"), "run: shard 2 of 3 is missing; name its summary, too");
    says(&of("a.json b.json"), "run: shard 3 of 3 is missing");
    says(&of("a.json b.json c.json b.json"), "b.csv: is there twice (run:2/3 and run:2/3)");
    let shard = |words: &str| {
        let output = bench.run(&format!("{words} --summary-only"));
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    };
    shard("a.csv --shard run:2/3 --muscle m.toml --out twice.json");
    says(&of("a.json twice.json c.json"), "a.csv: is there twice (run:1/3 and run:2/3)");
    shard("good.csv --shard run:2/3 --muscle m.toml --out over.json");
    says(&of("a.json over.json c.json"), "run: shard 2 begins at 0.000 s, before shard 1 ends at");
    shard("b.csv --shard run:2/4 --muscle m.toml --out four.json");
    says(&of("a.json four.json c.json"), "one shard says that there are 3 of them, another 4");
    let muscle = std::fs::read_to_string(bench.folder.path().join("m.toml")).unwrap();
    bench.file("other.toml", format!("# another\n{muscle}"));
    shard("b.csv --shard run:2/3 --muscle other.toml --out other.json");
    says(&of("a.json other.json c.json"), "b.csv: was made with another muscle file than a.csv");
    shard("b.csv --shard run:2/3 --muscle m.toml --skip-bad-rows --out read.json");
    says(&of("a.json read.json c.json"), "b.csv: was made with another set of options of reading than a.csv");
    says("--from-summaries a.json --agreement agreed.json --muscle other.toml --out model.json", "another muscle file");
    says("a.csv b.csv --muscle m.toml --summary-only --out s.json", "--summary-only takes one recording");
    says("a.csv --muscle m.toml --summary-only --loss huber --out s.json", "identify in one for it");
    says("a.csv --muscle m.toml --summary-only --form as-printed --out s.json", "identify in one for --form");
    says(&format!("a.csv {TAIL} --shard run:2"), "");
    let version = std::fs::read_to_string(bench.folder.path().join("b.json")).unwrap();
    bench.file("version.json", version.replacen("\"version\":\"", "\"version\":\"9", 1));
    says(&of("a.json version.json c.json"), "b.csv: its summary is by pam-identify 9");
    bench.file("schema.json", version.replacen("pam-summary/1", "pam-summary/2", 1));
    says(&of("a.json schema.json c.json"), "schema is \"pam-summary/2\", expected \"pam-summary/1\"");

    // The second pass.
    assert_eq!(bench.run(MERGE).status.code(), Some(0));
    says(MERGE, "a.csv: answers pass 1, and pass 2 is asked for; run it again");
    says(&of("a.json b.json c.json"), "the agreement is of other shards");
    says(&format!("{MERGE} --seed 2"), "was begun with other options of the fit");
    says(
        "good.csv --muscle m.toml --summary-only --agreement agreed.json --out s.json",
        "good.csv: the agreement is of other",
    );
}
