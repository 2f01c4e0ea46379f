//! What a refit of the base parameters can absorb: the tangent space of eq. 11 over some rows.

use std::ops::Range;

use nalgebra::DMatrix;
use pam_identification::problem::ForceProblem;
use pam_muscle::force::columns::N_COLUMNS;

use crate::design_matrix::DesignMatrix;
use crate::state::{Setting, State};

/// Orthonormal directions over weighted rows.
#[derive(Debug)]
pub(crate) struct Tangent {
    /// Rows of the sheet that take part, in groups over which means are taken.
    groups: Vec<Range<usize>>,
    /// Root of the weight of each group; their squares sum up to one.
    roots: Vec<f64>,
    directions: Vec<Vec<f64>>,
}

/// Share of a direction that must be left beside those before it.
const LEAST_LEFT: f64 = 1e-9;

impl Tangent {
    /// Of the base parameters of `state` over groups of rows of `sheet`, each with the weight beside it. A parameter that presses
    /// against its range counts as free: with another effect in the model it may let go.
    pub(crate) fn of(
        setting: &Setting<'_>,
        state: &State,
        sheet: &DesignMatrix,
        groups: Vec<(Range<usize>, f64)>,
    ) -> Self {
        let total: f64 = groups.iter().map(|(_, weight)| weight).sum();
        let roots: Vec<f64> = groups.iter().map(|(_, weight)| (weight / total.max(f64::MIN_POSITIVE)).sqrt()).collect();
        let groups = groups.into_iter().map(|(group, _)| group).collect();
        let empty = pam_optim::summary::Summary::new(N_COLUMNS);
        let problem = ForceProblem { summary: &empty, columns: setting.columns, space: setting.space, steps: &[] };
        let slopes: DMatrix<f64> = problem.weight_jacobian(&state.fit.x[..setting.space.free.len()]);
        let mut tangent = Self { groups, roots, directions: Vec::new() };
        for slope in slopes.column_iter() {
            let mut direction = tangent.means(|row| {
                let columns = &sheet.columns[row * sheet.width..row * sheet.width + N_COLUMNS];
                columns.iter().zip(slope.iter()).map(|(column, slope)| column * slope).sum()
            });
            let before = norm(&direction);
            // Twice is enough (Kahan): what rounding leaves of the first pass goes with the second.
            tangent.remove(&mut direction);
            tangent.remove(&mut direction);
            let left = norm(&direction);
            if left > LEAST_LEFT * before {
                direction.iter_mut().for_each(|value| *value /= left);
                tangent.directions.push(direction);
            }
        }
        tangent
    }

    /// Mean of `value` over each group, times the root of its weight.
    fn means(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        self.groups
            .iter()
            .zip(&self.roots)
            .map(|(group, root)| root * group.clone().map(&value).sum::<f64>() / group.len().max(1) as f64)
            .collect()
    }

    fn remove(&self, values: &mut [f64]) {
        for direction in &self.directions {
            let share = dot(direction, values);
            for (value, along) in values.iter_mut().zip(direction) {
                *value -= share * along;
            }
        }
    }

    /// What a refit leaves of `force_n` (a function of the row), times the roots of the weights: its norm is the root mean
    /// square. Zero where nothing but rounding is left.
    pub(crate) fn left_of(&self, force_n: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut values = self.means(force_n);
        let before = norm(&values);
        self.remove(&mut values);
        self.remove(&mut values);
        if norm(&values) <= LEAST_LEFT * before {
            values.fill(0.0);
        }
        values
    }
}

pub(crate) fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(left, right)| left * right).sum()
}

pub(crate) fn norm(values: &[f64]) -> f64 {
    dot(values, values).sqrt()
}
