//! The program as a person meets it: messages, exit codes, files that are there or not.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

fn shipped(name: &str) -> String {
    std::fs::read_to_string(root().join("datasets/bench-nominal").join(name)).unwrap()
}

/// A folder with the muscle file and one good recording.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::copy(root().join("configs/muscle-nominal.toml"), folder.path().join("m.toml")).unwrap();
        std::fs::write(folder.path().join("good.csv"), shipped("isobaric-triangles.csv")).unwrap();
        Self { folder }
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.folder.path().join(name), content).unwrap();
        self
    }

    fn run(&self, arguments: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pam-identify"))
            .args(arguments.split(' ').filter(|word| !word.is_empty()).map(|word| word.replace('~', " ")))
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }

    /// The one line of an error; nothing may have been written.
    fn refusal(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(output.stdout.is_empty());
        assert!(!self.folder.path().join("model.json").exists(), "an output was written");
        let left: Vec<_> = std::fs::read_dir(self.folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.starts_with('.'))
            .collect();
        assert!(left.is_empty(), "left behind: {left:?}");
        let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
        assert_eq!(errors.len(), 1, "{stderr}");
        errors[0].to_owned()
    }
}

/// The good recording with every row changed: time s, pressure kPa, length mm, force N in and out.
fn reworked(change: impl Fn(usize, [f64; 4]) -> [f64; 4]) -> String {
    let mut text = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
    for (index, line) in shipped("isobaric-triangles.csv").lines().skip(1).enumerate() {
        let mut fields = line.split(',').map(|field| field.parse::<f64>().unwrap());
        let row = [(); 4].map(|()| fields.next().unwrap());
        let [t, p, l, f] = change(index, row);
        text.push_str(&format!("{t},{p},{l},{f}\n"));
    }
    text
}

const TAIL: &str = "--muscle m.toml --out model.json";

/// The published schema.
const SCHEMA: &str = include_str!("../../../crates/core/schemas/pam-model-1.json");

