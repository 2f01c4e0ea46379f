//! What to record next: of the bench protocols, the one that drives the surviving explanations furthest apart.
//!
//! Each protocol is run in thought within the pressures and lengths that the model covers, through every explanation as it
//! was fitted. The base parameters of one may then be refitted to the force of the other; the root mean square of what
//! remains is how far apart the protocol drives the two. Mean squares over time are information per time, so the
//! largest separation is also the most information per minute of recording; time in which nothing is recorded counts as lost.

use pam_core::artifact::diagnosis::{Coordinate, NextExperiment, Region, Verdict};
use pam_core::artifact::model::Domain;
use pam_core::effects::{Effect, Kind, Role};
use pam_core::force::columns::ForceColumns;
use rayon::prelude::*;

use crate::hypothesis::Guess;
use crate::protocols::{self, PROTOCOLS, Protocol, Reach, Take};
use crate::rehearsal::Rehearsal;
use crate::search::Found;
use crate::sheet::Ground;
use crate::state::{Setting, State};
use crate::tangent::{Tangent, norm};
use crate::verdict::{Sizes, alternatives};
use crate::words;

/// One row of a path that a rig can follow: straight from row to row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetPoint {
    /// Time, in s.
    pub time_s: f64,
    /// Gauge pressure, in kPa.
    pub pressure_kpa: f64,
    /// Length, in mm.
    pub length_mm: f64,
}

/// A path that a rig can follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Setpoints {
    /// With rising time.
    pub points: Vec<SetPoint>,
}

impl Setpoints {
    /// Writes the path as a table.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_csv(&self, to: &mut dyn std::io::Write) -> std::io::Result<()> {
        writeln!(to, "time_s,pressure_kPa,length_mm")?;
        for SetPoint { time_s, pressure_kpa, length_mm } in &self.points {
            writeln!(to, "{time_s:.4},{pressure_kpa:.3},{length_mm:.4}")?;
        }
        Ok(())
    }

    /// Time that the path takes, in s.
    pub fn duration_s(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.time_s)
    }

    fn of(takes: &[Take]) -> Self {
        let mut points: Vec<SetPoint> = Vec::new();
        let mut start_s = 0.0;
        for take in takes {
            start_s += take.pause_before_s;
            points.extend(take.knots.iter().map(|knot| SetPoint {
                time_s: start_s + knot.time_s,
                pressure_kpa: knot.pressure_pa * 1e-3,
                length_mm: knot.length_m * 1e3,
            }));
            start_s += take.duration_s();
        }
        Self { points }
    }
}

/// An explanation as it was fitted.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// Catalogue id of what tells it from the others; `nothing` where it has no effect.
    pub id: &'static str,
    /// Base and effects, fitted.
    pub state: State,
}

/// How far apart a protocol drives explanations.
#[derive(Debug, Clone)]
pub struct Separation {
    /// Name of the protocol.
    pub protocol: &'static str,
    /// Root mean square, in N, of each pair: (0, 1), (0, 2), …, (1, 2), …
    pub pairs_n: Vec<f64>,
    /// Time of the bench that it takes, in s.
    pub bench_s: f64,
    /// Share of it that is recorded.
    pub recorded_share: f64,
}

impl Separation {
    /// Information that it brings on all pairs together.
    fn worth(&self, noise_n: f64) -> f64 {
        self.pairs_n.iter().map(|pair_n| (self.recorded_share * (pair_n / noise_n).powi(2)).ln_1p()).sum()
    }
}

/// Separation as a share of the noise that counts as one.
const LEAST_SHARE_OF_NOISE: f64 = 0.2;
/// Rivals that are weighed against an effect, at most, the best first.
const MOST_RIVALS: usize = 3;
/// Share of the information of the best protocol that a shorter one must bring to be preferred.
const NEARLY: f64 = 0.7;

/// What the model covers: pressures and lengths of its recordings, and where it is taut there.
fn reach<'a>(domain: &Domain, state: &'a State, may_hang_slack: bool) -> Reach<'a> {
    Reach {
        model: &state.model,
        pressure_pa: (domain.pressure_pa[0].max(0.0), domain.pressure_pa[1]),
        length_m: (domain.length_m[0], domain.length_m[1]),
        lowest_tension_n: if may_hang_slack {
            f64::NEG_INFINITY
        } else {
            (0.01 * domain.force_n[1]).max(domain.force_n[0])
        },
    }
}

