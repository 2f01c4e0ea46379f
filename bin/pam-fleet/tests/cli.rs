//! The program as a person meets it.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use std::path::Path;
use std::process::{Command, Output, Stdio};

/// The published schema.
const SCHEMA: &str = include_str!("../../../crates/artifact/schemas/pam-fleet-plan-1.json");
/// A model whose parameters are known.
const MODEL: &str = include_str!("../../pam-predict/tests/data/model.json");
/// Muscles of the fleet: six on each of two rigs.
const MUSCLES: usize = 12;

/// A table of twelve muscles, and what the programs left of each: models with `k1` from `k1`, nothing of the diagnosis.
struct Fleet {
    folder: tempfile::TempDir,
}

impl Fleet {
    fn new(k1: impl Fn(usize) -> f64) -> Self {
        let fleet = Self { folder: tempfile::tempdir().unwrap() };
        let mut table = "path,muscle,rig,date,role\n".to_owned();
        for index in 0..MUSCLES {
            let (muscle, rig) = (format!("m{index:02}"), format!("r{}", index % 2));
            table += &format!("{muscle}/a.csv,{muscle},{rig},2026-03-01,estimation\n");
            let mut model: serde_json::Value = serde_json::from_str(MODEL).unwrap();
            let parameters = model["parameters"].as_array_mut().unwrap();
            let entry = parameters.iter_mut().find(|entry| entry["name"] == "k1").unwrap();
            entry["status"] = "fitted".into();
            entry["value"] = k1(index).into();
            entry["stderr"] = 0.001.into();
            let place = format!("results/{muscle}--{rig}--2026-03-01");
            fleet.write(&format!("{place}/model.json"), &model.to_string());
            fleet.write(&format!("{place}/identify.exit"), "0\n1 2 model.json\n");
            for step in ["predict", "diagnose", "train-inverse"] {
                fleet.write(&format!("{place}/{step}.exit"), "skipped\n");
            }
        }
        fleet.write("table.csv", &table);
        fleet
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, content).unwrap();
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    fn run(&self, arguments: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pam-fleet"))
            .args(arguments.split(' '))
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }

    fn refusal(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(!self.path("fleet.csv").exists() && !self.path("plan.json").exists(), "an output was written");
        let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
        assert_eq!(errors.len(), 1, "{stderr}");
        errors[0].to_owned()
    }
}

const REPORT: &str = "table.csv --muscle m.toml --results results --out fleet.csv --report fleet.html";

/// Scatter of a percent, without a draw.
fn alike(index: usize) -> f64 {
    0.9 + 0.003 * ((index * 5) % 7) as f64
}

fn column(sheet: &str, name: &str) -> Vec<String> {
    let mut lines = sheet.lines();
    let at = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(at).unwrap().to_owned()).collect()
}

#[test]
fn a_muscle_that_is_not_like_the_others_is_named_first() {
    let fleet = Fleet::new(|index| if index == 4 { 1.9 } else { alike(index) });
    let output = fleet.run(REPORT);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let sheet = fleet.read("fleet.csv");
    let standing: Vec<usize> = (0..MUSCLES).filter(|index| column(&sheet, "stands_out")[*index] == "yes").collect();
    assert_eq!(standing, [4], "{sheet}");
    let page = fleet.read("fleet.html");
    assert!(page.contains("One muscle is not like the others") && page.contains("First of all m04: k1 is high"));
}

#[test]
fn equal_muscles_stand_out_nowhere_and_equal_inputs_give_equal_bytes() {
    let fleet = Fleet::new(alike);
    assert_eq!(fleet.run(REPORT).status.code(), Some(0));
    let first = [fleet.read("fleet.csv"), fleet.read("fleet.html")];
    assert!(column(&first[0], "stands_out").iter().all(|word| word == "no"), "{}", first[0]);
    assert!(first[1].contains("No muscle stands out"));
    assert_eq!(fleet.run(&format!("{REPORT} --threads 1")).status.code(), Some(0));
    assert_eq!([fleet.read("fleet.csv"), fleet.read("fleet.html")], first);
}

