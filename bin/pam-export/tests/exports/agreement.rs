//! Exported C and Python beside the model: every effect of the catalogue along a recording.

use std::process::{Command, Output};

use crate::desk::{Desk, cases, column, effects, has_c, kept_to_fitted, model, python, touching_guard};
use pam_artifact::{InverseArtifact, ModelArtifact};
use pam_inverse_model::InverseNetwork;
use pam_muscle::effects::Effect;

/// Largest error of a translation, in N.
const TOLERANCE_N: f64 = 1e-9;

/// Compiles the program beside a header, warnings being errors.
fn compile(desk: &Desk, name: &str) {
    let arguments = ["-std=c99", "-pedantic", "-O2", "-Wall", "-Wextra", "-Werror", "-o", name];
    let output = desk.run(Command::new("cc").args(arguments).arg(format!("{name}_check.c")).arg("-lm"));
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
}

fn check(desk: &Desk, name: &str, arguments: &[&str]) -> Output {
    desk.run(Command::new(desk.path().join(name)).args(arguments))
}

/// Largest difference that a check program prints in a line that begins so.
fn largest(output: &Output, line: &str) -> f64 {
    let text = String::from_utf8_lossy(&output.stdout);
    let line = text.lines().find(|found| found.starts_with(line)).unwrap_or_else(|| panic!("{text}"));
    line.split("largest difference ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn c_agrees_with_the_model_on_every_effect_along_a_recording() {
    if !has_c() {
        return;
    }
    let desk = Desk::new();
    desk.recording("multisine.csv", 3000);
    for (name, effects) in cases() {
        desk.write("model.json", &model(&effects));
        desk.exported(&format!("multisine.csv --model model.json --c {name}.h --vectors vectors.csv --quiet"));
        compile(&desk, &name);
        for (arguments, n) in [(&[][..], 300), (&["vectors.csv"][..], 3000)] {
            let output = check(&desk, &name, arguments);
            let said = String::from_utf8_lossy(&output.stdout).into_owned();
            assert_eq!(output.status.code(), Some(0), "{name}: {said}");
            assert!(said.starts_with(&format!("force: {n} instants")), "{name}: {said}");
            assert!(largest(&output, "force") <= TOLERANCE_N, "{name}: {said}");
        }
    }
}

#[test]
fn empirical_terms_of_the_test_pull_and_fade() {
    let desk = Desk::new();
    desk.recording("multisine.csv", 1500);
    let forces_n = |effects: &[&dyn Effect], log: &str| {
        desk.write("model.json", &model(effects));
        desk.exported(&format!("{log}--model model.json --vectors vectors.csv --quiet"));
        column(&desk.read("vectors.csv"), "force_model_n")
    };
    let mut n_fading = 0;
    for (name, effects) in cases().into_iter().filter(|(name, _)| name.starts_with("term_") || name.contains("guard")) {
        let mut differing = 0.0_f64;
        for log in ["multisine.csv ", ""] {
            let (plain_n, with_n) = (forces_n(&[], log), forces_n(&effects, log));
            let n_pulling = plain_n.iter().zip(&with_n).filter(|(plain, with)| plain != with).count();
            differing = differing.max(n_pulling as f64 / plain_n.len() as f64);
            n_fading += usize::from(n_pulling > 0 && n_pulling < plain_n.len());
        }
        assert!(differing > 0.1, "{name} pulls at {differing} of the instants");
    }
    assert!(n_fading > 5, "{n_fading}");
}

#[test]
fn an_effect_of_ones_own_stands_in_the_header_under_its_equation() {
    let desk = Desk::new();
    desk.write("model.json", &model(&[touching_guard()]));
    desk.exported("--model model.json --c muscle.h --quiet");
    let header = desk.read("muscle.h");
    for expected in ["/* empirical term: F = ", "MUSCLE_EMPIRICAL_1_HEIGHT ", "muscle_sentence_bump(x, 0.11, 0.02)"] {
        assert!(header.contains(expected), "{expected}: {header}");
    }
}

/// The model with another law of friction at standstill.
fn at_standstill(model: &str, law: &str) -> String {
    let slides = "{\"slides\": {\"over_pa\": 40000.0}}";
    assert!(model.contains(slides), "{model}");
    model.replace(slides, law)
}

const STICKS: &str = "\"sticks\"";
const RELAXES: &str = "{\"relaxes\": {\"time_constant_s\": 2.0, \"to\": 0.3}}";

#[test]
fn without_the_future_the_direction_is_late_and_no_more() {
    if !has_c() {
        return;
    }
    let desk = Desk::new();
    // The shorter the strokes, the larger the share of them in which a turn has not been noticed yet: minor loops go down to
    // 1 mm, and the threshold is 0.15 mm. A rest is noticed a second late.
    let [sticks, relaxes] = [STICKS, RELAXES].map(|law| at_standstill(&model(&[]), law));
    let logs = [("isobaric-triangles", 3.0), ("length-steps", 3.0), ("minor-loops", 6.0)];
    for (law, logs) in [(model(&[]), &logs[..]), (sticks, &[("isometric-ramps", 6.0)][..]), (relaxes, &logs[1..2])] {
        desk.write("model.json", &law);
        desk.exported("--model model.json --c muscle.h --quiet");
        compile(&desk, "muscle");
        for (log, most_percent) in logs {
            desk.recording(&format!("{log}.csv"), 6000);
            desk.exported(&format!("{log}.csv --model model.json --vectors vectors.csv --quiet"));
            let output = check(&desk, "muscle", &["vectors.csv"]);
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let another: f64 =
                text.split("direction differs at ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
            assert!(another > 0.0 && another < *most_percent, "{log}: {text}");
        }
    }
}

#[test]
fn a_check_program_finds_a_parameter_that_is_off() {
    if !has_c() {
        return;
    }
    let desk = Desk::new();
    let slack = effects().find(|effect| effect.page().id == "presliding-hysteresis").unwrap();
    desk.write("model.json", &model(&[slack]));
    desk.exported("--model model.json --c muscle.h --quiet");
    let name = "#define MUSCLE_PRESLIDING_HYSTERESIS_SLIP_DISTANCE_M ";
    let header = desk.read("muscle.h");
    let at = header.find(name).unwrap() + name.len();
    desk.write("muscle.h", &format!("{}1.0001 * {}", &header[..at], &header[at..]));
    compile(&desk, "muscle");
    let output = check(&desk, "muscle", &[]);
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stdout));
    assert_eq!(check(&desk, "muscle", &["nowhere.csv"]).status.code(), Some(2));
}

