//! A sentence as an effect, as every program evaluates it.

use std::sync::{Mutex, PoisonError};

use super::{Argument, Curve, Sentence};
use crate::coordinate::Coordinate;
use crate::effects::page::{Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// Id of a sentence that a diagnosis found and that has no name.
pub const EMPIRICAL: &str = "empirical";

/// An effect that is a sentence.
#[derive(Debug)]
struct Own {
    sentence: Sentence,
    page: &'static Page,
    amplitudes: &'static [Amplitude],
}

/// Every sentence that was made an effect, each kept for as long as the program runs.
static KEPT: Mutex<Vec<&'static Own>> = Mutex::new(Vec::new());

/// `sentence` as an effect with the id [`EMPIRICAL`]. The same sentence gives the same effect.
///
/// # Errors
/// Where it cannot be evaluated.
pub fn own(sentence: &Sentence) -> Result<&'static dyn Effect, String> {
    sentence.check()?;
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = kept.iter().find(|own| own.sentence == *sentence) {
        return Ok(*known);
    }
    let amplitudes = amplitudes(sentence).leak();
    let own: &'static Own = Box::leak(Box::new(Own { sentence: sentence.clone(), page: &PAGE, amplitudes }));
    kept.push(own);
    Ok(own)
}

/// Amplitudes of a sentence, with ranges beyond anything that a muscle may want.
fn amplitudes(sentence: &Sentence) -> Vec<Amplitude> {
    let unit = sentence.scale.unit_of_curve();
    let largest = sentence.scale.largest();
    match &sentence.shape {
        Curve::Line => {
            // A line of the whole range's height.
            let [low, high] = sentence.seen;
            let steepest = largest / low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
            vec![Amplitude {
                name: "slope",
                symbol: "a",
                unit: quotient(unit, sentence.memory.unit(&sentence.driver)),
                range: (-steepest, steepest),
            }]
        }
        Curve::Saturation { .. } => vec![Amplitude { name: "limit", symbol: "a", unit, range: (-largest, largest) }],
        Curve::Bump { .. } => vec![Amplitude { name: "height", symbol: "a", unit, range: (-largest, largest) }],
        Curve::Monotone { knots } => (1..knots.len())
            .map(|index| format!("rise_{index}").leak())
            .map(|name| Amplitude { name, symbol: name, unit, range: (-largest, largest) })
            .collect(),
        Curve::Spline { knots } => (0..knots.len())
            .map(|index| format!("value_{}", index + 1).leak())
            .map(|name| Amplitude { name, symbol: name, unit, range: (-largest, largest) })
            .collect(),
    }
}

/// Unit of one quantity over another.
fn quotient(over: &'static str, under: &'static str) -> &'static str {
    match (over, under) {
        (over, "1") => over,
        (over, under) if over == under => "1",
        ("1", "Pa") => "1/Pa",
        ("1", "m/s") => "s/m",
        ("1", under) => format!("1/{under}").leak(),
        (over, "m/s") => format!("{over} s/m").leak(),
        (over, under) => format!("{over}/{under}").leak(),
    }
}

impl Effect for Own {
    fn page(&self) -> &'static Page {
        self.page
    }

    /// Of the muscle as far as anyone knows: what has no name belongs to nothing else.
    fn shape(&self) -> &'static [Shape] {
        &[]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        self.amplitudes
    }

    fn has_one_sign(&self) -> bool {
        matches!(self.sentence.shape, Curve::Monotone { .. })
    }

    fn is_static(&self) -> bool {
        self.sentence.is_static()
    }

    fn uses_slopes(&self) -> bool {
        self.sentence.scale.uses_slopes()
    }

    fn sentence_at(&self, _shape: &[f64]) -> Option<Sentence> {
        Some(self.sentence.clone())
    }

    fn start(&self, _muscle: &Muscle, _shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { sentence: self.sentence.clone(), argument: Argument::of(&self.sentence) })
    }
}

/// A sentence along a recording.
pub(super) struct State {
    pub(super) sentence: Sentence,
    pub(super) argument: Argument,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        let argument = self.argument.follow(now, base);
        self.sentence.columns(argument, now, base, columns);
    }
}

