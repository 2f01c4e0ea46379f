//! The bench as its users see it: protocols, recordings, files.

use std::f64::consts::PI;

use pam_muscle::Muscle;
use pam_virtual_bench::bench::BenchError;
use pam_virtual_bench::parameters::{NYLON_MODULUS_PA, Parameters};
use pam_virtual_bench::protocol::{ALL, ProtocolError};
use pam_virtual_bench::sensors::Clock;
use pam_virtual_bench::{Bench, BenchRecording, Options, TrueMuscle, command};

/// Short enough for a test, long enough for every part of a protocol.
const SHORT: Options = Options { seed: 3, duration_scale: 0.05, highest_pressure_pa: 500e3, lowest_tension_n: 5.0 };

/// Strands as thick as a quarter of the wall.
fn muscle(rest_length_m: f64, rest_radius_m: f64, braid_angle_deg: f64, wall_thickness_m: f64) -> TrueMuscle {
    let muscle = Muscle {
        rest_length_m,
        rest_radius_m,
        braid_angle_rad: braid_angle_deg.to_radians(),
        wall_thickness_m,
        strand_count: 200.0,
        strand_diameter_m: 0.25 * wall_thickness_m,
    };
    TrueMuscle::new(muscle, NYLON_MODULUS_PA, Parameters::nominal())
}

/// Long and short, thick and thin, flat and steep braids.
fn muscles() -> [TrueMuscle; 5] {
    [
        TrueMuscle::nominal(),
        muscle(0.281, 0.0065, 28.0, 0.0015),
        muscle(1.2, 0.020, 22.0, 0.004),
        muscle(0.060, 0.004, 30.0, 0.0006),
        muscle(0.300, 0.010, 40.0, 0.001),
    ]
}

fn bench(name: &str, options: &Options) -> Bench {
    let muscle = TrueMuscle::nominal();
    let command = command(name, &muscle, options).expect("a protocol for the nominal muscle");
    Bench::new(muscle, command)
}

fn csv(recording: &BenchRecording) -> Vec<u8> {
    let mut bytes = Vec::new();
    recording.write_csv(&mut bytes).expect("a vector takes all bytes");
    bytes
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0.0), |(sum, n), value| (sum + value * value, n + 1.0));
    f64::sqrt(sum / n)
}

#[test]
fn every_protocol_keeps_every_muscle_taut_and_within_reach() {
    for muscle in muscles() {
        for protocol in ALL {
            let command = protocol.command(&muscle, &SHORT).unwrap();
            let bench = Bench::new(muscle.clone(), command);
            let place = format!("{}, {:?}", protocol.name, muscle.muscle());
            let recording = bench.record(1);
            let lowest_n = recording.true_force_n.iter().copied().fold(f64::INFINITY, f64::min);
            // `null` is vented: only the constant force is left. The interpolated floor of `multisine` and
            // the pull of the held load of `lift` and `isotonic` come close to the limit of 5 N.
            let limit_n = if ["null", "lift", "isotonic"].contains(&protocol.name) { 0.0 } else { 4.5 };
            assert!(lowest_n > limit_n, "{place}: {lowest_n} N");
            let (shortest_m, longest_m) = bench.command().length_range_m();
            let highest_contraction = muscle.muscle().contraction_ratio(shortest_m);
            assert!(highest_contraction <= 0.8 * muscle.muscle().max_contraction_ratio() + 1e-9, "{place}");
            assert!(longest_m < muscle.muscle().strand_length_m(), "{place}");
            let (lowest_pa, highest_pa) = bench.command().pressure_range_pa();
            assert!(lowest_pa >= 0.0 && highest_pa <= 500e3 + 1e-6, "{place}: {lowest_pa} {highest_pa}");
            assert!(recording.n_samples() > 10, "{place}");
            let largest_error_n = recording
                .force_n
                .iter()
                .zip(&recording.true_force_n)
                .map(|(measured, truth)| (measured - truth).abs())
                .fold(0.0, f64::max);
            // Six standard deviations of the noise and half a step: the load cell never saturates.
            assert!(largest_error_n < 6.0 * 0.2 + bench.sensors().force_n.step(), "{place}: {largest_error_n} N");
        }
    }
}

#[test]
fn equal_seeds_give_equal_bytes_and_other_seeds_other_noise() {
    let bench = bench("minor-loops", &SHORT);
    assert_eq!(csv(&bench.record(5)), csv(&bench.record(5)));
    let (a, b) = (bench.record(5), bench.record(6));
    assert_ne!(a.force_n, b.force_n);
    assert_eq!(a.true_force_n, b.true_force_n);
}

#[test]
fn noise_has_the_stated_rms_on_every_channel() {
    let recording = bench("multisine", &Options { duration_scale: 0.5, ..SHORT }).record(2);
    let error = |measured: &[f64], truth: &[f64]| rms(measured.iter().zip(truth).map(|(m, t)| m - t));
    // 24 000 rows: 0.5 % standard error; quantization adds 0.1 to 0.5 %.
    for (stated, found) in [
        (0.5e3, error(&recording.pressure_pa, &recording.true_pressure_pa)),
        (30e-6, error(&recording.length_m, &recording.true_length_m)),
        (0.2, error(&recording.force_n, &recording.true_force_n)),
    ] {
        assert!((found / stated - 1.0).abs() < 0.02, "{found} instead of {stated}");
    }
}

