//! The zero of the load cell drifts while it warms up.
//!
//! ```text
//! F_read = F + D (1 - e^{-t/τ}) + w(t),   E[w(t)²] = σ² t
//! ```
//!
//! | symbol | code              | unit | meaning                                     |
//! |--------|-------------------|------|---------------------------------------------|
//! | `D`    | `drift_n`         | N    | drift once warm                             |
//! | `τ`    | `warm_up_s`       | s    | time of warming up                          |
//! | `σ`    | `walk_n_per_sqrt_s` | N/√s | random walk, another in each recording    |
//!
//! Starts from zero in each recording; does not depend on load or motion.
//!
//! Source: bridge excitation heats the gauges; drift of zero with temperature is in every data sheet of load cells.

use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;

use crate::draw::{Draw, source};
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Drift of the zero.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ForceDrift {
    drift_n: f64,
    warm_up_s: f64,
    walk_n_per_sqrt_s: f64,
    walked_n: f64,
    random: Pcg64Dxsm,
}

impl ForceDrift {
    pub(crate) fn new(drift_n: f64, warm_up_s: f64, walk_n_per_sqrt_s: f64) -> Self {
        Self { drift_n, warm_up_s, walk_n_per_sqrt_s, walked_n: 0.0, random: source("force-drift", 0) }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let scale = draw.force_scale() * draw.sign();
        let drift_n = draw.severe("drift_once_warm", 4.0 * scale, 8.0 * scale, "N");
        let warm_up_s = draw.ratio("warm_up_time", 60.0, 240.0, "s");
        let walk = draw.severe("random_walk", 0.01 * scale.abs(), 0.025 * scale.abs(), "N/s^0.5");
        draw.at("time", 0.0, draw.command.duration_s(), "s");
        Self::new(drift_n, warm_up_s, walk)
    }
}

impl Mechanism for ForceDrift {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let draw: f64 = StandardNormal.sample(&mut self.random);
        self.walked_n += self.walk_n_per_sqrt_s * now.step_s.sqrt() * draw;
        now.reading.force_n += self.walked_n - self.drift_n * (-now.time_s / self.warm_up_s).exp_m1();
    }

    fn begin(&mut self, seed: u64) {
        self.random = source("force-drift", seed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Readout;
    use crate::mechanism::moment::rig::run;

    fn drift_n(mut drift: ForceDrift, seed: u64) -> Vec<f64> {
        drift.begin(seed);
        let moments = run(vec![Box::new(Readout), Box::new(drift)], &[(3e5, 0.25); 10_001]);
        moments.iter().map(|now| now.reading.force_n).collect()
    }

    #[test]
    fn without_the_walk_it_warms_up_from_zero() {
        let drift_n = drift_n(ForceDrift::new(5.0, 10.0, 0.0), 1);
        assert_eq!(drift_n[0], 0.0);
        assert!((drift_n[10_000] - 5.0 * (1.0 - (-1.0_f64).exp())).abs() < 1e-9);
        assert!(drift_n.windows(2).all(|pair| pair[1] > pair[0]));
    }

    #[test]
    fn the_walk_spreads_as_the_root_of_time_and_is_another_in_each_recording() {
        let ends: Vec<f64> = (0..100).map(|seed| drift_n(ForceDrift::new(0.0, 10.0, 0.1), seed)[10_000]).collect();
        let rms_n = (ends.iter().map(|end_n| end_n * end_n).sum::<f64>() / 100.0).sqrt();
        // 0.1 N/√s over 10 s; a hundred walks tell it within 7 %, of which four times are allowed.
        assert!((rms_n / (0.1 * 10.0_f64.sqrt()) - 1.0).abs() < 0.28, "{rms_n}");
    }
}
