//! A cable carries tension but cannot push: below zero it hangs.
//!
//! ```text
//! F_cell = F                     for F > 0
//! F_cell = -F_b (1 - e^{F/F_b})  for F ≤ 0
//! ```
//!
//! | symbol | code        | unit | meaning                                               |
//! |--------|-------------|------|-------------------------------------------------------|
//! | `F`    | `total_n()` | N    | tension of a muscle that is held to its length        |
//! | `F_b`  | `bending_n` | N    | what the bending of muscle and cable resists at most  |
//!
//! Shows only where a protocol lets the muscle hang slack. A severity below one leaves a share of the push.
//!
//! Source: unilateral contact; the small resistance is that of a buckled column, whose load hardly grows with its
//! shortening.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Tension that cannot be negative.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Slack {
    share: f64,
    bending_n: f64,
}

impl Slack {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let scale = draw.force_scale();
        let bending_n = draw.ratio("bending_resistance", 0.4 * scale, 1.2 * scale, "N");
        draw.at("force", -2.0 * bending_n, bending_n, "N");
        Self { share: draw.severity.min(1.0), bending_n }
    }
}

impl Mechanism for Slack {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let push_n = -now.tension.total_n();
        if push_n > 0.0 {
            let held_n = -self.bending_n * (-push_n / self.bending_n).exp_m1();
            now.tension.beside_n += self.share * (push_n - held_n);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::drive;

    const SLACK: Slack = Slack { share: 1.0, bending_n: 0.8 };

    #[test]
    fn a_muscle_that_would_push_hangs_with_no_more_than_its_bending() {
        let vented = drive(SLACK, &[(0.0, 0.23)]);
        assert!((-0.8..0.0).contains(&vented[0].tension.total_n()));
    }

    #[test]
    fn a_taut_muscle_is_left_alone() {
        assert_eq!(drive(SLACK, &[(3e5, 0.25)])[0].tension.beside_n, 0.0);
    }
}
