use super::*;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};

fn noisy_ramp(sigma: f64) -> Vec<f64> {
    let normal = Normal::new(0.0, sigma).unwrap();
    let mut generator = rand_pcg::Pcg64::seed_from_u64(5);
    (0..20_000).map(|i| 0.01 * f64::from(i) + normal.sample(&mut generator)).collect()
}

#[test]
fn noise_on_a_ramp_with_jumps_is_found() {
    let mut values = noisy_ramp(0.2);
    for (index, value) in values.iter_mut().enumerate() {
        *value += (index / 1000) as f64 * 7.0;
    }
    assert!((noise_std(&values) - 0.2).abs() < 0.005, "{}", noise_std(&values));
}

#[test]
fn a_quantized_channel_shows_its_step_and_a_fine_one_shows_none() {
    let coarse: Vec<f64> = noisy_ramp(0.9).iter().map(|v| (v / 0.683).round() * 0.683).collect();
    let printed: Vec<f64> = coarse.iter().map(|v| (v * 1e4).round() * 1e-4).collect();
    assert!((quantization_step(&printed).unwrap() - 0.683).abs() < 1e-3);
    assert_eq!(quantization_step(&noisy_ramp(0.9)), None);
    assert_eq!(quantization_step(&[3.0; 100]), None);
}

#[test]
fn a_motion_that_a_slow_clock_hardly_follows_is_no_noise() {
    let mut generator = rand_pcg::Pcg64::seed_from_u64(3);
    let normal = Normal::new(0.0, 2e-5).unwrap();
    // 25 Hz: 3 s at rest, 3 s of 10 mm at 1 Hz, and so on.
    let values: Vec<f64> = (0..1500_i32)
        .map(|at| {
            let moves = if at / 75 % 2 == 1 { 0.01 * (0.25 * f64::from(at)).sin() } else { 0.0 };
            moves + normal.sample(&mut generator)
        })
        .collect();
    let found = noise_std(&values);
    // Half of the windows move: the quietest fifth of all is the middle of the others, a third above theirs.
    assert!((1.8e-5..2.8e-5).contains(&found), "{found}");
}

#[test]
fn colored_noise_is_found_on_a_moving_channel_and_white_noise_as_what_it_is() {
    let period_s = 0.005;
    let white = noisy_ramp(0.2);
    let found = colored_noise_std(&white, period_s).unwrap();
    assert!((found - 0.2).abs() < 0.01, "{found}");
    // Neighbors share most of it over a twentieth of a second: second differences see less than half of it.
    let mut state = 0.0;
    let colored: Vec<f64> = white
        .iter()
        .enumerate()
        .map(|(at, value)| {
            state = 0.9 * state + (value - 0.01 * at as f64);
            0.01 * at as f64 + state
        })
        .collect();
    let whole = 0.2 / (1.0_f64 - 0.81).sqrt();
    let found = colored_noise_std(&colored, period_s).unwrap();
    let inferred = whole_noise_std(noise_std(&colored), found, period_s);
    assert!((0.9..1.1).contains(&(inferred / whole)), "{inferred} of {whole}");
    assert_eq!(whole_noise_std(0.2, 0.21, period_s), 0.21);
    assert!(noise_std(&colored) < 0.45 * whole && found > 0.5 * whole, "{found} of {whole}");
    assert_eq!(colored_noise_std(&white, 0.1), None);
}

#[test]
fn noise_that_neighbors_share_for_long_is_found_where_the_channel_rests() {
    let normal = Normal::new(0.0, 1.0).unwrap();
    let mut generator = rand_pcg::Pcg64::seed_from_u64(8);
    let mut state = 0.0;
    // 150 Hz; 10 s at rest and 10 s of a fast ramp in turn; a deviation of 3.2 that is shared over 130 ms.
    let values: Vec<f64> = (0..9000)
        .map(|at| {
            state = 0.95 * state + normal.sample(&mut generator);
            let moved = f64::from(at % 3000 - 1500).max(0.0) * 10.0;
            state + moved
        })
        .collect();
    let period_s = 1.0 / 150.0;
    let colored = colored_noise_std(&values, period_s).unwrap();
    let found = rest_noise_std(&values, period_s, colored).unwrap();
    // 2.9 of averages, less a quarter: the quietest windows are taken for those of independent values.
    assert!(colored < 1.2 && (2.0..3.0).contains(&found), "{colored} {found}");
    // White noise is averaged out, and what always moves says nothing.
    let white: Vec<f64> = (0..9000).map(|_| normal.sample(&mut generator)).collect();
    let found = rest_noise_std(&white, period_s, 1.0).unwrap();
    assert!((0.3..0.42).contains(&found), "{found}");
    let moving: Vec<f64> = (0..9000).map(|at| 1e3 * (0.02 * f64::from(at)).sin()).collect();
    assert_eq!(rest_noise_std(&moving, period_s, 0.1), None);
}
