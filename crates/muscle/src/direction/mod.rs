//! Direction in which friction acts: +1 after contracting, -1 after extending, and between the two while it turns over.
//!
//! Friction changes sign with the direction of motion, which a noisy velocity cannot give. The direction is therefore
//! a *play* on the length: it flips once the length has turned back by a threshold.
//!
//! In a recording the future is known, so a flip is dated back to where the motion turned. How exactly that
//! is known depends on the noise: around it the direction is *unsettled*, and a fit does not count those
//! samples, as little as those of a sensor that is out of its range.
//!
//! A turn is first the vertex of the parabola or the corner of the two lines that describe the length around it, whichever leaves
//! less: the play alone notices it a threshold late. Near there the length leaves its farthest point, as a path says that no
//! corner bends (`travel`): that is the turn, at the vertex where the path came from elsewhere and at the end of the rest where it
//! rested, and where the two disagree the direction is unsettled. After it friction keeps its
//! sign over some tens of micrometers ([`Thresholds::held_m`], the play of joints and strands) and goes to the other one within
//! some more ([`Thresholds::turn_m`], their give): what the recordings say.
//!
//! A length that stays within the play for a second stands still, unless it turns slowly or crawls all the while.
//! What friction does where it stands still and the pressure moves is a property of the muscle ([`Standstill`]): it
//! keeps its last sign, or sticks at the force that it has, or relaxes, or the strands slide under rising (+1, as if contracting) and falling
//! pressure (-1), at once or only after the pressure has turned back by some amount.
//! At the beginning of a segment nothing is known of it until the first
//! motion: the state is zero there and the samples are unsettled. In a segment in which nothing ever moves it stays zero, and
//! its samples count.
//!
//! # Design
//! The play acts on a centered moving average, because the range that white noise covers grows without end:
//! five standard deviations of the raw channel would flip within seconds of a hold. Five of the raw channel
//! are at least eleven of the average over [`WINDOW_S`] or five samples.

use std::io;
use std::ops::Range;

use pam_recording::Recording;
use rayon::prelude::*;

mod carried;
mod rest;
mod slow_turn;
mod states;
mod thresholds;
mod travel;
mod turn;

use states::{Bounds, State, Stretch, moving_average, rest};

pub use carried::{Carried, Piece};
pub use rest::STANDSTILL_S;
pub use states::{STICKS_FROM_PA, STICKS_UP_TO, WINDOW_S};
pub use thresholds::{Driver, Law, Standstill, Thresholds};

/// Rows that are worked on at a time, from the beginning of a segment on; across a border between two nothing is remembered but a
/// state.
pub const STRETCH_ROWS: usize = 1 << 18;

/// Direction of every row of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Direction {
    /// In hundredths.
    states: Vec<i16>,
    settled: Vec<bool>,
    /// Whether the direction is known at all: some motion came before it in its segment.
    known: Vec<bool>,
    /// Rows that no fit counts for another reason.
    left_out: Vec<Range<usize>>,
}

/// Beginnings that are tried on either side of zero.
const BEGINNINGS: i32 = 20;
/// Hundredths of a state.
const STEPS: f64 = 100.0;

