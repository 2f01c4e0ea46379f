//! Where a muscle may be taken, and the numbers of the protocols scaled to it.

use pam_artifact::model::Domain;
use pam_muscle::force::ForceModel;

/// Rest length for which distances and speeds of the protocols are written, in m.
const REFERENCE_LENGTH_M: f64 = 0.267;
/// Pressure for which they are written.
const REFERENCE_KPA: f64 = 500.0;
/// Contractions for which they are written.
const REFERENCE_CONTRACTION: (f64, f64) = (-0.005, 0.21);

/// Where the muscle may be taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach<'a> {
    /// What says where it is taut.
    pub model: &'a ForceModel,
    /// Lowest and highest pressure, in Pa.
    pub pressure_pa: (f64, f64),
    /// Shortest and longest length, in m.
    pub length_m: (f64, f64),
    /// Tension to be kept while it contracts, in N; `-∞` lets it go slack.
    pub lowest_tension_n: f64,
}

impl<'a> Reach<'a> {
    /// What a model covers: pressures and lengths of its recordings, and where it is taut there.
    pub(crate) fn of(domain: &Domain, model: &'a ForceModel, may_hang_slack: bool) -> Self {
        Self {
            model,
            pressure_pa: (domain.pressure_pa[0].max(0.0), domain.pressure_pa[1]),
            length_m: (domain.length_m[0], domain.length_m[1]),
            lowest_tension_n: if may_hang_slack {
                f64::NEG_INFINITY
            } else {
                (0.01 * domain.force_n[1]).max(domain.force_n[0])
            },
        }
    }

    pub(super) fn pressure(&self, kilopascal: f64) -> f64 {
        let (low, high) = self.pressure_pa;
        low + (kilopascal / REFERENCE_KPA).clamp(0.0, 1.0) * (high - low)
    }

    pub(super) fn pressure_rate(&self, kilopascal_per_s: f64) -> f64 {
        kilopascal_per_s / REFERENCE_KPA * (self.pressure_pa.1 - self.pressure_pa.0).max(1e3)
    }

    pub(super) fn distance(&self, millimeters: f64) -> f64 {
        millimeters * 1e-3 * self.model.muscle().rest_length_m / REFERENCE_LENGTH_M
    }

    pub(super) fn length(&self, contraction: f64) -> f64 {
        let (short, long) = self.length_m;
        let (from, to) = REFERENCE_CONTRACTION;
        long + ((contraction - from) / (to - from)).clamp(0.0, 1.0) * (short - long)
    }

    pub(super) fn is_taut(&self, pressure_pa: f64, length_m: f64) -> bool {
        self.lowest_tension_n == f64::NEG_INFINITY
            || self.model.force_n(pressure_pa, length_m, 1.0) >= self.lowest_tension_n
    }

    /// The length nearest to that of a contraction at which the muscle is taut; none if it is slack at any.
    pub(super) fn taut_length(&self, pressure_pa: f64, contraction: f64) -> Option<f64> {
        let wanted = self.length(contraction);
        if self.is_taut(pressure_pa, wanted) {
            return Some(wanted);
        }
        let (mut slack, mut taut) = (wanted, self.length_m.1);
        if !self.is_taut(pressure_pa, taut) {
            return None;
        }
        while taut - slack > 1e-5 {
            let middle = 0.5 * (taut + slack);
            if self.is_taut(pressure_pa, middle) { taut = middle } else { slack = middle }
        }
        Some(taut)
    }

    /// The lowest pressure at which the muscle is taut at a length; none if it is slack at any.
    pub(super) fn taut_pressure(&self, length_m: f64) -> Option<f64> {
        let (mut slack, mut taut) = self.pressure_pa;
        if self.is_taut(slack, length_m) {
            return Some(slack);
        }
        if !self.is_taut(taut, length_m) {
            return None;
        }
        while taut - slack > 10.0 {
            let middle = 0.5 * (taut + slack);
            if self.is_taut(middle, length_m) { taut = middle } else { slack = middle }
        }
        Some(taut)
    }
}
