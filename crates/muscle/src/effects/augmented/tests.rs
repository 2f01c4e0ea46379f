use super::super::{CATALOGUE, effect};
use super::*;
use crate::force::{BaseParameters, Form};
use crate::geometry::tests::nominal;

fn base() -> ForceModel {
    let parameters = BaseParameters { theta: [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.3] };
    ForceModel::new(&nominal(), 3e9, Form::Corrected, parameters)
}

fn term(id: &str, shape: &[f64], amplitudes: &[f64]) -> Term {
    Term::new(effect(id).expect("an id"), shape.to_vec(), amplitudes.to_vec())
}

/// A stroke of 30 mm there and back at changing pressure.
fn path() -> Vec<Moment> {
    let muscle = nominal();
    (0..400)
        .map(|index| {
            let phase = f64::from(index) * 0.05;
            let settled = Moment::settled(&muscle, 3e5 + 1e5 * (0.7 * phase).sin(), 0.245 + 0.015 * phase.cos(), 1.0);
            Moment {
                time_s: 0.01 * f64::from(index),
                step_s: if index == 0 { 0.0 } else { 0.01 },
                speed_m_per_s: 0.075 * phase.sin(),
                direction: phase.sin().signum(),
                force_n: 300.0,
                ..settled
            }
        })
        .collect()
}

#[test]
fn without_terms_it_is_eq_11_to_the_bit() {
    let model = AugmentedModel::new(base(), Vec::new());
    let mut memory = model.start();
    for now in path() {
        let expected_n = base().force_n(now.pressure_pa, now.length_m, now.direction);
        assert_eq!(memory.force_n(&model, now).to_bits(), expected_n.to_bits());
        assert_eq!(
            model.settled_force_n(now.pressure_pa, now.length_m, -1.0),
            base().force_n(now.pressure_pa, now.length_m, -1.0)
        );
    }
}

#[test]
fn settled_presliding_is_eq_11() {
    let model = AugmentedModel::new(base(), vec![term("presliding-hysteresis", &[1e-3, 1.0, 0.0], &[])]);
    for direction in [1.0, 0.0, -1.0] {
        let settled_n = model.settled_force_n(3e5, 0.24, direction);
        assert!((settled_n - base().force_n(3e5, 0.24, direction)).abs() < 1e-9);
    }
}

#[test]
fn a_reversal_lets_go_of_the_friction_over_the_slip_distance() {
    let model = AugmentedModel::new(base(), vec![term("presliding-hysteresis", &[1e-3, 1.0, 0.0], &[])]);
    let mut memory = model.start();
    let at = |length_m, step_s, direction| Moment { step_s, ..Moment::settled(&nominal(), 3e5, length_m, direction) };
    memory.force_n(&model, at(0.24, 0.0, 1.0));
    let turned_n = memory.force_n(&model, at(0.240_01, 0.01, -1.0));
    let before_n = base().force_n(3e5, 0.240_01, 1.0);
    let after_n = base().force_n(3e5, 0.240_01, -1.0);
    assert!((turned_n - before_n).abs() < 0.05 * (after_n - before_n));
    let slid_n = memory.force_n(&model, at(0.25, 0.01, -1.0));
    assert!((slid_n - base().force_n(3e5, 0.25, -1.0)).abs() < 1e-9);
}

#[test]
fn amplitudes_of_zero_change_nothing() {
    for effect in CATALOGUE.iter().filter(|effect| effect.role() == Role::Pulls) {
        let shape: Vec<f64> = effect.shape().iter().map(|shape| shape.grid[0]).collect();
        let zeros = vec![0.0; effect.amplitudes().len()];
        let model = AugmentedModel::new(base(), vec![Term::new(*effect, shape, zeros)]);
        let mut memory = model.start();
        for now in path() {
            let expected_n = base().force_n(now.pressure_pa, now.length_m, now.direction);
            assert!((memory.force_n(&model, now) - expected_n).abs() < 1e-12, "{}", effect.page().id);
        }
    }
}

#[test]
fn the_force_is_linear_in_the_amplitudes() {
    for effect in CATALOGUE.iter().filter(|effect| effect.role() == Role::Pulls) {
        let shape: Vec<f64> = effect.shape().iter().map(|shape| shape.grid[0]).collect();
        let added_n = |factor: f64| -> Vec<f64> {
            let amplitudes = effect.amplitudes().iter().map(|amplitude| factor * amplitude.range.1).collect();
            let term = Term::new(*effect, shape.clone(), amplitudes);
            let model = AugmentedModel::new(base(), vec![term]);
            let mut memory = model.start();
            let base_n = |now: &Moment| base().force_n(now.pressure_pa, now.length_m, now.direction);
            path().into_iter().map(|now| memory.force_n(&model, now) - base_n(&now)).collect()
        };
        for (half_n, whole_n) in added_n(0.5).iter().zip(added_n(1.0)) {
            let error_n = (2.0 * half_n - whole_n).abs();
            assert!(error_n < 1e-9 * whole_n.abs().max(1.0), "{}: {half_n} {whole_n}", effect.page().id);
        }
    }
}

