//! Friction of the braid: how large it is, how it turns over, and what it does at standstill.
//!
//! ```text
//! F_friction = z · F_c(p, L) (1 + a sgn z)
//! F_c = f₁ p S + f₂ p^(5/3) S^(2/3) + f₀,   S = 2π r L
//! ```
//!
//! `z` in −1…1 is 1 when contracting and lowers the force then. In the base it is a stop operator on travel with a very short
//! reach; concealed pre-sliding replaces it by an [`Element`] with memory over millimeters.
//!
//! Sources: Dahl (1968); Canudas de Wit et al. (1995), LuGre; Bouc (1967) and Wen (1976); Iwan (1966); Vo-Minh et al. (2011),
//! Maxwell-slip for pneumatic muscles; Davis and Caldwell (2006) for pressure times surface.

use std::f64::consts::PI;

use crate::shape::Shape;
use crate::standstill::Standstill;

/// Sizes of the terms of friction.
#[derive(Debug, Clone, Copy)]
pub struct Amplitude {
    /// Factor on pressure times surface.
    pub by_surface: f64,
    /// Factor on `p^(5/3) S^(2/3)`, N^(-2/3)·…
    pub by_contact: f64,
    /// Part without pressure, N.
    pub constant_n: f64,
    /// Share by which contracting is wider and extending narrower.
    pub asymmetry: f64,
}

impl Amplitude {
    /// Friction when sliding, N.
    pub fn sliding_n(&self, pressure_pa: f64, radius_m: f64, length_m: f64) -> f64 {
        let pressure_pa = pressure_pa.max(0.0);
        let surface_m2 = 2.0 * PI * radius_m * length_m;
        let root = (pressure_pa * surface_m2).powf(2.0 / 3.0) * pressure_pa;
        self.by_surface * pressure_pa * surface_m2 + self.by_contact * root + self.constant_n
    }

    /// Factor by branch.
    pub fn branch(&self, state: f64) -> f64 {
        1.0 + self.asymmetry * state.clamp(-1.0, 1.0)
    }
}

/// How the state of friction follows travel.
#[derive(Debug, Clone)]
pub enum Element {
    /// Slides after `reach_m`: a stop operator.
    Stop {
        /// Distance that sets the scale of pre-sliding, m.
        reach_m: f64,
        /// State, −1…1.
        state: f64,
    },
    /// Approaches sliding exponentially (Dahl with exponent 1).
    Dahl {
        /// Distance that sets the scale of pre-sliding, m.
        reach_m: f64,
        /// State, −1…1.
        state: f64,
    },
    /// Dahl's bristles with damping `damping_s` of their own deflection.
    LuGre {
        /// Distance that sets the scale of pre-sliding, m.
        reach_m: f64,
        /// Damping of the bristles over their stiffness, s.
        damping_s: f64,
        /// State, −1…1.
        state: f64,
        /// Rate of the state, 1/s.
        rate: f64,
    },
    /// Elements that slip one after another: reach, weight, state.
    Slip(Vec<(f64, f64, f64)>),
    /// `dz = (1 − |z|^n (γ + β sgn(z dx))) dx/reach` with `β + γ = 1`.
    BoucWen {
        /// Distance that sets the scale of pre-sliding, m.
        reach_m: f64,
        /// Exponent `n`.
        exponent: f64,
        /// `β`.
        beta: f64,
        /// State, −1…1.
        state: f64,
    },
    /// One of the shapes that have a slope and no closed form.
    Shaped {
        /// Shape.
        shape: Shape,
        /// Distance that sets the scale of pre-sliding, m.
        reach_m: f64,
        /// State, −1…1.
        state: f64,
    },
}

impl Element {
    /// Weighted slip elements from reaches and weights, the weights brought to sum 1.
    pub fn slip(reaches_m: &[f64], weights: &[f64], start: f64) -> Self {
        let sum: f64 = weights.iter().sum();
        Self::Slip(reaches_m.iter().zip(weights).map(|(&reach_m, &weight)| (reach_m, weight / sum, start)).collect())
    }

    /// State in −1…1 (slightly beyond for damped bristles).
    pub fn state(&self) -> f64 {
        match self {
            Self::Stop { state, .. }
            | Self::Dahl { state, .. }
            | Self::BoucWen { state, .. }
            | Self::Shaped { state, .. } => *state,
            Self::LuGre { state, damping_s, rate, .. } => (state + damping_s * rate).clamp(-1.2, 1.2),
            Self::Slip(elements) => elements.iter().map(|(_, weight, state)| weight * state).sum(),
        }
    }