/// How far apart every protocol that `reach` leaves room for drives `explanations`, in the order of the protocols.
fn separations(
    setting: &Setting<'_>,
    protocols: &[Protocol],
    reach: &Reach<'_>,
    explanations: &[Explanation],
) -> Vec<Separation> {
    let (highest_pa, longest_m) = (reach.pressure_pa.1, reach.length_m.1);
    let columns =
        ForceColumns::new(setting.muscle, setting.strand_modulus_pa, setting.columns.form(), highest_pa * longest_m);
    protocols
        .par_iter()
        .filter_map(|protocol| {
            let takes = protocol.takes(reach);
            if takes.is_empty() {
                None
            } else {
                Some(separation(setting, &columns, protocol, &takes, reach, explanations))
            }
        })
        .collect()
}

fn separation(
    setting: &Setting<'_>,
    columns: &ForceColumns,
    protocol: &Protocol,
    takes: &[Take],
    reach: &Reach<'_>,
    explanations: &[Explanation],
) -> Separation {
    let rehearsal = Rehearsal::of(takes, reach);
    let ground = Ground { track: &rehearsal.track, columns, only: None };
    let setting = Setting {
        track: &rehearsal.track,
        columns,
        space: setting.space,
        muscle: setting.muscle,
        strand_modulus_pa: setting.strand_modulus_pa,
        only: None,
    };
    let runs: Vec<Run> = explanations
        .par_iter()
        .map(|explanation| Run::of(&setting, &ground, explanation, &rehearsal.stands_for_s))
        .collect();
    let mut pairs_n = Vec::new();
    for (index, left) in runs.iter().enumerate() {
        for right in &runs[index + 1..] {
            // Either may bend towards the other; the nearer they come, the less the protocol decides.
            let apart = |bent: &Run| norm(&bent.tangent.left_of(|row| left.force_n[row] - right.force_n[row]));
            pairs_n.push(apart(left).min(apart(right)));
        }
    }
    let recorded_s: f64 = takes.iter().map(Take::duration_s).sum();
    let bench_s: f64 = recorded_s + takes.iter().map(|take| take.pause_before_s).sum::<f64>();
    Separation { protocol: protocol.name, pairs_n, bench_s, recorded_share: recorded_s / bench_s }
}

/// An explanation run through a protocol.
struct Run {
    force_n: Vec<f64>,
    tangent: Tangent,
}

impl Run {
    fn of(setting: &Setting<'_>, ground: &Ground<'_>, explanation: &Explanation, stands_for_s: &[f64]) -> Self {
        let state = &explanation.state;
        let mut sheet = ground.sheet(&state.guesses, &state.model);
        // The compliance of the strands is written in columns of its own range: weights follow from the parameters.
        let mut weights = setting.columns.weights(&state.fit.parameters).to_vec();
        weights.extend(&state.fit.amplitudes);
        let mut reads: Vec<_> = state
            .guesses
            .iter()
            .filter(|guess| guess.effect.role() == Role::Reads)
            .map(|guess| guess.effect.start(setting.muscle, &guess.shape))
            .collect();
        let force_n = sheet
            .columns
            .chunks_exact_mut(sheet.width)
            .map(|row| {
                let mut force_n: f64 = row.iter().zip(&weights).map(|(column, weight)| column * weight).sum();
                for memory in &mut reads {
                    // As much of what the parameters do shows there.
                    let slope = memory.slope(force_n);
                    row.iter_mut().for_each(|column| *column *= slope);
                    force_n = memory.reads(force_n);
                }
                force_n
            })
            .collect();
        let rows = stands_for_s.iter().enumerate().map(|(row, &weight_s)| (row..row + 1, weight_s)).collect();
        let tangent = Tangent::of(setting, state, &sheet, rows);
        Self { force_n, tangent }
    }
}

