//! A mass that knocks where a drive starts, stops or turns.
//!
//! That lasts some tens of milliseconds, much of it where the direction is not settled: a grid smooths it over or does not count it.
//! Around each knock, the residual is cleared of a level, a slope and, until something explains that, what goes with the speed
//! (friction, damping, delays); what remains must be one mass times the acceleration behind one mount
//! ([`pam_muscle::effects::Mount`]), the same in all knocks.

mod line;

use crate::joint::HeldOut;
use crate::search::chance;
use crate::track::FOLDS;
use crate::uncertainty::jackknife_stderr;
use crate::verdict::Sizes;

use super::{Motion, MovingMass};

use line::Sums;
pub(super) use line::{Knock, Line};

/// Transients that are needed.
const LEAST_KNOCKS: usize = 8;
/// The largest mass may be passed by so much as long as its size is not all that well known.
const PASSED: f64 = 1.5;
/// Times the noise floor that it must amount to in them, root mean square.
const TIMES_FLOOR: f64 = 3.0;
/// Probability by chance that is still believed.
const CHANCE: f64 = 1e-3;
/// Rounds in which the frequency of the mount is looked for between its neighbors.
const ROUNDS: usize = 3;
/// Frequencies of the mount that are tried first, in Hz.
const MOUNTS_HZ: [f64; 8] = [12.0, 16.0, 20.0, 25.0, 30.0, 40.0, 60.0, 120.0];

/// What the residual around knocks may still hold beside them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Residual {
    /// Friction, damping or a delay that nobody has looked for yet: what goes with the speed is cleared away, and knees are
    /// averaged over some rows. A mass is found beside it whatever its mount, and its size less well: the speed takes up what
    /// the mount has of another shape.
    WithSpeed,
    /// All of that has been looked for without the knocks. A mass has been found; this is its size.
    Explained,
}

impl Residual {
    /// How many of level, slope and speed are cleared away.
    fn n_cleared(self) -> usize {
        match self {
            Self::WithSpeed => 3,
            Self::Explained => 2,
        }
    }

    /// Share of what is left in the knocks that one mass must explain where it was not fitted.
    fn least_explained(self) -> f64 {
        match self {
            Self::WithSpeed => 0.75,
            Self::Explained => 0.5,
        }
    }
}

/// The mass behind `knocks` in `n_rows` rows, where it matters.
pub(super) fn mass(knocks: &[Knock], n_rows: usize, sizes: &Sizes, residual: Residual) -> Option<MovingMass> {
    if knocks.len() < LEAST_KNOCKS {
        return None;
    }
    // Averaged as accelerations are, a knock keeps about half of its size.
    let matters_n = if sizes.limited { sizes.matters_n } else { 0.5 * sizes.matters_n };
    fitted(knocks, n_rows, sizes.floor_n, residual).filter(|mass| mass.all_rows_n > matters_n)
}

/// The mass that explains `knocks` in `n_rows` rows, where noise leaves `floor_n` of any model; none where there is none.
fn fitted(knocks: &[Knock], n_rows: usize, floor_n: f64, residual: Residual) -> Option<MovingMass> {
    let (mount_hz, sums) = mounted(knocks, residual);
    let rest = |fold: usize| sums.iter().enumerate().filter(move |(index, _)| index % FOLDS != fold);
    let others: Vec<f64> = (0..FOLDS).map(|fold| Sums::total(rest(fold).map(|(_, sums)| sums)).slope()).collect();
    let counts: Vec<f64> = sums.iter().map(|sums| sums.rows).collect();
    let without = HeldOut {
        blocks: sums.iter().map(|sums| sums.yy / sums.rows).collect(),
        counts: counts.clone(),
        floor_square: 0.0,
    };
    let with = HeldOut {
        blocks: sums.iter().enumerate().map(|(index, sums)| sums.left_by(others[index % FOLDS]) / sums.rows).collect(),
        counts,
        floor_square: 0.0,
    };
    let explained = without.mean_square() - with.mean_square();
    // The columns of the effect are the negative acceleration.
    let mass_kg = -Sums::total(&sums).slope();
    let (_, heaviest_kg) = MovingMass::effect().amplitudes()[0].range;
    let passed = if residual == Residual::WithSpeed { PASSED } else { 1.0 };
    let believed = mass_kg.abs() <= passed * heaviest_kg
        && explained > residual.least_explained() * (without.mean_square() - floor_n.powi(2))
        && explained > (TIMES_FLOOR * floor_n).powi(2)
        && chance(&without, &with) < CHANCE;
    let mut speeds: Vec<f64> = knocks.iter().map(|knock| knock.fastest_m_per_s).collect();
    speeds.sort_by(f64::total_cmp);
    believed.then(|| MovingMass {
        mass_kg,
        mass_stderr_kg: jackknife_stderr(others.iter().copied()),
        mount_hz,
        all_rows_n: (explained * Sums::total(&sums).rows / n_rows.max(1) as f64).sqrt(),
        without,
        with,
        motion: Motion::Knocks {
            touched: knocks.iter().map(|knock| knock.place.clone()).collect(),
            speeds_m_per_s: (speeds[speeds.len() / 20], speeds[speeds.len() - 1]),
        },
    })
}

