//! Rows into triangles, in one pass.
//!
//! Every recording is cut into stretches of consecutive rows, and each stretch becomes a [`Summary`]. The
//! stretches are what uncertainty is judged by: neighboring samples share their errors, distant stretches do
//! not. Their merger is what the search sees. Stretches depend on the recordings alone, and are merged in
//! order, so that the number of threads changes nothing.

use std::ops::Range;

use pam_muscle::force::columns::{ForceColumns, N_COLUMNS};
use pam_optim::gathered::Gathered;
use pam_optim::summary::Summary;
use pam_recording::CHUNK_ROWS;
use rayon::prelude::*;

use crate::error::IdentifyError;
use crate::prepare::Prepared;

/// Stretches that the recordings together are cut into, about.
const STRETCHES: usize = 60;

/// Columns of a linear model of the force at one instant.
pub trait Columns: Sync {
    /// Number of columns.
    fn n_columns(&self) -> usize;
    /// Fills `row` (`n_columns` values); `direction` is +1 contracting, -1 extending.
    fn fill(&self, pressure_pa: f64, length_m: f64, direction: f64, row: &mut [f64]);
}

impl Columns for ForceColumns {
    fn n_columns(&self) -> usize {
        N_COLUMNS
    }

    fn fill(&self, pressure_pa: f64, length_m: f64, direction: f64, row: &mut [f64]) {
        row.copy_from_slice(&self.row(pressure_pa, length_m, direction));
    }
}

/// Weight of a sample in the sum of squares, from measured force and columns.
pub type SampleWeight<'a> = dyn Fn(f64, &[f64]) -> f64 + Sync + 'a;

/// One stretch of one recording.
#[derive(Debug, Clone)]
pub struct Stretch {
    /// Index of the recording.
    pub recording: usize,
    /// Its rows.
    pub rows: Range<usize>,
    /// Their summary.
    pub summary: Summary,
}

/// All recordings, condensed.
#[derive(Debug, Clone)]
pub struct Condensed {
    /// Stretches in order of recording and row.
    pub stretches: Vec<Stretch>,
    /// All stretches together.
    pub total: Summary,
}

/// Condenses `recordings`. Samples whose direction is unsettled are left out, as are those whose columns are
/// not finite. Every `stride`-th row counts; 1 takes all.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn condense(
    recordings: &[Prepared],
    columns: &dyn Columns,
    stride: usize,
    weight: Option<&SampleWeight<'_>>,
) -> Result<Condensed, IdentifyError> {
    let n_rows: Vec<usize> = recordings.iter().map(|prepared| prepared.recording.samples.n_rows()).collect();
    let plan = plan(&n_rows);
    let stretches: Result<Vec<Stretch>, IdentifyError> = plan
        .into_par_iter()
        .map(|(index, rows)| {
            let prepared = &recordings[index];
            condense_stretch(prepared, rows.clone(), columns, stride, weight)
                .map(|summary| Stretch { recording: index, rows, summary })
                .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })
        })
        .collect();
    Ok(Condensed::of(stretches?, columns.n_columns()))
}

impl Condensed {
    /// Of `stretches`, in order.
    pub(crate) fn of(stretches: Vec<Stretch>, n_columns: usize) -> Self {
        let mut total = Summary::new(n_columns);
        for stretch in &stretches {
            total.merge(&stretch.summary);
        }
        Self { stretches, total }
    }
}

/// Stretches that recordings of so many rows are cut into: which recording, and which rows of it.
pub(crate) fn plan(n_rows: &[usize]) -> Vec<(usize, Range<usize>)> {
    let stretch_rows = (n_rows.iter().sum::<usize>() / STRETCHES).max(1);
    let mut plan = Vec::new();
    for (index, &rows) in n_rows.iter().enumerate() {
        let pieces = ((rows as f64 / stretch_rows as f64).round() as usize).max(1);
        plan.extend((0..pieces).map(|piece| (index, piece * rows / pieces..(piece + 1) * rows / pieces)));
    }
    plan
}

/// Condenses some rows of a recording, as [`condense`] does.
///
/// # Errors
/// Where samples cannot be read back.
pub(crate) fn condense_stretch(
    prepared: &Prepared,
    rows: Range<usize>,
    columns: &dyn Columns,
    stride: usize,
    weight: Option<&SampleWeight<'_>>,
) -> std::io::Result<Summary> {
    let mut gathered = Gathered::new(columns.n_columns());
    fold_rows(&mut gathered, prepared, rows, columns, stride, weight)?;
    Ok(gathered.summary())
}

/// Folds some rows of a recording in, as [`condense`] does.
///
/// # Errors
/// Where samples cannot be read back.
pub(crate) fn fold_rows(
    gathered: &mut Gathered,
    prepared: &Prepared,
    rows: Range<usize>,
    columns: &dyn Columns,
    stride: usize,
    weight: Option<&SampleWeight<'_>>,
) -> std::io::Result<()> {
    let width = columns.n_columns() + 1;
    let mut row = vec![0.0; width];
    let mut next = rows.start.next_multiple_of(stride);
    for index in rows.start / CHUNK_ROWS..rows.end.div_ceil(CHUNK_ROWS) {
        let chunk = prepared.recording.samples.chunk(index)?;
        let (pressure_pa, length_m, force_n) = (chunk.pressure_pa(), chunk.length_m(), chunk.force_n());
        while next < rows.end.min(chunk.first_row() + chunk.n_rows()) {
            let here = next - chunk.first_row();
            if prepared.direction.is_settled(next) {
                columns.fill(pressure_pa[here], length_m[here], prepared.direction.sign(next), &mut row[..width - 1]);
                row[width - 1] = force_n[here];
                if row.iter().all(|value| value.is_finite()) {
                    let factor = weight.map_or(1.0, |weight| weight(force_n[here], &row[..width - 1]).sqrt());
                    gathered.push(row.iter().map(|value| factor * value));
                }
            }
            next += stride;
        }
    }
    Ok(())
}
