//! Freed dimensions of the muscle: the slow path.
//!
//! Columns depend on the dimensions, so that every change of one needs another pass over the recordings. The
//! search has two stages. A small swarm over the dimensions alone looks at every so-many-th row, and at
//! each of its places solves for the other parameters. From the best place, Gauss–Newton goes on with all
//! rows: each pass adds the derivative of the force by each dimension as a column, and one bounded descent
//! moves dimensions and parameters together.

use std::ops::ControlFlow;

use pam_muscle::force::ForceModel;
use pam_muscle::force::columns::{ForceColumns, N_COLUMNS};
use pam_muscle::force::{BaseParameters, Form};
use pam_muscle::{Dimension, Muscle};
use pam_optim::polish::descend;
use pam_optim::swarm::{SwarmOptions, minimize};

use crate::condense::{Columns, Condensed, condense};
use crate::error::IdentifyError;
use crate::prepare::Prepared;
use crate::problem::ForceProblem;
use crate::search_space::SearchSpace;

/// Rows that the swarm looks at, about.
const SWARM_ROWS: usize = 3000;
const PARTICLES_PER_DIMENSION: usize = 8;
const SWARM_ITERATIONS: usize = 15;
const MAX_PASSES: usize = 25;

/// What stays the same while dimensions move.
#[derive(Debug, Clone, Copy)]
pub struct Setting<'a> {
    /// Estimation recordings.
    pub recordings: &'a [Prepared],
    /// The muscle as measured.
    pub muscle: &'a Muscle,
    /// Modulus of the strands for their contact, in Pa.
    pub strand_modulus_pa: f64,
    /// How eq. 11 is written.
    pub form: Form,
    /// Largest pressure times length, in N/m.
    pub largest_n_per_m: f64,
    /// Dimensions that are freed.
    pub freed: &'a [Dimension],
    /// Parameters that are fitted.
    pub space: &'a SearchSpace,
    /// Seed of the swarm.
    pub seed: u64,
}

/// Dimensions and parameters found together.
#[derive(Debug)]
pub struct FreedFit {
    /// The muscle with its fitted dimensions.
    pub muscle: Muscle,
    /// Columns of eq. 11 for it.
    pub columns: ForceColumns,
    /// Recordings, condensed with the derivatives by the dimensions behind the columns of eq. 11.
    pub condensed: Condensed,
    /// Ranges that the dimensions may still move in, relative to where they are, in SI.
    pub steps: Vec<(f64, f64)>,
    /// Point of the unit box: parameters, then dimensions.
    pub x: Vec<f64>,
    /// Coordinates that press against the box.
    pub at_bound: Vec<bool>,
    /// Whether the passes came to rest.
    pub converged: bool,
}

/// Columns of eq. 11 and the derivatives of the force by each freed dimension.
struct Linearized {
    columns: ForceColumns,
    around: Vec<(ForceModel, ForceModel, f64)>,
}

impl Linearized {
    fn new(setting: &Setting<'_>, muscle: &Muscle, parameters: BaseParameters) -> Self {
        let model = |muscle: &Muscle| ForceModel::new(muscle, setting.strand_modulus_pa, setting.form, parameters);
        let around = setting
            .freed
            .iter()
            .map(|&dimension| {
                let (low, high) = dimension.fit_range(setting.muscle);
                let step = 1e-5 * (high - low);
                let value = dimension.of(muscle);
                (model(&dimension.set(muscle, value + step)), model(&dimension.set(muscle, value - step)), 2.0 * step)
            })
            .collect();
        Self { columns: columns_of(setting, muscle), around }
    }
}

impl Columns for Linearized {
    fn n_columns(&self) -> usize {
        N_COLUMNS + self.around.len()
    }

    fn fill(&self, pressure_pa: f64, length_m: f64, direction: f64, row: &mut [f64]) {
        self.columns.fill(pressure_pa, length_m, direction, &mut row[..N_COLUMNS]);
        for (value, (up, down, span)) in row[N_COLUMNS..].iter_mut().zip(&self.around) {
            *value =
                (up.force_n(pressure_pa, length_m, direction) - down.force_n(pressure_pa, length_m, direction)) / span;
        }
    }
}

fn columns_of(setting: &Setting<'_>, muscle: &Muscle) -> ForceColumns {
    ForceColumns::new(muscle, setting.strand_modulus_pa, setting.form, setting.largest_n_per_m)
}