impl Direction {
    /// Directions of `recording`.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn of(recording: &Recording, thresholds: Thresholds, driver: Driver) -> io::Result<Self> {
        Self::of_first(recording.samples.n_rows(), recording, thresholds, driver)
    }

    /// Directions of the first `n_rows` of `recording`.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn of_first(n_rows: usize, recording: &Recording, thresholds: Thresholds, driver: Driver) -> io::Result<Self> {
        Ok(Self::of_first_under(n_rows, recording, thresholds, driver, &[Law::of(thresholds)])?.remove(0))
    }

    /// The same under each of the `laws` in place of that of `thresholds`. All else is found once.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn of_first_under(
        n_rows: usize,
        recording: &Recording,
        thresholds: Thresholds,
        driver: Driver,
        laws: &[Law],
    ) -> io::Result<Vec<Self>> {
        let pieces = recording.segments.iter().map(|segment| Piece {
            rows: segment.start.min(n_rows)..segment.end.min(n_rows),
            carried: Carried::UNKNOWN,
        });
        let all = Self::of_pieces(n_rows, recording, &pieces.collect::<Vec<_>>(), thresholds, driver, laws)?;
        // Where nothing moves from beginning to end every sample counts, or none would.
        let counted = |(direction, _): (Self, Carried)| if direction.knows() { direction } else { direction.at_rest() };
        Ok(all.into_iter().map(counted).collect())
    }

    /// Directions of `pieces` of the first `n_rows` of `recording`, ascending, with what each of the `laws` carries on from the
    /// last of them. Rows beside them are unsettled. A piece that goes on in a segment begins a multiple of [`STRETCH_ROWS`] after
    /// it began, and ends there or with it: then its states are, to the bit, those that the whole segment has there.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn of_pieces(
        n_rows: usize,
        recording: &Recording,
        pieces: &[Piece],
        thresholds: Thresholds,
        driver: Driver,
        laws: &[Law],
    ) -> io::Result<Vec<(Self, Carried)>> {
        let empty = || Self {
            states: Vec::with_capacity(n_rows),
            settled: Vec::with_capacity(n_rows),
            known: Vec::with_capacity(n_rows),
            left_out: Vec::new(),
        };
        let mut all: Vec<(Self, Carried)> = laws.iter().map(|_| (empty(), Carried::UNKNOWN)).collect();
        for Piece { rows: piece, carried } in pieces {
            for (direction, ends) in &mut all {
                direction.skip_to(piece.start);
                *ends = *carried;
            }
            let starts: Vec<usize> = piece.clone().step_by(STRETCH_ROWS).collect();
            for starts in starts.chunks(rayon::current_num_threads()) {
                let read = |&start: &usize| rows(recording, &(start..(start + STRETCH_ROWS).min(piece.end)));
                let columns: Vec<Columns> = starts.par_iter().map(read).collect::<io::Result<_>>()?;
                let stretches: Vec<Option<Stretch<'_>>> = columns
                    .par_iter()
                    .map(|(time_s, pressure_pa, length_m)| {
                        (time_s.len() >= 2).then(|| Stretch::of(time_s, pressure_pa, length_m, thresholds, driver))
                    })
                    .collect();
                for stretch in stretches {
                    match stretch {
                        Some(stretch) => go_on(&stretch, thresholds, laws, &mut all),
                        // A row alone says nothing.
                        None => all.iter_mut().for_each(|(direction, before)| {
                            direction.extend(&[State { bounds: before.bounds(), is_settled: true }]);
                        }),
                    }
                }
            }
        }
        all.iter_mut().for_each(|(direction, _)| direction.skip_to(n_rows));
        Ok(all)
    }

    /// Of `n_rows` rows of which nothing is known.
    pub fn nothing(n_rows: usize) -> Self {
        let (states, settled) = (vec![0; n_rows], vec![false; n_rows]);
        Self { states, known: settled.clone(), settled, left_out: Vec::new() }
    }

    /// Leaves rows up to `row` unsettled and unknown.
    fn skip_to(&mut self, row: usize) {
        self.states.resize(row, 0);
        self.settled.resize(row, false);
        self.known.resize(row, false);
    }

    /// Assumes `state` wherever nothing is known.
    pub fn assume(&mut self, state: f64) {
        let hundredths = (STEPS * state).round() as i16;
        self.states.iter_mut().zip(&self.known).filter(|(_, known)| !**known).for_each(|(at, _)| *at = hundredths);
    }

    /// Number of rows up to the last of which nothing is known; none where all are known.
    pub fn unknown_until(&self) -> Option<usize> {
        self.known.iter().rposition(|known| !known).map(|row| row + 1)
    }

    /// Whether anything moves.
    pub fn knows(&self) -> bool {
        self.known.contains(&true)
    }

    /// The same where nothing moves in the whole recording: every sample counts, without friction until [`begun`](Self::begun) has
    /// taken it from the force.
    #[must_use]
    pub fn at_rest(mut self) -> Self {
        self.settled.fill(true);
        self
    }

    fn extend(&mut self, stretch: &[State]) {
        for State { bounds, is_settled } in stretch {
            self.states.push((STEPS * bounds.middle()).round() as i16);
            self.settled.push(*is_settled && bounds.is_known());
            self.known.push(bounds.is_known());
        }
    }

    /// Direction of a row, in [-1, 1], and up to [`STICKS_UP_TO`] where friction sticks and the pressure falls; 0 where it is not known.
    pub fn sign(&self, row: usize) -> f64 {
        f64::from(self.states[row]) / STEPS
    }

    /// Whether the direction of a row is certain and the row was not left out.
    pub fn is_settled(&self, row: usize) -> bool {
        self.settled[row]
    }

    /// Whether anything has moved since the segment of a row began.
    pub fn is_known(&self, row: usize) -> bool {
        self.known[row]
    }

    /// The same with what friction was at the beginning of every segment of `recording`, of which nothing is known but the force
    /// recorded there: among all beginnings the one under which the force comes nearest to it, where `forces_n` of row, pressure and
    /// length are those of state 0 and state 1. Samples stay settled or unsettled as they are. None where everything is known or no force
    /// was recorded.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn begun(
        &self,
        recording: &Recording,
        standstill: Standstill,
        forces_n: &dyn Fn(usize, f64, f64) -> [f64; 2],
    ) -> io::Result<Option<Self>> {
        if !recording.samples.has_force() || self.known.iter().all(|known| *known) {
            return Ok(None);
        }
        let mut begun = self.clone();
        for segment in &recording.segments {
            let unknown = self.known[segment.clone()].iter().take_while(|known| !**known).count();
            let unknown = segment.start..segment.start + unknown;
            if unknown.is_empty() {
                continue;
            }
            let (mut time_s, mut pressure_pa) = (Vec::new(), Vec::new());
            let (mut without_n, mut with_n) = (Vec::new(), Vec::new());
            for part in recording.samples.parts(unknown.clone()) {
                let (chunk, rows) = part?;
                for row in rows {
                    let (pressure, length) = (chunk.pressure_pa()[row], chunk.length_m()[row]);
                    let [neither_n, one_n] = forces_n(chunk.first_row() + row, pressure, length);
                    time_s.push(chunk.time_s()[row]);
                    pressure_pa.push(pressure);
                    without_n.push(chunk.force_n()[row] - neither_n);
                    with_n.push(one_n - neither_n);
                }
            }
            let smooth_pa = moving_average(&pressure_pa, 2);
            let left = |states: &[State]| -> f64 {
                let rows = states.iter().zip(without_n.iter().zip(&with_n));
                rows.map(|(state, (without, with))| (without - state.bounds.middle() * with).powi(2)).sum()
            };
            let beginnings = (-BEGINNINGS..=BEGINNINGS).map(|index| f64::from(index) / f64::from(BEGINNINGS));
            let paths = beginnings.map(|state| {
                let mut states = vec![State { bounds: Bounds::at(state), is_settled: false }; unknown.len()];
                if standstill.is_moved() {
                    rest((&time_s, &smooth_pa), standstill, Bounds::at(state), &mut states);
                }
                (left(&states), states)
            });
            if let Some((least, states)) = paths.min_by(|one, other| one.0.total_cmp(&other.0))
                && least.is_finite()
            {
                for (row, state) in unknown.zip(states) {
                    begun.states[row] = (STEPS * state.bounds.middle()).round() as i16;
                }
            }
        }
        Ok(Some(begun))
    }

    /// Leaves `rows` out, whose directions stay what they are.
    ///
    /// # Panics
    /// Where there are not that many rows.
    pub fn leave_out(&mut self, rows: Range<usize>) {
        self.settled[rows.clone()].fill(false);
        self.left_out.push(rows);
    }

    /// Rows that were left out, in no order.
    pub fn left_out(&self) -> &[Range<usize>] {
        &self.left_out
    }

    /// Rows whose direction is not certain or that were left out.
    pub fn n_unsettled(&self) -> usize {
        self.settled.iter().filter(|settled| !**settled).count()
    }

    /// Times that the direction flips.
    pub fn n_reversals(&self) -> usize {
        self.states.windows(2).filter(|pair| pair[0].signum() * pair[1].signum() < 0).count()
    }
}

