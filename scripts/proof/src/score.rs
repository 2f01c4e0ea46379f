//! One case: the diagnosis against the truth.

use pam_artifact::diagnosis::{DiagnosisArtifact, Region, Verdict};
use pam_muscle::Coordinate;
use pam_muscle::effects::effect;
use serde::{Deserialize, Serialize};

use crate::case::{Case, Kind, NAMELESS, Place};
use crate::heldout::HeldOut;

/// Share of both intervals that must overlap for a place to be right.
const OVERLAP: f64 = 0.5;

/// What came of a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Score {
    /// The case, with its truth.
    pub case: Case,
    /// What was diagnosed, or what the programs said instead.
    pub outcome: Outcome,
    /// Held-out error against the noise-free truth.
    pub heldout: Option<HeldOut>,
    /// Time of `pam-identify`, in s.
    pub identify_s: f64,
    /// Time of `pam-diagnose`, in s.
    pub diagnose_s: f64,
}

/// What was diagnosed, or what the programs said instead.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// A diagnosis.
    Diagnosed(Diagnosed),
    /// The error of a program.
    Failed(String),
}

/// What counts of a diagnosis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Diagnosed {
    /// What is to be believed.
    pub verdict: Verdict,
    /// Effects in order of evidence.
    pub named: Vec<Named>,
    /// Top region of the mismatch.
    pub top: Option<Spot>,
    /// Top region of what no effect explains.
    pub unexplained_top: Option<Spot>,
    /// Share of the excess left unexplained.
    pub unexplained_share: f64,
}

/// A named effect.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Named {
    /// Id.
    pub id: String,
    /// What the data cannot tell from it.
    pub alternatives: Vec<String>,
}

/// A region of a diagnosis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spot {
    /// Coordinate.
    pub coordinate: Coordinate,
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Share of the excess inside.
    pub share: f64,
}

impl From<&Region> for Spot {
    fn from(region: &Region) -> Self {
        Self { coordinate: region.coordinate, from: region.from, to: region.to, share: region.share_of_excess }
    }
}

impl From<&DiagnosisArtifact> for Diagnosed {
    fn from(artifact: &DiagnosisArtifact) -> Self {
        let named = artifact.effects.iter();
        Self {
            verdict: artifact.verdict,
            named: named
                .map(|effect| Named { id: effect.id.clone(), alternatives: effect.alternatives.clone() })
                .collect(),
            top: artifact.regions.first().map(Spot::from),
            unexplained_top: artifact.unexplained_where.first().map(Spot::from),
            unexplained_share: artifact.unexplained_share,
        }
    }
}

impl Spot {
    /// Whether it is the place: same coordinate, and each interval holds half of the other.
    pub fn is(&self, place: &Place) -> bool {
        let overlap = self.to.min(place.to) - self.from.max(place.from);
        let longer = (self.to - self.from).max(place.to - place.from);
        self.coordinate.name() == place.coordinate && overlap >= OVERLAP * longer
    }
}

impl Score {
    /// The diagnosis, where there is one.
    pub fn diagnosed(&self) -> Option<&Diagnosed> {
        match &self.outcome {
            Outcome::Diagnosed(diagnosed) => Some(diagnosed),
            Outcome::Failed(_) => None,
        }
    }

    /// Ids that are concealed.
    pub fn truth(&self) -> Vec<&str> {
        self.case.concealed.iter().map(|effect| effect.id.as_str()).collect()
    }

    fn first(&self) -> Option<&Named> {
        self.diagnosed()?.named.first()
    }

    /// The first name is right.
    pub fn first_is_right(&self) -> bool {
        self.first().is_some_and(|named| self.truth().contains(&named.id.as_str()))
    }

    /// The first name is right, or the truth is among what it is declared equivalent to.
    pub fn class_is_right(&self) -> bool {
        self.first_is_right()
            || self.first().is_some_and(|named| {
                named.alternatives.iter().any(|alternative| self.truth().contains(&alternative.as_str()))
            })
    }

    /// How many of the concealed effects are named.
    pub fn n_named(&self) -> usize {
        let is_named =
            |id: &&str| self.diagnosed().is_some_and(|diagnosed| diagnosed.named.iter().any(|named| named.id == *id));
        self.truth().iter().filter(|id| is_named(id)).count()
    }

    /// Names that are not concealed.
    pub fn n_false(&self) -> usize {
        let named = self.diagnosed().map_or(&[][..], |diagnosed| &diagnosed.named);
        named.iter().filter(|named| !self.truth().contains(&named.id.as_str())).count()
    }

