//! Where a path turns, to a fraction of its noise.

use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, DimName, DimSub, Dyn, OMatrix, OVector, Vector3};

/// Deviations of the noise in a threshold.
pub(super) const NOISE: f64 = 0.2;

/// Where a path turns: the vertex of the parabola or the corner of the two lines that describe it around there, whichever
/// leaves less.
pub(super) struct Turn {
    pub(super) row: usize,
    /// Rows by which that may be wrong: three deviations, and one row.
    pub(super) doubt: usize,
}

impl Turn {
    /// Most values that are fitted to.
    const MOST_VALUES: usize = 96;
    /// Times that the window is centered on the turn that was found.
    const ROUNDS: usize = 3;

    /// The turn around `row` of `raw`, after which it goes the way of `sign`, from as many rows on either side.
    /// `threshold` is five deviations of the noise. None where there is none.
    pub(super) fn of(raw: &[f64], row: usize, reach: usize, sign: i8, threshold: f64) -> Option<Self> {
        let noise = NOISE * threshold;
        let mut row = row;
        let mut doubt = 0.0;
        for _ in 0..Self::ROUNDS {
            let reach = reach.min(row).min(raw.len() - 1 - row);
            if reach < 4 {
                return None;
            }
            let values = &raw[row - reach..=row + reach];
            let stride = values.len().div_ceil(Self::MOST_VALUES);
            let (vertex, corner) = (vertex(values, stride), corner(values, stride, f64::from(sign)));
            // Of either the deviation where noise of that size lies on so many values.
            let per_value = noise * (stride as f64 / reach as f64).sqrt();
            let at = match (vertex, corner) {
                (Some((left, at, bend)), other)
                    if bend * f64::from(sign) > 0.0 && other.is_none_or(|(other, ..)| left < other) =>
                {
                    doubt = per_value / (bend * reach as f64);
                    at
                }
                (_, Some((_, at, bend))) => {
                    doubt = 2.0 * per_value / bend;
                    at as f64
                }
                _ => return None,
            };
            row = (row - reach) + at.clamp(0.0, 2.0 * reach as f64).round() as usize;
        }
        Some(Self { row, doubt: (3.0 * doubt.abs()).ceil() as usize + 1 })
    }
}

/// The parabola through `values`: squares that it leaves, its vertex in values from the first, its slope per value and value.
fn vertex(values: &[f64], stride: usize) -> Option<(f64, f64, f64)> {
    let middle = (values.len() / 2) as f64;
    let (left, weights) = fit(values, stride, values[0], |at| Vector3::new(1.0, at - middle, (at - middle).powi(2)))?;
    let bend = 2.0 * weights[2];
    let at = middle - weights[1] / bend;
    at.is_finite().then_some((left, at, bend))
}

/// Deviations by which one parabola must fall short of two. With 8 or 20, eq. 11 leaves as much of a hundred muscles of other worlds, to
/// half a percent.
const SURELY: f64 = 4.0;

/// Whether the parabola through `values` goes across something else at value `at`: whether two parabolas, before it and from there
/// on, surely leave less. `noise` is the deviation of a value.
pub(super) fn is_across(values: &[f64], at: usize, noise: f64) -> bool {
    let left = |values: &[f64]| {
        let middle = 0.5 * values.len() as f64;
        fit(values, 1, values[0], |at| Vector3::new(1.0, at - middle, (at - middle).powi(2))).map(|(left, _)| left)
    };
    let (before, after) = values.split_at(at);
    if before.len() < 4 || after.len() < 4 {
        return true;
    }
    let two = left(before).zip(left(after)).map(|(before, after)| before + after);
    left(values).zip(two).is_none_or(|(one, two)| one - two > (SURELY * noise).powi(2))
}

/// The two lines through `values` that meet where they leave least and turn there the way of `sign`: squares that they leave,
/// the corner, the change of the slope.
fn corner(values: &[f64], stride: usize, sign: f64) -> Option<(f64, usize, f64)> {
    let n = values.len();
    let lines = |corner: usize| {
        let from = corner as f64;
        let row = |at: f64| Vector3::new(1.0, (at - from).min(0.0), (at - from).max(0.0));
        fit(values, stride, values[corner], row).map(|(left, weights)| (left, corner, weights))
    };
    let corners = (n / 4..=n - 1 - n / 4).step_by(stride).filter_map(lines);
    let (left, corner, weights) = corners.min_by(|one, other| one.0.total_cmp(&other.0))?;
    let (before, after) = (sign * weights[1], sign * weights[2]);
    (after > 0.0 && before < 0.3 * after).then_some((left, corner, after - before))
}

/// Least squares of every `stride`-th of `values` less `origin`: squares that are left, and weights.
pub(super) fn fit<D>(
    values: &[f64],
    stride: usize,
    origin: f64,
    row: impl Fn(f64) -> OVector<f64, D>,
) -> Option<(f64, OVector<f64, D>)>
where
    D: DimName + DimSub<Dyn>,
    DefaultAllocator: Allocator<D, D> + Allocator<D>,
{
    let (mut normal, mut right, mut squares) = (OMatrix::<f64, D, D>::zeros(), OVector::<f64, D>::zeros(), 0.0);
    for (at, value) in values.iter().enumerate().step_by(stride) {
        let (row, value) = (row(at as f64), value - origin);
        normal.ger(1.0, &row, &row, 1.0);
        right.axpy(value, &row, 1.0);
        squares += value * value;
    }
    let weights = normal.cholesky()?.solve(&right);
    Some((squares - weights.dot(&right), weights))
}
