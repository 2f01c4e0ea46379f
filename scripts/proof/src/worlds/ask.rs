//! What the programs say of a case: they see its recordings and its muscle file, with default options.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use serde_json::Value;

use super::ceiling::{Beside, trees_n};
use super::discovered::Discovered;
use super::left_out::LeftOut;
use super::score::{Answer, Concealed};
use super::truth::{strings, text_of};

/// How a folder of cases is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Layout {
    /// As `worlds` writes it: e1.csv …, h1.csv …, and the force without noise in `truth`.
    Worlds,
    /// Four named recordings and a hold-out.
    Outside,
}

/// Cases, and how they are asked.
#[derive(Debug, Clone)]
pub struct Cases {
    /// Folder with `truth.json`.
    pub folder: PathBuf,
    /// How it is laid out.
    pub layout: Layout,
    /// Folder of the programs.
    pub bin: PathBuf,
    /// Where models and diagnoses are kept, if they are.
    pub keep: Option<PathBuf>,
    /// Where models that were kept are taken from, if they are, rather than identified.
    pub models: Option<PathBuf>,
    /// Script of the boosted trees, where they are asked, too.
    pub trees: Option<PathBuf>,
    /// Whether each single effect is taken out of the catalogue, too.
    pub leave_out: bool,
}

/// One case, and where its files go.
struct Case<'a> {
    cases: &'a Cases,
    name: &'a str,
    estimation: Vec<PathBuf>,
    holdouts: Vec<PathBuf>,
    scratch: PathBuf,
}

/// Runs a program; the last line of its complaint where it refuses.
fn run(mut command: Command) -> Result<Option<String>> {
    let output = command.output().with_context(|| format!("cannot run {}", command.get_program().display()))?;
    Ok(match output.status.code() {
        Some(0 | 1) => None,
        code => {
            let stderr = String::from_utf8_lossy(&output.stderr);
            let last = stderr.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no reason given");
            Some(format!("exit {code:?}: {last}"))
        }
    })
}

fn column(text: &str, name: &str) -> Result<Vec<f64>> {
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().context("an empty file")?;
    let index =
        header.split(',').position(|field| field.trim() == name).with_context(|| format!("no column {name}"))?;
    Ok(lines
        .map(|line| line.split(',').nth(index).and_then(|field| field.trim().parse().ok()).unwrap_or(f64::NAN))
        .collect())
}

impl Cases {
    /// Recordings of a case to estimate on and to judge on.
    fn recordings(&self, case: &str) -> (Vec<PathBuf>, Vec<PathBuf>) {
        let folder = self.folder.join(case);
        match self.layout {
            Layout::Worlds => {
                let numbered = |letter: &str| -> Vec<PathBuf> {
                    (1..)
                        .map(|number| folder.join(format!("{letter}{number}.csv")))
                        .take_while(|path| path.exists())
                        .collect()
                };
                (numbered("e"), numbered("h"))
            }
            Layout::Outside => (
                ["isobaric", "isometric", "sines", "steps"].map(|name| folder.join(format!("{name}.csv.gz"))).to_vec(),
                vec![folder.join("holdout.csv.gz")],
            ),
        }
    }

    /// Asks the programs about `truth`'s case.
    ///
    /// # Errors
    /// Where a program cannot be run or its files cannot be read; a refusal is an answer.
    pub fn ask(&self, truth: &Concealed) -> Result<Answer> {
        let name = &truth.case;
        let (estimation, holdouts) = self.recordings(name);
        ensure!(!estimation.is_empty() && !holdouts.is_empty(), "{name} has no recordings");
        let temporary = tempfile::tempdir()?;
        let scratch = match &self.keep {
            Some(folder) => folder.join(name),
            None => temporary.path().to_owned(),
        };
        fs::create_dir_all(&scratch)?;
        Case { cases: self, name, estimation, holdouts, scratch }.ask(truth)
    }
}

