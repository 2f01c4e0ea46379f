//! The valve between supply, muscle and atmosphere, with the regulator that holds a commanded pressure.
//!
//! A proportional valve meters the flow; its regulator brings the muscle to the command with a first-order lag:
//!
//! ```text
//! ṁ = V (p_c - p) / (κ R T τ),   limited to what the open valve lets through
//! ```
//!
//! Two on/off valves, one to the supply and one to the atmosphere, are either open or shut. In each period of
//! their switching frequency the regulator opens one of them for as long as the same flow takes, but not for
//! less than the shortest pulse; what is too short waits for the next period.
//!
//! | symbol | code                      | unit      | meaning                                          |
//! |--------|---------------------------|-----------|--------------------------------------------------|
//! | `p_c`  | `command_pa`              | Pa        | commanded gauge pressure                         |
//! | `τ`    | `lag_s`                   | s         | lag of valve, regulator and tube                 |
//! |        | `supply_pa`               | Pa        | gauge pressure of the supply                     |
//! |        | `switching_period_s`      | s         | least time from one opening to the next          |
//! |        | `shortest_pulse_s`        | s         | an on/off valve opens for this long or not at all |
//!
//! Left out: the valve's own mechanics, which the lag covers, and noise of the regulator's gauge.
//!
//! Source: sections 3.4 and figure 11 of Appl. Sci. 2023, 13(21), 12038 (on/off valves of at most 300 Hz);
//! ISO 6358-1:2013 for the flow.

use super::gas::flow_kg_per_s;

/// What kind of valve it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValveKind {
    /// Meters the flow.
    Proportional,
    /// Open or shut.
    OnOff,
}

/// Constants of a valve; see the [module](self).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValvePhysics {
    /// Kind of valve.
    pub kind: ValveKind,
    /// `τ`, in s.
    pub lag_s: f64,
    /// Gauge pressure of the supply, in Pa.
    pub supply_pa: f64,
    /// Sonic conductance, in m³/(s Pa).
    pub conductance_m3_per_s_pa: f64,
    /// Least time from one opening to the next, in s; rounded up to whole steps of the plant.
    pub switching_period_s: f64,
    /// Shortest opening, in s.
    pub shortest_pulse_s: f64,
}

/// A valve at work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Valve {
    physics: ValvePhysics,
    step_s: f64,
    /// `1 - exp(-step / τ)`.
    share_of_step: f64,
    /// `1 - exp(-period / τ)`, 1.
    share_of_period: f64,
    steps_per_period: u32,
    step_in_period: u32,
    /// Time for which the open valve stays open, in s; negative while venting.
    open_s: f64,
    /// Pressure that was too small a change for a pulse, in Pa.
    carried_pa: f64,
}

impl Valve {
    /// A shut valve, advanced in steps of `step_s`.
    pub fn new(physics: ValvePhysics, step_s: f64) -> Self {
        let steps_per_period = ((physics.switching_period_s / step_s - 1e-9).ceil() as u32).max(1);
        let share = |time_s: f64| -(-time_s / physics.lag_s).exp_m1();
        Self {
            physics,
            step_s,
            share_of_step: share(step_s),
            share_of_period: share(step_s * f64::from(steps_per_period)),
            steps_per_period,
            step_in_period: 0,
            open_s: 0.0,
            carried_pa: 0.0,
        }
    }

    /// Pressure after one step, in Pa gauge, at a [stiffness](super::BladderGas::stiffness_pa_per_kg) of the air.
    pub fn advance(&mut self, pressure_pa: f64, command_pa: f64, stiffness_pa_per_kg: f64) -> f64 {
        match self.physics.kind {
            ValveKind::Proportional => {
                let wanted_pa = (command_pa - pressure_pa) * self.share_of_step;
                let open_pa = self.step_s * stiffness_pa_per_kg * self.flow_kg_per_s(wanted_pa > 0.0, pressure_pa);
                // A muscle that is torn out of all proportion has no air that could be stiff.
                let most_pa = open_pa.max(0.0);
                pressure_pa + wanted_pa.clamp(-most_pa, most_pa)
            }
            ValveKind::OnOff => self.switch(pressure_pa, command_pa, stiffness_pa_per_kg),
        }
    }

