//! Where a mismatch lies: intervals of a coordinate.

use pam_artifact::diagnosis::Region;
use pam_muscle::Coordinate;

use crate::coordinates::Coordinates;
use crate::hypothesis::CandidateEffect;
use crate::state::Setting;

/// Intervals that a coordinate is divided into.
const BINS: usize = 24;
/// One that does not belong to a region is bridged where the next one behind it has at least this share of the highest density: a residual
/// that changes its sign goes through zero.
const BEHIND_A_DIP: f64 = 0.3;
/// Share of the excess in a region that may lie beside either of its ends. With 2.5 %, and a tenth of the highest density for all, 26 of
/// the places that [`By::edge`] counts are met.
const BESIDE_ENDS: f64 = 2e-4;

/// What a mismatch is told by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// What a refitted base leaves more without an effect: it is a little wrong everywhere.
    Refit,
    /// The force itself that an effect or a smooth residual has.
    Force,
}

impl By {
    /// An interval belongs to a region as long as its density is at least this share of the highest. Of 66 known places of other
    /// worlds 40 are met; with a tenth of both, and intervals whole, 34, with 0.03 of both, and 0.2 % beside an end, 38.
    fn edge(self) -> f64 {
        match self {
            Self::Refit => 0.1,
            Self::Force => 0.03,
        }
    }
}

/// Where a mismatch lies over one coordinate.
#[derive(Debug)]
pub struct Place {
    /// The interval.
    pub region: Region,
    /// Whether it is all of the coordinate, which says nothing.
    pub is_everywhere: bool,
}

/// The interval of `coordinate` in which the mean of `excess` (in N² at every instant) is concentrated; none where there is
/// no excess. Time is looked at one recording after the other.
pub fn concentrated(
    setting: &Setting<'_>,
    coordinates: &Coordinates,
    coordinate: Coordinate,
    (excess, by): (&[f64], By),
    p_value: f64,
    paths: &[String],
) -> Option<Place> {
    let values = coordinates.of_kind(coordinate);
    let counted = &setting.track.counted;
    let all = 0..setting.track.n();
    let (within, recording) = if coordinate == Coordinate::Time {
        let sums: Vec<f64> = setting.track.recordings.iter().map(|range| sum(range.clone(), counted, excess)).collect();
        let (index, _) = sums.iter().enumerate().max_by(|left, right| left.1.total_cmp(right.1))?;
        // In one recording or in all alike: an event stays where it happened.
        (setting.track.recordings[index].clone(), Some(index))
    } else {
        (all.clone(), None)
    };
    let mut here: Vec<usize> = within.filter(|&at| counted[at] && values[at].is_finite()).collect();
    if here.len() < 10 * BINS {
        return None;
    }
    here.sort_by(|&left, &right| values[left].total_cmp(&values[right]));
    let (low, high) = (values[here[here.len() / 500]], values[here[here.len() - 1 - here.len() / 500]]);
    if high <= low {
        return None;
    }
    let edges = edges(coordinate, low, high);
    let mut sums = vec![0.0; edges.len() - 1];
    let mut counts = vec![0.0; edges.len() - 1];
    for &at in &here {
        let bin = edges.partition_point(|&edge| edge <= values[at]).clamp(1, sums.len()) - 1;
        sums[bin] += excess[at];
        counts[bin] += 1.0;
    }
    let fewest = 0.002 * here.len() as f64;
    let density: Vec<f64> = sums
        .iter()
        .zip(&counts)
        .map(|(sum, count)| if *count >= fewest { (sum / count).max(0.0) } else { 0.0 })
        .collect();
    let (peak, &highest) = density.iter().enumerate().max_by(|left, right| left.1.total_cmp(right.1))?;
    if highest <= 0.0 {
        return None;
    }
    let inside = |bin: usize| density[bin] >= by.edge() * highest || counts[bin] < fewest;
    let high_again = |bin: usize| density.get(bin).is_some_and(|density| *density >= BEHIND_A_DIP * highest);
    let mut first = peak;
    while first > 0 && (inside(first - 1) || (first > 1 && high_again(first - 2))) {
        first -= 1;
    }
    let mut last = peak;
    while last + 1 < density.len() && (inside(last + 1) || high_again(last + 2)) {
        last += 1;
    }
    // Empty intervals at the rim belong to nobody.
    while first < peak && counts[first] < fewest {
        first += 1;
    }
    while last > peak && counts[last] < fewest {
        last -= 1;
    }
    let (from, to) = ends(&here, values, excess, &edges[first..=last + 1]);
    let is_all_there_is = recording.is_none() || setting.track.recordings.len() == 1;
    let is_everywhere = is_all_there_is && first == 0 && last + 1 == density.len();
    let total = sum(all, counted, excess);
    let region = Region {
        coordinate,
        from,
        to,
        unit: coordinate.unit().to_owned(),
        share_of_excess: if total > 0.0 {
            (sums[first..=last].iter().sum::<f64>() / total).clamp(0.0, 1.0)
        } else {
            0.0
        },
        p_value,
        recording: recording.and_then(|index| paths.get(index).cloned()),
    };
    Some(Place { region, is_everywhere })
}