#[test]
fn every_bad_recording_gets_one_line_with_place_and_remedy() {
    let bench = Bench::new();
    let header = "time_s,pressure_kPa,length_mm,force_N\n";
    let rows = "0,100,260,50\n0.01,110,259,55\n0.02,120,258,60\n";
    let with_row = |row: &str| format!("{header}{rows}{row}\n0.04,120,258,60\n");
    let cases: Vec<(&str, String, &str)> = vec![
        (
            "empty file",
            String::new(),
            "bad.csv: the file holds no rows; record again, or check that the logger closed the file",
        ),
        (
            "header only",
            header.to_owned(),
            "bad.csv: there are no rows; record again, or check that the logger closed the file",
        ),
        (
            "one row",
            format!("{header}0,100,260,50\n"),
            "bad.csv: there is only one row; at least 2 are needed: record for longer",
        ),
        (
            "missing column",
            "time_s,pressure_kPa,length_mm\n0,100,260\n0.01,110,259\n".to_owned(),
            "bad.csv: no column gives force; name a column force_N in the header, point to one with --map force_N=COLUMN, or give a constant with --fixed force_N=VALUE (the file has time_s, pressure_kPa, length_mm)",
        ),
        (
            "misspelt column",
            "time_s,presure_kPa,length_mm,force_N\n0,100,260,50\n0.01,110,259,55\n".to_owned(),
            "bad.csv:1:2: unknown column \"presure_kPa\"; did you mean pressure_kPa?",
        ),
        (
            "unknown unit",
            "time_s,pressure_atm,length_mm,force_N\n0,1,260,50\n0.01,1,259,55\n".to_owned(),
            "bad.csv:1:2: unknown unit \"atm\" of column \"pressure_atm\"; pressure can be in kPa, Pa, MPa, bar or psi, for example pressure_kPa (for other units see --calibrate)",
        ),
        (
            "duplicate header",
            "time_s,pressure_kPa,length_mm,force_N,force_N\n0,1,260,50,50\n0.01,1,259,55,55\n".to_owned(),
            "bad.csv:1:5: column \"force_N\" gives force again after \"force_N\"; rename one of them in the header",
        ),
        (
            "text in a number",
            with_row("0.03,abc,258,60"),
            "bad.csv:5:2: \"abc\" in column \"pressure_kPa\" is not a number; correct the row, or drop such rows with --skip-bad-rows",
        ),
        (
            "NaN",
            with_row("0.03,120,nan,60"),
            "bad.csv:5:3: \"nan\" in column \"length_mm\" is not finite; correct the row, or drop such rows with --skip-bad-rows",
        ),
        (
            "infinity",
            with_row("0.03,120,258,inf"),
            "bad.csv:5:4: \"inf\" in column \"force_N\" is not finite; correct the row, or drop such rows with --skip-bad-rows",
        ),
        (
            "clock running back",
            with_row("0.01,120,258,60"),
            "bad.csv:5:1: the clock runs back from 0.02 s to 0.01 s; cut the file there if the logger started anew, or drop such rows with --skip-bad-rows",
        ),
        (
            "short row",
            with_row("0.03,120,258"),
            "bad.csv:5:4: 3 fields where the header has 4; correct the row, or drop such rows with --skip-bad-rows",
        ),
        (
            "constant force",
            reworked(|_, [t, p, l, _]| [t, p, l, 20.0]),
            "bad.csv: force never varies (it is 20 N in every row); check the load cell and the column that holds it, or for a dead weight leave the column out and give --fixed force_N=20",
        ),
        (
            "constant time",
            reworked(|_, [_, p, l, f]| [1.0, p, l, f]),
            "bad.csv: time never varies (it is 1 s in every row); check the logger's clock and the column that holds it",
        ),
        (
            "too few rows",
            format!("{header}{rows}"),
            "bad.csv: 3 samples for 8 parameters; at least 26 are needed, record for longer",
        ),
        (
            "kPa under a header that says bar",
            reworked(|_, r| r).replace("pressure_kPa", "pressure_bar"),
            "bad.csv: pressure reaches 50188.000 kPa, 100 times too high; kPa under a header that says bar is a factor of 100; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "bar under a header that says kPa",
            reworked(|_, [t, p, l, f]| [t, 0.01 * p, l, f]),
            "bad.csv: pressure reaches 5.019 kPa, 100 times too low; bar under a header that says kPa is a factor of 100; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "milliseconds under a header that says seconds",
            reworked(|i, [_, p, l, f]| [1000.0 * i as f64, p, l, f]),
            "bad.csv: time reaches 9505000 s, one row every 1000 s, 1000 times too high; ms under a header that says s is a factor of 1000; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "seconds under a header that says milliseconds",
            reworked(|_, r| r).replace("time_s", "time_ms"),
            "bad.csv: time reaches 0.0950 s in 9506 rows, 1000 times too low; s under a header that says ms is a factor of 1000; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "millimeters under a header that says meters",
            reworked(|_, r| r).replace("length_mm", "length_m"),
            "bad.csv: length reaches 268444.000 mm, 1000 times too high; mm under a header that says m is a factor of 1000; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "kilonewtons under a header that says newtons",
            reworked(|_, [t, p, l, f]| [t, p, l, 1e-3 * f]),
            "bad.csv: force reaches 1.119 N, 1000 times too low; kN under a header that says N is a factor of 1000; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "force of the wrong sign",
            reworked(|_, [t, p, l, f]| [t, p, l, -f]),
            "bad.csv: force falls as pressure rises (correlation -0.98), so its sign is turned; tension is positive: add --calibrate 'force_N = -1 * force_N', or go on with --accept-implausible",
        ),
        (
            "pressure and force swapped",
            reworked(|_, [t, p, l, f]| [t, f, l, p]),
            "bad.csv: pressure and force look swapped (correlation with an ideal muscle 0.59 as they are, 0.98 the other way round); exchange their names with --map, or go on with --accept-implausible",
        ),
        (
            "pressure and length swapped",
            reworked(|_, [t, p, l, f]| [t, l, p, f]),
            "bad.csv: pressure and length look swapped (correlation with an ideal muscle 0.75 as they are, 0.98 the other way round); exchange their names with --map, or go on with --accept-implausible",
        ),
        (
            "another muscle",
            reworked(|_, [t, p, l, f]| [t, p, l + 60.0, f]),
            "bad.csv: length runs from 270.8 to 328.4 mm, which a muscle of rest length 267.0 mm cannot have (it would be stretched by more than a tenth, or its strands straight); check that the recording and the muscle file belong together, or go on with --accept-implausible",
        ),
    ];
    for (name, content, expected) in cases {
        bench.file("bad.csv", content);
        let said = bench.refusal(&format!("bad.csv {TAIL}"));
        assert_eq!(said, format!("error: {expected}"), "{name}");
    }
}

