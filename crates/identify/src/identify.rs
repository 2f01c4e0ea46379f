//! All of it in order: from recordings to an artifact.

use pam_artifact::model::{Assumed, BladderLaw, FrictionLaw, IdentifyConfig, Loss, StandstillFit};
use pam_muscle::direction::Thresholds;
use pam_muscle::force::columns::ForceColumns;
use pam_muscle::force::{BaseParameters, ForceModel, Form, Parameter};
use pam_muscle::{Dimension, Muscle, MuscleFile};

use crate::check::enough;
use crate::condense::{Condensed, condense};
use crate::error::IdentifyError;
use crate::evaluate::{evaluate, noise_floor_n};
use crate::fit::{Fit, FitOptions, search};
use crate::prepare::{Gated, Prepared, direct, finest_length_play_m, redirect, thresholds};
use crate::problem::ForceProblem;
use crate::search_space::{Free, LATEX_RATIO, SearchSpace};
use crate::standstill;
use crate::unbounded::unbounded_fit;
use crate::uncertainty::jackknife;
use crate::{excitation, faults, geometry, report, robust};

pub use crate::check::check;
pub use crate::identified::Identified;
pub use crate::request::Request;

/// A request whose recordings have passed the gate.
#[derive(Debug)]
pub struct Checked {
    pub(crate) gates: Vec<Gated>,
    pub(crate) n_estimation: usize,
    pub(crate) muscle: MuscleFile,
    pub(crate) form: Form,
    pub(crate) options: FitOptions,
    pub(crate) loss: Loss,
    pub(crate) free: Vec<Parameter>,
    pub(crate) fix: Vec<(Parameter, f64)>,
    pub(crate) length_play_m: Option<f64>,
    pub(crate) pressure_play_pa: Option<f64>,
    pub(crate) assumed: Assumed,
    pub(crate) accept_implausible: bool,
    pub(crate) unbounded: bool,
}

impl Checked {
    /// Quality gate of every recording, estimation first.
    pub fn gates(&self) -> &[Gated] {
        &self.gates
    }

    /// Fits the model.
    ///
    /// # Errors
    /// [`IdentifyError`] names the recording and the remedy.
    pub fn identify(self) -> Result<Identified, IdentifyError> {
        self.identify_observed(&|| {})
    }

