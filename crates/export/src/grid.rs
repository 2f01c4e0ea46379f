//! Settled force on a grid over the operating range, fine enough for linear interpolation.

use pam_artifact::model::Domain;
use pam_muscle::effects::AugmentedModel;

use crate::ExportError;

/// Directions of the grid; between them the friction is proportional to the direction.
pub const DIRECTIONS: [f64; 3] = [-1.0, 0.0, 1.0];

/// Largest error of the interpolation that a grid stops at, as a share of the range of force.
const ERROR_SHARE: f64 = 5e-4;
/// Cells per coordinate, fewest and most; each try has twice as many.
const CELLS: (usize, usize) = (8, 128);

/// Settled force of a muscle.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Gauge pressures, rising, in Pa.
    pub pressure_pa: Vec<f64>,
    /// Lengths, rising, in m.
    pub length_m: Vec<f64>,
    /// Forces, in N: `pressure × length × direction`, the pressure fastest, as MATLAB has its arrays.
    pub force_n: Vec<f64>,
    /// Largest error of linear interpolation in the middle of a cell, in N.
    pub interpolation_error_n: f64,
}

impl Grid {
    /// The force of `model` over what it was identified on.
    ///
    /// # Errors
    /// [`ExportError::NoRange`] where that is a single pressure or length, [`ExportError::WithoutForce`] where the model has no
    /// force there.
    pub fn of(model: &AugmentedModel, domain: &Domain) -> Result<Self, ExportError> {
        for (what, [from, to]) in [("pressure", domain.pressure_pa), ("length", domain.length_m)] {
            if from >= to {
                return Err(ExportError::NoRange { what });
            }
        }
        let mut cells = CELLS.0;
        loop {
            let grid = Self::with_cells(model, domain, cells)?;
            let (lowest, highest) = grid.range_n();
            if cells == CELLS.1 || grid.interpolation_error_n <= ERROR_SHARE * (highest - lowest) {
                return Ok(grid);
            }
            cells *= 2;
        }
    }

    fn with_cells(model: &AugmentedModel, domain: &Domain, cells: usize) -> Result<Self, ExportError> {
        let pressure_pa = evenly(domain.pressure_pa, cells);
        let length_m = evenly(domain.length_m, cells);
        let force_n = |pressure_pa: f64, length_m: f64, direction: f64| {
            let force_n = model.settled_force_n(pressure_pa, length_m, direction);
            if force_n.is_finite() { Ok(force_n) } else { Err(ExportError::WithoutForce { pressure_pa, length_m }) }
        };
        let mut grid = Self { pressure_pa, length_m, force_n: Vec::new(), interpolation_error_n: 0.0 };
        for direction in DIRECTIONS {
            for &length_m in &grid.length_m {
                for &pressure_pa in &grid.pressure_pa {
                    grid.force_n.push(force_n(pressure_pa, length_m, direction)?);
                }
            }
        }
        for (plane, direction) in DIRECTIONS.into_iter().enumerate() {
            for (column, lengths) in grid.length_m.windows(2).enumerate() {
                for (row, pressures) in grid.pressure_pa.windows(2).enumerate() {
                    let corner = |r: usize, c: usize| grid.at(row + r, column + c, plane);
                    let middle_n = 0.25 * (corner(0, 0) + corner(1, 0) + corner(0, 1) + corner(1, 1));
                    let exact_n =
                        force_n(0.5 * (pressures[0] + pressures[1]), 0.5 * (lengths[0] + lengths[1]), direction)?;
                    grid.interpolation_error_n = grid.interpolation_error_n.max((middle_n - exact_n).abs());
                }
            }
        }
        Ok(grid)
    }

    /// Force at a pressure, a length and a direction by their numbers, in N.
    pub fn at(&self, pressure: usize, length: usize, direction: usize) -> f64 {
        self.force_n[(direction * self.length_m.len() + length) * self.pressure_pa.len() + pressure]
    }

    /// Lowest and highest force, in N.
    pub fn range_n(&self) -> (f64, f64) {
        let widened = |(low, high): (f64, f64), force: &f64| (low.min(*force), high.max(*force));
        self.force_n.iter().fold((f64::INFINITY, f64::NEG_INFINITY), widened)
    }
}

/// `cells + 1` values from end to end.
pub(crate) fn evenly([from, to]: [f64; 2], cells: usize) -> Vec<f64> {
    (0..=cells).map(|index| from + (to - from) * index as f64 / cells as f64).collect()
}
