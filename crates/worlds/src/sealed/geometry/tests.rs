use super::*;

#[test]
fn a_contact_that_is_complete_only_shifts_the_pressure() {
    let now = Moment::default();
    for (mut law, threshold_pa) in [(Contact::Rayleigh(3e4), 0.5 * PI.sqrt() * 3e4), (Contact::Exponential(2e4), 2e4)] {
        assert!((law.pressure(&now, 4e5) - (4e5 - threshold_pa)).abs() < 5.0, "{law:?}");
        assert_eq!(law.pressure(&now, 0.0), 0.0);
        let (mut last_pa, mut last_slope) = (0.0, -1e-9);
        for step in 1..400 {
            let here_pa = law.pressure(&now, 1e3 * f64::from(step));
            let slope = (here_pa - last_pa) / 1e3;
            assert!(slope >= last_slope - 1e-3 && slope <= 1.0 + 1e-3, "{law:?} at {step} kPa: {slope}");
            (last_pa, last_slope) = (here_pa, slope);
        }
    }
}

#[test]
fn cones_lose_volume_only_where_the_muscle_is_wider_than_its_ends() {
    assert!(lost_m3(0.01, 0.02, 0.02).abs() < 1e-18);
    let lost = lost_m3(0.01, 0.03, 0.02);
    assert!(lost > 0.0 && lost < 2.0 * 0.01 * PI * 0.015 * 0.015);
}

#[test]
fn ends_taper_only_beyond_their_ferrules_and_then_take_force() {
    let muscle = Muscle::draw(&mut Dice::new(5, 5));
    let ferrule_m = 2.0 * muscle.cylinder_radius_m(0.9 * muscle.rest_length_m);
    let rest_m = muscle.rest_length_m;
    let mut ends = Ferrules { muscle, cone_m: 8e-3, ferrule_m, edge_m: 1e-4 };
    let mut at = |contraction: f64| {
        ends.added_n(&Moment { length_m: rest_m * (1.0 - contraction), pressure_pa: 3e5, ..Moment::default() })
    };
    assert!(at(0.02).abs() < 1e-3, "{}", at(0.02));
    assert!(at(0.18) < -2.0 && at(0.18) > -100.0, "{}", at(0.18));
}

#[test]
fn the_factor_of_the_ends_takes_force_that_grows_with_contraction() {
    let mut ends = Factor { at_vent: 0.2, always: 1.0, scale_pa: 1e5, lead_m2: 4e-3 };
    let mut at = |contraction| ends.added_n(&Moment { contraction, pressure_pa: 2e5, ..Moment::default() });
    assert_eq!(at(0.0), 0.0);
    assert!(at(0.1) < 0.0 && at(0.2) < at(0.1));
}

#[test]
fn strands_resist_only_beyond_their_limit() {
    for jam_pa in [None, Some(3e5)] {
        let mut lock = LockUp { from: 0.2, to: 0.25, size_n: 20.0, jam_pa };
        let mut at = |contraction| lock.added_n(&Moment { contraction, pressure_pa: 3e5, ..Moment::default() });
        assert_eq!(at(0.15), 0.0);
        assert!((at(0.25) + 20.0).abs() < 1e-6, "{jam_pa:?}: {}", at(0.25));
    }
}

#[test]
fn a_slack_cable_never_pushes_and_a_taut_one_is_straight() {
    let mut slack = Slack { width_n: 1.0, hanging: Some((2e-3, 4.0)), lacking_m: 0.0 };
    assert!((0.0..0.05).contains(&slack.limited_n(&Moment::default(), -40.0)));
    assert!((slack.limited_n(&Moment::default(), 200.0) - 200.0).abs() < 0.01);
    let mut at = |force_n| {
        let now = Moment { force_n, dt_s: 0.01, ..Moment::default() };
        (0..100).map(|_| slack.length(&now, 0.2)).last().unwrap_or(0.0)
    };
    assert!((at(0.0) - 0.198).abs() < 1e-9);
    assert!((at(4.0) - 0.199).abs() < 1e-9);
    assert!(at(100.0) > 0.19999);
}
