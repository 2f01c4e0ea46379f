use super::*;

#[test]
fn berg_reaches_half_of_sliding_from_rest_after_its_half_travel() {
    let mut loop_ =
        Berg { half_m: 1e-3, size_n: 10.0, last_m: None, direction: 0.0, since_m: 0.0, turned_at: 0.0, state: 0.0 };
    let mut at = |length_m: f64| loop_.added_n(&Moment { length_m, dt_s: 1e-3, ..Moment::default() });
    at(0.2);
    assert!((at(0.199) + 5.0).abs() < 1e-9);
    // A closed loop takes work: the force opposes motion on the whole.
    let (mut work, mut last_m) = (0.0, 0.199);
    for step in 1..=5000 {
        let length_m = 0.199 - 0.01 * (f64::from(step) * 0.01).sin();
        work += at(length_m) * (last_m - length_m);
        last_m = length_m;
    }
    assert!(work < 0.0, "{work}");
}

#[test]
fn branches_sum_to_a_stretched_exponential() {
    let terms = kohlrausch(1.0, 2.0);
    for time_s in [0.2, 1.0, 4.0, 10.0] {
        let sum: f64 = terms.iter().map(|(weight, s)| weight * (-time_s / s).exp()).sum();
        let expected = (-(time_s / 2.0_f64).sqrt()).exp();
        assert!((sum - expected).abs() < 0.03, "{time_s}: {sum} {expected}");
    }
}

#[test]
fn a_nonlinear_dashpot_flows_faster_under_more_and_comes_to_rest() {
    for flow in [Flow::Power(3.0), Flow::Sinh] {
        let left = |force_n: f64| {
            let mut branch = Dashpot {
                driver: Driver::Bladder,
                flow,
                weight: 1.0,
                constant_s: 1.0,
                reference_n: 10.0,
                state_n: Some(0.0),
                settled: 1.0,
            };
            let now = Moment { bladder_n: force_n, dt_s: 0.01, ..Moment::default() };
            (0..50).map(|_| branch.added_n(&now)).last().unwrap_or(0.0) / force_n
        };
        assert!(left(-30.0) < left(-5.0), "{flow:?}");
        assert!((0.0..1.0).contains(&left(-30.0)), "{flow:?}");
    }
}

#[test]
fn softening_remembers_its_largest_energy_and_virgin_rubber_is_whole() {
    for law in [Damage::Simo { depth: 0.3, alpha: 0.4 }, Damage::Tanh { inverse_r: 0.3, m: 0.3 }] {
        let mut bladder = Softening { law, reference_j: 0.5, energy_j: 0.0, most_j: 0.0, last: None };
        // A spring of 2 N/mm that pulls back when shorter than 0.25 m.
        let mut at = |length_m: f64| {
            bladder.bladder_factor(&Moment {
                length_m,
                bladder_n: -2000.0 * (0.25 - length_m),
                contraction: 1.0 - length_m / 0.25,
                ..Moment::default()
            })
        };
        assert!((at(0.25) - 1.0).abs() < 1e-5, "{law:?}");
        let mut go = |from_m: f64, to_m: f64| {
            (0..=200).map(|i| at(from_m + (to_m - from_m) * f64::from(i) / 200.0)).last().unwrap_or(0.0)
        };
        let virgin = go(0.25, 0.235);
        go(0.235, 0.22);
        let softened = go(0.22, 0.235);
        assert!(softened < virgin - 0.02, "{law:?}: {softened} {virgin}");
        assert!((go(0.235, 0.22) - go(0.22, 0.22)).abs() < 1e-9, "{law:?}");
    }
}
