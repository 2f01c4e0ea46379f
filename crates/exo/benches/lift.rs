//! Speed of lifts: two arms, 5 s, with and without the 2 s before it, and a thousandth of a study.

use std::path::Path;

use pam_exo::config::{LiftConfig, LiftPlan};
use pam_exo::inverse::ExactInverse;
use pam_exo::simulation::Simulation;
use pam_muscle::MuscleFile;
use pam_muscle::effects::AugmentedModel;
use pam_muscle::force::{BaseParameters, ForceModel, Form};

fn main() {
    divan::main();
}

fn setup() -> (LiftPlan, AugmentedModel, ExactInverse) {
    let (config, muscle) =
        (include_str!("../../../configs/lift.toml"), include_str!("../../../configs/muscle-nominal.toml"));
    let plan =
        LiftConfig::parse(config, Path::new("lift.toml")).and_then(|config| config.check(Path::new("lift.toml")));
    let (plan, muscle) = match (plan, MuscleFile::parse(muscle, Path::new("muscle.toml"))) {
        (Ok(plan), Ok(muscle)) => (plan, muscle.muscle),
        (plan, muscle) => panic!("{plan:?} {muscle:?}"),
    };
    let parameters = BaseParameters { theta: [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.0] };
    let model = ForceModel::new(&muscle, 3e9, Form::Corrected, parameters);
    let inverse = ExactInverse::new(model.clone(), 0.0, 5e5);
    (plan, model.into(), inverse)
}

#[divan::bench]
fn lift_of_5_s(bencher: divan::Bencher<'_, '_>) {
    let (plan, model, inverse) = setup();
    let plan = LiftPlan { handover_s: 0.0, hold_s: 0.0, ..plan };
    let simulation = Simulation { plan: &plan, model: &model, inverse: &inverse, plant: &model };
    bencher.bench_local(|| simulation.run_nominal(1, |_, _| {}));
}

#[divan::bench]
fn lift_of_5_s_after_a_hold_of_2_s(bencher: divan::Bencher<'_, '_>) {
    let (plan, model, inverse) = setup();
    let simulation = Simulation { plan: &plan, model: &model, inverse: &inverse, plant: &model };
    bencher.bench_local(|| simulation.run_nominal(1, |_, _| {}));
}
