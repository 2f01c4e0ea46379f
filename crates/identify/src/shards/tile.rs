//! Rows that are worked on in one place.

use std::io;
use std::ops::Range;

use pam_artifact::agreement::CutRecording;
use pam_artifact::summary::{Ends, Rows};
use pam_muscle::direction::{Carried, Direction, Driver, Law, Piece, Thresholds};
use pam_recording::quality::RecordingQuality;
use pam_recording::{Recording, Samples};

use super::parts::Part;
use crate::prepare::Prepared;

/// Rows of a recording at hand, and those of them that are counted.
pub(super) struct Tile<'a> {
    /// The recording.
    pub(super) cut: &'a CutRecording,
    /// Its row that is the first one here.
    pub(super) first_row: usize,
    /// Rows here that are counted.
    pub(super) owned: Range<usize>,
    /// The rows; its segments are those of the counted ones.
    pub(super) recording: Recording,
    /// Whether the first row that is counted goes on in a segment.
    goes_on: bool,
}

/// A recording of `cut`'s name that holds these samples.
pub(super) fn recording_of(cut: &CutRecording, samples: Samples, segments: Vec<Range<usize>>) -> Recording {
    Recording {
        path: cut.name.clone(),
        sha256: String::new(),
        samples,
        segments,
        repairs: cut.repairs.clone(),
        ignored_columns: Vec::new(),
    }
}

/// Samples of rows that were handed over, one after the other.
pub(super) fn samples_of(rows: &[&Rows]) -> Samples {
    let column = |of: for<'r> fn(&'r Rows) -> &'r [f64]| -> Vec<f64> {
        rows.iter().flat_map(|rows| of(rows).iter().copied()).collect()
    };
    let time_s = column(|rows| &rows.time_s);
    let pressure_pa = column(|rows| &rows.pressure_pa);
    let length_m = column(|rows| &rows.length_m);
    let force_n = column(|rows| &rows.force_n);
    Samples::from_columns(&time_s, &pressure_pa, &length_m, &force_n)
}

/// `rows` of `samples` to hand over, the first of which is row `first_row` of the recording.
///
/// # Errors
/// Where samples cannot be read back.
pub(super) fn rows_of(samples: &Samples, first_row: usize, rows: Range<usize>) -> io::Result<Rows> {
    let mut handed = Rows { first_row: rows.start, ..Rows::default() };
    let rows = rows.start - first_row..rows.end - first_row;
    for part in samples.parts(rows) {
        let (chunk, here) = part?;
        handed.time_s.extend_from_slice(&chunk.time_s()[here.clone()]);
        handed.pressure_pa.extend_from_slice(&chunk.pressure_pa()[here.clone()]);
        handed.length_m.extend_from_slice(&chunk.length_m()[here.clone()]);
        handed.force_n.extend_from_slice(&chunk.force_n()[here]);
    }
    Ok(handed)
}

impl<'a> Tile<'a> {
    /// The rows of a `part` of `cut`, which `samples` holds.
    pub(super) fn of(cut: &'a CutRecording, part: &Part, samples: Samples) -> Self {
        let first_row = part.held.start;
        let within = |&[start, end]: &[usize; 2]| {
            let rows = start.max(part.owned.start)..end.min(part.owned.end);
            (rows.start < rows.end).then(|| rows.start - first_row..rows.end - first_row)
        };
        let segments: Vec<Range<usize>> = cut.segments.iter().filter_map(within).collect();
        let goes_on = cut.segments.iter().all(|segment| segment[0] != part.owned.start);
        let owned = part.owned.start - first_row..part.owned.end - first_row;
        Self { cut, first_row, owned, recording: recording_of(cut, samples, segments), goes_on }
    }

    /// What the rows begin with: `carried` where they go on in a segment.
    pub(super) fn begin(&self, carried: Carried) -> Carried {
        if self.goes_on { carried } else { Carried::UNKNOWN }
    }

    /// Quality of the whole recording.
    pub(super) fn quality(&self) -> Option<&RecordingQuality> {
        self.cut.quality.as_ref()
    }

    /// Directions after `carried`, under each of the `laws`, with where they end; of the rows before `until` alone.
    ///
    /// # Errors
    /// Where samples cannot be read back.
    pub(super) fn directions(
        &self,
        thresholds: Thresholds,
        carried: Carried,
        laws: &[Law],
        until: usize,
    ) -> io::Result<Vec<(Direction, Ends)>> {
        let begin = self.begin(carried);
        let pieces: Vec<Piece> = self
            .recording
            .segments
            .iter()
            .map(|rows| rows.start..rows.end.min(until))
            .filter(|rows| rows.start < rows.end)
            .map(|rows| Piece { carried: if rows.start == self.owned.start { begin } else { Carried::UNKNOWN }, rows })
            .collect();
        let n_rows = self.recording.samples.n_rows();
        let found = Direction::of_pieces(n_rows, &self.recording, &pieces, thresholds, Driver::Motion, laws)?;
        let ends = |(direction, carried): (Direction, Carried)| {
            let moves = direction.knows();
            (direction, Ends { carried, moves })
        };
        Ok(found.into_iter().map(ends).collect())
    }

    /// The direction under one set of thresholds, in a recording in which nothing moves if `at_rest`, without excluded samples.
    ///
    /// # Errors
    /// Where samples cannot be read back.
    pub(super) fn direction(
        &self,
        thresholds: Thresholds,
        carried: Carried,
        at_rest: bool,
    ) -> io::Result<(Direction, Ends)> {
        let laws = [Law::of(thresholds)];
        let (direction, ends) = self.directions(thresholds, carried, &laws, self.owned.end)?.remove(0);
        let mut direction = if at_rest { direction.at_rest() } else { direction };
        self.leave_out(&mut direction);
        Ok((direction, ends))
    }

    /// Leaves out what no fit may count.
    pub(super) fn leave_out(&self, direction: &mut Direction) {
        let here = self.first_row..self.first_row + self.recording.samples.n_rows();
        for &[start, end] in &self.cut.excluded {
            let rows = start.max(here.start)..end.min(here.end);
            if rows.start < rows.end {
                direction.leave_out(rows.start - here.start..rows.end - here.start);
            }
        }
    }

    /// The rows with a direction.
    pub(super) fn prepared(&self, quality: &RecordingQuality, direction: Direction) -> Prepared {
        Prepared { recording: self.recording.clone(), quality: quality.clone(), direction }
    }

    /// The rows that are counted, from the first that is a multiple of `stride` in the recording.
    pub(super) fn strided(&self, stride: usize) -> Range<usize> {
        let start = (self.first_row + self.owned.start).next_multiple_of(stride) - self.first_row;
        start.min(self.owned.end)..self.owned.end
    }
}