/// Fits dimensions and parameters together, from `start` (a point of the search space's unit box).
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn fit_freed(setting: &Setting<'_>, start: &[f64]) -> Result<FreedFit, IdentifyError> {
    let mut muscle = swarm_over_dimensions(setting, start)?;
    let n_free = setting.space.free.len();
    let mut x = start.to_vec();
    let mut best: Option<(f64, Muscle, Vec<f64>)> = None;
    let mut converged = false;
    for _ in 0..MAX_PASSES {
        let linearized = Linearized::new(setting, &muscle, setting.space.parameters(&x));
        let condensed = condense(setting.recordings, &linearized, 1, None)?;
        let steps = steps_left(setting, &muscle);
        let columns = linearized.columns;
        let problem =
            ForceProblem { summary: &condensed.total, columns: &columns, space: setting.space, steps: &steps };
        let here = problem.mean_square(&with_rest(&x, &steps));
        if let Some((best_here, best_muscle, best_x)) = &best
            && here > best_here * (1.0 + 1e-12)
        {
            // The straight line overshot: half the way back.
            for &dimension in setting.freed {
                let middle = 0.5 * (dimension.of(&muscle) + dimension.of(best_muscle));
                muscle = dimension.set(&muscle, middle);
            }
            for (value, best) in x.iter_mut().zip(best_x) {
                *value = 0.5 * (*value + best);
            }
            continue;
        }
        best = Some((here, muscle.clone(), x.clone()));
        let polished = descend(&problem, &with_rest(&x, &steps));
        let mut moved = 0.0_f64;
        for (index, &dimension) in setting.freed.iter().enumerate() {
            let (low, high) = steps[index];
            let step = low + polished.x[n_free + index] * (high - low);
            moved = moved.max((step / (high - low)).abs());
            muscle = dimension.set(&muscle, dimension.of(&muscle) + step);
        }
        x = polished.x[..n_free].to_vec();
        if moved < 1e-7 {
            converged = polished.termination.converged();
            break;
        }
    }
    finish(setting, muscle, &x, converged)
}

/// The last pass: columns and derivatives at the place that was found.
fn finish(setting: &Setting<'_>, muscle: Muscle, x: &[f64], converged: bool) -> Result<FreedFit, IdentifyError> {
    let linearized = Linearized::new(setting, &muscle, setting.space.parameters(x));
    let condensed = condense(setting.recordings, &linearized, 1, None)?;
    let steps = steps_left(setting, &muscle);
    let columns = linearized.columns;
    let polished = {
        let problem =
            ForceProblem { summary: &condensed.total, columns: &columns, space: setting.space, steps: &steps };
        descend(&problem, &with_rest(x, &steps))
    };
    // A dimension is at its bound where no room is left in the direction that it presses.
    Ok(FreedFit { muscle, columns, condensed, steps, x: polished.x, at_bound: polished.at_bound, converged })
}

/// `x` with the coordinates after it that leave the dimensions where they are.
fn with_rest(x: &[f64], steps: &[(f64, f64)]) -> Vec<f64> {
    x.iter().copied().chain(steps.iter().map(|(low, high)| -low / (high - low))).collect()
}

fn steps_left(setting: &Setting<'_>, muscle: &Muscle) -> Vec<(f64, f64)> {
    setting
        .freed
        .iter()
        .map(|&dimension| {
            let (low, high) = dimension.fit_range(setting.muscle);
            let value = dimension.of(muscle);
            (low - value, high - value)
        })
        .collect()
}

/// The best place of a small swarm over the dimensions, on a share of the rows.
fn swarm_over_dimensions(setting: &Setting<'_>, start: &[f64]) -> Result<Muscle, IdentifyError> {
    let n_rows: usize = setting.recordings.iter().map(|prepared| prepared.recording.samples.n_rows()).sum();
    let stride = (n_rows / SWARM_ROWS).max(1);
    let ranges: Vec<(f64, f64)> = setting.freed.iter().map(|dimension| dimension.fit_range(setting.muscle)).collect();
    let muscle_at = |x: &[f64]| {
        let mut muscle = setting.muscle.clone();
        for ((&dimension, (low, high)), x) in setting.freed.iter().zip(&ranges).zip(x) {
            muscle = dimension.set(&muscle, low + x * (high - low));
        }
        muscle
    };
    let mut failure = None;
    let mut cost = |x: &[f64]| {
        let columns = columns_of(setting, &muscle_at(x));
        match condense(setting.recordings, &columns, stride, None) {
            Ok(condensed) => {
                let problem =
                    ForceProblem { summary: &condensed.total, columns: &columns, space: setting.space, steps: &[] };
                descend(&problem, start).cost
            }
            Err(error) => {
                failure = Some(error);
                f64::INFINITY
            }
        }
    };
    let options = SwarmOptions {
        n_particles: PARTICLES_PER_DIMENSION * setting.freed.len(),
        n_iterations: SWARM_ITERATIONS,
        seed: setting.seed,
        start: 0,
    };
    let found = minimize(setting.freed.len(), None, &options, &mut cost, &mut |_, _| ControlFlow::Continue(()));
    failure.map_or(Ok(muscle_at(&found.best)), Err)
}
