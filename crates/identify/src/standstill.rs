//! Which law the friction of a muscle follows while its length stands still, and after a reversal, judged by its recordings.
//!
//! Every law gives the same columns of eq. 11 other signs of friction where the length rests and the pressure moves. The law
//! that leaves least of the force, with weights free of bounds so that no start of a search matters, is taken; samples
//! before the first motion, whose friction nobody knows, count without friction under every law.

use std::cell::OnceCell;
use std::io;
use std::ops::Range;

use pam_artifact::model::StandstillFit;
use pam_muscle::direction::{Direction, Driver, Law, Standstill, Thresholds};
use pam_muscle::force::Form;
use pam_muscle::force::columns::{ForceColumns, N_COLUMNS};
use pam_optim::gathered::Gathered;
use pam_optim::summary::Summary;
use pam_recording::CHUNK_ROWS;
use rayon::prelude::*;

use crate::error::IdentifyError;
use crate::prepare::Prepared;

/// Pressures over which friction may turn over, in Pa; nothing for any change that is not noise.
const OVER_PA: [f64; 6] = [0.0, 1e4, 2e4, 4e4, 8e4, 1.6e5];

/// The law in the middle of them all. Where recordings hardly tell, an error towards either end, friction that is held and friction that
/// follows at once, costs least from here. With 20 or 80 kPa in its place, before all others that are not clearly better, eq. 11 leaves 1 % more
/// of 80 healthy muscles of other worlds in the mean, and as much of 240 others, to half a percent.
const MIDDLE: Standstill = Standstill::Slides { over_pa: MIDDLE_PA, share: 1.0 };
/// See [`MIDDLE`].
const MIDDLE_PA: f64 = 4e4;
/// How many times more or less pressure is near that, where what recordings tell decides.
const NEAR: f64 = 2.0;

/// Shares of the friction that the pressure may bring about, less than all of it.
const SHARES: [f64; 4] = [0.8, 0.6, 0.4, 0.2];

/// Those of them that are looked at first, and the pressures.
const FEW: [f64; 2] = [0.8, 0.4];
/// See [`FEW`].
const FEW_PA: [f64; 3] = [1e4, 4e4, 1.6e5];

/// Travels over which friction may keep its sign after a reversal, and in which it may turn over after that, in m. What takes
/// longer is pre-sliding, an effect with a name.
const HELD_M: [f64; 5] = [0.0, 1e-5, 2e-5, 3e-5, 4.5e-5];
/// See [`HELD_M`].
const TURNS_M: [f64; 6] = [0.0, 1e-5, 2e-5, 3.5e-5, 5e-5, 1e-4];

/// Share of the play below which a finer one is another hypothesis.
const FINER: f64 = 0.5;

/// Rows that the laws are compared on, at most.
const MOST_ROWS: usize = 60_000;
/// Rows that travels are compared on, at most, the first of every recording: they show around reversals, at the full rate.
const TURNING_ROWS: usize = 200_000;

/// Share of the mean square that a law far from the middle must gain over that one.
const CLEARLY: f64 = 0.01;

/// Share of the mean square that a law must gain over all others which takes up what is none of friction's: friction of which the pressure
/// turns only a share, beside a pressure that is late, as that too answers every change of the pressure while the length rests; two real
/// muscles, whose friction turns over wholly, gain 2 % at most. And friction that sticks, which goes with one over the pressure, as does much
/// of what a wrong pressure leaves: of 272 looked-at muscles of two strangers it gains more in 29 of the 48 whose friction
/// sticks, and in five of the others. A diagnosis judges once more beside what it names, and then 43 of the 48 have it.
const BY_ITSELF: f64 = 0.05;
/// Time over which a change of the pressure is taken, in s: that of a delay or a lag that instruments have.
const LATE_S: f64 = 0.05;

/// The same for a travel in which friction turns over, which shows in a few samples only.
const HARDLY: f64 = 5e-4;

