//! Points drawn from the model, evenly over where it has an inverse.
//!
//! A point is a length, a direction and a share of the [branch](crate::exact::Branch) of pressures there; the
//! force is what the model says. Points to train on come from a sequence that leaves no gaps, points to judge
//! on are drawn independently.
//!
//! The sequence is the additive recurrence `x_n = frac(x_0 + n α)` with `α_i = g^-i` and `g` the root of
//! `g⁴ = g + 1`, after Roberts (2018), "The unreasonable effectiveness of quasirandom sequences"; `x_0` is drawn.

use rand::RngExt as _;
use rayon::prelude::*;

use crate::ExactInverse;
use crate::stream::Stream;

/// A point of the force model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Gauge pressure, in Pa.
    pub pressure_pa: f64,
    /// Length, in m.
    pub length_m: f64,
    /// Direction, -1 to +1.
    pub direction: f64,
    /// Force there, in N.
    pub force_n: f64,
}

/// Root of `g⁴ = g + 1`.
const G: f64 = 1.220_744_084_605_759_5;
/// By how much coordinates reach over their ends before they are cut to them: puts some points on the faces of
/// the box, where a network errs most.
const OVERHANG: f64 = 0.02;
/// Share of the points that move neither way for certain: directions between the two.
const BETWEEN: f64 = 0.2;

/// Where points come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Draw {
    /// Without gaps, and on the faces of the operating range too.
    Design,
    /// Independently, moving one way or the other.
    Independent,
}

/// At most `n` points where the inverse exists; those whose length and direction have no branch are left out.
pub fn points(inverse: &ExactInverse, n: usize, draw: Draw, seed: u64) -> Vec<Point> {
    let inverse_box = inverse.inverse_box();
    let stream = if draw == Draw::Design { Stream::Design } else { Stream::Evaluation };
    let mut random = stream.random(seed);
    let shift: [f64; 3] = std::array::from_fn(|_| random.random_range(0.0..1.0));
    let coordinates = |index: usize| -> [f64; 3] {
        std::array::from_fn(|axis| {
            let step = G.powi(-(axis as i32) - 1);
            let share = (shift[axis] + (index + 1) as f64 * step).fract();
            ((share - 0.5) * (1.0 + 2.0 * OVERHANG) + 0.5).clamp(0.0, 1.0)
        })
    };
    let drawn: Vec<[f64; 3]> = (0..n)
        .map(|index| match draw {
            Draw::Design => coordinates(index),
            Draw::Independent => std::array::from_fn(|_| random.random_range(0.0..1.0)),
        })
        .collect();
    drawn
        .into_par_iter()
        .filter_map(|[p, l, s]| {
            let direction = match draw {
                Draw::Design => ((s - 0.5) * 2.0 / BETWEEN).clamp(-1.0, 1.0),
                Draw::Independent => (s - 0.5_f64).signum(),
            };
            let length_m = inverse_box.length_m[0] + l * inverse_box.length_span_m();
            let [low_pa, high_pa] = inverse.branch(length_m, direction)?.pressure_pa;
            let pressure_pa = low_pa + p * (high_pa - low_pa);
            let force_n = inverse.model().settled_force_n(pressure_pa, length_m, direction);
            Some(Point { pressure_pa, length_m, direction, force_n })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::tests::{BOX, nominal_inverse, soft};

    #[test]
    fn points_lie_where_the_inverse_finds_them_again() {
        for inverse in [nominal_inverse(), ExactInverse::new(soft(), BOX, 0.05)] {
            for draw in [Draw::Design, Draw::Independent] {
                let drawn = points(&inverse, 300, draw, 1);
                assert!(drawn.len() > 250, "{}", drawn.len());
                for point in drawn {
                    let pressure_pa = inverse.pressure_pa(point.force_n, point.length_m, point.direction).unwrap();
                    assert!((pressure_pa - point.pressure_pa).abs() < 1.0, "{point:?} {pressure_pa}");
                }
            }
        }
    }

    #[test]
    fn every_eighth_of_the_box_gets_its_share() {
        let inverse = nominal_inverse();
        let drawn = points(&inverse, 800, Draw::Design, 5);
        let middle_m = 0.5 * (BOX.length_m[0] + BOX.length_m[1]);
        for long in [false, true] {
            for contracting in [false, true] {
                let n = drawn.iter().filter(|p| (p.length_m > middle_m) == long && (p.direction > 0.0) == contracting);
                assert!((190..=210).contains(&n.count()));
            }
        }
    }
}
