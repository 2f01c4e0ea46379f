//! A program that checks a header against test vectors.

use std::fmt::Write as _;
use std::path::Path;

use pam_inverse_model::InverseNetwork;

use super::constants::number;
use super::header::Names;
use super::parts::{CHECK, CHECK_INVERSE};
use crate::ExportError;
use crate::vectors::Vector;

/// Steps of force, length and direction at which an inverse is checked, beyond its range on either side.
const INVERSE_STEPS: [u32; 3] = [7, 9, 3];
/// How far beyond, as a share of the range.
const BEYOND: f64 = 0.05;

/// The program for a header at `path`, to be written at `program`, with `vectors` in it.
///
/// # Errors
/// [`ExportError::NoName`] where the file's name gives none for C.
pub fn check_program(
    path: &Path,
    program: &Path,
    vectors: &[Vector],
    inverse: Option<&InverseNetwork>,
) -> Result<String, ExportError> {
    let names = Names::of(path)?;
    let file_name = |path: &Path| path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let text = names.put_into(CHECK);
    let text = text.replace("@HEADER@", &file_name(path)).replace("@PROGRAM@", &file_name(program));
    let text = text.replace("@VECTORS@", &rows(vectors.iter().map(Vector::values)));
    let (check, main) = match inverse {
        Some(network) => {
            let rows = rows(inverse_vectors(network).into_iter());
            (names.put_into(CHECK_INVERSE).replace("@VECTORS@", &rows), "    failed |= check_inverse();\n")
        }
        None => (String::new(), ""),
    };
    Ok(text.replace("@INVERSE_CHECK@\n", &check).replace("@INVERSE_MAIN@\n", main))
}

fn rows<const N: usize>(rows: impl Iterator<Item = [f64; N]>) -> String {
    let lines: Vec<String> = rows
        .map(|row| {
            let mut line = "    {".to_owned();
            for (index, value) in row.into_iter().enumerate() {
                let _ = write!(line, "{}{}", if index > 0 { ", " } else { "" }, number(value));
            }
            line.push_str("},");
            line
        })
        .collect();
    lines.join("\n")
}

/// Force, length, direction, pressure and whether that is outside, over a grid that goes beyond the domain.
fn inverse_vectors(network: &InverseNetwork) -> Vec<[f64; 5]> {
    let [forces, lengths, directions] = INVERSE_STEPS;
    let domain = network.domain();
    let at = |[from, to]: [f64; 2], index: u32, n: u32| {
        let share = f64::from(index) / f64::from(n - 1);
        from + (to - from) * (share * (1.0 + 2.0 * BEYOND) - BEYOND)
    };
    let mut vectors = Vec::new();
    for length in 0..lengths {
        for direction in 0..directions {
            for force in 0..forces {
                let length_m = at(domain.length_m, length, lengths);
                let direction = -1.0 + 2.0 * f64::from(direction) / f64::from(directions - 1);
                let force_n = at(domain.force_n, force, forces);
                let found = network.pressure_pa(force_n, length_m, direction);
                let outside = f64::from(u8::from(found.outside));
                vectors.push([force_n, length_m, direction, found.pressure_pa, outside]);
            }
        }
    }
    vectors
}