#[test]
fn a_short_piece_of_a_small_loop_has_its_channels_where_they_are() {
    let bench = Bench::new();
    let steps = shipped("length-steps.csv");
    let piece: Vec<&str> = steps.lines().take(1).chain(steps.lines().skip(46).take(261)).collect();
    bench.file("piece.csv", piece.join("\n"));
    let output = bench.run(&format!("piece.csv --check {TAIL}"));
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn one_pressure_is_fitted_with_a_word_where_its_gauge_is_alive() {
    let bench = Bench::new();
    let at_300_kpa = |text: &str| -> String {
        let rows = text.lines().enumerate().filter(|(line, text)| {
            *line == 0 || text.split(',').nth(1).is_some_and(|p| (p.parse::<f64>().unwrap() - 300.0).abs() < 1.5)
        });
        rows.map(|(_, text)| format!("{text}\n")).collect()
    };
    bench.file("one.csv", at_300_kpa(&shipped("isobaric-triangles.csv")));
    let output = bench.run(&format!("one.csv {TAIL}"));
    let said = String::from_utf8(output.stderr).unwrap();
    assert_ne!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("trust this model at that pressure alone, or add a recording at another"), "{said}");
}

#[test]
fn every_bad_command_line_gets_one_line_with_the_remedy() {
    let bench = Bench::new();
    bench.file("flat.csv", reworked(|_, [t, _, l, f]| [t, 300.0, l, f]));
    bench.file("worse.toml", "rest_length_mm = 267\nrest_radius_mm = 10\nbraid_angle = 25\n");
    bench.file("other.csv", reworked(|_, [t, p, l, f]| [t, p, l, 1.8 * f]));
    bench.file("sub", "");
    let cases: Vec<(String, &str)> = vec![
        (format!("missing.csv {TAIL}"), "missing.csv: no such file; check the path"),
        (format!(". {TAIL}"), ".: is a directory; name the recordings in it"),
        (
            format!("flat.csv {TAIL}"),
            "flat.csv: pressure stays at 300.0 kPa in every estimation recording, which cannot tell the gas from the rubber; add a recording at another pressure",
        ),
        (
            format!("good.csv other.csv {TAIL}"),
            "other.csv: at equal pressure and length the force is 1.80 times that of good.csv; they are of different muscles, or a gain changed between them: identify them apart, or go on with --accept-implausible",
        ),
        (
            format!("good.csv --holdout good.csv {TAIL}"),
            "good.csv: is fitted and held out as well; hold out a recording that the fit does not see",
        ),
        (
            format!("good.csv --holdout other.csv {TAIL}"),
            "other.csv: at equal pressure and length the force is 1.80 times that of good.csv; they are of different muscles, or a gain changed between them: identify them apart, or go on with --accept-implausible",
        ),
        (
            "good.csv --muscle none.toml --out model.json".to_owned(),
            "cannot read muscle file none.toml: no such file; check the path",
        ),
        (
            "good.csv --muscle worse.toml --out model.json".to_owned(),
            "worse.toml:3:1: unknown field `braid_angle`; did you mean `braid_angle_deg`?",
        ),
        (
            "good.csv --muscle m.toml --out sub/model.json".to_owned(),
            "cannot write sub/model.json: sub is not a folder; name another path",
        ),
        (
            "good.csv --muscle m.toml --out nowhere/model.json".to_owned(),
            "cannot write nowhere/model.json: folder nowhere does not exist; create it with `mkdir -p nowhere`",
        ),
        (
            "good.csv --muscle m.toml --out good.csv".to_owned(),
            "cannot write good.csv: it is also an input, which the run would destroy; name another",
        ),
        ("good.csv --muscle m.toml --out .".to_owned(), "cannot write .: it is a folder; name a file inside it"),
        (
            "good.csv --muscle m.toml --out /dev/full".to_owned(),
            "cannot write /dev/full: no space left on the device; free some or name a path elsewhere",
        ),
        (
            "good.csv --muscle m.toml".to_owned(),
            "the following required arguments were not provided: --out <MODEL.json>; see --help",
        ),
        (
            format!("good.csv {TAIL} --fix k4=1"),
            "invalid value 'k4=1' for '--fix <NAME=VALUE>': no parameter is called \"k4\"; expected one of k1, k2, k3, c10, c01, strand_modulus, rubber_friction, strand_friction; see --help",
        ),
        (
            format!("good.csv {TAIL} --fix strand_modulus=0"),
            "invalid value 'strand_modulus=0' for '--fix <NAME=VALUE>': strand_modulus cannot be 0; give 1e6 to 1e18; see --help",
        ),
        (
            format!("good.csv {TAIL} --free k1"),
            "invalid value 'k1' for '--free <NAME>': expected c01 or strand_friction; see --help",
        ),
        (
            format!("good.csv {TAIL} --map pressure_kPa=volt"),
            "good.csv: --map names column \"volt\", which the file lacks; it has time_s, pressure_kPa, length_mm, force_N",
        ),
        (
            format!("good.csv {TAIL} --columns time_s,force_N"),
            "good.csv:1:1: the file has a header of its own; leave --columns away and rename its columns with --map",
        ),
        (
            format!("good.csv {TAIL} --calibrate pressure_kPa~=~sin(x)"),
            "invalid value 'pressure_kPa = sin(x)' for '--calibrate <NAME=LINE>': '(' cannot be used in \"sin(x)\"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'; see --help",
        ),
        (
            format!("good.csv {TAIL} --max-rmse-n -1"),
            "invalid value '-1' for '--max-rmse-n <X>': expected a number above 0; see --help",
        ),
        (
            format!("good.csv {TAIL} --holdut x.csv"),
            "unexpected argument '--holdut' found; did you mean --holdout? See --help",
        ),
    ];
    for (arguments, expected) in cases {
        assert_eq!(bench.refusal(&arguments), format!("error: {expected}"), "{arguments}");
    }
}