/// The recording that would tell most, with a path for the rig; none where nothing is in question.
pub(crate) fn next_experiment(
    setting: &Setting<'_>,
    found: &Found,
    verdict: Verdict,
    unexplained: &[Region],
    sizes: &Sizes,
    domain: &Domain,
) -> Option<(NextExperiment, Setpoints)> {
    let best = &found.best.state;
    match verdict {
        Verdict::Consistent => None,
        Verdict::Unexplained => {
            let left_n = if best.guesses.is_empty() { sizes.mismatch_n } else { sizes.left_n };
            look_closer(unexplained.first()?, left_n, best, domain)
        }
        Verdict::Ambiguous => {
            // The first that has rivals; others are settled one after the other.
            let (index, ids) = (0..best.guesses.len())
                .map(|index| (index, alternatives(found, index)))
                .find(|(_, ids)| !ids.is_empty())?;
            let mut explanations = vec![Explanation { id: best.guesses[index].id(), state: best.clone() }];
            let rivals = found.taken[index].rivals.iter().filter(|rival| ids.contains(&rival.guess.id()));
            for rival in rivals.take(MOST_RIVALS) {
                let mut guesses = best.guesses.clone();
                guesses[index] = rival.guess.clone();
                if let Some(state) = setting.fit_near(guesses, best) {
                    explanations.push(Explanation { id: rival.guess.id(), state });
                }
            }
            separate(setting, &explanations, sizes.floor_n, domain)
        }
        Verdict::Explained => {
            let evidence = |index: usize| {
                found.taken.get(index).map_or(0.0, |taken| taken.without.log_ratio(&found.best.held_out))
            };
            let index = (0..best.guesses.len()).max_by(|left, right| evidence(*left).total_cmp(&evidence(*right)))?;
            let mut guesses = best.guesses.clone();
            let effect = guesses.remove(index).effect;
            let without = setting.fit_near(guesses, best)?;
            let explanations = [
                Explanation { id: effect.page().id, state: best.clone() },
                Explanation { id: "nothing", state: without },
            ];
            confirm(setting, effect, &explanations, sizes.floor_n, domain)
        }
    }
}

/// The protocol that separates `explanations` best, the first of which is the best one.
pub fn separate(
    setting: &Setting<'_>,
    explanations: &[Explanation],
    noise_n: f64,
    domain: &Domain,
) -> Option<(NextExperiment, Setpoints)> {
    let first = explanations.first()?;
    let reach = reach(domain, &first.state, hangs_slack(explanations));
    let found = separations(setting, &PROTOCOLS, &reach, explanations);
    let most = found.iter().map(|separation| separation.worth(noise_n)).fold(0.0, f64::max);
    // Of those that are nearly as good as the best, the one that the bench is done with first.
    let best = found
        .iter()
        .filter(|separation| separation.worth(noise_n) >= NEARLY * most)
        .min_by(|left, right| left.bench_s.total_cmp(&right.bench_s))?;
    let limit_n = LEAST_SHARE_OF_NOISE * noise_n;
    let mut told_apart = vec![false; explanations.len()];
    let (mut smallest_n, mut at) = (f64::INFINITY, 0);
    for left in 0..explanations.len() {
        for right in left + 1..explanations.len() {
            if best.pairs_n[at] > limit_n {
                (told_apart[left], told_apart[right]) = (true, true);
                smallest_n = smallest_n.min(best.pairs_n[at]);
            }
            at += 1;
        }
    }
    let page = first.state.guesses.iter().find(|guess| guess.id() == first.id).map(|guess| guess.effect.page());
    let test = page
        .and_then(|page| {
            let rivals = &explanations[1..];
            page.confused_with.iter().find(|confusion| rivals.iter().any(|rival| rival.id == confusion.id))
        })
        .map(|confusion| confusion.test)
        .or(page.map(|page| page.test));
    let protocol = protocols::named(best.protocol)?;
    if smallest_n == f64::INFINITY {
        let ids: Vec<&str> = explanations.iter().map(|explanation| explanation.id).collect();
        let largest_n = best.pairs_n.iter().copied().fold(0.0, f64::max);
        let instruction = format!(
            "No recording within the pressures and lengths of the model would tell {} apart: {largest_n:.2} N at most{}",
            ids.join(" and "),
            test.map_or_else(|| ".".to_owned(), |test| format!(". What would: {test}."))
        );
        let ids = ids.into_iter().map(str::to_owned).collect();
        return Some(planned(protocol, &reach, ids, largest_n, instruction));
    }
    let separates = explanations
        .iter()
        .zip(told_apart)
        .filter(|(_, told)| *told)
        .map(|(explanation, _)| explanation.id.to_owned())
        .collect();
    let mut instruction = run_it(protocol, &reach);
    if let Some(test) = test {
        instruction += &format!(" On a bench without a program: {test}.");
    }
    Some(planned(protocol, &reach, separates, smallest_n, instruction))
}

