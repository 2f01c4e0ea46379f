//! Configurations of a lift; then whether it is within reach, and the lift itself where it is short.

#![no_main]

use libfuzzer_sys::fuzz_target;
use pam_exo::config::LiftConfig;
use pam_exo::inverse::ExactInverse;
use pam_exo::reach::check_reach;
use pam_exo::simulation::Simulation;
use pam_fuzz::{nominal_model, with_file};

/// Steps of the plant that are simulated at most.
const MOST_STEPS: f64 = 3000.0;

fuzz_target!(|data: &[u8]| {
    let read = with_file(data, LiftConfig::read).map_err(|error| error.to_string());
    let Ok((_, plan, _)) = read else { return };
    let artifact = nominal_model();
    let model = artifact.augmented_model().of_the_muscle();
    let [lowest_pa, highest_pa] = plan.control.pressure_limits_pa;
    let inverse = ExactInverse::new(model.clone(), lowest_pa, highest_pa);
    let simulation = Simulation { plan: &plan, model: &model, inverse: &inverse, plant: &model };
    let duration_s = plan.handover_s + plan.hold_s + plan.reference.duration_s + plan.settle_s;
    if check_reach(&simulation, &artifact.domain).is_ok() && duration_s / plan.step_s <= MOST_STEPS {
        let _ = simulation.run_nominal(1, |_, _| {});
    }
});
