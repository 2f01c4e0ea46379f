//! What is concealed: kinds in their proportions, every effect of the catalogue equally often, all else at random.

use std::collections::BTreeSet;

use anyhow::{Result, bail};
use pam_muscle::MuscleFile;
use rand::seq::SliceRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Dxsm;

use crate::calibrate::Calibration;
use crate::case::{Case, Concealed, Kind, Log, NAMELESS, catalogue};
use crate::rig::{Hidden, Rig, hidden_of};
use crate::sets::{HOLDOUT_SAMPLES, SETS, Set};

/// What a refit of eq. 11 leaves of each effect, over the noise floor.
const OVER_FLOOR: (f64, f64) = (1.5, 5.0);

/// Most that a refit may leave of a muscle with nothing concealed, over the noise floor: above it the direction of motion
/// could not be told from the length, and nothing would not be nothing.
const NOTHING_LEAVES: f64 = 0.35;

/// Draws after which an effect is given up.
const MOST_REDRAWS: u32 = 60;

/// Share of the nameless that have an effect of the catalogue beside them.
const NAMELESS_BESIDE: f64 = 0.25;

/// Share of the cases whose rig lets the muscle hang slack.
const HANGS: f64 = 0.3;

/// Lowest tension of a rig that keeps the muscle taut, and of one that does not, in N.
const TAUT_N: f64 = 5.0;
const SLACKEST_N: f64 = -40.0;

/// Letters of names: no vowels, so that no name means anything.
const LETTERS: &[u8] = b"bcdfghjklmnpqrstvwxz";

/// What a case is to be, before anything about it is drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// Place in the order of cases, which seeds it.
    pub index: u64,
    /// What sort of case.
    pub kind: Kind,
    /// The effect, for singles and nameless ones.
    pub id: Option<&'static str>,
    /// Colored noise and a smooth misfit.
    pub colored: bool,
}

/// Plans `count` cases in random order; half of each kind with colored noise.
pub fn plan(count: usize, seed: u64) -> Vec<Plan> {
    let mut random = Pcg64Dxsm::seed_from_u64(seed);
    let mut plans = Vec::new();
    let mut catalogue = catalogue();
    catalogue.shuffle(&mut random);
    for (kind, n) in counts(count) {
        let offset = usize::from(random.random::<bool>());
        for position in 0..n {
            let id = match kind {
                Kind::Single => Some(catalogue[position % catalogue.len()]),
                Kind::Nameless => Some(NAMELESS[position % NAMELESS.len()]),
                _ => None,
            };
            // An effect that comes again comes with the other noise.
            let round = match kind {
                Kind::Single => position + position / catalogue.len(),
                Kind::Nameless => position / NAMELESS.len(),
                _ => position,
            };
            plans.push(Plan { index: 0, kind, id, colored: (round + offset) % 2 == 0 });
        }
    }
    plans.shuffle(&mut random);
    for (index, plan) in plans.iter_mut().enumerate() {
        plan.index = index as u64;
    }
    plans
}

/// Cases of each kind: shares of `count`, largest remainders rounded up.
fn counts(count: usize) -> Vec<(Kind, usize)> {
    let mut counts = Kind::SHARES.map(|(kind, share)| (kind, (share * count as f64) as usize));
    let mut order: Vec<usize> = (0..counts.len()).collect();
    order.sort_by(|&a, &b| {
        let rest = |index: usize| (Kind::SHARES[index].1 * count as f64).fract();
        rest(b).total_cmp(&rest(a))
    });
    let left = count - counts.iter().map(|(_, n)| n).sum::<usize>();
    for &index in order.iter().cycle().take(left) {
        counts[index].1 += 1;
    }
    counts.to_vec()
}

