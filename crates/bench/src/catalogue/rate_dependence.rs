//! Friction of the braid that grows slowly with speed, as thermally activated sliding does.
//!
//! ```text
//! F_f = F_c h,   τ dh/dt = 1 + κ asinh(|v| / v₀) - h
//! ```
//!
//! | symbol | code            | unit | meaning                                   |
//! |--------|-----------------|------|-------------------------------------------|
//! | `F_c`  | `friction_n`    | N    | friction of the braid as found            |
//! | `h`    | `level`         | 1    | its level over that of very slow motion   |
//! | `κ`    | `growth`        | 1    | growth per e-fold of speed                |
//! | `v₀`   | `speed_m_per_s` | m/s  | speed from which it grows                 |
//! | `τ`    | `settling_s`    | s    | time in which the level follows the speed |
//!
//! Linear at small speeds, logarithmic at large ones.
//!
//! Source: Eyring (1936), J. Chemical Physics 4, for flow over barriers; on polymers as friction, Persson (2000),
//! "Sliding Friction".

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Friction that grows with the logarithm of speed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RateDependence {
    growth: f64,
    speed_m_per_s: f64,
    settling_s: f64,
    level: f64,
}

impl RateDependence {
    pub(crate) fn new(growth: f64, speed_m_per_s: f64, settling_s: f64) -> Self {
        Self { growth, speed_m_per_s, settling_s, level: 1.0 }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let length = draw.length_scale();
        let growth = draw.severe("growth_per_e_fold", 0.08, 0.14, "1");
        let speed_m_per_s = draw.ratio("onset_speed", 0.1e-3 * length, 0.6e-3 * length, "m/s");
        let settling_s = draw.ratio("settling_time", 5e-3, 20e-3, "s");
        Self::new(growth, speed_m_per_s, settling_s)
    }
}

impl Mechanism for RateDependence {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let settled = 1.0 + self.growth * (now.braid_speed_m_per_s() / self.speed_m_per_s).asinh();
        self.level += (settled - self.level) * -(-now.step_s / self.settling_s).exp_m1();
        now.tension.friction_n *= self.level;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go};

    fn level_at(speed_mm_per_s: f64) -> f64 {
        let mut path = vec![(3e5, 0.26)];
        go(&mut path, 3e5, 0.25, (10.0 / speed_mm_per_s * 1e3) as usize);
        let moments = drive(RateDependence::new(0.1, 0.1e-3, 0.01), &path);
        let last = moments.last().unwrap();
        last.tension.friction_n / TrueMuscle::nominal().friction_n(3e5, last.muscle_length_m)
    }

    #[test]
    fn each_tenfold_speed_adds_the_same() {
        let (first, second) = (level_at(10.0) - level_at(1.0), level_at(100.0) - level_at(10.0));
        assert!((second - 0.1 * 10.0_f64.ln()).abs() < 1e-3, "{second}");
        assert!((first - second).abs() < 2e-3, "{first} {second}");
    }

    #[test]
    fn a_rest_brings_it_back_to_that_of_slow_motion() {
        let mut path = vec![(3e5, 0.26)];
        go(&mut path, 3e5, 0.25, 100);
        go(&mut path, 3e5, 0.25, 500);
        let moments = drive(RateDependence::new(0.1, 0.1e-3, 0.01), &path);
        let last = moments.last().unwrap();
        assert!((last.tension.friction_n - TrueMuscle::nominal().friction_n(3e5, 0.25)).abs() < 1e-9);
    }
}
