//! Sensors: filter, gain, zero, noise, bits, the clock; and what they add to the force.

use crate::draw::Dice;
use crate::forms::{Channel, Delay, Lateness};
use crate::muscle::StaticForce;
use crate::noise::Color;
use crate::simulate::Trace;

/// One channel's sensor. Units are SI.
#[derive(Debug, Clone)]
pub struct Sensor {
    /// Full scale.
    pub full_scale: f64,
    /// Deviation of the noise.
    pub noise: f64,
    /// Color of the noise.
    pub color: Color,
    /// Gain.
    pub gain: f64,
    /// Reading that the gain pivots about.
    pub pivot: f64,
    /// Zero.
    pub zero: f64,
    /// Bits over the full scale.
    pub bits: u32,
    /// Time constant of the anti-alias filter, s; 0 for none.
    pub filter_s: f64,
    /// Order of that filter: so many first orders in series.
    pub filter_order: usize,
    /// Bow of the characteristic at half of the full scale, as a share of it.
    pub bow: f64,
}

impl Sensor {
    fn calibrated(&self, value: f64) -> f64 {
        let straight = self.pivot + self.gain * (value - self.pivot) + self.zero;
        if self.bow == 0.0 {
            return straight;
        }
        let share = value / self.full_scale;
        straight + 4.0 * self.bow * self.full_scale * share * (1.0 - share)
    }

    fn quantized(&self, value: f64) -> f64 {
        let step = self.full_scale / f64::from(2u32.pow(self.bits));
        (value / step).round() * step
    }

    fn filtered(&self, values: &[f64], dt_s: f64) -> Vec<f64> {
        if self.filter_s <= 0.0 {
            return values.to_vec();
        }
        let keep = (-dt_s / self.filter_s).exp();
        let mut filtered = values.to_vec();
        for _ in 0..self.filter_order {
            let mut state = filtered[0];
            for value in &mut filtered {
                state = keep * state + (1.0 - keep) * *value;
                *value = state;
            }
        }
        filtered
    }
}

/// All sensors and the clock of a world.
#[derive(Debug, Clone)]
pub struct Sensors {
    /// Sampling rate, Hz.
    pub rate_hz: f64,
    /// Gauge.
    pub pressure: Sensor,
    /// Encoder.
    pub length: Sensor,
    /// Load cell.
    pub force: Sensor,
    /// Deviation of the tare from recording to recording, N.
    pub tare_n: f64,
    /// Deviation of the sampling instants, as a share of the period.
    pub jitter: f64,
    /// Whether the stamps show the instants, or an even clock.
    pub stamps_show_jitter: bool,
    /// Gaps in the log per recording.
    pub gaps: usize,
    /// Share of the samples that are lost one by one.
    pub lost: f64,
    /// Step of the stamps, s; 0 where they have as many digits as the file.
    pub stamp_step_s: f64,
}

/// A recording as logged, and what a perfect load cell would have logged.
#[derive(Debug, Clone, Default)]
pub struct Log {
    /// Stamps, s.
    pub time_s: Vec<f64>,
    /// Pressure, Pa.
    pub pressure_pa: Vec<f64>,
    /// Length, m.
    pub length_m: Vec<f64>,
    /// Force, N.
    pub force_n: Vec<f64>,
    /// Force without noise, bits and tare, N.
    pub true_force_n: Vec<f64>,
    /// Pressure and length without noise and bits.
    pub true_inputs: Vec<(f64, f64)>,
    /// State of friction.
    pub state: Vec<f64>,
    /// Temperature, °C, where it is logged.
    pub temperature_c: Vec<f64>,
    /// Mean square of what the sensors add to the force, N².
    pub floor_n2: f64,
}

fn at(values: &[f64], place: f64) -> f64 {
    let place = place.clamp(0.0, (values.len() - 1) as f64);
    let index = (place as usize).min(values.len().saturating_sub(2));
    let share = place - index as f64;
    values[index] * (1.0 - share) + values[(index + 1).min(values.len() - 1)] * share
}

/// What a delay is at a time, s.
fn late_s(delay: Option<Delay>, channel: Channel, time_s: f64) -> f64 {
    match delay {
        Some(delay) if delay.channel == channel => match delay.lateness {
            Lateness::Wandering(share) => {
                let wander = (1.7 * time_s).sin() + (0.61 * time_s + 1.0).sin() + (4.3 * time_s + 2.0).sin();
                (delay.delay_s * (1.0 + share * wander / 1.5)).max(0.0)
            }
            Lateness::Growing { per_s } => 0.5 * delay.delay_s + per_s * time_s,
            Lateness::Polled { period_s } => 0.5 * delay.delay_s + time_s.rem_euclid(period_s),
        },
        _ => 0.0,
    }
}

