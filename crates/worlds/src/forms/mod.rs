//! Forms of the effects: how each is built from a severity, once the world and the plan are known.
//!
//! A severity `u` in 0…1 runs over the published range of a form's size, logarithmically; what else a form needs (time
//! constants, exponents, places) is drawn from the generator it is handed, so that equal generators differ in `u` alone.

use std::collections::BTreeMap;

use crate::draw::Dice;
use crate::friction::Element;
use crate::mechanism::Mechanism;
use crate::muscle::Muscle;
use crate::place::Place;

pub mod fixture;
pub mod friction;
pub mod geometry;
pub mod memory;
pub mod nameless;
pub mod pneumatics;
pub mod slow;

/// What a form may know about the world and the plan.
#[derive(Debug, Clone)]
pub struct Setting {
    /// The muscle as built.
    pub muscle: Muscle,
    /// Least and most contraction that the plan visits.
    pub contractions: (f64, f64),
    /// Least and most pressure that the plan visits, Pa.
    pub pressures_pa: (f64, f64),
    /// Least and most force along the estimation recordings, without the effect, N.
    pub forces_n: (f64, f64),
    /// Travel of all estimation recordings, m.
    pub travel_m: f64,
    /// Duration of every recording, s; estimation first.
    pub durations_s: Vec<f64>,
    /// How many of them are for estimation.
    pub estimation: usize,
    /// Largest pull of the bladder against contraction, N.
    pub bladder_n: f64,
    /// Recording period, s.
    pub period_s: f64,
}

impl Setting {
    /// Duration of all estimation recordings, s.
    pub fn total_s(&self) -> f64 {
        self.durations_s[..self.estimation].iter().sum()
    }

    /// A contraction within the visited range, at a share of it.
    pub fn contraction_at(&self, share: f64) -> f64 {
        self.contractions.0 + share * (self.contractions.1 - self.contractions.0)
    }
}

/// A channel of the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// Pressure.
    Pressure,
    /// Length.
    Length,
    /// Force.
    Force,
}

/// A channel that is late.
#[derive(Debug, Clone, Copy)]
pub struct Delay {
    /// Which.
    pub channel: Channel,
    /// By how much, s.
    pub delay_s: f64,
    /// How the delay varies.
    pub lateness: Lateness,
}

/// How a delay varies along a recording.
#[derive(Debug, Clone, Copy)]
pub enum Lateness {
    /// By this share of it, slowly to and fro; 0 for a constant delay.
    Wandering(f64),
    /// From half of it, by so much per second.
    Growing {
        /// Growth, s/s.
        per_s: f64,
    },
    /// Half of it, and the time since the channel was asked last.
    Polled {
        /// Period of asking, s.
        period_s: f64,
    },
}

/// A spring between the muscle and the encoder's length.
#[derive(Debug, Clone, Copy)]
pub struct Compliance {
    /// Stiffness `k`, N/m: where a spring is not linear, the one that its law says.
    pub stiffness_n_per_m: f64,
    /// Law.
    pub spring: Spring,
}

/// Law of a spring in series; each is linear where it is pushed.
#[derive(Debug, Clone, Copy)]
pub enum Spring {
    /// `x = F/k`.
    Linear,
    /// `x = (F_h/k) ln(1 + F/F_h)`, with the stiffness `k` at no force.
    Hardening {
        /// Force at which the stiffness has doubled, N.
        hardening_n: f64,
    },
    /// `x = (F_r/k) (F/F_r)^i`, with the secant `k` at `F_r`.
    Power {
        /// Exponent `i`.
        exponent: f64,
        /// Force of the secant, N.
        reference_n: f64,
    },
    /// `x = F/k` up to a preload, and beyond it with a share of the stiffness.
    Preloaded {
        /// Preload, N.
        preload_n: f64,
        /// Share of the stiffness that is left.
        softer: f64,
    },
}

impl Compliance {
    /// Extension under a force, m.
    pub fn extension_m(&self, force_n: f64) -> f64 {
        let stiffness_n_per_m = self.stiffness_n_per_m;
        match self.spring {
            Spring::Hardening { hardening_n } if force_n > 0.0 => {
                hardening_n / stiffness_n_per_m * (force_n / hardening_n).ln_1p()
            }
            Spring::Power { exponent, reference_n } if force_n > 0.0 => {
                reference_n / stiffness_n_per_m * (force_n / reference_n).powf(exponent)
            }
            Spring::Preloaded { preload_n, softer } if force_n > preload_n => {
                (preload_n + (force_n - preload_n) / softer) / stiffness_n_per_m
            }
            _ => force_n / stiffness_n_per_m,
        }
    }
}

/// A form, built.
#[derive(Debug, Default)]
pub struct Built {
    /// Mechanisms to run.
    pub mechanisms: Vec<Box<dyn Mechanism>>,
    /// Element that replaces the friction's.
    pub element: Option<Element>,
    /// Channel that is late.
    pub delay: Option<Delay>,
    /// Spring in series.
    pub compliance: Option<Compliance>,
    /// Where the effect lives.
    pub place: Option<Place>,
    /// Parameters, by name with unit.
    pub parameters: BTreeMap<&'static str, f64>,
}

impl Built {
    /// One mechanism.
    pub fn one(mechanism: impl Mechanism + 'static) -> Self {
        Self { mechanisms: vec![Box::new(mechanism)], ..Self::default() }
    }

    /// Adds a parameter for the truth.
    pub fn with(mut self, name: &'static str, value: f64) -> Self {
        self.parameters.insert(name, value);
        self
    }

    /// Adds a place.
    pub fn at(mut self, coordinate: &'static str, from: f64, to: f64) -> Self {
        self.place = Some(Place::new(coordinate, from, to));
        self
    }
}

/// Size at severity `u` between two positive bounds, logarithmically.
pub fn size(u: f64, from: f64, to: f64) -> f64 {
    from * (to / from).powf(u)
}

/// Builds a form.
pub type Build = fn(&mut Dice, f64, &Setting) -> Built;
