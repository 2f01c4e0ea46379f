//! Faults and mistakes: one line with place and remedy.

use pam_artifact::diagnosis::Verdict;

use crate::desk::{Desk, LOGS, reworked};

#[test]
fn a_fault_in_what_was_held_out_decides() {
    let desk = &Desk::with(&[]);
    let held = "multisine.csv";
    desk.file("turned.csv", reworked(desk, held, |[t, p, l, f]| [t, p, l, -f]));
    desk.file("longer.csv", reworked(desk, held, |[t, p, l, f]| [t, p, l + 60.0, f]));
    desk.file("pascal.csv", reworked(desk, held, |[t, p, l, f]| [t, 1e3 * p, l, f]));
    desk.file("gain.csv", reworked(desk, held, |[t, p, l, f]| [t, p, l, 1.2 * f]));
    desk.file("datum.csv", reworked(desk, held, |[t, p, l, f]| [t, p, l + 4.0, f]));
    for (name, says) in [
        ("turned", "turned.csv: force falls as pressure rises"),
        ("longer", "longer.csv: length runs from"),
        ("pascal", "pascal.csv: pressure reaches"),
    ] {
        let said = desk.refusal(&format!("{LOGS} --model model.json --holdout {name}.csv --out refused.json"));
        assert!(said.contains(says), "{said}");
    }
    for (name, says) in [("gain", "the force reads 1.200 times what it should"), ("datum", "the length reads 4.0")] {
        let files = "--out diagnosis.json --out-model augmented.json";
        let line = format!("{LOGS} --model model.json --holdout {name}.csv {files}");
        let (diagnosis, _) = desk.diagnosed(&line, 1);
        assert_eq!(diagnosis.verdict, Verdict::Unexplained, "{}", diagnosis.statement);
        let first = format!("Held out, {name}.csv is missed by ");
        assert!(diagnosis.statement.starts_with(&first), "{}", diagnosis.statement);
        assert!(diagnosis.statement.contains(says), "{}", diagnosis.statement);
    }
}

