//! Rows whose clock contradicts their neighbours, where such rows may be dropped.
//!
//! A serial link that loses its framing writes a stamp far back or far ahead. Of two runs of rows that
//! contradict each other the shorter is dropped: a stamp ahead is recognised by the rows after it, which
//! go on from before it. Rows can be taken back for as long as [`PROBATION_ROWS`] others; beyond that, what runs back
//! is what is wrong.

use std::collections::VecDeque;

use super::repair::Repairs;
use super::row_fault::RowFault;
use super::rows::Channels;

/// Rows that later ones may still prove wrong.
const PROBATION_ROWS: usize = 8;

/// A row and where it stood.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) line: u64,
    pub(crate) channels: Channels,
}

impl Row {
    fn time_s(&self) -> f64 {
        self.channels[0]
    }
}

/// Holds the latest rows back until their clock is beyond doubt.
#[derive(Debug, Default)]
pub(crate) struct ClockFilter {
    accepted: VecDeque<Row>,
    /// Rows that go on from before some of the accepted ones.
    challengers: Vec<Row>,
    /// Stamp of the last row let go.
    released_s: Option<f64>,
}

impl ClockFilter {
    /// Takes a row; moves those beyond doubt to `released`.
    pub(crate) fn admit(&mut self, row: Row, released: &mut Vec<Row>, repairs: &mut Repairs) {
        let last_s = self.accepted.back().map_or(f64::NEG_INFINITY, Row::time_s);
        if row.time_s() >= last_s {
            self.drop_challengers(repairs);
            self.accepted.push_back(row);
        } else if self.released_s.is_some_and(|released_s| row.time_s() < released_s) {
            repairs.skip(row.line, &RowFault::ClockRunsBack { before_s: last_s, time_s: row.time_s() });
        } else if let Some(before) = self.challengers.last().filter(|before| row.time_s() < before.time_s()) {
            repairs.skip(row.line, &RowFault::ClockRunsBack { before_s: before.time_s(), time_s: row.time_s() });
        } else {
            self.challengers.push(row);
            self.judge(repairs);
        }
        while self.accepted.len() > PROBATION_ROWS {
            self.release(released);
        }
    }

    /// Moves all rows that are left to `released`.
    pub(crate) fn finish(&mut self, released: &mut Vec<Row>, repairs: &mut Repairs) {
        self.drop_challengers(repairs);
        while !self.accepted.is_empty() {
            self.release(released);
        }
    }

    /// Lets the challengers win once they are more than the rows they contradict.
    fn judge(&mut self, repairs: &mut Repairs) {
        let Some(from_s) = self.challengers.first().map(Row::time_s) else { return };
        let contradicted = self.accepted.iter().rev().take_while(|row| row.time_s() > from_s).count();
        if self.challengers.len() > contradicted {
            for row in self.accepted.drain(self.accepted.len() - contradicted..) {
                repairs.skip(row.line, &RowFault::ClockJumpsAhead { time_s: row.time_s() });
            }
            self.accepted.extend(self.challengers.drain(..));
        }
    }

    fn drop_challengers(&mut self, repairs: &mut Repairs) {
        let last_s = self.accepted.back().map_or(f64::NEG_INFINITY, Row::time_s);
        for row in self.challengers.drain(..) {
            repairs.skip(row.line, &RowFault::ClockRunsBack { before_s: last_s, time_s: row.time_s() });
        }
    }

    fn release(&mut self, released: &mut Vec<Row>) {
        if let Some(row) = self.accepted.pop_front() {
            self.released_s = Some(row.time_s());
            released.push(row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stamps that are kept, and lines that are dropped.
    fn keep(stamps: &[f64]) -> (Vec<f64>, Vec<u64>) {
        let (mut filter, mut released, mut repairs) = (ClockFilter::default(), Vec::new(), Repairs::default());
        for (index, time_s) in stamps.iter().enumerate() {
            let row = Row { line: index as u64 + 1, channels: [*time_s, 0.0, 0.0, 0.0, 0.0] };
            filter.admit(row, &mut released, &mut repairs);
        }
        filter.finish(&mut released, &mut repairs);
        assert_eq!(released.len() as u64 + repairs.rows_skipped, stamps.len() as u64);
        let kept = released.iter().map(Row::time_s).collect();
        (kept, repairs.first_skipped.iter().map(|row| row.line).collect())
    }

    #[test]
    fn a_clock_that_only_goes_on_loses_nothing() {
        let stamps: Vec<f64> = (0..100).map(|index| f64::from(index / 2)).collect();
        assert_eq!(keep(&stamps), (stamps, vec![]));
    }

    #[test]
    fn stamps_far_back_are_dropped() {
        assert_eq!(keep(&[7.0, 8.0, 9.0, 0.5, 0.5, 10.0]), (vec![7.0, 8.0, 9.0, 10.0], vec![4, 5]));
    }

    #[test]
    fn a_stamp_far_ahead_is_dropped_and_not_the_rows_after_it() {
        assert_eq!(keep(&[1.0, 2.0, 900.0, 3.0, 4.0, 5.0]), (vec![1.0, 2.0, 3.0, 4.0, 5.0], vec![3]));
        assert_eq!(keep(&[1.0, 2.0, 900.0, 901.0, 3.0, 4.0, 5.0]), (vec![1.0, 2.0, 3.0, 4.0, 5.0], vec![3, 4]));
        assert_eq!(keep(&[900.0, 1.0, 2.0, 3.0]), (vec![1.0, 2.0, 3.0], vec![1]));
        assert_eq!(keep(&[1.0, 900.0, 2.0, 800.0, 3.0, 4.0]), (vec![1.0, 2.0, 3.0, 4.0], vec![2, 4]));
    }

    #[test]
    fn a_step_back_by_one_row_drops_that_row() {
        assert_eq!(keep(&[1.0, 2.0, 3.0, 2.5, 4.0, 5.0]), (vec![1.0, 2.0, 3.0, 4.0, 5.0], vec![4]));
    }

    #[test]
    fn a_clock_that_starts_anew_drops_what_follows() {
        let stamps: Vec<f64> = (0..50).chain(0..20).map(f64::from).collect();
        assert_eq!(keep(&stamps).0.len(), 50);
    }
}
