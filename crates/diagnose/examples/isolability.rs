//! Diagnose recordings; print what they could tell apart, what to record next, and how long either takes.
#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "an example")]

use std::path::Path;
use std::time::Instant;

use pam_artifact::ModelArtifact;
use pam_artifact::diagnosis::DiagnoseConfig;
use pam_diagnosis::artifact::Agreement;
use pam_diagnosis::diagnose::{MAX_EFFECTS, Request, diagnose};
use pam_recording::{ReadOptions, read_recording};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let (model, _) = ModelArtifact::read(Path::new(&arguments.next().unwrap())).unwrap();
    let estimation = arguments.map(|path| read_recording(Path::new(&path), &ReadOptions::default()).unwrap()).collect();
    let config = DiagnoseConfig { matters_above_n: None, max_effects: MAX_EFFECTS, excluded: Vec::new() };
    let begin = Instant::now();
    let mut found = diagnose(Request {
        estimation,
        holdout: Vec::new(),
        model,
        config,
        effects: Vec::new(),
        rig: Vec::new(),
        accept_implausible: false,
    })
    .unwrap();
    let seconds = begin.elapsed().as_secs_f64();
    let agreement = Agreement::of(&found).unwrap();
    found.weigh(&agreement).unwrap();
    println!("{seconds:.2} s: {}", found.statement);
    let isolability = &found.isolability;
    for (index, id) in isolability.ids.iter().enumerate() {
        let like: Vec<String> = (0..isolability.ids.len())
            .filter(|&other| other != index && isolability.cosine[index][other] > 0.8)
            .map(|other| format!("{} {:.2}", isolability.ids[other], isolability.cosine[index][other]))
            .collect();
        println!("  {id:26} {:8.3} N  {}", isolability.visible_n[index], like.join(", "));
    }
    for effect in &found.effects {
        println!("{} or {:?}", effect.id, effect.alternatives);
    }
    if let Some((experiment, setpoints)) = &found.next_experiment {
        println!("{experiment:#?}\n{} set-points, {:.0} s", setpoints.points.len(), setpoints.duration_s());
    }
}
