//! Effects of one's own: a name, a sentence of the grammar, and ranges of its numbers, in TOML.
//!
//! ```toml
//! [[effect]]
//! id = "touching-guard"
//! name = "a guard that touches the muscle"
//! driver = "contraction"
//! shape = { saturation = { from = [0.08, 0.2], over = [0.002, 0.05] } }
//! amplitude = [0.0, 300.0]
//! ```
//!
//! `driver`, `memory`, `scale` and `shape` are those of a [`Sentence`], written as in a model; without them the memory is `none` and
//! the scale `one`. Where the grammar wants a number, two in brackets are a range that a fit searches. `amplitude` is the range of
//! every number in which the curve is linear, in the unit that scale and curve leave for a force.

use pam_recording::spelling::toml_fault;
use serde::Deserialize;
use serde_json::Value;

use super::{Argument, Curve, Scale, Sentence, own};
use crate::effects::page::{Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, CATALOGUE, Effect, Kind, Memory, NAMELESS, Role, Shape};
use crate::geometry::Muscle;

/// Most numbers of one sentence that may be ranges: every combination is looked at.
const MOST_FREE: usize = 3;
/// Sizes in a range where a fit looks first, and places.
const LOOKS: (usize, usize) = (5, 13);
/// Values that a sentence answers while it is fitted: all of them. What is written says which were seen.
const EVERYWHERE: [f64; 2] = [-1e15, 1e15];
/// Fields of the grammar that are one number, and whether it is a place (or a size, which is positive).
const NUMBERS: [(&str, bool); 9] = [
    ("from", true),
    ("center", true),
    ("over", false),
    ("width", false),
    ("time_constant_s", false),
    ("half_width", false),
    ("distance", false),
    ("above_m_per_s", false),
    ("above_pa_per_s", false),
];

/// Why a file of effects is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CustomError {
    /// It is no TOML, or has other keys.
    #[error("line {line}, column {column}: {reason}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// Why.
        reason: String,
    },
    /// It is TOML without effects.
    #[error("it has no [[effect]]; configs/effects/touching-guard.toml shows one")]
    Nothing,
    /// One of its effects cannot be.
    #[error("effect \"{id}\": {reason}")]
    Effect {
        /// Its id.
        id: String,
        /// Why, and what would do.
        reason: String,
    },
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    #[serde(default)]
    effect: Vec<WrittenEffect>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenEffect {
    id: String,
    name: String,
    summary: Option<String>,
    source: Option<String>,
    #[serde(default)]
    belongs_to: BelongsTo,
    driver: toml::Value,
    #[serde(default = "none")]
    memory: toml::Value,
    #[serde(default = "one")]
    scale: Scale,
    shape: toml::Value,
    amplitude: [f64; 2],
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum BelongsTo {
    #[default]
    Muscle,
    Instrument,
    Fixture,
}

fn none() -> toml::Value {
    toml::Value::String("none".to_owned())
}

fn one() -> Scale {
    Scale::One
}

/// A number of a sentence that is fitted.
#[derive(Debug)]
struct Free {
    /// Where it stands in the sentence, as a JSON pointer.
    pointer: String,
    name: String,
    range: [f64; 2],
    is_place: bool,
}

/// An effect that a user wrote.
#[derive(Debug)]
struct Custom {
    /// The sentence, its free numbers in the middle of their ranges.
    sentence: Sentence,
    /// The same as JSON, and where in it each shape stands.
    template: Value,
    pointers: Vec<String>,
    page: &'static Page,
    shape: &'static [Shape],
    amplitudes: &'static [Amplitude],
}

/// The effects in a file of them, kept for as long as the program runs.
///
/// # Errors
/// [`CustomError`] names the effect, the key and what would do.
pub fn custom_effects(text: &str) -> Result<Vec<&'static dyn Effect>, CustomError> {
    let written: Written = toml::from_str(text).map_err(|error| {
        let (line, column, reason) = toml_fault(text, &error);
        CustomError::Text { line, column, reason }
    })?;
    if written.effect.is_empty() {
        return Err(CustomError::Nothing);
    }
    let mut effects: Vec<&'static dyn Effect> = Vec::new();
    for one in written.effect {
        let id = one.id.clone();
        let refused = |reason: String| CustomError::Effect { id: id.clone(), reason };
        let known = CATALOGUE.iter().chain(NAMELESS).chain(&effects);
        if known.map(|effect| effect.page().id).any(|known| known == one.id) {
            return Err(refused("the id is taken; give it another".to_owned()));
        }
        effects.push(Box::leak(Box::new(Custom::of(&one).map_err(refused)?)));
    }
    Ok(effects)
}

