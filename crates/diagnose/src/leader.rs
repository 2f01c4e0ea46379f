//! What explained most in the first look, where nothing stands in the end.
//!
//! A search takes effects by what they explain less what they are charged: for a memory of what went before every recording, a share
//! that is all of a whole, an amplitude at its largest. Where all that was taken so falls, the effect that explained most whatever it is
//! charged may be the one: it is looked for alone, and has to stand as any other.

use pam_muscle::effects::Effect;

use crate::borne_out::{NO_CHANCE, OVERWHELMING};
use crate::search::Found;
use crate::stand_ins::has_memory;
use crate::trial::Trial;

/// The effect of the first look of `found`, at all of the catalogue, that explained most, where nothing of it is left: beyond any chance,
/// and none that a static map would do for as well.
///
/// Of 313 looked-at cases that were without a name, of 599, six have one by it, all of them right: two that warm, creep, rubber hysteresis
/// and load-dependent friction twice, once beside another effect that is not named.
pub(crate) fn leader(found: &Found) -> Option<&Trial> {
    if !found.best.state.guesses.is_empty() || !found.looked_at_all {
        return None;
    }
    let is_told = |effect: &dyn Effect| has_memory(effect) || effect.is_odd();
    let every = found.first.iter().filter(|trial| is_told(trial.guess.effect));
    let leads = every.max_by(|one, other| one.uncharged().total_cmp(&other.uncharged()))?;
    (leads.uncharged() >= OVERWHELMING && leads.by_chance(found.first.len()) < NO_CHANCE).then_some(leads)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::HeldOut;
    use crate::rehearsal::tests::Given;
    use crate::search::{Limits, search};
    use crate::state::Setting;

    /// Blocks of which each has about the mean square `square`.
    fn blocks(square: f64) -> HeldOut {
        let blocks = (0..12).map(|at| square * (1.0 + 0.1 * f64::from(at % 3))).collect();
        HeldOut { blocks, counts: vec![10.0; 12], floor_square: 1e-4 }
    }

    #[test]
    fn what_explained_most_leads_whatever_it_is_charged_where_nothing_stands() {
        let mut given = Given::of(&["multisine", "isometric-ramps"], &[]);
        given.disturb();
        let limits = Limits::of_test(1, 0.3);
        let setting = Setting { floor_square: 0.09, ..given.setting() };
        let mut found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
        assert!(found.best.state.guesses.is_empty() && leader(&found).is_none(), "a healthy muscle");
        let at =
            |found: &Found, id: &str| found.first.iter().position(|trial| trial.guess.id() == id).expect("a trial");
        let explains = |found: &mut Found, id: &str, evidence: f64| {
            let at = at(found, id);
            let trial = &mut found.first[at];
            (trial.before, trial.log_ratio) = (blocks(9.0), 0.0);
            trial.held_out = HeldOut { counts: vec![10.0; 12], ..blocks(9.0 * (-evidence / 12.0_f64).exp()) };
            // Not the same in every block, or nothing could be chance.
            trial.held_out.blocks.iter_mut().step_by(2).for_each(|block| *block *= 1.01);
            trial.uncharged()
        };
        let leads = |found: &Found| leader(found).map(|trial| trial.guess.id());
        assert!(explains(&mut found, "thermal-softening", OVERWHELMING - 1.0) < OVERWHELMING);
        assert_eq!(leads(&found), None);
        assert!(explains(&mut found, "thermal-softening", OVERWHELMING + 1.0) > OVERWHELMING);
        assert_eq!(leads(&found), Some("thermal-softening"));
        explains(&mut found, "load-dependent-friction", OVERWHELMING + 2.0);
        assert_eq!(leads(&found), Some("load-dependent-friction"), "friction is odd, and no smooth map");
        explains(&mut found, "end-taper", OVERWHELMING + 9.0);
        assert_eq!(leads(&found), Some("load-dependent-friction"), "a map would do for a taper");
        found.looked_at_all = false;
        assert_eq!(leads(&found), None, "what was excluded may have explained more");
        found.looked_at_all = true;
        found.best.state.guesses.push(given.guess("pressure-lag", &[0.15, 0.0]));
        assert_eq!(leads(&found), None, "something stands");
    }

    #[test]
    fn one_block_is_no_leader() {
        let mut given = Given::of(&["multisine"], &[]);
        given.disturb();
        let limits = Limits::of_test(1, 0.3);
        let setting = Setting { floor_square: 0.09, ..given.setting() };
        let mut found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
        let trial = found.first.iter_mut().find(|trial| trial.guess.id() == "force-drift").expect("a trial");
        (trial.before, trial.held_out) = (blocks(9e6), blocks(9e6));
        for block in &mut trial.held_out.blocks[..2] {
            *block *= 1e-5;
        }
        assert!(trial.uncharged() > OVERWHELMING);
        assert!(leader(&found).is_none());
    }
}