#[test]
fn the_remedies_that_the_messages_name_do_help() {
    let bench = Bench::new();
    bench.file("turned.csv", reworked(|_, [t, p, l, f]| [t, p, l, -f]));
    bench.file("swapped.csv", reworked(|_, [t, p, l, f]| [t, f, l, p]));
    bench.file("slip.csv", reworked(|_, row| row).replace("pressure_kPa", "pressure_bar"));
    bench.file("rows.csv", format!("{}nonsense\n", shipped("isobaric-triangles.csv")));
    for arguments in [
        "turned.csv --calibrate force_N~=~-1~*~force_N",
        "swapped.csv --map pressure_kPa=force_N --map force_N=pressure_kPa",
        "slip.csv --map pressure_kPa=pressure_bar",
        "rows.csv --skip-bad-rows",
        "slip.csv --accept-implausible --check",
    ] {
        let output = bench.run(&format!("{arguments} {TAIL}"));
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments}: {said}");
    }
}

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
    let model = |name: &str| pam_core::artifact::ModelArtifact::read(&bench.folder.path().join(name)).unwrap().0;
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

#[test]
fn a_fit_above_the_limit_is_rejected_but_written() {
    let bench = Bench::new();
    let output = bench.run(&format!("good.csv {TAIL} --max-rmse-n 0.1"));
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).unwrap().contains("rejected: RMSE"));
    assert!(bench.folder.path().join("model.json").exists());
}

