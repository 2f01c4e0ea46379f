//! A sentence fitted together with the base and everything that was named, as a model will carry it.

use pam_core::effects::Sentence;
use pam_core::effects::sentence::{Curve, Scale, own};

use super::field::Field;
use crate::hypothesis::{Guess, Sign};
use crate::search::{Judged, judged};
use crate::state::Setting;

/// Share of the height of a curve by which it may go back and still be taken for one that never does.
const GOES_BACK: f64 = 0.05;

/// `best` with `sentence`; a curve that never goes back nearly becomes one that does not, where that foretells held-out blocks as
/// well.
pub(super) fn joined(setting: &Setting<'_>, field: &Field<'_>, best: &Judged, sentence: &Sentence) -> Option<Judged> {
    let arguments = field.arguments(sentence);
    let values = field.amplitudes(&field.products(&arguments, sentence.scale, &sentence.shape)?)?;
    let plain = with(setting, best, &anchored(sentence, &values), Sign::Any)?;
    let steady = steady(sentence, &values).and_then(|(sentence, sign)| with(setting, best, &sentence, sign));
    Some(match steady {
        Some(steady) if steady.held_out.mean_square() <= plain.held_out.mean_square() => steady,
        _ => plain,
    })
}

fn with(setting: &Setting<'_>, best: &Judged, sentence: &Sentence, sign: Sign) -> Option<Judged> {
    let guess = Guess { effect: own(sentence).ok()?, shape: Vec::new(), sign, carried: false };
    let mut guesses = best.state.guesses.clone();
    guesses.push(guess);
    judged(setting, setting.fit_near(guesses, &best.state)?)
}

/// `sentence` with its spline zero where its `values` are nearest to it, if a parameter of eq. 11 takes what is the same
/// everywhere: the two could not be told apart.
fn anchored(sentence: &Sentence, values: &[f64]) -> Sentence {
    let absorbed = matches!(sentence.scale, Scale::One | Scale::GasForce | Scale::BladderForce | Scale::Friction);
    let Curve::Spline { knots, zero_at: None } = &sentence.shape else { return sentence.clone() };
    let least = (0..values.len()).min_by(|left, right| values[*left].abs().total_cmp(&values[*right].abs()));
    let shape = Curve::Spline { knots: knots.clone(), zero_at: least.filter(|_| absorbed) };
    Sentence { shape, ..sentence.clone() }
}

/// `sentence` with a curve that never goes back, where its `values` hardly do.
fn steady(sentence: &Sentence, values: &[f64]) -> Option<(Sentence, Sign)> {
    let Curve::Spline { knots, .. } = &sentence.shape else { return None };
    let (up, down) = values.windows(2).fold((0.0, 0.0), |(up, down), pair| {
        let step = pair[1] - pair[0];
        (up + f64::max(step, 0.0), down + f64::max(-step, 0.0))
    });
    if f64::min(up, down) > GOES_BACK * f64::max(up, down) {
        return None;
    }
    let sign = if up > down { Sign::Positive } else { Sign::Negative };
    Some((Sentence { shape: Curve::Monotone { knots: knots.clone() }, ..sentence.clone() }, sign))
}