#[test]
fn without_noise_only_quantization_is_left() {
    let bench = bench("lift", &SHORT);
    let sensors = bench.sensors().clone().with_noise_times(0.0);
    let step_n = sensors.force_n.step();
    let recording = bench.with_sensors(sensors).unwrap().record(1);
    for (measured_n, true_n) in recording.force_n.iter().zip(&recording.true_force_n) {
        // Half a step of the converter and half a unit of the last decimal.
        assert!((measured_n - true_n).abs() <= 0.5 * step_n + 0.005 + 1e-12);
    }
}

#[test]
fn halving_the_step_changes_nothing_but_rows_next_to_a_reversal() {
    for protocol in ALL {
        let bench = bench(protocol.name, &SHORT);
        let (coarse, fine) = (bench.record(1), bench.clone().with_oversampling(20).record(1));
        let step_n = bench.sensors().force_n.step();
        let mut away = 0;
        for index in 1..coarse.n_samples() - 1 {
            let around = &fine.true_direction[index - 1..=index + 1];
            if around.iter().any(|direction| *direction != coarse.true_direction[index]) {
                continue;
            }
            away += 1;
            let change_n = (coarse.true_force_n[index] - fine.true_force_n[index]).abs();
            assert!(change_n < step_n, "{}, row {index}: {change_n} N", protocol.name);
        }
        assert!(away * 10 > coarse.n_samples() * 9, "{}: {away} of {}", protocol.name, coarse.n_samples());
    }
}

#[test]
fn an_isobaric_loop_is_as_wide_as_twice_the_friction() {
    let muscle = TrueMuscle::nominal();
    let recording = bench("isobaric-triangles", &Options { duration_scale: 0.4, ..SHORT }).record(1);
    let near = |direction: f64| {
        let rows = (0..recording.n_samples()).filter(|index| {
            recording.true_direction[*index] == direction
                && recording.true_pressure_pa[*index] == 300e3
                && (recording.true_length_m[*index] - 0.24).abs() < 3e-5
        });
        let forces: Vec<f64> = rows.map(|index| recording.true_force_n[index]).collect();
        forces.iter().sum::<f64>() / forces.len() as f64
    };
    let width_n = near(-1.0) - near(1.0);
    let twice_n = 2.0 * muscle.friction_n(300e3, 0.24);
    // Rows within 30 µm: 8 N/mm of stiffness leave 0.25 N.
    assert!((width_n - twice_n).abs() < 0.25, "{width_n} {twice_n}");
}

#[test]
fn an_isometric_ramp_pulls_less_on_the_way_up() {
    let recording = bench("isometric-ramps", &SHORT).record(1);
    for index in 1..recording.n_samples() {
        let rise_pa = recording.true_pressure_pa[index] - recording.true_pressure_pa[index - 1];
        let stands = recording.true_length_m[index] == recording.true_length_m[index - 1];
        // Across a reversal between two rows either direction may be right.
        let monotone = index > 1
            && index + 1 < recording.n_samples()
            && rise_pa * (recording.true_pressure_pa[index + 1] - recording.true_pressure_pa[index]) > 0.0
            && rise_pa * (recording.true_pressure_pa[index - 1] - recording.true_pressure_pa[index - 2]) > 0.0;
        if stands && monotone {
            assert_eq!(recording.true_direction[index], rise_pa.signum(), "row {index}");
        }
    }
}

#[test]
fn an_isotonic_muscle_carries_its_load_while_it_moves() {
    let muscle = TrueMuscle::nominal();
    let recording = bench("isotonic", &Options { duration_scale: 0.2, ..SHORT }).record(1);
    let mut moving = 0;
    for index in 1..recording.n_samples() {
        if (recording.true_length_m[index] - recording.true_length_m[index - 1]).abs() > 1e-7 {
            moving += 1;
            let nearest_n = [20.0, 60.0, 120.0, 250.0_f64]
                .into_iter()
                .map(|load_n| (recording.true_force_n[index] - load_n).abs())
                .fold(f64::INFINITY, f64::min);
            // A row next to a reversal may be off by the friction; the rig goes straight between knots, the
            // balance does not.
            let friction_n = muscle.friction_n(recording.true_pressure_pa[index], recording.true_length_m[index]);
            let reversed = recording.true_direction[index] != recording.true_direction[index - 1];
            assert!(nearest_n < if reversed { 2.0 * friction_n } else { 0.5 }, "row {index}: {nearest_n} N");
        }
    }
    assert!(moving > 1000);
}

#[test]
fn no_two_takes_share_a_second_and_time_never_runs_back() {
    let bench = bench("isometric-ramps", &SHORT);
    let recording = bench.record(1);
    assert!(recording.time_s.windows(2).all(|pair| pair[1] > pair[0]));
    let gaps = recording.time_s.windows(2).filter(|pair| pair[1] - pair[0] > 1.0).count();
    assert_eq!(gaps, bench.command().takes.len() - 1);
}

