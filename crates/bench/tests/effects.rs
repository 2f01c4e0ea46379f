//! Concealed effects as a user of the library meets them.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic")]

use pam_virtual_bench::catalogue::EFFECTS;
use pam_virtual_bench::concealed::ConcealedError;
use pam_virtual_bench::{Bench, BenchRecording, Concealed, Options, TrueMuscle, command};

/// Short, and slack where the effect asks for that.
const SHORT: Options =
    Options { seed: 3, duration_scale: 0.05, highest_pressure_pa: 500e3, lowest_tension_n: f64::NEG_INFINITY };

/// Every effect shows in at least one of these.
const PROTOCOLS: [&str; 3] = ["multisine", "rate-ladder", "isometric-ramps"];

fn bench(protocol: &str, concealed: &[Concealed]) -> Bench {
    let muscle = TrueMuscle::nominal();
    let command = command(protocol, &muscle, &SHORT).unwrap();
    Bench::new(muscle, command).with_effects(concealed, 11).unwrap()
}

/// Largest difference that a perfect logger would see: force in N, pressure in kPa, length in mm.
fn difference(a: &BenchRecording, b: &BenchRecording) -> f64 {
    let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    largest(&a.ideal_force_n, &b.ideal_force_n)
        .max(largest(&a.ideal_pressure_pa, &b.ideal_pressure_pa) * 1e-3)
        .max(largest(&a.ideal_length_m, &b.ideal_length_m) * 1e3)
}

fn csv(recording: &BenchRecording) -> Vec<u8> {
    let mut bytes = Vec::new();
    recording.write_csv(&mut bytes).unwrap();
    bytes
}

#[test]
fn without_effects_the_ideal_log_is_the_truth() {
    let recording = bench("multisine", &[]).record(1);
    assert_eq!(recording.ideal_force_n, recording.true_force_n);
    assert_eq!(recording.ideal_pressure_pa, recording.true_pressure_pa);
    assert_eq!(recording.ideal_length_m, recording.true_length_m);
}

#[test]
fn every_effect_shows_in_a_protocol_and_vanishes_at_no_severity() {
    for effect in EFFECTS {
        let mut shown = 0.0_f64;
        for protocol in PROTOCOLS {
            let plain = bench(protocol, &[]).record(1);
            let none = bench(protocol, &[Concealed::new(effect.id, 0.0)]).record(1);
            assert!(difference(&plain, &none) < 1e-9, "{} in {protocol}", effect.id);
            let some = bench(protocol, &[Concealed::new(effect.id, 1.0)]).record(1);
            assert_eq!(plain.n_samples(), some.n_samples());
            assert!(some.ideal_force_n.iter().all(|force_n| force_n.is_finite()), "{}", effect.id);
            shown = shown.max(difference(&plain, &some));
        }
        // Twice the noise of any channel.
        assert!(shown > 0.4, "{}: {shown}", effect.id);
    }
}

#[test]
fn twice_the_severity_is_about_twice_the_effect_where_amplitudes_are_meant() {
    for id in ["rubber-hysteresis", "viscous-damping", "braid-lockup", "force-drift", "end-taper", "inertia"] {
        let plain = bench("rate-ladder", &[]).record(1);
        let with = |severity| difference(&plain, &bench("rate-ladder", &[Concealed::new(id, severity)]).record(1));
        let (once, twice) = (with(1.0), with(2.0));
        assert!((twice - 2.0 * once).abs() <= 0.02 * twice, "{id}: {once} {twice}");
    }
}

#[test]
fn all_effects_together_run_on_any_muscle() {
    let all: Vec<Concealed> = EFFECTS.iter().map(|effect| Concealed::new(effect.id, 1.0)).collect();
    let options = Options { duration_scale: 0.01, ..SHORT };
    for (seed, protocol) in (0..).zip(["multisine", "rate-ladder", "isometric-ramps", "lift"]) {
        let muscle = TrueMuscle::random(seed);
        let command = command(protocol, &muscle, &options).unwrap();
        let bench = Bench::new(muscle, command).with_effects(&all, 2).unwrap();
        let recording = bench.with_smooth_misfit(0.5).unwrap().record(1);
        assert!(recording.ideal_force_n.iter().all(|force_n| force_n.is_finite()), "{protocol}");
    }
}

