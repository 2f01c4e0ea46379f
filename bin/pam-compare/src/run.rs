//! Two models and recordings in, a comparison out.

use anyhow::ensure;
use pam_artifact::comparison::{CompareConfig, ComparisonArtifact, Outcome, SCHEMA};
use pam_artifact::{Input, InputRole, ModelArtifact, Tool, readable_json};
use pam_cli::{Output, Verdict, publish, read_recordings};
use pam_comparison::blocks::Resampling;
use pam_comparison::{compare, parameters};

use crate::args::Args;
use crate::tables;

/// Level of the intervals.
const LEVEL: f64 = 0.95;

pub(crate) fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    let from_stdin = args.logs.iter().filter(|path| path.as_os_str() == "-").count();
    ensure!(from_stdin <= 1, "standard input can be read once only; name the other recordings as files");
    for (index, log) in args.logs.iter().enumerate() {
        ensure!(!args.logs[..index].contains(log), "{}: is named twice; name each recording once", log.display());
    }
    let inputs = || [&args.a, &args.b].into_iter().chain(&args.logs).chain(&args.read.channels);
    let out = args.out.as_deref().filter(|_| !args.run.check);
    let out = out.map(|path| Output::open(path)?.apart_from(inputs())).transpose()?;

    let (a, sha256_a) = ModelArtifact::read(&args.a)?;
    let (b, sha256_b) = ModelArtifact::read(&args.b)?;
    ensure!(
        sha256_a != sha256_b,
        "{} and {} are the same model; name two to compare",
        args.a.display(),
        args.b.display()
    );
    let read = args.read.resolve()?;
    let recordings = read_recordings(&args.logs, &read.options, &console)?;
    let mut hashes: Vec<Input> = [(&args.a, sha256_a), (&args.b, sha256_b)]
        .map(|(path, sha256)| Input { path: path.display().to_string(), sha256, role: InputRole::Model })
        .into();
    hashes.extend(read.channels);
    hashes.extend(recordings.iter().map(|recording| Input::recording(recording, InputRole::Validation)));
    let resampling = Resampling { n: args.resamples as usize, level: LEVEL, seed: args.run.seed };
    let compared = compare([&a, &b], &recordings, args.accept_implausible, resampling)?;
    if args.run.check {
        console.note("inputs are fine; nothing was written (--check)");
        return Ok(Verdict::Accepted);
    }
    let artifact = ComparisonArtifact {
        schema: SCHEMA.to_owned(),
        tool: Tool { name: "pam-compare".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() },
        inputs: hashes,
        config: CompareConfig {
            n_resamples: args.resamples as usize,
            level: LEVEL,
            accept_implausible: args.accept_implausible,
        },
        seed: args.run.seed,
        outcome: compared.outcome,
        together: compared.together,
        recordings: compared.recordings,
        parameters: parameters([&a, &b]),
        effects_a: a.effects.iter().map(|effect| effect.id.clone()).collect(),
        effects_b: b.effects.iter().map(|effect| effect.id.clone()).collect(),
    };
    console.text(tables::all(&artifact));
    for words in tables::warnings(&artifact) {
        console.warn(words);
    }
    let outputs = match out {
        Some(output) => vec![(output, readable_json(&artifact)?)],
        None => Vec::new(),
    };
    publish(outputs, &console)?;
    Ok(if artifact.outcome == Outcome::A { Verdict::Rejected } else { Verdict::Accepted })
}
