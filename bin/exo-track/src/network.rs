//! The trained network as the inverse of the loop.

use pam_exo::inverse::{Inverse, Inverted};
use pam_inverse_model::InverseNetwork;

/// A network that is never asked beyond its reach: there, the force is moved to the nearest one that it knows.
#[derive(Debug)]
pub(crate) struct Network(pub(crate) InverseNetwork);

impl Inverse for Network {
    fn pressure_pa(&self, force_n: f64, length_m: f64, direction: f64) -> Inverted {
        let asked = self.0.pressure_pa(force_n, length_m, direction);
        if !asked.outside {
            return Inverted { pressure_pa: asked.pressure_pa, outside: false };
        }
        let [shortest_m, longest_m] = self.0.domain().length_m;
        let (length_m, direction) = (length_m.clamp(shortest_m, longest_m), direction.clamp(-1.0, 1.0));
        let force_n = match self.0.reach_n(length_m, direction) {
            Some([lowest_n, highest_n]) if lowest_n <= highest_n => force_n.clamp(lowest_n, highest_n),
            _ => force_n,
        };
        Inverted { pressure_pa: self.0.pressure_pa(force_n, length_m, direction).pressure_pa, outside: true }
    }
}
