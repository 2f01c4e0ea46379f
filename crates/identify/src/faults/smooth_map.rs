//! A smooth map of pressure and length to force, which knows no muscle:
//!
//! ```text
//! F ≈ c₀ + c₁ p + c₂ p x + c₃ p x² + c₄ x + c₅ x²,   x from the shortest length, -1, to the longest, 1
//! ```

use nalgebra::{SMatrix, SVector};

/// Terms of the map.
const N_TERMS: usize = 6;

/// Sums of the rows that a map is fitted to.
#[derive(Debug, Clone)]
pub struct Sums {
    scales: Scales,
    normal: SMatrix<f64, N_TERMS, N_TERMS>,
    right: SVector<f64, N_TERMS>,
    n: f64,
}

/// What makes the channels sizes of about one.
#[derive(Debug, Clone, Copy)]
struct Scales {
    highest_pa: f64,
    middle_m: f64,
    half_m: f64,
}

impl Scales {
    fn terms(&self, pressure_pa: f64, length_m: f64) -> SVector<f64, N_TERMS> {
        let (p, x) = (pressure_pa / self.highest_pa, (length_m - self.middle_m) / self.half_m);
        SVector::from([1.0, p, p * x, p * x * x, x, x * x])
    }
}

impl Sums {
    /// Of no rows yet, for pressures up to `highest_pa` and lengths between the two of `length_m`.
    pub fn new(highest_pa: f64, length_m: [f64; 2]) -> Self {
        let [shortest_m, longest_m] = length_m;
        let scales = Scales {
            highest_pa: highest_pa.max(f64::MIN_POSITIVE),
            middle_m: 0.5 * (shortest_m + longest_m),
            half_m: 0.5 * (longest_m - shortest_m).max(f64::MIN_POSITIVE),
        };
        Self { scales, normal: SMatrix::zeros(), right: SVector::zeros(), n: 0.0 }
    }

    /// Takes a row in.
    pub fn push(&mut self, pressure_pa: f64, length_m: f64, force_n: f64) {
        let terms = self.scales.terms(pressure_pa, length_m);
        self.normal += terms * terms.transpose();
        self.right += terms * force_n;
        self.n += 1.0;
    }

    /// The map that leaves least of the rows; none where nothing varies.
    pub fn map(&self) -> Option<SmoothMap> {
        // A trace of a prior, for terms that the rows do not tell apart.
        let solved = (self.normal + SMatrix::identity() * (1e-6 * self.n)).cholesky()?;
        Some(SmoothMap { scales: self.scales, weights: solved.solve(&self.right) })
    }
}

/// The map.
#[derive(Debug, Clone)]
pub struct SmoothMap {
    scales: Scales,
    weights: SVector<f64, N_TERMS>,
}

impl SmoothMap {
    /// Force that the map does not give, in N.
    pub fn residual_n(&self, pressure_pa: f64, length_m: f64, force_n: f64) -> f64 {
        force_n - self.scales.terms(pressure_pa, length_m).dot(&self.weights)
    }
}
