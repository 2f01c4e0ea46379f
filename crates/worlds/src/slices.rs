//! The sliced bench: a muscle of many slices in equilibrium, without any closed form of its force.
//!
//! Slice `i` has the radii `a`, `c` at its ends, mean `m`, difference `d`, a meridian `s` and an axial length `l`:
//!
//! ```text
//! s² = b² − (2π n m)²          strands keep their length b (which pressure stretches a little)
//! l² = s² − d²                 a slice that widens is a cone
//! E  = ρ W(s/l₀, m̃/m̃₀) + k d²/2   membrane, and strands that resist the cone
//! v  = π l (m² + d²/12)        frustum
//! ```
//!
//! The ends are clamped at the fittings' radius. The radii make `Σ E − p Σ v − F (Σ l − L)` stationary; the multiplier `F` is
//! the force. Newton's method on the radii and `F`, tridiagonal but for one border row; solved on Chebyshev nodes of
//! `(p, L)` and interpolated by polynomials, so that no table shows. Slices differ in braid angle and wall.
//!
//! The part that is the bladder's is the derivative of `F` with the modulus of the membrane, by a second solution.

use std::f64::consts::PI;

use crate::curve::{Surfaces, chebyshev_node};
use crate::draw::Dice;
use crate::muscle::{Muscle, Parts};

const COUNT_PRESSURE: usize = 10;
const COUNT_LENGTH: usize = 16;
/// Most that the interpolation may miss a solution by, N.
const INTERPOLATION_N: f64 = 0.15;

/// One slice as built.
#[derive(Debug, Clone)]
struct Slice {
    strand_m: f64,
    /// `2π` times the turns within the slice.
    winding: f64,
    rest_length_m: f64,
    rest_radius_m: f64,
    wall_m: f64,
}

/// Prepared force of a sliced muscle.
#[derive(Debug, Clone)]
pub struct SlicedMuscle {
    /// Force of gas and braid, of the bladder, and radius.
    parts: Surfaces,
    /// Slices that it is made of.
    pub count: usize,
}

struct Problem<'a> {
    muscle: &'a Muscle,
    slices: &'a [Slice],
    bending_n_per_m: f64,
    membrane: f64,
}

/// Value, first and second derivative.
type Jet = (f64, f64, f64);

