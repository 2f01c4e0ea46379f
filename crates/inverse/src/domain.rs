//! Where a model may be inverted: the box that its recordings cover.

use pam_artifact::model::Domain;

use crate::InverseError;

/// Smallest range of length, as a share of the longest: below it a model has seen one length only.
const MIN_LENGTH_SHARE: f64 = 0.01;
/// Likewise for pressure and force.
const MIN_SHARE: f64 = 0.05;

/// A box of pressure, length and force, with ranges that are wide enough to invert over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InverseBox {
    /// Lowest and highest gauge pressure, in Pa.
    pub pressure_pa: [f64; 2],
    /// Shortest and longest length, in m.
    pub length_m: [f64; 2],
    /// Lowest and highest force, in N; not negative, because a slack muscle pulls with no force.
    pub force_n: [f64; 2],
}

impl InverseBox {
    /// The box of a model's domain.
    ///
    /// # Errors
    /// [`InverseError::Degenerate`] where a range is empty or next to nothing.
    pub fn of(domain: &Domain) -> Result<Self, InverseError> {
        let [lowest_n, highest_n] = domain.force_n;
        let inverse_box = Self {
            pressure_pa: domain.pressure_pa,
            length_m: domain.length_m,
            force_n: [lowest_n.max(0.0), highest_n],
        };
        let ranges = [
            ("pressure", inverse_box.pressure_pa, 1e-3, "kPa", MIN_SHARE),
            ("length", inverse_box.length_m, 1e3, "mm", MIN_LENGTH_SHARE),
            ("force", inverse_box.force_n, 1.0, "N", MIN_SHARE),
        ];
        for (name, [from, to], scale, unit, share) in ranges {
            let wide = to - from >= share * to.abs() && to > from;
            if !(wide && from.is_finite() && to.is_finite()) {
                let rounded = |value: f64| (value * scale * 1e4).round() / 1e4;
                return Err(InverseError::Degenerate { name, from: rounded(from), to: rounded(to), unit });
            }
        }
        Ok(inverse_box)
    }

    /// Range of pressure: the full scale of pressure errors, in Pa.
    pub fn pressure_span_pa(&self) -> f64 {
        self.pressure_pa[1] - self.pressure_pa[0]
    }

    /// Range of length, in m.
    pub fn length_span_m(&self) -> f64 {
        self.length_m[1] - self.length_m[0]
    }

    /// Range of force: the full scale of force errors, in N.
    pub fn force_span_n(&self) -> f64 {
        self.force_n[1] - self.force_n[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn domain() -> Domain {
        Domain {
            pressure_pa: [1e3, 5e5],
            length_m: [0.21, 0.268],
            force_n: [-0.4, 1100.0],
            length_rate_m_per_s: 0.03,
            pressure_rate_pa_per_s: 1e5,
        }
    }

    #[test]
    fn a_slack_muscle_has_no_force_to_invert() {
        assert_eq!(InverseBox::of(&domain()).unwrap().force_n, [0.0, 1100.0]);
    }

    #[test]
    fn one_length_is_no_domain() {
        let isometric = Domain { length_m: [0.26703, 0.26707], ..domain() };
        assert_eq!(
            InverseBox::of(&isometric).unwrap_err().to_string(),
            "the model's domain covers length 267.03 to 267.07 mm only; identify it from recordings in which the length varies"
        );
        for broken in [[0.268, 0.21], [f64::NAN, 0.268], [0.21, f64::INFINITY]] {
            assert!(InverseBox::of(&Domain { length_m: broken, ..domain() }).is_err());
        }
    }
}