#[test]
fn the_pure_swarm_says_that_it_was_not_polished() {
    let bench = Bench::new();
    assert_eq!(bench.run(&format!("good.csv {TAIL} --no-polish")).status.code(), Some(0));
    let (artifact, _) = pam_core::artifact::ModelArtifact::read(&bench.folder.path().join("model.json")).unwrap();
    assert!(!artifact.config.polish && !artifact.search.converged);
    assert!(artifact.search.starts.iter().all(|start| start.polished_rmse_n.is_none()));
}

#[test]
fn outliers_move_the_robust_fit_less() {
    let bench = Bench::new();
    // Every fiftieth force is 200 N too high: a loose contact.
    bench.file("loose.csv", reworked(|index, [t, p, l, f]| [t, p, l, if index % 50 == 0 { f + 200.0 } else { f }]));
    let k3_n = |arguments: &str| {
        assert_eq!(bench.run(&format!("{arguments} {TAIL} --quiet")).status.code(), Some(0));
        let (artifact, _) = pam_core::artifact::ModelArtifact::read(&bench.folder.path().join("model.json")).unwrap();
        artifact.parameters.iter().find(|entry| entry.name == "k3").unwrap().value
    };
    let (clean, square, huber) = (k3_n("good.csv"), k3_n("loose.csv"), k3_n("loose.csv --loss huber"));
    assert!((huber - clean).abs() < 0.3 && (square - clean).abs() > 2.0, "{clean} {square} {huber}");
}

#[test]
fn a_freed_braid_angle_comes_back() {
    let bench = Bench::new();
    for name in ["isometric-ramps", "minor-loops", "length-steps"] {
        bench.file(&format!("{name}.csv"), shipped(&format!("{name}.csv")));
    }
    let muscle = std::fs::read_to_string(root().join("configs/muscle-nominal.toml")).unwrap();
    // Measured two degrees wrong; k1 and k2, which mimic the angle, held at the truth.
    let wrong = muscle
        .replace("braid_angle_deg = 25.0", "braid_angle_deg = 27.0")
        .replace("fit = []", "fit = [\"braid_angle_deg\"]");
    assert_ne!(wrong, muscle);
    bench.file("wrong.toml", wrong);
    let output = bench.run(
        "good.csv isometric-ramps.csv minor-loops.csv length-steps.csv --muscle wrong.toml --fix k1=0.9 --fix k2=1.05 --out \
         model.json --quiet",
    );
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let (artifact, _) = pam_core::artifact::ModelArtifact::read(&bench.folder.path().join("model.json")).unwrap();
    let angle = artifact.parameters.iter().find(|entry| entry.name == "braid_angle").unwrap();
    let error_rad = (angle.value - 25.0_f64.to_radians()).abs();
    assert!(error_rad < 4.0 * angle.stderr.unwrap(), "{} ± {:?}", angle.value.to_degrees(), angle.stderr);
}