impl Problem<'_> {
    /// Energy of the membrane of a slice as a function of its mean radius.
    fn membrane_j(&self, slice: &Slice, mean_m: f64) -> f64 {
        let meridian_m = (slice.strand_m.powi(2) - (slice.winding * mean_m).powi(2)).max(1e-10).sqrt();
        let axial = meridian_m / slice.rest_length_m;
        // Middle of the wall, whose volume is constant.
        let rest_middle_m = slice.rest_radius_m - 0.5 * slice.wall_m;
        let square = mean_m * mean_m - (slice.rest_radius_m.powi(2) - rest_middle_m.powi(2)) / axial;
        let hoop = square.max(1e-10).sqrt() / rest_middle_m;
        let volume_m3 = 2.0 * PI * rest_middle_m * slice.wall_m * slice.rest_length_m;
        self.membrane * volume_m3 * self.muscle.rubber.energy_j_per_m3(axial, hoop)
    }

    fn membrane_jet(&self, slice: &Slice, mean_m: f64) -> Jet {
        let step = 2e-4 * mean_m;
        let (below, here, above) = (
            self.membrane_j(slice, mean_m - step),
            self.membrane_j(slice, mean_m),
            self.membrane_j(slice, mean_m + step),
        );
        (here, (above - below) / (2.0 * step), (above - 2.0 * here + below) / (step * step))
    }

    /// Solves from a start; radii of the inner nodes and force. None where Newton's method does not arrive.
    fn solve(&self, pressure_pa: f64, length_m: f64, radii: &mut [f64], force_n: &mut f64) -> Option<()> {
        let count = self.slices.len();
        let inner = count - 1;
        let stretch = 1.0
            + (pressure_pa * length_m * self.muscle.strand_m()
                / (2.0 * PI * self.muscle.turns().powi(2) * self.muscle.strand_stiffness_n()))
            .clamp(0.0, 0.2);
        for _ in 0..60 {
            let (mut gradient, mut length_gradient) = (vec![0.0; inner], vec![0.0; inner]);
            let (mut diagonal, mut off) = (vec![0.0; inner], vec![0.0; inner]);
            let mut total_m = 0.0;
            for (index, slice) in self.slices.iter().enumerate() {
                let (a, c) = (radii[index], radii[index + 1]);
                let (m, d) = (0.5 * (a + c), c - a);
                let strand_m = slice.strand_m * stretch;
                let l = (strand_m.powi(2) - (slice.winding * m).powi(2) - d * d).max(1e-9).sqrt();
                total_m += l;
                let k2 = slice.winding * slice.winding;
                let (l_m, l_d) = (-k2 * m / l, -d / l);
                let (l_mm, l_dd, l_md) = (-k2 / l - l_m * l_m / l, -1.0 / l - l_d * l_d / l, -l_m * l_d / l);
                let q = m * m + d * d / 12.0;
                let (q_m, q_d) = (2.0 * m, d / 6.0);
                let v_m = PI * (l_m * q + l * q_m);
                let v_d = PI * (l_d * q + l * q_d);
                let v_mm = PI * (l_mm * q + 2.0 * l_m * q_m + 2.0 * l);
                let v_dd = PI * (l_dd * q + 2.0 * l_d * q_d + l / 6.0);
                let v_md = PI * (l_md * q + l_m * q_d + l_d * q_m);
                let (_, e_m, e_mm) = self.membrane_jet(slice, m);
                let (p, f, k) = (pressure_pa, *force_n, self.bending_n_per_m);
                let (u_m, u_d) = (e_m - p * v_m - f * l_m, k * d - p * v_d - f * l_d);
                let (u_mm, u_dd) = (e_mm - p * v_mm - f * l_mm, k - p * v_dd - f * l_dd);
                let u_md = -p * v_md - f * l_md;
                if index > 0 {
                    gradient[index - 1] += 0.5 * u_m - u_d;
                    length_gradient[index - 1] += 0.5 * l_m - l_d;
                    diagonal[index - 1] += 0.25 * u_mm - u_md + u_dd;
                }
                if index < inner {
                    gradient[index] += 0.5 * u_m + u_d;
                    length_gradient[index] += 0.5 * l_m + l_d;
                    diagonal[index] += 0.25 * u_mm + u_md + u_dd;
                }
                if index > 0 && index < inner {
                    off[index - 1] = 0.25 * u_mm - u_dd;
                }
            }
            let down: Vec<f64> = gradient.iter().map(|value| -value).collect();
            let newton = tridiagonal(&diagonal, &off, &down);
            let along = tridiagonal(&diagonal, &off, &length_gradient);
            let dot = |x: &[f64]| -> f64 { x.iter().zip(&length_gradient).map(|(x, g)| x * g).sum() };
            let change_n = (length_m - total_m - dot(&newton)) / dot(&along);
            let mut largest = 0.0_f64;
            let change: Vec<f64> = newton.iter().zip(&along).map(|(n, g)| n + change_n * g).collect();
            for value in &change {
                largest = largest.max(value.abs());
            }
            let damping = (1e-3 / largest.max(1e-30)).min(1.0);
            for (radius, value) in radii[1..count].iter_mut().zip(&change) {
                *radius += damping * value;
            }
            *force_n += damping * change_n;
            if !force_n.is_finite() || radii.iter().any(|radius| *radius <= 0.0 || !radius.is_finite()) {
                return None;
            }
            if largest < 1e-12 && change_n.abs() < 1e-6 {
                return Some(());
            }
        }
        None
    }
}

/// Solves a symmetric tridiagonal system (Thomas).
fn tridiagonal(diagonal: &[f64], off: &[f64], right: &[f64]) -> Vec<f64> {
    let count = diagonal.len();
    let (mut pivots, mut solution) = (diagonal.to_vec(), right.to_vec());
    for row in 1..count {
        let factor = off[row - 1] / pivots[row - 1];
        pivots[row] -= factor * off[row - 1];
        solution[row] -= factor * solution[row - 1];
    }
    for row in (0..count).rev() {
        let after = if row + 1 < count { off[row] * solution[row + 1] } else { 0.0 };
        solution[row] = (solution[row] - after) / pivots[row];
    }
    solution
}

