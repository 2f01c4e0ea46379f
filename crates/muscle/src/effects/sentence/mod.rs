//! Sentences: a grammar in which a force without a name is written, and evaluated like any effect.
//!
//! ```text
//! F = F_base + S · f(m(d)) · w
//! ```
//!
//! | part | type         | says                                                                               |
//! |------|--------------|------------------------------------------------------------------------------------|
//! | `d`  | [`Driver`]   | what drives it: pressure, contraction, speed, force, time, …                       |
//! | `m`  | [`Recall`]   | what it remembers of that: nothing, a lag, play, the largest so far, …             |
//! | `f`  | [`Curve`]    | how it answers: a line, a saturation, a bump, a spline with few knots              |
//! | `S`  | [`Scale`]    | what it is in proportion to: nothing, pressure, gas force, friction, direction, …  |
//! | `w`  | [`Sentence::seen`] | 1 where `m(d)` was seen, falling to 0 over a tenth of that range beyond it   |
//!
//! `f` is linear in its amplitudes, which a model carries as parameters; everything else is fixed in the sentence. Any
//! language evaluates it from the formulas in these files and the [`Moment`].

mod argument;
mod curve;
mod custom;
mod driver;
mod own;
mod recall;
mod scale;
mod text;

pub use argument::Argument;
pub use curve::{Curve, MOST_KNOTS};
pub use custom::{CustomError, custom_effects};
pub use driver::Driver;
pub use own::{EMPIRICAL, own};
pub use recall::Recall;
pub use scale::Scale;

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Base, Moment};

/// A force as a sentence of the grammar, but for its amplitudes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Sentence {
    /// What drives it.
    pub driver: Driver,
    /// What it remembers of its driver.
    pub memory: Recall,
    /// What it is in proportion to.
    pub scale: Scale,
    /// How it answers what it remembers.
    pub shape: Curve,
    /// Lowest and highest value, after the memory, that the recordings show; the force fades to zero over a tenth of the
    /// range beyond.
    pub seen: [f64; 2],
}

/// Share of the seen range over which a sentence fades to zero beyond it.
const FADES_OVER: f64 = 0.1;

impl Sentence {
    /// Values that a fit finds: those of the curve.
    pub fn n_amplitudes(&self) -> usize {
        self.shape.n_amplitudes()
    }

    /// Whether it depends on pressure, length and direction alone.
    pub fn is_static(&self) -> bool {
        let is_state = matches!(self.driver, Driver::Pressure | Driver::Contraction | Driver::Force);
        self.memory == Recall::None && is_state
    }

    /// Why it cannot be evaluated, in words.
    ///
    /// # Errors
    /// Names the part and what it may be.
    pub fn check(&self) -> Result<(), String> {
        let [low, high] = self.seen;
        if !(low.is_finite() && high.is_finite() && low < high) {
            return Err(format!("seen is [{low}, {high}]; the first has to be below the second"));
        }
        self.driver.check()?;
        self.memory.check(&self.driver)?;
        self.shape.check()
    }

    /// Fills in the force per unit of each amplitude where the curve's argument is `argument`.
    pub fn columns(&self, argument: f64, now: &Moment, base: &Base, columns: &mut [f64]) {
        let factor = self.weight(argument) * self.scale.factor(now, base);
        self.shape.columns(argument.clamp(self.seen[0], self.seen[1]), columns);
        columns.iter_mut().for_each(|column| *column *= factor);
    }

    /// 1 inside the range that was seen, falling evenly to 0 beyond it.
    pub fn weight(&self, argument: f64) -> f64 {
        let [low, high] = self.seen;
        let beyond = (low - argument).max(argument - high).max(0.0);
        (1.0 - beyond / (FADES_OVER * (high - low))).max(0.0)
    }

    /// Value of the curve with `amplitudes` at `argument`, in the unit of the amplitudes; without scale and fading.
    pub fn value(&self, argument: f64, amplitudes: &[f64]) -> f64 {
        let mut columns = vec![0.0; self.n_amplitudes()];
        self.shape.columns(argument, &mut columns);
        columns.iter().zip(amplitudes).map(|(column, amplitude)| column * amplitude).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::moment::tests::{base, still};
    use super::*;

    fn bump() -> Sentence {
        Sentence {
            driver: Driver::Contraction,
            memory: Recall::None,
            scale: Scale::One,
            shape: Curve::Bump { center: 0.1, width: 0.02 },
            seen: [0.05, 0.15],
        }
    }

    #[test]
    fn beyond_what_was_seen_it_fades_to_zero() {
        let mut sentence = bump();
        sentence.shape = Curve::Line;
        let force_n = |argument: f64| {
            let mut columns = [0.0];
            sentence.columns(argument, &still(), &base(), &mut columns);
            columns[0]
        };
        assert!((force_n(0.15) - 0.15).abs() < 1e-12);
        // Half way through a tenth of the range beyond its end.
        assert!((force_n(0.155) - 0.5 * 0.15).abs() < 1e-12);
        assert_eq!(force_n(0.16), 0.0);
        assert_eq!(force_n(-5.0), 0.0);
    }

    #[test]
    fn a_sentence_survives_its_own_text() {
        let text = serde_json::to_string(&bump()).expect("a sentence is JSON");
        insta::assert_snapshot!(text, @r#"{"driver":"contraction","memory":"none","scale":"one","shape":{"bump":{"center":0.1,"width":0.02}},"seen":[0.05,0.15]}"#);
        assert_eq!(serde_json::from_str::<Sentence>(&text).expect("its own text"), bump());
    }

    #[test]
    fn what_cannot_be_evaluated_is_refused_by_name() {
        let refusal = |change: &dyn Fn(&mut Sentence)| {
            let mut sentence = bump();
            change(&mut sentence);
            sentence.check().expect_err("a refusal")
        };
        let messages = [
            refusal(&|sentence| sentence.seen = [0.2, 0.1]),
            refusal(&|sentence| sentence.shape = Curve::Bump { center: 0.1, width: 0.0 }),
            refusal(&|sentence| sentence.shape = Curve::Spline { knots: vec![0.1, 0.1, 0.2] }),
            refusal(&|sentence| sentence.memory = Recall::Lag { time_constant_s: -1.0 }),
            refusal(&|sentence| (sentence.driver, sentence.memory) = (Driver::Pressure, Recall::Work)),
        ];
        insta::assert_snapshot!(messages.join("\n"), @r"
        seen is [0.2, 0.1]; the first has to be below the second
        the width of the bump is 0; it has to be positive
        the knots do not rise from each to the next
        time_constant_s is -1; it has to be positive
        the memory work is one of the driver contraction
        ");
        bump().check().expect("a sentence");
    }
}
