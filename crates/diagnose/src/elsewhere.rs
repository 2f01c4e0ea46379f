//! Names with which recordings that were held out are followed worse: the model keeps them to those that it was fitted to.
//!
//! What a muscle or a rig did in the fitted recordings may have come to its end before others, or begin anew in them at a point
//! that nobody knows. A model that carries it there all the same would be worse than one without; what it explains of the fitted
//! recordings stays explained.

use pam_muscle::effects::sentence::EMPIRICAL;
use pam_muscle::effects::{AugmentedModel, Term};

use crate::held_error::Left;

/// What a model keeps to the recordings that it was fitted to.
#[derive(Debug, Clone)]
pub struct KeptToFitted {
    /// Ids of the effects.
    pub ids: Vec<&'static str>,
    /// The model as it was fitted, with all effects in every recording.
    pub everywhere: AugmentedModel,
}

impl KeptToFitted {
    /// Whether the effect `id` is among them.
    pub(crate) fn has(&self, id: &str) -> bool {
        self.ids.contains(&id)
    }

    /// What a person should know of it, where `with_n` are left of what was held out with the effects and `without_n` without, over
    /// all samples, in N.
    pub(crate) fn statement(&self, with_n: f64, without_n: f64) -> String {
        let them = if self.ids.len() > 1 { "them" } else { "it" };
        format!(
            " Held-out recordings are followed worse with {}: over all samples {with_n:.2} N are left with {them}, {without_n:.2} N \
             without. The finding rests on the fitted recordings alone, and the model applies it to no others.",
            self.ids.join(" and ")
        )
    }
}

/// Keeps terms of `augmented` to the fitted recordings where `left` surely shows that held-out ones are followed better without, and
/// any of them as long as they are followed worse than with `base` alone. The ids of these terms, and whether they still are.
pub(crate) fn keep_to_fitted(
    augmented: &mut AugmentedModel,
    base: &AugmentedModel,
    left: &dyn Fn(&AugmentedModel) -> Left,
) -> (Vec<&'static str>, bool) {
    let (mut now, base) = (left(augmented), left(base));
    let mut ids = Vec::new();
    loop {
        let without = |index: usize| {
            let mut other = augmented.clone();
            other.keep_to_fitted(index);
            let left = left(&other);
            (index, other, left)
        };
        let terms = augmented.terms();
        let candidates = (0..terms.len()).filter(|&index| may_be_kept(&terms[index])).map(without);
        let best = candidates.min_by(|one, other| one.2.together_n().total_cmp(&other.2.together_n()));
        let is_worse = now.is_worse_than(&base);
        let Some((index, other, left)) = best else { return (ids, is_worse) };
        let gains = is_worse && left.together_n() < now.together_n();
        if !gains && !now.is_surely_bettered_by(&left) {
            return (ids, is_worse);
        }
        ids.push(terms[index].effect.page().id);
        (*augmented, now) = (other, left);
    }
}

/// Whether `term` acts in other recordings and may be kept from them: an empirical term is written only where these are followed better
/// with it.
fn may_be_kept(term: &Term) -> bool {
    term.acts_elsewhere() && term.effect.page().id != EMPIRICAL
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::given::tests::artifact;

    /// The model with effects of these ids, of no size.
    fn with(ids: &[&str]) -> AugmentedModel {
        let term = |id: &&str| {
            let effect = pam_muscle::effects::effect(id).expect("an id");
            let shape = effect.shape().iter().map(|shape| shape.grid[0]).collect();
            Term::new(effect, shape, vec![0.0; effect.amplitudes().len()])
        };
        AugmentedModel::new(artifact().force_model(), ids.iter().map(term).collect())
    }

    /// What is left where each of `changes` is by how much an effect that acts elsewhere changes it, of 10 N.
    fn leaving<'a>(changes: &'a [(&'a str, f64)]) -> impl Fn(&AugmentedModel) -> Left + 'a {
        |model| {
            let elsewhere = model.elsewhere();
            let acts = |id: &str| elsewhere.terms().iter().any(|term| term.effect.page().id == id);
            let left_n = 10.0 + changes.iter().filter(|(id, _)| acts(id)).map(|(_, change_n)| change_n).sum::<f64>();
            Left::of_each(std::iter::once(vec![(left_n, true); 80]))
        }
    }

    fn kept(model: &mut AugmentedModel, changes: &[(&str, f64)]) -> Vec<&'static str> {
        let base = AugmentedModel::from(model.base().clone());
        keep_to_fitted(model, &base, &leaving(changes)).0
    }

    #[test]
    fn a_name_that_what_was_held_out_follows_worse_is_kept_to_the_fitted_and_the_others_stay() {
        let mut model = with(&["pressure-creep", "force-drift"]);
        assert_eq!(kept(&mut model, &[("pressure-creep", -4.0), ("force-drift", 2.0)]), ["force-drift"]);
        assert_eq!(model.not_elsewhere(), ["force-drift"]);
        assert_eq!(model.terms().len(), 2);
    }

    #[test]
    fn what_raises_it_above_the_base_goes_even_where_that_is_little_and_below_the_base_little_may_stay() {
        assert_eq!(kept(&mut with(&["pressure-creep"]), &[("pressure-creep", 0.2)]), ["pressure-creep"]);
        let mut below = with(&["pressure-creep", "force-drift"]);
        assert!(kept(&mut below, &[("pressure-creep", -4.0), ("force-drift", 0.1)]).is_empty());
        assert!(below.not_elsewhere().is_empty());
        assert!(kept(&mut with(&["pressure-creep"]), &[("pressure-creep", 0.05)]).is_empty(), "no more than rounding");
    }

    #[test]
    fn what_is_worse_than_the_base_without_any_of_its_terms_is_said_to_be() {
        let still = |base_n: f64| {
            let left = |model: &AugmentedModel| {
                let left_n = if model.is_plain() { base_n } else { 10.0 };
                Left::of_each(std::iter::once(vec![(left_n, true); 80]))
            };
            keep_to_fitted(&mut with(&["pressure-creep"]), &with(&[]), &left).1
        };
        assert!(still(9.8) && !still(9.95) && !still(10.2));
    }

    #[test]
    fn a_person_is_told_what_it_would_cost() {
        let said =
            KeptToFitted { ids: vec!["pressure-creep", "force-drift"], everywhere: with(&[]) }.statement(6.22, 3.04);
        assert!(
            said.contains(
                "worse with pressure-creep and force-drift: over all samples 6.22 N are left with them, 3.04 N without"
            ),
            "{said}"
        );
    }
}
