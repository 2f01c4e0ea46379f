//! How a sentence answers its argument `x`: curves that are linear in their amplitudes.
//!
//! | curve        | value                                                                     | amplitudes        |
//! |--------------|---------------------------------------------------------------------------|-------------------|
//! | `line`       | `a x`                                                                     | `a`               |
//! | `saturation` | `a sgn(u) (1 - e^{-\|u\| / over})`, `u = x - from`                         | `a`               |
//! | `bump`       | `a e^{-((x - center) / width)²}`                                          | `a`               |
//! | `monotone`   | `Σ a_i clamp((x - k_i) / (k_{i+1} - k_i), 0, 1)`, all `a_i` of one sign     | one a step        |
//! | `spline`     | cubic Hermite through `a_i` at `k_i`, slope at `k_i` that from `k_{i-1}` to `k_{i+1}` | one a knot |

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Most knots that a curve may have.
pub const MOST_KNOTS: usize = 40;

/// How a sentence answers its argument; see the [module](self) for the equations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Curve {
    /// In proportion.
    Line,
    /// Up to a limit.
    Saturation {
        /// Where it is zero.
        from: f64,
        /// Distance from there at which 63 % of the limit are reached.
        over: f64,
    },
    /// Around one place.
    Bump {
        /// Where it is largest.
        center: f64,
        /// Distance from there at which 37 % are left.
        width: f64,
    },
    /// Never back.
    Monotone {
        /// Knots, rising.
        knots: Vec<f64>,
    },
    /// Through free values.
    Spline {
        /// Knots, rising.
        knots: Vec<f64>,
    },
}

impl Curve {
    /// Name as in files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Saturation { .. } => "saturation",
            Self::Bump { .. } => "bump",
            Self::Monotone { .. } => "monotone",
            Self::Spline { .. } => "spline",
        }
    }

    /// Numbers in which it is linear.
    pub fn n_amplitudes(&self) -> usize {
        match self {
            Self::Line | Self::Saturation { .. } | Self::Bump { .. } => 1,
            Self::Monotone { knots } => knots.len().saturating_sub(1),
            Self::Spline { knots } => knots.len(),
        }
    }

    /// Degrees of freedom: amplitudes, and what was chosen besides.
    pub fn n_parameters(&self) -> usize {
        match self {
            Self::Line => 1,
            Self::Saturation { .. } => 2,
            Self::Bump { .. } => 3,
            Self::Monotone { .. } | Self::Spline { .. } => self.n_amplitudes(),
        }
    }

    pub(super) fn check(&self) -> Result<(), String> {
        match self {
            Self::Line => Ok(()),
            Self::Saturation { from, over: distance } | Self::Bump { center: from, width: distance } => {
                let name =
                    if matches!(self, Self::Bump { .. }) { "width of the bump" } else { "over of the saturation" };
                if !from.is_finite() {
                    return Err(format!("the place of the {} is {from}", self.name()));
                }
                if !(distance.is_finite() && *distance > 0.0) {
                    return Err(format!("the {name} is {distance}; it has to be positive"));
                }
                Ok(())
            }
            Self::Monotone { knots } | Self::Spline { knots } => {
                if !(2..=MOST_KNOTS).contains(&knots.len()) {
                    return Err(format!("a {} has {} knots; give 2 to {MOST_KNOTS}", self.name(), knots.len()));
                }
                if knots.iter().any(|knot| !knot.is_finite()) || knots.windows(2).any(|pair| pair[0] >= pair[1]) {
                    return Err("the knots do not rise from each to the next".to_owned());
                }
                Ok(())
            }
        }
    }

    /// Fills in the value per unit of each amplitude at `x`.
    pub fn columns(&self, x: f64, columns: &mut [f64]) {
        match self {
            Self::Line => columns[0] = x,
            Self::Saturation { from, over } => {
                let away = x - from;
                columns[0] = -away.signum() * (-away.abs() / over).exp_m1();
            }
            Self::Bump { center, width } => columns[0] = (-((x - center) / width).powi(2)).exp(),
            Self::Monotone { knots } => {
                for (column, pair) in columns.iter_mut().zip(knots.windows(2)) {
                    *column = ((x - pair[0]) / (pair[1] - pair[0])).clamp(0.0, 1.0);
                }
            }
            Self::Spline { .. } => {
                columns.fill(0.0);
                self.each(x, &mut |index, value| columns[index] += value);
            }
        }
    }

    /// The same, each value that is not zero with its amplitude.
    pub fn each(&self, x: f64, visit: &mut dyn FnMut(usize, f64)) {
        match self {
            Self::Spline { knots } => hermite(knots, x, visit),
            _ => {
                let mut columns = [0.0; MOST_KNOTS];
                let columns = &mut columns[..self.n_amplitudes()];
                self.columns(x, columns);
                columns
                    .iter()
                    .enumerate()
                    .filter(|(_, value)| **value != 0.0)
                    .for_each(|(index, &value)| visit(index, value));
            }
        }
    }
}

