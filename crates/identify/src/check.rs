//! What is refused before anything is fitted.

use pam_muscle::force::Parameter;
use pam_muscle::force::columns::N_COLUMNS;

use crate::error::IdentifyError;
use crate::faults;
use crate::identify::Checked;
use crate::prepare::{Gated, gate};
use crate::request::Request;

/// Looks at the recordings and for instrument faults; nothing is fitted.
///
/// # Errors
/// [`IdentifyError`] names the recording and the remedy.
pub fn check(request: Request) -> Result<Checked, IdentifyError> {
    let n_estimation = request.estimation.len();
    let mut request = request;
    let (estimation, validation) = (std::mem::take(&mut request.estimation), std::mem::take(&mut request.validation));
    let gates = gate(estimation.into_iter().chain(validation).collect())?;
    let strand_m = request.muscle.muscle.strand_length_m();
    for gated in &gates {
        let path = || gated.recording.path.clone();
        if !gated.recording.samples.has_force() {
            return Err(IdentifyError::NoForce { path: path() });
        }
        if request.accept_implausible {
            within_strand(gated, strand_m)?;
        }
    }
    if !request.accept_implausible {
        let fault = faults::find(&gates, &request.muscle.muscle)
            .map_err(|reason| IdentifyError::Samples { path: gates[0].recording.path.clone(), reason })?;
        if let Some(fault) = fault {
            return Err(IdentifyError::Fault(fault));
        }
    }
    of_gates(gates, n_estimation, request)
}

/// Refuses a length that strands of `strand_m` do not reach.
pub(crate) fn within_strand(gated: &Gated, strand_m: f64) -> Result<(), IdentifyError> {
    match gated.quality.channel("length") {
        Some(length) if length.highest >= strand_m => Err(IdentifyError::LengthBeyondStrand {
            path: gated.recording.path.clone(),
            length_mm: length.highest * 1e3,
            strand_mm: strand_m * 1e3,
        }),
        _ => Ok(()),
    }
}

/// What was looked at, of which the first `n_estimation` are to be fitted; refuses too few samples and a constant pressure.
pub(crate) fn of_gates(gates: Vec<Gated>, n_estimation: usize, request: Request) -> Result<Checked, IdentifyError> {
    let n_samples = gates[..n_estimation].iter().map(|gate| gate.quality.n_rows).sum();
    enough(&gates[0].recording.path, n_samples)?;
    let pressures = || gates[..n_estimation].iter().filter_map(|gate| gate.quality.channel("pressure"));
    let lowest_pa = pressures().map(|channel| channel.lowest).fold(f64::INFINITY, f64::min);
    let highest_pa = pressures().map(|channel| channel.highest).fold(f64::NEG_INFINITY, f64::max);
    // To the last digit: where a gauge is alive, what it cannot tell is held at its nominal value, with a word.
    if highest_pa <= lowest_pa {
        return Err(IdentifyError::ConstantPressure {
            path: gates[0].recording.path.clone(),
            pressure_kpa: 0.5e-3 * (lowest_pa + highest_pa),
        });
    }
    Ok(Checked {
        gates,
        n_estimation,
        muscle: request.muscle,
        form: request.form,
        options: request.options,
        loss: request.loss,
        free: request.free,
        fix: request.fix,
        length_play_m: request.length_play_m,
        pressure_play_pa: request.pressure_play_pa,
        assumed: request.assumed,
        accept_implausible: request.accept_implausible,
        unbounded: request.unbounded,
    })
}

/// Refuses fewer samples than twice the columns.
pub(crate) fn enough(path: &str, n_samples: usize) -> Result<(), IdentifyError> {
    let needed = 2 * N_COLUMNS;
    if n_samples < needed {
        let (path, n_parameters) = (path.to_owned(), Parameter::ALL.len());
        return Err(IdentifyError::TooFewSamples { path, n_samples, n_parameters, needed });
    }
    Ok(())
}
