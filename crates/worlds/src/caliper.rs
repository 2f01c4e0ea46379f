//! Calipers: the muscle file as it was measured.

use crate::draw::Dice;
use crate::muscle::Muscle;

/// How the dimensions were measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Caliper {
    /// Errors as a multiple of 0.3 mm of length, 0.07 mm of radius, 0.3°, 0.03 mm of wall and a fifth of the modulus, rms.
    Normal(f64),
    /// Tape, vernier and protractor, read to half a millimeter, a tenth (diameter and wall) and half a degree; the modulus of a
    /// datasheet.
    Rounded,
    /// A caliper that squeezes a soft tube: up to 0.2 mm too little diameter and 0.05 mm too little wall, always.
    Squeezed,
    /// A photograph whose scale is off by up to 0.6 % in length and radius alike; angle and wall as usual.
    Photographed,
}

impl Caliper {
    /// Name, for the truth.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal(times) => ["none", "usual", "double"][times as usize],
            Self::Rounded => "rounded",
            Self::Squeezed => "squeezed",
            Self::Photographed => "photographed",
        }
    }

    /// The muscle file.
    pub fn muscle_toml(self, muscle: &Muscle, dice: &mut Dice) -> String {
        let length_mm = 1e3 * muscle.rest_length_m;
        let radius_mm = 1e3 * muscle.rest_radius_m;
        let angle_deg = muscle.braid_angle_rad.to_degrees();
        let wall_mm = 1e3 * muscle.wall_m;
        let modulus_gpa = 1e-9 * muscle.strand_modulus_pa;
        let times = if let Self::Normal(times) = self { times } else { 1.0 };
        let mut error = |rms: f64| times * rms * dice.normal();
        let (length_mm, radius_mm, angle_deg, wall_mm, modulus_gpa) = match self {
            Self::Normal(_) => (
                length_mm + error(0.3),
                radius_mm + error(0.07),
                angle_deg + error(0.3),
                wall_mm + error(0.03),
                modulus_gpa * (1.0 + error(0.2)).clamp(0.4, 1.8),
            ),
            Self::Rounded => {
                let rounded = |value: f64, step: f64| (value / step).round() * step;
                (
                    rounded(length_mm + error(0.15), 0.5),
                    0.5 * rounded(2.0 * radius_mm + error(0.04), 0.1),
                    rounded(angle_deg + error(0.15), 0.5),
                    rounded(wall_mm + error(0.02), 0.1),
                    if modulus_gpa > 6.0 { 10.0 } else { 3.0 },
                )
            }
            Self::Squeezed => (
                length_mm + error(0.2),
                radius_mm - 0.02 - error(0.03).abs().min(0.08),
                angle_deg + error(0.25),
                wall_mm - error(0.02).abs().min(0.05),
                modulus_gpa * (1.0 + error(0.15)).clamp(0.6, 1.5),
            ),
            Self::Photographed => {
                let scale = 1.0 + error(0.003).clamp(-0.006, 0.006);
                (
                    scale * length_mm,
                    scale * radius_mm + error(0.03),
                    angle_deg + error(0.2),
                    wall_mm + error(0.03),
                    modulus_gpa * (1.0 + error(0.2)).clamp(0.4, 1.8),
                )
            }
        };
        format!(
            "rest_length_mm = {length_mm:.2}\nrest_radius_mm = {radius_mm:.3}\nbraid_angle_deg = {angle_deg:.2}\n\
             wall_thickness_mm = {:.3}\nstrand_count = {}\nstrand_diameter_mm = {:.3}\n\
             strand_modulus_gpa = {modulus_gpa:.2}\n",
            wall_mm.max(0.3),
            muscle.strand_count,
            1e3 * muscle.strand_diameter_m,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_caliper_stays_within_its_errors() {
        let muscle = Muscle::draw(&mut Dice::new(3, 3));
        for seed in 0..200 {
            for caliper in [Caliper::Rounded, Caliper::Squeezed, Caliper::Photographed] {
                let text = caliper.muscle_toml(&muscle, &mut Dice::new(seed, 3));
                let value = |name: &str| -> f64 {
                    let line = text.lines().find(|line| line.starts_with(name)).expect("a line");
                    line.split(" = ").nth(1).expect("a value").parse().expect("a number")
                };
                let radius_error_mm = value("rest_radius_mm") - 1e3 * muscle.rest_radius_m;
                assert!((value("rest_length_mm") - 1e3 * muscle.rest_length_m).abs() < 2.5, "{text}");
                assert!(radius_error_mm.abs() < 0.2, "{text}");
                if caliper == Caliper::Squeezed {
                    assert!((-0.11..-0.01).contains(&radius_error_mm), "{text}");
                }
                assert!((value("braid_angle_deg") - muscle.braid_angle_rad.to_degrees()).abs() < 1.2, "{text}");
            }
        }
    }
}
