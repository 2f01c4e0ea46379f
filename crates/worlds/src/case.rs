//! A case: a world, what is concealed in it, and how large that is beside the sensors.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::catalogue::{Form, Half, ids, named, nameless};
use crate::draw::Dice;
use crate::forms::Built;
use crate::lumped::LumpedMuscle;
use crate::place::Place;
use crate::sensors::Log;
use crate::severity::cylinder_misfit_n;
use crate::stage::Stage;
use crate::world::{Attributes, Bench, Demands, Unmade, World};

/// Kind of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CaseKind {
    /// Nothing is concealed.
    Nothing,
    /// One effect of the catalogue.
    One,
    /// Two of them.
    Two,
    /// One that no catalogue has.
    Nameless,
}

/// What to draw.
#[derive(Debug, Clone)]
pub struct Request {
    /// Seed of everything.
    pub seed: u64,
    /// Cases.
    pub cases: usize,
    /// Half of the forms.
    pub half: Half,
    /// Only this bench.
    pub bench: Option<Bench>,
    /// Only this kind.
    pub kind: Option<CaseKind>,
}

/// Least and most severity that is aimed at.
pub(crate) const SEVERITIES: (f64, f64) = (1.2, 20.0);

/// The truth of a case.
#[derive(Debug, Clone, Serialize)]
pub struct Truth {
    /// Name of the folder.
    pub case: String,
    /// Kind.
    pub kind: CaseKind,
    /// Catalogue ids, or `nameless:<kind>`.
    pub concealed: Vec<String>,
    /// Form of each.
    pub forms: Vec<&'static str>,
    /// Size of each beside the floor, after a generic static refit.
    pub severity_over_floor: Vec<f64>,
    /// Where in its published range each is, 0…1.
    pub severity_in_range: Vec<f64>,
    /// Parameters of each.
    pub parameters: Vec<BTreeMap<&'static str, f64>>,
    /// Where each lives, if in a region.
    pub place: Vec<Option<Place>>,
    /// Attributes of the world.
    pub world: Attributes,
    /// Sampling rate, Hz.
    pub rate_hz: f64,
    /// Duration of each recording, s, by name.
    pub duration_s: BTreeMap<String, f64>,
    /// Protocol of each recording.
    pub protocol: BTreeMap<String, crate::protocol::Kind>,
    /// What sensors add to the force, N rms: noise and bits of the load cell, and those of pressure and length through the slopes.
    pub floor_n: f64,
    /// What the best cylinder would leave of the force without the effect, N rms.
    pub cylinder_misfit_n: f64,
    /// Deviation of the tare from recording to recording, N.
    pub tare_n: f64,
    /// Least and most true force of the estimation recordings, N.
    pub force_range_n: (f64, f64),
    /// Worlds that were drawn and given up.
    pub redraws: usize,
    /// Of these, how many for which reason.
    pub redraws_by_reason: BTreeMap<Unmade, usize>,
    /// Effects, or nameless forms, that were given up for others, since no world showed them.
    pub given_up: Vec<&'static str>,
}

/// A case, ready to be written.
#[derive(Debug, Clone)]
pub struct Case {
    /// Truth.
    pub truth: Truth,
    /// World.
    pub world: World,
    /// Logs, estimation first.
    pub logs: Vec<Log>,
    /// Seed of the caliper.
    pub caliper_seed: u64,
}

/// Kinds of all cases: in proportion, in random order.
fn kinds(request: &Request) -> Vec<CaseKind> {
    let mut kinds: Vec<CaseKind> = (0..request.cases)
        .map(|index| {
            let share = (index as f64 + 0.5) / request.cases as f64;
            match share {
                low if low < 0.25 => CaseKind::Nothing,
                low if low < 0.70 => CaseKind::One,
                low if low < 0.85 => CaseKind::Two,
                _ => CaseKind::Nameless,
            }
        })
        .collect();
    Dice::new(request.seed, 11).shuffle(&mut kinds);
    request.kind.map_or(kinds, |kind| vec![kind; request.cases])
}

/// What an effect is given up as: its id, or its form if it has none.
fn label(form: &Form) -> &'static str {
    if form.id == "nameless" { form.form } else { form.id }
}