#[test]
fn a_refusal_costs_its_muscle_and_ends_in_the_table_of_refusals() {
    let fleet = Fleet::new(alike);
    let place = "results/m07--r1--2026-03-01";
    fleet.write(&format!("{place}/identify.exit"), "2\n");
    fleet.write(
        &format!("{place}/identify.jsonl"),
        "{\"level\":\"error\",\"message\":\"m07/a.csv:9:2: <nan> is no number\"}\n",
    );
    std::fs::remove_dir_all(fleet.path("results/m02--r0--2026-03-01")).unwrap();
    assert_eq!(fleet.run(REPORT).status.code(), Some(1));
    let outcomes = column(&fleet.read("fleet.csv"), "identify");
    let expected = |index: usize| match index {
        2 => "missing",
        7 => "refused",
        _ => "accepted",
    };
    assert!((0..MUSCLES).all(|index| outcomes[index] == expected(index)), "{outcomes:?}");
    let page = fleet.read("fleet.html");
    assert!(page.contains("m07/a.csv:9:2: &lt;nan&gt; is no number"), "the reason is there, as it was written");
    assert!(page.contains("identify has not run to its end"));
}

#[test]
fn the_page_loads_nothing_and_says_everything_without_its_script() {
    let fleet = Fleet::new(alike);
    assert_eq!(fleet.run(REPORT).status.code(), Some(0));
    let page = fleet.read("fleet.html");
    for reference in ["src=", "url(", "@import", "<link", "fetch(", "import("] {
        assert!(!page.contains(reference), "{reference}");
    }
    let (document, script) = page.split_once("<script>").unwrap();
    assert!((0..MUSCLES).all(|index| document.contains(&format!("<td>m{index:02}</td>"))));
    assert!(!script.contains("innerHTML") && document.contains("prefers-color-scheme: dark"));
}

#[test]
fn the_plan_is_what_the_schema_says() {
    let fleet = Fleet::new(alike);
    assert_eq!(fleet.run("table.csv --muscle m.toml --plan plan.json --quiet").status.code(), Some(0));
    let plan: serde_json::Value = serde_json::from_str(&fleet.read("plan.json")).unwrap();
    jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &plan).unwrap();
    assert_eq!(plan["campaigns"].as_array().unwrap().len(), MUSCLES);
    assert_eq!(plan["campaigns"][3]["id"], "m03--r1--2026-03-01");
    assert!(Path::new(plan["campaigns"][3]["estimation"][0].as_str().unwrap()).is_absolute());
    let printed = fleet.run("--schema").stdout;
    assert!(printed == SCHEMA.as_bytes(), "the published schema is stale; run scripts/schemas");
}

#[test]
fn what_cannot_be_right_is_one_line() {
    let fleet = Fleet::new(alike);
    let sheet = "--muscle m.toml --results results --out fleet.csv";
    let nowhere = fleet.refusal("table.csv --muscle m.toml --results result --out fleet.csv");
    assert_eq!(nowhere, "error: result: no such folder; --results is where the campaigns' folders lie");
    assert_eq!(
        fleet.refusal(&format!("tabel.csv {sheet}")),
        "error: cannot read tabel.csv: no such file; did you mean table.csv?"
    );
    assert_eq!(
        fleet.refusal("table.csv --plan plan.json"),
        "error: table.csv:2:1: no dimensions are known; name a muscle file with --muscle, or in a column dimensions"
    );
    assert!(fleet.refusal("table.csv --muscle m.toml").contains("--results"), "what is missing is named");
    let own = fleet.refusal("table.csv --muscle m.toml --plan table.csv");
    assert!(own.contains("table.csv"), "{own}");
    // Nor does it write over what the table names, or take it for two.
    fleet.write("m00/a.csv", "time_s\n0\n");
    fleet.write("m.toml", "rest_length_mm = 267.0\n");
    for out in ["m00/a.csv", "m.toml"] {
        let own = fleet.refusal(&format!("table.csv --muscle m.toml --plan {out}"));
        assert_eq!(
            own,
            format!("error: cannot write {out}: it is also an input, which the run would destroy; name another")
        );
    }
    fleet.write("twice.csv", &format!("{}./m00/a.csv,m00,r0,2026-03-01,holdout\n", fleet.read("table.csv")));
    assert_eq!(
        fleet.refusal("twice.csv --muscle m.toml --plan plan.json"),
        "error: twice.csv:14:1: the same recording stands in line 2; keep one of the two"
    );
}
