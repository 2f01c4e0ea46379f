//! What friction does at standstill.

use crate::draw::Dice;

/// What friction does while the length is held and the pressure moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Standstill {
    /// Keeps its last value.
    Held,
    /// Follows the direction of the pressure at once.
    FollowsPressure,
    /// A stop operator on pressure with this reach, Pa.
    SlidesAfter(f64),
    /// A stop operator on pressure that turns only a part of the contacts over.
    GivesPartly {
        /// Reach, Pa.
        reach_pa: f64,
        /// Most that the state is brought to, 0…1.
        most: f64,
    },
    /// A stop operator behind a play: the pressure moves freely by a band first.
    GivesLate {
        /// Half of the band, Pa.
        band_pa: f64,
        /// Reach, Pa.
        reach_pa: f64,
        /// Place within the band, Pa.
        place_pa: f64,
    },
}

impl Standstill {
    /// Draws a law.
    pub fn draw(dice: &mut Dice) -> Self {
        match dice.weighted(&[1.0, 1.0, 1.0]) {
            0 => Self::Held,
            1 => Self::FollowsPressure,
            _ => Self::SlidesAfter(dice.log_uniform(3e3, 3e4)),
        }
    }

    /// Draws a law of the third part.
    pub fn draw_sealed(dice: &mut Dice) -> Self {
        match dice.weighted(&[1.0, 1.0, 0.5]) {
            0 => Self::GivesPartly { reach_pa: dice.log_uniform(4e3, 4e4), most: dice.uniform(0.3, 0.8) },
            1 => Self::GivesLate {
                band_pa: dice.log_uniform(2e3, 1.5e4),
                reach_pa: dice.log_uniform(3e3, 2e4),
                place_pa: 0.0,
            },
            _ => Self::Held,
        }
    }

    /// Name, for the truth.
    pub fn name(self) -> &'static str {
        match self {
            Self::GivesPartly { .. } => "gives-partly",
            Self::GivesLate { .. } => "gives-late",
            Self::Held => "held",
            Self::FollowsPressure => "follows-pressure",
            Self::SlidesAfter(_) => "slides-after-pressure",
        }
    }
}
