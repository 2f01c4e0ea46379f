use super::*;

fn states_of(
    time_s: &[f64],
    pressure_pa: &[f64],
    length_m: &[f64],
    thresholds: Thresholds,
    driver: Driver,
    carried: Bounds,
) -> Vec<State> {
    let stretch = Stretch::of(time_s, pressure_pa, length_m, thresholds, driver);
    let states = stretch.states(thresholds.standstill, carried);
    let path = stretch.path(&states);
    stretch.turned(&states, path.as_deref(), thresholds, carried)
}
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};

const THRESHOLDS: Thresholds =
    Thresholds { length_m: 150e-6, pressure_pa: 2e3, held_m: 0.0, turn_m: 0.0, standstill: Standstill::AT_ONCE };

/// ±1, ±2 where unsettled, 0 where unknown.
fn marks_under(standstill: Standstill, pressure_pa: &[f64], length_m: &[f64]) -> Vec<i8> {
    let n = length_m.len();
    let thresholds = Thresholds { standstill, ..THRESHOLDS };
    states_of(&times(n), pressure_pa, length_m, thresholds, Driver::Motion, Bounds::UNKNOWN)
        .into_iter()
        .map(|state| state.bounds.sign() * if state.is_settled { 1 } else { 2 })
        .collect()
}

fn marks(pressure_pa: &[f64], length_m: &[f64]) -> Vec<i8> {
    marks_under(Standstill::AT_ONCE, pressure_pa, length_m)
}

fn noise(n: usize, sigma: f64, seed: u64) -> Vec<f64> {
    let normal = Normal::new(0.0, sigma).unwrap();
    let mut generator = rand_pcg::Pcg64::seed_from_u64(seed);
    (0..n).map(|_| normal.sample(&mut generator)).collect()
}

fn times(n: usize) -> Vec<f64> {
    (0..n).map(|index| index as f64 * 0.005).collect()
}

#[test]
fn a_hold_before_a_return_belongs_to_the_way_there() {
    let n = 6000;
    let mut length: Vec<f64> = (0..n)
        .map(|i| match i {
            0..1000 => 0.267 - f64::from(i) * 25e-6,
            1000..4000 => 0.242,
            _ => 0.242 + f64::from(i - 4000) * 10e-6,
        })
        .collect();
    let n = n as usize;
    for (value, noise) in length.iter_mut().zip(noise(n, 30e-6, 4)) {
        *value += noise;
    }
    let marks = marks(&vec![3e5; n], &length);
    assert!(marks[..3930].iter().all(|&mark| mark == 1));
    assert!(marks[4030..].iter().all(|&mark| mark == -1));
}

#[test]
fn a_slow_sine_is_right_wherever_it_is_settled() {
    let n = 8000;
    let omega = 2.0 * std::f64::consts::PI * 0.05 * 0.005;
    let noise = noise(n, 30e-6, 6);
    let length: Vec<f64> = (0..n).map(|i| 0.24 + 0.01 * (omega * i as f64).cos() + noise[i]).collect();
    let marks = marks(&vec![3e5; n], &length);
    for (index, mark) in marks.iter().enumerate() {
        let expected = if (omega * index as f64).sin() > 0.0 { 1 } else { -1 };
        assert!(index < 100 || *mark == expected || mark.abs() == 2, "row {index}: {mark}");
    }
}

/// A triangle of 40 mm at 5 mm/s, 200 Hz, with 30 µm of noise: 8 s each way.
#[test]
fn a_noisy_triangle_flips_once_per_turn() {
    let n = 6400;
    let truth: Vec<f64> = (0..n)
        .map(|i| {
            let phase = i % 3200;
            0.267 - if phase < 1600 { phase as f64 } else { (3200 - phase) as f64 } * 25e-6
        })
        .collect();
    let noise = noise(n, 30e-6, 1);
    let length: Vec<f64> = truth.iter().zip(&noise).map(|(l, e)| l + e).collect();
    let marks = marks(&vec![3e5; n], &length);
    let flips = marks.windows(2).filter(|pair| pair[0].signum() != pair[1].signum()).count();
    assert_eq!(flips, 3);
    // Settled marks are never wrong, and only a few are unsettled.
    for (index, mark) in marks.iter().enumerate() {
        let expected = if index % 3200 < 1600 { 1 } else { -1 };
        assert!(*mark == expected || mark.abs() == 2, "row {index}: {mark}");
    }
    let unsettled = marks.iter().filter(|mark| mark.abs() == 2).count();
    // Three turns of 0.1 s at 5 mm/s.
    assert!((10..100).contains(&unsettled), "{unsettled}");
}

