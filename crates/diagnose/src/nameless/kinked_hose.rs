//! A hose that kinks as the muscle contracts, and traps the air.
//!
//! ```text
//! dp_m/dt = (p - p_m) / τ                                   where ε < ε_k
//! dp_m/dt = (p - p_m) / τ_k - (p_m + p₀) d ln V / dt        beyond
//! ```
//!
//! An open hose lets the pressure follow as a lag does; a closed one leaks a little, and its air is compressed as the muscle moves.

use pam_muscle::effects::page::{Page, Symbol, Typical};
use pam_muscle::effects::{Dependence, Effect, Kind, Memory, Moment, Role, Seen, Shape};
use pam_muscle::{Coordinate, Kinematics, Muscle};

/// The force.
#[derive(Debug)]
pub(super) struct KinkedHose;

/// Where a fit looks for the kink, in shares of the range of the contraction.
const SHARES: [f64; 5] = [0.2, 0.35, 0.5, 0.65, 0.8];

static SHAPE: [Shape; 3] = [
    Shape { name: "open_s", symbol: "τ", unit: "s", range: (1e-3, 1.0), grid: &[0.005, 0.03, 0.1, 0.25] },
    Shape { name: "closed_s", symbol: "τ_k", unit: "s", range: (0.01, 60.0), grid: &[0.3, 1.5, 8.0] },
    Shape {
        name: "kink_contraction",
        symbol: "ε_k",
        unit: "1",
        range: (-0.2, 0.5),
        grid: &[0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3],
    },
];

impl Effect for KinkedHose {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &SHAPE
    }

    fn first_shapes(&self, seen: &Seen) -> Vec<Vec<f64>> {
        let (low, high) = seen.contraction_ratio;
        let [open, closed, _] = &SHAPE;
        let constants_s =
            open.grid.iter().flat_map(|&open_s| closed.grid.iter().map(move |&closed_s| [open_s, closed_s]));
        constants_s
            .flat_map(|[open_s, closed_s]| SHARES.map(|share| vec![open_s, closed_s, low + share * (high - low)]))
            .collect()
    }

    fn start(&self, muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State {
            kinematics: Kinematics::of(muscle),
            open_s: shape[0],
            closed_s: shape[1],
            kink: shape[2],
            last: None,
        })
    }
}

struct State {
    kinematics: Kinematics,
    open_s: f64,
    closed_s: f64,
    kink: f64,
    last: Option<Last>,
}

/// The moment before.
#[derive(Clone, Copy)]
struct Last {
    gauge_pa: f64,
    inside_pa: f64,
    volume_m3: f64,
}

/// Pressure of the air around, in Pa.
const AMBIENT_PA: f64 = 101_325.0;

impl Memory for State {
    fn sees(&mut self, now: &mut Moment) {
        let gauge_pa = now.pressure_pa;
        let diameter_m = self.kinematics.diameter_m(now.length_m);
        let volume_m3 = std::f64::consts::FRAC_PI_4 * diameter_m * diameter_m * now.length_m;
        let inside_pa = match self.last {
            Some(last) if now.step_s > 0.0 => {
                let (constant_s, from_pa) = if now.contraction_ratio > self.kink {
                    (self.closed_s, (last.inside_pa + AMBIENT_PA) * last.volume_m3 / volume_m3 - AMBIENT_PA)
                } else {
                    (self.open_s, last.inside_pa)
                };
                let ratio = now.step_s / constant_s;
                let behind_pa = (gauge_pa - last.gauge_pa) / ratio;
                gauge_pa - behind_pa + (from_pa - last.gauge_pa + behind_pa) * (-ratio).exp()
            }
            _ => gauge_pa,
        };
        self.last = Some(Last { gauge_pa, inside_pa, volume_m3 });
        now.pressure_pa = inside_pa;
    }
}

static PAGE: Page = Page {
    id: "kinked-hose",
    role: Role::Sees,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "a hose that kinks as the muscle contracts",
    summary: "Beyond some contraction the hose kinks: the muscle keeps the air that it has, and its pressure follows the gauge hardly at \
              all.",
    equation: "dp_m/dt = (p - p_m) / τ below ε_k, (p - p_m) / τ_k - (p_m + p₀) d ln V / dt beyond,  F = F_base(p_m, L)",
    symbols: &[
        Symbol { symbol: "τ", unit: "s", meaning: "time constant of the open hose" },
        Symbol { symbol: "τ_k", unit: "s", meaning: "time constant of the kinked hose" },
        Symbol { symbol: "ε_k", unit: "1", meaning: "contraction beyond which it is kinked" },
        Symbol { symbol: "p_m", unit: "Pa", meaning: "gauge pressure in the muscle" },
        Symbol { symbol: "p₀", unit: "Pa", meaning: "pressure of the air around" },
        Symbol { symbol: "V", unit: "m³", meaning: "volume of the muscle, a cylinder of the braid's diameter" },
    ],
    validity: "Air that keeps its temperature.",
    source: "Boyle's law for the air behind the kink",
    signature: "The residual goes with the rate of the pressure, and with the motion, at large contraction alone.",
    confused_with: &[],
    test: "look at the hose at the largest contraction",
    protocol: "isometric-ramps",
    coordinate: Coordinate::Contraction,
    typical: Typical::UNKNOWN,
    regions: &[],
    drivers: &[],
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Pressure in a muscle that starts vented and whose gauge jumps to 1 bar, after each of ten seconds at the lengths.
    fn inside_pa(kink: f64, lengths_m: impl Fn(u32) -> f64) -> Vec<f64> {
        let muscle = Muscle::nominal();
        let mut hose = KinkedHose.start(&muscle, &[0.1, 1e3, kink]);
        let at = |second: u32| {
            let pressure_pa = if second == 0 { 0.0 } else { 1e5 };
            Moment {
                step_s: if second == 0 { 0.0 } else { 1.0 },
                ..Moment::settled(&muscle, pressure_pa, lengths_m(second), 1.0)
            }
        };
        (0..10)
            .map(|second| {
                let mut now = at(second);
                hose.sees(&mut now);
                now.pressure_pa
            })
            .collect()
    }

    #[test]
    fn an_open_hose_follows_and_a_kinked_one_keeps_its_air() {
        let rest_m = Muscle::nominal().rest_length_m;
        let open = inside_pa(0.1, |_| rest_m);
        let kinked = inside_pa(0.1, |_| 0.8 * rest_m);
        assert!((open[9] - 1e5).abs() < 1.0, "{open:?}");
        assert!(kinked[9] < 2e3, "{kinked:?}");
    }

    #[test]
    fn the_air_behind_a_kink_is_compressed_as_the_muscle_is_pulled_long() {
        let muscle = Muscle::nominal();
        let length_m = |second: u32| (0.8 + 0.01 * f64::from(second)) * muscle.rest_length_m;
        let inside = inside_pa(0.05, length_m);
        let volume = |second: u32| muscle.diameter_m(length_m(second)).powi(2) * length_m(second);
        let boyle_pa = AMBIENT_PA * volume(0) / volume(9) - AMBIENT_PA;
        assert!(boyle_pa > 5e3 && (inside[9] / boyle_pa - 1.0).abs() < 0.2, "{boyle_pa} {inside:?}");
    }
}
