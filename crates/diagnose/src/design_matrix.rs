//! What a hypothesis makes of the track: moments in the muscle, columns of eq. 11, columns of the effects.

use std::ops::Range;

use pam_muscle::effects::{Base, Kind, Memory, Moment, Role};
use pam_muscle::force::ForceModel;
use pam_muscle::force::columns::{FRICTION, ForceColumns, N_COLUMNS};
use rayon::prelude::*;

use crate::hypothesis::{CandidateEffect, n_amplitudes};
use crate::track::Track;
use pam_muscle::shift::shift;

/// Rows of a hypothesis.
#[derive(Debug, Clone)]
pub struct DesignMatrix {
    /// Moments as the muscle sees them.
    pub seen: Vec<Moment>,
    /// What eq. 11 says there, with the parameters that the sheet was made with.
    pub base: Vec<Base>,
    /// Columns of eq. 11, and of the effects behind them, row-major.
    pub columns: Vec<f64>,
    /// Columns of a row.
    pub width: usize,
    /// Those of events, which come on top of what the cell reads.
    pub events: Vec<usize>,
}

/// Rows `instants` of `table`, row-major with so many columns, one after the other.
pub(crate) fn rows_of(table: &[f64], columns: usize, instants: &[usize]) -> Vec<f64> {
    let rows: Vec<&[f64]> = instants.iter().map(|&at| &table[at * columns..(at + 1) * columns]).collect();
    rows.concat()
}

impl DesignMatrix {
    /// Force at instant `at` that `weights` of the columns make, in N.
    pub fn force_n(&self, at: usize, weights: &[f64]) -> f64 {
        let row = &self.columns[at * self.width..(at + 1) * self.width];
        row.iter().zip(weights).map(|(column, weight)| column * weight).sum()
    }

    /// The part of it that events make, in N.
    pub fn events_n(&self, at: usize, weights: &[f64]) -> f64 {
        self.events.iter().map(|&event| self.columns[at * self.width + event] * weights[event]).sum()
    }
}

/// What does not change during a diagnosis.
#[derive(Debug)]
pub struct Regressors<'a> {
    /// The recordings.
    pub track: &'a Track,
    /// Columns of eq. 11.
    pub columns: &'a ForceColumns,
    /// Instants whose columns are wanted, the others' are zero; none where all are.
    pub only: Option<&'a [bool]>,
    /// Whether the slopes of the base are wanted where no effect of the hypothesis needs them.
    pub slopes: bool,
}

