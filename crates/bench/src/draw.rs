//! How the inner parameters of a concealed effect are drawn, and kept for the truth.
//!
//! Each effect has a source of random numbers of its own, so that what one draws does not depend on which others are
//! concealed beside it. Nothing but the muscle and the seed decides, so that recordings of one muscle under different
//! protocols conceal the same.

use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;

use crate::path::Command;
use crate::reach::{REFERENCE_LENGTH_M, REFERENCE_PRESSURE_PA, Reach};
use crate::true_muscle::TrueMuscle;

/// Pressure at which the force of a muscle is compared with that of the nominal one.
const SCALE_PRESSURE_PA: f64 = 300e3;

/// One drawn number.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnParameter {
    /// Name.
    pub name: &'static str,
    /// Value, in SI.
    pub value: f64,
    /// Unit; `1` where it has none.
    pub unit: &'static str,
}

/// Where an effect shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// `time`, `pressure`, `contraction`, `speed`, `travel_since_reversal`, `time_since_last_move`, `cycle` or `force`.
    pub coordinate: &'static str,
    /// Where it begins, in SI.
    pub from: f64,
    /// Where it ends, in SI.
    pub to: f64,
    /// Unit; `1` where it has none.
    pub unit: &'static str,
}

/// Draws the parameters of one effect.
pub(crate) struct Draw<'a> {
    pub(crate) muscle: &'a TrueMuscle,
    pub(crate) command: &'a Command,
    pub(crate) severity: f64,
    pub(crate) parameters: Vec<DrawnParameter>,
    pub(crate) place: Option<Place>,
    random: Pcg64Dxsm,
}

impl<'a> Draw<'a> {
    pub(crate) fn new(id: &str, severity: f64, seed: u64, muscle: &'a TrueMuscle, command: &'a Command) -> Self {
        Self { muscle, command, severity, parameters: Vec::new(), place: None, random: source(id, seed) }
    }

    fn keep(&mut self, name: &'static str, value: f64, unit: &'static str) -> f64 {
        self.parameters.push(DrawnParameter { name, value, unit });
        value
    }

    /// Evenly between two values.
    pub(crate) fn even(&mut self, name: &'static str, low: f64, high: f64, unit: &'static str) -> f64 {
        let share: f64 = self.random.random();
        self.keep(name, low + share * (high - low), unit)
    }

    /// Between two values, evenly over their ratio.
    pub(crate) fn ratio(&mut self, name: &'static str, low: f64, high: f64, unit: &'static str) -> f64 {
        let share: f64 = self.random.random();
        self.keep(name, low * (high / low).powf(share), unit)
    }

    /// Between two values, evenly over their ratio, times the severity.
    pub(crate) fn severe(&mut self, name: &'static str, low: f64, high: f64, unit: &'static str) -> f64 {
        let share: f64 = self.random.random();
        self.keep(name, low * (high / low).powf(share) * self.severity, unit)
    }

    /// Either of two signs.
    pub(crate) fn sign(&mut self) -> f64 {
        if self.random.random::<f64>() < 0.5 { -1.0 } else { 1.0 }
    }

    /// One of the numbers below `count`.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((self.random.random::<f64>() * count as f64) as usize).min(count - 1)
    }

    /// A normal deviate, which is not kept.
    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.random)
    }

    /// Says where the effect shows.
    pub(crate) fn at(&mut self, coordinate: &'static str, from: f64, to: f64, unit: &'static str) {
        self.place = Some(Place { coordinate, from, to, unit });
    }

    /// Force of this muscle relative to that of the nominal one.
    pub(crate) fn force_scale(&self) -> f64 {
        let force_n =
            |muscle: &TrueMuscle| muscle.force_n(SCALE_PRESSURE_PA, muscle.muscle().rest_length_m, 0.0).max(1.0);
        force_n(self.muscle) / force_n(&TrueMuscle::nominal())
    }

    /// Length of this muscle relative to that of the nominal one.
    pub(crate) fn length_scale(&self) -> f64 {
        self.muscle.muscle().rest_length_m / REFERENCE_LENGTH_M
    }

    /// Largest contraction that the protocols reach.
    pub(crate) fn reached_contraction(&self) -> f64 {
        let reach = Reach::new(self.muscle, REFERENCE_PRESSURE_PA, 5.0);
        self.muscle.muscle().contraction_ratio(reach.length_m(0.21))
    }
}

/// The source of random numbers of an effect: stream number is the FNV-1a hash of its id.
pub(crate) fn source(id: &str, seed: u64) -> Pcg64Dxsm {
    let hash = id
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    let mut root = Pcg64Dxsm::seed_from_u64(seed);
    let state = u128::from(rand::Rng::next_u64(&mut root)) << 64 | u128::from(rand::Rng::next_u64(&mut root));
    // Above the numbers of the sensors' streams.
    Pcg64Dxsm::new(state, 1 << 64 | u128::from(hash))
}
