//! Which static map a hypothesis is judged beside.

use super::*;
use crate::rehearsal::tests::Given;
use crate::search::judged;

const PROTOCOLS: [&str; 3] = ["isobaric-triangles", "isometric-ramps", "multisine"];

/// What the base is judged beside in `given`.
fn beside(given: &Given) -> Beside {
    let setting = Setting { floor_square: 0.09, ..given.setting() };
    let base = judged(&setting, setting.fit(Vec::new(), &given.start, &given.model).expect("a fit")).expect("folds");
    let of_recordings = Nuisance::of_recordings(&given.track, 0.3);
    Beside::of(&setting, &of_recordings, &Coordinates::of(&given.track), &base).expect("maps")
}

#[test]
fn a_map_bends_where_a_bend_foretells_and_is_the_smooth_one_where_none_does() {
    let mut sharp = Given::of(&PROTOCOLS, &[("threshold-pressure", &[6e4], &[])]);
    sharp.disturb();
    let sharp = beside(&sharp);
    assert!(sharp.plain.n() < sharp.smooth.n() && sharp.smooth.n() < sharp.free.n());
    let mut smooth = Given::of(&PROTOCOLS, &[]);
    smooth.disturb();
    smooth.bend(6.0);
    let smooth = beside(&smooth);
    assert!(smooth.plain.n() < smooth.smooth.n());
    assert_eq!(smooth.free.n(), smooth.smooth.n());
}
