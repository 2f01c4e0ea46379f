//! The program as a person meets it.

use std::process::Command;

use crate::desk::{Desk, effects, kept_to_fitted, model, python};
use pam_artifact::ModelArtifact;

/// The one error of a refused run, which leaves no file of those named `out`.
fn refusal(desk: &Desk, arguments: &str) -> String {
    let output = desk.export(arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments}: {stderr}");
    let left = std::fs::read_dir(desk.path())
        .unwrap()
        .filter(|entry| entry.as_ref().unwrap().file_name().to_string_lossy().starts_with("out"));
    assert_eq!(left.count(), 0, "{arguments}: a file was written");
    let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
    assert_eq!(errors.len(), 1, "{stderr}");
    errors[0].to_owned()
}

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write("model.json", &model(&[]));
    desk
}

#[test]
fn what_cannot_be_exported_is_refused_in_a_line() {
    let desk = desk();
    desk.write("broken.json", &model(&[]).replace("\"k1\"", "\"k9\""));
    desk.recording("multisine.csv", 100);
    let named = |words: &str| refusal(&desk, words);
    assert_eq!(
        named("--model model.json"),
        "error: nothing to write: name --c, --python, --simulink, --mujoco or --vectors"
    );
    assert_eq!(
        named("--model model.json --c out/2nd.h"),
        "error: \"2nd\" gives no name for what is in it; begin the file's name with a letter, as in muscle.h"
    );
    let mut huge = model(&[]);
    let k1 = huge.find("\"name\": \"k1\"").unwrap();
    let from = k1 + huge[k1..].find("\"value\": ").unwrap() + "\"value\": ".len();
    let to = from + huge[from..].find(',').unwrap();
    huge.replace_range(from..to, "1e300");
    desk.write("huge.json", &huge);
    for output in ["--c out.h", "--python out.py", "--mujoco out.xml", "--simulink out.m", "--vectors out.csv"] {
        let said = named(&format!("--model huge.json {output}"));
        assert!(said.contains("huge.json: the modelled force is") && said.contains("which no muscle has"), "{said}");
    }
    assert!(named("--model nowhere.json --c out.h").starts_with("error: cannot read nowhere.json: "));
    assert!(named("--model broken.json --c out.h").contains("broken.json: parameter"));
    assert!(named("--model model.json --c model.json").contains("model.json"));
    assert!(named("multisine.csv --model model.json --c out.h").contains("--vectors"));
    assert!(named("multisine.csv --model model.json --vectors missing/out.csv").contains("missing"));
}

#[test]
fn an_inverse_of_another_model_is_refused() {
    let desk = desk();
    desk.write("inverse.json", include_str!("data/inverse.json"));
    let said = refusal(&desk, "--model model.json --inverse inverse.json --c out.h");
    assert!(said.starts_with("error: inverse.json: it is the inverse of another model"), "{said}");
}

#[test]
fn check_writes_nothing_and_equal_inputs_give_equal_bytes() {
    let desk = desk();
    desk.exported("--model model.json --c out.h --vectors out.csv --check --quiet");
    assert!(!desk.path().join("out.h").exists() && !desk.path().join("out_check.c").exists());
    let formats = "--model model.json --c m.h --simulink m.m --mujoco m.xml --vectors m.csv --quiet";
    let again = self::desk();
    for desk in [&desk, &again] {
        desk.exported(formats);
    }
    for name in ["m.h", "m_check.c", "m.m", "m.xml", "m.csv"] {
        assert_eq!(desk.read(name), again.read(name), "{name}");
    }
}

#[test]
fn the_muscle_alone_has_no_instruments() {
    let desk = desk();
    let some: Vec<_> = effects().filter(|effect| ["force-drift", "slack"].contains(&effect.page().id)).collect();
    desk.write("model.json", &model(&some));
    let output = desk.export("--model model.json --c - --muscle-only");
    let header = String::from_utf8(output.stdout).unwrap();
    assert!(header.contains("MUSCLE_SLACK_FLOOR_N") && !header.contains("FORCE_DRIFT"));
    assert!(String::from_utf8(output.stderr).unwrap().contains("left out, as they are not the muscle's: force-drift"));
}

#[test]
fn what_acts_in_the_fitted_recordings_alone_is_not_exported() {
    let desk = desk();
    let some: Vec<_> = effects().filter(|effect| ["slack", "pressure-creep"].contains(&effect.page().id)).collect();
    desk.write("model.json", &kept_to_fitted(&model(&some), "slack"));
    for option in ["", " --muscle-only"] {
        let output = desk.export(&format!("--model model.json --c -{option}"));
        let header = String::from_utf8(output.stdout).unwrap();
        assert!(!header.contains("MUSCLE_SLACK_FLOOR_N") && header.contains("MUSCLE_PRESSURE_CREEP"));
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            said.contains("left out, as they act only in the recordings that the model was fitted to: slack"),
            "{said}"
        );
    }
}