impl Regressors<'_> {
    /// The rows of `guesses`; what effects need of the base comes from `model`.
    pub fn sheet(&self, guesses: &[CandidateEffect], model: &ForceModel) -> DesignMatrix {
        let width = N_COLUMNS + n_amplitudes(guesses);
        let n = self.track.n();
        let mut sheet = DesignMatrix {
            seen: self.track.instants.iter().map(|instant| instant.moment).collect(),
            base: vec![Base::default(); n],
            columns: vec![0.0; n * width],
            width,
            events: events(guesses),
        };
        let DesignMatrix { seen, base, columns, .. } = &mut sheet;
        let (mut seen, mut base, mut columns) = (&mut seen[..], &mut base[..], &mut columns[..]);
        let parts: Vec<_> = self
            .track
            .recordings
            .iter()
            .enumerate()
            .map(|(recording, range)| Part {
                recording,
                range: range.clone(),
                seen: split_off(&mut seen, range.len()),
                base: split_off(&mut base, range.len()),
                columns: split_off(&mut columns, range.len() * width),
                width,
            })
            .collect();
        parts.into_par_iter().for_each(|part| self.fill(part, guesses, model));
        sheet
    }

    fn fill(&self, part: Part<'_>, guesses: &[CandidateEffect], model: &ForceModel) {
        let Part { recording, range, seen, base, columns, width } = part;
        shift(seen, &self.track.instants[range.clone()], delays_s(guesses));
        let mut walk = Walk::of(self, recording, guesses, model);
        for (((now, row), here), at) in seen.iter_mut().zip(columns.chunks_exact_mut(width)).zip(base).zip(range) {
            *here = walk.step(now, self.only.is_none_or(|only| only[at]), row);
        }
    }

    /// Columns of `guesses` as [`DesignMatrix::columns`]: those of the instants `listed`, which rise.
    pub fn columns_at(&self, guesses: &[CandidateEffect], model: &ForceModel, listed: &[usize]) -> Vec<f64> {
        let width = N_COLUMNS + n_amplitudes(guesses);
        let delays_s = delays_s(guesses);
        let mut columns = vec![0.0; listed.len() * width];
        let mut passing = vec![0.0; width];
        let mut rows = columns.chunks_exact_mut(width).zip(listed).peekable();
        let mut seen = Vec::new();
        for (recording, range) in self.track.recordings.iter().enumerate() {
            let instants = &self.track.instants[range.clone()];
            seen.clear();
            seen.extend(instants.iter().map(|instant| instant.moment));
            shift(&mut seen, instants, delays_s);
            let mut walk = Walk::of(self, recording, guesses, model);
            for (now, at) in seen.iter_mut().zip(range.clone()) {
                match rows.next_if(|(_, next)| **next == at) {
                    Some((row, _)) => walk.step(now, true, row),
                    None => walk.step(now, false, &mut passing),
                };
            }
        }
        columns
    }

    /// Columns of one more guess that only adds, over the moments of `sheet`, row-major: those of the instants `listed`, which rise.
    pub fn more_columns(
        &self,
        sheet: &DesignMatrix,
        guess: &CandidateEffect,
        model: &ForceModel,
        listed: &[usize],
    ) -> Vec<f64> {
        let n = guess.amplitudes().len();
        let mut columns = vec![0.0; listed.len() * n];
        let mut passing = vec![0.0; n];
        let mut rows = columns.chunks_exact_mut(n).zip(listed).peekable();
        for (recording, range) in self.track.recordings.iter().enumerate() {
            let mut memory = guess.start_in(recording, model.muscle());
            for at in range.clone() {
                let row = rows.next_if(|(_, next)| **next == at).map_or(&mut passing[..], |(row, _)| row);
                memory.pulls(&sheet.seen[at], &sheet.base[at], row);
            }
        }
        columns
    }

    /// By how much the columns of `guess` differ in every recording where the same recording went before; none of what is
    /// constant over a recording, which its tare stands for.
    pub fn beginnings(&self, sheet: &DesignMatrix, guess: &CandidateEffect, model: &ForceModel) -> Vec<Vec<f64>> {
        let n = guess.amplitudes().len();
        let mut columns = Vec::new();
        for range in &self.track.recordings {
            let moments = &sheet.seen[range.clone()];
            let (Some(first), Some(last)) = (moments.first(), moments.last()) else { continue };
            let lasted_s = last.time_s - first.time_s;
            let mut memory = guess.effect.start(model.muscle(), &guess.shape);
            let mut pass = |later_s: f64| {
                let mut rows = vec![0.0; range.len() * n];
                for ((moment, base), row) in
                    moments.iter().zip(&sheet.base[range.clone()]).zip(rows.chunks_exact_mut(n))
                {
                    memory.pulls(&Moment { time_s: moment.time_s + later_s, ..*moment }, base, row);
                }
                rows
            };
            let (once, again) = (pass(0.0), pass(lasted_s));
            for amplitude in 0..n {
                let change = |row: usize| again[row * n + amplitude] - once[row * n + amplitude];
                let (low, high) = (0..range.len())
                    .map(change)
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |range, value| (range.0.min(value), range.1.max(value)));
                if high - low > 1e-3 * high.abs().max(low.abs()) {
                    let mut column = vec![0.0; self.track.n()];
                    (0..range.len()).for_each(|row| column[range.start + row] = change(row));
                    columns.push(column);
                }
            }
        }
        columns
    }
}

/// Columns of `guesses` that are events.
pub fn events(guesses: &[CandidateEffect]) -> Vec<usize> {
    let mut events = Vec::new();
    let mut at = N_COLUMNS;
    for guess in guesses {
        let own = at..at + guess.amplitudes().len();
        at = own.end;
        if guess.effect.kind() == Kind::Event {
            events.extend(own);
        }
    }
    events
}

/// Delays of the pressure and the length channel in all `guesses` together, in s.
fn delays_s(guesses: &[CandidateEffect]) -> [f64; 2] {
    let shifts = guesses.iter().filter(|guess| guess.effect.role() == Role::Shift);
    shifts.fold([0.0; 2], |[pressure_s, length_s], guess| {
        let more_s = guess.effect.delays_s(&guess.shape);
        [pressure_s + more_s[0], length_s + more_s[1]]
    })
}

