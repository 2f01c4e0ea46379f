//! The figure of a lift, as a document.

use pam_report::{FigureError, LiftArm, LiftFigure, lift_figure};

fn figure(n_instants: u32) -> LiftFigure {
    let column =
        |of: fn(f64) -> f64| (0..n_instants).map(|instant| of(0.01 * f64::from(instant))).collect::<Vec<f64>>();
    let arm = LiftArm {
        angle_rad: column(|time_s| 0.06 * time_s + 1e-3 * (7.0 * time_s).sin()),
        velocity_rad_per_s: column(|time_s| 0.06 + 7e-3 * (7.0 * time_s).cos()),
        acceleration_rad_per_s2: column(|time_s| -0.049 * (7.0 * time_s).sin()),
        pressure_kpa: column(|time_s| 20.0 + 16.0 * time_s),
        command_kpa: column(|time_s| 21.0 + 16.0 * time_s),
        force_n: column(|time_s| 57.0 - 2.0 * time_s),
        command_force_n: column(|time_s| 57.0 - 2.0 * time_s),
    };
    LiftFigure {
        title: "Lift of <5 kg>".to_owned(),
        subtitle: "Angle error".to_owned(),
        time_s: column(|time_s| time_s),
        reference: [column(|time_s| 0.06 * time_s), column(|_| 0.06), column(|_| 0.0)],
        arms: [arm.clone(), arm],
    }
}

#[test]
fn six_panels_that_say_different_things() {
    let svg = lift_figure(&figure(501)).unwrap();
    for text in [
        "Lift of &lt;5 kg&gt;",
        "Angle of the elbows",
        "Tracking error, angle",
        "Tracking error, velocity",
        "Angular acceleration",
        "Muscle pressure",
        "Muscle tension",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("paper"));
    assert!(svg.len() < 200_000, "{}", svg.len());
}

#[test]
fn a_long_lift_is_no_longer_document() {
    assert!(lift_figure(&figure(100_000)).unwrap().len() < 400_000);
}

#[test]
fn one_arm_may_have_been_given_up() {
    let mut one = figure(501);
    one.arms[1] = LiftArm::default();
    assert!(!lift_figure(&one).unwrap().contains("NaN"));
    one.arms[0] = LiftArm::default();
    assert_eq!(lift_figure(&one), Err(FigureError::NothingToDraw));
}