impl Custom {
    fn of(written: &WrittenEffect) -> Result<Self, String> {
        let is_id = |id: &str| {
            let kebab = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
            id.starts_with(|first: char| first.is_ascii_lowercase()) && id.bytes().all(kebab)
        };
        if !is_id(&written.id) {
            return Err("an id has lower-case letters, digits and hyphens, as touching-guard".to_owned());
        }
        if written.name.trim().is_empty() || written.name.chars().any(char::is_control) {
            return Err("name is empty or has control characters; say in words what it is".to_owned());
        }
        let json =
            |key: &str, value: &toml::Value| serde_json::to_value(value).map_err(|error| format!("{key}: {error}"));
        let mut template = serde_json::json!({
            "driver": json("driver", &written.driver)?,
            "memory": json("memory", &written.memory)?,
            "scale": written.scale,
            "shape": json("shape", &written.shape)?,
            "seen": EVERYWHERE,
        });
        let mut free = Vec::new();
        take_ranges(&mut template, "", &mut free)?;
        if free.len() > MOST_FREE {
            return Err(format!("{} numbers are ranges; fix all but {MOST_FREE} of them", free.len()));
        }
        let sentence = parse(&template)?;
        // A sentence that holds at both ends of every range holds between them.
        for end in [0, 1] {
            let mut there = template.clone();
            free.iter().for_each(|free| set(&mut there, &free.pointer, free.range[end]));
            parse(&there)?;
        }
        let amplitudes = amplitudes(&sentence, written.amplitude)?;
        let shape: Vec<Shape> = free.iter().map(|free| shape(free, &sentence)).collect();
        let page = page(written, &sentence, &shape, &amplitudes);
        Ok(Self {
            sentence,
            template,
            pointers: free.into_iter().map(|free| free.pointer).collect(),
            page: Box::leak(Box::new(page)),
            shape: shape.leak(),
            amplitudes: amplitudes.leak(),
        })
    }

    fn at(&self, shape: &[f64]) -> Sentence {
        let mut template = self.template.clone();
        self.pointers.iter().zip(shape).for_each(|(pointer, value)| set(&mut template, pointer, *value));
        parse(&template).unwrap_or_else(|_| self.sentence.clone())
    }
}

/// Puts the middle of every range in its place, and says which they were.
fn take_ranges(value: &mut Value, pointer: &str, free: &mut Vec<Free>) -> Result<(), String> {
    let Value::Object(fields) = value else { return Ok(()) };
    for (key, field) in fields {
        let pointer = format!("{pointer}/{key}");
        let number = NUMBERS.iter().find(|(name, _)| name == key);
        let (Some(&(name, is_place)), Value::Array(ends)) = (number, &*field) else {
            take_ranges(field, &pointer, free)?;
            continue;
        };
        let numbers: Vec<f64> = ends.iter().filter_map(Value::as_f64).collect();
        let range = match numbers[..] {
            [low, high] if ends.len() == 2 && low < high && (is_place || low > 0.0) => [low, high],
            _ if is_place => return Err(format!("{name} is no range; give its ends as [low, high]")),
            _ => return Err(format!("{name} is no range; give its ends as [low, high], both above zero")),
        };
        *field = Value::from(middle(range, is_place));
        free.push(Free { pointer, name: name.to_owned(), range, is_place });
    }
    Ok(())
}

fn middle([low, high]: [f64; 2], is_place: bool) -> f64 {
    if is_place { 0.5 * (low + high) } else { (low * high).sqrt() }
}

fn set(template: &mut Value, pointer: &str, value: f64) {
    if let Some(field) = template.pointer_mut(pointer) {
        *field = Value::from(value);
    }
}

fn parse(template: &Value) -> Result<Sentence, String> {
    let sentence: Sentence = serde_json::from_value(template.clone()).map_err(|error| error.to_string())?;
    sentence.check()?;
    Ok(sentence)
}