#[test]
fn a_closed_pipe_ends_the_run_without_a_word() {
    let bench = Bench::new();
    let mut child = Command::new(env!("CARGO_BIN_EXE_pam-identify"))
        .args("good.csv --muscle m.toml --out - --quiet".split(' '))
        .current_dir(bench.folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(said, "");
}

#[test]
fn a_muscle_file_from_a_pipe_is_read_once_and_hashed_as_it_was_parsed() {
    let bench = Bench::new();
    let text = std::fs::read(bench.folder.path().join("m.toml")).unwrap();
    let fifo = bench.folder.path().join("fifo.toml");
    assert!(Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    let writer = std::thread::spawn({
        let text = text.clone();
        move || std::fs::write(fifo, text).unwrap()
    });
    let output = bench.run("good.csv --muscle fifo.toml --out model.json --quiet");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    writer.join().unwrap();
    let model: serde_json::Value =
        serde_json::from_slice(&std::fs::read(bench.folder.path().join("model.json")).unwrap()).unwrap();
    assert_eq!(model["inputs"][0]["sha256"], pam_core::artifact::sha256_hex(&text).as_str());
}

#[test]
fn both_forms_are_compared_on_what_a_pipe_gave_once() {
    let bench = Bench::new();
    let log = std::fs::read(bench.folder.path().join("good.csv")).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_pam-identify"))
        .args(["-", "--muscle", "m.toml", "--out", "model.json", "--compare-forms"])
        .current_dir(bench.folder.path())
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::io::Write::write_all(&mut child.stdin.take().unwrap(), &log).unwrap();
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("as printed"), "{said}");
}

#[test]
fn a_parameter_is_held_once_and_not_fitted_as_well() {
    let bench = Bench::new();
    let cases = [
        ("--fix k3=0 --fix k3=1", "--fix holds k3 twice, at 0 and at 1; leave one of them out"),
        ("--free c01 --free c01", "--free names c01 twice; leave one of them out"),
        ("--fix c01=1e5 --free c01", "--fix holds c01 and --free fits it; leave one of them out"),
    ];
    for (options, expected) in cases {
        assert_eq!(bench.refusal(&format!("good.csv {options} {TAIL}")), format!("error: {expected}"));
    }
    let said = bench.refusal(&format!("good.csv --fix k1=1e300 {TAIL}"));
    assert!(said.contains("k1 cannot be 1e300; give -1e3 to 1e3"), "{said}");
}

#[test]
fn what_leaves_nothing_to_fit_is_said() {
    let bench = Bench::new();
    let all = "--fix k1=0.9 --fix k2=1 --fix k3=0 --fix c10=1e5 --fix c01=1e5 --fix strand_modulus=3e9 --fix \
               rubber_friction=1e-3 --fix strand_friction=0";
    let expected = "error: every parameter is held with --fix, and nothing is left to fit; leave one of them out";
    assert_eq!(bench.refusal(&format!("good.csv {all} {TAIL}")), expected);
    // Noise of the size of the force says nothing of anything.
    let noise = |row: usize| 4e4 * ((row * 7919 % 101) as f64 / 50.0 - 1.0);
    bench.file("noise.csv", reworked(|row, [t, p, l, _]| [t, p, l, noise(row)]));
    let said = bench.refusal(&format!("noise.csv --accept-implausible {TAIL}"));
    assert!(said.contains("noise.csv: these recordings can identify none of k1, k2, k3"), "{said}");
}

#[test]
fn a_dead_weight_gives_a_model_that_can_be_read() {
    let bench = Bench::new();
    let rows: String =
        reworked(|_, row| row).lines().skip(1).map(|line| format!("{}\n", line.rsplit_once(',').unwrap().0)).collect();
    bench.file("weight.csv", format!("time_s,pressure_kPa,length_mm\n{rows}"));
    let output = bench.run(&format!("weight.csv --fixed force_N=100 --accept-implausible {TAIL}"));
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", String::from_utf8_lossy(&output.stderr));
    let (model, _) = pam_core::artifact::ModelArtifact::read(&bench.folder.path().join("model.json")).unwrap();
    assert_eq!(model.fit.estimation.r2, 0.0);
}

#[test]
fn a_model_that_no_muscle_has_is_rejected_unless_it_is_asked_for() {
    let bench = Bench::new();
    // A load cell that shows 60 N without a muscle.
    bench.file("tare.csv", reworked(|_, [t, p, l, f]| [t, p, l, f + 60.0]));
    let output = bench.run(&format!("tare.csv {TAIL}"));
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("rejected: these are not the parameters of a muscle") && said.contains("k3 = "), "{said}");
    let config = |options: &str, code: i32| {
        let output = bench.run(&format!("{options} {TAIL} --quiet"));
        assert_eq!(output.status.code(), Some(code), "{options}");
        let text = std::fs::read(bench.folder.path().join("model.json")).unwrap();
        serde_json::from_slice::<serde_json::Value>(&text).unwrap()["config"].clone()
    };
    assert_eq!(config("tare.csv --accept-implausible", 0)["accept_implausible"], true);
    assert!(config("good.csv", 0).get("accept_implausible").is_none());
}

