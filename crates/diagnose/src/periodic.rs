//! A force that swings at one frequency in recording after recording while neither pressure nor length does.
//!
//! A pump without a tank, a motor on the frame, the mains: what swings by its own clock is no function of what the channels show, so no
//! effect and no term can foretell it, and a root mean square hides it beside reversals. In a spectrum it stands alone. What comes from
//! the drives is there in pressure or length as well, or at multiples of what is.
//!
//! In a study of these rules on 530 cases of other benches that were looked at all ten with a pump are found, and none of the others. Each
//! constant halved and doubled: with half of what makes a line one more case has one, and with twice as much one pump less is found; with half of
//! what a drive may have, one less; in a sixth of the recordings in place of a third the same are found, in two thirds three less; with
//! half of what matters four more cases have a line, which is hum, and with twice as much two pumps less are found; with windows of 5 s one less, and with
//! windows of 20 s two less, and one more case has a line.

mod spectrum;

use pam_artifact::diagnosis::Periodic;
use pam_identification::trace::Trace;
use rayon::prelude::*;

use spectrum::{Spectrum, hz};

/// Share of the recordings that are to have it, and how many at least: a pump does not always run.
const SHARE: f64 = 1.0 / 3.0;
/// See [`SHARE`].
const LEAST: usize = 2;

/// The line of the residuals of `traces` that is largest, at one frequency in at least a third of the recordings that are long enough.
pub(crate) fn periodic<'a>(traces: impl IntoParallelIterator<Item = &'a Trace>) -> Option<Periodic> {
    let spectra: Vec<Spectrum> = traces.into_par_iter().filter_map(Spectrum::of).collect();
    let least = LEAST.max((SHARE * spectra.len() as f64).ceil() as usize);
    let of_one = |k: usize| {
        // A frequency between two of the spectrum is in either.
        let is_near = |spectrum: &&Spectrum| (k - 1..=k + 1).any(|near| spectrum.line_n(near).is_some());
        let n_recordings = spectra.iter().filter(is_near).count();
        let amplitude_n = spectra.iter().filter_map(|spectrum| spectrum.line_n(k)).max_by(f64::total_cmp)?;
        let line = Periodic { frequency_hz: hz(k), amplitude_n, n_recordings, n_looked_at: spectra.len() };
        (n_recordings >= least).then_some(line)
    };
    let lines = Spectrum::frequencies().filter_map(of_one);
    lines.max_by(|one, other| one.amplitude_n.total_cmp(&other.amplitude_n))
}

/// Whether `periodic` is larger, root mean square in the recording that has most of it, than `matters_n`.
pub(crate) fn matters(periodic: &Periodic, matters_n: f64) -> bool {
    periodic.amplitude_n > std::f64::consts::SQRT_2 * matters_n
}

/// In a sentence.
pub(crate) fn words(periodic: &Periodic) -> String {
    let Periodic { frequency_hz, amplitude_n, n_recordings, n_looked_at } = periodic;
    format!(
        "at {frequency_hz:.1} Hz the force swings by up to {amplitude_n:.2} N to either side in {n_recordings} of {n_looked_at} recordings, \
         and neither pressure nor length does: a pump, a motor or the mains may do that, and with the muscle held still, switching them \
         off in turn tells which"
    )
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::periodic) const PERIOD_S: f64 = 0.005;

    /// A residual that swings with `amplitude_n` at `hz` for `lasts_s`, beside noise; the pressure does with `amplitude_pa`.
    pub(in crate::periodic) fn swinging(lasts_s: f64, hz: f64, amplitude_n: f64, amplitude_pa: f64) -> Trace {
        let time_s: Vec<f64> = (0..(lasts_s / PERIOD_S) as usize).map(|row| PERIOD_S * row as f64).collect();
        let mut state = (1000.0 * hz) as u64 + 7;
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        let swing = |time_s: &f64| (std::f64::consts::TAU * hz * time_s).sin();
        Trace {
            pressure_pa: time_s.iter().map(|t| 2e5 + 1e3 * t + amplitude_pa * swing(t) + 50.0 * noise()).collect(),
            length_m: time_s.iter().map(|_| 0.25 + 1e-5 * noise()).collect(),
            force_n: time_s.iter().map(|t| 100.0 + amplitude_n * swing(t) + 0.5 * noise()).collect(),
            model_n: vec![100.0; time_s.len()],
            direction: vec![1.0; time_s.len()],
            settled: vec![true; time_s.len()],
            time_s,
        }
    }

    #[test]
    fn what_swings_at_one_frequency_in_most_recordings_is_found_with_its_amplitude() {
        let traces = [swinging(30.0, 3.5, 2.0, 0.0), swinging(20.0, 3.5, 1.0, 0.0), swinging(20.0, 9.0, 0.0, 0.0)];
        let found = periodic(&traces).expect("a line");
        assert!((found.frequency_hz - 3.5).abs() < 0.051 && (found.amplitude_n - 2.0).abs() < 0.1, "{found:?}");
        assert_eq!((found.n_recordings, found.n_looked_at), (2, 3));
        assert!(matters(&found, 1.0) && !matters(&found, 1.6));
        assert!(words(&found).starts_with("at 3.5 Hz the force swings by up to 1.97 N"), "{}", words(&found));
    }

    #[test]
    fn a_frequency_between_two_of_the_spectrum_is_one_line() {
        let traces = [3.43, 3.45, 3.47].map(|hz| swinging(30.0, hz, 2.0, 0.0));
        assert_eq!(periodic(&traces).expect("a line").n_recordings, 3);
    }

    #[test]
    fn noise_other_frequencies_one_recording_or_a_pressure_that_swings_are_no_line() {
        let none = |traces: &[Trace]| assert_eq!(periodic(traces), None);
        none(&[2.0, 3.0, 4.0, 5.0].map(|hz| swinging(30.0, hz, 0.0, 0.0)));
        none(&[2.0, 3.0, 4.0, 5.0].map(|hz| swinging(30.0, hz, 2.0, 0.0)));
        none(&[swinging(30.0, 3.5, 2.0, 0.0)]);
        none(&[3.5, 3.5, 3.5].map(|hz| swinging(30.0, hz, 2.0, 1e3)));
        none(&[]);
    }
}
