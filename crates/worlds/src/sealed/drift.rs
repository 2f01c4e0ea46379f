//! The load cell's zero: drift and jumps.

use crate::draw::Dice;
use crate::forms::{Built, Setting, size};
use crate::mechanism::{Mechanism, Moment};
use crate::place::Place;

/// Drift of the load cell's zero: by diffusion, or at random.
#[derive(Debug)]
enum Drift {
    /// Size at the end of the estimation recordings, N, and when that is, s.
    Root(f64, f64),
    /// Zeros at even distances in s, N, joined smoothly.
    Walk(Vec<f64>, f64),
}

impl Mechanism for Drift {
    fn cell_n(&mut self, now: &Moment, force_n: f64) -> f64 {
        force_n
            + match self {
                Self::Root(size_n, total_s) => *size_n * (now.time_s.max(0.0) / *total_s).sqrt(),
                Self::Walk(zeros_n, apart_s) => {
                    let place = (now.time_s.max(0.0) / *apart_s).min((zeros_n.len() - 2) as f64);
                    let index = (place as usize).min(zeros_n.len() - 2);
                    let share = (place - index as f64).clamp(0.0, 1.0);
                    let smooth = share * share * (3.0 - 2.0 * share);
                    zeros_n[index] + (zeros_n[index + 1] - zeros_n[index]) * smooth
                }
            }
    }
}

/// Drift as the root of time: moisture or heat that diffuses into a load cell.
pub fn drift_root(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let size_n = dice.sign() * size(u, 0.5, 9.0);
    Built::one(Drift::Root(size_n, setting.total_s())).with("size_n", size_n)
}

/// Drift as a random walk: its deviation grows as the root of time.
pub fn drift_walk(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let size_n = size(u, 0.5, 6.0);
    let whole_s: f64 = setting.durations_s.iter().sum::<f64>() + 25.0 * setting.durations_s.len() as f64;
    let apart_s = setting.total_s() / 30.0;
    let count = (whole_s / apart_s) as usize + 3;
    let mut zero_n = 0.0;
    let zeros_n = (0..count)
        .map(|_| {
            let here_n = zero_n;
            zero_n += size_n / 30f64.sqrt() * dice.normal();
            here_n
        })
        .collect();
    Built::one(Drift::Walk(zeros_n, apart_s)).with("size_n", size_n)
}

/// A zero of the load cell that goes to another place and perhaps to a third.
#[derive(Debug)]
struct Shift {
    recording: usize,
    at_s: f64,
    size_n: f64,
    /// How long the way takes, s.
    taking_s: f64,
    /// After how long it comes back in part, s, and the share that stays.
    back: Option<(f64, f64)>,
    since_s: Option<f64>,
    tared: bool,
}

impl Mechanism for Shift {
    fn begin(&mut self, recording: usize, rested: bool) {
        self.tared |= rested && recording > self.recording;
    }

    fn cell_n(&mut self, now: &Moment, force_n: f64) -> f64 {
        if now.recording == self.recording && now.recording_time_s >= self.at_s && self.since_s.is_none() {
            self.since_s = Some(now.time_s);
        }
        let Some(since_s) = self.since_s.filter(|_| !self.tared) else { return force_n };
        let passed_s = now.time_s - since_s;
        let come = (passed_s / self.taking_s).clamp(0.0, 1.0);
        let stays = match self.back {
            Some((after_s, stays)) if passed_s > after_s => stays,
            _ => 1.0,
        };
        force_n + self.size_n * come * stays
    }
}

fn shift(dice: &mut Dice, u: f64, setting: &Setting, taking_s: f64, back: Option<(f64, f64)>) -> Built {
    let size_n = dice.sign() * size(u, 1.0, 10.0);
    let recording = dice.between(0, setting.estimation - 1);
    let duration_s = setting.durations_s[recording];
    let at_s = dice.uniform(0.25, 0.65) * duration_s;
    let back = back.map(|(share, stays)| (share * (duration_s - at_s), stays));
    let place = Place { recording: Some(format!("e{}", recording + 1)), ..Place::new("time_s", at_s, duration_s) };
    let built = Built::one(Shift { recording, at_s, size_n, taking_s, back, since_s: None, tared: false });
    Built { place: Some(place), ..built }.with("size_n", size_n).with("at_s", at_s)
}

/// A jump that goes back in part some time later, as of a cable that is touched.
pub fn step_back(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let back = Some((dice.uniform(0.4, 0.8), dice.uniform(0.2, 0.6)));
    shift(dice, u, setting, 1e-3, back)
}

/// A bond that slips within a second or two.
pub fn step_slip(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let taking_s = dice.log_uniform(0.2, 2.0);
    shift(dice, u, setting, taking_s, None).with("taking_s", taking_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_comes_once_goes_back_in_part_and_is_tared_away() {
        let mut shift = Shift {
            recording: 1,
            at_s: 5.0,
            size_n: 4.0,
            taking_s: 1.0,
            back: Some((10.0, 0.5)),
            since_s: None,
            tared: false,
        };
        let mut at = |recording, recording_time_s: f64| {
            let time_s = 100.0 * recording as f64 + recording_time_s;
            shift.cell_n(&Moment { recording, recording_time_s, time_s, ..Moment::default() }, 0.0)
        };
        assert_eq!(at(0, 6.0), 0.0);
        assert_eq!(at(1, 4.0), 0.0);
        assert_eq!(at(1, 5.0), 0.0);
        assert_eq!(at(1, 5.5), 2.0);
        assert_eq!(at(1, 9.0), 4.0);
        assert_eq!(at(1, 16.0), 2.0);
        shift.begin(2, true);
        assert_eq!(shift.cell_n(&Moment { recording: 2, time_s: 300.0, ..Moment::default() }, 1.0), 1.0);
    }

    #[test]
    fn a_walk_is_smooth_and_starts_at_nothing() {
        let mut walk = Drift::Walk(vec![0.0, 2.0, 1.0, 3.0], 10.0);
        let mut at = |time_s| walk.cell_n(&Moment { time_s, ..Moment::default() }, 0.0);
        assert_eq!(at(0.0), 0.0);
        assert!((at(5.0) - 1.0).abs() < 1e-12);
        assert!((at(9.999) - at(10.001)).abs() < 1e-3);
    }
}