    fn switch(&mut self, pressure_pa: f64, command_pa: f64, stiffness_pa_per_kg: f64) -> f64 {
        if self.step_in_period == 0 {
            let wanted_pa = (command_pa - pressure_pa) * self.share_of_period + self.carried_pa;
            let period_s = self.step_s * f64::from(self.steps_per_period);
            let full_pa_per_s = stiffness_pa_per_kg * self.flow_kg_per_s(wanted_pa > 0.0, pressure_pa);
            let open_s = if full_pa_per_s > 0.0 { (wanted_pa.abs() / full_pa_per_s).min(period_s) } else { 0.0 };
            if open_s >= self.physics.shortest_pulse_s {
                self.open_s = open_s.copysign(wanted_pa);
                self.carried_pa = 0.0;
            } else {
                self.open_s = 0.0;
                self.carried_pa = wanted_pa.clamp(-1e4, 1e4);
            }
        }
        self.step_in_period = (self.step_in_period + 1) % self.steps_per_period;
        let open_s = self.open_s.clamp(-self.step_s, self.step_s);
        self.open_s -= open_s;
        if open_s == 0.0 {
            return pressure_pa;
        }
        pressure_pa + open_s * stiffness_pa_per_kg * self.flow_kg_per_s(open_s > 0.0, pressure_pa)
    }

    fn flow_kg_per_s(&self, filling: bool, pressure_pa: f64) -> f64 {
        let conductance = self.physics.conductance_m3_per_s_pa;
        if filling {
            flow_kg_per_s(conductance, self.physics.supply_pa, pressure_pa)
        } else {
            flow_kg_per_s(conductance, pressure_pa, 0.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::BladderGas;

    const PHYSICS: ValvePhysics = ValvePhysics {
        kind: ValveKind::Proportional,
        lag_s: 0.04,
        supply_pa: 6e5,
        conductance_m3_per_s_pa: 2e-9,
        switching_period_s: 1.0 / 300.0,
        shortest_pulse_s: 2e-4,
    };

    /// A tenth of a liter.
    fn air() -> f64 {
        BladderGas::stiffness_pa_per_kg(1e4)
    }

    #[test]
    fn a_small_step_of_a_proportional_valve_is_an_exponential() {
        let mut valve = Valve::new(PHYSICS, 1e-3);
        let mut pressure_pa = 50e3;
        for step in 1..=200 {
            pressure_pa = valve.advance(pressure_pa, 52e3, air());
            let expected_pa = 52e3 - 2e3 * (-f64::from(step) * 1e-3 / 0.04).exp();
            assert!((pressure_pa - expected_pa).abs() < 1e-6, "step {step}");
        }
    }

    #[test]
    fn a_large_step_is_limited_by_the_flow() {
        let mut valve = Valve::new(ValvePhysics { conductance_m3_per_s_pa: 1e-10, ..PHYSICS }, 1e-3);
        let rate = air() * flow_kg_per_s(1e-10, 6e5, 0.0) * 1e-3;
        assert!((valve.advance(0.0, 5e5, air()) - rate).abs() < 1e-9);
    }

    #[test]
    fn on_off_valves_follow_the_same_lag_in_pulses() {
        let mut on_off = Valve::new(ValvePhysics { kind: ValveKind::OnOff, ..PHYSICS }, 5e-4);
        let mut proportional = Valve::new(PHYSICS, 5e-4);
        let (mut pulsed_pa, mut metered_pa) = (50e3, 50e3);
        for _ in 0..600 {
            pulsed_pa = on_off.advance(pulsed_pa, 80e3, air());
            metered_pa = proportional.advance(metered_pa, 80e3, air());
            // One shortest pulse is worth 0.2 ms of about 1.7 MPa/s, and a period of lag 3.5 ms of 0.75 MPa/s.
            assert!((pulsed_pa - metered_pa).abs() < 3e3, "{pulsed_pa} {metered_pa}");
        }
        assert!((pulsed_pa - 80e3).abs() < 1e3);
    }

    #[test]
    fn air_without_a_volume_lets_nothing_through() {
        for kind in [ValveKind::Proportional, ValveKind::OnOff] {
            for stiffness_pa_per_kg in [-1e9, f64::NAN] {
                let mut valve = Valve::new(ValvePhysics { kind, ..PHYSICS }, 1e-3);
                let pressure_pa = valve.advance(50e3, 80e3, stiffness_pa_per_kg);
                assert!((pressure_pa - 50e3).abs() < f64::EPSILON, "{kind:?}: {pressure_pa}");
            }
        }
    }

    #[test]
    fn neither_fills_above_the_supply_nor_vents_below_the_atmosphere() {
        for kind in [ValveKind::Proportional, ValveKind::OnOff] {
            let mut valve = Valve::new(ValvePhysics { kind, ..PHYSICS }, 1e-3);
            let (mut high_pa, mut low_pa) = (5e5, 1e4);
            for _ in 0..2000 {
                high_pa = valve.advance(high_pa, 9e5, air());
                low_pa = valve.advance(low_pa, -5e4, air());
            }
            assert!(high_pa < 6.1e5, "{kind:?}: {high_pa}");
            assert!(low_pa > -2e3, "{kind:?}: {low_pa}");
        }
    }
}
