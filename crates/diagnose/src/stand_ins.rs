//! What was named though something without a name lies behind it: the nearest name in the catalogue, and the wrong one.

use pam_core::artifact::diagnosis::{Coordinate, Verdict};

use crate::hypothesis::Guess;
use crate::search::{Found, Limits};
use crate::state::Setting;
use crate::verdict::{Sizes, verdict};

/// Lets go of every effect that leaves far more than it explains, and of every local static one beside which structure is left
/// over the very coordinate that it acts on, which `left_over` is: a static force of another shape. What remains of the sizes.
pub(crate) fn let_go(
    setting: &Setting<'_>,
    found: &mut Found,
    sizes: Sizes,
    limits: &Limits,
    left_over: Option<Coordinate>,
) -> Sizes {
    if verdict(found, &sizes, false) != Verdict::Unexplained {
        return sizes;
    }
    let stands_in = |guess: &Guess| {
        let effect = guess.effect;
        let misshapen = effect.is_static() && effect.is_local() && left_over == Some(effect.page().coordinate);
        sizes.most_is_left() || misshapen
    };
    for index in (0..found.best.state.guesses.len()).rev() {
        let guess = &found.best.state.guesses[index];
        let id = guess.id();
        if stands_in(guess) && found.let_go(setting, index) {
            found.stand_ins.push(id);
        }
    }
    Sizes::of(found, limits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;
    use crate::search::{judged, search};
    use crate::structure::{Feature, Remainder};

    /// Names that are left of `guess` in `given`, where structure is left over `left_over`.
    fn names(given: &Given, guess: Guess, left_over: Coordinate) -> Vec<&'static str> {
        let limits = Limits {
            max_effects: 0,
            excluded: Vec::new(),
            matters_above_n: None,
            sensor_floor_n: 0.1,
            confirmed: false,
        };
        let plain = Setting { floor_square: 0.01, ..given.setting() };
        let mut found = search(&plain, &given.start, &given.model, &limits, &|| {}).expect("a search");
        let nuisance = found.nuisance.clone();
        let setting = plain.beside(&nuisance);
        let state = setting.fit_near(vec![guess], &found.best.state).expect("a fit");
        found.best = judged(&setting, state).expect("a fit of every fold");
        let every: Vec<&Feature> = found.features.iter().collect();
        found.left = Remainder::of(&setting, &found.best.state).structure(&every);
        let sizes = Sizes::of(&found, &limits);
        let_go(&setting, &mut found, sizes, &limits, Some(left_over));
        found.best.state.guesses.iter().map(Guess::id).collect()
    }

    #[test]
    fn a_static_force_of_another_shape_gets_no_static_name() {
        let mut given = Given::of(&["isobaric-triangles", "multisine"], &[]);
        for instant in &mut given.track.instants {
            let ratio = instant.moment.contraction_ratio;
            instant.force_n += 3.0 * (60.0 * ratio).sin() - 600.0 * (ratio - 0.12).max(0.0);
        }
        let guess = given.guess("braid-lockup", &[0.12, 0.015]);
        assert_eq!(names(&given, guess.clone(), Coordinate::Contraction), Vec::<&str>::new());
        assert_eq!(names(&given, guess, Coordinate::Speed), ["braid-lockup"]);
    }

    #[test]
    fn what_explains_most_stays_and_what_leaves_most_does_not() {
        let protocols = ["isobaric-triangles", "multisine"];
        let lagging = Given::of(&protocols, &[("pressure-lag", &[0.15], &[])]);
        let lag = lagging.guess("pressure-lag", &[0.15]);
        assert_eq!(names(&lagging, lag, Coordinate::Contraction), ["pressure-lag"]);
        let mut touched = Given::of(&protocols, &[]);
        for instant in &mut touched.track.instants {
            instant.force_n += 6.0 * (-((instant.moment.contraction_ratio - 0.05) / 0.012).powi(2)).exp();
        }
        let lag = touched.guess("pressure-lag", &[0.15]);
        assert_eq!(names(&touched, lag, Coordinate::Contraction), Vec::<&str>::new());
    }
}
