//! Diagnoses: what is read can be written and read again, and is the same.

#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use pam_artifact::DiagnosisArtifact;
use pam_fuzz::{json, with_file};

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| { json::mutate(data, size, max_size, seed) });

fuzz_target!(|data: &[u8]| {
    let read = with_file(data, DiagnosisArtifact::read).map_err(|error| error.to_string());
    let Ok((artifact, _)) = read else { return };
    let text = serde_json::to_vec(&artifact).expect("an artifact is JSON");
    assert_eq!(serde_json::from_slice::<DiagnosisArtifact>(&text).expect("its own text"), artifact);
});