#[test]
fn vectors_are_what_pam_predict_says() {
    let desk = Desk::new();
    desk.recording("multisine.csv", 3000);
    let relaxing = effects().find(|effect| effect.page().id == "viscoelastic-relaxation").unwrap();
    desk.write("model.json", &model(&[relaxing]));
    desk.exported("multisine.csv --model model.json --vectors vectors.csv --quiet");
    let vectors = column(&desk.read("vectors.csv"), "force_model_n");
    let (artifact, _) = ModelArtifact::read(&desk.path().join("model.json")).unwrap();
    let options = pam_recording::ReadOptions::default();
    let recording = pam_recording::read_recording(&desk.path().join("multisine.csv"), &options).unwrap();
    let mut prepared = pam_identification::predict::prepare_plausible(recording, &artifact).unwrap();
    let model = artifact.augmented_model();
    prepared.begin_with(&model, artifact.direction, 0).unwrap();
    let forces_n = pam_identification::predict::augmented_forces_n(&prepared, &model, artifact.direction).unwrap();
    assert_eq!(vectors, forces_n);
}

/// A network that was trained on the model of the test, small but with every part.
const INVERSE: &str = include_str!("data/inverse.json");

#[test]
fn the_inverse_agrees_and_takes_less_than_a_microsecond() {
    if !has_c() {
        return;
    }
    let desk = Desk::new();
    with_inverse(&desk);
    desk.exported("--model model.json --inverse inverse.json --c muscle.h --quiet");
    compile(&desk, "muscle");
    // Of several runs, as other work on the machine slows some.
    let mut fastest_ns = f64::INFINITY;
    for _ in 0..5 {
        let output = check(&desk, "muscle", &[]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(0), "{text}");
        let line = text.lines().find(|line| line.contains("ns per evaluation")).unwrap();
        fastest_ns = fastest_ns.min(line.split(' ').nth(1).unwrap().parse().unwrap());
    }
    assert!(fastest_ns <= 1000.0, "{fastest_ns} ns");
}

/// Model and inverse that belong together.
fn with_inverse(desk: &Desk) {
    desk.write("model.json", &model(&[]));
    let (_, sha256) = ModelArtifact::read(&desk.path().join("model.json")).unwrap();
    desk.write("inverse.json", &INVERSE.replace("SHA256", &sha256));
}

