//! A folder with models, and the programs that are run in it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use pam_muscle::effects::sentence::{Curve, Driver, Recall, Scale, Sentence, custom_effects, own};
use pam_muscle::effects::{CATALOGUE, Effect, NAMELESS};

/// A model whose every value is known.
const MODEL: &str = include_str!("../../../pam-predict/tests/data/model.json");

/// Parameters of eq. 11 that make every term count.
const VALUES: [(&str, &str); 8] = [
    ("k1", "0.9"),
    ("k2", "1.05"),
    ("k3", "2.0"),
    ("c10", "118400.0"),
    ("c01", "105700.0"),
    ("strand_modulus", "3000000000.0"),
    ("rubber_friction", "0.0012"),
    ("strand_friction", "0.3"),
];

/// The folder.
pub(crate) struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    /// An empty one.
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// The folder.
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Writes a file.
    pub(crate) fn write(&self, name: &str, content: &str) {
        std::fs::write(self.path().join(name), content).unwrap();
    }

    /// Content of a file.
    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path().join(name)).unwrap()
    }

    /// Runs `pam-export` with words parted by blanks.
    pub(crate) fn export(&self, arguments: &str) -> Output {
        self.run(Command::new(env!("CARGO_BIN_EXE_pam-export")).args(arguments.split(' ')))
    }

    /// Runs `pam-export`, which must succeed.
    pub(crate) fn exported(&self, arguments: &str) {
        let output = self.export(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
    }

    /// Runs a program here.
    pub(crate) fn run(&self, command: &mut Command) -> Output {
        command.current_dir(self.path()).stdin(Stdio::null()).output().unwrap()
    }

    /// The first `n_rows` of a recording of the virtual bench, as a file of that name.
    pub(crate) fn recording(&self, name: &str, n_rows: usize) {
        let text = std::fs::read_to_string(shipped(name)).unwrap();
        let lines: Vec<&str> = text.lines().take(n_rows + 1).collect();
        self.write(name, &(lines.join("\n") + "\n"));
    }
}

/// A recording of the virtual bench.
pub(crate) fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/bench-nominal").join(name)
}

/// Every effect, those without a name as well.
pub(crate) fn effects() -> impl Iterator<Item = &'static dyn Effect> {
    CATALOGUE.iter().chain(NAMELESS).copied()
}

/// Empirical terms in which every driver, memory, scale and curve of the grammar comes at least once. What they have seen is less
/// than what the recordings of the tests show, so that they fade on the way.
pub(crate) fn empirical_terms() -> Vec<&'static dyn Effect> {
    let moved = |above_m_per_s, above_pa_per_s| Driver::TimeSinceLastMove { above_m_per_s, above_pa_per_s };
    let bump = |center, width| Curve::Bump { center, width };
    let spline = |knots: &[f64]| Curve::Spline { knots: knots.to_vec() };
    let monotone = |knots: &[f64]| Curve::Monotone { knots: knots.to_vec() };
    let terms = [
        (Driver::Contraction, Recall::None, Scale::One, bump(0.1, 0.05), [0.05, 0.15]),
        (
            Driver::Pressure,
            Recall::Lag { time_constant_s: 0.3 },
            Scale::Pressure,
            Curve::Saturation { from: 5e2, over: 1e4 },
            [-1e4, 1e4],
        ),
        (Driver::Speed, Recall::TwoLags { time_constants_s: [0.05, 0.3] }, Scale::GasForce, Curve::Line, [-0.01, 0.02]),
        (
            Driver::Force,
            Recall::Play { half_width: 10.0 },
            Scale::BladderForce,
            monotone(&[-10.0, -5.0, 0.0, 8.0]),
            [-9.0, 9.0],
        ),
        (Driver::Time, Recall::Travelled, Scale::Friction, spline(&[0.0, 0.5, 1.0, 2.0, 3.5]), [0.2, 3.0]),
        (Driver::TravelSinceReversal, Recall::Dahl { distance: 1e-3 }, Scale::Direction, Curve::Line, [-0.9, 0.8]),
        (moved(0.02, 2e5), Recall::None, Scale::Contracting, spline(&[0.0, 0.02, 0.05]), [0.0, 0.04]),
        (
            Driver::TimeSincePressureMoved { above_pa_per_s: 1e5 },
            Recall::Largest,
            Scale::Extending,
            bump(0.3, 0.8),
            [0.0, 2.0],
        ),
        (Driver::Cycle, Recall::None, Scale::SlopeOverPressure, Curve::Saturation { from: 1.0, over: 2.0 }, [0.0, 6.0]),
        (Driver::Contraction, Recall::Work, Scale::SlopeOverLength, monotone(&[0.0, 1.0, 5.0, 40.0]), [0.0, 20.0]),
        (Driver::Contraction, Recall::Largest, Scale::One, spline(&[0.0, 0.1]), [0.0, 0.08]),
        (Driver::TravelSinceReversal, Recall::None, Scale::One, Curve::Line, [0.0, 0.01]),
    ];
    let effect = |(driver, memory, scale, shape, seen)| own(&Sentence { driver, memory, scale, shape, seen }).unwrap();
    terms.into_iter().map(effect).collect()
}

