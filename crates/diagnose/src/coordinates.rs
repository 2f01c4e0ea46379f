//! What a residual is laid out over: eight coordinates of every instant.

use pam_muscle::Coordinate;
use pam_muscle::effects::Moment;

use crate::track::Track;

/// Values of the coordinates, one vector per coordinate in the order of [`Coordinate::ALL`].
#[derive(Debug, Clone)]
pub struct Coordinates {
    values: [Vec<f64>; 8],
    /// Whether the muscle moved, by length or by pressure.
    pub moving: Vec<bool>,
}

impl Coordinates {
    /// Coordinates of `track`.
    pub fn of(track: &Track) -> Self {
        let limits = moving_limits(track.instants.iter().map(|instant| &instant.moment));
        let n = track.n();
        let mut values: [Vec<f64>; 8] = std::array::from_fn(|_| Vec::with_capacity(n));
        let mut moving = Vec::with_capacity(n);
        for range in &track.recordings {
            let mut history = History::new(limits);
            for at in range.clone() {
                let moment = &track.instants[at].moment;
                history.push(moment);
                moving.push(history.moves);
                let row = [
                    moment.time_s,
                    moment.pressure_pa,
                    moment.contraction_ratio,
                    moment.speed_m_per_s.abs(),
                    history.travel_m,
                    history.rest_s,
                    history.cycle,
                    track.instants[at].force_n,
                ];
                for (column, value) in values.iter_mut().zip(row) {
                    column.push(value);
                }
            }
        }
        Self { values, moving }
    }

    /// Takes `values`, one at every instant, for those of `coordinate`.
    pub fn replace(&mut self, coordinate: Coordinate, values: Vec<f64>) {
        self.values[coordinate as usize] = values;
    }

    /// Values of one coordinate at every instant.
    pub fn of_kind(&self, coordinate: Coordinate) -> &[f64] {
        &self.values[coordinate as usize]
    }
}

/// What a recording has been through, moment by moment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct History {
    limits: [f64; 2],
    last_direction: f64,
    turn_m: f64,
    flips: usize,
    last_move_s: f64,
    /// Whether the muscle moves, by length or by pressure.
    pub(crate) moves: bool,
    /// Travel since the last reversal, in m.
    pub(crate) travel_m: f64,
    /// Time since the last move, in s.
    pub(crate) rest_s: f64,
    /// Cycle of motion, counted from 1.
    pub(crate) cycle: f64,
}

impl History {
    /// At the beginning of a recording; `limits` as of [`moving_limits`].
    pub(crate) fn new(limits: [f64; 2]) -> Self {
        Self {
            limits,
            last_direction: 0.0,
            turn_m: 0.0,
            flips: 0,
            last_move_s: 0.0,
            moves: false,
            travel_m: 0.0,
            rest_s: 0.0,
            cycle: 1.0,
        }
    }

    /// Goes on to the next moment.
    pub(crate) fn push(&mut self, moment: &Moment) {
        if moment.direction != self.last_direction || moment.step_s == 0.0 {
            self.flips += usize::from(self.last_direction != 0.0 && moment.direction != self.last_direction);
            (self.last_direction, self.turn_m) = (moment.direction, moment.slide_m);
        }
        let [speed, rate] = self.limits;
        self.moves = moment.speed_m_per_s.abs() > speed || moment.pressure_rate_pa_per_s.abs() > rate;
        if self.moves || moment.step_s == 0.0 {
            self.last_move_s = moment.time_s;
        }
        self.travel_m = (moment.slide_m - self.turn_m).abs();
        self.rest_s = moment.time_s - self.last_move_s;
        self.cycle = 1.0 + (self.flips / 2) as f64;
    }
}

/// Speed in m/s and rate of pressure in Pa/s above which the muscle moves.
pub(crate) fn moving_limits<'a>(moments: impl Iterator<Item = &'a Moment> + Clone) -> [f64; 2] {
    [
        moving_above(moments.clone().map(|moment| moment.speed_m_per_s.abs()).collect(), 3e-4),
        moving_above(moments.map(|moment| moment.pressure_rate_pa_per_s.abs()).collect(), 3e3),
    ]
}

/// Three percent of a high quantile of the rates, and never below `floor`.
fn moving_above(mut rates: Vec<f64>, floor: f64) -> f64 {
    if rates.is_empty() {
        return floor;
    }
    let index = (rates.len() - 1) * 95 / 100;
    let (_, high, _) = rates.select_nth_unstable_by(index, f64::total_cmp);
    (0.03 * *high).max(floor)
}
