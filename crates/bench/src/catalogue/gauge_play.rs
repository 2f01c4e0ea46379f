//! A pressure gauge whose works have play: it reads low on the way up and high on the way down.
//!
//! ```text
//! p_read = p + Σ w_i (y_i - p),   y_i ← max(p - r_i, min(p + r_i, y_i))
//! ```
//!
//! | symbol | code         | unit | meaning                                |
//! |--------|--------------|------|----------------------------------------|
//! | `y_i`  | `positions_pa` | Pa | what is behind play `i`                |
//! | `r_i`  | `half_plays_pa`| Pa | half its width                         |
//! | `w_i`  | `share`      | 1    | its share of the reading, equal for all |
//!
//! Depends on the path of the pressure and not on its rate; the muscle has the true pressure. Zero while the
//! pressure is held from the start.
//!
//! Source: Prandtl (1928) and Ishlinskii (1944), for sums of plays.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Half-plays over the largest.
const PLAYS: [f64; 3] = [0.1, 0.4, 1.0];

/// Plays between pressure and reading.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GaugePlay {
    share: f64,
    half_plays_pa: [f64; 3],
    positions_pa: Option<[f64; 3]>,
}

impl GaugePlay {
    /// Plays up to `largest_pa`, which take the reading `offset_pa` away on a long way.
    pub(crate) fn new(offset_pa: f64, largest_pa: f64) -> Self {
        let half_plays_pa = PLAYS.map(|play| play * largest_pa);
        Self { share: offset_pa / half_plays_pa.iter().sum::<f64>(), half_plays_pa, positions_pa: None }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let offset_pa = draw.severe("half_width", 2e3, 4e3, "Pa");
        let largest_pa = draw.ratio("largest_half_play", 25e3, 60e3, "Pa");
        Self::new(offset_pa, largest_pa)
    }
}

impl Mechanism for GaugePlay {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let pressure_pa = now.gauge_pressure_pa;
        let positions_pa = self.positions_pa.get_or_insert([pressure_pa; 3]);
        for (position_pa, half_play_pa) in positions_pa.iter_mut().zip(self.half_plays_pa) {
            *position_pa = position_pa.clamp(pressure_pa - half_play_pa, pressure_pa + half_play_pa);
            now.reading.pressure_pa += self.share * (*position_pa - pressure_pa);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Readout;
    use crate::mechanism::moment::rig::{go, run};

    fn offsets_pa(path: &[(f64, f64)]) -> Vec<f64> {
        run(vec![Box::new(Readout), Box::new(GaugePlay::new(2e3, 40e3))], path)
            .iter()
            .map(|now| now.reading.pressure_pa - now.gauge_pressure_pa)
            .collect()
    }

    #[test]
    fn it_reads_low_on_the_way_up_and_high_on_the_way_down_at_any_rate() {
        for steps in [10, 1000] {
            let mut path = vec![(100e3, 0.25)];
            go(&mut path, 400e3, 0.25, steps);
            go(&mut path, 100e3, 0.25, steps);
            let offsets_pa = offsets_pa(&path);
            assert!((offsets_pa[steps] + 2e3).abs() < 1e-9);
            assert!((offsets_pa[2 * steps] - 2e3).abs() < 1e-9);
        }
    }

    #[test]
    fn a_small_loop_returns_to_the_point_of_reversal() {
        let mut path = vec![(100e3, 0.25)];
        go(&mut path, 300e3, 0.25, 100);
        go(&mut path, 280e3, 0.25, 100);
        go(&mut path, 300e3, 0.25, 100);
        let offsets_pa = offsets_pa(&path);
        assert!((offsets_pa[300] - offsets_pa[100]).abs() < 1e-9);
        assert!(offsets_pa[200] > offsets_pa[100] + 100.0);
    }

    #[test]
    fn a_held_pressure_is_read_as_it_is_and_the_muscle_has_the_true_one() {
        let mut path = vec![(300e3, 0.25)];
        go(&mut path, 300e3, 0.23, 10);
        assert!(offsets_pa(&path).iter().all(|offset_pa| *offset_pa == 0.0));
    }
}
