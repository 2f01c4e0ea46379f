//! Lock-up of the braid: strands that touch side by side stop the contraction.
//!
//! ```text
//! F = F_base - K w ln(1 + exp((ε - ε_l) / w))
//! ```

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Seen, Shape};
use crate::geometry::Muscle;

/// Where a fit looks for the lock, in units of the largest contraction.
const SHARES: [f64; 6] = [0.4, 0.5, 0.6, 0.7, 0.8, 0.9];

static SHAPE: &[Shape] = &[
    Shape {
        name: "lock_contraction",
        symbol: "ε_l",
        unit: "1",
        range: (0.1, 0.5),
        grid: &[0.12, 0.16, 0.2, 0.24, 0.28],
    },
    Shape { name: "onset_contraction", symbol: "w", unit: "1", range: (1e-3, 0.05), grid: &[0.004, 0.015] },
];

/// The effect.
#[derive(Debug)]
pub(super) struct BraidLockup;

impl Effect for BraidLockup {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        SHAPE
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "stiffness_n", symbol: "K", unit: "N", range: (0.0, 1e6) }]
    }

    fn first_shapes(&self, seen: &Seen) -> Vec<Vec<f64>> {
        let largest = seen.contraction_ratio.1;
        let (lowest_lock, highest_lock) = SHAPE[0].range;
        let pairs = SHARES.iter().flat_map(|share| SHAPE[1].grid.iter().map(move |&onset| (share * largest, onset)));
        pairs
            .filter(|(lock, _)| (lowest_lock..=highest_lock).contains(lock))
            .map(|(lock, onset)| vec![lock, onset])
            .collect()
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { lock: shape[0], onset: shape[1] })
    }
}

struct State {
    lock: f64,
    onset: f64,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        let beyond = (now.contraction_ratio - self.lock) / self.onset;
        // ln(1 + e^x) without overflow.
        columns[0] = -self.onset * (beyond.max(0.0) + (-beyond.abs()).exp().ln_1p());
    }
}

static PAGE: Page = Page {
    id: "braid-lockup",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::PartOfState,
    name: "lock-up of the braid",
    summary: "Beyond some contraction neighbouring strands touch, and the braid cannot open further. The force falls \
              steeply there, at the same contraction whatever the pressure.",
    equation: "F = F_base - K w ln(1 + exp((ε - ε_l) / w))",
    symbols: &[
        Symbol { symbol: "K", unit: "N", meaning: "stiffness of the locked braid per contraction ratio; 1 to 50 kN" },
        Symbol {
            symbol: "ε_l",
            unit: "1",
            meaning: "contraction where it locks; 0.20 to 0.33 in a dense braid, from sin 2θ = n N d_s / b_s",
        },
        Symbol { symbol: "w", unit: "1", meaning: "contraction over which it sets in; 0.004 to 0.015" },
        Symbol { symbol: "ε", unit: "1", meaning: "contraction ratio" },
    ],
    validity: "A stiffness that does not depend on the pressure; contraction up to a few w beyond the lock.",
    source: "Davis and Caldwell (2006), \"Braid effects on contractile range and friction modeling in pneumatic muscle \
             actuators\", Int. J. Robotics Research 25(4), for the lock; the smooth hinge is chosen here",
    signature: "The residual is static and confined to the largest contractions, a ramp downwards with the same start at \
                every pressure.",
    confused_with: &[
        Confusion {
            id: "end-taper",
            because: "both lower the force at large contraction",
            test: "free contraction at three pressures: a braid that locks stops at one contraction, a taper does not",
        },
        Confusion {
            id: "slack",
            because: "at large contraction and low pressure the force ends in both",
            test: "large contraction at high pressure, where the muscle still pulls: only a lock shows there",
        },
        Confusion {
            id: "threshold-pressure",
            because: "in steps of the length at one pressure both bend the force over the contraction",
            test: "the same steps at three pressures: the lock stays where it is",
        },
    ],
    test: "slow isobaric strokes to the largest contraction at three pressures",
    protocol: "isobaric-triangles",
    coordinate: Coordinate::Contraction,
    typical: Typical { shapes: &[&[0.2, 0.008]], amplitudes: &[1e4] },
    regions: &[Coordinate::Contraction],
    drivers: &["contraction"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::catalogue::tests::seen;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    fn column(contraction_ratio: f64) -> f64 {
        let mut memory = BraidLockup.start(&nominal(), &[0.2, 0.004]);
        pull(&mut *memory, &Moment { contraction_ratio, ..still() }, &base())[0]
    }

    #[test]
    fn it_resists_contraction_beyond_the_lock_alone() {
        assert!(column(0.1).abs() < 1e-9);
        assert!((column(0.3) + 0.1).abs() < 1e-9, "one per contraction ratio beyond the lock");
        assert!((column(0.2) + 0.004 * 2.0_f64.ln()).abs() < 1e-12);
        assert!(column(50.0).is_finite() && column(-50.0).abs() < 1e-12);
    }

    #[test]
    fn a_fit_looks_where_the_recording_went() {
        let seen = Seen { force_n: (0.0, 900.0), duration_s: 60.0, ..seen() };
        let shapes = BraidLockup.first_shapes(&seen);
        assert_eq!(shapes.len(), 12);
        assert!(shapes.iter().all(|shape| shape[0] < 0.25 && shape[0] > 0.09));
        let isometric = Seen { contraction_ratio: (0.0, 0.0), ..seen };
        assert!(BraidLockup.first_shapes(&isometric).is_empty());
    }
}