#[test]
fn terms_act_in_the_order_of_their_roles() {
    let model = AugmentedModel::new(
        base(),
        vec![
            term("slack", &[10.0, 0.0], &[]),
            term("viscous-damping", &[], &[1e4, 0.0]),
            term("threshold-pressure", &[5e4], &[]),
        ],
    );
    let fast = Moment { speed_m_per_s: 1.0, ..Moment::settled(&nominal(), 3e5, 0.24, 1.0) };
    assert_eq!(model.start().force_n(&model, fast), 10.0);
    let slow = Moment { speed_m_per_s: 1e-3, ..fast };
    let seen = AugmentedModel::new(base(), vec![term("threshold-pressure", &[5e4], &[])]);
    let expected_n = seen.settled_force_n(3e5, 0.24, 1.0) - 10.0;
    assert!((model.start().force_n(&model, slow) - expected_n).abs() < 1e-9);
    assert!(expected_n + 10.0 < base().force_n(3e5, 0.24, 1.0) - 40.0);
}

#[test]
fn a_settled_fixture_is_stretched_by_the_force_that_results() {
    for (compliance_m_per_n, length_m) in [(2e-5, 0.24), (4e-5, 0.266), (1e-4, 0.266)] {
        let model = AugmentedModel::new(base(), vec![term("series-compliance", &[compliance_m_per_n, 1.0, 0.0], &[])]);
        let force_n = model.settled_force_n(3e5, length_m, 1.0);
        let expected_n = base().force_n(3e5, length_m - compliance_m_per_n * force_n, 1.0);
        assert!((force_n - expected_n).abs() < 1e-9 * force_n, "{force_n} {expected_n}");
    }
}

#[test]
fn a_static_map_goes_with_what_is_recorded_and_not_with_what_the_muscle_sees() {
    let spring = term("series-compliance", &[2e-5, 0.0, 0.0], &[]);
    // 100 N for every tenth of contraction.
    let amplitudes: Vec<f64> = (0..20).map(|index| if index == 0 { 50.0 } else { 0.0 }).collect();
    let map = term("static-map", &[0.0, 5e5, 0.05, 0.15], &amplitudes);
    let now = Moment { force_n: 300.0, ..Moment::settled(&nominal(), 3e5, 0.24, 1.0) };
    let [alone_n, both_n] = [vec![spring.clone()], vec![spring, map]].map(|terms| {
        let model = AugmentedModel::new(base(), terms);
        model.start().force_n(&model, now)
    });
    let recorded_n = 1e3 * (nominal().contraction_ratio(0.24) - 0.1);
    assert!((both_n - alone_n - recorded_n).abs() < 1e-9, "{} {recorded_n}", both_n - alone_n);
}

#[test]
fn a_muscle_leaves_instruments_and_fixture_behind() {
    let model = AugmentedModel::new(
        base(),
        vec![
            term("force-drift", &[30.0], &[0.1, 0.0]),
            term("slack", &[0.0, 0.0], &[]),
            term("pressure-lag", &[0.05, 0.0], &[]),
            term("force-step", &[0.0, 1.0], &[3.0]),
        ],
    );
    let muscle = model.of_the_muscle();
    let ids: Vec<&str> = muscle.terms().iter().map(|term| term.effect.page().id).collect();
    assert_eq!(ids, ["slack", "pressure-lag"]);
    assert_eq!(model.beside_the_muscle(), ["force-drift", "force-step"]);
    assert_eq!(model.elsewhere().terms().len(), 3);
}

#[test]
fn what_is_kept_to_the_fitted_recordings_acts_there_and_nowhere_else() {
    let terms = vec![term("viscous-damping", &[], &[1e4, 0.0]), term("slack", &[0.0, 0.0], &[])];
    let mut model = AugmentedModel::new(base(), terms);
    assert!(model.not_elsewhere().is_empty());
    model.keep_to_fitted(0);
    assert_eq!(model.not_elsewhere(), ["viscous-damping"]);
    assert!(model.beside_the_muscle().is_empty());
    let fast = Moment { speed_m_per_s: 1e-2, ..Moment::settled(&nominal(), 3e5, 0.24, 1.0) };
    let force_n = |model: &AugmentedModel| model.start_in(0).force_n(model, fast);
    let plain_n = base().force_n(3e5, 0.24, 1.0);
    assert!((force_n(&model) - plain_n).abs() > 50.0);
    for other in [model.elsewhere(), model.of_the_muscle()] {
        assert_eq!(other.terms().len(), 1);
        assert!((force_n(&other) - plain_n).abs() < 1e-9);
    }
}
