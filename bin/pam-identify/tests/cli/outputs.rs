//! Outputs, and where they go.

use crate::bench::{Bench, SCHEMA, TAIL, shipped};

#[test]
fn the_same_inputs_give_the_same_bytes_on_any_number_of_threads() {
    let bench = Bench::new();
    let of = |threads: usize| {
        let name = format!("model{threads}.json");
        let arguments =
            format!("good.csv --muscle m.toml --threads {threads} --quiet --out {name} --figure fit{threads}.svg");
        assert_eq!(bench.run(&arguments).status.code(), Some(0));
        let read = |name: String| std::fs::read(bench.folder.path().join(name)).unwrap();
        (read(name), read(format!("fit{threads}.svg")))
    };
    let one = of(1);
    assert_eq!(one, of(2));
    assert_eq!(one, of(5));
}

#[test]
fn a_check_writes_nothing_and_a_quiet_run_says_nothing() {
    let bench = Bench::new();
    let output = bench.run(&format!("good.csv {TAIL} --check"));
    assert_eq!(output.status.code(), Some(0));
    assert!(!bench.folder.path().join("model.json").exists());
    let output = bench.run(&format!("good.csv {TAIL} --quiet"));
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout.is_empty() && output.stderr.is_empty());
}

#[test]
fn the_artifact_goes_to_standard_output_and_obeys_its_schema() {
    let bench = Bench::new();
    let output = bench.run("good.csv --muscle m.toml --out - --unbounded --quiet");
    let mut artifact: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(artifact["effects"].as_array().unwrap().len(), 0);
    assert!(bench.run("--schema").stdout == SCHEMA.as_bytes(), "the published schema is stale; run scripts/schemas");
    let schema: serde_json::Value = serde_json::from_str(SCHEMA).unwrap();
    jsonschema::validate(&schema, &artifact).unwrap();
    artifact["schema"] = "pam-model/2".into();
    assert!(!jsonschema::is_valid(&schema, &artifact), "a schema is of one kind and version");
}

#[test]
fn the_example_is_a_muscle_file_that_is_accepted_unchanged() {
    let bench = Bench::new();
    let output = bench.run("--example");
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("# "), "it is commented");
    let output_to_file = bench.run("--example --out mine.toml");
    assert_eq!(String::from_utf8(output_to_file.stderr).unwrap(), "note: wrote mine.toml; fill in what you measured\n");
    assert_eq!(std::fs::read(bench.folder.path().join("mine.toml")).unwrap(), output.stdout);
    let output = bench.run("good.csv --muscle mine.toml --check");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(bench.refusal("good.csv --example --out model.json").contains("cannot be used with"));
}

#[test]
fn machines_get_an_error_with_its_place() {
    let bench = Bench::new();
    bench.file("bad.csv", "time_s,pressure_kPa,length_mm,force_N\n0,100,200,1\n1,x,200,2\n");
    let output = bench.run(&format!("bad.csv {TAIL} --format json"));
    assert_eq!(output.status.code(), Some(2));
    let line: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
    assert_eq!(
        (&line["level"], &line["path"], &line["line"], &line["column"]),
        (&"error".into(), &"bad.csv".into(), &3.into(), &2.into())
    );
    let output = bench.run(&format!("good.csv {TAIL} --format json"));
    let said = String::from_utf8(output.stderr).unwrap();
    let levels: Vec<String> = said
        .lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap()["level"].as_str().unwrap().to_owned())
        .collect();
    assert!(levels.contains(&"table".to_owned()) && levels.last().is_some_and(|level| level == "note"), "{levels:?}");
}

#[test]
fn a_matlab_file_gives_the_model_that_its_columns_give() {
    let bench = Bench::new();
    bench.file("good.mat", level_5(&shipped("isobaric-triangles.csv")));
    let arguments = "--muscle m.toml --quiet --map pressure_kPa=p_meas";
    assert_eq!(bench.run(&format!("good.mat {arguments} --out mat.json")).status.code(), Some(0));
    bench.file("named.csv", shipped("isobaric-triangles.csv").replacen("pressure_kPa", "p_meas", 1));
    assert_eq!(bench.run(&format!("named.csv {arguments} --out csv.json")).status.code(), Some(0));
    let model = |name: &str| pam_artifact::ModelArtifact::read(&bench.folder.path().join(name)).unwrap().0;
    assert_eq!(model("mat.json").parameters, model("csv.json").parameters);
    let said = bench.refusal("good.mat --muscle m.toml --out model.json");
    assert!(said.starts_with("error: good.mat: no column gives pressure"), "{said}");
}

/// A MATLAB file with a vector per column of `csv`.
fn level_5(csv: &str) -> Vec<u8> {
    let mut lines = csv.lines();
    let names = lines.next().unwrap().replace("pressure_kPa", "p_meas");
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect();
    let element = |kind: u32, data: &[u8]| {
        let mut bytes = [kind.to_le_bytes(), (data.len() as u32).to_le_bytes()].concat();
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    };
    let mut file = vec![b' '; 124];
    file.extend(b"\0\x01IM");
    for (column, name) in names.split(',').enumerate() {
        let numbers: Vec<u8> = rows.iter().flat_map(|row| row[column].to_le_bytes()).collect();
        let parts = [
            element(6, &[6_u32.to_le_bytes(), [0; 4]].concat()),
            element(5, &[(rows.len() as u32).to_le_bytes(), 1_u32.to_le_bytes()].concat()),
            element(1, name.as_bytes()),
            element(9, &numbers),
        ];
        file.extend(element(14, &parts.concat()));
    }
    file
}
