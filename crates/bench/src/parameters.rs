//! Parameters of the muscle's tension, by name and in SI.

/// Modulus of nylon monofilament, in Pa (2–4 GPa).
pub const NYLON_MODULUS_PA: f64 = 3e9;

/// Parameters of the muscle's tension, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// Gain of the gas term, `k₁`.
    pub k1: f64,
    /// Contraction gain of the gas term, `k₂`.
    pub k2: f64,
    /// Constant force `k₃`, in N.
    pub k3_n: f64,
    /// First Mooney–Rivlin constant `C₁₀`, in Pa.
    pub c10_pa: f64,
    /// Second Mooney–Rivlin constant `C₀₁`, in Pa.
    pub c01_pa: f64,
    /// Modulus of the strands `E` as they stretch, in Pa.
    pub strand_modulus_pa: f64,
    /// Friction of the braid on the bladder `f'`, as a share of the normal force.
    pub rubber_friction: f64,
    /// Friction of strand on strand, `f_ss / S_scale`.
    pub strand_friction: f64,
}

impl Parameters {
    /// Names that [`Parameters::set`] knows, with the unit of each.
    pub const NAMES: [(&'static str, &'static str); 8] = [
        ("k1", "1"),
        ("k2", "1"),
        ("k3", "N"),
        ("c10", "Pa"),
        ("c01", "Pa"),
        ("strand_modulus", "Pa"),
        ("rubber_friction", "1"),
        ("strand_friction", "1"),
    ];

    /// Latex on nylon, with the friction of strand on strand left to that on the bladder.
    ///
    /// The Mooney–Rivlin constants are those of latex after Klute and Hannaford (2000); the rest is of
    /// the order that published muscles show.
    pub fn nominal() -> Self {
        Self {
            k1: 0.9,
            k2: 1.05,
            k3_n: 2.0,
            c10_pa: 118.4e3,
            c01_pa: 105.7e3,
            strand_modulus_pa: NYLON_MODULUS_PA,
            rubber_friction: 1.2e-3,
            strand_friction: 0.0,
        }
    }

    /// The values in the order of [`Parameters::NAMES`].
    pub fn values(&self) -> [f64; 8] {
        [
            self.k1,
            self.k2,
            self.k3_n,
            self.c10_pa,
            self.c01_pa,
            self.strand_modulus_pa,
            self.rubber_friction,
            self.strand_friction,
        ]
    }

    /// Sets one parameter by name, in SI.
    ///
    /// # Errors
    /// [`ParameterError`] if there is no such parameter, or no muscle has such a value.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let (slot, lowest, highest) = match name {
            "k1" => (&mut self.k1, 0.0, 2.0),
            "k2" => (&mut self.k2, 0.0, 2.0),
            "k3" => (&mut self.k3_n, -1e3, 1e3),
            "c10" => (&mut self.c10_pa, 0.0, 1e8),
            "c01" => (&mut self.c01_pa, 0.0, 1e8),
            "strand_modulus" => (&mut self.strand_modulus_pa, 1e7, 1e15),
            "rubber_friction" => (&mut self.rubber_friction, 0.0, 0.1),
            "strand_friction" => (&mut self.strand_friction, 0.0, 100.0),
            _ => return Err(ParameterError::Unknown { name: name.to_owned() }),
        };
        if !(lowest..=highest).contains(&value) {
            return Err(ParameterError::OutOfRange { name: name.to_owned(), value, lowest, highest });
        }
        *slot = value;
        Ok(())
    }
}

/// Why a parameter is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// No parameter has this name.
    #[error("the muscle has no parameter \"{name}\"")]
    Unknown {
        /// Name asked for.
        name: String,
    },
    /// A value that no muscle has.
    #[error("{name} = {} is outside {lowest} to {highest}; values are in SI", pam_recording::spelling::number(*value))]
    OutOfRange {
        /// Parameter.
        name: String,
        /// Value asked for.
        value: f64,
        /// Lowest value accepted.
        lowest: f64,
        /// Highest value accepted.
        highest: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_that_does_not_exist_or_cannot_be_is_refused() {
        let mut parameters = Parameters::nominal();
        let unknown = ParameterError::Unknown { name: "k4".to_owned() };
        assert_eq!(parameters.set("k4", 1.0), Err(unknown));
        let message = parameters.set("rubber_friction", 0.5).unwrap_err().to_string();
        assert_eq!(message, "rubber_friction = 0.5 is outside 0 to 0.1; values are in SI");
        assert_eq!(parameters, Parameters::nominal());
    }

    #[test]
    fn every_listed_parameter_can_be_set() {
        for (index, (name, _)) in Parameters::NAMES.into_iter().enumerate() {
            let mut parameters = Parameters::nominal();
            let value = if name == "strand_modulus" { 2e9 } else { 0.05 };
            parameters.set(name, value).unwrap();
            assert_eq!(parameters.values()[index], value, "{name}");
        }
    }
}
