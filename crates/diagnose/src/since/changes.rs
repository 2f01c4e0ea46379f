//! All of it in order: the model of then and later recordings in, what has changed out.

use pam_artifact::ModelArtifact;
use pam_artifact::change::{Change, ChangeCandidate, ChangeConfig, ChangeFit, ChangeVerdict, Compared};
use pam_identification::evaluate::{evaluate_augmented, noise_floor_n};
use pam_muscle::force::columns::ForceColumns;
use pam_recording::Recording;

use super::baseline::Baseline;
use super::domain::keep_within;
use super::hypothesis::Later;
use super::nuisances::nuisances;
use super::point::Point;
use super::rows::Rows;
use super::search::Bounds;
use super::traces::LaterTrace;
use super::written;
use crate::check;
use crate::error::DiagnoseError;
use crate::track::Track;

/// What to compare.
#[derive(Debug)]
pub struct Request {
    /// Later recordings.
    pub recordings: Vec<Recording>,
    /// The model of then with what was diagnosed then.
    pub baseline: ModelArtifact,
    /// Options.
    pub config: ChangeConfig,
}

/// What has changed.
#[derive(Debug)]
pub struct Changes {
    /// What is to be believed.
    pub verdict: ChangeVerdict,
    /// In words.
    pub statement: String,
    /// What has changed.
    pub changes: Vec<Change>,
    /// Everything else.
    pub unchanged: Vec<Compared>,
    /// Residuals.
    pub fit: ChangeFit,
    /// Everything that was weighed alone.
    pub candidates: Vec<ChangeCandidate>,
    /// What a person should know.
    pub warnings: Vec<String>,
    /// The recordings over time.
    pub traces: Vec<LaterTrace>,
}

/// Share of the variance of the force below which the model of then is that of another muscle, unless what has changed brings it
/// near what it left of its own recordings.
const OF_THIS_MUSCLE: f64 = 0.9;
/// Times what it left of its own recordings that is near.
const OF_ITS_OWN: f64 = 3.0;
/// Share of what counts that must lie within the pressures and lengths of then.
const LEAST_COMPARED: f64 = 0.2;

/// Checks the recordings without fitting anything.
///
/// # Errors
/// [`DiagnoseError`] names the recording and the remedy.
pub fn check(request: Request) -> Result<(), DiagnoseError> {
    prepared(request).map(|_| ())
}

/// Compares.
///
/// # Errors
/// [`DiagnoseError`] names the recording and the remedy.
pub fn changes(request: Request) -> Result<Changes, DiagnoseError> {
    let (track, baseline, config, fit) = prepared(request)?;
    let path = || baseline.path.clone();
    let then = &baseline.point;
    let columns = nuisances(then, &baseline.known, &track, baseline.floor_n);
    let rows = Rows::new(&track, &columns, baseline.floor_n.powi(2));
    let measured_n = track.instants.iter().map(|instant| instant.force_n).collect();
    let bounds = Bounds {
        free: &baseline.known.free,
        n_then: then.terms.len(),
        seen: track.seen(),
        excluded: &config.excluded,
        most: config.max_changes,
        floor_n: baseline.floor_n,
        missed_n: baseline.known.missed_n,
    };
    let later = Later { track: &track, rows, measured_n };
    let found = later.search(then, &bounds).ok_or_else(|| DiagnoseError::Undetermined { path: path() })?;
    let changes = written::written(&later, then, &baseline.known, &found, fit);
    let ChangeFit { then_n, as_then_n, now_n, noise_floor_n, .. } = changes.fit;
    let follows = now_n < OF_ITS_OWN * then_n.max(noise_floor_n);
    if baseline.explained < OF_THIS_MUSCLE && !follows && !config.accept_implausible {
        let explained = 100.0 * baseline.explained;
        return Err(DiagnoseError::NotOfThen { path: path(), left_n: as_then_n, now_n, explained });
    }
    Ok(changes)
}

/// The model of then, read for a comparison.
struct Then {
    point: Point,
    known: Baseline,
    /// Noise floor of the later recordings, in N.
    floor_n: f64,
    /// First of the later recordings.
    path: String,
    /// Share of the variance of their force that it explains.
    explained: f64,
}

fn prepared(request: Request) -> Result<(Track, Then, ChangeConfig, ChangeFit), DiagnoseError> {
    let Request { recordings, baseline, config } = request;
    let (mut later, _) = check::prepare(recordings, Vec::new(), &baseline, config.accept_implausible)?;
    let augmented = baseline.augmented_model().elsewhere();
    for prepared in &mut later {
        prepared.begin_with(&augmented, baseline.direction, 0)?;
    }
    let path = later[0].recording.path.clone();
    let as_then = evaluate_augmented(&later, &augmented, baseline.direction)?;
    let floor_n = noise_floor_n(&later, augmented.base())?;
    let mut track = Track::of(&later, baseline.direction, augmented.base())?;
    let share_compared = keep_within(&mut track, &baseline.domain);
    if share_compared < LEAST_COMPARED {
        let [low, high] = baseline.domain.pressure_pa.map(|pressure_pa| 1e-3 * pressure_pa);
        let [short, long] = baseline.domain.length_m.map(|length_m| 1e3 * length_m);
        return Err(DiagnoseError::Elsewhere { path, low, high, short, long });
    }
    check::long_enough(&track, &later)?;
    let largest_n_per_m =
        later.iter().map(|prepared| prepared.quality.largest_pressure_length_n_per_m).fold(0.0, f64::max);
    let columns = ForceColumns::new(&baseline.geometry, baseline.strand_modulus_pa, baseline.form, largest_n_per_m);
    let explained = as_then.together.map_or(0.0, |together| together.r2.max(0.0));
    let fit = ChangeFit {
        then_n: baseline.fit.estimation.rmse_n,
        as_then_n: 0.0,
        within_errors_n: 0.0,
        now_n: 0.0,
        noise_floor_n: floor_n,
        share_compared,
    };
    let known = Baseline::of(&baseline, &columns);
    let then = Then { point: Point::of(&augmented), known, floor_n, path, explained };
    Ok((track, then, config, fit))
}