#[test]
fn every_mistake_gets_one_line_with_place_and_remedy() {
    // One of its own: other tests write beside the shared one while a refusal looks for leftovers.
    let desk = &Desk::with(&[]);
    let triangles = "isobaric-triangles.csv";
    desk.file("copy.csv", std::fs::read(desk.path(triangles)).unwrap());
    desk.file("rewritten.csv", reworked(desk, triangles, |row| row));
    desk.file("still.csv", reworked(desk, triangles, |[t, p, l, _]| [t, p, l, 7.5]));
    desk.file("held.csv", reworked(desk, triangles, |[t, _, _, f]| [t, 300.0, 250.0, f]));
    desk.file("clipped.csv", reworked(desk, triangles, |[t, p, l, f]| [t, p, l, f.min(300.0)]));
    desk.file("other.csv", reworked(desk, triangles, |[t, p, l, f]| [t, p, l + 60.0, f]));
    let head: Vec<String> =
        std::fs::read_to_string(desk.path(triangles)).unwrap().lines().take(400).map(str::to_owned).collect();
    desk.file("short.csv", head.join("\n") + "\n");
    desk.file("empty.csv", "");
    desk.file("broken.json", "{\"schema\": \"pam-model/1\",");
    desk.file("inverse.json", "{\"schema\": \"pam-inverse/1\"}");
    desk.file("sub", "");
    let to = "--out refused.json";
    let cases = [
        format!("{LOGS} --model model.json --holdout {triangles} {to}"),
        format!("{LOGS} --model model.json --holdout copy.csv {to}"),
        format!("{LOGS} --model model.json --holdout rewritten.csv {to}"),
        format!("still.csv --model model.json {to}"),
        format!("held.csv --model model.json {to}"),
        format!("clipped.csv --model model.json {to}"),
        format!("other.csv --model model.json {to}"),
        format!("short.csv --model model.json {to}"),
        format!("empty.csv --model model.json {to}"),
        format!("missing.csv --model model.json {to}"),
        format!("{LOGS} --model missing.json {to}"),
        format!("{LOGS} --model broken.json {to}"),
        format!("{LOGS} --model inverse.json {to}"),
        format!("{LOGS} --model model.json --out sub/refused.json"),
        format!("{LOGS} --model model.json --out refused.json --report nowhere/refused.html"),
        format!("{LOGS} --model model.json --out refused.json --out-model refused.json"),
        format!("{LOGS} --model model.json --out model.json"),
        format!("{LOGS} --model model.json --out /dev/full"),
        format!("{LOGS} --model model.json {to} --exclude stribek"),
        format!("{LOGS} --model model.json {to} --exclude gearbox"),
        format!("{LOGS} --model model.json {to} --max-effects 0"),
        format!("{LOGS} --model model.json {to} --matters-above-n -1"),
        format!("{LOGS} --model model.json"),
        format!("{LOGS} {to}"),
        format!("--model model.json {to}"),
        format!("{LOGS} --model model.json {to} --figure refused.svg"),
        "--explain stribek".to_owned(),
        "--explain all --figure refused.svg".to_owned(),
        format!("--explain stribeck {to}"),
    ];
    let said: Vec<String> = cases.iter().map(|arguments| desk.refusal(arguments)).collect();
    insta::assert_snapshot!(said.join("\n"), @r#"
    error: isobaric-triangles.csv: is fitted and held out as well; hold out a recording that the diagnosis does not see
    error: copy.csv: has the same samples as isobaric-triangles.csv, which is fitted; a hold-out must be a recording that nothing was fitted to
    error: rewritten.csv: has the same samples as isobaric-triangles.csv, which is fitted; a hold-out must be a recording that nothing was fitted to
    error: still.csv: force never varies (it is 7.5 N in every row); check the load cell and the column that holds it, or for a dead weight leave the column out and give --fixed force_N=7.5
    error: held.csv: pressure stays at 300 kPa throughout; check its wiring, or leave the recording out
    error: clipped.csv: force stands at 300.0 N, the end of its range, in 56 % of the samples; the sensor is saturated: leave the recording out, or take a sensor with more range
    error: other.csv: length runs from 270.8 to 328.5 mm, which a muscle of rest length 267.0 mm cannot have (it would be stretched by more than a tenth, or its strands straight); check that the recording and the model belong together, or go on with --accept-implausible
    error: short.csv: 2.0 s of motion in all is too short to judge by; record at least 3 s more (blocks of some seconds are held out in turn)
    error: empty.csv: the file holds no rows; record again, or check that the logger closed the file
    error: missing.csv: no such file; check the path
    error: cannot read missing.json: no such file; check the path
    error: broken.json:1:25: EOF while parsing a value; expected a pam-model/1 artifact
    error: inverse.json: schema is "pam-inverse/1", expected "pam-model/1"; write it with pam-identify
    error: cannot write sub/refused.json: sub is not a folder; name another path
    error: cannot write nowhere/refused.html: folder nowhere does not exist; create it with `mkdir -p nowhere`
    error: two outputs go to refused.json; name different ones
    error: cannot write model.json: it is also an input, which the run would destroy; name another
    error: cannot write /dev/full: no space left on the device; free some or name a path elsewhere
    error: --exclude: no effect is called "stribek"; did you mean stribeck?
    error: --exclude: no effect is called "gearbox"; pam-diagnose --explain all lists them
    error: invalid value '0' for '--max-effects <N>': 0 is not in 1..=10; see --help
    error: --matters-above-n -1 is no size of a force; give newtons from 0 up
    error: the following required arguments were not provided: --out <DIAGNOSIS.json>; see --help
    error: the following required arguments were not provided: --model <MODEL.json>; see --help
    error: the following required arguments were not provided: <LOG>...; see --help
    error: --figure draws an effect; name it with --explain (figures of a diagnosis are in --report)
    error: --explain: no effect is called "stribek"; did you mean stribeck?
    error: --figure draws one effect; name it instead of all
    error: the argument '--explain <ID>' cannot be used with '--out <DIAGNOSIS.json>'; see --help
    "#);
}