#[test]
fn a_small_swing_leaves_what_came_before_it_settled() {
    let n = 3000;
    // 20 mm one way, then swings of 0.2 mm, barely above the threshold.
    let length: Vec<f64> = (0..n)
        .map(|i| if i < 2000 { 0.267 - f64::from(i) * 10e-6 } else { 0.247 + 1e-4 * (f64::from(i) * 0.05).sin() })
        .collect();
    let n = n as usize;
    let marks = marks(&vec![3e5; n], &length);
    assert!(marks[..1980].iter().all(|&mark| mark == 1));
}

#[test]
fn noise_on_a_long_hold_never_flips_the_direction() {
    let n = 200_000;
    let mut length: Vec<f64> = (0..1000).map(|i| 0.267 - i as f64 * 25e-6).collect();
    length.extend(vec![0.267 - 1000.0 * 25e-6; n - 1000]);
    for (value, noise) in length.iter_mut().zip(noise(n, 30e-6, 2)) {
        *value += noise;
    }
    let marks = marks(&vec![3e5; n], &length);
    assert!(marks.iter().all(|mark| mark.signum() == 1));
}

#[test]
fn pressure_takes_the_place_of_a_length_that_stands_still() {
    let n = 4000;
    let pressure: Vec<f64> = (0..n).map(|i| if i < 2000 { i as f64 } else { (4000 - i) as f64 } * 200.0).collect();
    let marks = marks(&pressure, &vec![0.25; n]);
    for (index, mark) in marks.iter().enumerate().skip(40) {
        let expected = if index < 2000 { 1 } else { -1 };
        assert!(*mark == expected || index.abs_diff(2000) < 30, "row {index}: {mark}");
    }
}

#[test]
fn a_hold_at_constant_pressure_keeps_the_last_direction() {
    let n = 3000;
    let length: Vec<f64> = (0..n).map(|i| 0.26 - (i.min(1000)) as f64 * 20e-6).collect();
    let marks = marks(&vec![2e5; n], &length);
    assert!(marks.iter().all(|&mark| mark == 1));
}

#[test]
fn a_recording_that_never_moves_has_no_direction() {
    let marks = marks(&vec![2e5; 500], &vec![0.25; 500]);
    assert!(marks.iter().all(|&mark| mark == 0));
}

/// Contracting for 5 s, then held for 15 s while the pressure falls and rises again.
fn held_length() -> (Vec<f64>, Vec<f64>) {
    let length = (0..4000).map(|i| 0.26 - f64::from(i.min(1000)) * 20e-6).collect();
    let pressure = (0..4000)
        .map(|i| match i {
            0..1500 => 3e5,
            1500..2500 => 3e5 - f64::from(i - 1500) * 200.0,
            _ => 1e5 + f64::from(i - 2500) * 100.0,
        })
        .collect();
    (pressure, length)
}

#[test]
fn friction_that_is_held_keeps_its_sign_whatever_the_pressure_does() {
    let (pressure, length) = held_length();
    let marks = marks_under(Standstill::Held, &pressure, &length);
    assert!(marks[100..].iter().all(|&mark| mark == 1));
}

#[test]
fn friction_that_sticks_is_the_same_force_at_every_pressure() {
    let (pressure, length) = held_length();
    let states_at = |pressure: &[f64], carried: Bounds| {
        let thresholds = Thresholds { standstill: Standstill::Sticks, ..THRESHOLDS };
        states_of(&times(4000), pressure, &length, thresholds, Driver::Motion, carried)
    };
    let states = states_at(&pressure, Bounds::UNKNOWN);
    for row in [1400, 1600, 2000, 2500, 3000, 3900] {
        let force = states[row].bounds.middle() * pressure[row];
        assert!((force - 3e5).abs() < 0.02 * 3e5, "row {row}: {force}");
    }
    // Vented altogether, no more is left than so many times what a motion gives.
    let vented: Vec<f64> = pressure.iter().map(|pressure_pa| (pressure_pa - 1e5).max(0.0)).collect();
    let most = states_at(&vented, Bounds::UNKNOWN).iter().map(|state| state.bounds.middle()).fold(0.0, f64::max);
    assert!((most - STICKS_UP_TO).abs() < 1e-9, "{most}");
}