/// Every law with what it leaves, the one to be taken first.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn judge(
    recordings: &[&Prepared],
    columns: &ForceColumns,
    thresholds: Thresholds,
) -> Result<Vec<StandstillFit>, IdentifyError> {
    let stride = stride(recordings.iter().map(|prepared| prepared.recording.samples.n_rows()).sum());
    let late = OnceCell::new();
    judge_by(&|laws: Vec<Standstill>, is_late: bool| {
        let late: Option<&Vec<Vec<f64>>> = if is_late {
            let changes: Result<Vec<Vec<f64>>, IdentifyError> =
                recordings.iter().map(|prepared| changes_pa(prepared)).collect();
            let changes = changes?;
            Some(late.get_or_init(|| changes))
        } else {
            None
        };
        let under = |standstill: &Standstill| Law { standstill: *standstill, ..Law::of(thresholds) };
        let asked: Vec<Law> = laws.iter().map(under).collect();
        let counts = Counts::Settled(stride);
        let left = mean_squares(recordings, columns, thresholds, &asked, counts, late.map(Vec::as_slice))?;
        let fitted = |(standstill, left): (Standstill, f64)| StandstillFit { standstill, rmse_n: left.sqrt() };
        Ok(laws.into_iter().zip(left).map(fitted).collect())
    })
}

/// The laws that are compared first: those under which the pressure turns over all of the friction, or none.
pub fn laws() -> Vec<Standstill> {
    let slides = OVER_PA.map(|over_pa| Standstill::Slides { over_pa, share: 1.0 });
    slides.into_iter().chain([Standstill::Held, Standstill::Sticks]).collect()
}

/// Laws under which the pressure turns over a share of the friction: the few that are looked at first.
pub fn few_laws() -> Vec<Standstill> {
    partly(&FEW_PA, &FEW)
}

fn partly(over_pa: &[f64], shares: &[f64]) -> Vec<Standstill> {
    let law = |&over_pa: &f64| shares.iter().map(move |&share| Standstill::Slides { over_pa, share });
    over_pa.iter().flat_map(law).collect()
}

/// Every law with what it leaves, the one to be taken first; `fitted` gives what laws leave, beside a late pressure if so asked.
///
/// # Errors
/// Those of `fitted`.
pub fn judge_by<E>(
    fitted: &dyn Fn(Vec<Standstill>, bool) -> Result<Vec<StandstillFit>, E>,
) -> Result<Vec<StandstillFit>, E> {
    let mut judged = fitted(laws(), false)?;
    sort(&mut judged);
    let most = (1.0 - BY_ITSELF).sqrt();
    // Where no few of them gain anything near it, none of the others is looked at.
    let promises =
        least(fitted(few_laws(), false)?).is_some_and(|law| law.rmse_n < (1.0 - CLEARLY).sqrt() * judged[0].rmse_n);
    let best = if promises { least(fitted(partly(&OVER_PA[1..], &SHARES), false)?) } else { None };
    if let Some(best) = best.filter(|best| best.rmse_n < most * judged[0].rmse_n) {
        let wholly = least(fitted(laws(), true)?);
        let partly = least(fitted(vec![best.standstill], true)?);
        if partly.zip(wholly).is_some_and(|(partly, wholly)| partly.rmse_n < most * wholly.rmse_n) {
            judged.insert(0, best);
        }
    }
    Ok(judged)
}

/// Brings them into the order in which they are to be taken, those that leave least first. As good is not better: a law farther from the
/// middle than [`NEAR`] comes after those within unless it leaves clearly less than the middle one, and of laws that leave the same the
/// nearest to the middle is first. Friction that sticks waits unless it leaves less by [`BY_ITSELF`] than all others.
fn sort(laws: &mut [StandstillFit]) {
    let others = laws.iter().filter(|law| law.standstill != Standstill::Sticks);
    let most_of_sticks_n = others.map(|law| law.rmse_n).fold(f64::INFINITY, f64::min) * (1.0 - BY_ITSELF).sqrt();
    let most_n = laws.iter().find(|law| law.standstill == MIDDLE).map_or(f64::INFINITY, |law| law.rmse_n)
        * (1.0 - CLEARLY).sqrt();
    let away = |law: &StandstillFit| match law.standstill {
        Standstill::Slides { over_pa, .. } if over_pa > 0.0 => (over_pa / MIDDLE_PA).max(MIDDLE_PA / over_pa),
        _ => f64::INFINITY,
    };
    let waits = |law: &StandstillFit| match law.standstill {
        Standstill::Sticks => law.rmse_n > most_of_sticks_n,
        _ => away(law) > NEAR && law.rmse_n > most_n,
    };
    laws.sort_by(|one, other| {
        let by_rmse = one.rmse_n.total_cmp(&other.rmse_n);
        waits(one).cmp(&waits(other)).then(by_rmse).then(away(one).total_cmp(&away(other)))
    });
}

