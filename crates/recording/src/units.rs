//! Quantities and units as a header writes them: `pressure_kPa`, `time_ms`.

use std::fmt;

/// Quantity of a column of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Time since any origin.
    Time,
    /// Gauge pressure in the muscle.
    Pressure,
    /// Length, clamp to clamp.
    Length,
    /// Tension, positive when the muscle pulls.
    Force,
    /// Temperature of the muscle; optional.
    Temperature,
}

/// A unit: `si = value * multiply / divide + offset`. Decimal fractions divide, because `159.5 / 1000`
/// is the double nearest to 0.1595 and `159.5 * 0.001` need not be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    /// Spelling in a header.
    pub(crate) symbol: &'static str,
    multiply: f64,
    divide: f64,
    offset: f64,
}

impl Unit {
    const fn new(symbol: &'static str, multiply: f64, divide: f64) -> Self {
        Self { symbol, multiply, divide, offset: 0.0 }
    }

    /// `value` in SI.
    #[inline]
    pub(crate) fn si(&self, value: f64) -> f64 {
        value * self.multiply / self.divide + self.offset
    }
}

/// Dates are seconds as well, once they are read.
const TIME: [Unit; 4] =
    [Unit::new("s", 1.0, 1.0), Unit::new("ms", 1.0, 1e3), Unit::new("us", 1.0, 1e6), Unit::new(ISO, 1.0, 1.0)];

/// Unit of a column of dates: ISO 8601.
pub(crate) const ISO: &str = "iso";

/// Other words for quantities, in lower case. A travel ("Weg") is no length: its zero is elsewhere.
const OTHER_WORDS: [(&str, Quantity); 9] = [
    ("zeit", Quantity::Time),
    ("timestamp", Quantity::Time),
    ("datetime", Quantity::Time),
    ("zeitstempel", Quantity::Time),
    ("druck", Quantity::Pressure),
    ("länge", Quantity::Length),
    ("laenge", Quantity::Length),
    ("kraft", Quantity::Force),
    ("temperatur", Quantity::Temperature),
];

/// Other spellings of units.
const OTHER_SYMBOLS: [(&str, &str); 6] =
    [("sec", "s"), ("msec", "ms"), ("µs", "us"), ("μs", "us"), ("°C", "C"), ("degC", "C")];

/// The pound-force per square inch follows from the international inch and pound.
const PRESSURE: [Unit; 5] = [
    Unit::new("kPa", 1e3, 1.0),
    Unit::new("Pa", 1.0, 1.0),
    Unit::new("MPa", 1e6, 1.0),
    Unit::new("bar", 1e5, 1.0),
    Unit::new("psi", 4.448_221_615_260_5, 0.0254 * 0.0254),
];

const LENGTH: [Unit; 4] =
    [Unit::new("mm", 1.0, 1e3), Unit::new("m", 1.0, 1.0), Unit::new("cm", 1.0, 1e2), Unit::new("in", 0.0254, 1.0)];

/// Pound-force and kilogram-force rest on the standard acceleration of 9.80665 m/s².
const FORCE: [Unit; 4] = [
    Unit::new("N", 1.0, 1.0),
    Unit::new("kN", 1e3, 1.0),
    Unit::new("lbf", 4.448_221_615_260_5, 1.0),
    Unit::new("kgf", 9.806_65, 1.0),
];

const TEMPERATURE: [Unit; 2] = [
    Unit { symbol: "C", multiply: 1.0, divide: 1.0, offset: 273.15 },
    Unit { symbol: "K", multiply: 1.0, divide: 1.0, offset: 0.0 },
];

impl Quantity {
    /// Every quantity, in the order of the columns of a recording.
    pub const ALL: [Self; 5] = [Self::Time, Self::Pressure, Self::Length, Self::Force, Self::Temperature];