/// Amplitudes of the curve, within `range`.
fn amplitudes(sentence: &Sentence, range: [f64; 2]) -> Result<Vec<Amplitude>, String> {
    let [low, high] = range;
    if !(low.is_finite() && high.is_finite() && low < high && low <= 0.0 && high >= 0.0) {
        return Err(format!("amplitude is [{low}, {high}]; give the least and the largest, with zero between them"));
    }
    let largest = sentence.scale.largest();
    // A line has the slope of what drives it, whose range only recordings tell.
    if sentence.shape != Curve::Line && low.abs().max(high) > largest {
        return Err(format!("amplitude is [{low}, {high}]; no muscle wants more than {largest} of this scale"));
    }
    let fitted = own(sentence).map_err(|reason| reason.to_string())?;
    Ok(fitted.amplitudes().iter().map(|amplitude| Amplitude { range: (low, high), ..*amplitude }).collect())
}

fn shape(free: &Free, sentence: &Sentence) -> Shape {
    let [low, high] = free.range;
    let unit = match free.name.as_str() {
        "time_constant_s" => "s",
        "above_m_per_s" => "m/s",
        "above_pa_per_s" => "Pa/s",
        "half_width" | "distance" => sentence.driver.unit(),
        _ => sentence.memory.unit(&sentence.driver),
    };
    let looks = |share: f64| if free.is_place { low + share * (high - low) } else { low * (high / low).powf(share) };
    let n = if free.is_place { LOOKS.1 } else { LOOKS.0 };
    let grid: Vec<f64> = (0..n).map(|index| looks((index as f64 + 0.5) / n as f64)).collect();
    let name = free.name.clone().leak();
    Shape { name, symbol: symbol(name), unit, range: (low, high), grid: grid.leak() }
}

fn page(written: &WrittenEffect, sentence: &Sentence, shape: &[Shape], amplitudes: &[Amplitude]) -> Page {
    let ranged = |name: &'static str, symbol: &'static str, unit: &'static str, (low, high): (f64, f64)| Symbol {
        symbol,
        unit,
        meaning: format!("{name}; fitted, {low} to {high}").leak(),
    };
    let shapes = shape.iter().map(|shape| ranged(shape.name, shape.symbol, shape.unit, shape.range));
    let amplitudes = amplitudes.iter().map(|one| ranged(one.name, one.symbol, one.unit, one.range));
    let symbols: Vec<Symbol> = shapes.chain(amplitudes).collect();
    let given = |text: &Option<String>, otherwise: &'static str| match text {
        Some(text) => text.clone().leak(),
        None => otherwise,
    };
    Page {
        id: written.id.clone().leak(),
        role: Role::Pulls,
        kind: match written.belongs_to {
            BelongsTo::Muscle => Kind::Muscle,
            BelongsTo::Instrument => Kind::Instrument,
            BelongsTo::Fixture => Kind::Fixture,
        },
        dependence: if sentence.is_static() { Dependence::State } else { Dependence::Past },
        name: written.name.clone().leak(),
        summary: given(&written.summary, "An effect of a file of one's own."),
        equation: sentence.equation().leak(),
        symbols: symbols.leak(),
        validity: "Where the recordings show it; a model lets it fade to zero over a tenth of that range beyond.",
        source: given(&written.source, "the file of --effects"),
        signature: "What its equation says.",
        confused_with: &[],
        test: "a further recording in which its driver moves while everything else rests",
        protocol: "multisine",
        coordinate: sentence.driver.coordinate(),
        typical: Typical::UNKNOWN,
        regions: &[],
        drivers: &[],
    }
}

/// Symbol in equations of a number of a sentence, or of an amplitude of its curve.
fn symbol(name: &'static str) -> &'static str {
    match name {
        "time_constant_s" => "τ",
        "half_width" => "h",
        "distance" => "d",
        "center" => "c",
        "width" => "w",
        "from" => "u₁",
        "over" => "u₀",
        "slope" | "limit" | "height" => "a",
        _ => name,
    }
}

impl Effect for Custom {
    fn page(&self) -> &'static Page {
        self.page
    }

    fn shape(&self) -> &'static [Shape] {
        self.shape
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        self.amplitudes
    }

    /// Whatever drives it: a curve may act in a part of the time alone.
    fn is_local(&self) -> bool {
        matches!(self.sentence.shape, Curve::Bump { .. } | Curve::Saturation { .. })
    }

    fn has_one_sign(&self) -> bool {
        matches!(self.sentence.shape, Curve::Monotone { .. })
    }

    fn uses_slopes(&self) -> bool {
        self.sentence.scale.uses_slopes()
    }

    fn sentence_at(&self, shape: &[f64]) -> Option<Sentence> {
        Some(self.at(shape))
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        let sentence = self.at(shape);
        let argument = Argument::of(&sentence);
        Box::new(own::State { sentence, argument })
    }
}

#[cfg(test)]
mod tests;
