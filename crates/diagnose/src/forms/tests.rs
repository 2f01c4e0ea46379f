use super::*;

use pam_muscle::effects::effect;

use crate::rehearsal::tests::Given;

/// A term of the catalogue.
fn term(id: &str, shape: &[f64], amplitudes: &[f64]) -> Term {
    Term::new(effect(id).expect("an id"), shape.to_vec(), amplitudes.to_vec())
}

fn largest_n(column: &[f64]) -> f64 {
    column.iter().fold(0.0, |most, value| f64::max(most, value.abs()))
}

/// The state of `guess` fitted to `given`, with its forms.
fn forms_of(given: &Given, id: &str, shape: &[f64]) -> Forms {
    let setting = given.setting();
    let state = setting.fit(vec![given.guess(id, shape)], &given.start, &given.model).expect("a fit");
    Forms::of(&setting, &state, &Coordinates::of(&given.track))
}

#[test]
fn ranks_run_from_one_end_to_the_other_whatever_the_outliers() {
    let values = [1.0, 2.0, 3.0, 4.0];
    assert_eq!(over_quantiles(&values, &[true; 4]), [-1.0, -0.5, 0.0, 0.5]);
    // A value that is reached once, and far away, is no lever.
    assert_eq!(over_quantiles(&[1.0, 2.0, 3.0, 1e9], &[true; 4])[3], 0.5);
}

#[test]
fn what_is_not_counted_has_a_rank_and_gives_none() {
    let ranks = over_quantiles(&[1.0, 2.0, 3.0, 4.0], &[true, false, true, false]);
    assert_eq!(ranks, [-1.0, 0.0, 0.0, 1.0]);
    assert!(over_quantiles(&[f64::NAN, 1.0], &[true, true]).iter().all(|rank| rank.is_finite()));
}

#[test]
fn a_lag_bends_to_twice_and_half_its_time_constant() {
    let given = Given::of(&["multisine"], &[("pressure-lag", &[0.1, 0.0], &[])]);
    let forms = forms_of(&given, "pressure-lag", &[0.1, 0.0]);
    let [columns] = &forms.columns_n[..] else { panic!("one effect, and {} sets", forms.columns_n.len()) };
    // To first order a lag is in proportion to its time constant: twice of it adds about as much again, half of it takes half.
    let (half, twice) = (&columns[0], &columns[1]);
    let along = half.iter().zip(twice).map(|(half, twice)| half * twice).sum::<f64>();
    assert!(along < 0.0, "to opposite sides");
    let ratio = largest_n(twice) / largest_n(half);
    assert!((1.3..2.5).contains(&ratio), "{ratio}");
    assert!(columns.iter().all(|column| column.len() == given.track.n()));
}

#[test]
fn a_shape_bends_no_further_than_its_range() {
    let given = Given::of(&["multisine"], &[("pressure-lag", &[1.0, 0.0], &[])]);
    let forms = forms_of(&given, "pressure-lag", &[1.0, 0.0]);
    let (half, twice) = (&forms.columns_n[0][0], &forms.columns_n[0][1]);
    assert!(largest_n(half) > 1.0);
    assert_eq!(largest_n(twice), 0.0);
}

#[test]
fn an_event_does_not_bend() {
    let given = Given::of(&["multisine"], &[]);
    let forms = forms_of(&given, "force-step", &[0.0, 5.0]);
    assert!(forms.columns_n.is_empty());
    let nuisance = Nuisance::of_recordings(&given.track, 0.3);
    assert_eq!(forms.beside(&nuisance, &given.track.counted).n(), nuisance.n());
}

#[test]
fn forms_stand_beside_the_nuisances_that_were_there() {
    let given = Given::of(&["multisine"], &[("pressure-lag", &[0.1, 0.0], &[])]);
    let forms = forms_of(&given, "pressure-lag", &[0.1, 0.0]);
    let nuisance = Nuisance::of_recordings(&given.track, 0.3);
    assert!(forms.beside(&nuisance, &given.track.counted).n() > nuisance.n());
}

#[test]
fn a_known_effect_may_have_another_size_and_its_zeros_another_value() {
    let given = Given::of(&["isobaric-triangles"], &[]);
    let n_of = |term: Term| of_known_n(&given.track, &given.model, &[term]).len();
    // The mount of a mass is a shape; so is the hardening of a fixture, which has a share that slides as well, at zero here.
    let plain = n_of(term("series-compliance", &[1e-5, 1.0, 0.01], &[]));
    let zeros = n_of(term("series-compliance", &[1e-5, 1.0, 0.0], &[]));
    // Both sides of the zero stand in the place of half and twice the value.
    assert_eq!(plain, zeros);
    let own_n = &of_known_n(&given.track, &given.model, &[term("rubber-hysteresis", &[2e-3], &[8.0])])[0];
    assert!((7.0..9.0).contains(&largest_n(own_n)), "{}", largest_n(own_n));
}

#[test]
fn what_lives_in_time_is_not_bent_over_time() {
    let given = Given::of(&["multisine"], &[]);
    let drift = of_known_n(&given.track, &given.model, &[term("force-drift", &[120.0], &[0.01, 1.0])]);
    let lag = of_known_n(&given.track, &given.model, &[term("pressure-lag", &[0.1, 0.0], &[])]);
    // A lag has polynomials over the coordinate that it lives in, of itself and of friction; and one more shape, to either side.
    assert_eq!(lag.len() - drift.len(), 2 * LIVES + 2);
}
