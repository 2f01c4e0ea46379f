//! What each option of the controller is worth: the lift with all of them, without each, and with none.

use pam_muscle::effects::AugmentedModel;
use pam_muscle::force::{BaseParameters, ForceModel, Parameter};

use crate::config::LiftPlan;
use crate::control::{ControlSettings, LengthSource};
use crate::plant::ValveKind;
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

/// What each variant is tried on: other loads and wear, then other valves and muscles.
pub const CASES: [&str; 9] = [
    "as configured",
    "load +30 %",
    "load −30 %",
    "friction +50 %, turned",
    "lag ±50 %",
    "on/off valve",
    "on/off, load ±30 %",
    "pull −10 %",
    "rubber +30 %",
];

/// A plant that the controller was not told of.
struct Case {
    deviations: Vec<Deviation>,
    valve: ValveKind,
    force: AugmentedModel,
}

fn cases(simulation: &Simulation<'_>) -> [Case; CASES.len()] {
    let none = Deviation::none(simulation.plan);
    let load = |payload| Deviation { payload, ..none.clone() };
    let lag = |lag| Deviation { lag, ..none.clone() };
    let worn = Deviation { friction: 1.5, friction_state: [-1.0; 2], ..none.clone() };
    let as_configured = |deviations: Vec<Deviation>| Case {
        deviations,
        valve: simulation.plan.valve.kind,
        force: simulation.plant.clone(),
    };
    let on_off = |deviations| Case { valve: ValveKind::OnOff, ..as_configured(deviations) };
    let other = |parameters: &[Parameter], factor: f64| Case {
        force: scaled(simulation.plant, parameters, factor),
        ..as_configured(vec![none.clone()])
    };
    [
        as_configured(vec![none.clone()]),
        as_configured(vec![load(1.3)]),
        as_configured(vec![load(0.7)]),
        as_configured(vec![worn]),
        as_configured(vec![lag(1.5), lag(0.5)]),
        on_off(vec![none.clone()]),
        on_off(vec![load(1.3), load(0.7)]),
        other(&[Parameter::K1], 0.9),
        other(&[Parameter::C10, Parameter::C01], 1.3),
    ]
}

/// The model with some of its parameters scaled.
fn scaled(model: &AugmentedModel, parameters: &[Parameter], factor: f64) -> AugmentedModel {
    let base = model.base();
    let mut theta = base.parameters().theta;
    parameters.iter().for_each(|parameter| theta[parameter.index()] *= factor);
    model.on(ForceModel::new(base.muscle(), base.strand_modulus_pa(), base.form(), BaseParameters { theta }))
}

/// Lifts with every variant of the controller; an option that the configuration leaves off has no row. `observe` is
/// told how many of how many figures are done.
pub fn compare_options(simulation: &Simulation<'_>, seed: u64, mut observe: impl FnMut(u64, u64)) -> Vec<Variant> {
    let cases = cases(simulation);
    let variants = variants(simulation);
    let n_figures = (variants.len() * CASES.len()) as u64;
    let mut n_done = 0;
    variants
        .into_iter()
        .map(|(name, plan)| {
            let cases = cases.each_ref().map(|case| {
                let errors = errors(simulation, &plan, case, seed);
                n_done += 1;
                observe(n_done, n_figures);
                errors
            });
            Variant { name, cases }
        })
        .collect()
}

/// The configuration with all options, without each, and with none.
fn variants(simulation: &Simulation<'_>) -> Vec<(String, LiftPlan)> {
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
    without("ramp", ControlSettings { ramp: false, ..full });
    without("hysteresis-aware inverse", ControlSettings { hysteresis_aware: false, ..full });
    if !simulation.model.is_plain() {
        without("memory of effects", ControlSettings { effect_memory: false, ..full });
    }
    without("payload estimation", ControlSettings { payload_estimation: false, ..full });
    without("length by reference", ControlSettings { length: LengthSource::Measured, ..full });
    if plan.handover_s + plan.hold_s > 0.0 {
        plans.push(("without hold".to_owned(), LiftPlan { handover_s: 0.0, hold_s: 0.0, ..plan.clone() }));
    }
    let bare = LiftPlan { control: full.paper(), ..plan.clone() };
    plans.push(("computed torque alone".to_owned(), bare.clone()));
    plans.push(("computed torque alone, no hold".to_owned(), LiftPlan { handover_s: 0.0, hold_s: 0.0, ..bare }));
    plans
}

fn errors(simulation: &Simulation<'_>, plan: &LiftPlan, case: &Case, seed: u64) -> CaseErrors {
    let mut plan = plan.clone();
    plan.valve.kind = case.valve;
    let varied = Simulation { plan: &plan, ..*simulation };
    let (mut max_rad, mut squares, mut count, mut troubled) = (0.0_f64, 0.0, 0.0, false);
    for deviation in &case.deviations {
        for offset in 0..SEEDS {
            let mut rng = stream(seed.wrapping_add(offset), 0);
            for outcome in varied.run(deviation, &case.force, &mut rng, |_, _| {}) {
                let [max, rmse] = if outcome.began {
                    [outcome.errors.angle_rad.max, outcome.errors.angle_rad.rmse]
                } else {
                    [plan.diverged_rad; 2]
                };
                max_rad = max_rad.max(max);
                squares += rmse.powi(2);
                count += 1.0;
                troubled |= !outcome.is_clean();
            }
        }
    }
    CaseErrors { max_rad, rmse_rad: (squares / count).sqrt(), troubled }
}