#[test]
fn a_longer_scale_gives_a_longer_recording_of_the_same_protocol() {
    let muscle = TrueMuscle::nominal();
    for protocol in ALL {
        let logged_s = |duration_scale| {
            protocol.command(&muscle, &Options { duration_scale, ..Options::default() }).unwrap().logged_s()
        };
        let (tenth_s, half_s, full_s) = (logged_s(0.1), logged_s(0.5), logged_s(1.0));
        assert!(tenth_s < half_s && half_s < full_s, "{}: {tenth_s} {half_s} {full_s}", protocol.name);
    }
}

#[test]
fn phases_of_the_multisine_come_from_its_seed() {
    let muscle = TrueMuscle::nominal();
    let takes = |seed| command("multisine", &muscle, &Options { seed, ..SHORT }).unwrap().takes;
    assert_eq!(takes(1), takes(1));
    assert_ne!(takes(1), takes(2));
}

#[test]
fn a_muscle_may_hang_slack_where_that_is_asked_for() {
    let options = Options { lowest_tension_n: f64::NEG_INFINITY, ..SHORT };
    let recording = bench("isometric-ramps", &options).record(1);
    assert!(recording.true_force_n.iter().any(|force_n| *force_n < -50.0));
    assert!(recording.true_pressure_pa.contains(&0.0));
}

#[test]
fn golden_first_rows_of_a_log() {
    let recording = bench("lift", &SHORT).record(1);
    let text = String::from_utf8(csv(&recording)).unwrap();
    let head: Vec<&str> = text.lines().take(3).collect();
    assert_eq!(
        head,
        ["time_s,pressure_kPa,length_mm,force_N", "0.000,23.67,266.949,56.47", "0.005,24.20,266.972,55.80"]
    );
}

#[test]
fn a_millisecond_clock_changes_the_stamps_and_nothing_else() {
    let ideal = bench("lift", &SHORT).at_rate(2000.0).unwrap();
    let mut sensors = ideal.sensors().clone();
    sensors.clock = Clock::Milliseconds;
    let coarse = ideal.clone().with_sensors(sensors).unwrap().record(1);
    let ideal = ideal.record(1);
    assert_eq!(coarse.force_n, ideal.force_n);
    assert!(coarse.time_s.windows(2).any(|pair| pair[0] == pair[1]));
    assert!(coarse.time_s.iter().zip(&ideal.time_s).all(|(cut, time)| (0.0..0.001).contains(&(time - cut))));
}

#[test]
fn what_cannot_be_run_is_refused_by_name() {
    let muscle = TrueMuscle::nominal();
    let unknown = command("isobaric", &muscle, &SHORT);
    assert_eq!(unknown, Err(ProtocolError::Unknown { name: "isobaric".to_owned() }));
    let slack = command("isometric-ramps", &muscle, &Options { lowest_tension_n: 5e3, ..SHORT });
    assert!(matches!(slack, Err(ProtocolError::Slack { protocol: "isometric-ramps", .. })));
    let soft = Parameters { strand_modulus_pa: 1e8, ..Parameters::nominal() };
    let soft = TrueMuscle::new(muscle.muscle().clone(), NYLON_MODULUS_PA, soft);
    assert!(matches!(command("lift", &soft, &SHORT), Err(ProtocolError::SoftBraid { .. })));
    let scale = command("lift", &muscle, &Options { duration_scale: -1.0, ..SHORT });
    assert_eq!(scale, Err(ProtocolError::DurationScale { value: -1.0 }));
    let bench = bench("lift", &SHORT);
    assert_eq!(bench.clone().at_rate(0.0), Err(BenchError::Rate { value_hz: 0.0 }));
    let noisy = bench.sensors().clone().with_noise_times(-1.0);
    assert_eq!(bench.with_sensors(noisy), Err(BenchError::Noise { channel: "pressure", value: -0.5 }));
}

#[test]
fn the_force_jumps_by_twice_the_friction_between_two_rows_at_a_reversal() {
    let muscle = TrueMuscle::nominal();
    let recording = bench("rate-ladder", &Options { duration_scale: 0.02, ..SHORT }).record(1);
    let jumps: Vec<usize> = (1..recording.n_samples())
        .filter(|index| recording.true_direction[*index] != recording.true_direction[*index - 1])
        .collect();
    assert!(jumps.len() > 20, "{}", jumps.len());
    let index = jumps[0];
    let (pressure_pa, length_m) = (recording.true_pressure_pa[index], recording.true_length_m[index]);
    let expected_n = 2.0 * 1.2e-3 * pressure_pa * PI * muscle.muscle().diameter_m(length_m) * length_m;
    let jump_n = recording.true_force_n[index] - recording.true_force_n[index - 1];
    assert!((jump_n - expected_n).abs() < 0.3 * expected_n, "{jump_n} {expected_n}");
}
