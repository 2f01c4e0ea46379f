use super::*;
use pam_muscle::Muscle;
use pam_muscle::effects::{Term, effect};
use pam_muscle::force::{BaseParameters, ForceModel, Form};

fn muscle() -> Muscle {
    Muscle::nominal()
}

fn model(theta: [f64; 8]) -> ForceModel {
    ForceModel::new(&muscle(), 3e9, Form::Corrected, BaseParameters { theta })
}

/// The nominal muscle of latex and nylon.
pub(crate) fn nominal() -> ForceModel {
    model([0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.0])
}

/// Strands so soft that force falls at high pressure and contraction.
pub(crate) fn soft() -> ForceModel {
    model([0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 0.3e9, 1.2e-3, 0.0])
}

/// Box of the nominal muscle.
pub(crate) const BOX: InverseBox =
    InverseBox { pressure_pa: [500.0, 5e5], length_m: [0.211, 0.268], force_n: [4.5, 1119.0] };

/// The inverse of the nominal muscle.
pub(crate) fn nominal_inverse() -> ExactInverse {
    ExactInverse::new(nominal(), BOX, 0.05)
}

#[test]
fn validates_against_the_closed_form_of_a_rigid_braid() {
    // Rigid strands and one friction linear in p: F = A(L, s) p + B(L), so p = (F - B) / A.
    let model = model([0.9, 1.05, 2.0, 118.4e3, 105.7e3, 0.0, 1.2e-3, 0.0]);
    let inverse = ExactInverse::new(model.clone(), InverseBox { force_n: [4.5, 1300.0], ..BOX }, 0.05);
    for length_m in [0.212, 0.23, 0.25, 0.267] {
        for direction in [-1.0, 0.3, 1.0] {
            let constant_n = model.force_n(0.0, length_m, direction);
            let gain = model.force_n(1.0, length_m, direction) - constant_n;
            for expected_pa in [1.2e5, 3.3e5, 4.9e5] {
                let force_n = constant_n + gain * expected_pa;
                let pressure_pa = inverse.pressure_pa(force_n, length_m, direction).unwrap();
                assert!((pressure_pa - expected_pa).abs() < 1e-3, "{length_m} {direction}: {pressure_pa}");
            }
        }
    }
}

#[test]
fn pressure_to_force_to_pressure_is_the_identity_on_the_branch() {
    for inverse in [nominal_inverse(), ExactInverse::new(soft(), BOX, 0.05)] {
        for length_m in [0.211, 0.226, 0.245, 0.268] {
            for direction in [-1.0, 1.0] {
                let Some(branch) = inverse.branch(length_m, direction) else { continue };
                for share in [0.0, 0.2, 0.7, 1.0] {
                    let [low_pa, high_pa] = branch.pressure_pa;
                    let pressure_pa = low_pa + share * (high_pa - low_pa);
                    let force_n = inverse.model().settled_force_n(pressure_pa, length_m, direction);
                    let found_pa = inverse.pressure_pa(force_n, length_m, direction).unwrap();
                    assert!((found_pa - pressure_pa).abs() < 1e-2, "{length_m} {direction}: {found_pa}");
                }
            }
        }
    }
}

#[test]
fn the_nominal_muscle_rises_everywhere_and_a_soft_one_does_not() {
    assert!(nominal_inverse().rises_everywhere());
    assert!(!ExactInverse::new(soft(), BOX, 0.05).rises_everywhere());
}

#[test]
fn friction_makes_two_pressures_of_one_force() {
    let inverse = nominal_inverse();
    let at = |direction| inverse.pressure_pa(33.5, 0.2255, direction).unwrap();
    // Friction both ways over the slope of the force.
    let slope = slope_n_per_pa(inverse.model(), at(0.0), 0.2255, 0.0, 5e5);
    let friction_n = -inverse.model().base().terms(at(0.0), 0.2255, 1.0).friction_n;
    let gap_pa = at(1.0) - at(-1.0);
    assert!((gap_pa - 2.0 * friction_n / slope).abs() < 0.01 * gap_pa && gap_pa > 3e3, "{gap_pa}");
}

#[test]
fn what_has_no_inverse_says_why_and_what_is_possible() {
    let inverse = nominal_inverse();
    let message =
        |force_n, length_m, direction| inverse.pressure_pa(force_n, length_m, direction).unwrap_err().to_string();
    assert_eq!(message(100.0, 0.3, 1.0), "length 300.00 mm is outside 211.00 to 268.00 mm");
    assert_eq!(message(100.0, 0.25, 2.0), "direction 2 is outside -1 to 1");
    assert_eq!(message(f64::NAN, 0.25, 1.0), "force NaN N is outside 4.5 to 756.9 N at 250.00 mm");
    assert!(matches!(
        inverse.pressure_pa(2000.0, 0.25, 1.0),
        Err(NoInverse::Force { range_n: [_, highest_n], .. }) if highest_n < 1119.0
    ));
    // Pulled beyond the strands' length there is no force at all.
    let stretched = ExactInverse::new(nominal(), InverseBox { length_m: [0.211, 0.4], ..BOX }, 0.05);
    assert!(matches!(stretched.pressure_pa(100.0, 0.35, 1.0), Err(NoInverse::Flat { .. })));
}

/// The nominal muscle behind a threshold of 40 kPa, with a gauge that drifts.
fn with_threshold() -> AugmentedModel {
    let term = |id: &str, shape: &[f64], amplitudes: &[f64]| {
        Term::new(effect(id).unwrap(), shape.to_vec(), amplitudes.to_vec())
    };
    let drift = term("force-drift", &[30.0], &[5.0, 5.0]);
    AugmentedModel::new(nominal(), vec![term("threshold-pressure", &[4e4], &[]), drift])
}

#[test]
fn a_threshold_asks_for_its_pressure_on_top() {
    let (plain, behind) = (nominal_inverse(), ExactInverse::new(with_threshold(), BOX, 0.05));
    assert!(!behind.rises_everywhere());
    for (force_n, length_m, direction) in [(300.0, 0.24, 1.0), (500.0, 0.26, -1.0)] {
        let [expected_pa, found_pa] =
            [&plain, &behind].map(|inverse| inverse.pressure_pa(force_n, length_m, direction).unwrap());
        // h(p) = p_e + h(0), turned around.
        let (width_pa, threshold_pa) = (1e4_f64, 4e4_f64);
        let vented_pa = 0.5 * (threshold_pa.hypot(width_pa) - threshold_pa);
        let hinge_pa = expected_pa + vented_pa;
        let excess_pa = hinge_pa - width_pa * width_pa / (4.0 * hinge_pa);
        assert!((found_pa - threshold_pa - excess_pa).abs() < 1.0, "{found_pa}");
    }
}

#[test]
fn effects_of_size_zero_change_nothing() {
    let zero = Term::new(effect("load-dependent-friction").unwrap(), vec![], vec![0.0, 0.0]);
    let augmented = ExactInverse::new(AugmentedModel::new(nominal(), vec![zero]), BOX, 0.05);
    for (force_n, length_m, direction) in [(100.0, 0.22, 1.0), (300.0, 0.24, 0.2), (500.0, 0.26, -1.0)] {
        let [expected_pa, found_pa] =
            [&nominal_inverse(), &augmented].map(|inverse| inverse.pressure_pa(force_n, length_m, direction).unwrap());
        assert_eq!(found_pa.to_bits(), expected_pa.to_bits());
    }
}
