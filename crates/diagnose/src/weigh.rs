//! What a diagnosis is worth at the full rate of the recordings: the verdict in words and numbers, and what held-out recordings say of
//! it.

use pam_artifact::diagnosis::{EmpiricalGain, Verdict};
use pam_identification::evaluate::Evaluation;

use crate::artifact::{Agreement, together};
use crate::diagnose::Diagnosis;
use crate::discover;
use crate::error::DiagnoseError;
use crate::held_error::WORSE;
use crate::nuisance::{ENDS_ID, MAP_ID};
use crate::typical::FOLLOWED_WITHIN;
use crate::{held, periodic, words};

/// Times the sensors' noise that may be left of what is called explained.
const EXPLAINED_WITHIN: f64 = 1.5;

impl Diagnosis {
    /// Says the verdict in words and numbers, and lowers what is called explained to explained in part where, over all samples,
    /// more is left than half as much again as the sensors leave, or where what was held out is followed worse with a name than
    /// without, and says so. The model as given and what was held out decide, too: where either is missed, nothing is consistent or
    /// explained, and that is said first.
    ///
    /// # Errors
    /// [`DiagnoseError::Recording`] where samples cannot be read back.
    pub fn weigh(&mut self, agreement: &Agreement) -> Result<(), DiagnoseError> {
        if self.is_followed(agreement) {
            self.verdict = Verdict::Consistent;
            (self.regions, self.unexplained) = (Vec::new(), Vec::new());
        }
        let numbers = self.numbers(agreement);
        self.unexplained_share = numbers.share_unexplained(&self.effects);
        self.statement = words::statement(self.verdict, &self.effects, &numbers, &self.regions, &self.unexplained);
        if self.verdict == Verdict::Consistent {
            self.statement += self.tares.words().as_deref().unwrap_or_default();
        }
        self.statement += &words::nameless(&self.nameless);
        self.statement += &words::as_well(&self.as_well);
        if let Some(empirical) = &mut self.empirical {
            let held = agreement.holdout_without_terms.as_ref().zip(agreement.holdout.together.as_ref());
            empirical.holdout =
                held.map(|(without, with)| EmpiricalGain { rmse_without_n: without.rmse_n, rmse_with_n: with.rmse_n });
            self.statement += &discover::statement(empirical, !self.effects.is_empty(), numbers.with_map);
        } else if self.verdict == Verdict::Unexplained && self.effects.is_empty() && numbers.with_map {
            let held = agreement.base_holdout.together.zip(agreement.holdout.together);
            let held = held.map(|(base, written)| (base.rmse_n, written.rmse_n));
            self.statement += &words::of_map(held, (numbers.before_n, numbers.after_n));
        }
        self.tell_periodic();
        let left_n = together(&agreement.estimation).rmse_all_n;
        let sensors_n = self.sizes.sensors_n;
        if self.verdict == Verdict::Explained && left_n > EXPLAINED_WITHIN * sensors_n {
            self.verdict = Verdict::ExplainedInPart;
            self.statement.push_str(&format!(
                " Over all samples, reversals included, {left_n:.2} N are left, where noise leaves {:.2} N.",
                numbers.floor_n
            ));
        }
        if let Some(kept) = &self.kept_to_fitted {
            if self.verdict == Verdict::Explained && self.effects.iter().any(|named| kept.has(&named.id)) {
                self.verdict = Verdict::ExplainedInPart;
            }
            let held = agreement.holdout_everywhere.as_ref().zip(agreement.holdout.together.as_ref());
            if let Some((with, without)) = held {
                self.statement += &kept.statement(with.rmse_all_n, without.rmse_all_n);
            }
        }
        if let Some((before_n, after_n)) = self.raised(agreement) {
            if self.verdict == Verdict::Explained {
                self.verdict = Verdict::ExplainedInPart;
            }
            self.statement.push_str(&format!(
                " With that, held-out recordings are followed worse: over all samples their RMSE rises from {before_n:.2} to {after_n:.2} N. \
                 The finding rests on the fitted recordings alone."
            ));
        }
        let held::Held { missed, noticed, unjudged, followed } = held::judge(self, agreement)?;
        self.given.holdout_missed = missed;
        self.noticed.extend(noticed);
        if self.given.misses || !self.given.holdout_missed.is_empty() {
            self.verdict = match self.verdict {
                Verdict::Consistent | Verdict::Unexplained => Verdict::Unexplained,
                Verdict::Explained | Verdict::ExplainedInPart | Verdict::Ambiguous => Verdict::ExplainedInPart,
            };
        }
        if let Some(pooled) = &self.pooled
            && self.verdict == Verdict::Consistent
        {
            self.statement += &pooled.statement(&followed);
        }
        self.statement = words::with_given(&self.given, &self.statement);
        if !unjudged.is_empty() {
            let missed = unjudged.join("; ");
            self.statement.push_str(&format!(" Held out, {missed}: that judges the extrapolation, not the model."));
        }
        Ok(())
    }