fn least(laws: Vec<StandstillFit>) -> Option<StandstillFit> {
    laws.into_iter().min_by(|one, other| one.rmse_n.total_cmp(&other.rmse_n))
}

/// What the pressure changes by within [`LATE_S`] around every row, in Pa.
pub(crate) fn changes_pa(prepared: &Prepared) -> Result<Vec<f64>, IdentifyError> {
    let samples = &prepared.recording.samples;
    let n_rows = samples.n_rows();
    let mut pressure_pa = Vec::with_capacity(n_rows);
    while pressure_pa.len() < n_rows {
        let chunk = samples.chunk(pressure_pa.len() / CHUNK_ROWS).map_err(|reason| unreadable(prepared, reason))?;
        pressure_pa.extend_from_slice(chunk.pressure_pa());
    }
    let half = ((0.5 * LATE_S / prepared.quality.period_s).round() as usize).max(1);
    let change = |row: usize| pressure_pa[(row + half).min(n_rows - 1)] - pressure_pa[row.saturating_sub(half)];
    Ok((0..n_rows).map(change).collect())
}

/// Whether `laws` leave the same: nothing that they were judged by tells them apart.
pub fn is_undecided(laws: &[StandstillFit]) -> bool {
    let of = |law: &StandstillFit| law.rmse_n * law.rmse_n;
    let (least, most) =
        laws.iter().map(of).fold((f64::INFINITY, 0.0), |(low, high), left| (f64::min(low, left), f64::max(high, left)));
    laws.len() > 1 && least > (1.0 - CLEARLY) * most
}

/// `thresholds` with the travels in which friction turns over after a reversal: those of [`HELD_M`] and [`TURNS_M`] that leave
/// least of the force; none where nothing is clearly gained. What shakes a length at rest may be its sensor, or a tremor of the
/// muscle that turns friction over with every swing: where white noise alone asks for a much finer play, `finest_m`, the force
/// says which.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn turning(
    recordings: &[&Prepared],
    columns: &ForceColumns,
    thresholds: Thresholds,
    finest_m: f64,
) -> Result<Thresholds, IdentifyError> {
    let first = turning_rows(recordings.len());
    let laws = turning_laws(thresholds);
    let mut judged = Vec::new();
    for length_m in turning_plays_m(thresholds, finest_m) {
        let thresholds = Thresholds { length_m, ..thresholds };
        judged.extend(mean_squares(recordings, columns, thresholds, &laws, Counts::First(first), None)?);
    }
    Ok(turning_of(&judged, thresholds, finest_m))
}

/// Laws that are compared after a reversal, that without travels first; at a standstill that of `thresholds`.
pub fn turning_laws(thresholds: Thresholds) -> Vec<Law> {
    let travels = HELD_M.iter().flat_map(|&held_m| TURNS_M.map(|turn_m| (held_m, turn_m)));
    travels.map(|(held_m, turn_m)| Law { held_m, turn_m, ..Law::of(thresholds) }).collect()
}

/// Rows of each of `n_recordings` that travels are compared on, its first ones.
pub fn turning_rows(n_recordings: usize) -> usize {
    TURNING_ROWS / n_recordings.max(1)
}

/// Plays of the length under which travels are compared, in m.
pub fn turning_plays_m(thresholds: Thresholds, finest_m: f64) -> Vec<f64> {
    let finest = (finest_m < FINER * thresholds.length_m).then_some(finest_m);
    std::iter::once(thresholds.length_m).chain(finest).collect()
}

