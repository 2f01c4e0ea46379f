//! What each option of the controller is worth: the lift with all of them, without each, and with none.

use crate::config::LiftPlan;
use crate::control::{ControlSettings, LengthSource};
use crate::simulation::{Deviation, Simulation, stream};

/// Seeds that a figure is taken over.
const SEEDS: u64 = 5;

/// One way to lift.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// What it leaves out or has.
    pub name: String,
    /// Errors in each of [`CASES`].
    pub cases: [CaseErrors; CASES.len()],
}

/// Angle errors over several seeds and both arms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CaseErrors {
    /// Largest of all, in rad.
    pub max_rad: f64,
    /// Root mean square of all, in rad.
    pub rmse_rad: f64,
    /// Whether a lift was slack, saturated or given up.
    pub troubled: bool,
}

/// What each variant is tried on.
pub const CASES: [&str; 5] = ["as configured", "load +30 %", "load −30 %", "friction +50 %, turned", "lag ±50 %"];

fn deviations(plan: &LiftPlan) -> [Vec<Deviation>; CASES.len()] {
    let none = Deviation::none(plan);
    [
        vec![none.clone()],
        vec![Deviation { payload: 1.3, ..none.clone() }],
        vec![Deviation { payload: 0.7, ..none.clone() }],
        vec![Deviation { friction: 1.5, friction_state: [-1.0; 2], ..none.clone() }],
        vec![Deviation { lag: 1.5, ..none.clone() }, Deviation { lag: 0.5, ..none }],
    ]
}

/// Lifts with every variant of the controller; an option that the configuration leaves off has no row.
pub fn compare_options(simulation: &Simulation<'_>, seed: u64) -> Vec<Variant> {
    let plan = simulation.plan;
    let full = plan.control;
    let mut plans = vec![("as configured".to_owned(), plan.clone())];
    let mut without = |name: &str, control: ControlSettings| {
        if control != full {
            plans.push((format!("without {name}"), LiftPlan { control, ..plan.clone() }));
        }
    };
    without("integral action", ControlSettings { integral_per_s3: 0.0, ..full });
    without("disturbance observer", ControlSettings { disturbance_observer: false, ..full });
    without("lag compensation", ControlSettings { lag_compensation: false, ..full });
    without("hysteresis-aware inverse", ControlSettings { hysteresis_aware: false, ..full });
    without("payload estimation", ControlSettings { payload_estimation: false, ..full });
    without("length by reference", ControlSettings { length: LengthSource::Measured, ..full });
    if plan.handover_s + plan.hold_s > 0.0 {
        plans.push(("without hold".to_owned(), LiftPlan { handover_s: 0.0, hold_s: 0.0, ..plan.clone() }));
    }
    let bare = LiftPlan { control: full.paper(), ..plan.clone() };
    plans.push(("computed torque alone".to_owned(), bare.clone()));
    plans.push(("computed torque alone, no hold".to_owned(), LiftPlan { handover_s: 0.0, hold_s: 0.0, ..bare }));
    plans
        .into_iter()
        .map(|(name, plan)| {
            let varied = Simulation { plan: &plan, ..*simulation };
            let cases = deviations(&plan).map(|deviations| errors(&varied, &deviations, seed));
            Variant { name, cases }
        })
        .collect()
}

fn errors(simulation: &Simulation<'_>, deviations: &[Deviation], seed: u64) -> CaseErrors {
    let (mut max_rad, mut squares, mut count, mut troubled) = (0.0_f64, 0.0, 0.0, false);
    for deviation in deviations {
        for offset in 0..SEEDS {
            let mut rng = stream(seed.wrapping_add(offset), 0);
            for outcome in simulation.run(deviation, simulation.plant, &mut rng, |_, _| {}) {
                max_rad = max_rad.max(outcome.errors.angle_rad.max);
                squares += outcome.errors.angle_rad.rmse.powi(2);
                count += 1.0;
                troubled |= !outcome.is_clean();
            }
        }
    }
    CaseErrors { max_rad, rmse_rad: (squares / count).sqrt(), troubled }
}