    /// As [`Checked::identify`]; `observe` is called after every move of a swarm, swarms times moves altogether.
    ///
    /// # Errors
    /// As [`Checked::identify`].
    pub fn identify_observed(mut self, observe: &(dyn Fn() + Sync)) -> Result<Identified, IdentifyError> {
        let validation = self.gates.split_off(self.n_estimation);
        let (thresholds, finest_m) = self.thresholds();
        let largest_n_per_m =
            self.gates.iter().map(|gate| gate.quality.largest_pressure_length_n_per_m).fold(0.0, f64::max);
        let force_noise_n = self.force_noise_n();
        let mut estimation = direct(std::mem::take(&mut self.gates), thresholds, self.form)?;
        let columns = ForceColumns::new(&self.muscle.muscle, self.muscle.strand_modulus_pa, self.form, largest_n_per_m);
        let mut validation = direct(validation, thresholds, self.form)?;
        let mut judges: Vec<&Prepared> = estimation.iter().collect();
        let mut laws = self.judge_standstill(&judges, &columns, thresholds)?;
        let told_by_validation = standstill::is_undecided(&laws) && !validation.is_empty();
        if told_by_validation {
            judges.extend(&validation);
            laws = self.judge_standstill(&judges, &columns, thresholds)?;
        }
        let told_by_validation = told_by_validation && !standstill::is_undecided(&laws);
        let mut thresholds = Thresholds { standstill: laws[0].standstill, ..thresholds };
        if self.form == Form::Corrected {
            thresholds = standstill::turning(&estimation.iter().collect::<Vec<_>>(), &columns, thresholds, finest_m)?;
        }
        redirect(&mut estimation, thresholds, self.form)?;
        redirect(&mut validation, thresholds, self.form)?;
        let condensed = condense(&estimation, &columns, 1, None)?;
        enough(&estimation[0].recording.path, condensed.total.n_rows() as usize)?;
        let (space, unidentifiable) = self.search_space(&columns, &condensed, force_noise_n);
        excitation::something_to_fit(&space, &unidentifiable, &estimation[0].recording.path)?;
        let problem = ForceProblem { summary: &condensed.total, columns: &columns, space: &space, steps: &[] };
        let column_floor_rmse_n = problem.floor_mean_square().sqrt();
        let (fit, lags) =
            rayon::join(|| search(&problem, &self.options, observe), || faults::lag::find(&estimation, &columns));
        let lags =
            lags.map_err(|reason| IdentifyError::Samples { path: estimation[0].recording.path.clone(), reason })?;
        let found = self.settle(&estimation, columns.clone(), condensed.clone(), &space, fit, largest_n_per_m)?;
        let problem = ForceProblem {
            summary: &found.condensed.total,
            columns: &found.columns,
            space: &space,
            steps: &found.steps,
        };
        let uncertainty = jackknife(&problem, &found.condensed, &found.fit.x, &found.fit.at_bound);
        let model = self.model(&found.muscle, space.parameters(&found.fit.x[..space.free.len()]));
        for prepared in estimation.iter_mut().chain(&mut validation) {
            prepared.begin(&model, thresholds.standstill)?;
        }
        let estimation_fit = evaluate(&estimation, &model)?;
        let validation_fit = evaluate(&validation, &model)?;
        let noise_floor_n = noise_floor_n(&estimation, &model)?;
        let unbounded = if self.unbounded { unbounded_fit(&columns, &condensed, &validation)? } else { None };
        let mut identified = Identified {
            muscle: found.muscle,
            model,
            space,
            freed: self.muscle.fit.clone(),
            fit: found.fit,
            uncertainty,
            unidentifiable,
            thresholds,
            laws,
            told_by_validation,
            estimation,
            validation,
            estimation_fit,
            validation_fit,
            unbounded,
            force_noise_n,
            noise_floor_n,
            column_floor_rmse_n,
            twin_cosines: report::twin_cosines(&condensed.total),
            warnings: Vec::new(),
        };
        identified.warnings = report::warnings(&identified, &lags, &self.muscle);
        Ok(identified)
    }

    /// Thresholds of the direction, as given or from the noise of the estimation recordings, and the play of the length that their
    /// white noise alone allows, in m.
    pub(crate) fn thresholds(&self) -> (Thresholds, f64) {
        let gates = &self.gates[..self.gates.len().min(self.n_estimation)];
        let from_noise = thresholds(gates, &self.muscle.muscle);
        let thresholds = Thresholds {
            held_m: 0.0,
            turn_m: 0.0,
            standstill: from_noise.standstill,
            length_m: self.length_play_m.unwrap_or(from_noise.length_m),
            pressure_pa: self.pressure_play_pa.unwrap_or(from_noise.pressure_pa),
        };
        let finest_m = self.length_play_m.unwrap_or_else(|| finest_length_play_m(gates, &self.muscle.muscle));
        (thresholds, finest_m)
    }

    /// Laws of friction at standstill, the one to be taken first; only one where it is assumed or makes no difference.
    fn judge_standstill(
        &self,
        recordings: &[&Prepared],
        columns: &ForceColumns,
        thresholds: Thresholds,
    ) -> Result<Vec<StandstillFit>, IdentifyError> {
        match self.assumed.standstill {
            Some(standstill) => Ok(vec![StandstillFit { standstill, rmse_n: f64::NAN }]),
            None if self.form == Form::AsPrinted => {
                Ok(vec![StandstillFit { standstill: thresholds.standstill, rmse_n: f64::NAN }])
            }
            None => standstill::judge(recordings, columns, thresholds),
        }
    }

    /// White noise of the force over all estimation recordings.
    pub(crate) fn force_noise_n(&self) -> f64 {
        let (mut squares, mut rows) = (0.0, 0.0);
        for gate in &self.gates {
            if let Some(force) = gate.quality.channel("force") {
                let n = gate.quality.n_rows as f64;
                squares += n * force.noise * force.noise;
                rows += n;
            }
        }
        (squares / f64::max(rows, 1.0)).sqrt()
    }