    /// Word in a header.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Pressure => "pressure",
            Self::Length => "length",
            Self::Force => "force",
            Self::Temperature => "temperature",
        }
    }

    /// A right name, for messages: the unit that benches use most.
    pub fn example(self) -> String {
        format!("{}_{}", self.name(), self.units()[0].symbol)
    }

    /// Units known, the commonest first.
    pub(crate) fn units(self) -> &'static [Unit] {
        match self {
            Self::Time => &TIME,
            Self::Pressure => &PRESSURE,
            Self::Length => &LENGTH,
            Self::Force => &FORCE,
            Self::Temperature => &TEMPERATURE,
        }
    }

    /// Units known, as a list for messages: `kPa, Pa, MPa, bar or psi`.
    pub(crate) fn unit_list(self) -> String {
        let symbols: Vec<&str> = self.units().iter().map(|unit| unit.symbol).collect();
        match symbols.split_last() {
            Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
            None => String::new(),
        }
    }

    pub(crate) fn unit(self, symbol: &str) -> Option<&'static Unit> {
        let other = OTHER_SYMBOLS.iter().find(|(other, _)| other.eq_ignore_ascii_case(symbol));
        let symbol = other.map_or(symbol, |(_, symbol)| symbol);
        self.units().iter().find(|unit| unit.symbol.eq_ignore_ascii_case(symbol))
    }

    fn from_name(name: &str) -> Option<Self> {
        let lower = name.to_lowercase();
        let other = OTHER_WORDS.iter().find(|(word, _)| *word == lower).map(|(_, quantity)| *quantity);
        other.or_else(|| Self::ALL.into_iter().find(|quantity| quantity.name() == lower))
    }

    /// The quantity that `word` misspells: one letter off, two in a long word.
    fn resembling(word: &str) -> Option<Self> {
        let word = word.to_ascii_lowercase();
        let allowed = if word.chars().count() <= 6 { 1 } else { 2 };
        Self::ALL
            .into_iter()
            .map(|quantity| (strsim::osa_distance(&word, quantity.name()), quantity))
            .filter(|(distance, _)| *distance <= allowed)
            .min()
            .map(|(_, quantity)| quantity)
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// Meaning of a column's name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Name {
    /// A right name.
    Channel(Quantity, &'static Unit),
    /// A quantity without a unit.
    UnitMissing(Quantity),
    /// A quantity with a unit that is not known.
    UnitUnknown(Quantity, String),
    /// Nearly a quantity; with the right spelling.
    Misspelt(Quantity, String),
    /// None of the above.
    Other,
}

impl Name {
    pub(crate) fn read(name: &str) -> Self {
        let name = name.trim();
        if let Some(quantity) = Quantity::from_name(name) {
            return Self::UnitMissing(quantity);
        }
        // "Druck [bar]" and "Force (N)" are what spreadsheets and loggers make of a quantity and its unit.
        if let Some((word, symbol)) = bracketed(name)
            && let Some(quantity) = Quantity::from_name(word)
        {
            return match quantity.unit(symbol) {
                Some(unit) => Self::Channel(quantity, unit),
                None => Self::UnitUnknown(quantity, symbol.to_owned()),
            };
        }
        let Some((word, symbol)) = name.rsplit_once('_') else {
            return match Quantity::resembling(name) {
                Some(quantity) => Self::Misspelt(quantity, quantity.example()),
                None => Self::Other,
            };
        };
        if let Some(quantity) = Quantity::from_name(word) {
            return match quantity.unit(symbol) {
                Some(unit) => Self::Channel(quantity, unit),
                None => Self::UnitUnknown(quantity, symbol.to_owned()),
            };
        }
        match Quantity::resembling(word) {
            Some(quantity) => {
                let symbol = quantity.unit(symbol).unwrap_or(&quantity.units()[0]).symbol;
                Self::Misspelt(quantity, format!("{quantity}_{symbol}"))
            }
            None => Self::Other,
        }
    }

    /// Whether the name is that of a quantity, and only its unit is missing.
    pub(crate) fn lacks_unit(&self, of: Quantity) -> bool {
        *self == Self::UnitMissing(of)
    }

    /// The quantity that the name means, rightly spelt or not.
    pub(crate) fn quantity(&self) -> Option<Quantity> {
        match self {
            Self::Channel(quantity, _)
            | Self::UnitMissing(quantity)
            | Self::UnitUnknown(quantity, _)
            | Self::Misspelt(quantity, _) => Some(*quantity),
            Self::Other => None,
        }
    }
}

/// A word and what stands in brackets after it.
fn bracketed(name: &str) -> Option<(&str, &str)> {
    [('[', ']'), ('(', ')')].into_iter().find_map(|(open, close)| {
        let (word, symbol) = name.strip_suffix(close)?.split_once(open)?;
        Some((word.trim(), symbol.trim()))
    })
}

/// Whether `text` is the symbol of a unit, in brackets or not.
pub(crate) fn is_symbol(text: &str) -> bool {
    let symbol = bare_symbol(text);
    Quantity::ALL.into_iter().any(|quantity| quantity.unit(symbol).is_some())
}

/// The symbol of a unit without brackets around it.
pub(crate) fn bare_symbol(text: &str) -> &str {
    let text = text.trim();
    bracketed(text).filter(|(word, _)| word.is_empty()).map_or(text, |(_, symbol)| symbol)
}

/// A quantity without a unit together with the unit that stands elsewhere; any other name as it is.
pub(crate) fn with_unit(name: &str, unit: &str) -> String {
    let unit = bare_symbol(unit);
    if matches!(Name::read(name), Name::UnitMissing(_)) && !unit.is_empty() && unit != "-" {
        format!("{} [{unit}]", name.trim())
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests;
