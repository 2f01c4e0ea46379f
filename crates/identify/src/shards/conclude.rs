//! The fit to what shards condensed to.

use std::cell::RefCell;

use pam_artifact::agreement::AgreementArtifact;
use pam_artifact::model::StandstillFit;
use pam_muscle::direction::{Direction, Standstill, Thresholds};
use pam_muscle::force::columns::{ForceColumns, N_COLUMNS};
use pam_recording::Samples;

use super::answer::Shared;
use super::error::ShardError;
use super::tile::recording_of;
use super::triangle::summary;
use crate::check::{enough, of_gates, within_strand};
use crate::condense::{Condensed, Stretch, plan};
use crate::error::IdentifyError;
use crate::evaluate::{Evaluation, Tally, noise_floor_of};
use crate::excitation;
use crate::faults::ranges;
use crate::fit::{Fit, search};
use crate::identified::Identified;
use crate::identify::Checked;
use crate::prepare::{Gated, Prepared};
use crate::problem::ForceProblem;
use crate::report;
use crate::request::Request;
use crate::search_space::{Free, SearchSpace};
use crate::standstill::judge_by;
use crate::uncertainty::jackknife;

/// A request whose recordings are those of the agreement, as far as their quality is known.
///
/// # Errors
/// [`ShardError::Identify`] where what is known of them is refused.
pub(super) fn checked(request: Request, agreement: &AgreementArtifact) -> Result<Checked, ShardError> {
    let nothing = || Samples::from_columns(&[], &[], &[], &[]);
    let gated = agreement.recordings.iter().filter_map(|cut| {
        let quality = cut.quality.clone()?;
        Some(Gated { recording: recording_of(cut, nothing(), Vec::new()), quality })
    });
    let gates: Vec<Gated> = gated.collect();
    let muscle = &request.muscle.muscle;
    for gate in &gates {
        if request.accept_implausible {
            within_strand(gate, muscle.strand_length_m())?;
        } else if let Some(fault) = ranges::check(gate, muscle) {
            return Err(IdentifyError::Fault(fault).into());
        }
    }
    let n_recordings = gates.len();
    Ok(of_gates(gates, n_recordings, request)?)
}

/// The laws of friction at standstill that were compared, the one to be taken first; or those that have to be compared yet.
pub(super) fn judged(agreement: &AgreementArtifact) -> Result<Vec<StandstillFit>, Vec<(Standstill, bool)>> {
    let missing = RefCell::new(Vec::new());
    let fitted = |laws: Vec<Standstill>, late: bool| {
        let known = |standstill: &Standstill| {
            let is_it = |law: &&_| matches(law, *standstill, late);
            agreement.laws.iter().find(is_it).map(|law| law.fit)
        };
        let found: Vec<Option<StandstillFit>> = laws.iter().map(known).collect();
        let unknown = laws.iter().zip(&found).filter(|(_, found)| found.is_none());
        missing.borrow_mut().extend(unknown.map(|(law, _)| (*law, late)));
        found.into_iter().collect::<Option<Vec<StandstillFit>>>().ok_or(())
    };
    judge_by(&fitted).map_err(|()| missing.take())
}

fn matches(law: &pam_artifact::agreement::JudgedLaw, standstill: Standstill, late: bool) -> bool {
    law.late == late && law.fit.standstill == standstill
}

/// What was searched, and where the search ended.
struct Searched {
    columns: ForceColumns,
    condensed: Condensed,
    force_noise_n: f64,
    space: SearchSpace,
    unidentifiable: Vec<Free>,
    column_floor_rmse_n: f64,
    fit: Fit,
}

fn searched(
    checked: &Checked,
    agreement: &AgreementArtifact,
    observe: &(dyn Fn() + Sync),
) -> Result<Searched, ShardError> {
    let columns = Shared::of(agreement, &checked.muscle).columns;
    let condensed = condensed(agreement)?;
    let path = &agreement.recordings[0].name;
    enough(path, condensed.total.n_rows() as usize)?;
    let force_noise_n = checked.force_noise_n();
    let (space, unidentifiable) = checked.search_space(&columns, &condensed, force_noise_n);
    excitation::something_to_fit(&space, &unidentifiable, path)?;
    let problem = ForceProblem { summary: &condensed.total, columns: &columns, space: &space, steps: &[] };
    let column_floor_rmse_n = problem.floor_mean_square().sqrt();
    let fit = search(&problem, &checked.options, observe);
    Ok(Searched { columns, condensed, force_noise_n, space, unidentifiable, column_floor_rmse_n, fit })
}

