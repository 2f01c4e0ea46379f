//! What a model knows and does not apply: each program says what it leaves out, in the same words.

use std::path::Path;

use pam_muscle::effects::AugmentedModel;

use crate::Console;

/// Of effects that a model keeps to the recordings that it was fitted to.
const FITTED: &str = "act only in the recordings that the model was fitted to";

/// `model`, read from `path`, for recordings that it was not fitted to.
pub fn for_any_recording(model: &AugmentedModel, path: &Path, console: &Console) -> AugmentedModel {
    say(&model.not_elsewhere(), FITTED, path, console);
    model.elsewhere()
}

/// `model`, read from `path`, as a muscle takes it along: without instruments and fixture, and wherever the muscle goes.
pub fn for_the_muscle(model: &AugmentedModel, path: &Path, console: &Console) -> AugmentedModel {
    let beside = model.beside_the_muscle();
    say(&beside, "are not the muscle's", path, console);
    let mut fitted = model.not_elsewhere();
    fitted.retain(|id| !beside.contains(id));
    say(&fitted, FITTED, path, console);
    model.of_the_muscle()
}

fn say(ids: &[&str], reason: &str, path: &Path, console: &Console) {
    if !ids.is_empty() {
        console.note(format!("{}: left out, as they {reason}: {}", path.display(), ids.join(", ")));
    }
}
