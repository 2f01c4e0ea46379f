//! A smooth static map: what caliper, rubber and the form of eq. 11 leave of a static force, without a name.
//!
//! ```text
//! F = F_base + Σ a_ij P_i(p̂) P_j(ε̂) + s Σ b_ij P_i(p̂) P_j(ε̂)
//! ```
//!
//! with Legendre polynomials `P`, the direction of friction `s`, and pressure and contraction ratio scaled so that `p̂` and `ε̂`
//! go from -1 to 1 over what was seen; beyond, the map keeps its value at the rim. The first sum goes to the fourth degree in
//! both together, the second to the second.

use crate::coordinate::Coordinate;
use crate::effects::page::{Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// Highest degree of the sum that is the same in both directions, and of the one with the sign of friction.
pub const EVEN_DEGREE: usize = 4;
/// See [`EVEN_DEGREE`].
pub const ODD_DEGREE: usize = 2;

/// Degrees in pressure and in contraction of every term, in order.
pub fn terms(least: usize, degree: usize) -> impl Iterator<Item = (usize, usize)> {
    (least..=degree).flat_map(|total| (0..=total).map(move |in_pressure| (in_pressure, total - in_pressure)))
}

/// Legendre polynomials up to the fourth degree.
pub fn legendre(degree: usize, x: f64) -> f64 {
    match degree {
        0 => 1.0,
        1 => x,
        2 => 0.5 * (3.0 * x * x - 1.0),
        3 => 0.5 * (5.0 * x * x - 3.0) * x,
        _ => 0.125 * ((35.0 * x * x - 30.0) * x * x + 3.0),
    }
}

/// The map; it is no effect of the catalogue, as it has no name in physics.
#[derive(Debug)]
pub(super) struct StaticMap;

/// Scale of a coordinate whose range of values is from `low` to `high`.
pub fn scaled(value: f64, low: f64, high: f64) -> f64 {
    if high > low { (2.0 * (value - low) / (high - low) - 1.0).clamp(-1.0, 1.0) } else { 0.0 }
}

const fn map(name: &'static str) -> Amplitude {
    Amplitude { name, symbol: "a_ij, b_ij", unit: "N", range: (-1e4, 1e4) }
}

const fn rim(name: &'static str, unit: &'static str, range: (f64, f64)) -> Shape {
    Shape { name, symbol: "p̂, ε̂", unit, range, grid: &[0.0] }
}

const RIMS: &[Shape] = &[
    rim("lowest_pa", "Pa", (-1e6, 1e8)),
    rim("highest_pa", "Pa", (-1e6, 1e8)),
    rim("lowest_contraction_ratio", "1", (-1.0, 1.0)),
    rim("highest_contraction_ratio", "1", (-1.0, 1.0)),
];

const AMPLITUDES: &[Amplitude] = &[
    map("even_p0_e1_n"),
    map("even_p1_e0_n"),
    map("even_p0_e2_n"),
    map("even_p1_e1_n"),
    map("even_p2_e0_n"),
    map("even_p0_e3_n"),
    map("even_p1_e2_n"),
    map("even_p2_e1_n"),
    map("even_p3_e0_n"),
    map("even_p0_e4_n"),
    map("even_p1_e3_n"),
    map("even_p2_e2_n"),
    map("even_p3_e1_n"),
    map("even_p4_e0_n"),
    map("odd_p0_e0_n"),
    map("odd_p0_e1_n"),
    map("odd_p1_e0_n"),
    map("odd_p0_e2_n"),
    map("odd_p1_e1_n"),
    map("odd_p2_e0_n"),
];

impl Effect for StaticMap {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        RIMS
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        AMPLITUDES
    }

    /// It is what eq. 11 leaves of the recordings, and was fitted over what these have.
    fn pulls_as_recorded(&self) -> bool {
        true
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { pressure_pa: (shape[0], shape[1]), contraction_ratio: (shape[2], shape[3]) })
    }
}

struct State {
    pressure_pa: (f64, f64),
    contraction_ratio: (f64, f64),
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        let over_pressure = scaled(now.pressure_pa, self.pressure_pa.0, self.pressure_pa.1);
        let over_contraction = scaled(now.contraction_ratio, self.contraction_ratio.0, self.contraction_ratio.1);
        let by_pressure: [f64; 5] = std::array::from_fn(|degree| legendre(degree, over_pressure));
        let by_contraction: [f64; 5] = std::array::from_fn(|degree| legendre(degree, over_contraction));
        let even = terms(1, EVEN_DEGREE).map(|term| (1.0, term));
        let odd = terms(0, ODD_DEGREE).map(|term| (now.direction, term));
        for (column, (sign, (i, j))) in columns.iter_mut().zip(even.chain(odd)) {
            *column = sign * by_pressure[i] * by_contraction[j];
        }
    }
}

static PAGE: Page = Page {
    id: "static-map",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::State,
    name: "smooth static map",
    summary: "What the form of eq. 11, the dimensions of the muscle file and the law of the rubber leave of a smooth static \
              force. It has no name in physics and is fitted beside every effect.",
    equation: "F = F_base + Σ a_ij P_i(p̂) P_j(ε̂) + s Σ b_ij P_i(p̂) P_j(ε̂)",
    symbols: &[
        Symbol { symbol: "P_i", unit: "1", meaning: "Legendre polynomial of degree i" },
        Symbol {
            symbol: "p̂, ε̂", unit: "1", meaning: "pressure and contraction ratio, -1 to 1 over what was seen"
        },
        Symbol { symbol: "a_ij, b_ij", unit: "N", meaning: "size of each term" },
    ],
    validity: "Inside the pressures and contractions that were recorded; beyond, it keeps its value at the rim.",
    source: "Kennedy and O'Hagan (2001), J. Royal Statistical Society B 63(3), for a discrepancy beside a model",
    signature: "A smooth residual over pressure and contraction, the same at every time and speed.",
    confused_with: &[],
    test: "the same pressures and lengths at other speeds and on another day: the map stays",
    protocol: "isobaric-triangles",
    coordinate: Coordinate::Contraction,
    typical: Typical::UNKNOWN,
    regions: &[],
    drivers: &[],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    const SHAPE: [f64; 4] = [0.0, 4e5, 0.0, 0.2];

    #[test]
    fn every_term_has_an_amplitude() {
        assert_eq!(terms(1, EVEN_DEGREE).count() + terms(0, ODD_DEGREE).count(), AMPLITUDES.len());
        for (amplitude, (i, j)) in AMPLITUDES.iter().zip(terms(1, EVEN_DEGREE)) {
            assert_eq!(amplitude.name, format!("even_p{i}_e{j}_n"));
        }
    }

    #[test]
    fn legendre_polynomials_are_orthogonal() {
        for i in 0..=4 {
            for j in 0..=4 {
                let n = 2000;
                let x = |k: usize| (2.0 * k as f64 + 1.0) / n as f64 - 1.0;
                let product: f64 = (0..n).map(|k| legendre(i, x(k)) * legendre(j, x(k))).sum::<f64>() * 2.0 / n as f64;
                let expected = if i == j { 2.0 / (2.0 * i as f64 + 1.0) } else { 0.0 };
                assert!((product - expected).abs() < 1e-4, "{i} {j}: {product}");
            }
        }
    }

    #[test]
    fn beyond_what_was_seen_it_keeps_its_value() {
        let at =
            |pressure_pa| pull(&mut *StaticMap.start(&nominal(), &SHAPE), &Moment { pressure_pa, ..still() }, &base());
        assert_eq!(at(4e5), at(9e5));
        assert_ne!(at(3e5), at(4e5));
    }
}