#[test]
fn friction_that_relaxes_forgets_a_share_of_itself_whatever_the_pressure_does_until_the_length_moves() {
    let (pressure, length) = held_length();
    let relaxes = Standstill::Relaxes { time_constant_s: 3.0, to: 0.4 };
    let states_at = |pressure: &[f64], length: &[f64]| {
        let thresholds = Thresholds { standstill: relaxes, ..THRESHOLDS };
        states_of(&times(length.len()), pressure, length, thresholds, Driver::Motion, Bounds::UNKNOWN)
    };
    let still = vec![3e5; pressure.len()];
    for pressure in [&pressure, &still] {
        let states = states_at(pressure, &length);
        // The length rests from the 1000th row on, at 200 Hz.
        for row in [1100, 1300, 1600, 2500, 3900] {
            let expected = 0.4 + 0.6 * (-(0.005 * (row as f64 - 1000.0)) / 3.0).exp();
            let at = states[row].bounds.middle();
            assert!((at - expected).abs() < 0.02, "row {row}: {at} where {expected} is left");
        }
    }
    // On again the same way: all of it.
    let on: Vec<f64> = length.iter().copied().chain((1..200).map(|row| length[3999] - 5e-5 * f64::from(row))).collect();
    let states = states_at(&vec![3e5; on.len()], &on);
    let at = [3990, 4150].map(|row: usize| states[row].bounds.middle());
    assert!(at[0] < 0.42 && at[1] > 0.99, "{at:?}");
}

#[test]
fn friction_that_slides_turns_over_with_so_much_pressure() {
    let (pressure, length) = held_length();
    let thresholds = Thresholds { standstill: Standstill::Slides { over_pa: 4e4, share: 1.0 }, ..THRESHOLDS };
    let states = states_of(&times(4000), &pressure, &length, thresholds, Driver::Motion, Bounds::UNKNOWN);
    let at = |row: usize| states[row].bounds.middle();
    // 40 kPa take 200 rows down and 400 up.
    for (row, expected) in [(1400, 1.0), (1600, 0.0), (1710, -1.0), (2500, -1.0), (2700, 0.0), (2910, 1.0)] {
        assert!((at(row) - expected).abs() < 0.03, "row {row}: {}", at(row));
    }
}

#[test]
fn of_friction_that_slides_partly_the_rest_stays_until_the_pressure_has_turned_it() {
    let (pressure, length) = held_length();
    let standstill = Standstill::Slides { over_pa: 4e4, share: 0.4 };
    let thresholds = Thresholds { standstill, ..THRESHOLDS };
    let states = states_of(&times(4000), &pressure, &length, thresholds, Driver::Motion, Bounds::UNKNOWN);
    let at = |row: usize| states[row].bounds.middle();
    // A motion has brought about all of it, the pressure no more than its share either way.
    for (row, expected) in [(1400, 1.0), (1600, 0.0), (1710, -0.4), (2500, -0.4), (2600, 0.1), (2910, 0.4)] {
        assert!((at(row) - expected).abs() < 0.03, "row {row}: {}", at(row));
    }
}

#[test]
fn a_beginning_at_rest_is_unknown_until_something_moves_far_enough() {
    let (pressure, length) = (held_length().0[1000..].to_vec(), vec![0.24; 3000]);
    assert!(marks_under(Standstill::Held, &pressure, &length).iter().all(|&mark| mark == 0));
    let marks = marks_under(Standstill::Slides { over_pa: 4e4, share: 1.0 }, &pressure, &length);
    assert!(marks[..600].iter().all(|&mark| mark == 0));
    assert!(marks[720..1500].iter().all(|&mark| mark == -1));
    assert!(marks[1950..].iter().all(|&mark| mark == 1));
}

#[test]
fn a_sine_turns_at_its_vertex_and_a_triangle_at_its_corner() {
    let (n, period) = (4000, 400.0);
    let noise = noise(n, 20e-6, 8);
    let sine = |at: usize| 0.005 * (2.0 * std::f64::consts::PI * at as f64 / period).cos();
    let triangle = |at: usize| 0.005 * ((at as f64 / period + 0.25).rem_euclid(1.0) * 4.0 - 2.0).abs();
    for (path, shift) in [(&sine as &dyn Fn(usize) -> f64, 0.0), (&triangle, 0.25)] {
        let length: Vec<f64> = (0..n).map(|at| 0.24 + path(at) + noise[at]).collect();
        let marks = marks(&vec![3e5; n], &length);
        for (row, pair) in marks.windows(2).enumerate().skip(100) {
            if pair[0].signum() != pair[1].signum() {
                let turns = 2.0 * ((row + 1) as f64 / period + shift);
                // Half of what the play alone is late by.
                assert!((turns - turns.round()).abs() * period / 2.0 < 9.0, "row {row}: {turns}");
            }
        }
    }
}