/// Draws and calibrates the case of a plan.
///
/// # Errors
/// Where the effect cannot be made as strong as drawn in any of many draws.
pub fn case(plan: &Plan, seed: u64) -> Result<Case> {
    let mut random =
        Pcg64Dxsm::new(u128::from(seed) << 64 | u128::from(seed ^ 0x9e37_79b9), u128::from(plan.index) + 1);
    let name = letters(&mut random, 8);
    for redraws in 0..=MOST_REDRAWS {
        let ids = ids(plan, &mut random);
        if let Some(case) = attempt(plan, &ids, &name, redraws, &mut random)? {
            return Ok(case);
        }
    }
    bail!("{:?} cannot be concealed as drawn: {MOST_REDRAWS} draws failed", plan)
}

/// Effects to conceal.
fn ids(plan: &Plan, random: &mut Pcg64Dxsm) -> Vec<&'static str> {
    let mut others = catalogue();
    others.shuffle(random);
    match plan.kind {
        Kind::Nothing => Vec::new(),
        Kind::Single => plan.id.into_iter().collect(),
        Kind::Pair => others[..2].to_vec(),
        Kind::Triple => others[..3].to_vec(),
        Kind::Nameless => {
            let beside = (random.random::<f64>() < NAMELESS_BESIDE).then_some(others[0]);
            plan.id.into_iter().chain(beside).collect()
        }
    }
}

/// One draw of everything else; none where it has to be drawn again.
fn attempt(plan: &Plan, ids: &[&str], name: &str, redraws: u32, random: &mut Pcg64Dxsm) -> Result<Option<Case>> {
    let (muscle_seed, effect_seed): (u64, u64) = (random.random(), random.random());
    let lowest_tension_n = if random.random::<f64>() < HANGS { SLACKEST_N } else { TAUT_N };
    let rig = Rig::new(muscle_seed, lowest_tension_n);
    let set = SETS[random.random_range(0..SETS.len())];
    let Some((estimation, holdout)) = logs(&rig, &set, random) else { return Ok(None) };
    let muscle = MuscleFile::parse(&rig.muscle_file(), "muscle.toml".as_ref())?;
    let white_factor = 0.5 * 4.0_f64.powf(random.random());
    let calibration = Calibration { rig: &rig, muscle: &muscle, logs: &estimation, white_factor };
    let nothing = calibration.refit(&Hidden::NOTHING)?;
    let nothing_leaves_n = nothing.estimation_fit.together.map_or(0.0, |fitted| fitted.rmse_n);
    let noise = calibration.noise(&nothing.model, plan.colored)?;
    if nothing_leaves_n > NOTHING_LEAVES * noise.floor_n {
        return Ok(None);
    }
    let mut concealed = Vec::new();
    for id in ids {
        let drawn_over_floor = OVER_FLOOR.0 * (OVER_FLOOR.1 / OVER_FLOOR.0).powf(random.random());
        let Some((severity, left_n)) = calibration.severity(id, effect_seed, drawn_over_floor * noise.floor_n)? else {
            return Ok(None);
        };
        concealed.push(Concealed {
            id: (*id).to_owned(),
            severity,
            drawn_over_floor,
            over_floor: left_n / noise.floor_n,
            place: None,
        });
    }
    let mut case = Case {
        name: name.to_owned(),
        kind: plan.kind,
        muscle_seed,
        effect_seed,
        set: set.name.to_owned(),
        lowest_tension_n,
        concealed,
        noise,
        nothing_leaves_n,
        together_leave_n: nothing_leaves_n,
        estimation: estimation.clone(),
        holdout,
        redraws,
    };
    if !ids.is_empty() {
        let effects = hidden_of(&case);
        let hidden = Hidden { effects: &effects, seed: effect_seed, misfit_n: 0.0 };
        let eventful = estimation.iter().find(|log| log.eventful).unwrap_or(&estimation[0]);
        let places = rig.places(eventful, &hidden)?;
        let Ok(together_n) = calibration.leaves_n(&hidden) else { return Ok(None) };
        // Effects that cancel conceal nothing.
        if together_n < OVER_FLOOR.0 * noise.floor_n * 0.95 {
            return Ok(None);
        }
        case.together_leave_n = together_n;
        for (effect, place) in case.concealed.iter_mut().zip(places) {
            effect.place = place;
        }
    }
    Ok(Some(case))
}

