use super::*;

#[test]
fn a_sleeve_wrinkles_only_in_its_range_and_is_smooth_under_pressure() {
    let mut sleeve = Wrinkle { at: 0.1, width: 0.03, smooth_pa: 1e5, size_n: 10.0 };
    let mut at = |contraction, pressure_pa| sleeve.added_n(&Moment { contraction, pressure_pa, ..Moment::default() });
    assert!((at(0.1, 0.0) + 10.0).abs() < 1e-9);
    assert_eq!(at(0.14, 0.0), 0.0);
    assert!(at(0.1, 4e5).abs() < 0.05);
}

#[test]
fn a_bundle_jumps_once_per_cycle() {
    let mut bundle = Bundle { leaves: 0.15, returns: 0.05, share: 0.04, out: false, place: 0.0 };
    let mut at = |contraction| {
        let now = Moment { contraction, dt_s: 0.01, ..Moment::default() };
        (0..30).map(|_| bundle.gas_factor(&now)).last().unwrap_or(0.0)
    };
    assert!((at(0.1) - 1.0).abs() < 1e-6);
    assert!((at(0.2) - 0.96).abs() < 1e-6);
    assert!((at(0.1) - 0.96).abs() < 1e-6);
    assert!((at(0.02) - 1.0).abs() < 1e-6);
}

#[test]
fn a_swollen_braid_dries_again() {
    let mut moist = Moist { size_m: 1e-3, period_s: 100.0, share: 0.5, phase_s: 0.0, constant_s: 5.0, swollen: 0.0 };
    let mut at = |time_s: f64| moist.length(&Moment { time_s, dt_s: 0.1, ..Moment::default() }, 0.2);
    let mut lengths_m: Vec<f64> = (0..1000).map(|step| at(0.1 * f64::from(step))).collect();
    assert!((lengths_m[499] - 0.199).abs() < 1e-6);
    assert!((lengths_m.pop().unwrap_or(0.0) - 0.2).abs() < 1e-6);
}

#[test]
fn strokes_of_a_pump_leave_the_mean_alone_and_end_when_it_stops() {
    let mut pump = Pump { size_pa: 2000.0, hz: 3.0, on_s: 10.0, off_s: 5.0, phase: 0.0 };
    let mut at = |time_s| pump.pressure(&Moment { time_s, ..Moment::default() }, 2e5) - 2e5;
    let mean_pa = (0..3000).map(|step| at(2.0 + 0.001 * f64::from(step))).sum::<f64>() / 3000.0;
    assert!(mean_pa.abs() < 5.0, "{mean_pa}");
    assert_eq!(at(12.0), 0.0);
}

#[test]
fn a_swivel_lets_go_again_and_again() {
    let mut swivel = Swivel { holds_pa: 2e4, size_n: 5.0, last_pa: None, held_pa: 0.0, shown: 0.0 };
    let read: Vec<f64> = (0..2000)
        .map(|step| {
            swivel.cell_n(&Moment { pressure_pa: 50.0 * f64::from(step), dt_s: 1e-2, ..Moment::default() }, 0.0)
        })
        .collect();
    let falls = read.windows(2).filter(|pair| pair[1] < pair[0] - 1.0).count();
    assert!((4..=12).contains(&falls), "{falls}");
    assert!(read.iter().all(|force_n| (-0.1..=5.0).contains(force_n)));
}

#[test]
fn missed_pulses_add_up_until_the_mark() {
    let mut encoder = Missed { above_m_per_s: 5e-3, share: 0.01, mark_m: 0.24, last_m: None, error_m: 0.0 };
    let mut go = |from_m: f64, to_m: f64, speed_m_per_s: f64| {
        let steps = ((to_m - from_m).abs() / speed_m_per_s / 1e-3) as usize;
        let mut error_m = 0.0;
        for step in 0..=steps {
            let length_m = from_m + (to_m - from_m) * step as f64 / steps as f64;
            error_m = encoder.shown_length(&Moment { dt_s: 1e-3, ..Moment::default() }, length_m) - length_m;
        }
        error_m
    };
    assert!((go(0.23, 0.21, 0.02) - 2e-4).abs() < 1e-6);
    assert!((go(0.21, 0.23, 0.02) - 2e-4).abs() < 1e-6);
    assert!((go(0.23, 0.21, 0.002) - 2e-4).abs() < 1e-6);
    assert_eq!(go(0.21, 0.25, 0.02), 0.0);
}