    /// Sets every internal state.
    pub fn set(&mut self, start: f64) {
        match self {
            Self::Stop { state, .. }
            | Self::Dahl { state, .. }
            | Self::BoucWen { state, .. }
            | Self::Shaped { state, .. } => *state = start,
            Self::LuGre { state, rate, .. } => (*state, *rate) = (start, 0.0),
            Self::Slip(elements) => elements.iter_mut().for_each(|element| element.2 = start),
        }
    }

    /// Moves by `travel_m`, positive when contracting.
    pub fn step(&mut self, travel_m: f64, dt_s: f64) {
        match self {
            Self::Stop { reach_m, state } => *state = (*state + travel_m / *reach_m).clamp(-1.0, 1.0),
            Self::Dahl { reach_m, state } => {
                let to = travel_m.signum();
                *state = to + (*state - to) * (-travel_m.abs() / *reach_m).exp();
            }
            Self::LuGre { reach_m, state, rate, .. } => {
                let to = travel_m.signum();
                let next = to + (*state - to) * (-travel_m.abs() / *reach_m).exp();
                *rate = (next - *state) / dt_s;
                *state = next;
            }
            Self::Slip(elements) => {
                for (reach_m, _, state) in elements {
                    *state = (*state + travel_m / *reach_m).clamp(-1.0, 1.0);
                }
            }
            Self::Shaped { shape, reach_m, state } => *state = shape.step(*state, travel_m / *reach_m),
            Self::BoucWen { reach_m, exponent, beta, state } => {
                let parts = (travel_m.abs() / (0.1 * *reach_m)).ceil().clamp(1.0, 60.0);
                for _ in 0..parts as usize {
                    let step = travel_m / parts / *reach_m;
                    let gamma = 1.0 - *beta;
                    let hold = gamma + *beta * (*state * step).signum();
                    *state = (*state + step * (1.0 - state.abs().powf(*exponent) * hold)).clamp(-1.0, 1.0);
                }
            }
        }
    }
}

/// Speed below which a braid counts as standing, m/s: what a good drive leaves of motion.
const STANDING_M_PER_S: f64 = 4e-5;

/// State after a push towards its direction, at most to `most`; what is beyond that already stays.
fn pushed(state: f64, push: f64, most: f64) -> f64 {
    if push > 0.0 { (state + push).min(most).max(state) } else { (state + push).max(-most).min(state) }
}

/// Friction with its state.
#[derive(Debug, Clone)]
pub struct Friction {
    /// Sizes.
    pub amplitude: Amplitude,
    /// Law of motion.
    pub element: Element,
    /// Law at standstill.
    pub standstill: Standstill,
}

impl Friction {
    /// Moves the braid by `travel_m` while the pressure rises by `rise_pa`.
    pub fn step(&mut self, travel_m: f64, rise_pa: f64, dt_s: f64) {
        let reach_pa = match self.standstill {
            Standstill::Held => f64::INFINITY,
            Standstill::FollowsPressure => 150.0,
            Standstill::SlidesAfter(reach_pa)
            | Standstill::GivesPartly { reach_pa, .. }
            | Standstill::GivesLate { reach_pa, .. } => reach_pa,
        };
        let standing = (-(travel_m / dt_s / STANDING_M_PER_S).powi(2)).exp();
        let rise_pa = match &mut self.standstill {
            Standstill::GivesLate { band_pa, place_pa, .. } => {
                let moved_pa = *place_pa + rise_pa;
                let held_pa = moved_pa.clamp(-*band_pa, *band_pa);
                // Motion renews the contacts, and with them the band.
                *place_pa = standing * held_pa;
                moved_pa - held_pa
            }
            _ => rise_pa,
        };
        let most = if let Standstill::GivesPartly { most, .. } = self.standstill { most } else { 1.0 };
        self.element.step(travel_m, dt_s);
        if standing > 1e-6 && reach_pa.is_finite() && rise_pa.abs() > 0.0 {
            let push = standing * rise_pa / reach_pa;
            match &mut self.element {
                Element::Slip(elements) => {
                    let largest_m = elements.iter().fold(0.0_f64, |most, element| most.max(element.0));
                    for (reach_m, _, state) in elements {
                        *state = pushed(*state, push * largest_m / *reach_m, most);
                    }
                }
                Element::Stop { state, .. } => *state = pushed(*state, push, most),
                Element::Dahl { state, .. }
                | Element::LuGre { state, .. }
                | Element::BoucWen { state, .. }
                | Element::Shaped { state, .. } => {
                    let to = most * push.signum();
                    if (to - *state) * push > 0.0 {
                        *state = to + (*state - to) * (-push.abs()).exp();
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
