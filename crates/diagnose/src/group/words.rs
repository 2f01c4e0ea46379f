//! What a group says in words.

use std::collections::BTreeMap;

use pam_artifact::group::{GroupMuscle, RigEffect, Says};

use super::together::Group;

/// What was found, in one paragraph: the rig, then what muscles have of their own.
pub(super) fn statement(rig: &[RigEffect], muscles: &[GroupMuscle], group: &Group) -> String {
    let mut sentences = Vec::new();
    if rig.is_empty() {
        sentences.push(format!("The {} muscles together show no effect of the rig.", muscles.len()));
    }
    for effect in rig {
        sentences.push(of_the_rig(effect));
    }
    if !group.denied.is_empty() {
        let ids = group.denied.join(" or ");
        sentences.push(format!("Held-out recordings do not show {ids}, which would explain the fitted ones."));
    }
    for id in &group.apart {
        sentences.push(format!("What looks like {id} has another value in every muscle: it is not of one rig."));
    }
    let mut own: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for muscle in muscles {
        for effect in &muscle.effects {
            own.entry(&effect.id).or_default().push(&muscle.name);
        }
    }
    for (id, names) in own {
        let (have, their) = if names.len() == 1 { ("has", "its") } else { ("have", "their") };
        sentences.push(format!("{} {have} {id} of {their} own.", names.join(", ")));
    }
    sentences.join(" ")
}

fn of_the_rig(effect: &RigEffect) -> String {
    let of = |says: Says| -> Vec<&str> {
        effect.muscles.iter().filter(|one| one.says == says).map(|one| one.muscle.as_str()).collect()
    };
    let shown = of(Says::Shows);
    let mut sentence = format!("The rig has {}: {} show it", effect.id, shown.join(", "));
    if !effect.alternatives.is_empty() {
        sentence.push_str(&format!(" (or {})", effect.alternatives.join(", ")));
    }
    for (says, words) in [
        (Says::Differs, "has a value of its own in"),
        (Says::CannotShow, "cannot be seen in"),
        (Says::Denies, "is not there in"),
    ] {
        let names = of(says);
        if !names.is_empty() {
            sentence.push_str(&format!("; it {words} {}", names.join(", ")));
        }
    }
    sentence + "."
}

/// What a person should know.
pub(super) fn warnings(rig: &[RigEffect], muscles: &[GroupMuscle]) -> Vec<String> {
    let mut warnings = Vec::new();
    for effect in rig {
        for one in &effect.muscles {
            if !one.in_model && one.says != Says::Denies {
                warnings.push(format!(
                    "{}: {} leaves more of its recordings than nothing does; it is followed without it",
                    one.muscle, effect.id
                ));
            }
            match one.says {
                Says::Differs => warnings.push(format!(
                    "{}: {} differs from what the other muscles share; look at what was changed on the rig for it",
                    one.muscle, effect.id
                )),
                Says::Denies => warnings.push(format!(
                    "{}: its recordings speak against {}, which other muscles show; was it on the same rig?",
                    one.muscle, effect.id
                )),
                Says::Shows | Says::CannotShow => {}
            }
        }
    }
    warnings.extend(rig.iter().flat_map(|effect| confused_in_all(effect, muscles)));
    for muscle in muscles {
        if let Some(holdout) = muscle.holdout
            && holdout.together_all_n > 1.1 * holdout.alone_all_n.max(holdout.noise_floor_n)
        {
            warnings.push(format!(
                "{}: what the muscles share leaves {:.2} N of what was held out, its own diagnosis {:.2} N",
                muscle.name, holdout.together_all_n, holdout.alone_all_n
            ));
        }
    }
    warnings
}

/// Names that every muscle has of its own and that are confused with `effect` of the rig: each may be a part of it.
fn confused_in_all(effect: &RigEffect, muscles: &[GroupMuscle]) -> Vec<String> {
    let Some(of_the_rig) = pam_muscle::effects::effect(&effect.id) else { return Vec::new() };
    let is_everywhere = |id: &str| muscles.iter().all(|muscle| muscle.effects.iter().any(|own| own.id == id));
    let confused = of_the_rig.page().confused_with.iter().filter(|confusion| is_everywhere(confusion.id));
    let said = confused.map(|confusion| {
        let (id, of_rig, test) = (confusion.id, &effect.id, confusion.test);
        format!("every muscle has {id} beside {of_rig} of the rig, which it is easily confused with: {test}")
    });
    said.collect()
}
