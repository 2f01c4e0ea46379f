//! The file of a muscle, in millimeters and degrees, and why one is refused.

use std::path::{Path, PathBuf};

use pam_recording::spelling::{nearest, number};
use pam_recording::toml_file::{self, TomlFileError};
use serde::Deserialize;

use crate::geometry::{Dimension, Muscle};

/// A muscle file: what was measured, and which of it a fit may adjust.
#[derive(Debug, Clone, PartialEq)]
pub struct MuscleFile {
    /// Name for reports and figures, where the file gives one.
    pub name: Option<String>,
    /// Dimensions as measured.
    pub muscle: Muscle,
    /// Dimensions that are to be fitted, in the order of [`Dimension::ALL`].
    pub fit: Vec<Dimension>,
    /// Modulus of the strands, in Pa, for the contact between them; nylon unless the file says otherwise.
    pub strand_modulus_pa: f64,
}

/// The file as written: millimeters and degrees, unknown keys rejected.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct MuscleToml {
    #[serde(default)]
    name: Option<String>,
    rest_length_mm: f64,
    rest_radius_mm: f64,
    braid_angle_deg: f64,
    wall_thickness_mm: f64,
    strand_count: f64,
    strand_diameter_mm: f64,
    #[serde(default = "nylon_modulus_gpa")]
    strand_modulus_gpa: f64,
    #[serde(default)]
    fit: Vec<String>,
}

/// Nylon monofilament, 2–4 GPa.
fn nylon_modulus_gpa() -> f64 {
    3.0
}

/// Why a muscle file is refused.
#[derive(Debug, thiserror::Error)]
pub enum MuscleError {
    /// It cannot be read, or is no TOML of its kind.
    #[error(transparent)]
    File(#[from] TomlFileError),
    /// A value that no muscle has.
    #[error("{}: {key} = {} is outside {lowest} to {highest}; check the value and its unit", path.display(), number(*value))]
    OutOfRange {
        /// File being read.
        path: PathBuf,
        /// Key in the file.
        key: &'static str,
        /// Value found.
        value: f64,
        /// Lowest value accepted.
        lowest: f64,
        /// Highest value accepted.
        highest: f64,
    },
    /// A dimension to be fitted that does not exist or cannot be fitted.
    #[error("{}: fit names \"{name}\"; {remedy}", path.display())]
    UnknownDimension {
        /// File being read.
        path: PathBuf,
        /// Name found.
        name: String,
        /// What to write instead.
        remedy: String,
    },
}

impl MuscleFile {
    /// Reads and checks a muscle file.
    ///
    /// # Errors
    /// [`MuscleError`] names the file, and the key or the line, and what to do.
    pub fn read(path: &Path) -> Result<Self, MuscleError> {
        Self::read_with_text(path).map(|(file, _)| file)
    }

    /// As [`MuscleFile::read`], with the text that was parsed: a pipe cannot be read again for its digest.
    ///
    /// # Errors
    /// See [`MuscleFile::read`].
    pub fn read_with_text(path: &Path) -> Result<(Self, String), MuscleError> {
        let text = toml_file::read_text(path, "muscle file")?;
        Ok((Self::parse(&text, path)?, text))
    }

    /// Parses the text of a muscle file; `path` is for messages.
    ///
    /// # Errors
    /// See [`MuscleFile::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, MuscleError> {
        let written: MuscleToml = toml_file::parse(text, path)?;
        let within = |key, value: f64, lowest, highest| {
            if value >= lowest && value <= highest {
                Ok(value)
            } else {
                Err(MuscleError::OutOfRange { path: path.to_owned(), key, value, lowest, highest })
            }
        };
        let muscle = Muscle {
            rest_length_m: within("rest_length_mm", written.rest_length_mm, 10.0, 5000.0)? * 1e-3,
            rest_radius_m: within("rest_radius_mm", written.rest_radius_mm, 0.5, 100.0)? * 1e-3,
            braid_angle_rad: within("braid_angle_deg", written.braid_angle_deg, 5.0, 54.0)?.to_radians(),
            wall_thickness_m: within(
                "wall_thickness_mm",
                written.wall_thickness_mm,
                0.05,
                0.9 * written.rest_radius_mm,
            )? * 1e-3,
            strand_count: within("strand_count", written.strand_count, 4.0, 5000.0)?,
            strand_diameter_m: within("strand_diameter_mm", written.strand_diameter_mm, 0.01, 5.0)? * 1e-3,
        };
        let mut fit = Vec::new();
        for name in written.fit {
            let Some(dimension) = Dimension::ALL.into_iter().find(|dimension| dimension.key() == name) else {
                let remedy = if name.starts_with("strand_") {
                    "the strands act only through their modulus, which is always fitted".to_owned()
                } else if let Some(near) = nearest(&name, Dimension::ALL.map(Dimension::key)) {
                    format!("did you mean \"{near}\"?")
                } else {
                    format!("it can name {}", Dimension::ALL.map(Dimension::key).join(", "))
                };
                return Err(MuscleError::UnknownDimension { path: path.to_owned(), name, remedy });
            };
            fit.push(dimension);
        }
        fit.sort_unstable();
        fit.dedup();
        let strand_modulus_pa = within("strand_modulus_gpa", written.strand_modulus_gpa, 0.01, 500.0)? * 1e9;
        let name = written.name.map(|name| name.trim().to_owned()).filter(|name| !name.is_empty());
        Ok(Self { name, muscle, fit, strand_modulus_pa })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_muscle_file_in_the_wrong_unit_is_refused_by_name() {
        let text = "rest_length_mm = 0.267\nrest_radius_mm = 10\nbraid_angle_deg = 25\nwall_thickness_mm = 1\n\
                    strand_count = 240\nstrand_diameter_mm = 0.25\n";
        let message = MuscleFile::parse(text, Path::new("m.toml")).unwrap_err().to_string();
        assert_eq!(message, "m.toml: rest_length_mm = 0.267 is outside 10 to 5000; check the value and its unit");
    }

    #[test]
    fn a_misspelt_word_gets_the_nearest_one() {
        let text = "rest_length_mm = 267\nrest_radius_mm = 10\nbraid_angle_deg = 25\nwall_thickness_mm = 1\n\
                    strand_count = 240\nstrand_diameter_mm = 0.25\n";
        let message = |text: &str| MuscleFile::parse(text, Path::new("m.toml")).unwrap_err().to_string();
        assert_eq!(
            message(&text.replace("rest_radius", "rest_raduis")),
            "m.toml:2:1: unknown field `rest_raduis_mm`; did you mean `rest_radius_mm`?"
        );
        assert_eq!(
            message(&format!("{text}fit = [\"braid_angel_deg\"]\n")),
            "m.toml: fit names \"braid_angel_deg\"; did you mean \"braid_angle_deg\"?"
        );
    }

    #[test]
    fn a_dimension_that_cannot_be_fitted_is_refused_with_the_reason() {
        let text = "rest_length_mm = 267\nrest_radius_mm = 10\nbraid_angle_deg = 25\nwall_thickness_mm = 1\n\
                    strand_count = 240\nstrand_diameter_mm = 0.25\nfit = [\"strand_count\"]\n";
        let message = MuscleFile::parse(text, Path::new("m.toml")).unwrap_err().to_string();
        assert_eq!(
            message,
            "m.toml: fit names \"strand_count\"; the strands act only through their modulus, which is always fitted"
        );
    }
}
