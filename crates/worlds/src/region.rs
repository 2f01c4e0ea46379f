//! Where the rig may go, what holds its pressure, and what may hang on the muscle.

/// Where the rig may go.
#[derive(Debug, Clone)]
pub struct Region {
    /// Most contraction by pressure, at equal distances from 0 to the highest pressure.
    pub taut: Vec<f64>,
    /// Highest pressure, Pa.
    pub highest_pa: f64,
    /// Least contraction.
    pub least: f64,
    /// Most contraction at any pressure.
    pub most: f64,
    /// Whether triangles are cycled as fast as the rig goes.
    pub cycling: bool,
    /// Rest length, m.
    pub rest_m: f64,
    /// Highest speed, m/s.
    pub fastest_m_per_s: f64,
    /// Highest frequency of chirps, Hz.
    pub highest_hz: f64,
    /// Bandwidths of the drives of length and of pressure, Hz.
    pub bandwidths_hz: (f64, f64),
    /// Regulator that a changing volume disturbs; none for one that holds whatever comes.
    pub regulator: Option<Regulator>,
    /// Weight that may be hung on the muscle, with the contraction at which it is lifted, by pressure as in `taut`.
    pub hang: Option<(Load, Vec<f64>)>,
}

/// A weight that hangs on the muscle in a dashpot, between two stops: `c dL/dt = W − F`.
///
/// The inertia of the weight is left out: with some kilonewton seconds per meter it would act within milliseconds.
#[derive(Debug, Clone, Copy)]
pub struct Load {
    /// Weight `W`, N.
    pub weight_n: f64,
    /// Dashpot `c`, N s/m.
    pub dashpot_n_s_per_m: f64,
    /// Shortest and longest length that the stops allow, m.
    pub stops_m: (f64, f64),
}

/// A regulator of pressure: contracting widens the muscle, the pressure sags and comes back.
///
/// ```text
/// Δṗ = −Δp/τ − s P ε̇
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Regulator {
    /// Share `s` of the absolute pressure `P` that is lost per contraction; about 2.5 for a closed muscle.
    pub share: f64,
    /// Time `τ` to come back, s.
    pub recovery_s: f64,
}

impl Regulator {
    /// Adds what a motion does to the pressure, below a relief valve.
    pub(crate) fn disturb(self, pressure_pa: &mut [f64], contraction: &[f64], dt_s: f64, relief_pa: f64) {
        let keep = (-dt_s / self.recovery_s).exp();
        let mut sag_pa = 0.0;
        for (index, pressure_pa) in pressure_pa.iter_mut().enumerate().skip(1) {
            let moved = contraction[index] - contraction[index - 1];
            sag_pa = keep * sag_pa - self.share * (*pressure_pa + 1.013e5) * moved;
            // A vented muscle breathes freely.
            *pressure_pa = (*pressure_pa + sag_pa * (*pressure_pa / 2e4).clamp(0.0, 1.0)).min(relief_pa);
        }
    }
}

impl Region {
    /// Most contraction at a pressure.
    pub fn most_at(&self, pressure_pa: f64) -> f64 {
        self.along(&self.taut, pressure_pa).min(self.most).max(self.least)
    }

    /// Value of a table by pressure.
    fn along(&self, table: &[f64], pressure_pa: f64) -> f64 {
        let place = (pressure_pa / self.highest_pa).clamp(0.0, 1.0) * (table.len() - 1) as f64;
        let index = (place as usize).min(table.len() - 2);
        let share = place - index as f64;
        table[index] * (1.0 - share) + table[index + 1] * share
    }

    /// Contraction at which the weight is lifted at a pressure; the least where none hangs.
    pub(crate) fn lifted_at(&self, pressure_pa: f64) -> f64 {
        let lifted = self.hang.as_ref().map_or(self.least, |hang| self.along(&hang.1, pressure_pa));
        lifted.min(self.most).max(self.least)
    }

    /// Least pressure at which a contraction is taut, Pa.
    pub fn least_pressure_pa(&self, contraction: f64) -> f64 {
        let steps = 200;
        (0..=steps)
            .map(|step| self.highest_pa * f64::from(step) / f64::from(steps))
            .find(|&pressure_pa| self.most_at(pressure_pa) >= contraction)
            .unwrap_or(self.highest_pa)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regulator_sags_while_the_muscle_contracts_and_comes_back() {
        let contraction: Vec<f64> = (0..2000).map(|step| 1e-4 * f64::from(step.min(1000))).collect();
        let mut pressure_pa = vec![3e5; 2000];
        Regulator { share: 1.0, recovery_s: 0.05 }.disturb(&mut pressure_pa, &contraction, 1e-3, 4e5);
        // In a steady motion the sag is s P ε̇ τ.
        assert!((3e5 - pressure_pa[999] - 4.013e5 * 0.1 * 0.05).abs() < 50.0, "{}", pressure_pa[999]);
        assert!((pressure_pa[1999] - 3e5).abs() < 1.0);
    }
}
