//! Run the programs over cases of the independent bench and score what they say.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use clap::{Parser, ValueEnum};
use pam_proof::discovered::{Discovered, Discoveries};
use pam_proof::worlds_score::{Answer, Concealed, Score, Summary, error_left, score, summarize};
use rayon::prelude::*;
use serde_json::{Value, json};

/// Run identification, diagnosis and prediction over every case of a folder, and score strictly.
///
/// The programs see the recordings and the muscle file with default options; the truth is read afterwards. The error of
/// a model is measured against the force without noise, over all samples of every hold-out.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Example:\n  score-worlds out/worlds --bin target/release --json out/worlds/scores.json"
)]
struct Args {
    /// Folder of cases with truth.json.
    #[arg(value_name = "DIR")]
    folder: PathBuf,

    /// Folder of the programs.
    #[arg(long, value_name = "DIR", default_value = "target/release")]
    bin: PathBuf,

    /// How the folder is laid out.
    #[arg(long, default_value = "worlds")]
    layout: Layout,

    /// Scores to write (JSON).
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// Score only the first cases.
    #[arg(long, value_name = "N")]
    first: Option<usize>,

    /// Keep models and diagnoses in this folder.
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,

    /// Cases at a time; 0 is one a core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    jobs: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Layout {
    Worlds,
    Outside,
}

fn text_of(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), ToOwned::to_owned)
}

fn strings(value: &Value) -> Vec<String> {
    value.as_array().map(|values| values.iter().map(text_of).collect()).unwrap_or_default()
}

