//! Whether the muscle can follow the reference at all, before anything is simulated.

use crate::arm::Elbow;
use crate::error::ReachError;
use crate::plant::MusclePhysics;
use crate::reference::ReferenceAt;
use crate::simulation::{Deviation, Simulation};

/// Instants at which the reference is looked at.
const INSTANTS: u32 = 200;

/// Checks force against need along the whole reference: as the controller is told, and as it is.
///
/// # Errors
/// [`ReachError`] at the first instant where the force is out of reach.
pub fn check_reach(simulation: &Simulation<'_>) -> Result<(), ReachError> {
    let plan = simulation.plan;
    let real = simulation.physics(&Deviation::none(plan), simulation.plant);
    let told = MusclePhysics::new(simulation.model, 1.0, plan.presliding_m, 0.0);
    for (elbow, muscle) in [(Elbow::new(&plan.load, &plan.forearm), &told), (real.elbow, &real.muscle)] {
        for index in 0..=INSTANTS {
            let time_s = plan.reference.duration_s * f64::from(index) / f64::from(INSTANTS);
            check_instant(simulation, &elbow, muscle, time_s, plan.reference.at(time_s))?;
        }
    }
    Ok(())
}

fn check_instant(
    simulation: &Simulation<'_>,
    elbow: &Elbow,
    muscle: &MusclePhysics,
    time_s: f64,
    at: ReferenceAt,
) -> Result<(), ReachError> {
    let (sine, cosine) = at.q_rad.sin_cos();
    let there = simulation.lever().at(sine, cosine);
    let needed_n = (elbow.inertia_kg_m2 * at.ddq_rad_per_s2 + elbow.gravity_n_m(sine, cosine)) / there.moment_arm_m;
    let [lowest_pa, highest_pa] = simulation.plan.control.pressure_limits_pa;
    let direction = if at.dq_rad_per_s < 0.0 { -1.0 } else { 1.0 };
    let at_lowest_n = muscle.thrust_n(lowest_pa, there.length_m, direction);
    let at_highest_n = muscle.thrust_n(highest_pa, there.length_m, direction);
    let (q_rad, length_mm) = (at.q_rad, 1e3 * there.length_m);
    let (lowest_kpa, highest_kpa) = (1e-3 * lowest_pa, 1e-3 * highest_pa);
    let straight_mm = 1e3 * muscle.force().base().muscle().strand_length_m();
    if length_mm >= straight_mm {
        Err(ReachError::Overstretched { q_rad, time_s, length_mm, straight_mm })
    } else if at_highest_n <= 0.0 {
        Err(ReachError::Slack { q_rad, time_s, length_mm, needed_n, highest_kpa })
    } else if at_highest_n.is_nan() || at_highest_n < needed_n {
        // Also a force that is no number is out of reach.
        Err(ReachError::TooWeak { q_rad, time_s, length_mm, needed_n, available_n: at_highest_n, highest_kpa })
    } else if at_lowest_n.is_nan() || at_lowest_n > needed_n {
        Err(ReachError::TooStrong { q_rad, time_s, length_mm, needed_n, available_n: at_lowest_n, lowest_kpa })
    } else {
        Ok(())
    }
}