    pub(crate) fn model(&self, muscle: &Muscle, parameters: BaseParameters) -> ForceModel {
        ForceModel::new(muscle, self.muscle.strand_modulus_pa, self.form, parameters)
    }

    /// What is moved, and what the recordings cannot identify. Twins whose shares the recordings do not tell are moved
    /// together: `C₁₀` and `C₀₁` as their sum, both frictions as that of the bladder.
    pub(crate) fn search_space(
        &self,
        columns: &ForceColumns,
        condensed: &Condensed,
        noise_n: f64,
    ) -> (SearchSpace, Vec<Free>) {
        let fixed = [Parameter::C10, Parameter::C01].into_iter().any(|parameter| self.fixes(parameter));
        let judged = self.form == Form::Corrected;
        let mut bladder = match self.assumed.bladder {
            _ if fixed || self.free.contains(&Parameter::C01) => BladderLaw::Free,
            Some(bladder) => bladder,
            None => {
                if judged {
                    BladderLaw::Free
                } else {
                    BladderLaw::Shared
                }
            }
        };
        let mut friction = match self.assumed.friction {
            _ if self.free.contains(&Parameter::StrandFriction) => FrictionLaw::Both,
            Some(friction) => friction,
            None => {
                if judged {
                    FrictionLaw::Both
                } else {
                    FrictionLaw::Rubber
                }
            }
        };
        loop {
            let space = self.space_of(columns, bladder, friction);
            let hopeless = self.hopeless(columns, condensed, &space, noise_n);
            let lost = |parameter: Parameter| hopeless.contains(&Free::One(parameter));
            let twins = lost(Parameter::C10) || lost(Parameter::C01);
            let frictions = lost(Parameter::RubberFriction) || lost(Parameter::StrandFriction);
            if bladder == BladderLaw::Free && self.assumed.bladder.is_none() && !fixed && twins {
                bladder = BladderLaw::Shared;
            } else if friction == FrictionLaw::Both && self.assumed.friction.is_none() && frictions {
                friction = FrictionLaw::Rubber;
            } else {
                let mut space = space;
                for &free in &hopeless {
                    if let Some(index) = space.free.iter().position(|other| *other == free) {
                        space.free.remove(index);
                        space.ranges.remove(index);
                    }
                }
                return (space, hopeless);
            }
        }
    }

    /// What these laws move.
    fn space_of(&self, columns: &ForceColumns, bladder: BladderLaw, friction: FrictionLaw) -> SearchSpace {
        let modulus_pa = self.muscle.strand_modulus_pa;
        let mut free = vec![Free::One(Parameter::K1), Free::One(Parameter::K2), Free::One(Parameter::K3)];
        match bladder {
            BladderLaw::Free => free.extend([Free::One(Parameter::C10), Free::One(Parameter::C01)]),
            BladderLaw::Shared => free.push(Free::BladderSum),
        }
        free.push(Free::One(Parameter::StrandCompliance));
        if friction != FrictionLaw::Strands {
            free.push(Free::One(Parameter::RubberFriction));
        }
        if friction != FrictionLaw::Rubber {
            free.push(Free::One(Parameter::StrandFriction));
        }
        // The square of the radius and k1 are one and the same in the gas term.
        if self.muscle.fit.contains(&Dimension::RestRadius) {
            free.retain(|free| *free != Free::One(Parameter::K1));
        }
        free.retain(|free| !matches!(free, Free::One(parameter) if self.fixes(*parameter)));
        let mut held = BaseParameters { theta: [0.0; 8] };
        for parameter in Parameter::ALL {
            held.theta[parameter.index()] = Free::One(parameter).ranges(modulus_pa).nominal;
        }
        if friction == FrictionLaw::Strands {
            held.theta[Parameter::RubberFriction.index()] = 0.0;
        }
        let sum_pa = Free::BladderSum.ranges(modulus_pa).nominal;
        held.theta[Parameter::C10.index()] = sum_pa / (1.0 + LATEX_RATIO);
        held.theta[Parameter::C01.index()] = sum_pa * LATEX_RATIO / (1.0 + LATEX_RATIO);
        for &(parameter, value) in &self.fix {
            held.theta[parameter.index()] = value;
        }
        let range = |free: &Free| {
            let (low, high) = free.ranges(modulus_pa).search;
            if *free == Free::One(Parameter::StrandCompliance) {
                (low, high.min(columns.max_compliance_per_pa()))
            } else {
                (low, high)
            }
        };
        let ranges = free.iter().map(range).collect();
        SearchSpace { free, ranges, held, bladder_ratio: LATEX_RATIO }
    }

