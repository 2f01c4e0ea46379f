use std::f64::consts::PI;

use super::*;
use crate::geometry::tests::nominal;

/// Nominal values of a self-made muscle of latex and nylon.
pub(super) fn nominal_parameters() -> BaseParameters {
    BaseParameters { theta: [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.0] }
}

#[test]
fn validates_against_published_forces() {
    // 666, 370 and 167 N at 0.3 MPa and contractions of 0, 0.1 and 0.2, printed to three digits and with
    // the paper's cubic in the braid term.
    let model = ForceModel::new(&nominal(), 3e9, Form::Corrected, nominal_parameters());
    for (contraction_ratio, expected_n) in [(0.0, 666.0), (0.1, 370.0), (0.2, 167.0)] {
        let force_n = model.force_n(3e5, model.muscle().length_m(contraction_ratio), 0.0);
        assert!((force_n - expected_n).abs() < 0.006 * expected_n, "ε = {contraction_ratio}: {force_n}");
    }
}

#[test]
fn pressure_turns_the_braid_as_a_shortening_by_its_slide_does() {
    let (muscle, modulus_pa) = (nominal(), 3e9);
    let model = ForceModel::new(&muscle, modulus_pa, Form::Corrected, nominal_parameters());
    let (length_m, pressure_pa, strand_m) = (0.25, 1e3, muscle.strand_length_m());
    // Axial equilibrium at the middle: the strands carry the gas on the end and the hoop, p L b / (2 π n² N) each.
    let turns = muscle.turns();
    let tension_n = pressure_pa * length_m * strand_m / (2.0 * PI * turns * turns * muscle.strand_count);
    let section_m2 = 0.25 * PI * muscle.strand_diameter_m * muscle.strand_diameter_m;
    let stretched_m = strand_m * (1.0 + tension_n / (modulus_pa * section_m2));
    let slid_m = model.slide_m_per_pa(length_m) * pressure_pa;
    let (turned, shortened) = (length_m / stretched_m, (length_m - slid_m) / strand_m);
    assert!((turned / shortened - 1.0).abs() < 1e-3 * slid_m / length_m, "{turned} {shortened}");
}

#[test]
fn friction_lowers_the_force_while_contracting_and_raises_it_while_extending() {
    let model = ForceModel::new(&nominal(), 3e9, Form::Corrected, nominal_parameters());
    let at = |direction| model.force_n(3e5, 0.24, direction);
    assert!(at(1.0) < at(0.0) && at(0.0) < at(-1.0));
    assert!((at(1.0) + at(-1.0) - 2.0 * at(0.0)).abs() < 1e-9);
}

#[test]
fn at_rest_without_pressure_only_the_constant_is_left() {
    let model = ForceModel::new(&nominal(), 3e9, Form::Corrected, nominal_parameters());
    assert!((model.force_n(0.0, 0.267, 1.0) - 2.0).abs() < 1e-6);
}
