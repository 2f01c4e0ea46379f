//! What makes a lift no success: slack, a pressure at its limit, an error that grew too large.

use crate::control::Limited;
use crate::lift::Instant;

/// Why a lift is no success.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Trouble {
    /// The muscle would have to push: its cable went slack.
    #[error("slack at {time_s:.2} s ({q_rad:.3} rad): the muscle would have to push")]
    Slack {
        /// When, in s.
        time_s: f64,
        /// At which angle, in rad.
        q_rad: f64,
    },
    /// The pressure that the controller wanted stayed at a limit for [`SATURATED_S`].
    #[error(
        "saturated from {time_s:.2} s ({q_rad:.3} rad): {} the {force_n:.1} N that are wanted",
        if *high { "the highest pressure pulls less than" } else { "even the lowest pressure pulls more than" }
    )]
    Saturated {
        /// Since when, in s.
        time_s: f64,
        /// At which angle, in rad.
        q_rad: f64,
        /// Whether it was the upper limit.
        high: bool,
        /// Force that was wanted, in N.
        force_n: f64,
    },
    /// The error grew beyond the limit, or beyond all limits.
    #[error(
        "given up at {time_s:.2} s{}: {}",
        if *time_s < 0.0 { ", before the lift" } else { "" },
        if error_rad.is_finite() {
            format!("the angle is off by {error_rad:.4} rad, more than limits.diverged_rad")
        } else {
            "the simulation ran away, as no muscle and no controller of these values can be held".to_owned()
        }
    )]
    Diverged {
        /// When, in s.
        time_s: f64,
        /// Error, in rad; infinite where the simulation ran away.
        error_rad: f64,
    },
}

/// How long a pressure may be wanted beyond a limit, in s: noise touches a limit for single periods.
pub const SATURATED_S: f64 = 0.1;

/// Notices the first trouble of each kind.
#[derive(Debug, Default)]
pub(crate) struct TroubleWatch {
    slack: Option<Trouble>,
    saturated: Option<Trouble>,
    diverged: Option<Trouble>,
    /// Since when the desired pressure lies at a limit, at which angle, and at which limit.
    limited: Option<(f64, f64, Limited)>,
}

impl TroubleWatch {
    /// Looks at a period of the lift for a pressure that stays at a limit.
    pub(crate) fn look(&mut self, instant: &Instant) {
        let limit = instant.command.limited;
        if limit == Limited::No {
            self.limited = None;
            return;
        }
        let (time_s, q_rad) = match self.limited {
            Some((time_s, q_rad, before)) if before == limit => (time_s, q_rad),
            _ => (instant.time_s, instant.state.q_rad),
        };
        self.limited = Some((time_s, q_rad, limit));
        if self.saturated.is_none() && instant.time_s - time_s >= SATURATED_S - 1e-9 {
            let (high, force_n) = (limit == Limited::High, instant.command.force_n);
            self.saturated = Some(Trouble::Saturated { time_s, q_rad, high, force_n });
        }
    }

    /// The cable is slack.
    pub(crate) fn slacken(&mut self, time_s: f64, q_rad: f64) {
        self.slack.get_or_insert(Trouble::Slack { time_s, q_rad });
    }

    /// The lift is given up.
    pub(crate) fn give_up(&mut self, time_s: f64, error_rad: f64) {
        self.diverged = Some(Trouble::Diverged { time_s, error_rad });
    }

    /// Slack, saturated, diverged.
    pub(crate) fn found(&self) -> [Option<Trouble>; 3] {
        [self.slack, self.saturated, self.diverged]
    }
}
