//! The bench, as the proof uses it: a random muscle, logs with what is concealed, with noise and without.

use anyhow::Result;
use pam_core::muscle::Muscle;
use pam_core::recording::{Recording, Samples};
use pam_virtual_bench::{Bench, BenchRecording, Options, Parameters, Protocol, Sensors, TrueMuscle};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Dxsm;

use crate::case::{Case, Log, Noise, Place};

/// Sampling rate, in Hz.
pub const RATE_HZ: f64 = 200.0;

/// Share of colored noise that remains after one sample.
const CORRELATION: f64 = 0.98;

/// Rows further apart than this belong to different takes, in s.
const GAP_S: f64 = 0.1;

/// A muscle on the rig.
#[derive(Debug, Clone)]
pub struct Rig {
    muscle: TrueMuscle,
}

/// What acts beside the muscle.
#[derive(Debug, Clone, Copy)]
pub struct Hidden<'a> {
    /// Ids and severities.
    pub effects: &'a [(&'a str, f64)],
    /// Decides their inner parameters.
    pub seed: u64,
    /// Smooth static misfit, root mean square, in N.
    pub misfit_n: f64,
}

impl Hidden<'_> {
    /// Nothing.
    pub const NOTHING: Self = Self { effects: &[], seed: 0, misfit_n: 0.0 };
}

impl Rig {
    /// A muscle as one might build it.
    pub fn random(seed: u64) -> Self {
        let mut random = Pcg64Dxsm::seed_from_u64(seed);
        let mut between = |low: f64, high: f64| low + random.random::<f64>() * (high - low);
        let muscle = Muscle {
            rest_length_m: between(0.18, 0.32),
            rest_radius_m: between(0.007, 0.012),
            braid_angle_rad: between(22.0, 28.0_f64).to_radians(),
            wall_thickness_m: between(0.7e-3, 1.3e-3),
            strand_count: between(160.0, 280.0).round(),
            strand_diameter_m: 0.25e-3,
        };
        let parameters = Parameters {
            k1: between(0.8, 1.0),
            k2: between(1.0, 1.2),
            k3_n: between(-3.0, 4.0),
            c10_pa: between(90e3, 150e3),
            c01_pa: between(80e3, 130e3),
            rubber_friction: between(0.8e-3, 3e-3),
            ..Parameters::nominal()
        };
        let modulus_pa = parameters.strand_modulus_pa;
        Self { muscle: TrueMuscle::new(muscle, modulus_pa, parameters) }
    }

    /// The muscle.
    pub fn muscle(&self) -> &TrueMuscle {
        &self.muscle
    }

    /// Muscle file with the dimensions as they are.
    pub fn muscle_file(&self) -> String {
        let muscle = self.muscle.muscle();
        format!(
            "rest_length_mm = {}\nrest_radius_mm = {}\nbraid_angle_deg = {}\nwall_thickness_mm = {}\nstrand_count = {}\n\
             strand_diameter_mm = {}\nstrand_modulus_gpa = {}\nfit = []\n",
            1e3 * muscle.rest_length_m,
            1e3 * muscle.rest_radius_m,
            muscle.braid_angle_rad.to_degrees(),
            1e3 * muscle.wall_thickness_m,
            muscle.strand_count,
            1e3 * muscle.strand_diameter_m,
            1e-9 * self.muscle.contact_modulus_pa(),
        )
    }

    /// Samples of a protocol at a duration scale.
    ///
    /// # Errors
    /// Where the protocol cannot be made for this muscle.
    pub fn samples(&self, protocol: &str, duration_scale: f64) -> Result<f64> {
        let options = Options { duration_scale, ..Options::default() };
        Ok(Protocol::named(protocol)?.command(&self.muscle, &options)?.logged_s() * RATE_HZ)
    }

    /// Records `log`; without `noise` the sensors are perfect but for their steps.
    ///
    /// # Errors
    /// Where the bench refuses.
    pub fn record(&self, log: &Log, hidden: &Hidden<'_>, noise: Option<&Noise>) -> Result<BenchRecording> {
        let bench = self.bench(log, hidden)?;
        let sensors = sensors(bench.sensors().clone(), noise);
        Ok(bench.with_sensors(sensors)?.at_rate(RATE_HZ)?.record(log.seed))
    }

    /// Where the effects show in `log`, each in turn.
    ///
    /// # Errors
    /// Where the bench refuses.
    pub fn places(&self, _log: &Log, hidden: &Hidden<'_>) -> Result<Vec<Option<Place>>> {
        Ok(vec![None; hidden.effects.len()])
    }

    fn bench(&self, log: &Log, _hidden: &Hidden<'_>) -> Result<Bench> {
        let options = Options { seed: log.seed, duration_scale: log.duration_scale, ..Options::default() };
        let command = Protocol::named(&log.protocol)?.command(&self.muscle, &options)?;
        Ok(Bench::new(self.muscle.clone(), command))
    }
}

/// Sensors with the noise of a case.
fn sensors(sensors: Sensors, noise: Option<&Noise>) -> Sensors {
    let mut sensors = sensors.with_noise_times(noise.map_or(0.0, |noise| noise.white_factor));
    if let Some(noise) = noise.filter(|noise| noise.colored) {
        sensors.force_n.noise_rms = noise.colored_n;
        sensors.force_n.noise_correlation = CORRELATION;
    }
    sensors
}

/// Noise of the sensors as they come: pressure in Pa, length in m, force in N.
pub fn sensor_noise(rig: &Rig) -> (f64, f64, f64) {
    let sensors = Sensors::suited_to(rig.muscle(), Options::default().highest_pressure_pa);
    (1e3 * sensors.pressure_kpa.noise_rms, 1e-3 * sensors.length_mm.noise_rms, sensors.force_n.noise_rms)
}

/// The case's own rig and what is hidden in it, for `action`.
pub fn hidden_of(case: &Case) -> Vec<(&str, f64)> {
    case.concealed.iter().map(|effect| (effect.id.as_str(), effect.severity)).collect()
}

/// A log of the bench as a recording in memory.
pub fn recording(path: &str, log: &BenchRecording) -> Recording {
    let mut segments = Vec::new();
    let mut start = 0;
    for row in 1..log.n_samples() {
        if log.time_s[row] - log.time_s[row - 1] > GAP_S {
            segments.push(start..row);
            start = row;
        }
    }
    segments.push(start..log.n_samples());
    Recording {
        path: path.to_owned(),
        sha256: String::new(),
        samples: Samples::from_columns(&log.time_s, &log.pressure_pa, &log.length_m, &log.force_n),
        segments,
        repairs: Default::default(),
        ignored_columns: Vec::new(),
    }
}