/// Effects of a case: the catalogue is gone through evenly, in an order of its own per seed. An effect that was given up is
/// replaced by any other.
fn concealed(
    request: &Request,
    kinds: &[CaseKind],
    index: usize,
    given_up: &[&'static str],
    dice: &mut Dice,
) -> Vec<&'static Form> {
    let before = kinds[..index].iter().filter(|kind| **kind == kinds[index]).count();
    let all = ids();
    let mut order: Vec<usize> = (0..all.len()).collect();
    Dice::new(request.seed, 100 + (before / all.len()) as u64).shuffle(&mut order);
    let of = |id: &str, dice: &mut Dice| -> &'static Form {
        let forms = named(id, request.half);
        forms[dice.between(0, forms.len() - 1)]
    };
    let first = |dice: &mut Dice| {
        let mut first = all[order[before % all.len()]];
        while given_up.contains(&first) {
            first = *dice.pick(&all);
        }
        first
    };
    match kinds[index] {
        CaseKind::Nothing => Vec::new(),
        CaseKind::One => {
            let first = first(dice);
            vec![of(first, dice)]
        }
        CaseKind::Two => {
            let first = first(dice);
            loop {
                let second = *dice.pick(&all);
                if second != first && !given_up.contains(&second) {
                    break vec![of(first, dice), of(second, dice)];
                }
            }
        }
        CaseKind::Nameless => {
            let forms = nameless(request.half);
            let mut form = forms[before % forms.len()];
            while given_up.contains(&form.form) {
                form = *dice.pick(&forms);
            }
            vec![form]
        }
    }
}

/// Share of samples that may pull less than a newton in worlds where the cable is to stay taut.
const SLACK_SHARE: f64 = 0.003;

fn slack_share(logs: &[Log]) -> f64 {
    let (mut slack, mut all) = (0usize, 0usize);
    for log in logs {
        slack += log.true_force_n.iter().filter(|force_n| **force_n < 1.0).count();
        all += log.true_force_n.len();
    }
    slack as f64 / all.max(1) as f64
}

/// Attempts after which other forms are drawn as well.
const ATTEMPTS: usize = 12;
/// Attempts after which an effect is given up for another.
const MOST_REDRAWS: usize = 40;
/// Steps of simulation after which it is given up as well: about a second. Counted, since a clock would draw other cases on
/// another computer. A third of it is left for every effect after the first.
const MOST_WORK: usize = 6_000_000;

/// Why no case came of a world, the form to blame if one is, and the steps simulated.
struct Failure {
    why: Unmade,
    blamed: Option<&'static Form>,
    work: usize,
}

impl Case {
    /// Draws case `index` of a request.
    pub fn draw(request: &Request, index: usize) -> Self {
        let kinds = kinds(request);
        let half = match request.half {
            Half::Choose => 1,
            Half::Report => 2,
            Half::Sealed => 3,
        };
        let mut by_reason: BTreeMap<Unmade, usize> = BTreeMap::new();
        let mut given_up: Vec<&'static str> = Vec::new();
        let mut forms: Vec<&'static Form> = Vec::new();
        let mut blamed: BTreeMap<&'static str, usize> = BTreeMap::new();
        let (mut tried, mut work) = (0, 0);
        // Streams of one case, before those of the next begin.
        for attempt in 0..1000 {
            let mut dice = Dice::new(request.seed, (half * 1_000_000 + index as u64) * 1000 + attempt);
            let most = if given_up.is_empty() { MOST_WORK } else { MOST_WORK / 3 };
            if !forms.is_empty() && (tried > MOST_REDRAWS || work > most) {
                let worst =
                    forms.iter().map(|form| label(form)).rev().max_by_key(|name| blamed.get(name).unwrap_or(&0));
                given_up.extend(worst);
                blamed.clear();
                (tried, work) = (0, 0);
            }
            if tried % ATTEMPTS == 0 {
                forms = concealed(request, &kinds, index, &given_up, &mut dice.fork());
            }
            tried += 1;
            let bench = request.bench.unwrap_or(if index.is_multiple_of(2) { Bench::Lumped } else { Bench::Slices });
            let outcome = match World::draw(&mut dice, bench, &Demands::of(&forms), request.half) {
                Ok(mut world) => {
                    let left = most.saturating_sub(work);
                    Self::stage((kinds[index], index), &forms, &mut world, &mut dice, left)
                }
                Err(why) => Err(Failure { why, blamed: None, work: 0 }),
            };
            match outcome {
                Ok(mut case) => {
                    case.truth.redraws = by_reason.values().sum();
                    case.truth.redraws_by_reason = by_reason;
                    case.truth.given_up = given_up;
                    return case;
                }
                Err(failure) => {
                    *by_reason.entry(failure.why).or_default() += 1;
                    work += failure.work;
                    if let Some(form) = failure.blamed {
                        *blamed.entry(label(form)).or_default() += 1;
                    }
                }
            }
        }
        unreachable!("some effect shows within a thousand worlds");
    }

