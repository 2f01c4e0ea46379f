use super::*;

fn parameter(name: &str, value: f64, unit: &str) -> ParameterEntry {
    ParameterEntry {
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
        stderr: None,
        status: ParameterStatus::Fitted,
    }
}

fn effect(id: &str, parameters: Vec<ParameterEntry>) -> EffectEntry {
    EffectEntry::new(id, parameters)
}

fn artifact(effects: Vec<EffectEntry>) -> ModelArtifact {
    let statistics = FitStatistics {
        rmse_n: 1.0,
        rmse_all_n: 1.0,
        max_n: 3.0,
        r2: 0.999,
        fit_percent: 99.0,
        n_samples: 1000,
        n_unsettled: 0,
    };
    let values = [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 3e9, 1.2e-3, 0.0];
    ModelArtifact {
        schema: SCHEMA.to_owned(),
        tool: Tool { name: "pam-identify".to_owned(), version: "0.1.0".to_owned() },
        inputs: Vec::new(),
        config: IdentifyConfig {
            n_particles: 60,
            n_iterations: 200,
            n_starts: 4,
            polish: true,
            loss: Loss::Square,
            freed: Vec::new(),
            fixed: Vec::new(),
            bladder_ratio: 0.89,
            assumed: Assumed::default(),
            accept_implausible: false,
        },
        seed: 1,
        muscle_name: None,
        geometry: Muscle::nominal(),
        strand_modulus_pa: 3e9,
        form: Form::Corrected,
        parameters: Parameter::ALL
            .into_iter()
            .zip(values)
            .map(|(known, value)| parameter(known.artifact_name(), value, known.unit()))
            .collect(),
        composites: Vec::new(),
        effects,
        correlation: Correlation { names: Vec::new(), matrix: Vec::new() },
        fit: FitReport {
            estimation: statistics,
            validation: None,
            recordings: Vec::new(),
            noise_floor_n: 0.9,
            force_noise_n: 0.2,
            effective_samples: 500.0,
        },
        domain: Domain {
            pressure_pa: [500.0, 5e5],
            length_m: [0.211, 0.268],
            force_n: [4.5, 1119.0],
            length_rate_m_per_s: 0.03,
            pressure_rate_pa_per_s: 2.9e5,
        },
        direction: Thresholds {
            length_m: 150e-6,
            pressure_pa: 2.5e3,
            held_m: 0.0,
            turn_m: 0.0,
            standstill: Standstill::AT_ONCE,
        },
        standstill_laws: Vec::new(),
        quality: Vec::new(),
        search: SearchReport { starts: Vec::new(), converged: true, column_floor_rmse_n: 1.0 },
        unbounded: None,
        warnings: Vec::new(),
    }
}

fn rubber(width_n: f64) -> EffectEntry {
    // The order of the parameters does not matter.
    effect("rubber-hysteresis", vec![parameter("width_n", width_n, "N"), parameter("slip_distance_m", 1e-3, "m")])
}

#[test]
fn effects_come_on_top_of_eq_11() {
    let artifact = artifact(vec![rubber(7.0)]);
    artifact.check().expect("a plausible artifact");
    let model = artifact.augmented_model();
    assert_eq!((model.terms()[0].shape.as_slice(), model.terms()[0].amplitudes.as_slice()), (&[1e-3][..], &[7.0][..]));
    let difference_n = model.settled_force_n(3e5, 0.24, 1.0) - artifact.force_model().force_n(3e5, 0.24, 1.0);
    assert!((difference_n + 7.0).abs() < 1e-9);
}

#[test]
fn an_artifact_survives_its_own_text_with_effects() {
    let mut artifact = artifact(vec![rubber(7.0)]);
    let text = |artifact: &ModelArtifact| serde_json::to_string(artifact).expect("an artifact is JSON");
    let everywhere = text(&artifact);
    assert_eq!(serde_json::from_str::<ModelArtifact>(&everywhere).expect("its own text"), artifact);
    assert!(!everywhere.contains("only_as_fitted"), "an effect acts in every recording unless it is said");
    artifact.effects[0].only_as_fitted = true;
    let read: ModelArtifact = serde_json::from_str(&text(&artifact)).expect("its own text");
    assert_eq!(read, artifact);
    assert_eq!(read.augmented_model().not_elsewhere(), ["rubber-hysteresis"]);
}

