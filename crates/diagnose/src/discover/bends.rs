//! Whether a term bends an effect that was named: it lives where that effect lives, so that it says how the effect's form differs
//! from the published one rather than what else is there.

use pam_muscle::Coordinate;
use pam_muscle::effects::sentence::{Recall, Sentence};

use crate::hypothesis::CandidateEffect;

/// Share of the most evidence at which a sentence that bends what was named is preferred to any other.
pub(super) const PREFERRED: f64 = 0.8;

/// Id of the effect among `named` whose form `sentence` bends; none where it bends none.
pub(super) fn bends(sentence: &Sentence, named: &[CandidateEffect]) -> Option<&'static str> {
    let lives = lives_in(sentence);
    named.iter().map(|guess| guess.effect.page()).find(|page| page.coordinate == lives).map(|page| page.id)
}

/// The coordinate that a sentence lives in.
fn lives_in(sentence: &Sentence) -> Coordinate {
    match (sentence.memory, sentence.driver) {
        (Recall::Lag { .. } | Recall::TwoLags { .. }, _) => Coordinate::TimeSinceLastMove,
        (Recall::Play { .. } | Recall::Dahl { .. }, _) => Coordinate::TravelSinceReversal,
        (Recall::Travelled | Recall::Work, _) => Coordinate::Cycle,
        (Recall::None | Recall::Largest, driver) => driver.coordinate(),
    }
}

#[cfg(test)]
mod tests {
    use pam_muscle::effects::effect;
    use pam_muscle::effects::sentence::{Curve, Driver, Scale};

    use super::*;
    use crate::hypothesis::Beginning;
    use crate::hypothesis::Sign;

    fn sentence(driver: Driver, memory: Recall) -> Sentence {
        Sentence { driver, memory, scale: Scale::One, shape: Curve::Line, seen: [0.0, 1.0] }
    }

    #[test]
    fn a_term_bends_the_effect_that_lives_where_it_lives_and_no_other() {
        let effect = effect("stribeck").expect("an effect");
        let named = [CandidateEffect { effect, shape: Vec::new(), sign: Sign::Any, beginning: Beginning::Fresh }];
        assert_eq!(bends(&sentence(Driver::Speed, Recall::None), &named), Some("stribeck"));
        assert_eq!(bends(&sentence(Driver::Contraction, Recall::None), &named), None);
        assert_eq!(bends(&sentence(Driver::Speed, Recall::Lag { time_constant_s: 1.0 }), &named), None);
        assert_eq!(bends(&sentence(Driver::Speed, Recall::None), &[]), None);
    }
}