/// The effect of `configs/effects/touching-guard.toml` as a model has it: its sentence at a place that was fitted.
pub(crate) fn touching_guard() -> &'static dyn Effect {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../configs/effects/touching-guard.toml");
    let guard = custom_effects(&std::fs::read_to_string(path).unwrap()).unwrap()[0];
    let sentence = guard.sentence_at(&[0.11, 0.02]).unwrap();
    own(&Sentence { seen: [0.02, 0.13], ..sentence }).unwrap()
}

/// Names, and effects of a model each: every effect alone, none, and all at once.
pub(crate) fn cases() -> Vec<(String, Vec<&'static dyn Effect>)> {
    let mut cases: Vec<(String, Vec<&'static dyn Effect>)> =
        effects().map(|effect| (effect.page().id.replace('-', "_"), vec![effect])).collect();
    let terms = empirical_terms();
    cases.extend(terms.iter().enumerate().map(|(index, term)| (format!("term_{}", index + 1), vec![*term])));
    cases.push(("touching_guard".to_owned(), vec![touching_guard()]));
    cases.push(("plain".to_owned(), vec![]));
    cases.push(("all".to_owned(), effects().chain(terms).collect()));
    cases
}

/// The model with `effects` and a law of friction at standstill.
pub(crate) fn model(effects: &[&dyn Effect]) -> String {
    let mut text = MODEL.to_owned();
    for (name, value) in VALUES {
        let from = text.find(&format!("\"name\": \"{name}\"")).unwrap();
        let at = from + text[from..].find("\"value\": ").unwrap() + "\"value\": ".len();
        let end = at + text[at..].find(',').unwrap();
        text.replace_range(at..end, value);
    }
    let direction =
        "\"direction\": {\n  \"held_m\": 2e-5, \"turn_m\": 3e-5, \"standstill\": {\"slides\": {\"over_pa\": 40000.0}},";
    // Beside others an effect has a past, alone it has none.
    let entries: Vec<String> = effects.iter().map(|effect| entry(*effect, effects.len() > 1)).collect();
    text.replace("\"direction\": {", direction)
        .replace("\"effects\": []", &format!("\"effects\": [{}]", entries.join(", ")))
}

/// A model whose effect `id` acts in the recordings alone that it was fitted to.
pub(crate) fn kept_to_fitted(model: &str, id: &str) -> String {
    let id = format!("\"id\": \"{id}\"");
    assert!(model.contains(&id), "{id}");
    model.replace(&id, &format!("{id}, \"only_as_fitted\": true"))
}

/// An effect with parameters inside their ranges: shapes from the middle of the grid, amplitudes of a size that shows; with a past
/// that what it keeps for good begins with, or without.
fn entry(effect: &dyn Effect, has_past: bool) -> String {
    let rims = [
        ("lowest_pa", 1e5),
        ("highest_pa", 2e5),
        ("lowest_contraction_ratio", 0.0),
        ("highest_contraction_ratio", 0.2),
    ];
    let shapes = effect.shape().iter().map(|shape| {
        let rim = rims.iter().find(|(name, _)| *name == shape.name);
        let middle = shape.grid[shape.grid.len() / 2];
        let value = match rim {
            Some((_, rim)) => *rim,
            None if middle == 0.0 => 0.2 * shape.range.1,
            None => middle,
        };
        (shape.name, value, shape.unit)
    });
    let amplitudes = effect.amplitudes().iter().enumerate().map(|(index, amplitude)| {
        let share = if amplitude.name.ends_with("_n") && effect.page().id == "static-map" { 2e-4 } else { 0.03 };
        (amplitude.name, share / (1.0 + index as f64) * amplitude.range.1, amplitude.unit)
    });
    let keeps = effect.keeps().iter().filter(|_| has_past).map(|kept| (kept.name, 0.15, kept.unit));
    let parameters: Vec<String> = shapes
        .chain(amplitudes)
        .chain(keeps)
        .map(|(name, value, unit)| {
            format!(
                "{{\"name\": \"{name}\", \"value\": {value:?}, \"unit\": \"{unit}\", \"stderr\": null, \"status\": \"fitted\"}}"
            )
        })
        .collect();
    let sentence = effect.sentence_at(&[]).map(|sentence| serde_json::to_string(&sentence).unwrap());
    let sentence = sentence.map(|sentence| format!("\"sentence\": {sentence}, ")).unwrap_or_default();
    format!("{{\"id\": \"{}\", {sentence}\"parameters\": [{}]}}", effect.page().id, parameters.join(", "))
}

/// Values of a column of a CSV file.
pub(crate) fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let at = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

/// The Python that has NumPy: `PAM_PYTHON`, or `python3`. None, and a line that says so, where `modules` are not there.
#[expect(clippy::print_stderr, reason = "a skipped test must be seen")]
pub(crate) fn python(modules: &str) -> Option<PathBuf> {
    let python = PathBuf::from(std::env::var_os("PAM_PYTHON").unwrap_or_else(|| "python3".into()));
    let found = Command::new(&python).args(["-c", &format!("import {modules}")]).output();
    if found.is_ok_and(|output| output.status.success()) {
        return Some(python);
    }
    eprintln!("SKIPPED: {} does not import {modules}; name one that does in PAM_PYTHON", python.display());
    None
}

/// Whether there is a C compiler; a line that says so where there is none.
#[expect(clippy::print_stderr, reason = "a skipped test must be seen")]
pub(crate) fn has_c() -> bool {
    let found = Command::new("cc").arg("--version").output().is_ok();
    if !found {
        eprintln!("SKIPPED: cc is not there, so the header was not compiled");
    }
    found
}
