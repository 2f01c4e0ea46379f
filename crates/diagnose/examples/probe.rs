//! Diagnose recordings and print what was weighed.
#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "an example")]

use pam_artifact::ModelArtifact;
use pam_diagnosis::problem::{DiagnosisProblem, SearchOutcome};
use pam_diagnosis::search::{Limits, chance};
use pam_diagnosis::track::Track;
use pam_identification::prepare::{direct, gate};
use pam_recording::{ReadOptions, read_recording};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let (model, _) = ModelArtifact::read(std::path::Path::new(&arguments.next().unwrap())).unwrap();
    let recordings =
        arguments.map(|path| read_recording(std::path::Path::new(&path), &ReadOptions::default()).unwrap()).collect();
    let begin = std::time::Instant::now();
    let gates = gate(recordings).unwrap();
    let prepared = direct(gates, model.direction, model.form).unwrap();
    let track = Track::of(&prepared, model.direction, &model.force_model()).unwrap();
    println!("{} instants, {} counted, {} blocks", track.n(), track.n_counted(), track.blocks.len());
    let limits = Limits {
        max_effects: 4,
        excluded: Vec::new(),
        own: Vec::new(),
        matters_above_n: None,
        sensor_floor_n: model.fit.noise_floor_n,
        only: None,
        confirmed: false,
    };
    let question = DiagnosisProblem::new(&prepared, &model, limits);
    let SearchOutcome { track, found, besides, sizes, .. } = question.answer(&track, &|| {}).unwrap();
    let setting = question.setting(&track, &found.nuisance);
    println!(
        "base {:.3} N, floor {:.3} N, sensor floor {:.3} N",
        found.base.held_out.mean_square().sqrt(),
        found.floor_square.sqrt(),
        model.fit.noise_floor_n
    );
    for trial in &found.first {
        println!(
            "  {:28} log ratio {:7.2}  rmse {:7.3}  p {:.1e} {:?}",
            trial.guess.id(),
            trial.log_ratio,
            trial.held_out.mean_square().sqrt(),
            chance(&found.base.held_out, &trial.held_out),
            trial.guess.shape
        );
    }
    let remainder = pam_diagnosis::structure::ProjectedResidual::of(&setting, &found.best.state);
    for feature in &found.features {
        let one = remainder.structure(&[feature]);
        println!(
            "  {:?} odd {} plane {}: {:?}",
            feature.coordinate,
            feature.odd,
            feature.plane,
            one.map(|one| one.held_out.mean_square().sqrt())
        );
    }
    println!("{:?}", remainder.structure(&[]).map(|one| one.held_out.mean_square().sqrt()));
    println!("pooled {:.3} N", found.best.state.fit.mean_square.sqrt());
    let residuals = setting.residuals_n(&found.best.state);
    for range in &track.recordings {
        let here: Vec<f64> = range.clone().filter(|&at| track.counted[at]).map(|at| residuals[at]).collect();
        println!(
            "   recording: mean {:.2} rms {:.2}",
            here.iter().sum::<f64>() / here.len() as f64,
            (here.iter().map(|r| r * r).sum::<f64>() / here.len() as f64).sqrt()
        );
    }
    println!("best {:.3} N: {:?}", found.best.held_out.mean_square().sqrt(), found.best.state.guesses);
    println!("amplitudes {:?} theta {:?}", found.best.state.fit.amplitudes, found.best.state.fit.parameters.theta);
    for (guess, taken) in found.best.state.guesses.iter().zip(&found.taken) {
        println!("without {} {:.3} N", guess.id(), taken.without.mean_square().sqrt());
        for rival in taken.rivals.iter().take(4) {
            println!("    {:28} {:.2} {:.3}", rival.guess.id(), rival.log_ratio, rival.held_out.mean_square().sqrt());
        }
    }
    let at_bound = &found.best.state.fit.at_bound;
    println!("at bound {at_bound:?}");
    if let Some(left) = &found.left {
        println!("left unnamed: {:.3} N", left.held_out.mean_square().sqrt());
    }
    println!("besides {besides:?}");
    let verdict = pam_diagnosis::verdict::verdict(&found, &sizes, !besides.is_empty());
    let alternatives: Vec<Vec<&str>> =
        (0..found.taken.len()).map(|i| pam_diagnosis::verdict::alternatives(&found, i)).collect();
    let mut names: Vec<&str> = found.best.state.guesses.iter().map(|guess| guess.id()).collect();
    names.extend(besides.ids());
    let firsts: Vec<String> = found
        .first
        .iter()
        .take(4)
        .map(|t| format!("{}:{:.1}/{:.2}", t.guess.id(), t.log_ratio, t.held_out.mean_square().sqrt()))
        .collect();
    println!(
        "RESULT\t{}\t{:.3}\t{:.3}\t{:.3}\t{:.3}\t{}\t{:.2}\t{:?}\t{:.2}\t{:.2}\t{:.2}\t{:.2}\t{:?}",
        names.join("+"),
        found.base.held_out.mean_square().sqrt(),
        found.best.held_out.mean_square().sqrt(),
        found.floor_square.sqrt(),
        model.fit.noise_floor_n,
        firsts.join(" "),
        begin.elapsed().as_secs_f64(),
        verdict,
        sizes.floor_n,
        sizes.mismatch_n,
        sizes.left_n,
        sizes.share_left(),
        alternatives
    );
}
