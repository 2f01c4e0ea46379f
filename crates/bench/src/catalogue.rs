//! The effects that the bench can conceal, by id.
//!
//! A new one is a file here and two lines below, its `mod` and its [`link`].

mod bad_spot;
mod bouc_wen;
mod braid_lockup;
mod capstan;
mod channel_delay;
mod end_taper;
mod force_drift;
mod force_step;
mod gauge_play;
mod inertia;
mod lugre;
mod mullins;
mod pressure_creep;
mod pressure_line;
mod rate_dependence;
mod rubbing_tie;
mod slack;
mod stribeck;
mod thermal;
mod threshold;
mod viscoelastic;
mod viscous;
mod wear;

use crate::draw::Draw;
use crate::mechanism::{Cable, Mechanism};

/// Where in the chain a mechanism stands; within a place they stand in the order of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Between gauge and muscle.
    Line,
    /// Between the gas and the braid.
    Contact,
    /// After the passive tension.
    Material,
    /// In place of the braid's friction.
    Braid,
    /// After the braid's friction.
    Resistance,
    /// Between muscle and load cell.
    Tension,
    /// In the load cell and on what moves with it.
    Cell,
    /// In the channels of the logger.
    Channel,
}

/// What an effect is made of.
pub(crate) enum Made {
    /// A link of the chain.
    Link(Stage, Box<dyn Mechanism>),
    /// What carries the muscle.
    Cable(Cable),
}

type MakeLink = fn(&mut Draw<'_>) -> Box<dyn Mechanism>;

#[derive(Clone, Copy)]
enum Make {
    Link(Stage, MakeLink),
    Cable(fn(&mut Draw<'_>) -> Cable),
}

/// An effect that can be concealed.
#[derive(Clone, Copy)]
pub struct Effect {
    /// Id, as a diagnosis names it.
    pub id: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    make: Make,
}

impl Effect {
    /// The effect with an id.
    pub fn with_id(id: &str) -> Option<&'static Self> {
        EFFECTS.iter().find(|effect| effect.id == id)
    }

    pub(crate) fn make(&self, draw: &mut Draw<'_>) -> Made {
        match self.make {
            Make::Link(stage, make) => Made::Link(stage, make(draw)),
            Make::Cable(make) => Made::Cable(make(draw)),
        }
    }
}

const fn link(id: &'static str, summary: &'static str, stage: Stage, make: MakeLink) -> Effect {
    Effect { id, summary, make: Make::Link(stage, make) }
}

/// Every effect; the last two have no name in the catalogue of a diagnosis.
pub static EFFECTS: &[Effect] = &[
    link("presliding-hysteresis", "LuGre friction of the braid: it gives way before it slides", Stage::Braid, |draw| {
        Box::new(lugre::LuGre::draw(draw))
    }),
    link("rubber-hysteresis", "Bouc-Wen memory of the rubber, whatever the pressure", Stage::Resistance, |draw| {
        Box::new(bouc_wen::BoucWen::draw(draw))
    }),
    link("stribeck", "friction of the braid is higher at low speed and after a rest", Stage::Resistance, |draw| {
        Box::new(stribeck::Stribeck::draw(draw))
    }),
    link("viscous-damping", "damping that grows with pressure, less while extending", Stage::Resistance, |draw| {
        Box::new(viscous::Viscous::draw(draw))
    }),
    link("rate-dependent-hysteresis", "friction of the braid grows as asinh of speed", Stage::Resistance, |draw| {
        Box::new(rate_dependence::RateDependence::draw(draw))
    }),
    link("load-dependent-friction", "a capstan between muscle and load cell", Stage::Tension, |draw| {
        Box::new(capstan::Capstan::draw(draw))
    }),
    link("viscoelastic-relaxation", "the bladder's force relaxes after a stretch", Stage::Material, |draw| {
        Box::new(viscoelastic::Viscoelastic::draw(draw))
    }),
    link("pressure-creep", "the gas force creeps after an inflation", Stage::Material, |draw| {
        Box::new(pressure_creep::PressureCreep::draw(draw))
    }),
    link("mullins-softening", "the bladder is softer where it has been before", Stage::Material, |draw| {
        Box::new(mullins::Mullins::draw(draw))
    }),
    link("thermal-softening", "the bladder warms by its losses and gets softer", Stage::Resistance, |draw| {
        Box::new(thermal::Thermal::draw(draw))
    }),
    link("fatigue-wear", "the gas force fades with the travel of the braid", Stage::Material, |draw| {
        Box::new(wear::Wear::draw(draw))
    }),
    link("threshold-pressure", "the bladder must be blown up before it reaches the braid", Stage::Contact, |draw| {
        Box::new(threshold::Threshold::draw(draw))
    }),
    link("end-taper", "conical ends take volume from the cylinder", Stage::Material, |draw| {
        Box::new(end_taper::EndTaper::draw(draw))
    }),
    link("braid-lockup", "the strands jam near the largest contraction", Stage::Material, |draw| {
        Box::new(braid_lockup::BraidLockup::draw(draw))
    }),
    link("slack", "a cable carries tension but cannot push", Stage::Tension, |draw| Box::new(slack::Slack::draw(draw))),
    link("pressure-lag", "a tube between gauge and muscle", Stage::Line, |draw| {
        Box::new(pressure_line::PressureLine::draw(draw))
    }),
    link("pressure-gauge-hysteresis", "the gauge's works have play", Stage::Channel, |draw| {
        Box::new(gauge_play::GaugePlay::draw(draw))
    }),
    link("channel-delay", "one channel of the log is late", Stage::Channel, |draw| {
        Box::new(channel_delay::ChannelDelay::draw(draw))
    }),
    Effect {
        id: "series-compliance",
        summary: "a cable that stretches between drive and muscle",
        make: Make::Cable(Cable::draw),
    },
    link("inertia", "the load cell also feels the mass of the moving end", Stage::Cell, |draw| {
        Box::new(inertia::Inertia::draw(draw))
    }),
    link("force-drift", "the load cell's zero drifts as it warms up", Stage::Cell, |draw| {
        Box::new(force_drift::ForceDrift::draw(draw))
    }),
    link("force-step", "a slip or knock shifts the load cell's zero at one instant", Stage::Cell, |draw| {
        Box::new(force_step::ForceStep::draw(draw))
    }),
    link("rubbing-tie", "a tie rubs over part of the stroke", Stage::Resistance, |draw| {
        Box::new(rubbing_tie::RubbingTie::draw(draw))
    }),
    link("bad-spot", "the load cell is off over part of its range", Stage::Cell, |draw| {
        Box::new(bad_spot::BadSpot::draw(draw))
    }),
];
