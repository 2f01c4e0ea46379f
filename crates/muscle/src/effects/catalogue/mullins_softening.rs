//! Mullins softening: rubber is softer below the largest stretch that it has seen.
//!
//! ```text
//! F = F_base - d f [1 - exp(-(ε_m - ε) / ε_c)] - e f [1 - exp(-s / s_c)] - a T [1 - exp(-(ε - ε_l) / ε_c)]
//! ε_m = max ε so far,   ε_l = min ε so far,   s = ∫ |dε|,   f = V_r dW/dL of latex
//! T = E V_r / L₀ max(ε_s - ε, 0),   E = 6 (C₁₀ + C₀₁) of latex,   ε_s = 1 - 1 / (√3 cos α₀)
//! ```
//!
//! Hoops of the bladder are stretched by contraction. Its axis is where it was mounted under tension, and that is most where the
//! muscle is longest: a bladder that is slack where an ideal braid pulls no more has the tension `T`. What it has lost of that is
//! missing below the greatest length so far.

use crate::coordinate::Coordinate;
use crate::effects::moment::LATEX_PA;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kept, Kind, Memory, Moment, Role, Shape};
use crate::force::bladder::Bladder;
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct MullinsSoftening;

impl Effect for MullinsSoftening {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape {
                name: "softening_contraction",
                symbol: "ε_c",
                unit: "1",
                range: (3e-3, IN_PROPORTION),
                grid: &[0.01, 0.03, 0.1],
            },
            Shape {
                name: "settling_travel",
                symbol: "s_c",
                unit: "1",
                range: (SETTLES_AT_ONCE, 5.0),
                grid: &[0.2, 0.8],
            },
        ]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "softening", symbol: "d", unit: "1", range: (0.0, 1.5) },
            Amplitude { name: "settling", symbol: "e", unit: "1", range: (0.0, 1.5) },
            Amplitude { name: "axial_softening", symbol: "a", unit: "1", range: (0.0, MOST_AXIAL) },
        ]
    }

    /// Before it had an axis, nothing was lost along it and nobody knew of the greatest length.
    fn unless_stated(&self, index: usize) -> Option<f64> {
        match index {
            4 => Some(0.0),
            7 => Some(NEVER),
            _ => None,
        }
    }

    /// Rubber that settles within its first stroke was stretched for the first time; a softening in proportion to the distance from
    /// the largest contraction is one of its published forms.
    fn may_end(&self, index: usize, end: f64) -> bool {
        [(0, IN_PROPORTION), (1, SETTLES_AT_ONCE)].contains(&(index, end))
    }

    fn outlasts(&self) -> bool {
        true
    }

    fn keeps(&self) -> &'static [Kept] {
        &[
            Kept { name: "past_contraction", unit: "1", range: (NEVER, 0.6), fresh: NEVER },
            Kept { name: "past_travel", unit: "1", range: (0.0, 1e9), fresh: 0.0 },
            Kept { name: "past_extension", unit: "1", range: (NEVER, 1.0), fresh: NEVER },
        ]
    }

    fn start(&self, muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        let &[softening_contraction, settling_travel] = shape else { unreachable!("two shape parameters") };
        let section_m2 = Bladder::new(muscle).rubber_volume_m3() / muscle.rest_length_m;
        Box::new(State {
            softening_contraction,
            settling_travel,
            stiffness_n: 6.0 * LATEX_PA * section_m2,
            slack_contraction: muscle.max_contraction_ratio(),
            largest: NEVER,
            longest: NEVER,
            follower: 0.0,
            travelled: 0.0,
        })
    }
}

struct State {
    softening_contraction: f64,
    settling_travel: f64,
    /// `E V_r / L₀`.
    stiffness_n: f64,
    /// `ε_s`.
    slack_contraction: f64,
    /// Largest contraction so far; gaps do not heal the rubber.
    largest: f64,
    /// Largest extension so far, `-ε_l`.
    longest: f64,
    /// Contraction behind that of the muscle by up to half the play, and the travel of it; that in gaps is left out.
    follower: f64,
    travelled: f64,
}

/// A contraction that no muscle softens over: below it the softening is in proportion.
const IN_PROPORTION: f64 = 0.3;
/// Travel of the contraction ratio that is less than a stroke.
const SETTLES_AT_ONCE: f64 = 0.02;
/// Largest contraction and extension of rubber that nothing was done to: no muscle is twice as long as at rest, and none contracts to
/// nothing.
const NEVER: f64 = -1.0;
/// Loss of tension, at most, in units of `T`: a bladder three times as stiff as latex, mounted at twice that tension, that loses all of it.
const MOST_AXIAL: f64 = 6.0;
/// Half the play in the count of travel, in contraction; noise at rest stays inside it.
const HALF_PLAY: f64 = 5e-4;

impl Memory for State {
    fn past(&self) -> Vec<f64> {
        vec![self.largest, self.travelled, self.longest]
    }

