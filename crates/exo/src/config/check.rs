//! From the file as written to the plan: ranges, multiples, units.

use std::path::Path;

use super::written::{LengthToml, LiftConfig, ValveKindToml};
use super::{LiftPlan, Spreads};
use crate::arm::{Forearm, Load};
use crate::control::{ControlSettings, LengthSource};
use crate::error::ConfigError;
use crate::plant::{Sensor, ValveKind, ValvePhysics};
use crate::reference::Quintic;

/// Periods of the controller in one lift, at most: each is kept with all its signals, about a kilobyte for both arms.
const MOST_PERIODS: f64 = 500_000.0;

/// Checks of one file.
struct Checker<'a> {
    path: &'a Path,
}

impl Checker<'_> {
    fn within(&self, key: &'static str, value: f64, lowest: f64, highest: f64) -> Result<f64, ConfigError> {
        // Also refuses what is no number.
        if value >= lowest && value <= highest {
            return Ok(value);
        }
        let remedy = if value.is_nan() { "write a number" } else { "check the value and its unit" };
        Err(ConfigError::OutOfRange { path: self.path.to_owned(), key, value, lowest, highest, remedy })
    }

    /// `value`, which must be a whole number of `step`s.
    fn multiple(
        &self,
        (key, value): (&'static str, f64),
        (step_key, step): (&'static str, f64),
    ) -> Result<f64, ConfigError> {
        let steps = value / step;
        if (steps - steps.round()).abs() < 1e-6 {
            return Ok(value);
        }
        // Rounded to what a person would write.
        let tidy = |value: f64| (value * 1e9).round() / 1e9;
        let (below, above) = (tidy(steps.floor() * step), tidy(steps.ceil() * step));
        let below = if below > 0.0 { below } else { above };
        Err(ConfigError::NotAMultiple { path: self.path.to_owned(), key, value, step_key, step, below, above })
    }

    fn ordered(&self, low: (&'static str, f64), high: (&'static str, f64)) -> Result<(), ConfigError> {
        if low.1 < high.1 {
            return Ok(());
        }
        let (low_key, low) = low;
        let (high_key, high) = high;
        Err(ConfigError::Order { path: self.path.to_owned(), low_key, low, high_key, high })
    }
}

impl LiftConfig {
    /// Checks every value; `path` is for messages.
    ///
    /// # Errors
    /// [`ConfigError`] names the key, what was found and what is expected.
    pub fn check(self, path: &Path) -> Result<LiftPlan, ConfigError> {
        let checker = Checker { path };
        let within = |key, value, lowest, highest| checker.within(key, value, lowest, highest);
        let Self { reference, arm, load, plant, valve, sensors, controller, limits, trials } = self;

        let step_ms = within("plant.step_ms", plant.step_ms, 0.01, 1.0)?;
        let step = ("plant.step_ms", step_ms);
        let period_ms = within("controller.period_ms", controller.period_ms, 0.1, 100.0)?;
        checker.multiple(("controller.period_ms", period_ms), step)?;
        let period = ("controller.period_ms / 1000", 1e-3 * period_ms);
        let times = [
            ("reference.duration_s", within("reference.duration_s", reference.duration_s, 0.1, 3600.0)?),
            ("reference.handover_s", within("reference.handover_s", reference.handover_s, 0.0, 60.0)?),
            ("reference.hold_s", within("reference.hold_s", reference.hold_s, 0.0, 60.0)?),
            ("reference.settle_s", within("reference.settle_s", reference.settle_s, 0.0, 3600.0)?),
        ];
        for time in times {
            checker.multiple(time, period)?;
        }
        let n_periods = times.iter().map(|(_, time_s)| time_s).sum::<f64>() / period.1;
        if n_periods > MOST_PERIODS {
            return Err(ConfigError::TooLong { path: path.to_owned(), n_periods, most: MOST_PERIODS });
        }
        let delay_ms = within("valve.delay_ms", valve.delay_ms, 0.0, 100.0)?;
        checker.multiple(("valve.delay_ms", delay_ms), step)?;
        let lowest_kpa = within("valve.lowest_kpa", valve.lowest_kpa, 0.0, 2000.0)?;
        let highest_kpa = within("valve.highest_kpa", valve.highest_kpa, 1.0, 2000.0)?;
        checker.ordered(("valve.lowest_kpa", lowest_kpa), ("valve.highest_kpa", highest_kpa))?;
        let supply_kpa = within("valve.supply_kpa", valve.supply_kpa, 1.0, 2000.0)?;
        checker.ordered(("valve.highest_kpa", highest_kpa), ("valve.supply_kpa", supply_kpa))?;
        let mass_kg = within("load.mass_kg", load.mass_kg, 0.0, 500.0)?;
        let percent = |key, value| Ok::<f64, ConfigError>(0.01 * within(key, value, 0.0, 95.0)?);

        Ok(LiftPlan {
            reference: Quintic {
                from_rad: within("reference.from_rad", reference.from_rad, -1.2, 1.2)?,
                to_rad: within("reference.to_rad", reference.to_rad, -1.2, 1.2)?,
                duration_s: reference.duration_s,
            },
            handover_s: reference.handover_s,
            hold_s: reference.hold_s,
            settle_s: reference.settle_s,
            upper_m: within("arm.upper_m", arm.upper_m, 0.01, 2.0)?,
            lower_m: within("arm.lower_m", arm.lower_m, 0.01, 2.0)?,
            mounted_length_m: arm
                .mounted_length_mm
                .map(|length_mm| {
                    Ok::<f64, ConfigError>(1e-3 * within("arm.mounted_length_mm", length_mm, 10.0, 5000.0)?)
                })
                .transpose()?,
            load: Load {
                mass_kg,
                inertia_kg_m2: within("load.inertia_kg_m2", load.inertia_kg_m2, 1e-6, 500.0)?,
                load_arm_m: within("arm.load_arm_m", arm.load_arm_m, 0.01, 3.0)?,
            },
            true_mass_kg: within("load.true_mass_kg", load.true_mass_kg.unwrap_or(mass_kg), 0.0, 500.0)?,
            forearm: Forearm {
                mass_kg: within("arm.forearm_mass_kg", arm.forearm_mass_kg, 0.0, 50.0)?,
                center_m: within("arm.forearm_center_m", arm.forearm_center_m, 0.0, 2.0)?,
                inertia_kg_m2: within("arm.forearm_inertia_kg_m2", arm.forearm_inertia_kg_m2, 0.0, 50.0)?,
            },
            step_s: 1e-3 * step_ms,
            presliding_m: 1e-3 * within("plant.presliding_mm", plant.presliding_mm, 1e-3, 100.0)?,
            friction_factor: within("plant.friction_factor", plant.friction_factor, 0.0, 10.0)?,
            friction_state: within("plant.friction_state", plant.friction_state, -1.0, 1.0)?,
            bowden: within("plant.bowden_friction", plant.bowden_friction, 0.0, 2.0)?,
            damping_n_m_s: within("plant.damping_n_m_s", plant.damping_n_m_s, 0.0, 100.0)?,
            valve: ValvePhysics {
                kind: match valve.kind {
                    ValveKindToml::Proportional => ValveKind::Proportional,
                    ValveKindToml::OnOff => ValveKind::OnOff,
                },
                lag_s: 1e-3 * within("valve.lag_ms", valve.lag_ms, 0.1, 5000.0)?,
                supply_pa: 1e3 * supply_kpa,
                // 1 l/(s bar) = 1e-8 m³/(s Pa).
                conductance_m3_per_s_pa: 1e-8
                    * within("valve.conductance_l_per_s_bar", valve.conductance_l_per_s_bar, 1e-4, 100.0)?,
                switching_period_s: 1.0 / within("valve.switching_hz", valve.switching_hz, 1.0, 1e5)?,
                shortest_pulse_s: 1e-3 * within("valve.shortest_pulse_ms", valve.shortest_pulse_ms, 0.0, 100.0)?,
            },
            transport_delay_s: 1e-3 * delay_ms,
            dead_volume_m3: 1e-6 * within("valve.dead_volume_cm3", valve.dead_volume_cm3, 0.0, 10_000.0)?,
            angle_sensor: Sensor {
                noise: 1e-3 * within("sensors.angle_noise_mrad", sensors.angle_noise_mrad, 0.0, 100.0)?,
                step: 1e-3 * within("sensors.angle_step_mrad", sensors.angle_step_mrad, 0.0, 100.0)?,
            },
            pressure_sensor: Sensor {
                noise: 1e3 * within("sensors.pressure_noise_kpa", sensors.pressure_noise_kpa, 0.0, 100.0)?,
                step: 1e3 * within("sensors.pressure_step_kpa", sensors.pressure_step_kpa, 0.0, 100.0)?,
            },
            control: ControlSettings {
                period_s: 1e-3 * period_ms,
                kp_per_s2: within("controller.kp_per_s2", controller.kp_per_s2, 0.0, 1e5)?,
                kd_per_s: within("controller.kd_per_s", controller.kd_per_s, 0.0, 1e4)?,
                observer_rad_per_s: within("controller.observer_rad_per_s", controller.observer_rad_per_s, 0.1, 1e4)?,
                length: match controller.length {
                    LengthToml::Measured => LengthSource::Measured,
                    LengthToml::Reference => LengthSource::Reference,
                },
                integral_per_s3: within("controller.integral_per_s3", controller.integral_per_s3, 0.0, 1e6)?,
                disturbance_observer: controller.disturbance_observer,
                lag_compensation: controller.lag_compensation,
                ramp: controller.ramp,
                valve_lag_s: 1e-3 * within("controller.valve_lag_ms", controller.valve_lag_ms, 0.0, 5000.0)?,
                transport_delay_s: 1e-3 * delay_ms,
                pressure_loop_s: 1e-3
                    * within("controller.pressure_loop_ms", controller.pressure_loop_ms, 1.0, 5000.0)?,
                hysteresis_aware: controller.hysteresis_aware,
                presliding_m: 1e-3 * within("controller.presliding_mm", controller.presliding_mm, 1e-3, 100.0)?,
                effect_memory: controller.effect_memory,
                payload_estimation: controller.payload_estimation,
                pressure_limits_pa: [1e3 * lowest_kpa, 1e3 * highest_kpa],
            },
            diverged_rad: within("limits.diverged_rad", limits.diverged_rad, 1e-6, 10.0)?,
            spreads: Spreads {
                payload: percent("trials.payload_percent", trials.payload_percent)?,
                friction: percent("trials.friction_percent", trials.friction_percent)?,
                lag: percent("trials.lag_percent", trials.lag_percent)?,
                geometry: percent("trials.geometry_percent", trials.geometry_percent)?,
                mounting_m: 1e-3 * within("trials.mounting_mm", trials.mounting_mm, 0.0, 100.0)?,
                noise: percent("trials.noise_percent", trials.noise_percent)?,
                model_parameters: trials.model_parameters,
            },
        })
    }
}