/// What effects make of one recording, moment by moment.
struct Walk<'a> {
    columns: &'a ForceColumns,
    model: &'a ForceModel,
    guesses: &'a [CandidateEffect],
    memories: Vec<Box<dyn Memory>>,
    slopes: bool,
    last: Option<Base>,
}

impl<'a> Walk<'a> {
    fn of(ground: &Regressors<'a>, recording: usize, guesses: &'a [CandidateEffect], model: &'a ForceModel) -> Self {
        Self {
            columns: ground.columns,
            model,
            guesses,
            memories: guesses.iter().map(|guess| guess.start_in(recording, model.muscle())).collect(),
            slopes: ground.slopes || guesses.iter().any(|guess| guess.effect.uses_slopes()),
            last: None,
        }
    }

    /// The base at the next moment, which becomes what the muscle sees of it; writes the columns of the effects to `row`, and where
    /// it is `wanted` those of eq. 11. Between wanted moments what the base was at the last one will do.
    fn step(&mut self, now: &mut Moment, wanted: bool, row: &mut [f64]) -> Base {
        for memory in &mut self.memories {
            memory.sees(now);
        }
        let mut slide = now.direction;
        for (guess, memory) in self.guesses.iter().zip(&mut self.memories) {
            if guess.effect.role() == Role::Slides {
                slide = memory.slides(now);
            }
        }
        if wanted {
            row[..N_COLUMNS].copy_from_slice(&self.columns.row(now.pressure_pa, now.length_m, 1.0));
            for friction in &mut row[FRICTION..N_COLUMNS] {
                *friction *= slide;
            }
        }
        let here = match self.last {
            Some(last) if !wanted => last,
            _ if self.slopes => Base::of(self.model, now.pressure_pa, now.length_m),
            _ => {
                let terms = self.model.terms(now.pressure_pa, now.length_m, 0.0);
                Base::from_terms(self.model, now.pressure_pa, now.length_m, &terms)
            }
        };
        self.last = Some(here);
        let mut at = N_COLUMNS;
        for (guess, memory) in self.guesses.iter().zip(&mut self.memories) {
            let n = guess.amplitudes().len();
            if guess.only_adds() {
                memory.pulls(now, &here, &mut row[at..at + n]);
            }
            at += n;
        }
        here
    }
}

/// Rows of one recording.
struct Part<'a> {
    recording: usize,
    range: Range<usize>,
    seen: &'a mut [Moment],
    base: &'a mut [Base],
    columns: &'a mut [f64],
    width: usize,
}

/// The first `n` of `slice`, which keeps the others.
fn split_off<'a, T>(slice: &mut &'a mut [T], n: usize) -> &'a mut [T] {
    slice.split_off_mut(..n).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::rehearsal::tests::Given;

    #[test]
    fn columns_at_some_instants_are_those_of_the_whole_matrix() {
        let given = Given::of(&["isobaric-triangles", "multisine"], &[]);
        let guesses = [
            given.guess("channel-delay", &[0.05, 0.0]),
            given.guess("pressure-lag", &[0.2, 0.0]),
            given.guess("rubber-hysteresis", &[2e-3]),
        ];
        let setting = given.setting().sampled();
        let ground = setting.ground();
        let sheet = ground.sheet(&guesses, &given.model);
        let listed: Vec<usize> = (0..given.track.n()).filter(|&at| given.track.sampled[at]).collect();
        let of_listed = listed.iter().flat_map(|&at| sheet.columns[at * sheet.width..(at + 1) * sheet.width].to_vec());
        let expected: Vec<f64> = of_listed.collect();
        assert!(expected.len() > 100 * sheet.width);
        assert_eq!(ground.columns_at(&guesses, &given.model, &listed), expected);
    }

    #[test]
    fn a_muscle_that_has_worked_begins_warm_and_cools() {
        let given = Given::of(&["isobaric-triangles"], &[]);
        let guess = given.guess("thermal-softening", &[200.0, 0.0]);
        let state = given.setting().fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let columns = given.setting().beginnings(&state, &guess);
        assert_eq!(columns.len(), given.track.recordings.len());
        for (column, range) in columns.iter().zip(&given.track.recordings) {
            let size = |at: usize| (column[at] / state.sheet.base[at].latex_n()).abs();
            assert!(size(range.start) > 1e-9 && size(range.end - 1) < size(range.start));
            assert!((0..column.len()).filter(|at| !range.contains(at)).all(|at| column[at] == 0.0));
        }
    }
}
