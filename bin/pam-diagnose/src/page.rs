//! The report of a diagnosis, from the artifact and the samples behind it.

use pam_artifact::diagnosis::{NamedEffect, NextExperiment, Region};
use pam_artifact::model::{ParameterEntry, ParameterStatus};
use pam_artifact::{DiagnosisArtifact, InputRole, ModelArtifact};
use pam_diagnosis::traces::Trace;
use pam_muscle::Coordinate;
use pam_muscle::effects::CATALOGUE;
use pam_muscle::effects::page::Confusion;
use pam_muscle::effects::symbols::{symbol_of_base, symbol_of_effect};
use pam_report::{
    DiagnosisPage, PageAlternative, PageAppendix, PageBaseParameter, PageCandidate, PageEffect, PageEstimate,
    PageInput, PageParameter, PageRecording, PageUnknown,
};

use crate::empirical;
use crate::own::OwnEffects;
use crate::provenance::Provenance;

/// Whether anything was added to the model.
pub(crate) fn has_additions(artifact: &DiagnosisArtifact) -> bool {
    !artifact.effects.is_empty() || artifact.empirical.is_some() || artifact.static_map
}

/// Everything that the report shows.
///
/// `model` is the one that was diagnosed, `augmented` the one with the effects.
pub(crate) fn page(
    artifact: &DiagnosisArtifact,
    [model, augmented]: [&ModelArtifact; 2],
    own: &OwnEffects,
    traces: Vec<Trace>,
    provenance: Provenance,
) -> DiagnosisPage {
    let with_effects = has_additions(artifact);
    DiagnosisPage {
        title: format!("Diagnosis of {}", model.muscle_title()),
        verdict: artifact.verdict,
        statement: artifact.statement.clone(),
        warnings: artifact.warnings.clone(),
        as_given: artifact.as_given.clone(),
        estimation: artifact.fit.estimation,
        holdout: artifact.fit.holdout,
        base_parameters: if with_effects { base_parameters(model, augmented) } else { Vec::new() },
        recordings: traces.into_iter().map(|trace| recording(trace, artifact, with_effects)).collect(),
        regions: significant(&artifact.regions).map(region).collect(),
        effects: artifact.effects.iter().map(|named| effect(named, own)).collect(),
        empirical: artifact.empirical.as_ref().map(empirical::page),
        static_map: artifact.static_map,
        candidates: artifact
            .candidates
            .iter()
            .map(|candidate| PageCandidate {
                id: candidate.id.clone(),
                name: name(&candidate.id, own),
                evidence: candidate.evidence,
                explains: candidate.explains,
                outcome: candidate.outcome.clone(),
            })
            .collect(),
        unknown: PageUnknown {
            regions: significant(&artifact.unexplained_where).map(region).collect(),
            implausible: artifact.implausible.clone(),
        },
        next_experiment: artifact.next_experiment.as_ref().map(|next| NextExperiment {
            // What has no name is nothing that a reader could look up.
            separates: next.separates.iter().filter(|id| own.page(id).is_some()).cloned().collect(),
            ..next.clone()
        }),
        isolability: Some(&artifact.isolability).filter(|isolability| !isolability.ids.is_empty()).cloned(),
        appendix: appendix(artifact, model, provenance),
    }
}

/// Free base parameters, composites and fitted dimensions of both models; what was fixed in both is left out.
fn base_parameters(model: &ModelArtifact, augmented: &ModelArtifact) -> Vec<PageBaseParameter> {
    let estimate = |value: f64, stderr: Option<f64>, status: Option<ParameterStatus>| PageEstimate {
        value,
        stderr,
        status: match status {
            Some(ParameterStatus::AtBound) => "at its bound",
            Some(ParameterStatus::Fixed) => "held",
            Some(ParameterStatus::Fitted | ParameterStatus::Composite) | None => "",
        }
        .to_owned(),
    };
    let parameters = model.parameters.iter().filter_map(|before| {
        let after = augmented.parameters.iter().find(|after| after.name == before.name)?;
        // A member of a composite has no value of its own.
        let is_free =
            |entry: &ParameterEntry| matches!(entry.status, ParameterStatus::Fitted | ParameterStatus::AtBound);
        (is_free(before) || is_free(after)).then(|| PageBaseParameter {
            name: before.name.clone(),
            symbol: symbol_of_base(&before.name).unwrap_or_default().to_owned(),
            unit: before.unit.clone(),
            before: estimate(before.value, before.stderr, Some(before.status)),
            after: estimate(after.value, after.stderr, Some(after.status)),
        })
    });
    let composites = model.composites.iter().filter_map(|before| {
        let after = augmented.composites.iter().find(|after| after.name == before.name)?;
        Some(PageBaseParameter {
            name: before.name.clone(),
            symbol: symbol_of_base(&before.name).unwrap_or_default().to_owned(),
            unit: before.unit.clone(),
            before: estimate(before.value, before.stderr, None),
            after: estimate(after.value, after.stderr, None),
        })
    });
    parameters.chain(composites).collect()
}

fn name(id: &str, own: &OwnEffects) -> String {
    own.page(id).map_or(String::new(), |page| page.name.to_owned())
}

/// Probability by chance above which a region is not shown.
const CHANCE: f64 = 0.05;

/// The first of `regions`, and of the others those that are hardly there by chance.
pub(crate) fn significant(regions: &[Region]) -> impl Iterator<Item = &Region> {
    regions
        .iter()
        .enumerate()
        .filter(|(index, region)| *index == 0 || region.p_value < CHANCE)
        .map(|(_, region)| region)
}