/// `thresholds` with the play and the travels that leave least, of the mean squares `left` for every one of the
/// [plays](turning_plays_m) and, within it, of the [laws](turning_laws).
pub fn turning_of(left: &[f64], thresholds: Thresholds, finest_m: f64) -> Thresholds {
    let laws = turning_laws(thresholds);
    let tried = turning_plays_m(thresholds, finest_m)
        .into_iter()
        .flat_map(|length_m| laws.iter().map(move |law| law.within(Thresholds { length_m, ..thresholds })));
    let judged: Vec<(f64, Thresholds)> = left.iter().copied().zip(tried).collect();
    let most = (1.0 - HARDLY) * judged[0].0;
    let best = judged.into_iter().filter(|(left, _)| *left < most).min_by(|one, other| one.0.total_cmp(&other.0));
    best.map_or(thresholds, |(_, travels)| travels)
}

/// Every how many of `n_rows` are looked at.
pub fn stride(n_rows: usize) -> usize {
    n_rows.div_ceil(MOST_ROWS).max(1)
}

/// Which rows a law is judged by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Counts {
    /// Every so many of those whose direction is settled, and of those before the first motion.
    Settled(usize),
    /// So many, but for what was left out of every fit: how friction turns over shows around reversals alone.
    First(usize),
}

impl Counts {
    /// Rows of a recording that are looked at, from its first on.
    fn rows(self, prepared: &Prepared) -> usize {
        let n_rows = prepared.recording.samples.n_rows();
        match self {
            Self::Settled(_) => n_rows,
            Self::First(first) => first.min(n_rows),
        }
    }
}

fn unreadable(prepared: &Prepared, reason: io::Error) -> IdentifyError {
    IdentifyError::Samples { path: prepared.recording.path.clone(), reason }
}

/// What the columns leave of the force under each of the `laws`, in N²; beside a pressure that is `late`, of which that is the change
/// around every row of every recording, where it is given.
fn mean_squares(
    recordings: &[&Prepared],
    columns: &ForceColumns,
    thresholds: Thresholds,
    laws: &[Law],
    counts: Counts,
    late: Option<&[Vec<f64>]>,
) -> Result<Vec<f64>, IdentifyError> {
    let summaries = |index: usize, prepared: &Prepared| -> io::Result<Vec<Summary>> {
        let n_rows = counts.rows(prepared);
        let directions = Direction::of_first_under(n_rows, &prepared.recording, thresholds, Driver::Motion, laws)?;
        let change_pa = late.map(|late| late[index].as_slice());
        let summary = |direction: &Direction| condensed(prepared, 0..n_rows, columns, direction, counts, change_pa);
        directions.par_iter().map(summary).collect()
    };
    let each: Result<Vec<Vec<Summary>>, IdentifyError> = recordings
        .par_iter()
        .enumerate()
        .map(|(index, prepared)| summaries(index, prepared).map_err(|reason| unreadable(prepared, reason)))
        .collect();
    let mut totals = vec![Summary::new(N_COLUMNS + usize::from(late.is_some())); laws.len()];
    for recording in each? {
        totals.iter_mut().zip(&recording).for_each(|(total, part)| total.merge(part));
    }
    let left = |total: &Summary| total.residual_floor_square_sum() / total.n_rows().max(1) as f64;
    Ok(totals.iter().map(left).collect())
}

