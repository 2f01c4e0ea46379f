use super::super::separation::Separation;
use super::super::separation::tests::{explanation, of};
use super::*;
use crate::rehearsal::tests::{Given, domain};

/// The path that would tell the two apart, where `truth` made the recordings and both were fitted to them.
fn between(
    protocols: &[&str],
    truth: (&'static str, &[f64], &[f64]),
    rival: (&'static str, &[f64]),
) -> (NextExperiment, Setpoints, Vec<Separation>) {
    let given = Given::of(protocols, &[truth]);
    let setting = given.setting();
    let explanations = [explanation(&given, truth.0, truth.1), explanation(&given, rival.0, rival.1)];
    let reach = Reach::of(&domain(), &explanations[0].state.model, false);
    let all = separations(&setting, &PROTOCOLS, &reach, &explanations);
    let (experiment, setpoints) = separate(&setting, &explanations, 0.3, &domain()).expect("an experiment");
    (experiment, setpoints, all)
}

#[test]
fn a_lag_and_a_delay_of_the_pressure_ask_for_a_pressure_chirp() {
    let (experiment, setpoints, _) =
        between(&["isometric-ramps"], ("pressure-lag", &[0.02, 0.0], &[]), ("channel-delay", &[-0.02, 0.0]));
    assert_eq!(experiment.protocol, "pressure-chirp");
    assert_eq!(experiment.separates, ["pressure-lag", "channel-delay"]);
    assert!(setpoints.duration_s() > 300.0);
}

#[test]
fn damping_and_a_late_length_ask_for_something_else_than_they_were_seen_in() {
    let (experiment, _, all) =
        between(&["rate-ladder"], ("viscous-damping", &[], &[50.0, 100.0]), ("channel-delay", &[0.0, 0.012]));
    // A locked length shows neither; the stiffness changes with pressure and length otherwise than damping does, which
    // takes fast and wide motion at several pressures to see.
    assert_eq!(experiment.protocol, "length-chirp");
    assert!(of(&all, "pressure-chirp").pairs_n[0] < 1e-6);
}

/// A delay of the force shows where damping does not act at all.
#[test]
fn damping_and_an_early_force_ask_for_a_pressure_chirp() {
    let (experiment, ..) =
        between(&["rate-ladder"], ("viscous-damping", &[], &[50.0, 100.0]), ("channel-delay", &[0.012, 0.012]));
    assert_eq!(experiment.protocol, "pressure-chirp");
}

#[test]
fn any_number_of_threads_gives_the_same_answer() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let (experiment, setpoints, all) =
                between(&["isometric-ramps"], ("pressure-lag", &[0.02, 0.0], &[]), ("channel-delay", &[-0.02, 0.0]));
            let bits: Vec<u64> = all.iter().flat_map(|separation| &separation.pairs_n).map(|n| n.to_bits()).collect();
            (experiment, setpoints, bits)
        })
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn the_page_of_an_effect_names_the_protocol_that_confirms_it() {
    let given = Given::of(&["isobaric-triangles", "minor-loops"], &[("presliding-hysteresis", &[1e-3, 1.0, 0.0], &[])]);
    let setting = given.setting();
    let with = explanation(&given, "presliding-hysteresis", &[1e-3, 1.0, 0.0]);
    let without = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
    let effect = with.state.guesses[0].effect;
    let explanations = [with, Explanation { id: "nothing", state: without }];
    let (experiment, _) = confirm(&setting, effect, &explanations, 0.3, &domain()).expect("an experiment");
    assert_eq!(experiment.protocol, "minor-loops");
    assert!(experiment.separation_n > 0.5);
}
