//! The operating range of pressures and lengths: where the inverse exists, and why not elsewhere.

use pam_artifact::inverse::Coverage;

use crate::ExactInverse;

/// Lengths of the grid.
const LENGTHS: usize = 56;
/// Pressures of the grid.
const PRESSURES: usize = 40;

/// What the inverse is like at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The pressure can be told from its force.
    Invertible,
    /// The force is below the domain's lowest.
    Slack,
    /// The force is above the domain's highest.
    Beyond,
    /// The force grows too little with the pressure, or falls, or is no number.
    Flat,
    /// Another range of pressures, which rises as well, is the one that is inverted.
    Ambiguous,
}

/// Kinds over the operating range, rows of pressure from the lowest, columns of length from the shortest.
#[derive(Debug, Clone, PartialEq)]
pub struct CoverageMap {
    /// Middles of the columns, in m.
    pub length_m: Vec<f64>,
    /// Middles of the rows, in Pa.
    pub pressure_pa: Vec<f64>,
    /// Kind of every cell.
    pub kinds: Vec<Kind>,
}

/// The map of one direction.
pub fn map(inverse: &ExactInverse, direction: f64) -> CoverageMap {
    let inverse_box = inverse.inverse_box();
    let middle = |from: f64, span: f64, cell: usize, n: usize| from + span * (cell as f64 + 0.5) / n as f64;
    let column = |cell: usize| middle(inverse_box.length_m[0], inverse_box.length_span_m(), cell, LENGTHS);
    let row = |cell: usize| middle(inverse_box.pressure_pa[0], inverse_box.pressure_span_pa(), cell, PRESSURES);
    let length_m: Vec<f64> = (0..LENGTHS).map(column).collect();
    let pressure_pa: Vec<f64> = (0..PRESSURES).map(row).collect();
    let mut kinds = vec![Kind::Flat; LENGTHS * PRESSURES];
    for (column, &length_m) in length_m.iter().enumerate() {
        let rising_pa = inverse.rising_pa(length_m, direction);
        let chosen_pa = crate::branch::longest(&rising_pa);
        for (row, &pressure_pa) in pressure_pa.iter().enumerate() {
            let within = |branch: &[f64; 2]| (branch[0]..=branch[1]).contains(&pressure_pa);
            let force_n = inverse.model().settled_force_n(pressure_pa, length_m, direction);
            kinds[row * LENGTHS + column] = if !rising_pa.iter().any(within) {
                Kind::Flat
            } else if force_n < inverse_box.force_n[0] {
                Kind::Slack
            } else if force_n > inverse_box.force_n[1] {
                Kind::Beyond
            } else if chosen_pa.as_ref().is_some_and(within) {
                Kind::Invertible
            } else {
                Kind::Ambiguous
            };
        }
    }
    CoverageMap { length_m, pressure_pa, kinds }
}

/// Shares of the operating range over both directions.
pub fn coverage(inverse: &ExactInverse) -> Coverage {
    let kinds: Vec<Kind> = [-1.0, 1.0].into_iter().flat_map(|direction| map(inverse, direction).kinds).collect();
    let percent = |kind: Kind| 100.0 * kinds.iter().filter(|found| **found == kind).count() as f64 / kinds.len() as f64;
    Coverage {
        n_cells: kinds.len(),
        invertible_percent: percent(Kind::Invertible),
        slack_percent: percent(Kind::Slack),
        beyond_percent: percent(Kind::Beyond),
        flat_percent: percent(Kind::Flat),
        ambiguous_percent: percent(Kind::Ambiguous),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::tests::{BOX, nominal_inverse, soft};

    #[test]
    fn shares_add_up_and_a_soft_braid_has_flat_places() {
        let nominal = coverage(&nominal_inverse());
        let soft = coverage(&ExactInverse::new(soft(), BOX, 0.05));
        for shares in [nominal, soft] {
            let sum = shares.invertible_percent + shares.slack_percent + shares.beyond_percent + shares.flat_percent;
            assert!((sum + shares.ambiguous_percent - 100.0).abs() < 1e-9);
        }
        assert!(nominal.flat_percent < 1e-9 && nominal.slack_percent > 1.0, "{nominal:?}");
        assert!(soft.flat_percent > 10.0 && soft.invertible_percent > 10.0, "{soft:?}");
    }
}