#[test]
fn strands_without_stretch_are_at_the_upper_end_and_those_of_aramid_are_plausible() {
    let bench = Bench::new();
    let output = bench.run(&format!("good.csv {TAIL} --accept-implausible --fix k1=0.5"));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(!said.contains("lower end of its range (1000"), "{said}");
}

#[test]
fn an_absolute_gauge_and_a_zero_that_is_off_are_named_beside_the_physics_that_does_the_same() {
    let bench = Bench::new();
    for (shift_kpa, words) in
        [(101.3, "the pressure is absolute"), (40.0, "the zero of the gauge is too high"), (-20.0, "too low")]
    {
        bench.file("shifted.csv", reworked(|_, [t, p, l, f]| [t, p + shift_kpa, l, f]));
        let output = bench.run(&format!("shifted.csv {TAIL}"));
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains(words), "{shift_kpa}: {said}");
        assert_eq!(said.contains("threshold pressure"), shift_kpa > 0.0, "{said}");
    }
}

#[test]
fn a_spike_is_located_and_does_not_count_and_one_beyond_everything_is_refused() {
    let bench = Bench::new();
    let with_spike = |by_n: f64| reworked(move |row, [t, p, l, f]| [t, p, l, if row == 4000 { f + by_n } else { f }]);
    bench.file("high.csv", with_spike(5000.0));
    let said = bench.refusal(&format!("high.csv {TAIL}"));
    assert!(
        said.contains("high.csv: force leaps from its neighbors and back: 6118.720 N at 40.000 s")
            && said.contains("(row 4001)"),
        "{said}"
    );
    let rmse = |log: &str| {
        let output = bench.run(&format!("{log} {TAIL}"));
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let (model, _) = pam_core::artifact::ModelArtifact::read(&bench.folder.path().join("model.json")).unwrap();
        (model.fit.estimation, model.warnings)
    };
    let (clean, _) = rmse("good.csv");
    bench.file("low.csv", with_spike(300.0));
    let (spiked, warnings) = rmse("low.csv");
    assert!((spiked.rmse_n - clean.rmse_n).abs() < 0.01, "{} {}", spiked.rmse_n, clean.rmse_n);
    assert_eq!(spiked.n_unsettled, clean.n_unsettled + 1);
    assert!(
        warnings.iter().any(|words| words.contains("low.csv: a sample leaps") && words.contains("(row 4001)")),
        "{warnings:?}"
    );
}

#[test]
fn a_force_that_freezes_half_way_is_refused_with_the_time() {
    let bench = Bench::new();
    let at = std::cell::Cell::new(0.0);
    let text = reworked(|row, [t, p, l, f]| {
        if row <= 4700 {
            at.set(f);
        }
        [t, p, l, at.get()]
    });
    bench.file("frozen.csv", text);
    let said = bench.refusal(&format!("frozen.csv {TAIL}"));
    assert!(said.contains("frozen.csv: force stands at ") && said.contains("it froze"), "{said}");
}