    /// The verdict.
    pub fn verdict(&self) -> Option<Verdict> {
        self.diagnosed().map(|diagnosed| diagnosed.verdict)
    }

    /// Declared unexplained, without a wrong name.
    pub fn is_rightly_unexplained(&self) -> bool {
        self.verdict() == Some(Verdict::Unexplained) && self.n_false() == 0
    }

    /// For the nameless: whether the top region of what is unexplained, or of the mismatch, is the true place.
    pub fn nameless_place_is_right(&self) -> bool {
        let place = self.case.concealed.iter().find(|effect| NAMELESS.contains(&effect.id.as_str()));
        let Some(place) = place.and_then(|effect| effect.place.as_ref()) else { return false };
        let spots = self.diagnosed().map(|diagnosed| [&diagnosed.unexplained_top, &diagnosed.top]);
        spots.is_some_and(|spots| spots.into_iter().flatten().any(|spot| spot.is(place)))
    }

    /// For a single effect that lives in a region: whether the top region has the right coordinate.
    pub fn coordinate_is_right(&self) -> Option<bool> {
        if self.case.kind != Kind::Single {
            return None;
        }
        let regions = effect(&self.case.concealed.first()?.id)?.page().regions;
        let top = self.diagnosed().and_then(|diagnosed| diagnosed.top.as_ref());
        (!regions.is_empty()).then(|| top.is_some_and(|top| regions.contains(&top.coordinate)))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::case::{Concealed, Noise};

    /// A case with `truth` concealed, diagnosed as `named` with alternatives.
    pub(crate) fn score(kind: Kind, truth: &[&str], verdict: Verdict, named: &[(&str, &[&str])]) -> Score {
        let place = Some(Place { coordinate: "contraction".to_owned(), from: 0.1, to: 0.14 });
        let concealed = truth
            .iter()
            .map(|id| Concealed {
                id: (*id).to_owned(),
                severity: 1.0,
                drawn_over_floor: 2.0,
                over_floor: 2.0,
                place: place.clone(),
            })
            .collect();
        let case = Case {
            name: "bcdf".to_owned(),
            kind,
            muscle_seed: 1,
            effect_seed: 2,
            set: "A".to_owned(),
            lowest_tension_n: 5.0,
            concealed,
            noise: Noise { white_factor: 1.0, colored: false, colored_n: 0.0, floor_n: 1.0, misfit_n: 0.0 },
            nothing_leaves_n: 0.0,
            together_leave_n: 2.0,
            estimation: Vec::new(),
            holdout: Vec::new(),
            redraws: 0,
        };
        let named = named.iter().map(|(id, alternatives)| Named {
            id: (*id).to_owned(),
            alternatives: alternatives.iter().map(|id| (*id).to_owned()).collect(),
        });
        let top = Some(Spot { coordinate: Coordinate::Contraction, from: 0.11, to: 0.15, share: 0.6 });
        let diagnosed =
            Diagnosed { verdict, named: named.collect(), top, unexplained_top: None, unexplained_share: 0.1 };
        let heldout = Some(HeldOut { base_n: 4.0, diagnosed_n: 1.0 });
        Score { case, outcome: Outcome::Diagnosed(diagnosed), heldout, identify_s: 0.1, diagnose_s: 1.0 }
    }

    #[test]
    fn a_name_is_right_first_or_by_its_declared_class() {
        let right = score(Kind::Single, &["slack"], Verdict::Explained, &[("slack", &[])]);
        assert!(right.first_is_right() && right.class_is_right() && right.n_false() == 0);
        let class = score(Kind::Single, &["slack"], Verdict::Ambiguous, &[("stribeck", &["slack"])]);
        assert!(!class.first_is_right() && class.class_is_right());
        let second = score(Kind::Single, &["slack"], Verdict::Explained, &[("stribeck", &[]), ("slack", &[])]);
        assert!(!second.class_is_right() && second.n_named() == 1 && second.n_false() == 1);
    }

    #[test]
    fn the_nameless_are_found_by_verdict_and_place() {
        let tie = score(Kind::Nameless, &["rubbing-tie"], Verdict::Unexplained, &[]);
        assert!(tie.is_rightly_unexplained() && tie.nameless_place_is_right());
        let blamed = score(Kind::Nameless, &["rubbing-tie"], Verdict::Unexplained, &[("slack", &[])]);
        assert!(!blamed.is_rightly_unexplained());
        let place = Place { coordinate: "contraction".to_owned(), from: 0.0, to: 0.12 };
        let spot = Spot { coordinate: Coordinate::Contraction, from: 0.11, to: 0.15, share: 0.6 };
        assert!(!spot.is(&place));
    }
}
