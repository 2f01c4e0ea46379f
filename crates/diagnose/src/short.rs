//! Names that recordings are too short for.
//!
//! A name needs blocks that were left out of the fit and are foretold better with it. Where only one or two of them are, or as many
//! foretold worse, that is chance, and only held-out recordings could say more.
//!
//! A memory with time constant `τ` bends away from a straight line by about `t / 8 τ` of what it does within `t`. Where every branch
//! with any weight is so slow that the recordings together see a straight line, they tell a drift, and not what makes it.

use pam_muscle::effects::{Kind, Term};

use crate::search::{Found, Limits, Taken, chance};
use crate::state::Setting;

/// Share of the shortest time constant that recordings must last: within it an exponential leaves its chord by 4 %. The false name
/// that this was found by, 1,420 s of memory in 17 s, had 1 %.
const LEAST_OF_MEMORY: f64 = 1.0 / 3.0;
/// Probability, corrected for the number of candidates, beyond which an improvement may be chance.
const CHANCE: f64 = 0.05;
/// From one branch of a memory to the next.
const SPREAD: f64 = 10.0;

/// The shortest time constant that has a weight, in s; none where the effect has no branches.
fn shortest_s(term: &Term) -> Option<f64> {
    let at = term.effect.shape().iter().position(|shape| shape.name == "time_constant_s")?;
    let names = ["overstress", "slow_overstress", "slowest_overstress"];
    let weight = |name: &str| {
        let index = term.effect.amplitudes().iter().position(|amplitude| amplitude.name == name)?;
        term.amplitudes.get(index).copied()
    };
    let weights: Vec<f64> = names.iter().map(|name| weight(name)).collect::<Option<_>>()?;
    let first = weights.iter().position(|weight| *weight != 0.0)?;
    Some(term.shape[at] * SPREAD.powi(first as i32))
}

/// Whether blocks that were left out of the fit tell so little of an effect that one of so many `looks` had to be as good.
fn may_be_chance(taken: &Taken, looks: f64) -> bool {
    looks * chance(&taken.without, &taken.with) > CHANCE
}

/// Lets go of names that recordings of `lasts_s` in all do not tell; what to say of each.
pub(crate) fn let_go(setting: &Setting<'_>, found: &mut Found, limits: &Limits, lasts_s: f64) -> Vec<String> {
    let mut said = Vec::new();
    let terms = found.best.state.terms();
    for (index, term) in terms.iter().enumerate().rev() {
        let Some(memory_s) = shortest_s(term).filter(|memory_s| lasts_s < LEAST_OF_MEMORY * memory_s) else { continue };
        if found.let_go(setting, index) {
            let name = term.effect.page().name;
            said.push(format!(
                "these {lasts_s:.0} s are too short for {name}: a memory of {memory_s:.0} s is a straight line within them; record \
                 {:.0} s or more",
                (LEAST_OF_MEMORY * memory_s).ceil()
            ));
        }
    }
    let looks = found.first.len() as f64;
    for index in (0..found.taken.len()).rev() {
        let effect = found.best.state.guesses[index].effect;
        // An event touches no more blocks than it lasts for.
        let is_open = !limits.confirmed && effect.kind() != Kind::Event;
        if is_open && may_be_chance(&found.taken[index], looks) && found.let_go(setting, index) {
            let name = effect.page().name;
            said.push(format!(
                "{name} would explain something, but too few stretches of these {lasts_s:.0} s show it: record for longer, or hold a \
                 recording out"
            ));
        }
    }
    said
}

#[cfg(test)]
mod tests {
    use super::*;

    use pam_muscle::effects::effect;

    use crate::joint::HeldOut;

    #[test]
    fn what_two_blocks_tell_may_be_chance_and_what_most_tell_is_none() {
        let held = |blocks: Vec<f64>| HeldOut { counts: vec![40.0; blocks.len()], blocks, floor_square: 0.3 };
        let taken = |touched: usize| {
            let without = (0..32).map(|block| if block < touched { 4.0 + 0.1 * f64::from(block as u8) } else { 0.1 });
            Taken {
                without: held(without.collect()),
                with: held(vec![0.1; 32]),
                rivals: Vec::new(),
                is_confirmed: false,
            }
        };
        assert!(may_be_chance(&taken(1), 25.0) && may_be_chance(&taken(2), 25.0));
        assert!(!may_be_chance(&taken(12), 25.0) && !may_be_chance(&taken(32), 25.0));
    }

    #[test]
    fn the_memory_of_an_effect_is_the_shortest_that_has_a_weight() {
        let creep = |amplitudes: [f64; 3]| {
            let effect = effect("pressure-creep").unwrap();
            let shape = effect.shape().iter().map(|shape| if shape.name == "time_constant_s" { 14.0 } else { 0.0 });
            shortest_s(&Term::new(effect, shape.collect(), amplitudes.to_vec()))
        };
        assert_eq!(creep([0.1, 0.0, 0.2]), Some(14.0));
        assert_eq!(creep([0.0, -0.1, 0.2]), Some(140.0));
        assert_eq!(creep([0.0, 0.0, 0.2]), Some(1400.0));
        assert_eq!(creep([0.0; 3]), None);
        let lag = effect("pressure-lag").unwrap();
        assert_eq!(shortest_s(&Term::new(lag, vec![0.1], vec![1.0])), None);
    }
}