/// Recordings of a set in random order, all fitted ones about equally long, and two held out; none where this muscle cannot
/// be taken through one of them.
fn logs(rig: &Rig, set: &Set, random: &mut Pcg64Dxsm) -> Option<(Vec<Log>, Vec<Log>)> {
    let mut files = BTreeSet::new();
    let mut log = |protocol: &str, samples: f64, random: &mut Pcg64Dxsm| {
        let mut file = letters(random, 6);
        while !files.insert(file.clone()) {
            file = letters(random, 6);
        }
        let duration_scale = scale(rig, protocol, samples)?;
        Some(Log {
            file: format!("{file}.csv"),
            protocol: protocol.to_owned(),
            duration_scale,
            seed: random.random(),
            eventful: false,
        })
    };
    let mut protocols = set.estimation.to_vec();
    protocols.shuffle(random);
    let estimation: Option<Vec<Log>> =
        protocols.iter().map(|protocol| log(protocol, set.samples(protocol), random)).collect();
    let mut estimation = estimation?;
    let eventful = random.random_range(0..estimation.len());
    estimation[eventful].eventful = true;
    let second = set.holdout[random.random_range(0..set.holdout.len())];
    let mut held = ["multisine", second];
    held.shuffle(random);
    let holdout: Option<Vec<Log>> = held.iter().map(|protocol| log(protocol, HOLDOUT_SAMPLES, random)).collect();
    Some((estimation, holdout?))
}

/// Duration scale at which a protocol has about `samples` samples.
fn scale(rig: &Rig, protocol: &str, samples: f64) -> Option<f64> {
    let (mut low, mut high) = (0.01, 3.0);
    for _ in 0..24 {
        let middle = f64::sqrt(low * high);
        if rig.samples(protocol, middle).ok()? < samples { low = middle } else { high = middle }
    }
    Some((low * 1e4).round() / 1e4)
}

fn letters(random: &mut Pcg64Dxsm, count: usize) -> String {
    (0..count).map(|_| char::from(LETTERS[random.random_range(0..LETTERS.len())])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_keep_their_proportions() {
        let of = |count| counts(count).into_iter().map(|(_, n)| n).collect::<Vec<_>>();
        assert_eq!(of(400), [176, 80, 64, 40, 40]);
        assert_eq!(of(24).iter().sum::<usize>(), 24);
        assert!(of(24).iter().all(|n| *n >= 2));
    }

    #[test]
    fn every_effect_comes_equally_often_and_with_either_noise() {
        let plans = plan(400, 7);
        for id in catalogue() {
            let of: Vec<_> = plans.iter().filter(|plan| plan.kind == Kind::Single && plan.id == Some(id)).collect();
            let each = plans.iter().filter(|plan| plan.kind == Kind::Single).count() / catalogue().len();
            assert!((each..=each + 1).contains(&of.len()), "{id}");
            assert!(of.iter().filter(|plan| plan.colored).count().abs_diff(of.len() / 2) <= 1, "{id}");
        }
        for kind in [Kind::Nothing, Kind::Nameless] {
            let of: Vec<_> = plans.iter().filter(|plan| plan.kind == kind).collect();
            assert_eq!(2 * of.iter().filter(|plan| plan.colored).count(), of.len());
        }
    }

    #[test]
    fn a_case_is_drawn_from_seed_and_index_alone() {
        let plan = Plan { index: 3, kind: Kind::Nothing, id: None, colored: true };
        let drawn = case(&plan, 5).unwrap();
        assert_eq!(drawn, case(&plan, 5).unwrap());
        assert_ne!(drawn, case(&plan, 6).unwrap());
        assert!(drawn.nothing_leaves_n <= NOTHING_LEAVES * drawn.noise.floor_n, "{drawn:?}");
    }
}
