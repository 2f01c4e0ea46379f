//! What is to be believed of a search.

use pam_artifact::diagnosis::Verdict;

use crate::search::{Found, Limits, Taken};

/// Sizes that the verdict rests on, root mean square over held-out blocks, in N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    /// What noise leaves of any model at the full rate.
    pub floor_n: f64,
    /// What the base model leaves beyond what any model leaves.
    pub mismatch_n: f64,
    /// What base and effects leave beyond what smooth functions on top of them leave.
    pub left_n: f64,
    /// Beyond which a mismatch matters.
    pub matters_n: f64,
    /// Share of the base model's residual (mean squares) that is structured.
    pub structured_share: f64,
    /// What no model gets below, mean square in N².
    pub floor_square: f64,
    /// What the best hypothesis leaves.
    pub best_n: f64,
    /// What the noise of the sensors alone leaves.
    pub sensors_n: f64,
    /// What a smooth static map takes of the base model's residual, where that is more than it takes of any muscle's.
    pub static_n: Option<f64>,
    /// Whether the user said what matters.
    pub limited: bool,
}

/// Times the sensors' noise that may be left of a model that lacks nothing: a smooth static map follows no muscle better.
const CONSISTENT_WITHIN: f64 = 2.5;
/// Share of the mismatch (mean squares) that may be left of an explanation.
const MOST_LEFT: f64 = 0.3;
/// The same of what matters by itself: less is what the form of an effect that is otherwise right leaves of it.
const LEAST_LEFT: f64 = 0.08;
/// The same beyond which what explains the rest is no explanation: twice as much is left.
const MOST: f64 = 2.0 / 3.0;
/// The same for an effect that the catalogue says it is confused with.
pub(crate) const DECLARED_RIVAL: f64 = 0.6;
/// A rival that reaches this share of the evidence cannot be told from what was named.
pub(crate) const RIVAL: f64 = 0.85;

impl Sizes {
    /// Of a search under its limits.
    pub fn of(found: &Found, limits: &Limits) -> Self {
        let floor_n = (found.floor_square + limits.sensor_floor_n.powi(2)).sqrt();
        let excess = |square: f64, below: f64| (square - below).max(0.0).sqrt();
        let best = found.best.held_out.mean_square();
        let left_n = found.left.as_ref().map_or(0.0, |left| excess(best, left.held_out.mean_square()));
        let base = found.before().mean_square();
        Self {
            structured_share: (excess(base, found.floor_square).powi(2) / base.max(f64::MIN_POSITIVE)).min(1.0),
            floor_square: found.floor_square,
            best_n: best.sqrt(),
            sensors_n: limits.sensor_floor_n,
            static_n: beyond_form(found),
            limited: limits.matters_above_n.is_some(),
            floor_n,
            mismatch_n: excess(base, found.floor_square),
            left_n,
            // The root mean square is then half as much again as the noise alone.
            matters_n: limits.matters_above_n.unwrap_or(floor_n * (1.5_f64.powi(2) - 1.0).sqrt()),
        }
    }

    /// The same where so much, root mean square, was explained besides.
    pub fn with(self, explained_n: f64) -> Self {
        Self { mismatch_n: self.mismatch_n.hypot(explained_n), ..self }
    }

    /// Beyond which what is none of the muscle's matters, in N: the user's limit, or what the noise of the sensors leaves.
    pub(crate) fn beyond_noise_n(&self) -> f64 {
        if self.limited { self.matters_n } else { self.sensors_n }
    }

    /// Share of the mismatch that the best hypothesis leaves, in mean squares, by what any model leaves.
    pub fn share_unexplained(&self) -> f64 {
        let excess = |rmse_n: f64| rmse_n.powi(2) - self.floor_square;
        if self.mismatch_n > 0.0 { (excess(self.best_n) / self.mismatch_n.powi(2)).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Whether far more of the mismatch is left than was explained.
    pub fn most_is_left(&self) -> bool {
        self.share_left() > MOST
    }

    /// Share of the mismatch that is left, in mean squares.
    pub fn share_left(&self) -> f64 {
        if self.mismatch_n > 0.0 { (self.left_n / self.mismatch_n).powi(2).min(1.0) } else { 0.0 }
    }
}

/// What the static map of `found` takes of the base model's residual, in N, where no form of eq. 11 accounts for that much.
fn beyond_form(found: &Found) -> Option<f64> {
    let square = found.base.held_out.mean_square() - found.whole.held_out.mean_square();
    (square > found.form_square).then(|| square.sqrt())
}

/// The verdict, for what the search found; `besides` says whether something was named besides that.
pub fn verdict(found: &Found, sizes: &Sizes, besides: bool) -> Verdict {
    let more_than = |times: f64, share: f64| sizes.left_n > times * sizes.matters_n && sizes.share_left() > share;
    let structured = more_than(0.5, MOST_LEFT) || more_than(1.0, LEAST_LEFT);
    if found.best.state.guesses.is_empty() && !besides {
        let beyond_sensors = !sizes.limited && sizes.best_n > CONSISTENT_WITHIN * sizes.sensors_n;
        let is_missing = sizes.mismatch_n > sizes.matters_n || beyond_sensors || sizes.static_n.is_some();
        // What called up a name that is none is there.
        let is_missing = is_missing
            || !found.nameless.is_empty()
            || found.as_well.iter().any(|(_, other)| other.is_missing)
            || [&found.stand_ins, &found.unheard_of, &found.outdone, &found.replaced]
                .iter()
                .any(|let_go_of| !let_go_of.is_empty());
        return if is_missing { Verdict::Unexplained } else { Verdict::Consistent };
    }
    if structured {
        Verdict::Unexplained
    } else if found.taken.iter().enumerate().any(|(index, _)| !alternatives(found, index).is_empty()) {
        Verdict::Ambiguous
    } else {
        Verdict::Explained
    }
}

/// Ids of the effects that cannot be told from effect `index`.
pub fn alternatives(found: &Found, index: usize) -> Vec<&'static str> {
    let Some(Taken { without, with, rivals, .. }) = found.taken.get(index) else { return Vec::new() };
    let own = without.log_ratio(with);
    let gained = without.mean_square() - with.mean_square();
    rivals
        .iter()
        .filter(|rival| rival.guess.id() != found.best.state.guesses[index].id())
        .filter(|rival| {
            let page = found.best.state.guesses[index].effect.page();
            let declared = page.confusion_with(rival.guess.id()).is_some();
            let share = if declared { DECLARED_RIVAL } else { RIVAL };
            rival.log_ratio > share * own && without.mean_square() - rival.held_out.mean_square() > share * gained
        })
        .map(|rival| rival.guess.id())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;
    use crate::search::search;
    use crate::state::Setting;

    /// The verdict where the base lacks a smooth static force of `size_n` at most.
    fn verdict_of(size_n: f64) -> Verdict {
        let mut given = Given::of(&["isobaric-triangles", "isometric-ramps", "multisine"], &[]);
        given.disturb();
        given.bend(size_n);
        let limits = Limits::of_test(0, 0.3);
        let setting = Setting { floor_square: 0.09, ..given.setting() };
        let found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
        verdict(&found, &Sizes::of(&found, &limits), false)
    }

    #[test]
    fn a_smooth_static_force_is_the_form_of_a_muscle_until_no_muscle_has_so_much() {
        assert_eq!(verdict_of(6.0), Verdict::Consistent);
        assert_eq!(verdict_of(200.0), Verdict::Unexplained);
    }
}

#[cfg(test)]
pub(crate) mod cases;

#[cfg(test)]
mod edges;
