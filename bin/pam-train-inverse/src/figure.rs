//! The figure of an inverse, from what was trained.

use pam_artifact::InverseArtifact;
use pam_artifact::inverse::RegionErrors;
use pam_inverse_model::ExactInverse;
use pam_inverse_model::branch::slope_n_per_pa;
use pam_inverse_model::coverage::{Kind, map};
use pam_inverse_model::report::{Outcome, Prepared};
use pam_report::number::significant;
use pam_report::{InverseCell, InverseFigure, InverseMap, RegionBar, SlopeCell, SlopeMap, inverse_figure};

/// Columns of length, in both kinds of map.
const COLUMNS: usize = 56;
/// Rows of force.
const ROWS: usize = 36;
/// Pressures that tell whether a force occurs at all.
const PRESSURES: usize = 64;

/// The figure as SVG.
pub(crate) fn svg(artifact: &InverseArtifact, outcome: &Outcome, prepared: &Prepared) -> anyhow::Result<String> {
    let errors = &artifact.errors;
    let direction_errors = |sign: f64| {
        let same = outcome.judged.iter().filter(|judged| judged.point.direction * sign > 0.0);
        same.map(|judged| judged.pressure_error_pa * 1e-3).collect()
    };
    let chosen = &artifact.training.starts[artifact.training.chosen];
    let in_kpa = |curve: &[f64]| curve.iter().map(|rmse_pa| rmse_pa * 1e-3).collect();
    Ok(inverse_figure(&InverseFigure {
        title: "Inverse of the muscle: pressure from force, length and direction".to_owned(),
        facts: vec![
            format!(
                "pressure RMSE on unseen points {} kPa ({} % of range)",
                significant(errors.pressure_pa.rmse * 1e-3, 2),
                significant(errors.pressure_rmse_percent, 2)
            ),
            format!(
                "force round trip {} N ({} %)",
                significant(errors.force_n.rmse, 2),
                significant(errors.force_rmse_percent, 2)
            ),
            format!("the inverse exists in {:.1} % of the operating range", errors.coverage.invertible_percent),
        ],
        maps: [1.0, -1.0].map(|direction| inverse_map(outcome, prepared.exact(), direction)),
        slopes: slope_map(prepared.exact()),
        training_rmse_kpa: in_kpa(&artifact.training.training_rmse_pa),
        validation_rmse_kpa: in_kpa(&artifact.training.validation_rmse_pa),
        best_epoch: chosen.best_epoch,
        errors_kpa: [direction_errors(1.0), direction_errors(-1.0)],
        regions: errors.regions.iter().filter_map(region).collect(),
    })?)
}

/// Network and exact inverse at the middles of cells over length and force.
fn inverse_map(outcome: &Outcome, exact: &ExactInverse, direction: f64) -> InverseMap {
    let inverse_box = exact.inverse_box();
    let middle = |from: f64, span: f64, cell: usize, n: usize| from + span * (cell as f64 + 0.5) / n as f64;
    let lengths_m: Vec<f64> = (0..COLUMNS)
        .map(|column| middle(inverse_box.length_m[0], inverse_box.length_span_m(), column, COLUMNS))
        .collect();
    // Lowest and highest force at any pressure of the operating range.
    let occurring: Vec<(f64, f64)> = lengths_m
        .iter()
        .map(|&length_m| {
            let force_n = |step: usize| {
                let share = step as f64 / PRESSURES as f64;
                let pressure_pa = inverse_box.pressure_pa[0] + share * inverse_box.pressure_span_pa();
                exact.model().settled_force_n(pressure_pa, length_m, direction)
            };
            (0..=PRESSURES).map(force_n).fold((f64::NAN, f64::NAN), |(low, high), n| (low.min(n), high.max(n)))
        })
        .collect();
    // The map ends where no length has a higher force, which may be far below the end of the operating range.
    let [lowest_n, highest_n] = inverse_box.force_n;
    let reached_n = occurring.iter().map(|range| range.1).fold(lowest_n, f64::max).min(highest_n);
    let top_n = if reached_n > lowest_n { reached_n } else { highest_n };
    let mut cells = Vec::with_capacity(ROWS * COLUMNS);
    for row in 0..ROWS {
        let force_n = middle(lowest_n, top_n - lowest_n, row, ROWS);
        for (&length_m, &(lowest_n, highest_n)) in lengths_m.iter().zip(&occurring) {
            cells.push(match exact.pressure_pa(force_n, length_m, direction) {
                Ok(exact_pa) => InverseCell::Found {
                    network_kpa: outcome.network.pressure_pa(force_n, length_m, direction).pressure_pa * 1e-3,
                    exact_kpa: exact_pa * 1e-3,
                },
                Err(_) if (lowest_n..=highest_n).contains(&force_n) => InverseCell::Missing,
                Err(_) => InverseCell::OutOfReach,
            });
        }
    }
    InverseMap {
        length_mm: inverse_box.length_m.map(|length_m| length_m * 1e3),
        force_n: [lowest_n, top_n],
        n_columns: COLUMNS,
        cells,
    }
}

/// Slope of the force while contracting, where the inverse exists.
fn slope_map(exact: &ExactInverse) -> SlopeMap {
    let found = map(exact, 1.0);
    let inverse_box = exact.inverse_box();
    let n_columns = found.length_m.len();
    let cell = |(index, kind): (usize, &Kind)| match kind {
        Kind::Invertible => {
            let (pressure_pa, length_m) = (found.pressure_pa[index / n_columns], found.length_m[index % n_columns]);
            let span_pa = inverse_box.pressure_span_pa();
            SlopeCell::Rising(slope_n_per_pa(exact.model(), pressure_pa, length_m, 1.0, span_pa) * 1e3)
        }
        Kind::Flat | Kind::Ambiguous => SlopeCell::Missing,
        Kind::Slack | Kind::Beyond => SlopeCell::OutOfReach,
    };
    SlopeMap {
        length_mm: inverse_box.length_m.map(|length_m| length_m * 1e3),
        pressure_kpa: inverse_box.pressure_pa.map(|pressure_pa| pressure_pa * 1e-3),
        n_columns,
        cells: found.kinds.iter().enumerate().map(cell).collect(),
    }
}

fn region(region: &RegionErrors) -> Option<RegionBar> {
    let found = region.pressure_pa?;
    Some(RegionBar { name: crate::tables::region_name(region), rmse_kpa: found.rmse * 1e-3, p95_kpa: found.p95 * 1e-3 })
}
