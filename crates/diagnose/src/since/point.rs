//! The model and the channels as numbers that move, and the force that they give.

use pam_muscle::Muscle;
use pam_muscle::effects::{AugmentedModel, Term};
use pam_muscle::force::{BaseParameters, ForceModel, Form};
use pam_muscle::motion::Instant;
use pam_muscle::shift::shift;
use rayon::prelude::*;

use super::quantity::Channel;
use crate::track::Track;

/// A model, and what the channels read of what there is: `read = (1 + gain) · true + zero`.
#[derive(Debug, Clone)]
pub(crate) struct Point {
    muscle: Muscle,
    strand_modulus_pa: f64,
    form: Form,
    /// Parameters of eq. 11.
    pub theta: BaseParameters,
    /// Effects.
    pub terms: Vec<Term>,
    /// Which of them are there; the others are kept in their places.
    pub present: Vec<bool>,
    /// Zeros and gains, in the order of [`Channel::ALL`].
    pub channels: [f64; Channel::ALL.len()],
}

impl Point {
    /// `model`, with channels that read what there is.
    pub(crate) fn of(model: &AugmentedModel) -> Self {
        let base = model.base();
        Self {
            muscle: base.muscle().clone(),
            strand_modulus_pa: base.strand_modulus_pa(),
            form: base.form(),
            theta: *base.parameters(),
            terms: model.terms().to_vec(),
            present: vec![true; model.terms().len()],
            channels: [0.0; Channel::ALL.len()],
        }
    }

    /// The model, without what the channels do.
    pub(crate) fn model(&self) -> AugmentedModel {
        let base = ForceModel::new(&self.muscle, self.strand_modulus_pa, self.form, self.theta);
        let present = self.terms.iter().zip(&self.present).filter(|(_, present)| **present);
        AugmentedModel::new(base, present.map(|(term, _)| term.clone()).collect())
    }

    /// The same without effect `term`.
    #[must_use]
    pub(crate) fn without(mut self, term: usize) -> Self {
        self.present[term] = false;
        self
    }

    /// The same with another effect.
    #[must_use]
    pub(crate) fn with(mut self, term: Term) -> Self {
        self.terms.push(term);
        self.present.push(true);
        self
    }

    /// What effect `term` leaves of having gone through each recording once before, in N.
    pub(crate) fn brought_by_n(&self, term: usize, track: &Track) -> Vec<f64> {
        let [with_n, without_n] = [self.clone(), self.clone().without(term)].map(|point| point.brought_n(track));
        with_n.iter().zip(&without_n).map(|(with, without)| with - without).collect()
    }

    /// Modulus that the contact between strands is computed with, in Pa.
    pub(crate) fn strand_modulus_pa(&self) -> f64 {
        self.strand_modulus_pa
    }

    fn channel(&self, channel: Channel) -> f64 {
        self.channels[channel.index()]
    }

    /// The instants as they would be without zeros and gains of pressure and length.
    fn corrected(&self, instants: &[Instant]) -> Vec<Instant> {
        let (zero_pa, gain) = (self.channel(Channel::PressureZero), 1.0 + self.channel(Channel::PressureGain));
        let zero_m = self.channel(Channel::LengthZero);
        let mut out = instants.to_vec();
        if zero_pa != 0.0 || gain != 1.0 || zero_m != 0.0 {
            for Instant { moment, .. } in &mut out {
                moment.pressure_pa = (moment.pressure_pa - zero_pa) / gain;
                moment.pressure_rate_pa_per_s /= gain;
                moment.length_m -= zero_m;
                moment.contraction_ratio += zero_m / self.muscle.rest_length_m;
            }
        }
        out
    }

    /// Force that the load cell reads at every instant of `track`, in N.
    pub(crate) fn force_n(&self, track: &Track) -> Vec<f64> {
        let passes = self.passes(track, 1);
        passes.into_iter().map(|[once]| once).collect()
    }

    /// The same where every recording had gone before itself, less that: what a lasting memory brings with it.
    fn brought_n(&self, track: &Track) -> Vec<f64> {
        self.passes::<2>(track, 2).into_iter().map(|[first, second]| second - first).collect()
    }

    fn passes<const N: usize>(&self, track: &Track, n: usize) -> Vec<[f64; N]> {
        let model = self.model();
        let (gain, zero_n) = (1.0 + self.channel(Channel::ForceGain), self.channel(Channel::ForceZero));
        let delays_s = model.delays_s();
        let of_recording = |range: &std::ops::Range<usize>| {
            let instants = self.corrected(&track.instants[range.clone()]);
            let mut moments: Vec<_> = instants.iter().map(|instant| instant.moment).collect();
            shift(&mut moments, &instants, delays_s);
            let mut memory = model.start();
            let mut rows = vec![[0.0; N]; moments.len()];
            for pass in 0..n {
                for (row, &now) in rows.iter_mut().zip(&moments) {
                    row[pass] = gain * memory.force_n(&model, now) + zero_n;
                }
            }
            rows
        };
        let parts: Vec<Vec<[f64; N]>> = track.recordings.par_iter().map(of_recording).collect();
        parts.concat()
    }
}
