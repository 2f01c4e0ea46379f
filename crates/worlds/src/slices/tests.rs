use super::*;
use crate::lumped::LumpedMuscle;

#[test]
fn slices_come_to_equilibrium_near_the_cylinder_but_not_on_it() {
    let mut dice = Dice::new(11, 3);
    let mut found = 0;
    for _ in 0..12 {
        let mut muscle = Muscle::draw(&mut dice);
        muscle.thick_wall = false;
        let Some(sliced) = SlicedMuscle::new(&muscle, &mut dice) else { continue };
        found += 1;
        let lumped = LumpedMuscle::new(&muscle);
        let length_m = 0.9 * muscle.rest_length_m;
        let pressure_pa = 0.7 * muscle.highest_pressure_pa;
        let (of_slices, of_cylinder) =
            (sliced.parts(pressure_pa, length_m).total_n(), lumped.parts(pressure_pa, length_m).total_n());
        let gas_n = lumped.parts(pressure_pa, length_m).gas_n;
        assert!((of_slices - of_cylinder).abs() < 0.35 * gas_n, "{of_slices} {of_cylinder}");
        assert!((of_slices - of_cylinder).abs() > 0.2, "{of_slices} {of_cylinder}");
    }
    assert!(found >= 10, "{found} of 12");
}

#[test]
fn interpolation_meets_a_solution_between_nodes() {
    let mut dice = Dice::new(12, 3);
    let muscle = Muscle::draw(&mut dice);
    let sliced = SlicedMuscle::new(&muscle, &mut dice).expect("an equilibrium");
    // Third differences of a kinked table would jump; these are smooth to a thousandth of a newton.
    let force_n = |i: f64| sliced.parts(2e5, muscle.rest_length_m * (1.0 - 0.002 * i)).total_n();
    for i in 0..60 {
        let i = f64::from(i);
        let fourth =
            force_n(i) - 4.0 * force_n(i + 1.0) + 6.0 * force_n(i + 2.0) - 4.0 * force_n(i + 3.0) + force_n(i + 4.0);
        assert!(fourth.abs() < 0.05, "{fourth}");
    }
}