/// Between which values the excess of the instants `here`, in the order of their `values`, lies within `edges`, but for a little at either
/// end: within the first and the last of these intervals, which may be far wider than what acts there.
fn ends(here: &[usize], values: &[f64], excess: &[f64], edges: &[f64]) -> (f64, f64) {
    let last = edges.len() - 1;
    let (low, after_low, before_high, high) = (edges[0], edges[1], edges[last - 1], edges[last]);
    let first = here.partition_point(|&at| values[at] < low);
    let within = &here[first..first + here[first..].partition_point(|&at| values[at] <= high)];
    let most = BESIDE_ENDS * within.iter().map(|&at| excess[at].max(0.0)).sum::<f64>();
    let (from, to) = (reaches(within.iter(), excess, most), reaches(within.iter().rev(), excess, most));
    (from.map_or(low, |at| values[at].clamp(low, after_low)), to.map_or(high, |at| values[at].clamp(before_high, high)))
}

/// The first of `instants` up to which the sum of the excess is more than `most`.
fn reaches<'a>(mut instants: impl Iterator<Item = &'a usize>, excess: &[f64], most: f64) -> Option<usize> {
    let mut beyond = 0.0;
    instants
        .find(|&&at| {
            beyond += excess[at].max(0.0);
            beyond > most
        })
        .copied()
}

/// From the instant of `event` to the end of its recording, whose mismatch a fit without it spreads over all; none for a recording
/// that is not there.
pub fn from_event(
    setting: &Setting<'_>,
    event: &CandidateEffect,
    excess: &[f64],
    p_value: f64,
    paths: &[String],
) -> Option<Region> {
    let [index, instant_s] = event.shape[..] else { return None };
    let index = index.round() as usize;
    let range = setting.track.recordings.get(index)?;
    let time_s = |at: usize| setting.track.instants[at].moment.time_s;
    let after = range.start + setting.track.instants[range.clone()].partition_point(|at| at.moment.time_s < instant_s);
    let counted = &setting.track.counted;
    let (here, all) = (sum(after..range.end, counted, excess), sum(0..setting.track.n(), counted, excess));
    Some(Region {
        coordinate: Coordinate::Time,
        from: instant_s,
        to: time_s(range.end - 1),
        unit: Coordinate::Time.unit().to_owned(),
        share_of_excess: if all > 0.0 { (here / all).clamp(0.0, 1.0) } else { 0.0 },
        p_value,
        recording: paths.get(index).cloned(),
    })
}

fn sum(range: std::ops::Range<usize>, counted: &[bool], excess: &[f64]) -> f64 {
    range.filter(|&at| counted[at]).map(|at| excess[at]).sum()
}

/// Borders of the intervals: evenly spaced; in proportion for what spans decades.
fn edges(coordinate: Coordinate, low: f64, high: f64) -> Vec<f64> {
    let skewed =
        matches!(coordinate, Coordinate::Speed | Coordinate::TravelSinceReversal | Coordinate::TimeSinceLastMove);
    let share = |index: usize| index as f64 / BINS as f64;
    if skewed {
        let floor = high * 3e-3;
        let mut edges: Vec<f64> = (0..=BINS).map(|index| floor * (high / floor).powf(share(index))).collect();
        edges[0] = low.min(floor);
        edges
    } else {
        (0..=BINS).map(|index| low + share(index) * (high - low)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_acts_in_a_corner_of_a_wide_interval_ends_where_it_acts() {
        let values: Vec<f64> = (0..1000).map(f64::from).collect();
        let here: Vec<usize> = (0..1000).collect();
        let within = |from: f64, to: f64| -> Vec<f64> {
            values.iter().map(|value| if (from..to).contains(value) { 4.0 } else { 0.0 }).collect()
        };
        let edges = [0.0, 250.0, 500.0, 750.0, 1000.0];
        assert_eq!(ends(&here, &values, &within(3.0, 11.0), &edges[..2]), (3.0, 10.0));
        assert_eq!(ends(&here, &values, &within(100.0, 900.0), &edges), (100.0, 899.0));
        // No farther than the intervals at the ends.
        assert_eq!(ends(&here, &values, &within(400.0, 600.0), &edges), (250.0, 750.0));
        assert_eq!(ends(&here, &values, &[0.0; 1000], &edges), (0.0, 1000.0));
    }
}