    /// Conceals forms in a world; within `most_work` steps it is tried anew with less contraction.
    fn stage(
        (kind, index): (CaseKind, usize),
        forms: &[&'static Form],
        world: &mut World,
        dice: &mut Dice,
        most_work: usize,
    ) -> Result<Self, Failure> {
        let may_be_slack = forms.iter().any(|form| form.id == "slack");
        let stage_dice = dice.fork();
        let aims: Vec<f64> = forms.iter().map(|_| dice.log_uniform(SEVERITIES.0 * 1.1, SEVERITIES.1)).collect();
        let form_dice: Vec<Dice> = forms.iter().map(|_| dice.fork()).collect();
        let caliper_seed = dice.between(0, 1 << 40) as u64;
        let mut work = 0;
        for _ in 0..5 {
            if work > most_work {
                return Err(Failure { why: Unmade::Work, blamed: None, work });
            }
            let stage = Stage::new(world, &mut stage_dice.clone());
            let unseen = |form: &&'static Form| {
                let work = work + stage.work.get();
                Failure { why: Unmade::NotSeen, blamed: Some(form), work }
            };
            // Whether each can show at all, before time goes into how large it is to be.
            let mut tops = Vec::new();
            for (form, dice) in forms.iter().zip(&form_dice) {
                let top = stage.severity_at(form, dice, 1.0);
                if !top.is_finite() || top < SEVERITIES.0 {
                    return Err(unseen(form));
                }
                tops.push(top);
            }
            let mut found = Vec::new();
            for (((form, dice), &aim), &top) in forms.iter().zip(&form_dice).zip(&aims).zip(&tops) {
                found.push(stage.search(form, dice, aim, top).ok_or_else(|| unseen(form))?);
            }
            let built = || -> Vec<Built> {
                forms
                    .iter()
                    .zip(&form_dice)
                    .zip(&found)
                    .map(|((form, dice), &(u, _))| stage.build(form, dice, u))
                    .collect()
            };
            let logs = stage.seen(built(), world.plan.len(), true);
            work += stage.work.get();
            if logs.iter().any(|log| log.true_force_n.iter().any(|force_n| !force_n.is_finite())) {
                return Err(Failure { why: Unmade::Diverged, blamed: None, work });
            }
            if !may_be_slack && slack_share(&logs) > SLACK_SHARE {
                // Less contraction everywhere keeps the muscle taut with the effect as well.
                world.region.taut.iter_mut().for_each(|most| *most -= 0.015);
                world.region.most -= 0.01;
                if world.region.most < 0.05 {
                    return Err(Failure { why: Unmade::Slack, blamed: None, work });
                }
                continue;
            }
            let described = built();
            let (setting, floor_n) = (stage.setting.clone(), stage.floor_n);
            let name = |recording: usize| {
                if recording < world.estimation {
                    format!("e{}", recording + 1)
                } else {
                    format!("h{}", recording - world.estimation + 1)
                }
            };
            let cylinder = LumpedMuscle::new(&world.muscle);
            let bladder_n = |length_m: f64| cylinder.parts(0.0, length_m).bladder_n;
            let cylinder_misfit_n = cylinder_misfit_n(&stage.plain, stage.scales, bladder_n);
            let mut attributes = world.attributes.clone();
            attributes.cylinder_misfit = match cylinder_misfit_n / floor_n {
                below if below < 0.5 => "below-half-floor",
                near if near < 1.5 => "about-floor",
                _ => "above-floor",
            };
            let truth = Truth {
                cylinder_misfit_n,
                case: format!("case{index:03}"),
                kind,
                concealed: forms
                    .iter()
                    .map(
                        |form| {
                            if form.id == "nameless" { format!("nameless:{}", form.form) } else { form.id.to_owned() }
                        },
                    )
                    .collect(),
                forms: forms.iter().map(|form| form.form).collect(),
                severity_over_floor: found.iter().map(|found| found.1).collect(),
                severity_in_range: found.iter().map(|found| found.0).collect(),
                parameters: described.iter().map(|built| built.parameters.clone()).collect(),
                place: described.into_iter().map(|built| built.place).collect(),
                world: attributes,
                rate_hz: world.sensors.rate_hz,
                duration_s: (0..world.plan.len()).map(|recording| (name(recording), world.plan[recording].1)).collect(),
                protocol: (0..world.plan.len()).map(|recording| (name(recording), world.plan[recording].0)).collect(),
                floor_n,
                tare_n: world.sensors.tare_n,
                force_range_n: setting.forces_n,
                redraws: 0,
                redraws_by_reason: BTreeMap::new(),
                given_up: Vec::new(),
            };
            return Ok(Self { truth, world: world.clone(), logs, caliper_seed });
        }
        Err(Failure { why: Unmade::Slack, blamed: None, work })
    }
}