fn region(region: &Region) -> Region {
    Region { recording: region.recording.as_deref().map(short_name), ..region.clone() }
}

fn effect(effect: &NamedEffect, own: &OwnEffects) -> PageEffect {
    let page = own.page(&effect.id);
    let confusions = page.map_or(&[][..], |page| page.confused_with);
    PageEffect {
        id: effect.id.clone(),
        name: effect.name.clone(),
        summary: page.map_or(String::new(), |page| page.summary.to_owned()),
        signature: page.map_or(String::new(), |page| page.signature.to_owned()),
        equation: effect.equation.clone(),
        symbols: page.map_or(Vec::new(), |page| page.symbols.to_vec()),
        validity: page.map_or(String::new(), |page| page.validity.to_owned()),
        source: page.map_or(String::new(), |page| page.source.to_owned()),
        parameters: effect.parameters.iter().map(|entry| parameter(&effect.id, entry)).collect(),
        evidence: effect.evidence,
        alternatives: effect.alternatives.iter().map(|id| alternative(id, confusions, own)).collect(),
        look_alikes: confusions
            .iter()
            .filter(|confusion| !effect.alternatives.iter().any(|id| id == confusion.id))
            .map(|confusion| alternative(confusion.id, confusions, own))
            .collect(),
        separating_test: effect.separating_test.clone(),
    }
}

/// Effect `id` with what the page of the effect that it is mistaken for says of it.
fn alternative(id: &str, confusions: &[Confusion], own: &OwnEffects) -> PageAlternative {
    let confusion = confusions.iter().find(|confusion| confusion.id == id);
    PageAlternative {
        id: id.to_owned(),
        name: name(id, own),
        because: confusion.map_or(String::new(), |confusion| confusion.because.to_owned()),
        test: confusion.map_or(String::new(), |confusion| confusion.test.to_owned()),
    }
}

/// Whether `entry` is what the muscle has been through, and no value of a fit.
pub(crate) fn is_past(entry: &ParameterEntry) -> bool {
    CATALOGUE.iter().any(|effect| effect.keeps().iter().any(|kept| kept.name == entry.name))
}

fn parameter(id: &str, entry: &ParameterEntry) -> PageParameter {
    PageParameter {
        name: entry.name.clone(),
        symbol: symbol_of_effect(id, &entry.name).unwrap_or_default().to_owned(),
        meaning: String::new(),
        value: entry.value,
        unit: entry.unit.clone(),
        stderr: entry.stderr,
        status: match entry.status {
            ParameterStatus::Fitted => "fitted",
            ParameterStatus::Fixed if is_past(entry) => "at the end of these recordings",
            ParameterStatus::Fixed => "not seen by these recordings",
            ParameterStatus::Composite => "not separately identifiable",
            ParameterStatus::AtBound => "at the end of its range",
        }
        .to_owned(),
    }
}

fn recording(trace: Trace, artifact: &DiagnosisArtifact, with_effects: bool) -> PageRecording {
    let scaled = |values: Vec<f64>, scale: f64| values.into_iter().map(|value| value * scale).collect();
    let stretches = significant(&artifact.regions)
        .chain(significant(&artifact.unexplained_where))
        .filter(|region| region.coordinate == Coordinate::Time && region.recording.as_ref() == Some(&trace.path))
        .map(|region| (region.from, region.to))
        .collect();
    PageRecording {
        name: short_name(&trace.path),
        time_s: trace.time_s,
        pressure_kpa: scaled(trace.pressure_pa, 1e-3),
        contraction_percent: scaled(trace.contraction_ratio, 1e2),
        speed_mm_per_s: scaled(trace.speed_m_per_s, 1e3),
        travel_mm: scaled(trace.travel_m, 1e3),
        rest_s: trace.rest_s,
        cycle: trace.cycle,
        force_n: trace.force_n,
        base_force_n: trace.base_n,
        model_force_n: with_effects.then_some(trace.augmented_n),
        settled: trace.settled,
        stretches,
        held_out: trace.held_out,
    }
}

fn appendix(artifact: &DiagnosisArtifact, model: &ModelArtifact, provenance: Provenance) -> PageAppendix {
    let config = &artifact.config;
    let matters = match config.matters_above_n {
        Some(limit_n) => format!("{limit_n} N"),
        None => "what makes the residual half as much again as the noise floor".to_owned(),
    };
    let excluded = if config.excluded.is_empty() { "none".to_owned() } else { config.excluded.join(", ") };
    PageAppendix {
        tool: format!("{} {}", artifact.tool.name, artifact.tool.version),
        muscle: model.muscle_title(),
        command: provenance.command,
        date: provenance.date,
        inputs: artifact
            .inputs
            .iter()
            .map(|input| PageInput {
                role: match input.role {
                    InputRole::Validation => "held out",
                    InputRole::Estimation => "estimation",
                    _ => "model",
                }
                .to_owned(),
                path: input.path.clone(),
                sha256: input.sha256.clone(),
            })
            .collect(),
        options: vec![
            ("excess that matters".to_owned(), matters),
            ("most effects".to_owned(), config.max_effects.to_string()),
            ("effects not considered".to_owned(), excluded),
            ("seed".to_owned(), artifact.seed.to_string()),
        ],
    }
}

/// File name without folders and ending.
pub(crate) fn short_name(path: &str) -> String {
    let file = path.rsplit('/').next().unwrap_or(path);
    file.strip_suffix(".gz").unwrap_or(file).trim_end_matches(".csv").to_owned()
}
