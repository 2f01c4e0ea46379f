//! Sentences as equations.

use super::{Curve, Driver, Recall, Scale, Sentence};

impl Sentence {
    /// The equation, in plain text: `F = F_base + S f(m(d))` with the symbols of its parts.
    pub fn equation(&self) -> String {
        let argument = self.memory.equation(self.driver.symbol());
        let curve = self.shape.equation(&argument);
        match self.scale.symbol() {
            "" => format!("F = F_base + {curve}"),
            scale => format!("F = F_base + {scale} {curve}"),
        }
    }
}

impl Driver {
    /// Symbol in equations.
    pub fn symbol(&self) -> &'static str {
        match self {
            Self::Pressure => "p",
            Self::Contraction => "ε",
            Self::Speed => "v",
            Self::Force => "F_static",
            Self::Time => "t",
            Self::TravelSinceReversal => "x_r",
            Self::TimeSinceLastMove { .. } => "t_rest",
            Self::TimeSincePressureMoved { .. } => "t_hold",
            Self::Cycle => "N",
        }
    }
}

impl Recall {
    fn equation(&self, driver: &str) -> String {
        match self {
            Self::None => driver.to_owned(),
            Self::Lag { .. } => format!("{driver} - lag_τ({driver})"),
            Self::TwoLags { .. } => format!("{driver} - lag_τ₂(lag_τ₁({driver}))"),
            Self::Play { .. } => format!("{driver} - play_h({driver})"),
            Self::Dahl { .. } => format!("z_d({driver})"),
            Self::Largest => format!("max({driver}) - {driver}"),
            Self::Travelled => format!("Σ|Δ{driver}|"),
            Self::Work => "Σ F_static |ΔL|".to_owned(),
        }
    }
}

impl Scale {
    fn symbol(self) -> &'static str {
        match self {
            Self::One => "",
            Self::Pressure => "p",
            Self::GasForce => "F_gas",
            Self::BladderForce => "F_latex",
            Self::Friction => "s p π D L",
            Self::Direction => "s",
            Self::Contracting => "(1 + s)/2",
            Self::Extending => "(1 - s)/2",
            Self::SlopeOverPressure => "∂F/∂p",
            Self::SlopeOverLength => "∂F/∂L",
        }
    }
}

impl Curve {
    fn equation(&self, argument: &str) -> String {
        match self {
            Self::Line => format!("a ({argument})"),
            Self::Saturation { .. } => format!("a sgn(u) (1 - exp(-|u| / u₀)), u = {argument} - u₁"),
            Self::Bump { .. } => format!("a exp(-(({argument} - c) / w)²)"),
            Self::Monotone { .. } | Self::Spline { .. } => format!("f({argument})"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_reads_as_an_equation() {
        let lag = Sentence {
            driver: Driver::Pressure,
            memory: Recall::Lag { time_constant_s: 0.3 },
            scale: Scale::SlopeOverPressure,
            shape: Curve::Line,
            seen: [-1e4, 1e4],
        };
        let bump = Sentence {
            driver: Driver::Contraction,
            memory: Recall::None,
            scale: Scale::One,
            shape: Curve::Bump { center: 0.12, width: 0.01 },
            seen: [0.0, 0.2],
        };
        insta::assert_snapshot!(format!("{}\n{}", lag.equation(), bump.equation()), @r"
        F = F_base + ∂F/∂p a (p - lag_τ(p))
        F = F_base + a exp(-((ε - c) / w)²)
        ");
    }
}
