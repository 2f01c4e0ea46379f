//! Muscles of one rig in, what the rig does to all of them and what is left for each out.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, ensure};
use pam_artifact::group::{GroupArtifact, GroupMuscle, HeldOutShare, RigEffect, Says};
use pam_artifact::group_file::{GroupMember, group_members};
use pam_artifact::{Input, InputRole, ModelArtifact, Tool, readable_json};
use pam_cli::{Console, Output, publish, read_recordings};
use pam_diagnosis::artifact::Head;
use pam_diagnosis::diagnose::{Request, check};
use pam_diagnosis::group::diagnose_group;
use pam_recording::sha256_hex;
use pam_recording::spelling::unreadable;
use pam_report::Table;
use pam_report::number::{engineering, engineering_with_stderr, significant};
use pam_report::text::wrapped;

use crate::args::Args;
use crate::own::OwnEffects;

pub(crate) fn group(args: &Args, own: &OwnEffects, console: &Console, path: &Path) -> anyhow::Result<pam_cli::Verdict> {
    let shown = path.display();
    let text = std::fs::read_to_string(path)
        .map_err(|reason| anyhow!("cannot read {shown}: {}", unreadable(path, &reason)))?;
    let mut members = group_members(&text).map_err(|fault| anyhow!("{shown}: {fault}"))?;
    members.iter_mut().for_each(|member| beside(member, path));
    let files =
        || members.iter().flat_map(|member| [&member.model].into_iter().chain(&member.logs).chain(&member.holdout));
    let out = args.out.as_deref().filter(|_| !args.run.check);
    let out = out.map(|out| -> anyhow::Result<Output> {
        let inputs = files().chain(&args.group).chain(&args.read.channels).chain(&args.effects);
        Ok(Output::open(out)?.apart_from(inputs)?)
    });
    let out = out.transpose()?;
    let read = args.read.resolve()?;
    let mut inputs =
        vec![Input { path: shown.to_string(), sha256: sha256_hex(text.as_bytes()), role: InputRole::Configuration }];
    inputs.extend(read.channels);
    inputs.extend(own.input.clone());
    let mut requests: Vec<(String, Request)> = Vec::new();
    for member in &members {
        let (model, sha256) = ModelArtifact::read(&member.model)?;
        inputs.push(Input { path: member.model.display().to_string(), sha256, role: InputRole::Model });
        let estimation = read_recordings(&member.logs, &read.options, console)?;
        let holdout = read_recordings(&member.holdout, &read.options, console)?;
        for (recordings, role) in [(&estimation, InputRole::Estimation), (&holdout, InputRole::Validation)] {
            for recording in recordings {
                let known = inputs.iter().find(|input| input.sha256 == recording.sha256);
                if let Some(known) = known {
                    let path = &recording.path;
                    return Err(anyhow!("{path}: is the same recording as {}; name each once", known.path));
                }
                inputs.push(Input::recording(recording, role));
            }
        }
        let request = Request {
            estimation,
            holdout,
            model,
            config: args.config(),
            effects: own.effects.clone(),
            rig: Vec::new(),
            accept_implausible: args.accept_implausible,
        };
        requests.push((member.name.clone(), request));
    }
    if args.run.check {
        for (_, request) in requests {
            check(request)?;
        }
        console.note("inputs are fine; nothing was diagnosed (--check)");
        return Ok(pam_cli::Verdict::Accepted);
    }
    let progress = console.progress("diagnosing", 1);
    let found = diagnose_group(requests, &|done, all| progress.set_of(done, all))?;
    drop(progress);
    let tool = Tool { name: "pam-diagnose".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() };
    let artifact = found.artifact(Head { tool, inputs, seed: args.run.seed }, args.config());
    console.text(said(&artifact));
    for warning in &artifact.warnings {
        console.warn(warning);
    }
    if let Some(output) = out {
        publish(vec![(output, readable_json(&artifact)?)], console)?;
    }
    Ok(if found.is_explained() { pam_cli::Verdict::Accepted } else { pam_cli::Verdict::Rejected })
}

/// Refuses what a group has no place for.
pub(crate) fn refuse_with_group(args: &Args) -> anyhow::Result<()> {
    ensure!(
        args.group.is_none() || args.logs.is_empty(),
        "--group names the recordings of every muscle in its file; give none on the command line"
    );
    Ok(())
}

/// Makes the paths of `member` those of the folder in which the file of the group lies.
fn beside(member: &mut GroupMember, path: &Path) {
    let folder = path.parent().unwrap_or(Path::new(""));
    let place = |path: &mut PathBuf| *path = folder.join(&path);
    place(&mut member.model);
    member.logs.iter_mut().chain(&mut member.holdout).for_each(place);
}

/// Tables and messages for the terminal.
fn said(artifact: &GroupArtifact) -> String {
    let mut text = wrapped(&artifact.statement, "");
    text.push('\n');
    for effect in &artifact.rig {
        text.push('\n');
        text.push_str(&effect_of_the_rig(effect));
    }
    text.push('\n');
    text.push_str(&muscles(&artifact.muscles));
    for effect in &artifact.rig {
        let test = wrapped(&format!("Test that decides on {}: {}", effect.id, effect.separating_test), "");
        text.push_str(&format!("{test}\n"));
    }
    text
}

fn effect_of_the_rig(effect: &RigEffect) -> String {
    let mut table = Table::new(["of the rig", "value", "log predictive ratio"]);
    table.row([effect.id.clone(), String::new(), significant(effect.log_ratio, 3)]);
    for entry in &effect.parameters {
        let value = match entry.stderr {
            Some(stderr) => engineering_with_stderr(entry.value, stderr, &entry.unit),
            None => engineering(entry.value, &entry.unit, 3),
        };
        table.row([format!("  {}", entry.name), value]);
    }
    for one in &effect.muscles {
        let says = match one.says {
            Says::Shows => "shows it",
            Says::CannotShow => "cannot show it",
            Says::Differs => "has another value",
            Says::Denies => "speaks against it",
        };
        table.row([format!("  {}", one.muscle), says.to_owned(), significant(one.log_ratio, 2)]);
    }
    for other in &effect.alternatives {
        table.row([format!("  or {other}")]);
    }
    if let Some(HeldOutShare { share, stderr }) = effect.held_out {
        let shown = format!("({:.0} ± {:.0}) % of its size", 100.0 * share, 100.0 * stderr);
        table.row(["  held-out recordings".to_owned(), shown]);
    }
    table.to_terminal()
}

fn muscles(muscles: &[GroupMuscle]) -> String {
    let head = ["muscle", "of its own", "RMSE, all samples", "eq. 11 N", "alone N", "together N"];
    let mut table = Table::new(head);
    for muscle in muscles {
        let own: Vec<&str> = muscle.effects.iter().map(|effect| effect.id.as_str()).collect();
        let own = if own.is_empty() { "-".to_owned() } else { own.join(", ") };
        let (on, residual) = match muscle.holdout {
            Some(holdout) => ("held out", holdout),
            None => ("fitted", muscle.estimation),
        };
        let numbers = [residual.base_all_n, residual.alone_all_n, residual.together_all_n];
        let [base, alone, together] = numbers.map(|number| significant(number, 3));
        table.row([muscle.name.clone(), own, on.to_owned(), base, alone, together]);
    }
    table.to_terminal()
}