/// The protocol that shows `effect` best, which the first of `explanations` has and the second has not.
fn confirm(
    setting: &Setting<'_>,
    effect: &'static dyn Effect,
    explanations: &[Explanation],
    noise_n: f64,
    domain: &Domain,
) -> Option<(NextExperiment, Setpoints)> {
    let page = effect.page();
    let state = &explanations[0].state;
    let reach = reach(domain, state, hangs_slack(explanations));
    let separates = vec![page.id.to_owned()];
    let own = protocols::named(page.protocol)?;
    if effect.kind() == Kind::Event {
        let instruction = format!("{} What happened once does not come back: {}.", run_it(own, &reach), page.test);
        let step_n = amplitude_of(state, effect).map_or(0.0, f64::abs);
        return Some(planned(own, &reach, separates, step_n, instruction));
    }
    // The protocol of the page was chosen for any muscle; in the reach of this one it may show nothing.
    let of_own = separations(setting, std::slice::from_ref(own), &reach, explanations).pop();
    let best = match of_own.filter(|separation| separation.pairs_n[0] > noise_n) {
        Some(own) => own,
        None => separations(setting, &PROTOCOLS, &reach, explanations)
            .into_iter()
            .max_by(|left, right| left.worth(noise_n).total_cmp(&right.worth(noise_n)))?,
    };
    let protocol = protocols::named(best.protocol)?;
    let instruction = format!("{} It would confirm {}: {}.", run_it(protocol, &reach), page.name, page.test);
    Some(planned(protocol, &reach, separates, best.pairs_n[0], instruction))
}

/// The first amplitude of `effect` in `state`.
fn amplitude_of(state: &State, effect: &'static dyn Effect) -> Option<f64> {
    let position = state.guesses.iter().position(|guess| guess.id() == effect.page().id)?;
    let before: usize = state.guesses[..position].iter().map(|guess| guess.amplitudes().len()).sum();
    state.fit.amplitudes.get(before).copied()
}

/// The protocol that dwells on where structure is left, over that place and as much again to either side.
fn look_closer(region: &Region, left_n: f64, state: &State, domain: &Domain) -> Option<(NextExperiment, Setpoints)> {
    let name = match region.coordinate {
        Coordinate::Time => "null",
        Coordinate::Pressure => "isometric-ramps",
        Coordinate::Contraction => "isobaric-triangles",
        Coordinate::Speed => "rate-ladder",
        Coordinate::TravelSinceReversal => "minor-loops",
        Coordinate::TimeSinceLastMove => "length-steps",
        Coordinate::Cycle => "run-in",
        Coordinate::Force => "isotonic",
    };
    let whole = reach(domain, state, state.guesses.iter().any(|guess| guess.effect.role() == Role::Reads));
    let around = |(low, high): (f64, f64), from: f64, to: f64| {
        let margin = to - from;
        let narrow = ((from - margin).max(low), (to + margin).min(high));
        if narrow.1 > narrow.0 { narrow } else { (low, high) }
    };
    let narrow = match region.coordinate {
        Coordinate::Pressure => Reach { pressure_pa: around(whole.pressure_pa, region.from, region.to), ..whole },
        Coordinate::Contraction => {
            let [short_m, long_m] = [region.to, region.from].map(|ratio| state.model.muscle().length_m(ratio));
            Reach { length_m: around(whole.length_m, short_m, long_m), ..whole }
        }
        _ => whole,
    };
    let protocol = protocols::named(name)?;
    let reach = if protocol.takes(&narrow).is_empty() { whole } else { narrow };
    let instruction = format!(
        "{} It dwells on what has no name yet, {}; two such recordings, one of them held out, tell whether it comes back.",
        run_it(protocol, &reach),
        words::place(region)
    );
    Some(planned(protocol, &reach, vec!["unexplained".to_owned()], left_n, instruction))
        .filter(|(_, setpoints)| !setpoints.points.is_empty())
}

