//! A search under the law of friction at standstill that fits best beside what it finds.

use pam_artifact::ModelArtifact;
use pam_identification::evaluate::evaluate_augmented;
use pam_identification::prepare::{Prepared, begin_at_rest, redirect};
use pam_muscle::direction::Thresholds;
use pam_muscle::effects::{AugmentedModel, Term};

use crate::error::DiagnoseError;
use crate::laws;
use crate::problem::{DiagnosisProblem, SearchOutcome};
use crate::rig;
use crate::search::Limits;
use crate::track::Track;

/// Times that another law of friction at standstill may be taken.
const MOST_LAWS: usize = 2;

/// Recordings as directions are found in them.
pub(crate) struct Recordings {
    pub(crate) estimation: Vec<Prepared>,
    pub(crate) holdout: Vec<Prepared>,
    /// Effects of the rig that are known.
    pub(crate) rig: Vec<Term>,
}

impl Recordings {
    /// The directions found anew, in the model as well.
    fn redirect(&mut self, model: &mut ModelArtifact, direction: Thresholds) -> Result<(), DiagnoseError> {
        model.direction = direction;
        for recordings in [&mut self.estimation, &mut self.holdout] {
            redirect(recordings, direction, model.form)?;
            begin_at_rest(recordings, &model.force_model(), direction.standstill)?;
        }
        Ok(())
    }

    /// What is found under the law of friction at standstill that fits best beside it; recordings and model follow that law.
    ///
    /// # Errors
    /// Where samples cannot be read back, or too few tell anything.
    pub(crate) fn under_best_law(
        &mut self,
        model: &mut ModelArtifact,
        limits: &Limits,
        mut track: Track,
        advance: &dyn Fn(),
    ) -> Result<SearchOutcome, DiagnoseError> {
        let mut best = DiagnosisProblem::new(&self.estimation, model, limits.clone()).answer(&track, advance)?;
        for _ in 0..MOST_LAWS {
            let problem = DiagnosisProblem::new(&self.estimation, model, limits.clone());
            // On every instant: what one law mistakes says that another one holds.
            let Some(standstill) = laws::better(&problem, &track, &best.found, model.direction)? else { break };
            let (before, before_n) = (model.direction, self.held_n(&best, model.direction)?);
            self.redirect(model, Thresholds { standstill, ..before })?;
            let redirected = rig::track(&self.estimation, model, &self.rig)?;
            let other = DiagnosisProblem::new(&self.estimation, model, limits.clone()).answer(&redirected, advance)?;
            let left = |outcome: &SearchOutcome| outcome.found.best.held_out.mean_square();
            let held_n = [before_n, self.held_n(&other, model.direction)?];
            if !follows_better([left(&best), left(&other)], (!self.holdout.is_empty()).then_some(held_n)) {
                self.redirect(model, before)?;
                break;
            }
            best = other;
            track = redirected;
        }
        Ok(best)
    }

    /// What is left of the hold-outs, root mean square over all samples, in N; nothing where nothing was held out.
    fn held_n(&self, outcome: &SearchOutcome, direction: Thresholds) -> Result<f64, DiagnoseError> {
        let state = &outcome.found.best.state;
        let terms = self.rig.iter().cloned().chain(state.terms()).collect();
        let augmented = AugmentedModel::new(state.model.clone(), terms).elsewhere();
        let together = evaluate_augmented(&self.holdout, &augmented, direction)?.together;
        Ok(together.map_or(0.0, |together| together.rmse_all_n))
    }
}

