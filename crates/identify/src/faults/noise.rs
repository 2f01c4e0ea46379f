//! A recording whose noise alone hides what a model misses: a hum, a loose shield, a gauge that bubbles.
//!
//! The noise floor of the sensors is subtracted wherever a model is judged, so that a recording with a hum of
//! fifty newtons is followed as well as can be, by every model. That is true, and worth nothing unless it is said.

use pam_muscle::force::ForceModel;

use crate::error::IdentifyError;
use crate::evaluate::{evaluate, noise_floor_n};
use crate::prepare::Prepared;

/// Times the noise of the quietest, or of what a model was identified on, beyond which a recording is said to be noisy, and the
/// share of the range of its force that this must be at least.
const NOISIER: f64 = 5.0;
const LEAST_SHARE: f64 = 0.01;
/// Share of the range of the force beyond which noise is said, whatever the others have.
const SHARE: f64 = 0.03;
/// Share of the noise floor that a model leaves at least where the floor is noise: steps and haste look like it, and a model follows
/// them.
const LEAVES: f64 = 1.0 / 3.0;

/// Whether a noise floor can be that of sensors, where a model leaves `left_n`: what is noise, no model follows.
pub fn is_noise(floor_n: f64, left_n: f64) -> bool {
    left_n >= LEAVES * floor_n
}

/// Message about recordings that are much noisier than `own_n`, which the sensors leave of the recordings of the model, or than
/// the quietest of them where that is not known: a word for each.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn words<'a>(
    recordings: impl Iterator<Item = &'a Prepared>,
    model: &ForceModel,
    own_n: Option<f64>,
) -> Result<Vec<String>, IdentifyError> {
    let mut floors = Vec::new();
    for prepared in recordings {
        let Some(force) = prepared.quality.channel("force") else { continue };
        let alone = std::slice::from_ref(prepared);
        let floor_n = noise_floor_n(alone, model)?;
        // Where the model has no force there is nothing to compare with, and other words are found for that.
        let left_n = evaluate(alone, model).map_or(f64::INFINITY, |evaluation| evaluation.each[0].rmse_n);
        if is_noise(floor_n, left_n) {
            floors.push((prepared.recording.path.as_str(), floor_n, force.highest - force.lowest));
        }
    }
    let quietest_n = floors.iter().map(|floor| floor.1).fold(f64::INFINITY, f64::min);
    let others_n = own_n.unwrap_or(quietest_n);
    let noisy = floors.into_iter().filter(|&(_, floor_n, range_n)| {
        floor_n > SHARE * range_n || (floor_n > NOISIER * others_n && floor_n > LEAST_SHARE * range_n)
    });
    Ok(noisy
        .map(|(path, floor_n, range_n)| {
            let others = if floor_n > NOISIER * others_n {
                format!("where the others have {others_n:.2} N")
            } else {
                format!("{:.0} % of the range of the force", 100.0 * floor_n / range_n)
            };
            format!(
                "{path}: the noise of its sensors alone leaves {floor_n:.2} N, {others}, and hides whatever is smaller: look for a \
                 hum, a loose shield or a worn sensor"
            )
        })
        .collect())
}