    /// What of `space` the recordings cannot identify.
    fn hopeless(&self, columns: &ForceColumns, condensed: &Condensed, space: &SearchSpace, noise_n: f64) -> Vec<Free> {
        let modulus_pa = self.muscle.strand_modulus_pa;
        let center: Vec<f64> = (0..space.free.len()).map(|index| space.nominal_coordinate(index, modulus_pa)).collect();
        let problem = ForceProblem { summary: &condensed.total, columns, space, steps: &[] };
        let floor_n = (condensed.total.residual_floor_square_sum() / condensed.total.n_rows().max(1) as f64).sqrt();
        let held = excitation::unidentifiable(&problem, &center, noise_n.max(floor_n).max(1e-6));
        space.free.iter().zip(held).filter(|(_, held)| *held).map(|(free, _)| *free).collect()
    }

    fn fixes(&self, parameter: Parameter) -> bool {
        self.fix.iter().any(|(fixed, _)| *fixed == parameter)
    }

    /// The slower ways, where asked for: freed dimensions, robust weights.
    fn settle(
        &self,
        estimation: &[Prepared],
        columns: ForceColumns,
        condensed: Condensed,
        space: &SearchSpace,
        fit: Fit,
        largest_n_per_m: f64,
    ) -> Result<Settled, IdentifyError> {
        let muscle = self.muscle.muscle.clone();
        if !self.muscle.fit.is_empty() {
            let setting = geometry::Setting {
                recordings: estimation,
                muscle: &self.muscle.muscle,
                strand_modulus_pa: self.muscle.strand_modulus_pa,
                form: self.form,
                largest_n_per_m,
                freed: &self.muscle.fit,
                space,
                seed: self.options.seed,
            };
            let freed = geometry::fit_freed(&setting, &fit.x)?;
            let fit = Fit { x: freed.x, at_bound: freed.at_bound, converged: freed.converged && fit.converged, ..fit };
            return Ok(Settled {
                muscle: freed.muscle,
                columns: freed.columns,
                condensed: freed.condensed,
                steps: freed.steps,
                fit,
            });
        }
        if self.loss == Loss::Huber {
            let model_of = |x: &[f64]| self.model(&muscle, space.parameters(x));
            let (fit, condensed) = robust::reweight(estimation, &columns, space, &model_of, fit)?;
            return Ok(Settled { muscle, columns, condensed, steps: Vec::new(), fit });
        }
        Ok(Settled { muscle, columns, condensed, steps: Vec::new(), fit })
    }

    /// Options as an artifact states them.
    pub fn config(&self) -> IdentifyConfig {
        IdentifyConfig {
            n_particles: self.options.n_particles,
            n_iterations: self.options.n_iterations,
            n_starts: self.options.n_starts,
            polish: self.options.polish,
            loss: self.loss,
            freed: self
                .free
                .iter()
                .map(|parameter| parameter.artifact_name().to_owned())
                .chain(self.muscle.fit.iter().map(|dimension| dimension.parameter_name().to_owned()))
                .collect(),
            fixed: self
                .fix
                .iter()
                .map(|&(parameter, value)| pam_artifact::model::FixedParameter {
                    name: parameter.artifact_name().to_owned(),
                    value: parameter.from_artifact(value),
                })
                .collect(),
            bladder_ratio: LATEX_RATIO,
            assumed: self.assumed,
            accept_implausible: self.accept_implausible,
        }
    }
}

/// Where the search and what follows it ended.
struct Settled {
    muscle: Muscle,
    columns: ForceColumns,
    condensed: Condensed,
    steps: Vec<(f64, f64)>,
    fit: Fit,
}