#[test]
fn a_unit_under_the_name_of_another_is_named() {
    let bench = Bench::new();
    for (pressure, force, words) in [
        (1.0 / 6.895, 1.0, "psi under a header that says kPa is a factor of 6.895"),
        (1.0, 1.0 / 4.448, "lbf under a header that says N is a factor of 4.448"),
        (1.0, 1.0 / 9.807, "kgf under a header that says N is a factor of 9.807"),
    ] {
        bench.file("unit.csv", reworked(|_, [t, p, l, f]| [t, pressure * p, l, force * f]));
        let said = bench.refusal(&format!("unit.csv {TAIL}"));
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn the_same_recording_twice_is_known_by_its_samples() {
    let bench = Bench::new();
    let good = bench.folder.path().join("good.csv");
    std::fs::hard_link(&good, bench.folder.path().join("link.csv")).unwrap();
    let units = reworked(|_, [t, p, l, f]| [t, p / 100.0, l / 25.4, f]);
    bench.file("units.csv", units.replace("pressure_kPa,length_mm", "pressure_bar,length_in"));
    let part: Vec<String> = reworked(|_, row| row).lines().take(4000).map(str::to_owned).collect();
    bench.file("part.csv", part.join("\n"));
    for name in ["link.csv", "units.csv", "part.csv", "./good.csv"] {
        let fitted = bench.refusal(&format!("good.csv {name} {TAIL}"));
        assert!(
            fitted.contains(&format!("{name}: has the same samples as good.csv, which is fitted as well")),
            "{fitted}"
        );
        let held_out = bench.refusal(&format!("good.csv --holdout {name} {TAIL}"));
        assert!(
            held_out.contains(&format!("{name}: has the same samples as good.csv, which is fitted;")),
            "{held_out}"
        );
    }
}

/// The good recording without a header, in volts as the example of a channels file has it.
fn in_volts() -> String {
    shipped("isobaric-triangles.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let mut fields = line.split(',').map(|field| field.parse::<f64>().unwrap());
            let [t, p, l, f] = [(); 4].map(|()| fields.next().unwrap());
            format!("{t},{},{l},{}\n", (p + 125.0) / 250.0, f / 100.0)
        })
        .collect()
}

#[test]
fn the_example_of_a_channels_file_reads_volts_without_a_header() {
    let bench = Bench::new();
    assert_eq!(bench.run("--example=channels --out bench.toml").status.code(), Some(0));
    bench.file("volts.csv", in_volts());
    let output = bench.run("volts.csv --muscle m.toml --channels bench.toml --out model.json --quiet --starts 1");
    let model: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(bench.folder.path().join("model.json")).unwrap()).unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let roles: Vec<&str> =
        model["inputs"].as_array().unwrap().iter().map(|input| input["role"].as_str().unwrap()).collect();
    assert_eq!(roles, ["muscle", "configuration", "estimation"]);
    // Beyond the range of the load cell no sample counts.
    let counted = |model: &serde_json::Value| model["fit"]["estimation"]["n_samples"].as_u64().unwrap();
    let within = counted(&model);
    let text = std::fs::read_to_string(bench.folder.path().join("bench.toml")).unwrap();
    bench.file("narrow.toml", text.replace("[-500.0, 500.0]", "[-500.0, 300.0]"));
    bench.run("volts.csv --muscle m.toml --channels narrow.toml --out narrow.json --quiet --starts 1");
    let narrow = std::fs::read_to_string(bench.folder.path().join("narrow.json")).unwrap();
    assert!(counted(&serde_json::from_str(&narrow).unwrap()) < within);
}

#[test]
fn a_channels_file_that_is_wrong_gets_one_line_with_its_place() {
    let bench = Bench::new();
    bench.file("bench.toml", "[pressure]\ncolumn = \"ai0\"\nunit = \"atm\"\n");
    assert_eq!(
        bench.refusal(&format!("good.csv --channels bench.toml {TAIL}")),
        "error: bench.toml:1:1: [pressure] has the unit \"atm\", which is not known; write kPa, Pa, MPa, bar or psi, and gain and \
         offset for any other"
    );
    bench.file("bench.toml", "[pressure]\ncolumn = \"ai0\"\nunit = \"bar\"\n");
    assert_eq!(
        bench.refusal(&format!("good.csv --channels bench.toml {TAIL}")),
        "error: good.csv: bench.toml [pressure] names column \"ai0\", which the file lacks; it has time_s, pressure_kPa, \
         length_mm, force_N"
    );
    // What the command line says wins.
    let output = bench.run("good.csv --channels bench.toml --map pressure_kPa=pressure_kPa --muscle m.toml --check");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(
        bench.refusal(&format!("good.csv --channels gone.toml {TAIL}")),
        "error: cannot read channels file gone.toml: no such file; check the path"
    );
}