fn hangs_slack(explanations: &[Explanation]) -> bool {
    let reads = |guess: &Guess| guess.effect.role() == Role::Reads;
    explanations.iter().any(|explanation| explanation.state.guesses.iter().any(reads))
}

/// How to run a protocol, in words.
fn run_it(protocol: &Protocol, reach: &Reach<'_>) -> String {
    let takes = protocol.takes(reach);
    let minutes = Setpoints::of(&takes).duration_s() / 60.0;
    let knots = || takes.iter().flat_map(|take| &take.knots);
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let (low_pa, high_pa) = range(&mut knots().map(|knot| knot.pressure_pa));
    let (short_m, long_m) = range(&mut knots().map(|knot| knot.length_m));
    format!(
        "Record {} ({}): {:.0} to {:.0} kPa, {:.1} to {:.1} mm, {minutes:.0} min; then diagnose again with that recording \
         beside the others.",
        protocol.name,
        protocol.summary,
        low_pa * 1e-3,
        high_pa * 1e-3,
        short_m * 1e3,
        long_m * 1e3
    )
}

fn planned(
    protocol: &Protocol,
    reach: &Reach<'_>,
    separates: Vec<String>,
    separation_n: f64,
    instruction: String,
) -> (NextExperiment, Setpoints) {
    let experiment = NextExperiment { protocol: protocol.name.to_owned(), separates, separation_n, instruction };
    (experiment, Setpoints::of(&protocol.takes(reach)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::{Given, domain};

    fn explanation(given: &Given, id: &'static str, shape: &[f64]) -> Explanation {
        let setting = given.setting();
        let state = setting.fit(vec![given.guess(id, shape)], &given.start, &given.model).expect("a fit");
        Explanation { id, state }
    }

    /// The path that would tell the two apart, where `truth` made the recordings and both were fitted to them.
    fn between(
        protocols: &[&str],
        truth: (&'static str, &[f64], &[f64]),
        rival: (&'static str, &[f64]),
    ) -> (NextExperiment, Setpoints, Vec<Separation>) {
        let given = Given::of(protocols, &[truth]);
        let setting = given.setting();
        let explanations = [explanation(&given, truth.0, truth.1), explanation(&given, rival.0, rival.1)];
        let reach = reach(&domain(), &explanations[0].state, false);
        let all = separations(&setting, &PROTOCOLS, &reach, &explanations);
        let (experiment, setpoints) = separate(&setting, &explanations, 0.3, &domain()).expect("an experiment");
        (experiment, setpoints, all)
    }

    fn of<'a>(all: &'a [Separation], protocol: &str) -> &'a Separation {
        all.iter().find(|separation| separation.protocol == protocol).expect("a protocol")
    }

    #[test]
    fn a_lag_and_a_delay_of_the_pressure_ask_for_a_pressure_chirp() {
        let (experiment, setpoints, _) =
            between(&["isometric-ramps"], ("pressure-lag", &[0.02], &[]), ("channel-delay", &[-0.02, 0.0]));
        assert_eq!(experiment.protocol, "pressure-chirp");
        assert_eq!(experiment.separates, ["pressure-lag", "channel-delay"]);
        assert!(setpoints.duration_s() > 300.0);
    }

    #[test]
    fn damping_and_a_late_length_ask_for_something_else_than_they_were_seen_in() {
        let (experiment, _, all) =
            between(&["rate-ladder"], ("viscous-damping", &[], &[50.0, 100.0]), ("channel-delay", &[0.0, 0.012]));
        // A locked length shows neither; the stiffness changes with pressure and length otherwise than damping does, which
        // takes fast and wide motion at several pressures to see.
        assert_eq!(experiment.protocol, "length-chirp");
        assert!(of(&all, "pressure-chirp").pairs_n[0] < 1e-6);
    }

    /// A delay of the force shows where damping does not act at all.
    #[test]
    fn damping_and_an_early_force_ask_for_a_pressure_chirp() {
        let (experiment, ..) =
            between(&["rate-ladder"], ("viscous-damping", &[], &[50.0, 100.0]), ("channel-delay", &[0.012, 0.012]));
        assert_eq!(experiment.protocol, "pressure-chirp");
    }

    #[test]
    fn set_points_stay_in_the_domain_and_run_forward() {
        let given = Given::of(&["isobaric-triangles"], &[]);
        let setting = given.setting();
        let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let domain = domain();
        for lowest_tension_n in [f64::NEG_INFINITY, 5.0] {
            let reach = Reach { lowest_tension_n, ..reach(&domain, &state, false) };
            for protocol in &PROTOCOLS {
                let points = Setpoints::of(&protocol.takes(&reach)).points;
                assert!(points.len() > 5, "{}", protocol.name);
                assert!(points.windows(2).all(|pair| pair[1].time_s > pair[0].time_s), "{}", protocol.name);
                for point in &points {
                    let (pressure_pa, length_m) = (point.pressure_kpa * 1e3, point.length_mm * 1e-3);
                    let inside =
                        |value: f64, [low, high]: [f64; 2]| value >= low - 1e-9 * high && value <= high * (1.0 + 1e-9);
                    assert!(inside(pressure_pa, domain.pressure_pa), "{}: {point:?}", protocol.name);
                    assert!(inside(length_m, domain.length_m), "{}: {point:?}", protocol.name);
                }
            }
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_answer() {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| {
                let (experiment, setpoints, all) =
                    between(&["isometric-ramps"], ("pressure-lag", &[0.02], &[]), ("channel-delay", &[-0.02, 0.0]));
                let bits: Vec<u64> =
                    all.iter().flat_map(|separation| &separation.pairs_n).map(|n| n.to_bits()).collect();
                (experiment, setpoints, bits)
            })
        };
        assert_eq!(run(1), run(2));
    }

    #[test]
    fn a_region_without_a_name_is_looked_at_more_closely() {
        let given = Given::of(&["isobaric-triangles"], &[]);
        let state = given.setting().fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let region = Region {
            coordinate: Coordinate::Contraction,
            from: 0.10,
            to: 0.13,
            unit: "1".to_owned(),
            share_of_excess: 0.8,
            p_value: 1e-6,
            recording: None,
        };
        let (experiment, setpoints) = look_closer(&region, 2.0, &state, &domain()).expect("an experiment");
        assert_eq!(experiment.protocol, "isobaric-triangles");
        let muscle = state.model.muscle();
        for point in &setpoints.points {
            let ratio = muscle.contraction_ratio(point.length_mm * 1e-3);
            assert!((0.07 - 1e-9..0.16 + 1e-9).contains(&ratio), "{ratio}");
        }
    }

    #[test]
    fn the_page_of_an_effect_names_the_protocol_that_confirms_it() {
        let given = Given::of(&["isobaric-triangles", "minor-loops"], &[("presliding-hysteresis", &[1e-3], &[])]);
        let setting = given.setting();
        let with = explanation(&given, "presliding-hysteresis", &[1e-3]);
        let without = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let effect = with.state.guesses[0].effect;
        let explanations = [with, Explanation { id: "nothing", state: without }];
        let (experiment, _) = confirm(&setting, effect, &explanations, 0.3, &domain()).expect("an experiment");
        assert_eq!(experiment.protocol, "minor-loops");
        assert!(experiment.separation_n > 0.5);
    }

    #[test]
    fn every_protocol_shows_something_of_something() {
        let given = Given::of(&["multisine"], &[("viscoelastic-relaxation", &[3.0], &[0.1, 0.1])]);
        let setting = given.setting();
        let with = explanation(&given, "viscoelastic-relaxation", &[3.0]);
        let without = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let explanations = [with, Explanation { id: "nothing", state: without }];
        let reach = reach(&domain(), &explanations[0].state, false);
        let all = separations(&setting, &PROTOCOLS, &reach, &explanations);
        assert_eq!(all.len(), PROTOCOLS.len());
        assert!(of(&all, "length-steps").pairs_n[0] > 10.0 * of(&all, "pressure-chirp").pairs_n[0]);
    }
}