/// The columns of `rows` of a recording with a `direction` of its own, beside the force.
///
/// # Errors
/// Where samples cannot be read back.
pub(crate) fn condensed(
    prepared: &Prepared,
    rows: Range<usize>,
    columns: &ForceColumns,
    direction: &Direction,
    counts: Counts,
    change_pa: Option<&[f64]>,
) -> io::Result<Summary> {
    debug_assert_eq!(columns.form(), Form::Corrected);
    let n_rows = rows.end;
    let stride = match counts {
        Counts::Settled(stride) => stride,
        Counts::First(_) => 1,
    };
    let mut left_out = vec![false; n_rows];
    for rows in prepared.direction.left_out() {
        left_out[rows.start.min(n_rows)..rows.end.min(n_rows)].fill(true);
    }
    let mut gathered = Gathered::new(N_COLUMNS + usize::from(change_pa.is_some()));
    let late_n =
        |change_pa: f64, length_m: f64| columns.gas().force_n(change_pa, columns.contraction_ratio(length_m), 1.0, 1.0);
    let samples = &prepared.recording.samples;
    let mut row = rows.start;
    while row < n_rows {
        let chunk = samples.chunk(row / CHUNK_ROWS)?;
        while row < n_rows.min(chunk.first_row() + chunk.n_rows()) {
            let here = row - chunk.first_row();
            let settled = |direction: &Direction| direction.is_settled(row) || !direction.is_known(row);
            let counts = matches!(counts, Counts::First(_)) || settled(direction) && settled(&prepared.direction);
            if counts && !left_out[row] {
                let length_m = chunk.length_m()[here];
                let values = columns.row(chunk.pressure_pa()[here], length_m, direction.sign(row));
                let late = change_pa.map(|change_pa| late_n(change_pa[row], length_m));
                let force_n = chunk.force_n()[here];
                if force_n.is_finite() && values.iter().chain(&late).all(|value| value.is_finite()) {
                    gathered.push(values.into_iter().chain(late).chain([force_n]));
                }
            }
            row += stride;
        }
    }
    Ok(gathered.summary())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pam_recording::Samples;

    use crate::prepare::{direct, gate};
    use crate::testing::{THRESHOLDS, model, recording};

    /// A muscle that goes one way, rests for 6 s and goes back, at 500 Hz. While it rests its length shakes by 40 µm at 8 Hz, by what
    /// the sensor does alone or by what the muscle does, and friction with it.
    fn shaking(shakes_the_muscle: bool) -> Prepared {
        let time_s: Vec<f64> = (0..5000).map(|row| 0.002 * f64::from(row)).collect();
        let path_m = |t: f64| 0.25 - 0.01 * t.min(2.0) + 0.01 * (t - 8.0).max(0.0);
        let shake_m = |t: f64| 40e-6 * (2.0 * std::f64::consts::PI * 8.0 * t).sin();
        let rests = |t: f64| (2.0..8.0).contains(&t);
        let length_m: Vec<f64> = time_s.iter().map(|&t| path_m(t) + if rests(t) { shake_m(t) } else { 0.0 }).collect();
        let model = model();
        let force_n: Vec<f64> = time_s
            .iter()
            .map(|&t| {
                let swing = (2.0 * std::f64::consts::PI * 8.0 * t).cos();
                let (shake, way) = match (rests(t), shakes_the_muscle) {
                    (true, true) => (shake_m(t), if swing < 0.0 { 1.0 } else { -1.0 }),
                    (true, false) => (0.0, 1.0),
                    (false, _) => (0.0, if t < 2.0 { 1.0 } else { -1.0 }),
                };
                model.force_n(3e5, path_m(t) + shake, way)
            })
            .collect();
        let samples = Samples::from_columns(&time_s, &[3e5; 5000], &length_m, &force_n);
        direct(gate(vec![recording("shaking.csv", samples)]).expect("a recording"), COARSE, Form::Corrected)
            .expect("directions")
            .remove(0)
    }

    const COARSE: Thresholds = Thresholds { length_m: 2e-4, standstill: Standstill::Held, ..THRESHOLDS };

    #[test]
    fn a_tremor_of_the_muscle_asks_for_a_finer_play_and_that_of_a_sensor_does_not() {
        let muscle = pam_muscle::Muscle::nominal();
        let columns = ForceColumns::new(&muscle, 3e9, Form::Corrected, 3e5 * 0.25);
        let play_m = |shakes_the_muscle: bool| {
            turning(&[&shaking(shakes_the_muscle)], &columns, COARSE, 2e-5).expect("travels").length_m
        };
        assert_eq!(play_m(true), 2e-5);
        assert_eq!(play_m(false), COARSE.length_m);
    }

    #[test]
    fn a_law_far_from_the_middle_is_taken_only_where_it_clearly_leaves_less() {
        let first = |of: &dyn Fn(Standstill) -> f64| {
            let fitted = |laws: Vec<Standstill>, _| -> Result<Vec<StandstillFit>, IdentifyError> {
                Ok(laws.into_iter().map(|law| StandstillFit { standstill: law, rmse_n: of(law) }).collect())
            };
            judge_by(&fitted).expect("laws")[0].standstill
        };
        // Near the middle as little as there is decides.
        let sooner = Standstill::Slides { over_pa: 2e4, share: 1.0 };
        assert_eq!(first(&|law| if law == sooner { 0.9999 } else { 1.0 }), sooner);
        let by = |one: Standstill, rmse_n: f64| move |law: Standstill| if law == one { rmse_n } else { 1.0 };
        assert_eq!(first(&|_| 1.0), MIDDLE);
        for law in [Standstill::Held, Standstill::AT_ONCE, Standstill::Slides { over_pa: 1.6e5, share: 1.0 }] {
            assert_eq!(first(&by(law, 0.997)), MIDDLE);
            assert_eq!(first(&by(law, 0.99)), law);
        }
        assert_eq!(first(&by(Standstill::Sticks, 0.98)), MIDDLE);
        assert_eq!(first(&by(Standstill::Sticks, 0.97)), Standstill::Sticks);
    }

    /// A muscle that goes back and forth and rests after each stroke while its pressure goes to another level and back, at 100 Hz, whose
    /// friction at rest is that of the last motion times what `at_rest` makes of the pressure of the motion and the pressure of now.
    fn resting(at_rest: impl Fn(f64, f64) -> f64) -> Prepared {
        let model = model();
        // A stroke of 2 s and a rest of 4 s, one way and the other.
        let row = |row: usize| {
            let (stroke, t) = (row / 600, 0.01 * (row % 600) as f64);
            let way = if stroke % 2 == 0 { 1.0 } else { -1.0 };
            let along = if way > 0.0 { (t / 2.0).min(1.0) } else { 1.0 - (t / 2.0).min(1.0) };
            let moves_pa = 2e5 + 2e4 * (stroke % 3) as f64;
            let other_pa = if stroke % 4 < 2 { 0.5e5 } else { 3.5e5 };
            let away = (1.0 - ((t - 4.0) / 1.5).abs()).max(0.0);
            let (pressure_pa, length_m) = (moves_pa + away * (other_pa - moves_pa), 0.26 - 0.03 * along);
            let share = if t > 2.0 { at_rest(moves_pa, pressure_pa) } else { 1.0 };
            let noise_n = 0.3 * ((row * 7919 % 1013) as f64 / 506.0 - 1.0);
            [0.01 * row as f64, pressure_pa, length_m, model.force_n(pressure_pa, length_m, share * way) + noise_n]
        };
        let rows: Vec<[f64; 4]> = (0..7200).map(row).collect();
        let [time_s, pressure_pa, length_m, force_n] =
            [0, 1, 2, 3].map(|column| rows.iter().map(|row| row[column]).collect::<Vec<f64>>());
        let samples = Samples::from_columns(&time_s, &pressure_pa, &length_m, &force_n);
        direct(gate(vec![recording("resting.csv", samples)]).expect("a recording"), THRESHOLDS, Form::Corrected)
            .expect("directions")
            .remove(0)
    }

    #[test]
    fn friction_that_sticks_is_told_from_friction_whose_sign_is_held() {
        let muscle = pam_muscle::Muscle::nominal();
        let columns = ForceColumns::new(&muscle, 3e9, Form::Corrected, 3e5 * 0.25);
        let taken = |at_rest: &dyn Fn(f64, f64) -> f64| {
            judge(&[&resting(at_rest)], &columns, THRESHOLDS).expect("laws")[0].standstill
        };
        assert_eq!(taken(&|moved_pa, now_pa| moved_pa / now_pa), Standstill::Sticks);
        // And where some of it follows the pressure.
        assert_eq!(taken(&|moved_pa, now_pa| (moved_pa / now_pa).powf(0.7)), Standstill::Sticks);
        assert_eq!(taken(&|_, _| 1.0), Standstill::Held);
    }

    #[test]
    fn laws_that_leave_the_same_are_undecided_and_one_law_alone_is_not() {
        let law = |rmse_n| StandstillFit { standstill: Standstill::Held, rmse_n };
        assert!(is_undecided(&[law(0.9489), law(0.9489), law(0.9501)]));
        assert!(!is_undecided(&[law(0.9489), law(0.9489), law(0.97)]));
        assert!(!is_undecided(&[law(0.9489)]) && !is_undecided(&[]));
    }
}
