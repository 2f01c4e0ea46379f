//! Recordings that contradict one another: a gain that changed between them, or another muscle.
//!
//! Two recordings that pass through the same pressure and length should have the same force there, but for friction, damping and
//! memory. How much these make is in the recordings themselves: where one of them passes a place several times, its forces spread
//! over a loop. Forces at a place contradict one another by what is left once both may move within such a loop,
//!
//! ```text
//! gap - W,   gap = distance between the ranges of force of the two at a place,   W = width of nine in ten loops of both
//! ```
//!
//! and a gain, unlike friction, slack or a tare, does so at nearly every place. A load that changes the friction, a damper or a bladder
//! that slackens are physics, however much they make of the force; what only they could be is a note, not a fault.

use std::collections::BTreeMap;

use pam_muscle::Muscle;
use pam_recording::Recording;
use pam_recording::quality::RecordingQuality;

use super::Fault;
use super::channels::Look;
use crate::prepare::Gated;

/// Ratio of forces that drift and a little gain explain at most, beyond the loops. The worst of 400 virtual muscles, some with two
/// effects, comes to 1.16 beyond its loops and to 1.75 with them; a gain that doubled comes to 1.6 and more.
const MOST_DIFFERENT: f64 = 1.4;
/// Places that two recordings must share, and that must show how wide loops are.
const LEAST_PLACES: usize = 4;
/// Share of the places that a gain must contradict: it acts on all, but places of a few newtons drown in a tare.
const CONTRADICTED: f64 = 0.75;
/// Share of the loops that are no wider than the one which both recordings are granted.
const LOOPS: f64 = 0.9;
/// Shares of the highest pressure and force below which ratios mean nothing: slack, dead band and tare.
const LOW_PRESSURE: f64 = 0.3;
const LOW_FORCE: f64 = 0.15;

/// A cell of 4 % of the highest pressure and half a percent of contraction.
type Place = (i64, i64);

/// Forces at a place.
#[derive(Debug, Clone, Copy)]
struct Passed {
    lowest_n: f64,
    highest_n: f64,
    sum_n: f64,
    count: f64,
    /// How often the recording came there.
    passes: usize,
}

impl Passed {
    fn mean_n(&self) -> f64 {
        self.sum_n / self.count
    }
}

fn places(look: &Look, muscle: &Muscle, highest_pa: f64) -> BTreeMap<Place, Passed> {
    let mut places: BTreeMap<Place, Passed> = BTreeMap::new();
    let mut before = None;
    for (pressure_pa, length_m, force_n) in look.rows() {
        let place = (
            (25.0 * pressure_pa / highest_pa).round() as i64,
            (200.0 * muscle.contraction_ratio(length_m)).round() as i64,
        );
        let comes = before != Some(place);
        before = Some(place);
        if pressure_pa <= LOW_PRESSURE * highest_pa {
            continue;
        }
        let passed = places.entry(place).or_insert(Passed {
            lowest_n: f64::INFINITY,
            highest_n: f64::NEG_INFINITY,
            sum_n: 0.0,
            count: 0.0,
            passes: 0,
        });
        passed.lowest_n = passed.lowest_n.min(force_n);
        passed.highest_n = passed.highest_n.max(force_n);
        passed.sum_n += force_n;
        passed.count += 1.0;
        passed.passes += usize::from(comes);
    }
    places
}

/// Value below which `share` of `values` lie; none where there are too few.
fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    let at = (share * (values.len().max(1) - 1) as f64).round() as usize;
    (values.len() >= LEAST_PLACES).then(|| *values.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// Comparison of two recordings.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Compared {
    /// Median ratio of their mean forces.
    ratio: f64,
    /// Ratio that is left beyond their loops at all but a quarter of the places; none where nothing shows how wide loops are.
    beyond_loops: Option<f64>,
}

/// Compares the forces of one recording with those of another; none where they share too few places.
fn compare(here: &BTreeMap<Place, Passed>, other: &BTreeMap<Place, Passed>) -> Option<Compared> {
    let largest_n =
        |places: &BTreeMap<Place, Passed>| places.values().map(|passed| passed.highest_n).fold(0.0, f64::max);
    let least_n = LOW_FORCE * largest_n(here).min(largest_n(other));
    let shared: Vec<(Passed, Passed)> = here
        .iter()
        .filter_map(|(place, passed)| other.get(place).map(|there| (*passed, *there)))
        .filter(|(here, there)| here.mean_n() > least_n && there.mean_n() > least_n)
        .collect();
    let mut ratios: Vec<f64> = shared.iter().map(|(here, there)| here.mean_n() / there.mean_n()).collect();
    let ratio = quantile(&mut ratios, 0.5)?;
    let mut loops_n: Vec<f64> = here
        .values()
        .chain(other.values())
        .filter(|passed| passed.passes > 1)
        .map(|passed| passed.highest_n - passed.lowest_n)
        .collect();
    let beyond_loops = quantile(&mut loops_n, LOOPS).and_then(|loop_n| {
        // Above one where the force is larger here, as the ratio is; the loop comes off the larger force.
        let mut beyond: Vec<f64> = shared
            .iter()
            .map(|(here, there)| {
                let (lower, higher) = if ratio < 1.0 { (here, there) } else { (there, here) };
                (higher.lowest_n - loop_n) / lower.highest_n
            })
            .collect();
        let beyond = quantile(&mut beyond, 1.0 - CONTRADICTED)?.max(1.0);
        Some(if ratio < 1.0 { 1.0 / beyond } else { beyond })
    });
    Some(Compared { ratio, beyond_loops })
}