/// The mount that explains most of `knocks`, in Hz, and the sums behind it.
fn mounted(knocks: &[Knock], residual: Residual) -> (f64, Vec<Sums>) {
    let tried = |mount_hz: f64| {
        let sums: Vec<Sums> = knocks.iter().map(|knock| knock.sums(mount_hz, residual)).collect();
        (Sums::total(&sums).left(), mount_hz, sums)
    };
    let better = |best: (f64, f64, Vec<Sums>), mount_hz: f64| {
        let trial = tried(mount_hz);
        if trial.0 < best.0 { trial } else { best }
    };
    let (softest, stiffest) = (MOUNTS_HZ[0], MOUNTS_HZ[MOUNTS_HZ.len() - 1]);
    let mut best = MOUNTS_HZ.into_iter().fold((f64::INFINITY, softest, Vec::new()), better);
    let mut factor: f64 = 1.12;
    for _ in 0..ROUNDS {
        let center = best.1;
        best = [center / factor, center * factor]
            .into_iter()
            .fold(best, |best, mount_hz| better(best, mount_hz.clamp(softest, stiffest)));
        factor = factor.sqrt();
    }
    (best.1, best.2)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use pam_muscle::smoothing::acceleration_weights;

    use super::*;

    const PERIOD_S: f64 = 0.005;
    /// Steps of the truth in one period.
    const FINE: usize = 50;

    /// Moves between two lengths with holds, at speeds that change from move to move. `pull` gives the force at a speed and an
    /// acceleration of an underdamped mount, which is another one than the fit has.
    fn line(pull: impl Fn(f64, f64) -> f64) -> Line {
        let mut line = Line::default();
        let (mut place_m, mut along_m, mut along_m_per_s) = (0.0, 0.0, 0.0);
        let rad_per_s = TAU * 30.0;
        let mut fine = Vec::new();
        for index in 0..24 {
            let speed = 0.02 * f64::from(1 + index % 5) * if index % 2 == 0 { 1.0 } else { -1.0 };
            for (drive_m_per_s, duration_s) in [(speed, 0.1), (0.0, 0.4)] {
                for _ in 0..(duration_s / PERIOD_S * FINE as f64).round() as usize {
                    let step_s = PERIOD_S / FINE as f64;
                    place_m += drive_m_per_s * step_s;
                    let acceleration = rad_per_s * (rad_per_s * (place_m - along_m) - 1.4 * along_m_per_s);
                    along_m_per_s += acceleration * step_s;
                    along_m += along_m_per_s * step_s;
                    fine.push((place_m, pull(drive_m_per_s, acceleration)));
                }
            }
        }
        let rows: Vec<(f64, f64)> = fine.iter().skip(FINE / 2).step_by(FINE).copied().collect();
        let weights = acceleration_weights(PERIOD_S);
        let half = weights.len() / 2;
        for at in 0..rows.len() {
            let place = |row: usize| rows[row.clamp(1, rows.len() - 2)].0;
            let bend = |row: usize| place(row + 1) - 2.0 * place(row) + place(row.max(1) - 1);
            let averaged: f64 =
                weights.iter().enumerate().map(|(index, weight)| weight * bend((at + index).max(half) - half)).sum();
            line.ends_s[1] = at as f64 * PERIOD_S;
            line.accelerations.push(averaged / (PERIOD_S * PERIOD_S));
            line.speeds.push((place(at + 8) - place(at.max(8) - 8)) / (16.0 * PERIOD_S));
            line.knees.push(false);
            line.residuals_n.push(rows[at].1);
        }
        line
    }

    fn found(pull: impl Fn(f64, f64) -> f64) -> Option<MovingMass> {
        let line = line(pull);
        let knocks = line.knocks(Residual::WithSpeed);
        assert!(knocks.len() >= 40, "{}", knocks.len());
        fitted(&knocks, line.accelerations.len(), 0.05, Residual::WithSpeed)
    }

    #[test]
    fn a_mass_is_found_behind_another_mount() {
        let knocks = found(|_, acceleration| -2.0 * acceleration).expect("a mass");
        assert!((knocks.mass_kg / 2.0 - 1.0).abs() < 0.2, "{knocks:?}");
    }

    #[test]
    fn damping_and_friction_are_no_mass() {
        assert!(found(|speed, _| 100.0 * speed).is_none());
        assert!(found(|speed, _| 5.0 * speed.signum() * f64::from(u8::from(speed != 0.0))).is_none());
        assert!(found(|_, _| 0.0).is_none());
    }

    #[test]
    fn what_differs_from_knock_to_knock_is_no_mass() {
        let sign = std::cell::Cell::new(0_u64);
        let odd = |_: f64, acceleration: f64| {
            sign.set(sign.get().wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
            acceleration * if sign.get() >> 63 == 0 { 1.0 } else { -1.0 }
        };
        assert!(found(odd).is_none());
    }
}
