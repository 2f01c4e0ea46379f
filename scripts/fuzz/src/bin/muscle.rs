//! Muscle files; then a look at a recording with that muscle, and the virtual bench with it.

#![no_main]

use libfuzzer_sys::fuzz_target;
use pam_fuzz::{fit_shortly, short_recording, with_file};
use pam_muscle::MuscleFile;
use pam_virtual_bench::Bench;
use pam_virtual_bench::parameters::Parameters;
use pam_virtual_bench::protocol::{Options, command};
use pam_virtual_bench::true_muscle::TrueMuscle;

fuzz_target!(|data: &[u8]| {
    let Ok(file) = with_file(data, MuscleFile::read).map_err(|error| error.to_string()) else { return };
    let parameters = Parameters { strand_modulus_pa: file.strand_modulus_pa, ..Parameters::nominal() };
    let muscle = TrueMuscle::new(file.muscle.clone(), file.strand_modulus_pa, parameters);
    let options = Options { seed: 1, duration_scale: 1e-3, ..Options::default() };
    if let Ok(command) = command("isometric-ramps", &muscle, &options) {
        let bench = Bench::new(muscle, command).at_rate(20.0).expect("a rate in range");
        let _ = bench.record(1);
    }
    if data.len() % 8 != 0 && !file.fit.is_empty() {
        return; // Freed dimensions take fifty times as long to fit as the other parameters.
    }
    fit_shortly(file, short_recording(), true);
});
