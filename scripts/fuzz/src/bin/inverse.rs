//! Inverse networks; then their pressure inside and outside of their domain.

#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use pam_artifact::InverseArtifact;
use pam_fuzz::{json, with_file};
use pam_inverse_model::InverseNetwork;

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| { json::mutate(data, size, max_size, seed) });

fuzz_target!(|data: &[u8]| {
    let read = with_file(data, InverseArtifact::read).map_err(|error| error.to_string());
    let Ok((artifact, _)) = read else { return };
    let network = InverseNetwork::from_artifact(&artifact);
    let [shortest_m, longest_m] = network.domain().length_m;
    for length_m in [shortest_m, 0.5 * (shortest_m + longest_m), longest_m, 0.0, -1.0, f64::MAX, f64::NAN] {
        // As exo-track asks, which stays in the domain.
        let inside_m = length_m.clamp(shortest_m, longest_m);
        for direction in [-1.0, 0.3, 1.0, f64::NAN] {
            if let Some([lowest_n, highest_n]) = network.reach_n(inside_m, direction)
                && lowest_n <= highest_n
            {
                let _ = network.pressure_pa(20.0_f64.clamp(lowest_n, highest_n), inside_m, direction);
            }
            for force_n in [-5.0, 0.0, 200.0, 1e300, f64::NAN] {
                let _ = network.pressure_pa(force_n, length_m, direction);
                let _ = network.is_inside(force_n, length_m, direction);
            }
        }
    }
});