impl Case<'_> {
    fn path(&self, name: &str) -> PathBuf {
        self.scratch.join(name)
    }

    /// The hold-outs, each after its option.
    fn held_out(&self) -> impl Iterator<Item = OsString> {
        self.holdouts.iter().flat_map(|path| ["--holdout".into(), path.clone().into_os_string()])
    }

    /// Diagnosis of the case without the effect `excluded`, as files of that `name`; the complaint where it is refused.
    fn diagnose(&self, name: &str, excluded: Option<&str>) -> Result<Result<Value, String>> {
        let mut diagnose = Command::new(self.cases.bin.join("pam-diagnose"));
        diagnose.args(&self.estimation).arg("--model").arg(self.path("model.json")).args(self.held_out());
        let (out, model) = (self.path(&format!("{name}.json")), self.path(&format!("{name}-model.json")));
        diagnose.arg("--out").arg(&out).arg("--out-model").arg(model).arg("--quiet");
        if let Some(id) = excluded {
            diagnose.args(["--exclude", id]);
        }
        if let Some(reason) = run(diagnose)? {
            return Ok(Err(format!("pam-diagnose {reason}")));
        }
        Ok(Ok(serde_json::from_str(&fs::read_to_string(out)?)?))
    }

    /// Model of the case, or one that was kept; the complaint where it is refused.
    fn identify(&self) -> Result<Option<String>> {
        if let Some(models) = &self.cases.models {
            let kept = models.join(self.name).join("model.json");
            if !kept.exists() {
                return Ok(Some(format!("no {}", kept.display())));
            }
            fs::copy(kept, self.path("model.json"))?;
            return Ok(None);
        }
        let mut identify = Command::new(self.cases.bin.join("pam-identify"));
        identify.args(&self.estimation).args(self.held_out());
        identify.arg("--muscle").arg(self.cases.folder.join(self.name).join("muscle.toml"));
        identify.arg("--out").arg(self.path("model.json")).arg("--quiet");
        Ok(run(identify)?.map(|reason| format!("pam-identify {reason}")))
    }

    fn ask(&self, truth: &Concealed) -> Result<Answer> {
        let refused = |reason: String| Answer {
            refused: Some(reason),
            base_n: f64::INFINITY,
            augmented_n: f64::INFINITY,
            ..Answer::default()
        };
        if let Some(reason) = self.identify()? {
            return Ok(refused(reason));
        }
        let diagnosis = match self.diagnose("diagnosis", None)? {
            Ok(diagnosis) => diagnosis,
            Err(reason) => return Ok(refused(reason)),
        };
        let named = diagnosis["effects"].as_array().into_iter().flatten();
        let regions =
            ["where", "unexplained_where"].into_iter().flat_map(|key| diagnosis[key].as_array().into_iter().flatten());
        let base_n = self.error_n("model.json")?.unwrap_or(f64::INFINITY);
        let augmented_n = self.error_n("diagnosis-model.json")?.unwrap_or(base_n);
        let left_out = match &truth.ids[..] {
            [id] if self.cases.leave_out && truth.kind == "one" => self.left_out(id, base_n)?,
            _ => None,
        };
        let trees_n = match &self.cases.trees {
            Some(script) => self.trees_n(script)?,
            None => None,
        };
        Ok(Answer {
            refused: None,
            verdict: text_of(&diagnosis["verdict"]),
            named: named.map(|effect| (text_of(&effect["id"]), strings(&effect["alternatives"]))).collect(),
            regions: regions.filter_map(region).collect(),
            base_n,
            augmented_n,
            discovered: Discovered::of(&diagnosis),
            settled_left: settled_left(&diagnosis),
            left_out,
            trees_n,
        })
    }

    /// What is said without the effect that was concealed.
    fn left_out(&self, id: &str, base_n: f64) -> Result<Option<LeftOut>> {
        let Ok(diagnosis) = self.diagnose("without", Some(id))? else { return Ok(None) };
        let named =
            diagnosis["effects"].as_array().into_iter().flatten().map(|effect| text_of(&effect["id"])).collect();
        Ok(Some(LeftOut {
            verdict: text_of(&diagnosis["verdict"]),
            named,
            discovered: Discovered::of(&diagnosis),
            error_n: self.error_n("without-model.json")?.unwrap_or(base_n),
        }))
    }

    /// Error of trees that learn what the identified model leaves.
    fn trees_n(&self, script: &Path) -> Result<Option<f64>> {
        let predicted = |files: &[PathBuf], kind: &str| -> Result<Option<Vec<PathBuf>>> {
            let mut written = Vec::new();
            for (index, file) in files.iter().enumerate() {
                let out = self.path(&format!("{kind}{index}.csv"));
                if !self.predict(file, &self.path("model.json"), &out)? {
                    return Ok(None);
                }
                written.push(out);
            }
            Ok(Some(written))
        };
        let (Some(fitted), Some(held)) = (predicted(&self.estimation, "fitted")?, predicted(&self.holdouts, "held")?)
        else {
            return Ok(None);
        };
        Ok(trees_n(script, &fitted, &held, Beside::Model { truth: &self.true_forces() }))
    }

    /// Whether the programs predict the force along a recording.
    fn predict(&self, recording: &Path, model: &Path, out: &Path) -> Result<bool> {
        let mut command = Command::new(self.cases.bin.join("pam-predict"));
        command.arg(recording).arg("--model").arg(model).arg("--out").arg(out).arg("--quiet");
        Ok(run(command)?.is_none())
    }

    /// Files with the force without noise, one for each hold-out; empty where there are none.
    fn true_forces(&self) -> Vec<PathBuf> {
        let folder = self.cases.folder.join("truth").join(self.name);
        let files: Vec<PathBuf> =
            self.holdouts.iter().filter_map(|path| Some(folder.join(path.file_name()?))).collect();
        if files.iter().all(|path| path.exists()) { files } else { Vec::new() }
    }

    /// Root mean square error of a model over all samples of every hold-out, N; none where there is no such model.
    fn error_n(&self, model: &str) -> Result<Option<f64>> {
        let model = self.path(model);
        if !model.exists() {
            return Ok(None);
        }
        let (mut sum, mut count) = (0.0, 0);
        let truth = self.true_forces();
        for (index, holdout) in self.holdouts.iter().enumerate() {
            let (squares, samples) = self.errors(holdout, truth.get(index).map(PathBuf::as_path), &model)?;
            sum += squares;
            count += samples;
        }
        Ok(Some((sum / count as f64).sqrt()))
    }

    /// Sum of squares and number of samples of a model's error along a hold-out.
    fn errors(&self, holdout: &Path, truth: Option<&Path>, model: &Path) -> Result<(f64, usize)> {
        let out = self.path("predicted.csv");
        if !self.predict(holdout, model, &out)? {
            return Ok((f64::INFINITY, 1));
        }
        let predicted = fs::read_to_string(&out)?;
        let model_n = column(&predicted, "force_model_N")?;
        let true_n = match truth {
            Some(path) => column(&fs::read_to_string(path)?, "force_N")?,
            None => column(&predicted, "force_N")?,
        };
        if model_n.len() != true_n.len() {
            return Ok((f64::INFINITY, 1));
        }
        let sum: f64 = model_n.iter().zip(&true_n).map(|(model, truth)| (model - truth).powi(2)).sum();
        Ok((if sum.is_finite() { sum } else { f64::INFINITY }, model_n.len()))
    }
}

