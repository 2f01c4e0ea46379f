//! Whether the muscle can follow the reference at all, before anything is simulated.

use crate::arm::{Elbow, Load};
use crate::error::ReachError;
use crate::simulation::Simulation;

/// Instants at which the reference is looked at.
const INSTANTS: u32 = 200;

/// Checks force against need along the whole reference, for the load as the controller is told and as it is.
///
/// # Errors
/// [`ReachError`] at the first instant where the force is out of reach.
pub fn check_reach(simulation: &Simulation<'_>) -> Result<(), ReachError> {
    let plan = simulation.plan;
    let knowledge = simulation.knowledge();
    let told = plan.load;
    let real = Load { mass_kg: plan.true_mass_kg, ..told };
    for (load, force) in [(told, simulation.model), (real, simulation.plant)] {
        let elbow = Elbow::new(&load, &plan.forearm);
        for index in 0..=INSTANTS {
            let time_s = plan.reference.duration_s * f64::from(index) / f64::from(INSTANTS);
            let at = plan.reference.at(time_s);
            let (sine, cosine) = at.q_rad.sin_cos();
            let there = knowledge.lever.at(sine, cosine);
            let torque_n_m = elbow.inertia_kg_m2 * at.ddq_rad_per_s2 + elbow.gravity_n_m(sine, cosine);
            let needed_n = torque_n_m / there.moment_arm_m;
            let [lowest_pa, highest_pa] = plan.control.pressure_limits_pa;
            let direction = if at.dq_rad_per_s < 0.0 { -1.0 } else { 1.0 };
            let available_n = force.force_n(highest_pa, there.length_m, direction);
            let length_mm = 1e3 * there.length_m;
            // Written so that a force that is no number is out of reach.
            if available_n.is_nan() || available_n < needed_n {
                let highest_kpa = 1e-3 * highest_pa;
                return Err(ReachError::TooWeak {
                    q_rad: at.q_rad,
                    time_s,
                    length_mm,
                    needed_n,
                    available_n,
                    highest_kpa,
                });
            }
            let available_n = force.force_n(lowest_pa, there.length_m, direction);
            if available_n.is_nan() || available_n > needed_n {
                let lowest_kpa = 1e-3 * lowest_pa;
                return Err(ReachError::TooStrong {
                    q_rad: at.q_rad,
                    time_s,
                    length_mm,
                    needed_n,
                    available_n,
                    lowest_kpa,
                });
            }
        }
    }
    Ok(())
}
