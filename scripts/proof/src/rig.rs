//! The bench, as the proof uses it: a random muscle, logs with what is concealed, with noise and without.

use anyhow::Result;
use pam_recording::{Recording, Samples};
use pam_virtual_bench::{Bench, BenchRecording, Concealed, Options, Protocol, Sensors, TrueMuscle};

use crate::case::{Case, EVENT, Log, Noise, Place};

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
    lowest_tension_n: f64,
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
    /// A muscle as one might build it, taken down to a tension.
    pub fn new(muscle_seed: u64, lowest_tension_n: f64) -> Self {
        Self { muscle: TrueMuscle::random(muscle_seed), lowest_tension_n }
    }

    /// The rig of a case.
    pub fn of(case: &Case) -> Self {
        Self::new(case.muscle_seed, case.lowest_tension_n)
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
        let options = self.options(0, duration_scale);
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
    pub fn places(&self, log: &Log, hidden: &Hidden<'_>) -> Result<Vec<Option<Place>>> {
        let place = |place: &pam_virtual_bench::draw::Place| Place {
            coordinate: place.coordinate.to_owned(),
            from: place.from,
            to: place.to,
        };
        Ok(self.bench(log, hidden)?.effects().iter().map(|effect| effect.place.as_ref().map(place)).collect())
    }

    fn options(&self, seed: u64, duration_scale: f64) -> Options {
        Options { seed, duration_scale, lowest_tension_n: self.lowest_tension_n, ..Options::default() }
    }

    fn bench(&self, log: &Log, hidden: &Hidden<'_>) -> Result<Bench> {
        let options = self.options(log.seed, log.duration_scale);
        let command = Protocol::named(&log.protocol)?.command(&self.muscle, &options)?;
        let concealed: Vec<Concealed> = hidden
            .effects
            .iter()
            .filter(|(id, _)| log.eventful || *id != EVENT)
            .map(|(id, severity)| Concealed::new(id, *severity))
            .collect();
        let bench = Bench::new(self.muscle.clone(), command).with_effects(&concealed, hidden.seed)?;
        Ok(bench.with_smooth_misfit(hidden.misfit_n)?)
    }
}

/// Sensors with the noise of a case.
fn sensors(sensors: Sensors, noise: Option<&Noise>) -> Sensors {
    let mut sensors = sensors.with_noise_times(noise.map_or(0.0, |noise| noise.white_factor));
    if let Some(noise) = noise.filter(|noise| noise.colored) {
        let force = &mut sensors.force_n;
        let total_n = force.noise_rms.hypot(noise.colored_n);
        force.colored_share = (noise.colored_n / total_n).powi(2);
        (force.noise_rms, force.noise_correlation) = (total_n, CORRELATION);
    }
    sensors
}

/// Noise of the sensors as they come: pressure in Pa, length in m, force in N.
pub fn sensor_noise(rig: &Rig) -> (f64, f64, f64) {
    let sensors = Sensors::suited_to(rig.muscle(), Options::default().highest_pressure_pa);
    (1e3 * sensors.pressure_kpa.noise_rms, 1e-3 * sensors.length_mm.noise_rms, sensors.force_n.noise_rms)
}

/// Ids and severities of what is concealed in a case.
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