impl Sensors {
    /// Logs a trace, or only its truth. Equal generators give equal noise, whatever the trace.
    pub fn log(
        &self,
        trace: &Trace,
        dt_s: f64,
        delay: Option<Delay>,
        force: &StaticForce,
        noisy: bool,
        dice: &mut Dice,
    ) -> Log {
        let period_s = 1.0 / self.rate_hz;
        let span_s = (trace.force_n.len() - 1) as f64 * dt_s;
        let count = (span_s * self.rate_hz + 1e-6).floor() as usize + 1;
        let jitter: Vec<f64> = (0..count).map(|_| (self.jitter * dice.normal()).clamp(-0.4, 0.4) * period_s).collect();
        let tare_n = self.tare_n * dice.normal();
        let noise = |sensor: &Sensor, dice: &mut Dice| -> Vec<f64> {
            sensor.color.series(count, period_s, dice).into_iter().map(|value| value * sensor.noise).collect()
        };
        let mut noise_of = [Vec::new(), Vec::new(), Vec::new()];
        // Gaps are drawn before the noise, so that the same samples remain without it.
        let mut keep = vec![true; count];
        for _ in 0..self.gaps {
            let (from, length) = (dice.between(count / 10, count * 9 / 10), dice.uniform(0.05, 1.5) * self.rate_hz);
            let to = (from + length as usize).min(count - 1);
            keep[from..to].fill(false);
        }
        if self.lost > 0.0 {
            keep[1..].iter_mut().for_each(|keep| *keep &= !dice.chance(self.lost));
        }
        if noisy {
            noise_of = [noise(&self.pressure, dice), noise(&self.length, dice), noise(&self.force, dice)];
        }
        let [of_pressure, of_length, of_force] = noise_of;
        let filtered = [
            self.pressure.filtered(&trace.pressure_pa, dt_s),
            self.length.filtered(&trace.length_m, dt_s),
            self.force.filtered(&trace.force_n, dt_s),
        ];
        let mut log = Log::default();
        let mut sum_n2 = 0.0;
        for index in 0..count {
            let time_s = index as f64 * period_s;
            let instant_s = (time_s + jitter[index]).clamp(0.0, span_s);
            let place = |channel| (instant_s - late_s(delay, channel, instant_s)) / dt_s;
            let pressure_pa = self.pressure.calibrated(at(&filtered[0], place(Channel::Pressure)));
            let length_m = self.length.calibrated(at(&filtered[1], place(Channel::Length)));
            let force_n = self.force.calibrated(at(&filtered[2], place(Channel::Force)));
            if !keep[index] {
                continue;
            }
            log.true_force_n.push(force_n);
            log.true_inputs.push((pressure_pa, length_m));
            log.state.push(at(&trace.state, instant_s / dt_s));
            let stamp_s = if self.stamps_show_jitter { instant_s } else { time_s };
            log.time_s.push(if self.stamp_step_s > 0.0 {
                (stamp_s / self.stamp_step_s).round() * self.stamp_step_s
            } else {
                stamp_s
            });
            if !noisy {
                continue;
            }
            let read_pa = self.pressure.quantized(pressure_pa + of_pressure[index]);
            let read_m = self.length.quantized(length_m + of_length[index]);
            let read_n = self.force.quantized(force_n + tare_n + of_force[index]);
            let (per_pa, per_m) = force.slopes(pressure_pa, length_m);
            let added_n = read_n - tare_n - force_n - per_pa * (read_pa - pressure_pa) - per_m * (read_m - length_m);
            sum_n2 += added_n * added_n;
            log.pressure_pa.push(read_pa);
            log.length_m.push(read_m);
            log.force_n.push(read_n);
            if !trace.temperature_c.is_empty() {
                log.temperature_c
                    .push(at(&trace.temperature_c, instant_s / dt_s) + 0.03 * of_force[index] / self.force.noise);
            }
        }
        log.floor_n2 = sum_n2 / log.time_s.len() as f64;
        log
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sensor() -> Sensor {
        Sensor {
            full_scale: 1000.0,
            noise: 0.1,
            color: Color::White,
            gain: 1.0,
            pivot: 0.0,
            zero: 0.0,
            bits: 10,
            filter_s: 0.0,
            filter_order: 1,
            bow: 0.0,
        }
    }

    #[test]
    fn a_bow_is_nothing_at_both_ends_and_a_filter_of_second_order_arrives_later() {
        let bowed = Sensor { bow: 1e-3, ..sensor() };
        assert!(bowed.calibrated(0.0).abs() < 1e-12 && (bowed.calibrated(1000.0) - 1000.0).abs() < 1e-9);
        assert!((bowed.calibrated(500.0) - 501.0).abs() < 1e-9);
        let steps: Vec<f64> = (0..100).map(|index| if index < 10 { 0.0 } else { 1.0 }).collect();
        let after = |filter_order| Sensor { filter_s: 5e-3, filter_order, ..sensor() }.filtered(&steps, 1e-3);
        assert!(after(2)[14] < after(1)[14] && after(2)[99] > 0.99);
    }

    #[test]
    fn readings_are_whole_steps() {
        let reading = sensor().quantized(123.4) / (1000.0 / 1024.0);
        assert!((reading - reading.round()).abs() < 1e-9);
    }
}
