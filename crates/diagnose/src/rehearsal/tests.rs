use pam_artifact::model::Domain;
use pam_identification::search_space::{Free, LATEX_RATIO, SearchSpace};
use pam_muscle::Muscle;
use pam_muscle::effects::effect;
use pam_muscle::force::columns::ForceColumns;
use pam_muscle::force::{BaseParameters, Form, Parameter};

use super::*;
use crate::design_matrix::Regressors;
use crate::hypothesis::{Beginning, CandidateEffect};
use crate::protocols;
use crate::search::{Found, Limits, judged, search};
use crate::state::Setting;

pub(crate) fn domain() -> Domain {
    Domain {
        pressure_pa: [0.0, 5e5],
        length_m: [0.213, 0.268],
        force_n: [3.0, 850.0],
        length_rate_m_per_s: 0.1,
        pressure_rate_pa_per_s: 5e5,
    }
}

/// Recordings without noise, made by a known model.
pub(crate) struct Given {
    pub track: Track,
    pub columns: ForceColumns,
    pub space: SearchSpace,
    pub muscle: Muscle,
    pub model: ForceModel,
    pub start: Vec<f64>,
}

impl Given {
    /// Of the protocols, with effects (id, shape, amplitudes).
    pub(crate) fn of(names: &[&str], effects: &[(&'static str, &[f64], &[f64])]) -> Self {
        let muscle = Muscle::nominal();
        let c10_pa = 220e3 / (1.0 + LATEX_RATIO);
        let parameters =
            BaseParameters { theta: [0.9, 1.05, 2.0, c10_pa, c10_pa * LATEX_RATIO, 1.0 / 3e9, 1.2e-3, 0.0] };
        let model = ForceModel::new(&muscle, 3e9, Form::Corrected, parameters);
        let columns = ForceColumns::new(&muscle, 3e9, Form::Corrected, 5e5 * 0.268);
        let free: Vec<Free> = [Parameter::K1, Parameter::K2, Parameter::K3]
            .map(Free::One)
            .into_iter()
            .chain([Free::BladderSum, Free::One(Parameter::StrandCompliance), Free::One(Parameter::RubberFriction)])
            .collect();
        let ranges: Vec<(f64, f64)> = free
            .iter()
            .map(|free| {
                let (low, high) = free.ranges(3e9).search;
                if *free == Free::One(Parameter::StrandCompliance) {
                    (low, high.min(columns.max_compliance_per_pa()))
                } else {
                    (low, high)
                }
            })
            .collect();
        let values = [0.9, 1.05, 2.0, 220e3, 1.0 / 3e9, 1.2e-3];
        let start = values.iter().zip(&ranges).map(|(value, (low, high))| (value - low) / (high - low)).collect();
        let space = SearchSpace { free, ranges, held: parameters, bladder_ratio: LATEX_RATIO };
        let limits = domain();
        let reach = Reach {
            model: &model,
            pressure_pa: (limits.pressure_pa[0], limits.pressure_pa[1]),
            length_m: (limits.length_m[0], limits.length_m[1]),
            lowest_tension_n: 8.0,
        };
        let takes: Vec<Take> =
            names.iter().flat_map(|name| protocols::named(name).expect("a protocol").takes(&reach)).collect();
        let mut track = Rehearsal::with_steps(&takes, &reach, 0.04).track;
        for (index, range) in track.recordings.iter().enumerate() {
            let rows = range.len();
            for piece in 0..8 {
                track.blocks.push(range.start + piece * rows / 8..range.start + (piece + 1) * rows / 8);
                track.recording_of_block.push(index);
                track.fold_of_block.push(piece);
            }
        }
        track.sample();
        let mut given = Self { track, columns, space, muscle, model, start };
        let guesses: Vec<CandidateEffect> = effects.iter().map(|(id, shape, _)| given.guess(id, shape)).collect();
        let mut weights = given.columns.weights(&parameters).to_vec();
        weights.extend(effects.iter().flat_map(|(_, _, amplitudes)| amplitudes.iter()));
        let sheet = Regressors { track: &given.track, columns: &given.columns, only: None, slopes: true }
            .sheet(&guesses, &given.model);
        for (at, instant) in given.track.instants.iter_mut().enumerate() {
            instant.force_n = sheet.force_n(at, &weights);
            instant.moment.force_n = instant.force_n;
        }
        given
    }

    /// Adds noise that neighbors share, of about 0.2 N.
    pub(crate) fn disturb(&mut self) {
        for (at, instant) in self.track.instants.iter_mut().enumerate() {
            let at = at as f64;
            instant.force_n += 0.2 * ((0.37 * at).sin() + (0.011 * at).sin());
        }
    }

    /// Adds a smooth static force of `size_n` at most, which the base lacks.
    pub(crate) fn bend(&mut self, size_n: f64) {
        for instant in &mut self.track.instants {
            let (p, e) = (instant.moment.pressure_pa * 2e-6, instant.moment.contraction_ratio * 5.0);
            instant.force_n += size_n * (2.5 * p + 2.0 * e).sin() * p;
        }
    }

    pub(crate) fn guess(&self, id: &str, shape: &[f64]) -> CandidateEffect {
        CandidateEffect {
            effect: effect(id).expect("an id"),
            shape: shape.to_vec(),
            sign: crate::hypothesis::Sign::Any,
            beginning: Beginning::Fresh,
        }
    }

    /// Asks of a search that took `guesses`, where the sensors leave `sensors_n`: in the setting in which these were fitted.
    pub(crate) fn with_found<T>(
        &self,
        sensors_n: f64,
        guesses: Vec<CandidateEffect>,
        ask: impl FnOnce(&Setting<'_>, Found, &Limits) -> T,
    ) -> T {
        let limits = Limits::of_test(0, sensors_n);
        let plain = Setting { floor_square: sensors_n.powi(2), ..self.setting() };
        let mut found = search(&plain, &self.start, &self.model, &limits, &|| {}).expect("a search");
        let nuisance = found.nuisance.clone();
        let setting = plain.beside(&nuisance);
        let state = setting.fit_near(guesses, &found.best.state).expect("a fit");
        found.best = judged(&setting, state).expect("a fit of every fold");
        ask(&setting, found, &limits)
    }

    pub(crate) fn setting(&self) -> Setting<'_> {
        Setting {
            track: &self.track,
            columns: &self.columns,
            space: &self.space,
            muscle: &self.muscle,
            strand_modulus_pa: 3e9,
            only: None,
            nuisance: &crate::nuisance::NONE,
            floor_square: 0.0,
            apart: true,
            effects: pam_muscle::effects::CATALOGUE,
        }
    }
}

#[test]
fn the_time_that_instants_stand_for_is_that_of_the_protocol() {
    let given = Given::of(&["null"], &[]);
    let limits = domain();
    let reach = Reach {
        model: &given.model,
        pressure_pa: (limits.pressure_pa[0], limits.pressure_pa[1]),
        length_m: (limits.length_m[0], limits.length_m[1]),
        lowest_tension_n: 8.0,
    };
    for name in ["isobaric-triangles", "isometric-ramps", "pressure-chirp", "dwell"] {
        let takes = protocols::named(name).expect("a protocol").takes(&reach);
        let rehearsal = Rehearsal::of(&takes, &reach);
        let (have_s, expected_s) =
            (rehearsal.stands_for_s.iter().sum::<f64>(), takes.iter().map(Take::duration_s).sum::<f64>());
        // Reversals are left out, at most half of a sweep.
        assert!(have_s <= expected_s * (1.0 + 1e-9), "{name}: {have_s} {expected_s}");
        assert!(have_s > 0.75 * expected_s, "{name}: {have_s} {expected_s}");
        assert!(rehearsal.track.instants.iter().all(|instant| instant.moment.direction != 0.0), "{name}");
    }
}
