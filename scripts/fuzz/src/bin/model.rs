//! Force models; then their force at a few points and along a recording, their inverse, and a draw of their parameters.

#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use pam_artifact::ModelArtifact;
use pam_exo::uncertainty::Uncertainty;
use pam_fuzz::{json, short_recording, with_file};
use pam_identification::evaluate::evaluate_augmented;
use pam_identification::predict::{augmented_forces_n, outside, prepare};
use pam_inverse_model::ExactInverse;
use pam_inverse_model::domain::InverseBox;

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| { json::mutate(data, size, max_size, seed) });

fuzz_target!(|data: &[u8]| {
    let read = with_file(data, ModelArtifact::read).map_err(|error| error.to_string());
    let Ok((artifact, _)) = read else { return };
    let model = artifact.augmented_model();
    for pressure_pa in [0.0, 3e5] {
        for length_m in [0.2, 0.25, 1.0] {
            for direction in [-1.0, 0.0, 1.0] {
                let _ = model.settled_force_n(pressure_pa, length_m, direction);
            }
        }
    }
    if let Ok(prepared) = prepare(short_recording(), &artifact) {
        let _ = outside(&prepared, &artifact.domain);
        let _ = augmented_forces_n(&prepared, &model.elsewhere(), artifact.direction);
        let _ = evaluate_augmented(std::slice::from_ref(&prepared), &model, artifact.direction);
    }
    let _ = Uncertainty::new(&artifact).map_err(|error| error.to_string());
    if let Ok(inverse_box) = InverseBox::of(&artifact.domain) {
        let middle = |range: [f64; 2]| 0.5 * (range[0] + range[1]);
        let (force_n, length_m) = (middle(inverse_box.force_n), middle(inverse_box.length_m));
        let inverse = ExactInverse::new(model.of_the_muscle(), inverse_box, 0.05);
        let _ = inverse.pressure_pa(force_n, length_m, 1.0);
    }
});