/// Values in the brackets after `name = `, in a MATLAB script.
fn values(script: &str, name: &str) -> Vec<f64> {
    let from = script.find(&format!("{name} = ")).unwrap();
    let open = from + script[from..].find('[').unwrap() + 1;
    let close = open + script[open..].find(']').unwrap();
    script[open..close].split_whitespace().filter(|word| *word != "...").map(|word| word.parse().unwrap()).collect()
}

#[test]
fn a_table_for_simulink_interpolates_to_the_settled_force() {
    let desk = desk();
    let some: Vec<_> = effects().filter(|effect| ["slack", "threshold-pressure"].contains(&effect.page().id)).collect();
    desk.write("model.json", &model(&some));
    desk.exported("--model model.json --simulink muscle.m --quiet");
    let script = desk.read("muscle.m");
    let [p, l, d, f] = ["pressure_pa", "length_m", "direction", "force_n"]
        .map(|name| values(&script, &format!("muscle_table.{name}")));
    assert!(script.contains(&format!("], [{} {} {}]);", p.len(), l.len(), d.len())));
    assert_eq!(f.len(), p.len() * l.len() * d.len());
    let model = ModelArtifact::read(&desk.path().join("model.json")).unwrap().0.augmented_model();
    let at = |values: &[f64], value: f64| {
        let below = values.partition_point(|known| *known <= value).clamp(1, values.len() - 1) - 1;
        (below, (value - values[below]) / (values[below + 1] - values[below]))
    };
    for step in 0..200 {
        let share = f64::from(step) / 199.0;
        let (pressure_pa, length_m) = (1e5 + 1e5 * share, l[0] + (l[l.len() - 1] - l[0]) * ((13.0 * share) % 1.0));
        let direction = [-1.0, 0.0, 1.0][step as usize % 3];
        let ((i, a), (j, b)) = (at(&p, pressure_pa), at(&l, length_m));
        let k = d.iter().position(|known| (known - direction).abs() < 0.1).unwrap();
        let corner = |r: usize, c: usize| f[(k * l.len() + j + c) * p.len() + i + r];
        let found_n = (1.0 - b) * ((1.0 - a) * corner(0, 0) + a * corner(1, 0))
            + b * ((1.0 - a) * corner(0, 1) + a * corner(1, 1));
        let expected_n = model.settled_force_n(pressure_pa, length_m, direction);
        // The script says what interpolation costs in the middle of a cell, where it costs most.
        let said: f64 = script.split("off by ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        assert!((found_n - expected_n).abs() <= 1.05 * said + 1e-3, "{found_n} {expected_n} {said}");
        assert!(said < 0.3);
    }
}

#[test]
fn mujoco_pulls_as_the_model_does() {
    let Some(python) = python("mujoco, numpy") else { return };
    let desk = desk();
    let some: Vec<_> =
        effects().filter(|effect| ["viscous-damping", "pressure-lag"].contains(&effect.page().id)).collect();
    desk.write("model.json", &model(&some));
    desk.exported("--model model.json --mujoco muscle.xml --python pam_muscle.py --quiet");
    let output = desk.run(Command::new(python).args(["-c", include_str!("mujoco.py")]));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    let numbers: Vec<f64> = said.split_whitespace().map(|word| word.parse().unwrap()).collect();
    let scene = desk.read("muscle.xml");
    let words: Vec<&str> = scene.split_whitespace().collect();
    let before = |unit: &str, which: usize| -> f64 {
        let at = words.iter().enumerate().filter(|(_, word)| **word == unit).nth(which).unwrap().0;
        words[at - 1].parse().unwrap()
    };
    let (rms_n, most_n) = (before("N", 0), before("N", 1));
    let [found_rms_n, found_most_n, damped_n, lag] = numbers[..] else { panic!("{said}") };
    // Error that the scene states, to the decimal stated.
    assert!(found_rms_n <= 1.5 * rms_n + 0.1 && found_most_n <= most_n + 0.1, "{said} {rms_n} {most_n}");
    assert!(rms_n < 5.0, "{rms_n}");
    // Damping is exact, and a lag of the pressure is the same filter.
    assert!(damped_n < 1e-6, "{said}");
    assert!(lag < 1e-9, "{said}");
}