#[test]
fn a_parameter_of_another_unit_or_none_of_a_model_is_refused_by_name() {
    let refusal = |change: &dyn Fn(&mut ModelArtifact)| {
        let mut artifact = artifact(Vec::new());
        change(&mut artifact);
        artifact.check().expect_err("a refusal")
    };
    let messages = [
        refusal(&|artifact| artifact.parameters[3].unit = "kPa".to_owned()),
        refusal(&|artifact| artifact.parameters[0].unit = "N".to_owned()),
        refusal(&|artifact| artifact.parameters.push(parameter("rest_lenght", 0.26, "m"))),
        refusal(&|artifact| artifact.parameters.push(parameter("gears", 4.0, "1"))),
        refusal(&|artifact| {
            artifact.parameters.extend([0.26, 0.27].map(|value| parameter("rest_length", value, "m")));
        }),
        refusal(&|artifact| artifact.parameters[5].value = -1e300),
    ];
    insta::assert_snapshot!(messages.join("\n"), @r#"
    the unit of parameter c10 is "kPa", expected "Pa"
    the unit of parameter k1 is "N", expected "1"
    parameter "rest_lenght" is unknown; did you mean rest_length?
    parameter "gears" is unknown; a model has k1, k2, k3, c10, c01, strand_modulus, rubber_friction, strand_friction, rest_length, rest_radius, braid_angle, wall_thickness
    parameter rest_length stands there twice
    strand_modulus is -1e300, which no strand has
    "#);
    let mut fitted = artifact(Vec::new());
    fitted.parameters.push(parameter("braid_angle", 0.43, "rad"));
    fitted.check().expect("a model with a fitted dimension");
}

#[test]
fn what_no_program_could_read_is_not_written() {
    let mut artifact = artifact(Vec::new());
    artifact.json().expect("a plausible artifact");
    artifact.fit.estimation.fit_percent = f64::NEG_INFINITY;
    insta::assert_snapshot!(artifact.json().expect_err("null is no number"), @"nothing is written, since no program could read it: fit_percent is no finite number");
}

#[test]
fn a_lag_of_before_air_had_a_mass_is_read_as_it_was_meant() {
    let lag = |entries| artifact(vec![effect("pressure-lag", entries)]).augmented_model().terms()[0].shape.clone();
    let time = || parameter("time_constant_s", 0.06, "s");
    assert_eq!(lag(vec![time()]), [0.06, 0.0]);
    assert_eq!(lag(vec![time(), parameter("air_mass", 0.5, "1")]), [0.06, 0.5]);
}

#[test]
fn what_the_catalogue_does_not_have_is_refused_by_name() {
    let refusal = |effects| artifact(effects).check().expect_err("a refusal");
    let one = |entries| refusal(vec![effect("rubber-hysteresis", entries)]);
    let width = || parameter("width_n", 7.0, "N");
    let distance = || parameter("slip_distance_m", 1e-3, "m");
    let messages = [
        refusal(vec![effect("stribek", vec![])]),
        one(vec![width()]),
        one(vec![width(), distance(), parameter("slope", 1.0, "1")]),
        one(vec![width(), width(), distance()]),
        one(vec![width(), parameter("slip_distance_m", 1.0, "mm")]),
        one(vec![parameter("width_n", -7.0, "N"), distance()]),
        one(vec![parameter("width_n", f64::NAN, "N"), distance()]),
        refusal(vec![rubber(7.0), rubber(8.0)]),
    ];
    insta::assert_snapshot!(messages.join("\n"), @r#"
    effect "stribek" is unknown; the nearest are stribeck, slack, inertia
    effect rubber-hysteresis lacks its parameter slip_distance_m; a model of an earlier catalogue has to be diagnosed again
    effect rubber-hysteresis has no parameter slope; it has slip_distance_m, width_n
    parameter width_n of effect rubber-hysteresis stands there twice
    parameter slip_distance_m of effect rubber-hysteresis is in mm; write it in m
    parameter width_n of effect rubber-hysteresis is -7; physics allows 0 to 200 N
    parameter width_n of effect rubber-hysteresis is NaN; physics allows 0 to 200 N
    effect rubber-hysteresis stands there twice
    "#);
}

#[test]
fn a_direction_that_flips_before_it_turns_is_refused() {
    let mut turned = artifact(vec![]);
    turned.direction =
        Thresholds { length_m: 0.0, pressure_pa: 0.0, held_m: 0.0, turn_m: 0.0, standstill: Standstill::Held };
    turned.check().expect("no threshold is one");
    turned.direction.length_m = -1.0;
    assert_eq!(turned.check(), Err("a threshold of the direction is negative: -1 m, 0 Pa".to_owned()));
}

/// Whether a model may have this law of friction at standstill.
fn may_have(standstill: Standstill) -> bool {
    let mut model = artifact(vec![]);
    model.direction.standstill = standstill;
    model.check().is_ok()
}

#[test]
fn friction_that_slides_by_more_than_all_of_it_or_partly_at_once_is_refused() {
    for (over_pa, share, is_right) in [
        (0.0, 1.0, true),
        (4e4, 0.6, true),
        (0.0, 0.6, false),
        (4e4, 0.0, false),
        (4e4, 1.2, false),
        (-1.0, 1.0, false),
    ] {
        assert_eq!(may_have(Standstill::Slides { over_pa, share }), is_right, "{over_pa} Pa, {share}");
    }
}

#[test]
fn friction_that_relaxes_at_once_or_not_at_all_is_refused() {
    for (time_constant_s, to, is_right) in [
        (3.0, 0.0, true),
        (3.0, 0.5, true),
        (0.0, 0.5, false),
        (f64::NAN, 0.5, false),
        (3.0, 1.0, false),
        (3.0, -0.1, false),
    ] {
        assert_eq!(may_have(Standstill::Relaxes { time_constant_s, to }), is_right, "{time_constant_s} s, {to}");
    }
}

#[test]
fn events_may_come_again() {
    let step = |instant_s| {
        let values = [("recording", 0.0, "1"), ("instant_s", instant_s, "s"), ("step_n", 2.0, "N")];
        effect("force-step", values.map(|(name, value, unit)| parameter(name, value, unit)).to_vec())
    };
    artifact(vec![step(3.0), step(9.0)]).check().expect("two events");
}
