//! A tube between gauge and muscle: the muscle's pressure comes late.
//!
//! ```text
//! C_i dP_i/dt = G_i (P_{i-1} - P_i) + G_{i+1} (P_{i+1} - P_i),   G_i = (P_{i-1} + P_i) / (2 P_ref) / R_i
//! ```
//!
//! | symbol  | code            | unit | meaning                                                     |
//! |---------|-----------------|------|-------------------------------------------------------------|
//! | `P_i`   | `cells_pa`      | Pa   | absolute pressure of cell `i`; `P_0` is at the gauge        |
//! | `C_i`   | `CAPACITIES`    | 1    | volume of a cell over that of the muscle; the last is it    |
//! | `R_i`   | `time_s / n`    | s    | laminar resistance times the volume of the muscle           |
//! | `P_ref` | `REFERENCE_PA`  | Pa   | absolute pressure at which the resistance is stated         |
//!
//! Flow of a gas through a tube goes with the difference of the squares of absolute pressure, so that a full muscle
//! fills and vents faster than an empty one, and inflation is faster than deflation. Each cell goes to the mean of
//! its neighbors exponentially, which is stable at any step.
//!
//! Source: compressible laminar flow (Hagen–Poiseuille with an ideal gas) as a ladder of cells; the volume of the
//! muscle is taken as constant.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Pressure of the air.
const ATMOSPHERE_PA: f64 = 101_325.0;

/// Absolute pressure at which the time constant is stated: 250 kPa gauge.
const REFERENCE_PA: f64 = 250e3 + ATMOSPHERE_PA;

/// Three cells of tube and the muscle.
const CAPACITIES: [f64; 4] = [0.05, 0.05, 0.05, 1.0];

/// Longest step, as a share of the time constant of the line.
const STEP: f64 = 0.01;

/// Most steps in one step of the bench.
const MOST_STEPS: f64 = 200.0;

/// A line of cells.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PressureLine {
    time_s: f64,
    cells_pa: Option<[f64; 4]>,
    gauge_pa: f64,
}

impl PressureLine {
    pub(crate) fn new(time_s: f64) -> Self {
        Self { time_s, cells_pa: None, gauge_pa: 0.0 }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        Self::new(draw.severe("time_constant_at_250_kpa", 0.03, 0.08, "s"))
    }
}

/// Moves the cells on with the gauge at an absolute pressure.
fn flow(cells_pa: &mut [f64; 4], gauge_pa: f64, step_s: f64, time_s: f64) {
    let resistance_s = time_s / CAPACITIES.len() as f64;
    let conductance = |a_pa: f64, b_pa: f64| (a_pa + b_pa) / (2.0 * REFERENCE_PA) / resistance_s;
    for index in 0..CAPACITIES.len() {
        let own_pa = cells_pa[index];
        let before_pa = if index == 0 { gauge_pa } else { cells_pa[index - 1] };
        let mut total = conductance(before_pa, own_pa);
        let mut inflow = total * before_pa;
        if let Some(after_pa) = cells_pa.get(index + 1) {
            let onward = conductance(own_pa, *after_pa);
            total += onward;
            inflow += onward * after_pa;
        }
        let mean_pa = inflow / total;
        cells_pa[index] = mean_pa + (own_pa - mean_pa) * (-step_s * total / CAPACITIES[index]).exp();
    }
}

impl Mechanism for PressureLine {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let gauge_pa = now.gauge_pressure_pa + ATMOSPHERE_PA;
        let before_pa = self.gauge_pa;
        self.gauge_pa = gauge_pa;
        let cells_pa = self.cells_pa.get_or_insert([gauge_pa; 4]);
        if self.time_s <= 0.0 {
            return;
        }
        // A line at rest stays at rest to the last bit, which tells a held muscle from a moving one.
        if before_pa == gauge_pa && cells_pa.iter().all(|cell_pa| (cell_pa - gauge_pa).abs() < 1e-3) {
            *cells_pa = [gauge_pa; 4];
        }
        let steps = (now.step_s / (STEP * self.time_s)).ceil().min(MOST_STEPS);
        for step in 1..=steps as usize {
            let share = (step as f64 - 0.5) / steps;
            flow(cells_pa, before_pa + share * (gauge_pa - before_pa), now.step_s / steps, self.time_s);
        }
        now.muscle_pressure_pa = cells_pa[3] - ATMOSPHERE_PA;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{go, run};

    fn muscle_pa(path: &[(f64, f64)]) -> Vec<f64> {
        run(vec![Box::new(PressureLine::new(0.05))], path).iter().map(|now| now.muscle_pressure_pa).collect()
    }

    #[test]
    fn a_ramp_is_followed_about_one_time_constant_behind() {
        let mut path = vec![(225e3, 0.25)];
        go(&mut path, 275e3, 0.25, 1000);
        let lag_pa = 275e3 - muscle_pa(&path)[1000];
        // Gas in the tube itself takes its share: the mean over the ladder of three cells adds 5 %; half of
        // the muscle's resistance lies before each cell on average.
        assert!((0.9..1.2).contains(&(lag_pa / (50e3 * 0.05))), "{lag_pa}");
    }

    #[test]
    fn filling_is_faster_than_venting() {
        let settled = |from_pa: f64, to_pa: f64| {
            let mut path = vec![(from_pa, 0.25)];
            go(&mut path, to_pa, 0.25, 1);
            go(&mut path, to_pa, 0.25, 60);
            ((muscle_pa(&path)[60] - from_pa) / (to_pa - from_pa)).abs()
        };
        assert!(settled(50e3, 450e3) > settled(450e3, 50e3) + 0.03);
    }

    #[test]
    fn nothing_lags_at_rest() {
        let mut path = vec![(100e3, 0.25)];
        go(&mut path, 300e3, 0.25, 100);
        go(&mut path, 300e3, 0.25, 3000);
        let pressures_pa = muscle_pa(&path);
        assert!((pressures_pa[3100] - 300e3).abs() < 1e-6);
        assert!(pressures_pa[150] < 299e3);
    }
}
