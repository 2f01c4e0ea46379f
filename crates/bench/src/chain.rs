//! The chain from drive to logger, put together.
//!
//! ```text
//! line → { contact → motion → passive tension → material → friction → resistance → tension }  → sensors → cell → channels
//!          hung in the cable, where there is one: it seeks the length at which the forces are equal
//! ```

use crate::catalogue::{Made, Stage};
use crate::friction::BraidFriction;
use crate::mechanism::{BraidMotion, Mechanism, PassiveTension, Readout, SeriesCable, SmoothMisfit};

/// The chain of a muscle with what is concealed.
pub(crate) fn assemble(made: Vec<Made>, misfit: Option<SmoothMisfit>) -> Vec<Box<dyn Mechanism>> {
    let mut cable = None;
    let mut links = Vec::new();
    for part in made {
        match part {
            Made::Link(stage, link) => links.push((stage, link)),
            Made::Cable(of) => cable = Some(of),
        }
    }
    let mut at = |stage: Stage| -> Vec<Box<dyn Mechanism>> {
        links.extract_if(.., |(of, _)| *of == stage).map(|(_, link)| link).collect()
    };
    let mut chain = at(Stage::Line);
    let mut muscle = at(Stage::Contact);
    muscle.push(Box::new(BraidMotion::new()));
    muscle.push(Box::new(PassiveTension));
    muscle.extend(at(Stage::Material));
    if let Some(misfit) = misfit {
        muscle.push(Box::new(misfit));
    }
    let braid = at(Stage::Braid);
    if braid.is_empty() {
        muscle.push(Box::new(BraidFriction));
    }
    muscle.extend(braid);
    muscle.extend(at(Stage::Resistance));
    muscle.extend(at(Stage::Tension));
    match cable {
        Some(cable) => chain.push(Box::new(SeriesCable::new(cable, muscle))),
        None => chain.extend(muscle),
    }
    chain.push(Box::new(Readout));
    chain.extend(at(Stage::Cell));
    chain.extend(at(Stage::Channel));
    chain
}