/// Whether another law follows the recordings better than the one before, of which `left_square` is left in blocks that were held out,
/// in N², and `held_n` in recordings that were, in N. What judges names judges laws as well; and blocks alone would keep a wrong law
/// beside an effect that is free enough to make up for it there.
fn follows_better(left_square: [f64; 2], held_n: Option<[f64; 2]>) -> bool {
    let [before_n, other_n] = held_n.unwrap_or([1.0; 2]);
    let [before, other] = left_square;
    other_n <= before_n && other * other_n.powi(2) < before * before_n.powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    use std::path::Path;

    use pam_identification::prepare::{direct, gate};
    use pam_muscle::direction::Standstill;
    use pam_recording::{Recording, Repairs, Samples};

    /// Back and forth between 0 and 1 in `period_s`, and the way it goes.
    fn triangle(t: f64, period_s: f64) -> (f64, f64) {
        let turns = (t / period_s).rem_euclid(1.0);
        if turns < 0.5 { (2.0 * turns, 1.0) } else { (2.0 - 2.0 * turns, -1.0) }
    }

    /// A muscle that shortens and lengthens for 30 s and is then held while its pressure goes up and down: friction follows that, or
    /// stays as the last motion left it.
    fn recorded(path: &str, model: &ModelArtifact, follows: bool) -> Recording {
        let force = model.force_model();
        let row = |row: usize| {
            let t = 0.02 * row as f64;
            let (along, way) = triangle(t, 10.0);
            let (length_m, pressure_pa, way) = if t < 30.0 {
                (0.26 - 0.03 * along, 2e5 + 1e5 * (t / 10.0).floor(), way)
            } else {
                (0.26, 2e5 + 2e5 * along, if follows { way } else { -1.0 })
            };
            let noise_n = 0.3 * ((row * 7919 % 1013) as f64 / 506.0 - 1.0);
            [t, pressure_pa, length_m, force.force_n(pressure_pa, length_m, way) + noise_n]
        };
        let rows: Vec<[f64; 4]> = (0..4000).map(row).collect();
        let [time_s, pressure_pa, length_m, force_n] =
            [0, 1, 2, 3].map(|column| rows.iter().map(|row| row[column]).collect::<Vec<f64>>());
        let samples = Samples::from_columns(&time_s, &pressure_pa, &length_m, &force_n);
        let segments = vec![0..samples.n_rows(); 1];
        let (sha256, repairs) = (String::new(), Repairs::default());
        Recording { path: path.to_owned(), sha256, samples, segments, repairs, ignored_columns: Vec::new() }
    }

    /// The law that a diagnosis ends with, of a model whose friction follows the pressure, where it is held in what is fitted.
    fn law(held_out_follows: bool) -> Standstill {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../bin/pam-predict/tests/data/model.json");
        let (mut model, _) = ModelArtifact::read(&path).expect("a model of the nominal muscle");
        model.direction.standstill = Standstill::AT_ONCE;
        let friction = model.parameters.iter_mut().find(|entry| entry.name == "rubber_friction").expect("a friction");
        friction.value = 1.2e-3;
        let prepared = |path, follows| {
            let gated = gate(vec![recorded(path, &model, follows)]).expect("a recording");
            direct(gated, model.direction, model.form).expect("directions")
        };
        let (estimation, holdout) = (prepared("fitted.csv", false), prepared("held.csv", held_out_follows));
        let limits = Limits { confirmed: true, ..Limits::of_test(0, 0.3) };
        let track = Track::of(&estimation, model.direction, &model.force_model()).expect("a track");
        let mut recordings = Recordings { estimation, holdout, rig: Vec::new() };
        recordings.under_best_law(&mut model, &limits, track, &|| {}).expect("a search");
        model.direction.standstill
    }

    #[test]
    fn a_law_is_better_where_blocks_and_recordings_are_followed_better_together_and_recordings_no_worse() {
        assert!(follows_better([4.0, 3.9], None));
        assert!(!follows_better([4.0, 4.0], None));
        assert!(follows_better([4.0, 3.9], Some([3.0, 3.0])));
        assert!(!follows_better([4.0, 1.0], Some([3.0, 3.1])), "held-out recordings are followed worse");
        assert!(follows_better([4.0, 5.0], Some([3.0, 2.0])), "they are followed much better");
        assert!(!follows_better([4.0, 5.0], Some([3.0, 2.9])), "they are followed little better");
    }

    #[test]
    fn a_law_of_standstill_that_fits_better_is_taken_where_hold_outs_are_followed_no_worse() {
        assert_eq!(law(false), Standstill::Held);
        assert_eq!(law(true), Standstill::AT_ONCE);
    }
}