impl SlicedMuscle {
    /// Prepares the force of a muscle. None where an equilibrium is not found.
    pub fn new(muscle: &Muscle, dice: &mut Dice) -> Option<Self> {
        let count = dice.between(15, 40);
        let uneven = dice.uniform(0.0, 0.01);
        let slices: Vec<Slice> = (0..count)
            .map(|_| {
                let angle = muscle.braid_angle_rad * (1.0 + 0.5 * uneven * dice.normal());
                let rest_length_m = muscle.rest_length_m / count as f64;
                Slice {
                    strand_m: rest_length_m / angle.cos(),
                    winding: rest_length_m * angle.tan() / muscle.rest_radius_m,
                    rest_length_m,
                    rest_radius_m: muscle.rest_radius_m,
                    wall_m: muscle.wall_m * (1.0 + uneven * dice.normal()),
                }
            })
            .collect();
        // Per slice, so that a finer cut does not change the cone: an energy ∝ (dr/dz)² per length. Strands that
        // resist less would let the middle buckle where the bladder pushes.
        let bending_n_per_m = dice.uniform(2.5e4, 5e4) * count as f64 / 20.0 * 0.25 / muscle.rest_length_m;
        let (from, to) = muscle.span_m;
        let highest_pa = 1.02 * muscle.highest_pressure_pa;
        let table = |membrane: f64| -> Option<(Vec<f64>, Vec<f64>)> {
            let problem = Problem { muscle, slices: &slices, bending_n_per_m, membrane };
            let (mut forces, mut radii_at) = (Vec::new(), Vec::new());
            for row in 0..COUNT_PRESSURE {
                let pressure_pa = chebyshev_node(row, COUNT_PRESSURE, 0.0, highest_pa);
                let mut radii = vec![muscle.rest_radius_m; count + 1];
                let mut force_n = 0.0;
                // From the longest length to the shortest, each from the one before; a step between two nodes helps.
                let mut last_m = muscle.rest_length_m;
                for column in 0..COUNT_LENGTH {
                    let length_m = chebyshev_node(column, COUNT_LENGTH, from, to);
                    let hops = 4;
                    for hop in 1..=hops {
                        let between_m = last_m + (length_m - last_m) * f64::from(hop) / f64::from(hops);
                        problem.solve(pressure_pa, between_m, &mut radii, &mut force_n)?;
                    }
                    last_m = length_m;
                    forces.push(force_n);
                    radii_at.push(radii[count / 2]);
                }
            }
            Some((forces, radii_at))
        };
        let (total, radii) = table(1.0)?;
        let (softer, _) = table(0.97)?;
        let bladder: Vec<f64> = total.iter().zip(&softer).map(|(whole, soft)| (whole - soft) / 0.03).collect();
        let gas: Vec<f64> = total.iter().zip(&bladder).map(|(whole, part)| whole - part).collect();
        let grid = [gas.as_slice(), bladder.as_slice(), radii.as_slice()];
        let parts = Surfaces::from_nodes((0.0, highest_pa), (from, to), COUNT_PRESSURE, COUNT_LENGTH, grid);
        let sliced = Self { parts, count };
        let problem = Problem { muscle, slices: &slices, bending_n_per_m, membrane: 1.0 };
        (sliced.missed_n(&problem)? < INTERPOLATION_N).then_some(sliced)
    }

    /// Largest distance from solutions between the nodes where the muscle pulls, N.
    fn missed_n(&self, problem: &Problem) -> Option<f64> {
        let muscle = problem.muscle;
        let mut most_n = 0.0_f64;
        for pressure_share in [0.07, 0.33, 0.61, 0.93] {
            let pressure_pa = pressure_share * muscle.highest_pressure_pa;
            let mut radii = vec![muscle.rest_radius_m; self.count + 1];
            let mut force_n = 0.0;
            for step in 0..24 {
                let length_m = muscle.rest_length_m * (1.008 - 0.01 * f64::from(step));
                problem.solve(pressure_pa, length_m, &mut radii, &mut force_n)?;
                if force_n < 0.0 {
                    break;
                }
                most_n = most_n.max((self.parts(pressure_pa, length_m).total_n() - force_n).abs());
            }
        }
        Some(most_n)
    }

    /// Parts of the force.
    pub fn parts(&self, pressure_pa: f64, length_m: f64) -> Parts {
        let [gas_n, bladder_n, radius_m] = self.parts.at(pressure_pa, length_m);
        Parts { gas_n, bladder_n, radius_m }
    }
}

#[cfg(test)]
mod tests;
