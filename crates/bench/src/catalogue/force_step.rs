//! A slip or a knock: at one instant the zero of the load cell shifts, and stays.
//!
//! ```text
//! F_read = F + A (1 - e^{-(t - t_s)/τ})   for t > t_s
//! ```
//!
//! | symbol | code         | unit | meaning                                            |
//! |--------|--------------|------|----------------------------------------------------|
//! | `A`    | `step_n`     | N    | shift                                              |
//! | `t_s`  | `instant_s`  | s    | when, in the second third of what is logged        |
//! | `τ`    | `settling_s` | s    | time in which the clamp settles                    |
//!
//! Source: none; it happens.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::path::Command;
use crate::true_muscle::TrueMuscle;

/// A shift at one instant.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ForceStep {
    step_n: f64,
    instant_s: f64,
    settling_s: f64,
}

impl ForceStep {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let scale = draw.force_scale() * draw.sign();
        let step_n = draw.severe("step", 4.0 * scale, 8.0 * scale, "N");
        let share = draw.even("share_of_logged_time", 0.35, 0.65, "1");
        let settling_s = draw.ratio("settling_time", 5e-3, 30e-3, "s");
        let instant_s = time_s(draw.command, share * draw.command.logged_s());
        draw.at("time", instant_s, draw.command.duration_s(), "s");
        Self { step_n, instant_s, settling_s }
    }
}

/// Time of the run at which so much of it has been logged.
fn time_s(command: &Command, logged_s: f64) -> f64 {
    let (mut left_s, mut time_s) = (logged_s, 0.0);
    for take in &command.takes {
        time_s += take.pause_before_s;
        if left_s <= take.duration_s() {
            return time_s + left_s;
        }
        left_s -= take.duration_s();
        time_s += take.duration_s();
    }
    time_s
}

impl Mechanism for ForceStep {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let since_s = now.time_s - self.instant_s;
        if since_s > 0.0 {
            now.reading.force_n -= self.step_n * (-since_s / self.settling_s).exp_m1();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Readout;
    use crate::mechanism::moment::rig::run;
    use crate::path::Path;

    #[test]
    fn nothing_before_the_instant_and_the_whole_step_ever_after() {
        let step = ForceStep { step_n: -5.0, instant_s: 0.5, settling_s: 0.01 };
        let moments = run(vec![Box::new(Readout), Box::new(step)], &[(3e5, 0.25); 2000]);
        assert!(moments[..=500].iter().all(|now| now.reading.force_n == 0.0));
        assert!(moments[700..].iter().all(|now| (now.reading.force_n + 5.0).abs() < 1e-6));
    }

    #[test]
    fn pauses_of_the_logger_do_not_count() {
        let take = |pause_before_s: f64| {
            let mut path = Path::from(1e5, 0.25);
            path.hold(10.0);
            path.take(pause_before_s)
        };
        let command = Command { protocol: "", takes: vec![take(0.0), take(100.0)] };
        assert!((time_s(&command, 8.0) - 8.0).abs() < 1e-12);
        assert!((time_s(&command, 12.0) - 112.0).abs() < 1e-12);
    }
}
