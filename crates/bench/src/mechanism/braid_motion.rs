//! Motion of the braid: its direction and its travel.
//!
//! ```text
//! Δx = -ΔL                      where the length moves
//! Δx = L (y(p) - y(p_before))   where it is held
//! ```
//!
//! Friction acts where strands slide, that is where the angle of the braid changes, `cos θ = L / b`. A shortening by `Δx`
//! changes it, and so do strands that stretch by the share `Δy` at a fixed length, as much as a shortening by `L Δy`.
//! The direction is the sign of `Δx`, held at standstill.

use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Follows the braid, step by step.
#[derive(Debug, Clone, PartialEq)]
pub struct BraidMotion {
    direction: f64,
    before: Option<(f64, f64)>,
}

impl BraidMotion {
    /// The muscle comes from being inflated, which moves the braid as a contraction does.
    pub fn new() -> Self {
        Self { direction: 1.0, before: None }
    }
}

impl Default for BraidMotion {
    fn default() -> Self {
        Self::new()
    }
}

impl Mechanism for BraidMotion {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        let (pressure_now_pa, length_now_m) = (now.muscle_pressure_pa, now.muscle_length_m);
        let (pressure_pa, length_m) = self.before.unwrap_or((pressure_now_pa, length_now_m));
        now.shortening_m = length_m - length_now_m;
        now.braid_travel_m = now.shortening_m;
        if now.shortening_m == 0.0 && pressure_now_pa != pressure_pa {
            let strain = |pressure_pa| muscle.strand_strain(pressure_pa, length_now_m);
            now.braid_travel_m = length_now_m * (strain(pressure_now_pa) - strain(pressure_pa));
        }
        let motion = if now.shortening_m == 0.0 { pressure_now_pa - pressure_pa } else { now.shortening_m };
        if motion != 0.0 {
            self.direction = motion.signum();
        }
        now.direction = self.direction;
        self.before = Some((pressure_now_pa, length_now_m));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig;

    fn last(positions: &[(f64, f64)]) -> Moment {
        rig::run(vec![Box::new(BraidMotion::new())], positions).pop().unwrap()
    }

    #[test]
    fn shortening_is_positive_travel_and_lengthening_negative() {
        let contracting = last(&[(3e5, 0.26), (3e5, 0.25)]);
        assert_eq!(contracting.direction, 1.0);
        assert!((contracting.braid_travel_m - 0.01).abs() < 1e-15);
        assert!((contracting.shortening_speed_m_per_s() - 10.0).abs() < 1e-9);
        assert_eq!(last(&[(3e5, 0.25), (3e5, 0.26)]).direction, -1.0);
    }

    #[test]
    fn direction_is_held_at_standstill() {
        let standing = last(&[(3e5, 0.25), (3e5, 0.26), (3e5, 0.26), (3e5, 0.26)]);
        assert_eq!((standing.direction, standing.braid_travel_m), (-1.0, 0.0));
    }

    #[test]
    fn pressure_takes_the_place_of_a_length_that_is_held() {
        let deflating = last(&[(3e5, 0.25), (2e5, 0.25)]);
        assert_eq!((deflating.direction, deflating.shortening_m), (-1.0, 0.0));
        // Some 2 to 4 mm of braid for 100 kPa: nylon stretches by about one percent.
        assert!((-4e-3..-1e-3).contains(&deflating.braid_travel_m), "{}", deflating.braid_travel_m);
        assert_eq!(last(&[(3e5, 0.25), (2e5, 0.25), (3e5, 0.25), (3e5, 0.25)]).direction, 1.0);
    }
}
