//! Effects beyond eq. 11: the catalogue.
//!
//! One effect is one file: equation, symbols, ranges, source, signature, what it is confused with and the
//! test that tells them apart, as its [`Page`]. An effect has *shape* parameters (time constants,
//! thresholds), in which the force is nonlinear, and *amplitudes*, in which it is linear once the shape is
//! fixed. It acts in one of five [`Role`]s, in this order, at every [`Moment`]:
//!
//! ```text
//! recorded p, L ─ shift ─► sees ─► p, L in the muscle ─► eq. 11, with the friction that slides ─► + pulls ─► reads ─► force
//! ```
//!
//! What an effect remembers is its [`Memory`]. The first moment of a memory finds it settled: as if the
//! muscle had long been there and had come slowly, in the present direction. So one moment alone gives the
//! static force, and a row of them the history, in a recording as in a simulation.

pub mod augmented;
mod catalogue;
pub mod moment;
pub mod page;
pub mod sentence;
pub mod slip;
pub mod symbols;

mod lag;
mod prony;

pub use augmented::{AugmentedMemory, AugmentedModel, Past, Term};
pub use catalogue::{CATALOGUE, Mount, NAMELESS, effect, end_stretch, static_map};
pub use moment::{Base, Moment};
pub use page::{Dependence, Kind, Page, Role, Symbol, Typical};
pub use sentence::Sentence;

use std::fmt;

use crate::geometry::Muscle;

/// A parameter in which the force is nonlinear; SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Name in artifacts, snake case with unit: `time_constant_s`.
    pub name: &'static str,
    /// Symbol in the equation of the page.
    pub symbol: &'static str,
    /// Unit; `1` where it has none.
    pub unit: &'static str,
    /// Lowest and highest value that a fit may give it.
    pub range: (f64, f64),
    /// Where a fit looks first, in rising order.
    pub grid: &'static [f64],
}

/// A parameter in which the force is linear; SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Amplitude {
    /// Name in artifacts.
    pub name: &'static str,
    /// Symbol in the equation of the page.
    pub symbol: &'static str,
    /// Unit; `1` where it has none.
    pub unit: &'static str,
    /// Lowest and highest value that physics allows.
    pub range: (f64, f64),
}

/// Something that a memory keeps for good, whatever rests between recordings; SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kept {
    /// Name in artifacts: `past_travel_m`.
    pub name: &'static str,
    /// Unit; `1` where it has none.
    pub unit: &'static str,
    /// Lowest and highest value that a muscle may have of it.
    pub range: (f64, f64),
    /// Its value before anything was done to the muscle.
    pub fresh: f64,
}

/// Ranges that the recordings cover, for grids that depend on them; SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Lowest and highest contraction ratio.
    pub contraction_ratio: (f64, f64),
    /// Lowest and highest gauge pressure, in Pa.
    pub pressure_pa: (f64, f64),
    /// Lowest and highest force, in N.
    pub force_n: (f64, f64),
    /// Lowest and highest logged temperature above 20 °C, in K; both zero where none was logged.
    pub warmth_k: (f64, f64),
    /// Longest recording, in s.
    pub duration_s: f64,
}

/// An effect of the catalogue.
pub trait Effect: Sync {
    /// Its documentation.
    fn page(&self) -> &'static Page;

    /// Where it acts.
    fn role(&self) -> Role {
        self.page().role
    }

    /// Its owner.
    fn kind(&self) -> Kind {
        self.page().kind
    }

    /// Parameters in which the force is nonlinear.
    fn shape(&self) -> &'static [Shape];

