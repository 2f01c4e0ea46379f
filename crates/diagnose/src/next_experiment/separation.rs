//! How far apart protocols drive explanations.

use pam_muscle::effects::Role;
use pam_muscle::force::columns::ForceColumns;
use rayon::prelude::*;

use crate::design_matrix::Regressors;
use crate::protocols::{Protocol, Reach, Take};
use crate::rehearsal::Rehearsal;
use crate::state::{Setting, State};
use crate::tangent::{Tangent, norm};

/// An explanation as it was fitted.
#[derive(Debug, Clone)]
pub(super) struct Explanation {
    /// Catalogue id of what tells it from the others; `nothing` where it has no effect.
    pub id: &'static str,
    /// Base and effects, fitted.
    pub state: State,
}

/// How far apart a protocol drives explanations.
#[derive(Debug, Clone)]
pub(super) struct Separation {
    /// Name of the protocol.
    pub protocol: &'static str,
    /// Root mean square, in N, of each pair: (0, 1), (0, 2), …, (1, 2), …
    pub pairs_n: Vec<f64>,
    /// Time of the bench that it takes, in s.
    pub bench_s: f64,
    /// Share of it that is recorded.
    pub recorded_share: f64,
}

impl Separation {
    /// Information that it brings on all pairs together.
    pub(super) fn worth(&self, noise_n: f64) -> f64 {
        self.pairs_n.iter().map(|pair_n| (self.recorded_share * (pair_n / noise_n).powi(2)).ln_1p()).sum()
    }
}

/// How far apart every protocol that `reach` leaves room for drives `explanations`, in the order of the protocols.
pub(super) fn separations(
    setting: &Setting<'_>,
    protocols: &[Protocol],
    reach: &Reach<'_>,
    explanations: &[Explanation],
) -> Vec<Separation> {
    let (highest_pa, longest_m) = (reach.pressure_pa.1, reach.length_m.1);
    let columns =
        ForceColumns::new(setting.muscle, setting.strand_modulus_pa, setting.columns.form(), highest_pa * longest_m);
    protocols
        .par_iter()
        .filter_map(|protocol| {
            let takes = protocol.takes(reach);
            if takes.is_empty() {
                None
            } else {
                Some(separation(setting, &columns, protocol, &takes, reach, explanations))
            }
        })
        .collect()
}

fn separation(
    setting: &Setting<'_>,
    columns: &ForceColumns,
    protocol: &Protocol,
    takes: &[Take],
    reach: &Reach<'_>,
    explanations: &[Explanation],
) -> Separation {
    let rehearsal = Rehearsal::of(takes, reach);
    let ground = Regressors { track: &rehearsal.track, columns, only: None, slopes: true };
    let setting = Setting {
        track: &rehearsal.track,
        columns,
        space: setting.space,
        muscle: setting.muscle,
        strand_modulus_pa: setting.strand_modulus_pa,
        only: None,
        nuisance: &crate::nuisance::NONE,
        floor_square: 0.0,
        apart: true,
        effects: setting.effects,
    };
    let runs: Vec<Run> = explanations
        .par_iter()
        .map(|explanation| Run::of(&setting, &ground, explanation, &rehearsal.stands_for_s))
        .collect();
    let mut pairs_n = Vec::new();
    for (index, left) in runs.iter().enumerate() {
        for right in &runs[index + 1..] {
            // Either may bend towards the other; the nearer they come, the less the protocol decides.
            let apart = |bent: &Run| norm(&bent.tangent.left_of(|row| left.force_n[row] - right.force_n[row]));
            pairs_n.push(apart(left).min(apart(right)));
        }
    }
    let recorded_s: f64 = takes.iter().map(Take::duration_s).sum();
    let bench_s: f64 = recorded_s + takes.iter().map(|take| take.pause_before_s).sum::<f64>();
    Separation { protocol: protocol.name, pairs_n, bench_s, recorded_share: recorded_s / bench_s }
}

/// An explanation run through a protocol.
struct Run {
    force_n: Vec<f64>,
    tangent: Tangent,
}

impl Run {
    fn of(setting: &Setting<'_>, ground: &Regressors<'_>, explanation: &Explanation, stands_for_s: &[f64]) -> Self {
        let state = &explanation.state;
        let mut sheet = ground.sheet(&state.guesses, &state.model);
        // The compliance of the strands is written in columns of its own range: weights follow from the parameters.
        let mut weights = setting.columns.weights(&state.fit.parameters).to_vec();
        weights.extend(&state.fit.amplitudes);
        let mut reads: Vec<_> = state
            .guesses
            .iter()
            .filter(|guess| guess.effect.role() == Role::Reads)
            .map(|guess| guess.effect.start(setting.muscle, &guess.shape))
            .collect();
        let force_n = sheet
            .columns
            .chunks_exact_mut(sheet.width)
            .map(|row| {
                let mut force_n: f64 = row.iter().zip(&weights).map(|(column, weight)| column * weight).sum();
                for memory in &mut reads {
                    // As much of what the parameters do shows there.
                    let slope = memory.slope(force_n);
                    row.iter_mut().for_each(|column| *column *= slope);
                    force_n = memory.reads(force_n);
                }
                force_n
            })
            .collect();
        let rows = stands_for_s.iter().enumerate().map(|(row, &weight_s)| (row..row + 1, weight_s)).collect();
        let tangent = Tangent::of(setting, state, &sheet, rows);
        Self { force_n, tangent }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::protocols::PROTOCOLS;
    use crate::rehearsal::tests::{Given, domain};

    pub(in crate::next_experiment) fn explanation(given: &Given, id: &'static str, shape: &[f64]) -> Explanation {
        let setting = given.setting();
        let state = setting.fit(vec![given.guess(id, shape)], &given.start, &given.model).expect("a fit");
        Explanation { id, state }
    }

    pub(in crate::next_experiment) fn of<'a>(all: &'a [Separation], protocol: &str) -> &'a Separation {
        all.iter().find(|separation| separation.protocol == protocol).expect("a protocol")
    }

    #[test]
    fn every_protocol_shows_something_of_something() {
        let given = Given::of(&["multisine"], &[("viscoelastic-relaxation", &[3.0], &[0.1, 0.1])]);
        let setting = given.setting();
        let with = explanation(&given, "viscoelastic-relaxation", &[3.0]);
        let without = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let explanations = [with, Explanation { id: "nothing", state: without }];
        let reach = Reach::of(&domain(), &explanations[0].state.model, false);
        let all = separations(&setting, &PROTOCOLS, &reach, &explanations);
        assert_eq!(all.len(), PROTOCOLS.len());
        assert!(of(&all, "length-steps").pairs_n[0] > 10.0 * of(&all, "pressure-chirp").pairs_n[0]);
    }
}