/// Lets the directions under every one of the `laws` go on along a `stretch`, each from what it carries. What is the same for several
/// of them is found once.
fn go_on(stretch: &Stretch<'_>, thresholds: Thresholds, laws: &[Law], all: &mut [(Direction, Carried)]) {
    type Going<'a> = (&'a Law, &'a mut (Direction, Carried));
    let mut groups: Vec<(Standstill, Bounds, Vec<Going<'_>>)> = Vec::new();
    for (law, going) in laws.iter().zip(all) {
        let (standstill, carried) = (law.standstill, going.1.bounds());
        match groups.iter_mut().find(|group| group.0 == standstill && group.1 == carried) {
            Some(group) => group.2.push((law, going)),
            None => groups.push((standstill, carried, vec![(law, going)])),
        }
    }
    groups.into_par_iter().for_each(|(standstill, carried, going)| {
        let states = stretch.states(standstill, carried);
        let path = stretch.path(&states);
        going.into_par_iter().for_each(|(law, (direction, before))| {
            let turned = stretch.turned(&states, path.as_deref(), law.within(thresholds), carried);
            *before = turned.last().map_or(*before, |state| Carried::of(state.bounds));
            direction.extend(&turned);
        });
    });
}

type Columns = (Vec<f64>, Vec<f64>, Vec<f64>);

/// Time, pressure and length of `rows`.
fn rows(recording: &Recording, rows: &Range<usize>) -> io::Result<Columns> {
    let (mut time_s, mut pressure_pa, mut length_m) = (Vec::new(), Vec::new(), Vec::new());
    for part in recording.samples.parts(rows.clone()) {
        let (chunk, rows) = part?;
        time_s.extend_from_slice(&chunk.time_s()[rows.clone()]);
        pressure_pa.extend_from_slice(&chunk.pressure_pa()[rows.clone()]);
        length_m.extend_from_slice(&chunk.length_m()[rows]);
    }
    Ok((time_s, pressure_pa, length_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pam_recording::{Repairs, Samples};

    const HELD: Thresholds =
        Thresholds { length_m: 1e-4, pressure_pa: 1e3, held_m: 0.0, turn_m: 0.0, standstill: Standstill::Held };

    /// Lengths at 100 Hz and constant pressure, with a gap of 5 s before row `gap`.
    fn recording(length_m: &[f64], gap: usize) -> Recording {
        let n = length_m.len();
        let time_s: Vec<f64> = (0..n).map(|row| 0.01 * row as f64 + if row < gap { 0.0 } else { 5.0 }).collect();
        Recording {
            path: "gap.csv".to_owned(),
            sha256: String::new(),
            samples: Samples::from_columns(&time_s, &vec![2e5; n], length_m, &vec![100.0; n]),
            segments: vec![0..gap, gap..n],
            repairs: Repairs::default(),
            ignored_columns: Vec::new(),
        }
    }

    #[test]
    fn after_a_gap_nothing_is_known_until_something_moves() {
        // Contracting for 2 s, a gap, at rest for 2 s, extending for 2 s.
        let length_m: Vec<f64> = (0..600)
            .map(|row| match row {
                0..200 => 0.26 - 5e-5 * f64::from(row),
                200..400 => 0.24,
                _ => 0.24 + 5e-5 * f64::from(row - 400),
            })
            .collect();
        let direction = Direction::of(&recording(&length_m, 200), HELD, Driver::Motion).expect("directions");
        assert!(direction.is_known(150) && direction.is_settled(150) && direction.sign(150) > 0.0);
        assert!((210..380).all(|row| !direction.is_known(row) && !direction.is_settled(row)));
        assert!(direction.is_settled(550) && direction.sign(550) < 0.0);
    }

    #[test]
    fn a_segment_that_never_moves_is_unknown_beside_one_that_does_and_counts_where_none_does() {
        let of = |travel_m: f64| {
            let length_m: Vec<f64> = (0..400).map(|row| 0.26 - travel_m * f64::from(row.min(200)) / 200.0).collect();
            Direction::of(&recording(&length_m, 200), HELD, Driver::Motion).expect("directions")
        };
        let counts = |direction: &Direction| [190, 300].map(|row| direction.is_settled(row));
        let known = |direction: &Direction| [190, 300].map(|row| direction.is_known(row));
        let (moves, rests) = (of(0.01), of(0.0));
        assert_eq!((counts(&moves), known(&moves)), ([true, false], [true, false]));
        assert_eq!((counts(&rests), known(&rests)), ([true, true], [false, false]), "friction is what the force says");
    }
}
