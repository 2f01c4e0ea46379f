//! One channel of the log comes late.
//!
//! ```text
//! reading(t) = signal(t - τ)
//! ```
//!
//! | symbol | code      | unit | meaning                               |
//! |--------|-----------|------|---------------------------------------|
//! | `τ`    | `delay_s` | s    | transport delay of force, pressure or length |
//!
//! The signal is kept at the fine step and read between two of them on a straight line; before the start it stood
//! still.
//!
//! Source: converters on separate buses; 5 to 50 ms are usual.

use std::collections::VecDeque;

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment, Reading};
use crate::true_muscle::TrueMuscle;

/// Which channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DelayedChannel {
    Force,
    Pressure,
    Length,
}

impl DelayedChannel {
    fn of(self, reading: &mut Reading) -> &mut f64 {
        match self {
            Self::Force => &mut reading.force_n,
            Self::Pressure => &mut reading.pressure_pa,
            Self::Length => &mut reading.length_m,
        }
    }
}

/// A transport delay.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ChannelDelay {
    channel: DelayedChannel,
    delay_s: f64,
    past: VecDeque<(f64, f64)>,
}

impl ChannelDelay {
    pub(crate) fn new(channel: DelayedChannel, delay_s: f64) -> Self {
        Self { channel, delay_s, past: VecDeque::new() }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let (channel, name) = [
            (DelayedChannel::Force, "force_delay"),
            (DelayedChannel::Pressure, "pressure_delay"),
            (DelayedChannel::Length, "length_delay"),
        ][draw.below(3)];
        Self::new(channel, draw.severe(name, 0.015, 0.035, "s"))
    }
}

impl Mechanism for ChannelDelay {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let signal = self.channel.of(&mut now.reading);
        self.past.push_back((now.time_s, *signal));
        let wanted_s = now.time_s - self.delay_s;
        while self.past.len() > 1 && self.past[1].0 <= wanted_s {
            self.past.pop_front();
        }
        let (from_s, from) = self.past[0];
        *signal = match self.past.get(1) {
            Some((to_s, to)) if wanted_s > from_s => from + (wanted_s - from_s) / (to_s - from_s) * (to - from),
            _ => from,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Readout;
    use crate::mechanism::moment::rig::{STEP_S, go, run};

    fn readings(channel: DelayedChannel, delay_s: f64) -> Vec<Moment> {
        let mut path = vec![(1e5, 0.26)];
        go(&mut path, 2e5, 0.25, 100);
        run(vec![Box::new(Readout), Box::new(ChannelDelay::new(channel, delay_s))], &path)
    }

    #[test]
    fn one_channel_is_late_by_the_delay_and_the_others_are_not() {
        let moments = readings(DelayedChannel::Length, 2.5 * STEP_S);
        let expected_m = 0.26 - 0.01 * 47.5 / 100.0;
        assert!((moments[50].reading.length_m - expected_m).abs() < 1e-12);
        assert_eq!(moments[50].reading.pressure_pa, moments[50].gauge_pressure_pa);
        assert_eq!(moments[1].reading.length_m, 0.26);
    }

    #[test]
    fn no_delay_changes_nothing() {
        for now in readings(DelayedChannel::Pressure, 0.0) {
            assert_eq!(now.reading.pressure_pa, now.gauge_pressure_pa);
        }
    }
}