/// Factor from a region's unit to that of the places.
fn region(value: &Value) -> Option<(String, f64, f64, Option<String>)> {
    let unit = value["unit"].as_str().unwrap_or_default();
    let (coordinate, factor) = match value["coordinate"].as_str()? {
        "pressure" => ("pressure_kPa", if unit == "kPa" { 1.0 } else { 1e-3 }),
        "contraction" => ("contraction", if unit == "%" { 0.01 } else { 1.0 }),
        "speed" => ("speed_mm_per_s", if unit == "mm/s" { 1.0 } else { 1e3 }),
        "travel_since_reversal" => ("travel_mm", if unit == "mm" { 1.0 } else { 1e3 }),
        "time" => ("time_s", 1.0),
        "force" => ("force_N", 1.0),
        _ => return None,
    };
    let recording = value["recording"].as_str().map(|path| {
        let name = path.rsplit('/').next().unwrap_or(path);
        name.split('.').next().unwrap_or(name).to_owned()
    });
    Some((coordinate.to_owned(), factor * value["from"].as_f64()?, factor * value["to"].as_f64()?, recording))
}

/// What a diagnosis leaves of held-out samples whose direction is settled, as a share of what the base does.
fn settled_left(diagnosis: &Value) -> Option<f64> {
    let holdout = &diagnosis["fit"]["holdout"];
    Some(holdout["rmse_after_n"].as_f64()? / holdout["rmse_before_n"].as_f64()?)
}
