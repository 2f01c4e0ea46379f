//! Tables for the n-D Lookup Table block of Simulink, as a MATLAB script that sets up their variables.
//!
//! A table has no memory: of effects that remember it holds what they come to where the muscle has long been.

use std::fmt::Write as _;
use std::path::Path;

use pam_inverse_model::InverseNetwork;

use crate::ExportError;
use crate::grid::{DIRECTIONS, Grid, evenly};

/// Cells of the inverse's table over force and over length.
const INVERSE_CELLS: usize = 48;

/// The script for a file at `path`, with `grid` and the inverse where there is one; `origin` says what it was written from, a line
/// each, and `without` which effects a table cannot hold.
///
/// # Errors
/// [`ExportError::NoName`] where the file's name gives none for a variable.
pub fn script(
    path: &Path,
    grid: &Grid,
    inverse: Option<&InverseNetwork>,
    origin: &[String],
    without: &[&str],
) -> Result<String, ExportError> {
    let prefix = crate::c::prefix(path)?;
    let name =
        if prefix.ends_with("table_") { prefix.trim_end_matches('_').to_owned() } else { format!("{prefix}table") };
    let mut text =
        "% Settled force of a pneumatic muscle over pressure, length and direction of motion, in SI.\n%\n".to_owned();
    for line in origin {
        let _ = writeln!(text, "% {line}");
    }
    let (low_n, high_n) = grid.range_n();
    let _ = write!(
        text,
        "%\n% n-D Lookup Table block, 3 dimensions, linear: breakpoints {name}.pressure_pa, {name}.length_m and\n\
         % {name}.direction (+1 contracting, -1 extending), table data {name}.force_n. Clip the inputs: outside, the model was\n\
         % never identified. Interpolation is off by {:.3} N at most in the middle of a cell, of {low_n:.0} to {high_n:.0} N.\n",
        grid.interpolation_error_n
    );
    if !without.is_empty() {
        let _ = writeln!(
            text,
            "% A table has no memory and no speed. These effects are in it as they settle: {}.",
            without.join(", ")
        );
    }
    text.push('\n');
    vector(&mut text, &format!("{name}.pressure_pa"), &grid.pressure_pa);
    vector(&mut text, &format!("{name}.length_m"), &grid.length_m);
    vector(&mut text, &format!("{name}.direction"), &DIRECTIONS);
    let sizes = [grid.pressure_pa.len(), grid.length_m.len(), DIRECTIONS.len()];
    array(&mut text, &format!("{name}.force_n"), &grid.force_n, sizes);
    if let Some(network) = inverse {
        inverse_table(&mut text, &name, network);
    }
    Ok(text)
}

/// The network over force, length and direction, kept within its pressures; where it must not be relied on is a table too.
fn inverse_table(text: &mut String, name: &str, network: &InverseNetwork) {
    let domain = network.domain();
    let (forces_n, lengths_m) = (evenly(domain.force_n, INVERSE_CELLS), evenly(domain.length_m, INVERSE_CELLS));
    let (mut pressures_pa, mut outside) = (Vec::new(), Vec::new());
    for direction in DIRECTIONS {
        for &length_m in &lengths_m {
            for &force_n in &forces_n {
                let found = network.pressure_pa(force_n, length_m, direction);
                pressures_pa.push(found.pressure_pa.clamp(domain.pressure_pa[0], domain.pressure_pa[1]));
                outside.push(f64::from(u8::from(found.outside)));
            }
        }
    }
    let _ = write!(
        text,
        "\n% Inverse: pressure over force, length and direction. Where {name}.inverse.outside is above 0 no pressure gives the force.\n"
    );
    let sizes = [forces_n.len(), lengths_m.len(), DIRECTIONS.len()];
    vector(text, &format!("{name}.inverse.force_n"), &forces_n);
    vector(text, &format!("{name}.inverse.length_m"), &lengths_m);
    vector(text, &format!("{name}.inverse.direction"), &DIRECTIONS);
    array(text, &format!("{name}.inverse.pressure_pa"), &pressures_pa, sizes);
    array(text, &format!("{name}.inverse.outside"), &outside, sizes);
}

fn vector(text: &mut String, name: &str, values: &[f64]) {
    let _ = writeln!(text, "{name} = [{}];", listed(values));
}

/// Values with the first dimension fastest, as MATLAB has its arrays.
fn array(text: &mut String, name: &str, values: &[f64], sizes: [usize; 3]) {
    let _ = writeln!(text, "{name} = reshape([ ...");
    for row in values.chunks(sizes[0]) {
        let _ = writeln!(text, "  {} ...", listed(row));
    }
    let [rows, columns, planes] = sizes;
    let _ = writeln!(text, "], [{rows} {columns} {planes}]);");
}

fn listed(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
    values.join(" ")
}
