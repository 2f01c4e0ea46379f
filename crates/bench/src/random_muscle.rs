//! A muscle drawn at random, of the kind that is made by hand.

use pam_muscle::Muscle;
use rand::RngExt;

use crate::draw::source;
use crate::parameters::Parameters;
use crate::true_muscle::TrueMuscle;

/// A muscle that is too weak for the protocols is drawn again: tension at 200 kPa and 15 % contraction, in N.
const WEAKEST_N: f64 = 20.0;

impl TrueMuscle {
    /// A plausible muscle about the nominal one. Its dimensions are what ruler, caliper and photograph would give: whole
    /// fractions of a millimeter and a degree.
    pub fn random(seed: u64) -> Self {
        let mut random = source("random-muscle", seed);
        loop {
            let mut between = |low: f64, high: f64| random.random_range(low..high);
            // Nearest multiple of `1 / per_unit`.
            let measured = |value: f64, per_unit: f64| (value * per_unit).round() / per_unit;
            let muscle = Muscle {
                rest_length_m: measured(between(220.0, 290.0), 2.0) * 1e-3,
                rest_radius_m: measured(between(8.0, 12.0), 20.0) * 1e-3,
                braid_angle_rad: measured(between(22.0, 28.0), 4.0).to_radians(),
                wall_thickness_m: measured(between(0.7, 1.3), 50.0) * 1e-3,
                strand_count: 2.0 * between(90.0, 150.0).round(),
                strand_diameter_m: measured(between(0.20, 0.30), 100.0) * 1e-3,
            };
            let (rubber_pa, c10_share) = (between(120e3, 350e3), between(0.5, 0.56));
            let strand_modulus_pa = between(2e9, 4e9);
            let parameters = Parameters {
                k1: between(0.78, 1.02),
                k2: between(1.0, 1.2),
                k3_n: between(-4.0, 4.0),
                c10_pa: c10_share * rubber_pa,
                c01_pa: (1.0 - c10_share) * rubber_pa,
                strand_modulus_pa,
                rubber_friction: between(0.7e-3, 2.5e-3),
                strand_friction: 0.0,
            };
            // A modulus from a data sheet has two digits.
            let drawn = Self::new(muscle, measured(strand_modulus_pa, 1e-8), parameters);
            if drawn.force_n(200e3, drawn.muscle().length_m(0.15), 1.0) > WEAKEST_N {
                return drawn;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::{ALL, Options};

    #[test]
    fn a_random_muscle_can_run_every_protocol_and_comes_back_from_its_seed() {
        let options = Options { duration_scale: 0.05, ..Options::default() };
        for seed in 0..30 {
            let muscle = TrueMuscle::random(seed);
            assert_eq!(muscle, TrueMuscle::random(seed));
            for protocol in ALL {
                assert!(protocol.command(&muscle, &options).is_ok(), "{seed}, {}", protocol.name);
            }
        }
    }
}
