//! What a residual is laid out over: eight coordinates of every instant.

use pam_core::artifact::diagnosis::Coordinate;

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
        let moments = || track.instants.iter().map(|instant| &instant.moment);
        let speed_limit = moving_above(moments().map(|moment| moment.speed_m_per_s.abs()).collect(), 3e-4);
        let rate_limit = moving_above(moments().map(|moment| moment.pressure_rate_pa_per_s.abs()).collect(), 3e3);
        let n = track.n();
        let mut values: [Vec<f64>; 8] = std::array::from_fn(|_| Vec::with_capacity(n));
        let mut moving = Vec::with_capacity(n);
        for range in &track.recordings {
            let mut last_direction = 0.0;
            let mut turn_m = 0.0;
            let mut flips = 0;
            let mut last_move_s = 0.0;
            for at in range.clone() {
                let moment = &track.instants[at].moment;
                if moment.direction != last_direction || moment.step_s == 0.0 {
                    flips += usize::from(last_direction != 0.0 && moment.direction != last_direction);
                    (last_direction, turn_m) = (moment.direction, moment.slide_m);
                }
                let moves =
                    moment.speed_m_per_s.abs() > speed_limit || moment.pressure_rate_pa_per_s.abs() > rate_limit;
                if moves || moment.step_s == 0.0 {
                    last_move_s = moment.time_s;
                }
                moving.push(moves);
                let row = [
                    moment.time_s,
                    moment.pressure_pa,
                    moment.contraction_ratio,
                    moment.speed_m_per_s.abs(),
                    (moment.slide_m - turn_m).abs(),
                    moment.time_s - last_move_s,
                    1.0 + (flips / 2) as f64,
                    track.instants[at].force_n,
                ];
                for (column, value) in values.iter_mut().zip(row) {
                    column.push(value);
                }
            }
        }
        Self { values, moving }
    }

    /// Values of one coordinate at every instant.
    pub fn of_kind(&self, coordinate: Coordinate) -> &[f64] {
        &self.values[coordinate as usize]
    }
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