#[test]
fn friction_turns_over_within_its_travel() {
    let n = 4000;
    let length: Vec<f64> = (0..n).map(|at| 0.24 + 1e-5 * (at as f64 - 2000.0).abs()).collect();
    let thresholds = Thresholds { length_m: 5e-5, turn_m: 1e-3, standstill: Standstill::Held, ..THRESHOLDS };
    let states = states_of(&times(n), &vec![3e5; n], &length, thresholds, Driver::Motion, Bounds::UNKNOWN);
    let state = |row: usize| states[row].bounds.middle();
    assert!((state(1900) - 1.0).abs() < 1e-9);
    // The average rounds the corner by some tenths of the travel.
    assert!(state(2050).abs() < 0.1, "{}", state(2050));
    assert!((state(2110) + 1.0).abs() < 1e-9, "{}", state(2110));
}

#[test]
fn friction_keeps_its_sign_over_a_play_and_a_late_mark_does_not_matter() {
    let (n, noise) = (4000, noise(4000, 20e-6, 11));
    let length: Vec<f64> = (0..n).map(|at| 0.24 + 0.005 * (at as f64 / 300.0).cos() + noise[at]).collect();
    let thresholds = Thresholds { length_m: 1e-4, held_m: 3e-5, standstill: Standstill::Held, ..THRESHOLDS };
    let states = states_of(&times(n), &vec![3e5; n], &length, thresholds, Driver::Motion, Bounds::UNKNOWN);
    for turn in 1..4 {
        let turn_row = (std::f64::consts::PI * f64::from(turn) * 300.0) as usize;
        // 30 µm from the turn are 33 rows after it.
        let flip = (turn_row - 60..turn_row + 120)
            .find(|&row| states[row].bounds.middle() * states[turn_row - 100].bounds.middle() < 0.0);
        assert!(flip.is_some_and(|row| row.abs_diff(turn_row + 33) < 15), "{turn_row} {flip:?}");
    }
}

/// A muscle that comes to rest after 2 s, and the pressure with it; it rests until 4 s and goes on the same way.
fn settling(n: usize) -> (Vec<f64>, Vec<f64>) {
    let noise = noise(n, 8e-6, 5);
    let done = |at: usize| {
        let t = (at as f64 / 400.0).min(1.0);
        t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
    };
    let length = (0..n).map(|at| 0.25 + 2e-3 * done(at) + 1e-5 * at.saturating_sub(800) as f64 + noise[at]).collect();
    let pressure = (0..n).map(|at| 1e5 + 2e5 * done(at)).collect();
    (pressure, length)
}

#[test]
fn a_pressure_that_settles_with_the_length_turns_no_friction() {
    // Extending under rising pressure: were the end of it a push at rest, friction would turn.
    let (pressure, length) = settling(1200);
    let thresholds = Thresholds { length_m: 4e-5, pressure_pa: 700.0, ..THRESHOLDS };
    let states = states_of(&times(1200), &pressure, &length, thresholds, Driver::Motion, Bounds::UNKNOWN);
    assert!(states[100..].iter().all(|state| state.bounds.sign() == -1));
}

#[test]
fn a_pressure_that_moves_in_half_a_second_of_rest_turns_friction() {
    let n = 600;
    let noise = noise(n, 8e-6, 7);
    let length: Vec<f64> =
        (0..n).map(|at| 0.25 + 2e-5 * at.min(200) as f64 + 2e-5 * at.saturating_sub(320) as f64 + noise[at]).collect();
    let pressure: Vec<f64> = (0..n).map(|at| 1e5 + 1e3 * at.saturating_sub(230).min(60) as f64).collect();
    let thresholds = Thresholds { length_m: 4e-5, pressure_pa: 700.0, ..THRESHOLDS };
    let states = states_of(&times(n), &pressure, &length, thresholds, Driver::Motion, Bounds::UNKNOWN);
    let sign = |row: usize| states[row].bounds.sign();
    assert_eq!([sign(150), sign(225), sign(260), sign(300), sign(360)], [-1, -1, 1, 1, -1]);
}
