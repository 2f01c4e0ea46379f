//! Documentation of an effect.

use crate::coordinate::Coordinate;

/// Where an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Moves a channel in time; [`Effect::delays_s`](super::Effect::delays_s).
    Shift,
    /// Changes the pressure or the length that the muscle sees; [`Memory::sees`](super::Memory::sees).
    Sees,
    /// Takes the place of the direction in the friction of eq. 11; [`Memory::slides`](super::Memory::slides).
    Slides,
    /// Adds a force; [`Memory::pulls`](super::Memory::pulls).
    Pulls,
    /// Changes what the load cell reads of the force; [`Memory::reads`](super::Memory::reads).
    Reads,
}

/// Owner of an effect; a simulation of the muscle takes the muscle's alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A sensor, its wiring or its clock.
    Instrument,
    /// The bench around the muscle.
    Fixture,
    /// The muscle itself, its tube included.
    Muscle,
    /// Something that happened once, in one recording.
    Event,
}

/// What the force of an effect depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dependence {
    /// What went before, time, or speed.
    Past,
    /// Pressure, length and direction alone: a smooth static map can stand in for it.
    State,
    /// The same, in a part of the range alone, where no smooth map follows it.
    PartOfState,
    /// The same, odd in the direction of motion: friction, for which only the odd part of a static map can stand in, and what eq. 11
    /// misses of a static force cannot.
    Direction,
}

/// The page of an effect in the catalogue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Page {
    /// Catalogue id, kebab case.
    pub id: &'static str,
    /// Where it acts.
    pub role: Role,
    /// Its owner.
    pub kind: Kind,
    /// What it depends on.
    pub dependence: Dependence,
    /// Name in words, as in "the muscle shows …".
    pub name: &'static str,
    /// The mechanism, in two or three sentences.
    pub summary: &'static str,
    /// The equation that is fitted, in plain text.
    pub equation: &'static str,
    /// Its symbols.
    pub symbols: &'static [Symbol],
    /// When the equation holds.
    pub validity: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// Its mark in a residual.
    pub signature: &'static str,
    /// Ids of the effects it is confused with, each with the reason and the bench test that separates the two.
    pub confused_with: &'static [Confusion],
    /// The bench test that shows the effect by itself.
    pub test: &'static str,
    /// Protocol of the virtual bench that shows it best, and that `--next-experiment` asks for.
    pub protocol: &'static str,
    /// Coordinate over which it is concentrated.
    pub coordinate: Coordinate,
    /// A size at which it is usual, the middle of the ranges that the symbols give; what recordings could show is asked for it.
    pub typical: Typical,
    /// Coordinates that name the region in which it lives, any of them; none where it lives everywhere.
    pub regions: &'static [Coordinate],
    /// Drivers of an empirical term that say what it depends on, as files call them.
    pub drivers: &'static [&'static str],
}

impl Page {
    /// Why it is confused with the effect `id`, and the test that separates the two; none where the page does not say that it is.
    pub fn confusion_with(&self, id: &str) -> Option<&'static Confusion> {
        self.confused_with.iter().find(|confusion| confusion.id == id)
    }
}

/// An effect at typical sizes, SI: each shape with each amplitude alone is one form of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Typical {
    /// Shapes; none where they depend on the recordings, or are the middle of the grids.
    pub shapes: &'static [&'static [f64]],
    /// One for each amplitude; none where they are the highest.
    pub amplitudes: &'static [f64],
}

impl Typical {
    /// Of an effect that comes in every size.
    pub const UNKNOWN: Self = Self { shapes: &[], amplitudes: &[] };
}

/// One symbol of an equation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Symbol {
    /// As in the equation.
    pub symbol: &'static str,
    /// Unit; `1` where it has none.
    pub unit: &'static str,
    /// Meaning, and the usual range of a parameter.
    pub meaning: &'static str,
}

/// An effect that looks alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Confusion {
    /// Catalogue id.
    pub id: &'static str,
    /// Why they look alike.
    pub because: &'static str,
    /// The test on a bench that distinguishes them.
    pub test: &'static str,
}