/// Weights of the values at up to four knots around `x`; a knot may come twice.
fn hermite(knots: &[f64], x: f64, visit: &mut dyn FnMut(usize, f64)) {
    let last = knots.len() - 1;
    let above = knots.partition_point(|&knot| knot <= x).clamp(1, last);
    let (left, right) = (above - 1, above);
    let width = knots[right] - knots[left];
    let t = ((x - knots[left]) / width).clamp(0.0, 1.0);
    let (t2, t3) = (t * t, t * t * t);
    visit(left, 2.0 * t3 - 3.0 * t2 + 1.0);
    visit(right, 3.0 * t2 - 2.0 * t3);
    for (knot, slope) in [(left, t3 - 2.0 * t2 + t), (right, t3 - t2)] {
        let (before, after) = (knot.saturating_sub(1), (knot + 1).min(last));
        let per = slope * width / (knots[after] - knots[before]);
        visit(after, per);
        visit(before, -per);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(curve: &Curve, x: f64, amplitudes: &[f64]) -> f64 {
        let mut columns = vec![0.0; amplitudes.len()];
        curve.columns(x, &mut columns);
        columns.iter().zip(amplitudes).map(|(column, amplitude)| column * amplitude).sum()
    }

    #[test]
    fn a_spline_goes_through_its_values_and_a_straight_one_stays_straight() {
        let knots = vec![0.0, 1.0, 2.5, 3.0, 5.0];
        let curve = Curve::Spline { knots: knots.clone() };
        for (index, knot) in knots.iter().enumerate() {
            let mut unit = [0.0; 5];
            unit[index] = 1.0;
            assert!((value(&curve, *knot, &unit) - 1.0).abs() < 1e-12);
        }
        let straight: Vec<f64> = knots.iter().map(|knot| 3.0 - 2.0 * knot).collect();
        for x in [0.2, 1.7, 2.9, 4.4] {
            assert!((value(&curve, x, &straight) - (3.0 - 2.0 * x)).abs() < 1e-12, "{x}");
        }
    }

    #[test]
    fn a_smooth_function_is_followed_to_the_third_order() {
        let error = |n: usize| {
            let knots: Vec<f64> = (0..n).map(|index| index as f64 / (n - 1) as f64).collect();
            let values: Vec<f64> = knots.iter().map(|knot| (6.0 * knot).sin()).collect();
            let curve = Curve::Spline { knots };
            // Inside, where slopes are central.
            (25..75)
                .map(|at| 0.01 * f64::from(at))
                .map(|x| (value(&curve, x, &values) - (6.0 * x).sin()).abs())
                .fold(0.0, f64::max)
        };
        assert!(error(21) < error(11) / 6.0, "{} {}", error(11), error(21));
    }

    #[test]
    fn steps_of_one_sign_never_go_back() {
        let curve = Curve::Monotone { knots: vec![0.0, 1.0, 4.0, 5.0] };
        let along: Vec<f64> = (-10..70).map(|at| value(&curve, 0.1 * f64::from(at), &[1.0, 0.0, 2.0])).collect();
        assert!(along.windows(2).all(|pair| pair[1] >= pair[0]));
        assert_eq!((along[0], along[79]), (0.0, 3.0));
    }

    #[test]
    fn a_saturation_is_odd_about_where_it_begins() {
        let curve = Curve::Saturation { from: 1.0, over: 0.5 };
        assert!((value(&curve, 1.5, &[2.0]) - 2.0 * (1.0 - (-1.0_f64).exp())).abs() < 1e-12);
        assert!((value(&curve, 1.5, &[2.0]) + value(&curve, 0.5, &[2.0])).abs() < 1e-12);
    }
}