    /// Whether the force does something at one frequency that matters.
    fn swings(&self) -> bool {
        self.periodic.is_some_and(|periodic| periodic::matters(&periodic, self.sizes.beyond_noise_n()))
    }

    /// Says what the force does at one frequency: where it matters beside the verdict, which is then explained in part at most, otherwise
    /// beside what was noticed.
    fn tell_periodic(&mut self) {
        let Some(periodic) = &self.periodic else { return };
        let words = periodic::words(periodic);
        if self.swings() {
            if self.verdict == Verdict::Explained {
                self.verdict = Verdict::ExplainedInPart;
            }
            self.statement += &format!(" Besides, {words}.");
        } else {
            self.noticed.push(words);
        }
    }

    /// Whether recordings that nothing was fitted to are followed so well, over all samples, that what is left of the fitted ones
    /// without a name, and without a term that models it, does not matter. A smooth static map belongs to any muscle's model, as far
    /// as the form of eq. 11 accounts for it. A fitted recording that is missed by far matters all the same: hold-outs do not show
    /// what is wrong with it.
    fn is_followed(&self, agreement: &Agreement) -> bool {
        let as_written = self.sizes.static_n.is_none().then_some(&agreement.holdout);
        let held = as_written.unwrap_or(&agreement.base_holdout).together.as_ref();
        self.verdict == Verdict::Unexplained
            && !self.typically_misses
            && !self.swings()
            && self.effects.is_empty()
            && self.nameless.is_empty()
            && self.as_well.iter().all(|(_, other)| !other.is_missing)
            && self.empirical.is_none()
            && held.is_some_and(|held| held.rmse_all_n <= FOLLOWED_WITHIN * agreement.noise_floor_n)
            && agreement.estimation.each.iter().all(|fitted| fitted.rmse_n <= held::FAR * agreement.noise_floor_n)
    }

    /// What the base model alone and what is written leave of what was held out, over all samples, in N, where something is named and
    /// leaves more there.
    pub(crate) fn raised(&self, agreement: &Agreement) -> Option<(f64, f64)> {
        let left_n = |held: &Evaluation| held.together.as_ref().map(|held| held.rmse_all_n);
        let (before_n, after_n) = (left_n(&agreement.base_holdout)?, left_n(&agreement.holdout)?);
        (!self.effects.is_empty() && after_n > WORSE * before_n).then_some((before_n, after_n))
    }

    /// Whether the augmented model has a smooth static map, be it that of the ends alone.
    pub(crate) fn has_map(&self) -> bool {
        self.entries.iter().any(|entry| [MAP_ID, ENDS_ID].contains(&entry.id.as_str()))
    }

    /// What the verdict says in numbers.
    fn numbers(&self, agreement: &Agreement) -> words::Numbers {
        words::Numbers {
            before_n: together(&agreement.base_estimation).rmse_n,
            after_n: together(&agreement.estimation).rmse_n,
            floor_n: agreement.noise_floor_n,
            matters_n: self.sizes.matters_n,
            static_n: self.sizes.static_n,
            held_n: agreement.base_holdout.together.as_ref().map(|held| held.rmse_n),
            with_map: self.has_map(),
            n_terms: self.empirical.as_ref().map_or(0, |empirical| empirical.terms.len()),
        }
    }
}

#[cfg(test)]
mod tests;