#[test]
fn python_agrees_with_pam_predict_on_every_effect_from_file_to_force() {
    let Some(python) = python("numpy") else { return };
    let desk = Desk::new();
    desk.recording("multisine.csv", 1500);
    desk.write("model.json", &model(&[]));
    desk.exported("--model model.json --python pam_muscle.py --quiet");
    let mut logs = Vec::new();
    for (name, effects) in cases() {
        desk.write(&format!("{name}.json"), &model(&effects));
        desk.exported(&format!("multisine.csv --model {name}.json --vectors {name}.vectors.csv --quiet"));
        logs.push((name, "multisine.csv".to_owned()));
    }
    // A model along a recording, with vectors.
    let vectors = |name: &str, log: &str| {
        let written = format!("--vectors {name}.vectors.csv --accept-implausible --quiet");
        desk.exported(&format!("{log}.csv --model {name}.json {written}"));
        (name.to_owned(), format!("{log}.csv"))
    };
    // Turns, rests, steps and ramps; one with a gap, one without a force.
    for log in ["isobaric-triangles", "isometric-ramps", "length-steps", "minor-loops", "lift"] {
        desk.recording(&format!("{log}.csv"), 4000);
    }
    let gap = desk.read("minor-loops.csv");
    let kept: Vec<&str> =
        gap.lines().enumerate().filter(|(row, _)| !(2000..3000).contains(row)).map(|(_, l)| l).collect();
    desk.write("gap.csv", &kept.join("\n"));
    let without: Vec<&str> = gap.lines().map(|line| line.rsplit_once(',').unwrap().0).collect();
    desk.write("no-force.csv", &without.join("\n"));
    for log in ["isobaric-triangles", "isometric-ramps", "length-steps", "minor-loops", "lift", "gap", "no-force"] {
        desk.write(&format!("{log}.json"), &desk.read("presliding_hysteresis.json"));
        logs.push(vectors(log, log));
    }
    // Friction that slides partly while the length rests, or sticks, or relaxes, and a rest after a gap, of which nothing is known but its force.
    let slides = desk.read("presliding_hysteresis.json");
    let partly = slides.replace("\"over_pa\": 40000.0", "\"over_pa\": 40000.0, \"share\": 0.6");
    let [sticks, relaxes] = [STICKS, RELAXES].map(|law| at_standstill(&slides, law));
    desk.write("rest.csv", &with_a_rest_after_a_gap(&desk.read("minor-loops.csv")));
    for (name, law) in [("partly", &partly), ("sticks", &sticks), ("relaxes", &relaxes)] {
        for log in ["isometric-ramps", "length-steps", "rest"] {
            let name = format!("{name}-{log}");
            desk.write(&format!("{name}.json"), law);
            logs.push(vectors(&name, log));
        }
    }
    // A length with noise, along which turns are vertices, corners and the ends of rests.
    let noisy = with_play(&desk.read("presliding_hysteresis.json"), 2e-4);
    for log in ["length-steps", "minor-loops", "isometric-ramps"] {
        let name = format!("noisy-{log}");
        desk.write(&format!("{name}.csv"), &with_noise(&desk.read(&format!("{log}.csv")), 0.08));
        desk.write(&format!("{name}.json"), &noisy);
        logs.push(vectors(&name, &name));
    }
    // What acts in the fitted recordings alone is nowhere.
    desk.write("fitted.json", &kept_to_fitted(&desk.read("presliding_hysteresis.json"), "presliding-hysteresis"));
    desk.exported("multisine.csv --model fitted.json --vectors fitted.vectors.csv --quiet");
    assert_eq!(
        column(&desk.read("fitted.vectors.csv"), "force_model_n"),
        column(&desk.read("plain.vectors.csv"), "force_model_n")
    );
    logs.push(("fitted".to_owned(), "multisine.csv".to_owned()));
    let lines: Vec<String> = logs.iter().map(|(name, log)| format!("{name} {log}")).collect();
    desk.write("cases.txt", &lines.join("\n"));
    let said = run_python(&desk, &python, include_str!("agreement.py"));
    assert_eq!(said.lines().count(), logs.len(), "{said}");
    for line in said.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let [step_n, whole_n] = [words[1], words[2]].map(|word| word.parse::<f64>().unwrap());
        assert!(step_n <= TOLERANCE_N && whole_n <= TOLERANCE_N, "{line}");
    }
}

