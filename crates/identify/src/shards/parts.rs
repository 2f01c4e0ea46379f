//! Which rows of a recording that was cut are whose.

use std::ops::Range;

use pam_artifact::agreement::CutRecording;
use pam_muscle::direction::STRETCH_ROWS;
use pam_recording::CHUNK_ROWS;

/// Rows that are looked at beyond those that are counted, at least: what a late pressure is compared over.
pub(super) const BESIDE_ROWS: usize = 1024;

/// Rows that are worked on in one place: by a shard, or, where a cut divides them, by the place that merges.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// Index of the shard; none where a cut divides the rows.
    pub shard: Option<usize>,
    /// Rows that are counted: whole stretches of the direction.
    pub owned: Range<usize>,
    /// Rows that must be at hand: whole chunks, and some beside what is counted.
    pub held: Range<usize>,
}

/// Parts of a recording, in order; together they count every row once.
pub fn parts(recording: &CutRecording) -> Vec<Part> {
    let borders = borders(recording);
    let n_rows = recording.extent.n_rows;
    let mut parts: Vec<Part> = Vec::new();
    let mut done = 0;
    for (shard, &[start, end]) in recording.rows.iter().enumerate() {
        let has = |rows: &Range<usize>| start <= rows.start && rows.end <= end;
        let first = borders.iter().copied().find(|&border| border >= start && has(&held(border..border, n_rows)));
        let last = borders.iter().rev().copied().find(|&border| border <= end && has(&held(border..border, n_rows)));
        let Some(owned) = first.zip(last).map(|(first, last)| first..last).filter(|owned| !owned.is_empty()) else {
            continue;
        };
        if done < owned.start {
            parts.push(Part { shard: None, held: held(done..owned.start, n_rows), owned: done..owned.start });
        }
        done = owned.end;
        parts.push(Part { shard: Some(shard), held: held(owned.clone(), n_rows), owned });
    }
    if done < n_rows {
        parts.push(Part { shard: None, held: held(done..n_rows, n_rows), owned: done..n_rows });
    }
    parts
}

/// Rows of a shard that it hands over: its share of the parts that cuts divide.
pub fn edges(recording: &CutRecording, shard: usize) -> Vec<Range<usize>> {
    let [start, end] = recording.rows[shard];
    let divided = parts(recording).into_iter().filter(|part| part.shard.is_none());
    let share = divided.map(|part| part.held.start.max(start)..part.held.end.min(end));
    share.filter(|rows| rows.start < rows.end).collect()
}

/// Rows at which the direction remembers nothing but a state, and the last one.
fn borders(recording: &CutRecording) -> Vec<usize> {
    let starts = recording.segments.iter().flat_map(|&[start, end]| (start..end).step_by(STRETCH_ROWS));
    starts.chain([recording.extent.n_rows]).collect()
}

fn held(owned: Range<usize>, n_rows: usize) -> Range<usize> {
    let start = owned.start.saturating_sub(BESIDE_ROWS) / CHUNK_ROWS * CHUNK_ROWS;
    start..((owned.end + BESIDE_ROWS).div_ceil(CHUNK_ROWS) * CHUNK_ROWS).min(n_rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pam_artifact::summary::Shard;
    use pam_recording::Repairs;
    use pam_recording::quality::parts::Extent;

    fn cut(n_rows: usize, segments: &[usize], cuts: &[usize]) -> CutRecording {
        let ranges = |inner: &[usize]| {
            let bounds: Vec<usize> = [0].iter().chain(inner).chain([&n_rows]).copied().collect();
            bounds.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>()
        };
        let rows = ranges(cuts);
        let shard = Shard { recording: "r".into(), number: 1, of: 1, path: "p".into(), sha256: String::new() };
        CutRecording {
            name: "r".to_owned(),
            shards: vec![shard; rows.len()],
            rows,
            extent: Extent {
                n_rows,
                first_s: 0.0,
                last_s: 1.0,
                lowest: [0.0; 3],
                highest: [0.0; 3],
                largest_pressure_length_n_per_m: 0.0,
            },
            segments: ranges(segments),
            repairs: Repairs::default(),
            quality: None,
            excluded: Vec::new(),
        }
    }

    #[test]
    fn a_recording_that_is_not_cut_is_one_part_without_edges() {
        let whole = cut(700_000, &[1000, 300_000], &[]);
        let all = Part { shard: Some(0), owned: 0..700_000, held: 0..700_000 };
        assert_eq!((parts(&whole), edges(&whole, 0)), (vec![all], vec![]));
    }

    #[test]
    fn every_row_is_counted_once_and_every_shard_has_what_it_holds() {
        for (segments, cuts) in [
            (&[][..], &[400_000, 1_000_001][..]),
            (&[30_000, 60_100, 333_333], &[60_100, 60_101, 500_000]),
            (&[5, 10, 15], &[7, 900_000]),
        ] {
            let recording = cut(1_500_000, segments, cuts);
            let parts = parts(&recording);
            assert!(parts.iter().any(|part| part.shard.is_some()) && parts.iter().any(|part| part.shard.is_none()));
            let mut done = 0;
            for part in &parts {
                assert_eq!(part.owned.start, done);
                done = part.owned.end;
                assert!(part.held.start <= part.owned.start && part.owned.end <= part.held.end);
                if let Some(shard) = part.shard {
                    let [start, end] = recording.rows[shard];
                    assert!(start <= part.held.start && part.held.end <= end, "{part:?}");
                }
            }
            assert_eq!(done, 1_500_000);
        }
    }
}