    fn go_on(&mut self, past: &[f64]) {
        if let &[largest, travelled, longest] = past {
            (self.largest, self.travelled, self.longest) = (largest, travelled, longest);
        }
    }

    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        let contraction = now.contraction_ratio;
        self.largest = self.largest.max(contraction);
        self.longest = self.longest.max(-contraction);
        let [below, within] =
            [self.largest - contraction, self.longest + contraction].map(|far| far / self.softening_contraction);
        if now.step_s == 0.0 {
            self.follower = now.contraction_ratio;
        } else {
            let followed = self.follower.clamp(now.contraction_ratio - HALF_PLAY, now.contraction_ratio + HALF_PLAY);
            self.travelled += (followed - self.follower).abs();
            self.follower = followed;
        }
        columns[0] = base.latex_n() * (-below).exp_m1();
        columns[1] = base.latex_n() * (-self.travelled / self.settling_travel).exp_m1();
        columns[2] = self.stiffness_n * (self.slack_contraction - contraction).max(0.0) * (-within).exp_m1();
    }
}

static PAGE: Page = Page {
    id: "mullins-softening",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "Mullins softening of the bladder",
    summary: "Rubber is softer where it has been stretched further before, and settles over its first cycles. The first \
              inflation to a new contraction meets the full resistance of the bladder, and every later cycle below it \
              meets less.",
    equation: "F = F_base - d f (1 - exp(-(ε_m - ε) / ε_c)) - e f (1 - exp(-s / s_c)) - a T (1 - exp(-(ε - ε_l) / ε_c)),  \
               ε_m = largest contraction so far, ε_l = smallest,  s = ∫ |dε|,  T = E V_r / L₀ (ε_s - ε)",
    symbols: &[
        Symbol {
            symbol: "d",
            unit: "1",
            meaning: "softening far below the largest contraction, in units of f; 0.02 to 0.1 for latex, 0.1 to 0.3 for \
                      filled rubber",
        },
        Symbol {
            symbol: "ε_c",
            unit: "1",
            meaning: "contraction below the largest, or above the smallest, at which 63 % are there; 0.01 to 0.1",
        },
        Symbol {
            symbol: "f",
            unit: "N",
            meaning: "force of a bladder of latex, C₁₀ + C₀₁ = 0.22 MPa, whatever the fitted bladder is",
        },
        Symbol { symbol: "ε_m", unit: "1", meaning: "largest contraction so far" },
        Symbol { symbol: "e", unit: "1", meaning: "softening over the first cycles, in units of f; 0.02 to 0.3" },
        Symbol {
            symbol: "s_c",
            unit: "1",
            meaning: "travel of the contraction ratio in which 63 % of that are there: a few cycles, 0.2 to 3",
        },
        Symbol { symbol: "s", unit: "1", meaning: "that travel so far, counted outside a play of 0.001" },
        Symbol {
            symbol: "a",
            unit: "1",
            meaning: "softening along the axis, in units of T; zero where the bladder was mounted without tension",
        },
        Symbol { symbol: "ε_l", unit: "1", meaning: "smallest contraction so far: where the muscle was longest" },
        Symbol {
            symbol: "T",
            unit: "N",
            meaning: "tension of a bladder of latex that is slack at the contraction ε_s, where an ideal braid pulls no more; \
                      E = 6 (C₁₀ + C₀₁), V_r is the volume of the rubber",
        },
    ],
    validity: "Rubber that is fresh or rested for a day when the first recording begins, and softened by one recording for \
               the next, or fresh in every one: whichever the recordings show. No recovery within hours.",
    source: "Mullins (1948); Ogden and Roxburgh (1999), Proc. Royal Society A 455, simplified to one exponential over the \
             contraction; Diani, Fayolle and Gilormini (2009), European Polymer Journal 45, for the first cycles",
    signature: "The first cycle to each new contraction, or to each new length where the bladder was mounted under tension, \
                differs from the second at the same pressure and length, the later ones agree; the difference has the shape of the bladder's force and ignores the pressure.",
    confused_with: &[
        Confusion {
            id: "viscoelastic-relaxation",
            because: "the first cycle of rested rubber differs from the later ones as well",
            test: "rest for ten minutes and repeat: relaxation comes back, softening does not",
        },
        Confusion {
            id: "thermal-softening",
            because: "both soften the bladder while the muscle works",
            test: "rest for half an hour and repeat: warm rubber has cooled down, softened rubber has not healed",
        },
        Confusion {
            id: "rubber-hysteresis",
            because: "in a single cycle both take another path back",
            test: "a second cycle to the same contraction: hysteresis opens the same loop again, softening does not",
        },
    ],
    test: "a staircase of largest contractions of 5, 10, 15 and 20 %, three cycles each; the staircase again; rest; again",
    protocol: "run-in",
    coordinate: Coordinate::Cycle,
    typical: Typical { shapes: &[&[0.03, 0.5]], amplitudes: &[0.06, 0.06, 0.0] },
    regions: &[],
    drivers: &["contraction"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn the_virgin_curve_is_untouched_and_the_way_back_softer() {
        let mut memory = MullinsSoftening.start(&nominal(), &[0.03, 0.5]);
        let mut at =
            |contraction_ratio| pull(&mut *memory, &Moment { step_s: 0.1, contraction_ratio, ..still() }, &base())[0];
        assert!(at(0.05).abs() < 1e-12 && at(0.1).abs() < 1e-12);
        // The bladder resists contraction; a softer one leaves more force.
        let back_n = at(0.07);
        assert!((back_n + base().latex_n() * (1.0 - (-1.0_f64).exp())).abs() < 1e-9);
        assert!(back_n > 0.0 && at(-10.0) <= -base().latex_n());
        // Up again along the softened curve, and out onto the virgin one.
        assert!((at(0.07) - back_n).abs() < 1e-12 && at(0.12).abs() < 1e-12);
    }

    #[test]
    fn a_bladder_under_tension_has_less_of_it_below_the_greatest_length_so_far() {
        let muscle = nominal();
        let mut memory = MullinsSoftening.start(&muscle, &[0.03, 0.5]);
        let mut at =
            |contraction_ratio| pull(&mut *memory, &Moment { step_s: 0.1, contraction_ratio, ..still() }, &base())[2];
        // Longer and longer on the virgin curve.
        assert!(at(0.1).abs() < 1e-12 && at(0.02).abs() < 1e-12);
        let back_n = at(0.05);
        let section_m2 = Bladder::new(&muscle).rubber_volume_m3() / muscle.rest_length_m;
        let tension_n = 6.0 * LATEX_PA * section_m2 * (muscle.max_contraction_ratio() - 0.05);
        assert!(tension_n > 10.0 && (back_n + tension_n * (1.0 - (-1.0_f64).exp())).abs() < 1e-9, "{back_n}");
        // Nothing where it is slack, and nothing at the greatest length again.
        assert_eq!(at(muscle.max_contraction_ratio() + 0.01), 0.0);
        assert!(at(0.02).abs() < 1e-12);
    }

    #[test]
    fn the_first_cycles_settle_it_and_noise_at_rest_does_not() {
        let mut memory = MullinsSoftening.start(&nominal(), &[0.03, 0.5]);
        let mut at = |contraction_ratio, step_s| {
            pull(&mut *memory, &Moment { step_s, contraction_ratio, ..still() }, &base())[1]
        };
        assert!(at(0.1, 0.0).abs() < 1e-12);
        for index in 0..1000 {
            assert!(at(0.1 + 4e-4 * f64::from(index % 2), 0.01).abs() < 1e-12);
        }
        // Five cycles of 0.1 there and back are twice the settling travel, but for the play.
        let last_n = (0..10).map(|index| at(0.1 + 0.1 * f64::from((index + 1) % 2), 0.5)).last().expect("ten turns");
        assert!((last_n / base().latex_n() - (-2.0_f64).exp_m1()).abs() < 5e-3, "{last_n}");
        // A gap keeps what was travelled and counts nothing.
        assert!((at(0.15, 0.0) - last_n).abs() < 1e-12);
    }

    #[test]
    fn a_memory_goes_on_from_what_an_earlier_one_has_kept() {
        let mut first = MullinsSoftening.start(&nominal(), &[0.03, 0.5]);
        let at = |contraction_ratio, step_s| Moment { step_s, contraction_ratio, ..still() };
        pull(&mut *first, &at(0.0, 0.0), &base());
        let most_n = pull(&mut *first, &at(0.12, 1.0), &base());
        let mut second = MullinsSoftening.start(&nominal(), &[0.03, 0.5]);
        second.go_on(&first.past());
        let there_n = pull(&mut *second, &at(0.12, 0.0), &base());
        assert!((there_n[0] - most_n[0]).abs() < 1e-12 && (there_n[1] - most_n[1]).abs() < 1e-12);
        let below_n = |memory: &mut dyn Memory| pull(memory, &at(0.05, 0.0), &base())[0];
        let mut fresh = MullinsSoftening.start(&nominal(), &[0.03, 0.5]);
        assert!(below_n(&mut *second) > 10.0 && below_n(&mut *fresh).abs() < 1e-12);
    }

    #[test]
    fn a_gap_does_not_heal_it_and_a_new_recording_does() {
        let mut memory = MullinsSoftening.start(&nominal(), &[0.03, 0.5]);
        let low = Moment { contraction_ratio: 0.02, ..still() };
        pull(&mut *memory, &still(), &base());
        assert!(pull(&mut *memory, &low, &base())[0] > 10.0);
        let mut fresh = MullinsSoftening.start(&nominal(), &[0.03, 0.5]);
        assert!(pull(&mut *fresh, &low, &base())[0].abs() < 1e-12);
    }
}