#[test]
fn python_has_the_settled_force_and_the_inverse() {
    let Some(python) = python("numpy") else { return };
    let desk = Desk::new();
    with_inverse(&desk);
    let network = InverseNetwork::from_artifact(&InverseArtifact::read(&desk.path().join("inverse.json")).unwrap().0);
    desk.exported("--model model.json --python pam_muscle.py --quiet");
    let stretched = ["series-compliance", "presliding-hysteresis", "slack"];
    let some: Vec<&dyn Effect> = effects().filter(|effect| stretched.contains(&effect.page().id)).collect();
    desk.write("some.json", &model(&some));
    let augmented = ModelArtifact::read(&desk.path().join("some.json")).unwrap().0.augmented_model();
    let mut expected = String::new();
    for step in 0..40 {
        let share = f64::from(step) / 39.0;
        let (pressure_pa, length_m) = (1e5 + 1e5 * share, 0.21 + 0.06 * ((7.0 * share) % 1.0));
        let direction = [-1.0, 0.3, 1.0][step as usize % 3];
        let settled_n = augmented.settled_force_n(pressure_pa, length_m, direction);
        let force_n = 600.0 * share;
        let found = network.pressure_pa(force_n, length_m, direction);
        let outside = u8::from(found.outside);
        expected +=
            &format!("{pressure_pa} {length_m} {direction} {settled_n} {force_n} {} {outside}\n", found.pressure_pa);
    }
    desk.write("expected.txt", &expected);
    let script = "\
import numpy as np, pam_muscle as pam
p, l, d, settled, force, pressure, outside = np.loadtxt('expected.txt').T
muscle, inverse = pam.Muscle.read('some.json'), pam.Inverse.read('inverse.json')
found, beyond = inverse.pressure_pa(force, l, d)
print(abs(muscle.settled_force_n(p, l, d) - settled).max(), (abs(found - pressure) / abs(pressure)).max())
print((beyond == outside).all(), outside.sum())
";
    let said = run_python(&desk, &python, script);
    let words: Vec<&str> = said.split_whitespace().collect();
    let [settled_n, pressure] = [words[0], words[1]].map(|word| word.parse::<f64>().unwrap());
    assert!(settled_n <= TOLERANCE_N && pressure <= 1e-9, "{said}");
    assert_eq!(words[2], "True", "{said}");
    assert!(words[3].parse::<f64>().unwrap() > 0.0, "points outside are among them: {said}");
}

/// A recording, and 20 s after its end 500 rows that are like its last one.
fn with_a_rest_after_a_gap(text: &str) -> String {
    let (_, last) = text.trim_end().rsplit_once('\n').unwrap();
    let (time_s, rest) = last.split_once(',').unwrap();
    let from_s = time_s.parse::<f64>().unwrap() + 20.0;
    let rows = (0..500).map(|row| format!("{:.4},{rest}\n", from_s + 0.005 * f64::from(row)));
    text.to_owned() + &rows.collect::<String>()
}

/// A recording whose lengths differ by up to half of `range_mm` from what they were.
fn with_noise(text: &str, range_mm: f64) -> String {
    let (header, rows) = text.split_once('\n').unwrap();
    let length = header.split(',').position(|name| name.starts_with("length")).unwrap();
    let row = |(index, line): (usize, &str)| {
        let mut values: Vec<String> = line.split(',').map(str::to_owned).collect();
        let off_mm = range_mm * ((index * 7919 % 1013) as f64 / 1013.0 - 0.5);
        values[length] = format!("{:.5}", values[length].parse::<f64>().unwrap() + off_mm);
        values.join(",") + "\n"
    };
    format!("{header}\n") + &rows.lines().enumerate().map(row).collect::<String>()
}

/// A model whose direction has another play of the length.
fn with_play(model: &str, length_m: f64) -> String {
    let (before, direction) = model.split_once("\"direction\": {").unwrap();
    let (until, after) = direction.split_once("\"length_m\": ").unwrap();
    let (_, after) = after.split_once(',').unwrap();
    format!("{before}\"direction\": {{{until}\"length_m\": {length_m},{after}")
}

/// Output of a script, run beside the module.
fn run_python(desk: &Desk, python: &std::path::Path, script: &str) -> String {
    // One thread: the matrices are small, and the machine may be busy.
    let output = desk
        .run(Command::new(python).args(["-c", script]).env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}