    /// Parameters in which the force is linear; none where the role is not [`Role::Pulls`].
    fn amplitudes(&self) -> &'static [Amplitude] {
        &[]
    }

    /// Shapes where a fit looks first; all combinations of the grids unless the effect knows better.
    fn first_shapes(&self, _seen: &Seen) -> Vec<Vec<f64>> {
        let mut shapes = vec![Vec::new()];
        for parameter in self.shape() {
            shapes = shapes
                .iter()
                .flat_map(|shape| parameter.grid.iter().map(move |&value| [shape.as_slice(), &[value]].concat()))
                .collect();
        }
        shapes
    }

    /// Shapes in the place of `shape` that a fit looks at when every effect is named: details that would stand in for other
    /// effects before.
    fn details(&self, _shape: &[f64]) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// Whether it acts in a part of the range alone; see [`Dependence::PartOfState`].
    fn is_local(&self) -> bool {
        self.page().dependence == Dependence::PartOfState
    }

    /// Whether all its amplitudes have the same sign, whichever it is.
    fn has_one_sign(&self) -> bool {
        false
    }

    /// Whether it depends on pressure, length and direction alone; see [`Dependence`].
    fn is_static(&self) -> bool {
        self.page().dependence != Dependence::Past
    }

    /// Whether a static effect is friction; see [`Dependence::Direction`].
    fn is_odd(&self) -> bool {
        self.page().dependence == Dependence::Direction
    }

    /// Whether it is itself still where shape `index` lies at this `end` of its range: an exponent says how, not what, and a mount
    /// may be rigid.
    fn may_end(&self, _index: usize, _end: f64) -> bool {
        false
    }

    /// Value of parameter `index`, the shapes, behind them the amplitudes and what it keeps, where an artifact does not state it: the
    /// effect had that value before it had the parameter.
    fn unless_stated(&self, _index: usize) -> Option<f64> {
        None
    }

    /// Whether its memory outlasts a recording, so that what went before decides where it begins.
    fn outlasts(&self) -> bool {
        false
    }

    /// Values that its memory keeps for good, in the order of [`Memory::past`].
    fn keeps(&self) -> &'static [Kept] {
        &[]
    }

    /// Whether what it has changed stays: it comes to its end, and recordings after that show nothing of it.
    fn is_permanent(&self) -> bool {
        !self.keeps().is_empty()
    }

    /// Whether its pull goes with pressure and length as recorded, whatever the muscle sees of them.
    fn pulls_as_recorded(&self) -> bool {
        false
    }

    /// Whether its pull needs the slopes of [`Base`], which cost four more evaluations of eq. 11.
    fn uses_slopes(&self) -> bool {
        false
    }

    /// The sentence that it is with `shape`, where it is no effect of the catalogue but one that was written in the grammar.
    fn sentence_at(&self, _shape: &[f64]) -> Option<Sentence> {
        None
    }

    /// By how much the channels of pressure and length are late behind the force, in s; [`Role::Shift`].
    fn delays_s(&self, _shape: &[f64]) -> [f64; 2] {
        [0.0; 2]
    }

    /// A memory at the beginning of a recording or a simulation.
    fn start(&self, muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory>;
}

/// By its id.
impl fmt::Debug for dyn Effect {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.page().id)
    }
}

/// State of an effect from moment to moment.
///
/// At the first moment of a recording a memory is settled. A gap (`step_s == 0`) is crossed: what fades with time has gone on,
/// what slides has come straight from where it was.
pub trait Memory: Send {
    /// Values of what it keeps for good, as [`Effect::keeps`] lists them.
    fn past(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Takes over what an earlier memory of the same effect has kept, before its first moment.
    fn go_on(&mut self, _past: &[f64]) {}

    /// Changes pressure or length from what the channels say to what the muscle sees.
    fn sees(&mut self, _now: &mut Moment) {}

    /// Replacement of the direction in the friction of eq. 11, in [-1, 1] as a rule.
    fn slides(&mut self, now: &Moment) -> f64 {
        now.direction
    }

    /// Fills in the force per unit of each amplitude.
    fn pulls(&mut self, _now: &Moment, _base: &Base, _columns: &mut [f64]) {}

    /// Reading of the load cell for a force, in N.
    fn reads(&mut self, force_n: f64) -> f64 {
        force_n
    }

    /// How much of a small change of the force [`reads`](Self::reads) leaves there, in [0, 1].
    fn slope(&self, _force_n: f64) -> f64 {
        1.0
    }

    /// Whether it leaves less than half.
    fn cuts(&self, force_n: f64) -> bool {
        self.slope(force_n) < 0.5
    }
}