/// The stretches of all recordings.
fn condensed(agreement: &AgreementArtifact) -> Result<Condensed, ShardError> {
    let n_rows: Vec<usize> = agreement.recordings.iter().map(|cut| cut.extent.n_rows).collect();
    let lacks = |recording: usize| ShardError::Lacks {
        path: agreement.recordings[recording].name.clone(),
        pass: agreement.pass,
    };
    let mut numbers = vec![0; n_rows.len()];
    let stretch = |(recording, rows): (usize, std::ops::Range<usize>)| {
        let number = numbers[recording];
        numbers[recording] += 1;
        let part = agreement.condensed.get(recording).and_then(|parts| parts.get(number));
        let summary = part.and_then(|part| summary(&part.triangle)).ok_or_else(|| lacks(recording))?;
        Ok(Stretch { recording, rows, summary })
    };
    let stretches: Result<Vec<Stretch>, ShardError> = plan(&n_rows).into_iter().map(stretch).collect();
    Ok(Condensed::of(stretches?, N_COLUMNS))
}

/// The parameters that fit best, in SI.
///
/// # Errors
/// [`ShardError::Identify`] where there is nothing to fit.
pub(super) fn theta(
    checked: &Checked,
    agreement: &AgreementArtifact,
    observe: &(dyn Fn() + Sync),
) -> Result<[f64; 8], ShardError> {
    let found = searched(checked, agreement, observe)?;
    Ok(found.space.parameters(&found.fit.x).theta)
}

/// The fit, with the agreement of its model with every recording and what noise does there.
///
/// # Errors
/// [`ShardError::Identify`] where there is nothing to fit, or the model has no force for a sample.
pub(super) fn conclude(
    checked: Checked,
    agreement: &AgreementArtifact,
    thresholds: Thresholds,
    tallies: &[(Tally, [f64; 2])],
    observe: &(dyn Fn() + Sync),
) -> Result<Identified, ShardError> {
    let Searched { columns, condensed, force_noise_n, space, unidentifiable, column_floor_rmse_n, fit } =
        searched(&checked, agreement, observe)?;
    let problem = ForceProblem { summary: &condensed.total, columns: &columns, space: &space, steps: &[] };
    let uncertainty = jackknife(&problem, &condensed, &fit.x, &fit.at_bound);
    let model = checked.model(&checked.muscle.muscle, space.parameters(&fit.x));
    let laws = match checked.assumed.standstill {
        Some(standstill) => vec![StandstillFit { standstill, rmse_n: f64::NAN }],
        None => judged(agreement).unwrap_or_default(),
    };
    let prepared =
        |Gated { recording, quality }: Gated| Prepared { recording, quality, direction: Direction::nothing(0) };
    let muscle = checked.muscle.clone();
    let estimation: Vec<Prepared> = checked.gates.into_iter().map(prepared).collect();
    for (prepared, (tally, _)) in estimation.iter().zip(tallies) {
        tally.judge(prepared, &model)?;
    }
    let n_rows = agreement.recordings.iter().map(|cut| cut.extent.n_rows);
    let floors: Vec<(usize, [f64; 2])> = n_rows.zip(tallies.iter().map(|(_, floor)| *floor)).collect();
    let all: Vec<Tally> = tallies.iter().map(|(tally, _)| *tally).collect();
    let mut identified = Identified {
        muscle: muscle.muscle.clone(),
        model,
        space,
        freed: Vec::new(),
        fit,
        uncertainty,
        unidentifiable,
        thresholds,
        laws,
        told_by_validation: false,
        estimation,
        validation: Vec::new(),
        estimation_fit: Evaluation::of(&all),
        validation_fit: Evaluation::of(&[]),
        unbounded: None,
        force_noise_n,
        noise_floor_n: noise_floor_of(&floors),
        column_floor_rmse_n,
        twin_cosines: report::twin_cosines(&condensed.total),
        warnings: Vec::new(),
    };
    identified.warnings = report::warnings(&identified, &[], &muscle);
    Ok(identified)
}