static PAGE: Page = Page {
    id: EMPIRICAL,
    role: Role::Pulls,
    kind: Kind::Muscle,
    // Each sentence says whether it has a past.
    dependence: Dependence::Past,
    name: "empirical term",
    summary: "A force that recordings show and that has no name in the catalogue: what drives it, what it remembers of that, \
              what it is in proportion to and how it answers are those that foretell held-out recordings best.",
    equation: "F = F_base + S f(m(d))",
    symbols: &[
        Symbol { symbol: "d", unit: "-", meaning: "what drives it" },
        Symbol { symbol: "m", unit: "-", meaning: "what it remembers of that" },
        Symbol {
            symbol: "f",
            unit: "-",
            meaning: "how it answers: a line, a saturation, a bump or a curve through values",
        },
        Symbol { symbol: "S", unit: "-", meaning: "what it is in proportion to" },
    ],
    validity: "Where it was seen; it fades to zero over a tenth of that range beyond.",
    source: "none: it is fitted to recordings",
    signature: "What its sentence says.",
    confused_with: &[],
    test: "a further recording in which its driver moves while everything else rests",
    protocol: "multisine",
    coordinate: Coordinate::Contraction,
    typical: Typical::UNKNOWN,
    regions: &[],
    drivers: &[],
};

#[cfg(test)]
mod tests {
    use super::super::{Driver, Recall, Scale};
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::effects::{AugmentedModel, Term};
    use crate::force::{BaseParameters, ForceModel, Form};
    use crate::geometry::tests::nominal;

    fn sentence(shape: Curve) -> Sentence {
        Sentence { driver: Driver::Contraction, memory: Recall::None, scale: Scale::Direction, shape, seen: [0.0, 0.2] }
    }

    #[test]
    fn the_same_sentence_is_kept_once() {
        let one = own(&sentence(Curve::Bump { center: 0.1, width: 0.01 })).expect("an effect");
        let again = own(&sentence(Curve::Bump { center: 0.1, width: 0.01 })).expect("an effect");
        let other = own(&sentence(Curve::Bump { center: 0.1, width: 0.02 })).expect("an effect");
        assert!(std::ptr::addr_eq(one, again) && !std::ptr::addr_eq(one, other));
    }

    #[test]
    fn it_pulls_as_its_sentence_says_and_amplitudes_have_the_unit_of_it() {
        let effect = own(&sentence(Curve::Bump { center: 27.0 / 267.0, width: 0.01 })).expect("an effect");
        assert_eq!((effect.amplitudes()[0].name, effect.amplitudes()[0].unit), ("height", "N"));
        let mut memory = effect.start(&nominal(), &[]);
        assert_eq!(pull(&mut *memory, &still(), &base())[0], 1.0);
        assert_eq!(pull(&mut *memory, &Moment { direction: -1.0, ..still() }, &base())[0], -1.0);
        let pressed = Sentence {
            driver: Driver::Pressure,
            scale: Scale::SlopeOverPressure,
            seen: [0.0, 5e5],
            ..sentence(Curve::Line)
        };
        assert_eq!(own(&pressed).expect("an effect").amplitudes()[0].unit, "1");
    }

    #[test]
    fn a_model_with_it_has_the_force_and_the_slopes_that_it_needs() {
        let parameters = BaseParameters { theta: [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.0] };
        let force = ForceModel::new(&nominal(), 3e9, Form::Corrected, parameters);
        let longer =
            Sentence { scale: Scale::SlopeOverLength, ..sentence(Curve::Spline { knots: vec![0.0, 0.1, 0.2] }) };
        let effect = own(&longer).expect("an effect");
        // As if the length read a tenth of a millimetre short everywhere.
        let term = Term::new(effect, Vec::new(), vec![1e-4; 3]);
        let model = AugmentedModel::new(force.clone(), vec![term]);
        let expected_n = force.force_n(3e5, 0.2401, 1.0);
        assert!((model.settled_force_n(3e5, 0.24, 1.0) - expected_n).abs() < 0.02);
    }
}
