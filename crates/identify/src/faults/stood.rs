//! A channel that stands at one value all through a recording and with which its force belongs to another muscle: a gauge that was
//! not connected, an encoder that stood, a value that was typed wrong.
//!
//! Most constant channels are right: a valve holds the pressure, a clamp the length, and somebody typed the set-point. So the
//! forces decide. A [smooth map](super::smooth_map) is fitted to all recordings, once with this one and once without. What it
//! leaves of this one when it may bend to it, and of the others when it need not, is friction and misfit in both, unless the
//! constant is wrong.

use std::io;

use super::Fault;
use super::channels::Look;
use super::smooth_map::{SmoothMap, Sums};
use crate::prepare::Gated;

/// How often as much as of the others the map may leave of the recording. Of 550 recordings in order the worst, taken as if a
/// channel of theirs were constant, comes to 2.1; a gauge that shows zero and an encoder that stands come to 25 and 13.
const MOST_LEFT: f64 = 5.0;
/// Share of the range of all forces that it must leave besides: a bench without friction or misfit leaves nothing of the others.
const LEAST_SHARE: f64 = 0.05;

/// Root mean square of what `map` leaves of `looks`.
fn left_n<'a>(map: &SmoothMap, looks: impl Iterator<Item = &'a Look>) -> f64 {
    let (mut squares, mut n) = (0.0, 0.0_f64);
    for (pressure_pa, length_m, force_n) in looks.flat_map(Look::rows) {
        squares += map.residual_n(pressure_pa, length_m, force_n).powi(2);
        n += 1.0;
    }
    (squares / n.max(1.0)).sqrt()
}

/// What a map leaves of the look at `index` that was fitted to all, and of the others that was fitted to them alone, in N.
fn with_and_without_n(looks: &[Look], index: usize) -> Option<(f64, f64)> {
    let rows = || looks.iter().flat_map(Look::rows);
    let highest_pa = rows().map(|row| row.0).fold(0.0, f64::max);
    let shortest_m = rows().map(|row| row.1).fold(f64::INFINITY, f64::min);
    let longest_m = rows().map(|row| row.1).fold(f64::NEG_INFINITY, f64::max);
    let mut sums = Sums::new(highest_pa, [shortest_m, longest_m]);
    let others = || looks.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, look)| look);
    for (pressure_pa, length_m, force_n) in others().flat_map(Look::rows) {
        sums.push(pressure_pa, length_m, force_n);
    }
    let without = sums.map()?;
    for (pressure_pa, length_m, force_n) in looks[index].rows() {
        sums.push(pressure_pa, length_m, force_n);
    }
    let with = sums.map()?;
    Some((left_n(&with, std::iter::once(&looks[index])), left_n(&without, others())))
}

/// Whether the forces of the look at `index` do not belong to those of the others; what is left of it and of them, in N.
fn belongs_elsewhere(looks: &[Look], index: usize) -> Option<(f64, f64)> {
    let (here_n, others_n) = with_and_without_n(looks, index)?;
    let forces = || looks.iter().flat_map(Look::rows).map(|row| row.2);
    let range_n = forces().fold(f64::NEG_INFINITY, f64::max) - forces().fold(f64::INFINITY, f64::min);
    (here_n > MOST_LEFT * others_n && here_n > LEAST_SHARE * range_n).then_some((here_n, others_n))
}

/// A recording one channel of which stands at a value that cannot be right.
///
/// # Errors
/// Where samples cannot be read back.
pub fn find(gates: &[Gated]) -> io::Result<Option<Fault>> {
    let with_force: Vec<&Gated> = gates.iter().filter(|gate| gate.recording.samples.has_force()).collect();
    let stands = |gate: &Gated| {
        [("pressure", 1e-3, "kPa"), ("length", 1e3, "mm")].into_iter().find_map(|(channel, scale, unit)| {
            let range = gate.quality.channel(channel)?;
            (range.highest <= range.lowest).then(|| (channel, format!("{:.2} {unit}", range.lowest * scale)))
        })
    };
    let standing: Vec<_> =
        with_force.iter().enumerate().filter_map(|(index, gate)| Some((index, stands(gate)?))).collect();
    // Where all of them stand, none is among others.
    if standing.is_empty() || standing.len() == with_force.len() {
        return Ok(None);
    }
    let looks: Vec<Look> = with_force.iter().map(|gate| Look::at(&gate.recording)).collect::<io::Result<_>>()?;
    Ok(standing.into_iter().find_map(|(index, (channel, value))| {
        let (here_n, others_n) = belongs_elsewhere(&looks, index)?;
        Some(Fault::Stood { path: with_force[index].recording.path.clone(), channel, value, here_n, others_n })
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A recording of a muscle with a loop of friction, as its channels show it.
    fn look(shows: impl Fn(f64, f64) -> (f64, f64)) -> Look {
        let rows = (0..500).map(|row| {
            let t = 0.05 * f64::from(row);
            let (pressure_pa, length_m) = (2.5e5 + 2e5 * (0.31 * t).sin(), 0.25 - 0.03 * (1.0 + (0.23 * t).cos()));
            let friction_n = 10.0 * (0.23 * t).sin().signum();
            let force_n = pressure_pa * 2e-3 * (length_m - 0.17) / 0.08 + 300.0 * (length_m - 0.25) - friction_n;
            let (pressure_pa, length_m) = shows(pressure_pa, length_m);
            (pressure_pa, length_m, force_n)
        });
        Look::of(rows)
    }

    #[test]
    fn a_gauge_that_shows_zero_and_an_encoder_that_stands_belong_elsewhere() {
        for shows in [|_, length_m| (0.0, length_m), |pressure_pa, _| (pressure_pa, 0.25)] as [fn(f64, f64) -> _; 2] {
            let looks = [look(|p, l| (p, l)), look(|p, l| (p, l)), look(shows)];
            assert!(belongs_elsewhere(&looks, 2).is_some());
            assert!(belongs_elsewhere(&looks, 0).is_none());
        }
    }

    #[test]
    fn a_clamp_that_holds_the_length_is_in_order() {
        let clamped = Look::of((0..500).map(|row| {
            let pressure_pa = 5e4 + 8e2 * f64::from(row);
            (pressure_pa, 0.25, pressure_pa * 2e-3 + 10.0)
        }));
        assert!(belongs_elsewhere(&[look(|p, l| (p, l)), clamped], 1).is_none());
    }
}