#[test]
fn equal_seeds_give_equal_bytes_and_the_order_of_effects_does_not_matter() {
    let effects =
        [Concealed::new("force-drift", 1.0), Concealed::new("series-compliance", 1.0), Concealed::new("stribeck", 1.0)];
    let reversed: Vec<Concealed> = effects.iter().rev().cloned().collect();
    let first = csv(&bench("rate-ladder", &effects).record(4));
    assert_eq!(first, csv(&bench("rate-ladder", &effects).record(4)));
    assert_eq!(first, csv(&bench("rate-ladder", &reversed).record(4)));
    assert_ne!(first, csv(&bench("rate-ladder", &effects).record(5)));
}

#[test]
fn recordings_that_share_the_seed_of_effects_conceal_the_same() {
    let all: Vec<Concealed> = EFFECTS
        .iter()
        .filter(|effect| !["force-step", "force-drift"].contains(&effect.id))
        .map(|effect| Concealed::new(effect.id, 1.0))
        .collect();
    assert_eq!(bench("multisine", &all).effects(), bench("lift", &all).effects());
    let other = bench("multisine", &all).with_effects(&all, 12).unwrap();
    assert_ne!(bench("multisine", &all).effects(), other.effects());
}

#[test]
fn places_lie_where_protocols_go() {
    let muscles = (0..20).map(TrueMuscle::random).chain([TrueMuscle::nominal()]);
    for (seed, muscle) in muscles.enumerate() {
        let command = command("isobaric-triangles", &muscle, &Options { lowest_tension_n: 5.0, ..SHORT }).unwrap();
        let reached = muscle.muscle().contraction_ratio(command.length_range_m().0);
        let all: Vec<Concealed> = EFFECTS.iter().map(|effect| Concealed::new(effect.id, 1.0)).collect();
        let bench = Bench::new(muscle, command).with_effects(&all, seed as u64).unwrap();
        let plain = bench.clone().with_effects(&[], 0).unwrap().record(1);
        let highest_n = plain.true_force_n.iter().copied().fold(0.0, f64::max);
        for effect in bench.effects() {
            let Some(place) = &effect.place else { continue };
            assert!(place.from < place.to, "{}", effect.id);
            match place.coordinate {
                "contraction" => assert!(place.from > 0.0 && place.from < 0.9 * reached, "{}", effect.id),
                "force" => assert!(place.to < 0.6 * highest_n, "{}", effect.id),
                "pressure" => assert!(place.to < 200e3, "{}: {}", effect.id, place.to),
                "time" => assert!(place.to <= bench.command().duration_s(), "{}", effect.id),
                _ => (),
            }
        }
    }
}

#[test]
fn a_step_falls_into_the_second_third_of_its_recording() {
    for protocol in PROTOCOLS {
        let bench = bench(protocol, &[Concealed::new("force-step", 1.0)]);
        let instant_s = bench.effects()[0].place.as_ref().unwrap().from;
        let recording = bench.record(1);
        let before = recording.time_s.iter().filter(|time_s| **time_s < instant_s).count() as f64;
        let share = before / recording.n_samples() as f64;
        assert!((1.0 / 3.0..2.0 / 3.0).contains(&share), "{protocol}: {share}");
    }
}

#[test]
fn what_cannot_be_concealed_is_refused_by_name() {
    let refused = |concealed: &[Concealed]| bench("lift", &[]).with_effects(concealed, 1).unwrap_err();
    let unknown = refused(&[Concealed::new("gravity", 1.0)]);
    assert_eq!(unknown, ConcealedError::Unknown { id: "gravity".to_owned() });
    let severity = refused(&[Concealed::new("slack", -1.0)]);
    assert_eq!(severity.to_string(), "severity -1 of slack is outside 0 to 100; 1 is typical");
    let twice = refused(&[Concealed::new("slack", 1.0), Concealed::new("slack", 0.5)]);
    assert_eq!(twice, ConcealedError::Twice { id: "slack".to_owned() });
}