fn is_different(ratio: f64) -> bool {
    !(1.0 / MOST_DIFFERENT..=MOST_DIFFERENT).contains(&ratio)
}

/// Every pair of recordings that share places: indices of the later and of the earlier one.
fn pairs(
    recordings: &[(&Recording, &RecordingQuality)],
    muscle: &Muscle,
) -> std::io::Result<Vec<(usize, usize, Compared)>> {
    let highest_pa = recordings
        .iter()
        .filter_map(|(_, quality)| quality.channel("pressure"))
        .map(|channel| channel.highest)
        .fold(0.0, f64::max);
    let mut tables = Vec::new();
    let mut pairs = Vec::new();
    let with_force = |(_, (recording, _)): &(usize, &(&Recording, &RecordingQuality))| recording.samples.has_force();
    for (index, (recording, _)) in recordings.iter().enumerate().filter(with_force) {
        let here = places(&Look::at(recording)?, muscle, highest_pa);
        for (other, earlier) in &tables {
            if let Some(compared) = compare(&here, earlier) {
                pairs.push((index, *other, compared));
            }
        }
        tables.push((index, here));
    }
    Ok(pairs)
}

/// Recordings whose forces differ by more than their loops and a little drift make, at equal pressure and length.
///
/// # Errors
/// Where samples cannot be read back.
pub fn find(gates: &[Gated], muscle: &Muscle) -> std::io::Result<Option<Fault>> {
    let recordings: Vec<_> = gates.iter().map(|gate| (&gate.recording, &gate.quality)).collect();
    let different = pairs(&recordings, muscle)?.into_iter().find_map(|(index, other, compared)| {
        compared.beyond_loops.filter(|beyond| is_different(*beyond)).map(|_| (index, other, compared.ratio))
    });
    Ok(different.map(|(index, other, ratio)| Fault::Disagree {
        path: gates[index].recording.path.clone(),
        other: gates[other].recording.path.clone(),
        ratio,
    }))
}

/// Message about recordings whose forces differ, but by no more than their loops allow: a note for each pair.
///
/// # Errors
/// Where samples cannot be read back.
pub fn notes(recordings: &[(&Recording, &RecordingQuality)], muscle: &Muscle) -> std::io::Result<Vec<String>> {
    let pairs = pairs(recordings, muscle)?;
    let within = pairs
        .iter()
        .filter(|(.., compared)| is_different(compared.ratio) && !compared.beyond_loops.is_some_and(is_different));
    Ok(within
        .map(|(index, other, Compared { ratio, .. })| {
            format!(
                "{}: at equal pressure and length the force is {ratio:.2} times that of {}, which friction, damping or slack may \
                 do as well as a gain that changed between them",
                recordings[*index].0.path, recordings[*other].0.path
            )
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const LARGEST_N: f64 = 300.0;

    /// Places of a recording that runs up and down through `of` with a loop of `loop_n`, and with `gain` and `zero_n`.
    fn looped(of: std::ops::Range<i64>, gain: f64, zero_n: f64, [down_n, up_n]: [f64; 2]) -> BTreeMap<Place, Passed> {
        of.map(|place| {
            let middle_n = LARGEST_N - 12.0 * place as f64;
            let [lowest_n, highest_n] = [down_n, up_n].map(|off_n| gain * (middle_n + off_n) + zero_n);
            let passes = 1 + usize::from(down_n < up_n);
            ((20, place), Passed { lowest_n, highest_n, sum_n: lowest_n + highest_n, count: 2.0, passes })
        })
        .collect()
    }

    fn beyond(here: &BTreeMap<Place, Passed>, other: &BTreeMap<Place, Passed>) -> Option<f64> {
        compare(here, other).and_then(|compared| compared.beyond_loops)
    }

    #[test]
    fn a_gain_that_doubled_is_beyond_any_loop_and_the_two_sides_of_a_loop_are_not() {
        let both = looped(0..20, 1.0, 0.0, [-10.0, 10.0]);
        assert!(is_different(beyond(&looped(0..20, 2.0, 0.0, [-10.0, 10.0]), &both).unwrap()));
        assert!(is_different(beyond(&looped(0..20, 0.5, 0.0, [-10.0, 10.0]), &both).unwrap()));
        // The load makes the friction: loops of two thirds of the force, and a recording that only lengthens.
        let wide = looped(12..18, 1.0, 0.0, [-50.0, 50.0]);
        let up = looped(12..18, 1.0, 0.0, [50.0, 50.0]);
        let down = looped(12..18, 1.0, 0.0, [-50.0, -50.0]);
        assert!(is_different(compare(&up, &wide).unwrap().ratio));
        assert_eq!(beyond(&up, &wide), Some(1.0));
        assert_eq!(beyond(&down, &wide), Some(1.0));
        // Where neither shows a loop, nobody knows how much friction makes.
        assert!(is_different(compare(&up, &down).unwrap().ratio));
        assert_eq!(beyond(&up, &down), None);
    }

    #[test]
    fn a_tare_is_no_gain() {
        let tared = looped(0..20, 1.0, 60.0, [-10.0, 10.0]);
        assert!(!is_different(beyond(&tared, &looped(0..20, 1.0, 0.0, [-10.0, 10.0])).unwrap()));
    }
}