fn truths(args: &Args) -> Result<Vec<Concealed>> {
    let path = args.folder.join("truth.json");
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let truth: Value = serde_json::from_str(&text)?;
    let mut concealed = Vec::new();
    match args.layout {
        Layout::Worlds => {
            for case in truth["cases"].as_array().context("truth.json holds no cases")? {
                let mut world: BTreeMap<String, String> = case["world"]
                    .as_object()
                    .map(|world| {
                        world.iter().filter(|(_, v)| !v.is_array()).map(|(k, v)| (k.clone(), text_of(v))).collect()
                    })
                    .unwrap_or_default();
                let severities: Vec<f64> =
                    case["severity_over_floor"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
                if let Some(least) = severities.iter().copied().reduce(f64::min) {
                    let class =
                        ["1.2 to 2.5", "2.5 to 6", "above 6"][usize::from(least > 2.5) + usize::from(least > 6.0)];
                    world.insert("severity".to_owned(), class.to_owned());
                }
                let places = case["place"].as_array().into_iter().flatten().filter_map(|place| {
                    let coordinate = place["coordinate"].as_str()?.to_owned();
                    let recording = place["recording"].as_str().map(ToOwned::to_owned);
                    Some((coordinate, place["from"].as_f64()?, place["to"].as_f64()?, recording))
                });
                concealed.push(Concealed {
                    case: text_of(&case["case"]),
                    kind: text_of(&case["kind"]),
                    ids: strings(&case["concealed"]),
                    places: places.collect(),
                    world,
                    severities,
                });
            }
        }
        Layout::Outside => {
            for (name, case) in truth.as_object().context("truth.json holds no cases")? {
                let ids = strings(&case["concealed"]);
                let kind = match ids.len() {
                    0 => "nothing",
                    1 if ids[0].contains("nameless") => "nameless",
                    1 => "one",
                    _ => "two",
                };
                let world = ["standstill", "rate_hz"].map(|key| (key.to_owned(), text_of(&case[key])));
                concealed.push(Concealed {
                    case: name.clone(),
                    kind: kind.to_owned(),
                    ids,
                    world: world.into_iter().collect(),
                    ..Concealed::default()
                });
            }
        }
    }
    concealed.truncate(args.first.unwrap_or(usize::MAX));
    ensure!(!concealed.is_empty(), "no cases");
    Ok(concealed)
}

/// Recordings of a case to estimate on and to judge on.
fn recordings(args: &Args, case: &str) -> (Vec<PathBuf>, Vec<PathBuf>) {
    let folder = args.folder.join(case);
    match args.layout {
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

/// Sum of squares and number of samples of a model's error along a hold-out.
fn errors(args: &Args, case: &str, holdout: &Path, model: &Path, scratch: &Path) -> Result<(f64, usize)> {
    let out = scratch.join("predicted.csv");
    let mut command = Command::new(args.bin.join("pam-predict"));
    command.arg(holdout).arg("--model").arg(model).arg("--out").arg(&out).arg("--quiet");
    if run(command)?.is_some() {
        return Ok((f64::INFINITY, 1));
    }
    let predicted = fs::read_to_string(&out)?;
    let model_n = column(&predicted, "force_model_N")?;
    let truth_path = holdout.file_name().map(|name| args.folder.join("truth").join(case).join(name));
    let true_n = match truth_path {
        Some(path) if path.exists() => column(&fs::read_to_string(path)?, "force_N")?,
        _ => column(&predicted, "force_N")?,
    };
    if model_n.len() != true_n.len() {
        return Ok((f64::INFINITY, 1));
    }
    let sum: f64 = model_n.iter().zip(&true_n).map(|(model, truth)| (model - truth).powi(2)).sum();
    Ok((if sum.is_finite() { sum } else { f64::INFINITY }, model_n.len()))
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

fn answer(args: &Args, case: &str) -> Result<Answer> {
    let (estimation, holdouts) = recordings(args, case);
    ensure!(!estimation.is_empty() && !holdouts.is_empty(), "{case} has no recordings");
    let temporary = tempfile::tempdir()?;
    let scratch = match &args.keep {
        Some(folder) => folder.join(case),
        None => temporary.path().to_owned(),
    };
    fs::create_dir_all(&scratch)?;
    let path = |name: &str| scratch.join(name);
    let refused = |reason: String| Answer {
        refused: Some(reason),
        base_n: f64::INFINITY,
        augmented_n: f64::INFINITY,
        ..Answer::default()
    };
    let mut identify = Command::new(args.bin.join("pam-identify"));
    identify.args(&estimation).arg("--muscle").arg(args.folder.join(case).join("muscle.toml"));
    identify.args(holdouts.iter().flat_map(|path| ["--holdout".into(), path.clone()]));
    identify.arg("--out").arg(path("model.json")).arg("--quiet");
    if let Some(reason) = run(identify)? {
        return Ok(refused(format!("pam-identify {reason}")));
    }
    let mut diagnose = Command::new(args.bin.join("pam-diagnose"));
    diagnose.args(&estimation).arg("--model").arg(path("model.json"));
    diagnose.args(holdouts.iter().flat_map(|path| ["--holdout".into(), path.clone()]));
    diagnose.arg("--out").arg(path("diagnosis.json")).arg("--out-model").arg(path("augmented.json")).arg("--quiet");
    if let Some(reason) = run(diagnose)? {
        return Ok(refused(format!("pam-diagnose {reason}")));
    }
    let diagnosis: Value = serde_json::from_str(&fs::read_to_string(path("diagnosis.json"))?)?;
    let named = diagnosis["effects"].as_array().into_iter().flatten();
    let regions =
        ["where", "unexplained_where"].into_iter().flat_map(|key| diagnosis[key].as_array().into_iter().flatten());
    let rms = |model: &str| -> Result<f64> {
        let (mut sum, mut count) = (0.0, 0);
        for holdout in &holdouts {
            let (squares, samples) = errors(args, case, holdout, &path(model), &scratch)?;
            sum += squares;
            count += samples;
        }
        Ok((sum / count as f64).sqrt())
    };
    let base_n = rms("model.json")?;
    Ok(Answer {
        refused: None,
        verdict: text_of(&diagnosis["verdict"]),
        named: named.map(|effect| (text_of(&effect["id"]), strings(&effect["alternatives"]))).collect(),
        regions: regions.filter_map(region).collect(),
        base_n,
        discovered: Discovered::of(&diagnosis),
        settled_left: settled_left(&diagnosis),
        augmented_n: if path("augmented.json").exists() { rms("augmented.json")? } else { base_n },
    })
}

/// What a diagnosis leaves of held-out samples whose direction is settled, as a share of what the base does.
fn settled_left(diagnosis: &Value) -> Option<f64> {
    let holdout = &diagnosis["fit"]["holdout"];
    Some(holdout["rmse_after_n"].as_f64()? / holdout["rmse_before_n"].as_f64()?)
}

fn discoveries(scores: &[Score], out: &mut impl Write) -> Result<Discoveries> {
    let found = Discoveries::of(scores);
    writeln!(out, "nothing: nothing discovered            {}", found.nothing_where_nothing)?;
    writeln!(out, "nameless: discovered                   {}", found.discovered)?;
    writeln!(out, "  of these with its driver             {}", found.driver)?;
    writeln!(out, "  of these with its memory             {}", found.memory)?;
    writeln!(out, "nameless: error not above the base's   {}", found.no_harm)?;
    if let Some((median, most)) = found.error_left {
        writeln!(out, "nameless: error left, median / 90 %    {median:.3} / {most:.3}")?;
    }
    if let Some((median, most)) = found.settled_left {
        writeln!(out, "  where the direction is settled       {median:.3} / {most:.3}")?;
    }
    Ok(found)
}

fn table(out: &mut impl Write, title: &str, groups: &BTreeMap<String, Summary>) -> Result<()> {
    writeln!(
        out,
        "\n{title:<34} {:>14} {:>14} {:>14} {:>14} {:>14} {:>14}  left 50/90 %",
        "strict", "nothing", "one first", "one only", "or altern.", "nameless"
    )?;
    for (name, sum) in groups {
        let left = sum.error_left.map_or_else(String::new, |(median, most)| format!("{median:.2} / {most:.2}"));
        writeln!(
            out,
            "  {name:<32} {:>14} {:>14} {:>14} {:>14} {:>14} {:>14}  {left}",
            sum.strict, sum.nothing, sum.one_right_first, sum.one_right_only, sum.one_or_alternative, sum.nameless
        )?;
    }
    Ok(())
}

fn report(scores: &[Score], out: &mut impl Write) -> Result<Value> {
    let all: Vec<&Score> = scores.iter().collect();
    let sum = summarize(&all);
    writeln!(out, "nothing: consistent                    {}", sum.nothing)?;
    writeln!(out, "one: right name first                  {}", sum.one_right_first)?;
    writeln!(out, "one: right name and no other           {}", sum.one_right_only)?;
    writeln!(out, "one: name or declared alternative      {}", sum.one_or_alternative)?;
    writeln!(out, "two: both and no other                 {}", sum.both_only)?;
    writeln!(out, "two: both, at most one other           {}", sum.both_and_one_other)?;
    writeln!(out, "nameless: no name, not consistent      {}", sum.nameless)?;
    writeln!(out, "regions that meet a known place        {}", sum.regions)?;
    writeln!(out, "refused                                {}", sum.refused)?;
    writeln!(out, "all, strict                            {}", sum.strict)?;
    writeln!(out, "all, end-taper forgiven on slices      {}", sum.strict_but_ends)?;
    if let Some((median, most)) = sum.error_left {
        writeln!(out, "held-out error left, median / 90 %     {median:.3} / {most:.3}")?;
    }
    let found = discoveries(scores, out)?;
    let mut by_world: BTreeMap<String, BTreeMap<String, Vec<&Score>>> = BTreeMap::new();
    let mut by_effect: BTreeMap<String, Vec<&Score>> = BTreeMap::new();
    for score in scores {
        for (attribute, value) in &score.truth.world {
            by_world.entry(attribute.clone()).or_default().entry(value.clone()).or_default().push(score);
        }
        if score.truth.kind == "one" || score.truth.kind == "nameless" {
            by_effect.entry(score.truth.ids.join(" ")).or_default().push(score);
        }
    }
    let summaries = |groups: &BTreeMap<String, Vec<&Score>>| -> BTreeMap<String, Summary> {
        groups.iter().map(|(name, scores)| (name.clone(), summarize(scores))).collect()
    };
    let mut worlds = BTreeMap::new();
    for (attribute, groups) in &by_world {
        let groups = summaries(groups);
        table(out, attribute, &groups)?;
        worlds.insert(attribute.clone(), groups);
    }
    let effects = summaries(&by_effect);
    table(out, "effect", &effects)?;
    writeln!(
        out,
        "\nmisses: case, concealed (size over floor), verdict, named (alternatives), error left, base error in N"
    )?;
    for score in scores.iter().filter(|score| !score.strict) {
        let named: Vec<String> = score
            .answer
            .named
            .iter()
            .map(|(id, others)| if others.is_empty() { id.clone() } else { format!("{id} ({})", others.join(", ")) })
            .collect();
        let sizes: Vec<String> = score.truth.severities.iter().map(|size| format!("{size:.1}")).collect();
        let truth = if score.truth.ids.is_empty() { "nothing".to_owned() } else { score.truth.ids.join(" + ") };
        writeln!(
            out,
            "  {} {truth} [{}] | {} | {} | {:.2} | {:.2}",
            score.truth.case,
            sizes.join(", "),
            score.answer.refused.as_deref().unwrap_or(&score.answer.verdict),
            named.join("; "),
            error_left(score),
            score.answer.base_n,
        )?;
    }
    Ok(json!({ "overall": sum, "discoveries": found, "by_world": worlds, "by_effect": effects, "cases": scores }))
}

fn main() -> Result<()> {
    let args = Args::parse();
    let cases = truths(&args)?;
    if args.layout == Layout::Outside && !args.folder.join("truth").exists() {
        writeln!(
            std::io::stdout(),
            "no force without noise in {}: errors are against the recorded force",
            args.folder.display()
        )?;
    }
    for program in ["pam-identify", "pam-diagnose", "pam-predict"] {
        if !args.bin.join(program).exists() {
            bail!("no {program} in {}", args.bin.display());
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.jobs).build()?;
    let scores: Vec<Score> = pool.install(|| {
        cases
            .into_par_iter()
            .map(|truth| -> Result<Score> {
                let answer = answer(&args, &truth.case)?;
                Ok(score(truth, answer))
            })
            .collect::<Result<_>>()
    })?;
    let value = report(&scores, &mut std::io::stdout().lock())?;
    if let Some(path) = &args.json {
        let mut text = serde_json::to_string_pretty(&value)?;
        text.push('\n');
        fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}
