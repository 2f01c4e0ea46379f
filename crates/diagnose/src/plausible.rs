//! Base parameters that no braided muscle has, and what a name says of them.

use pam_artifact::diagnosis::Implausible;
use pam_identification::search_space::Free;
use pam_muscle::force::Parameter;

use crate::state::{Setting, State};
use crate::uncertainty::Uncertainty;

/// Base parameters of `state` that no braided muscle has.
pub fn implausible(setting: &Setting<'_>, state: &State) -> Vec<Implausible> {
    let x = &state.fit.x;
    setting
        .space
        .free
        .iter()
        .enumerate()
        .filter_map(|(index, free)| {
            let value = setting.space.value(index, x[index]);
            let (low, high) = free.ranges(setting.strand_modulus_pa).plausible;
            let margin = 1e-6 * (high - low);
            if (low - margin..=high + margin).contains(&value) {
                return None;
            }
            let modulus = free.name() == "strand_modulus";
            let written = |value: f64| if modulus { 1.0 / value } else { value };
            Some(Implausible {
                parameter: free.name().to_owned(),
                value: written(value),
                unit: match free.name() {
                    "k3" => "N",
                    "strand_modulus" | "c10" | "c01" | "c10 + c01" => "Pa",
                    _ => "1",
                }
                .to_owned(),
                plausible: if modulus { [written(high), written(low)] } else { [low, high] },
                likely_cause: free.likely_cause(value > high).to_owned(),
            })
        })
        .collect()
}

/// Standard errors by which a parameter must lie outside its plausible range: one in forty by chance.
const SURELY: f64 = 2.0;

/// Whether the base of `named` surely strains where that of `bare` did not: eq. 11 and an effect that pull against one another
/// describe a static force that is neither's. Friction and the give of the strands are no part of it: they are known badly. Nor is
/// what the recordings do not determine, as one held length leaves most of eq. 11 open.
pub(crate) fn strains(setting: &Setting<'_>, named: &State, bare: &State) -> bool {
    let vague = [Parameter::RubberFriction, Parameter::StrandFriction, Parameter::StrandCompliance]
        .map(|parameter| Free::One(parameter).name());
    let before = implausible(setting, bare);
    let mut strained = implausible(setting, named);
    strained.retain(|strained| {
        !vague.contains(&strained.parameter.as_str())
            && before.iter().all(|other| other.parameter != strained.parameter)
    });
    if strained.is_empty() {
        return false;
    }
    let Some(folds) = setting.fold_fits(named) else { return true };
    let errors = Uncertainty::of(&folds, setting.space).base;
    strained.iter().any(|strained| {
        let [low, high] = strained.plausible;
        let outside = (low - strained.value).max(strained.value - high);
        let error = setting.space.free.iter().zip(&errors).find(|(free, _)| free.name() == strained.parameter);
        error.is_none_or(|(_, error)| outside > SURELY * error)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    #[test]
    fn a_base_strains_where_it_leaves_what_muscles_have() {
        let healthy = Given::of(&["isobaric-triangles", "isometric-ramps"], &[]);
        let mut half_as_much_again = Given::of(&["isobaric-triangles", "isometric-ramps"], &[]);
        for instant in &mut half_as_much_again.track.instants {
            instant.force_n *= 1.5;
        }
        let fit = |given: &Given| given.setting().fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let (bare, strained) = (fit(&healthy), fit(&half_as_much_again));
        let setting = healthy.setting();
        let names: Vec<String> = implausible(&setting, &strained).into_iter().map(|found| found.parameter).collect();
        assert!(names.contains(&"k1".to_owned()), "{names:?}");
        assert!(strains(&setting, &strained, &bare));
        // What was strained before is no news.
        assert!(!strains(&setting, &strained, &strained) && !strains(&setting, &bare, &strained));
    }
}
