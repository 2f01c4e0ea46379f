//! Whether the muscle can follow the reference at all, before anything is simulated.
//!
//! At every instant of the reference the force that the lift needs has to lie between the forces at the lowest and at the
//! highest pressure, for the arm as the controller is told and as it is. Where it does not, a mounted length is looked for
//! with which it does, or else a load, or else a smaller rise; each is only proposed after a lift with it went well.

use pam_artifact::model::Domain;

use crate::arm::Elbow;
use crate::config::LiftPlan;
use crate::error::{Help, OutOfReach, ReachError};
use crate::inverse::{ExactInverse, Inverse as _};
use crate::plant::MusclePhysics;
use crate::reference::ReferenceAt;
use crate::simulation::{Deviation, Simulation};

/// Instants at which the reference is looked at.
const INSTANTS: u32 = 200;
/// More than any muscle pulls, in N.
const BEYOND_MUSCLES_N: f64 = 1e6;
/// Share of `limits.diverged_rad` by which a bare arm may be lifted: it swings as far again.
const BARE_SHARE: f64 = 0.5;
/// But by no more than this, in rad.
const BARE_MOST_RAD: f64 = 0.5;
/// Mounted lengths that are tried, as shares of the rest length.
const LENGTHS: [f64; 2] = [0.6, 1.3];
/// The longest that a configuration may say, in m.
const LONGEST_M: f64 = 5.0;
/// Steps between them, and how far to both sides a length that fits must fit as well, in m.
const LENGTH_STEP_M: f64 = 5e-4;
/// Lifts that are tried in search of a length or a load, at most.
const MOST_LIFTS: usize = 12;
/// Steps of a lift that is tried, at most.
const MOST_STEPS: f64 = 100_000.0;

/// What a lift asks of the muscle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Shortest and longest length, in m.
    pub length_m: [f64; 2],
    /// Lowest and highest pressure, in Pa.
    pub pressure_pa: [f64; 2],
}

/// Checks force against need along the whole reference; `domain` is where the controller's model was identified.
///
/// # Errors
/// [`ReachError`] at the first instant where the force is out of reach.
pub fn check_reach(simulation: &Simulation<'_>, domain: &Domain) -> Result<Reach, ReachError> {
    let reach = find_reach(simulation).map_err(|(length_m, what)| {
        let [shortest_m, longest_m] = domain.length_m;
        let recorded_mm =
            (length_m < shortest_m || length_m > longest_m).then_some([1e3 * shortest_m, 1e3 * longest_m]);
        ReachError { what, recorded_mm, help: help(simulation, domain) }
    })?;
    Ok(Reach { pressure_pa: pressures_pa(simulation), ..reach })
}

/// What would bring a lift that is out of reach, or that did not begin, into reach.
pub fn help(simulation: &Simulation<'_>, domain: &Domain) -> Help {
    if let Some(length_m) = fitting_length_m(simulation, domain) {
        return Help::MountedLength { length_mm: 1e3 * length_m };
    }
    if let Some(mass_kg) = fitting_mass_kg(simulation) {
        return Help::Mass { mass_kg };
    }
    fitting_rise_rad(simulation).map_or(Help::Other, |to_rad| Help::Rise { to_rad })
}

/// The mounted length next to the configured one with which the lift goes well, in m; recorded lengths go first.
fn fitting_length_m(simulation: &Simulation<'_>, domain: &Domain) -> Option<f64> {
    let rest_m = simulation.model.base().muscle().rest_length_m;
    let steps = |share: f64| ((share * rest_m).clamp(LENGTH_STEP_M, LONGEST_M) / LENGTH_STEP_M) as u32;
    let with_length = |length_m: f64| LiftPlan { mounted_length_m: Some(length_m), ..simulation.plan.clone() };
    let lengths_m: Vec<f64> =
        (steps(LENGTHS[0])..=steps(LENGTHS[1])).map(|step| f64::from(step) * LENGTH_STEP_M).collect();
    let reach = |length_m: &f64| find_reach(&Simulation { plan: &with_length(*length_m), ..*simulation }).ok();
    let reaches: Vec<Option<Reach>> = lengths_m.iter().map(reach).collect();
    let recorded = |reach: &Reach| {
        reach.length_m[0] >= domain.length_m[0] - LENGTH_STEP_M
            && reach.length_m[1] <= domain.length_m[1] + LENGTH_STEP_M
    };
    let configured_m = simulation.mounted_length_m();
    let mut fitting: Vec<(bool, f64)> = (1..lengths_m.len().saturating_sub(1))
        .filter(|&index| reaches[index - 1..=index + 1].iter().all(Option::is_some))
        .filter_map(|index| reaches[index].map(|reach| (!recorded(&reach), lengths_m[index])))
        .collect();
    fitting.sort_by(|a, b| a.0.cmp(&b.0).then((a.1 - configured_m).abs().total_cmp(&(b.1 - configured_m).abs())));
    // Those that are tried lie ever further away, so that a band in which lifts fail is left.
    let mut index = 0;
    for attempt in 0..MOST_LIFTS {
        let &(_, length_m) = fitting.get(index)?;
        if goes_well(simulation, &with_length(length_m)) {
            return Some(length_m);
        }
        index += 1 << attempt.min(5);
    }
    None
}

/// The largest load of some tenths of the configured one with which the lift goes well, in kg.
fn fitting_mass_kg(simulation: &Simulation<'_>) -> Option<f64> {
    let plan = simulation.plan;
    (1..10).rev().find_map(|tenths| {
        let share = 0.1 * f64::from(tenths);
        let mut lighter = plan.clone();
        lighter.load.mass_kg = (10.0 * share * plan.load.mass_kg).floor() / 10.0;
        let share = lighter.load.mass_kg / plan.load.mass_kg;
        lighter.load.inertia_kg_m2 *= share;
        lighter.true_mass_kg *= share;
        let reached = share > 0.0 && find_reach(&Simulation { plan: &lighter, ..*simulation }).is_ok();
        (reached && goes_well(simulation, &lighter)).then_some(lighter.load.mass_kg)
    })
}

/// The largest rise of some twentieths of the configured one with which the lift goes well, as its end in rad.
fn fitting_rise_rad(simulation: &Simulation<'_>) -> Option<f64> {
    let plan = simulation.plan;
    let rise_rad = plan.reference.to_rad - plan.reference.from_rad;
    (1..20).rev().find_map(|twentieths| {
        let mut smaller = plan.clone();
        // In hundredths of a rad, as it is written.
        let to_rad = plan.reference.from_rad + 0.05 * f64::from(twentieths) * rise_rad;
        smaller.reference.to_rad = (100.0 * to_rad).round() / 100.0;
        let is_rise = (smaller.reference.to_rad - plan.reference.from_rad) * rise_rad > 0.0;
        let reached = is_rise && find_reach(&Simulation { plan: &smaller, ..*simulation }).is_ok();
        (reached && goes_well(simulation, &smaller)).then_some(smaller.reference.to_rad)
    })
}

/// Whether a lift goes well; of one that takes long to simulate, reach is all that is asked.
fn goes_well(simulation: &Simulation<'_>, plan: &LiftPlan) -> bool {
    let duration_s = plan.handover_s + plan.hold_s + plan.reference.duration_s + plan.settle_s;
    if duration_s / plan.step_s > MOST_STEPS {
        return true;
    }
    let outcomes = Simulation { plan, ..*simulation }.run_nominal(1, |_, _| {});
    outcomes.iter().all(|outcome| outcome.began && outcome.is_clean())
}

/// Lowest and highest pressure that a reference within reach takes.
fn pressures_pa(simulation: &Simulation<'_>) -> [f64; 2] {
    let [lowest_pa, highest_pa] = simulation.plan.control.pressure_limits_pa;
    let inverse = ExactInverse::new(simulation.model.clone(), lowest_pa, highest_pa);
    let mut range_pa = [f64::INFINITY, f64::NEG_INFINITY];
    let visited = along_reference(simulation, &mut |at, length_m, needed_n| {
        let pressure_pa = inverse.pressure_pa(needed_n, length_m, direction(at)).pressure_pa;
        range_pa = [range_pa[0].min(pressure_pa), range_pa[1].max(pressure_pa)];
    });
    debug_assert!(visited.is_ok(), "the reference is within reach");
    range_pa
}

/// The lengths of the reach, or the length and the reason where it ends. Pressures, which take most of the time, are left to
/// [`pressures_pa`]: a search asks for some hundred reaches.
fn find_reach(simulation: &Simulation<'_>) -> Result<Reach, (f64, OutOfReach)> {
    let mut reach = Reach { length_m: [f64::INFINITY, 0.0], pressure_pa: [f64::INFINITY, f64::NEG_INFINITY] };
    along_reference(simulation, &mut |_, length_m, _| {
        reach.length_m = [reach.length_m[0].min(length_m), reach.length_m[1].max(length_m)];
    })?;
    Ok(reach)
}

/// Walks along the reference with the arm as told and as it is: instant, length and force that is needed there.
fn along_reference(
    simulation: &Simulation<'_>,
    visit: &mut dyn FnMut(&ReferenceAt, f64, f64),
) -> Result<(), (f64, OutOfReach)> {
    let plan = simulation.plan;
    let real = simulation.physics(&Deviation::none(plan), simulation.plant);
    let told = MusclePhysics::new(simulation.model, 1.0, plan.presliding_m, 0.0);
    for muscle in [&told, &real.muscle] {
        check_bare(simulation, muscle)?;
    }
    for (elbow, muscle) in [(Elbow::new(&plan.load, &plan.forearm), &told), (real.elbow, &real.muscle)] {
        for index in 0..=INSTANTS {
            let time_s = plan.reference.duration_s * f64::from(index) / f64::from(INSTANTS);
            let at = plan.reference.at(time_s);
            let (length_m, needed_n) = check_instant(simulation, &elbow, muscle, time_s, at)?;
            visit(&at, length_m, needed_n);
        }
    }
    Ok(())
}

fn direction(at: &ReferenceAt) -> f64 {
    if at.dq_rad_per_s < 0.0 { -1.0 } else { 1.0 }
}

/// Before the load is laid onto the arms, the muscle is all that moves them: at the lowest pressure it must not lift them
/// far.
fn check_bare(simulation: &Simulation<'_>, muscle: &MusclePhysics) -> Result<(), (f64, OutOfReach)> {
    let plan = simulation.plan;
    if plan.handover_s <= 0.0 {
        return Ok(());
    }
    let lowest_pa = plan.control.pressure_limits_pa[0];
    let pull_n = |q_rad: f64| muscle.thrust_n(lowest_pa, simulation.lever().at_angle(q_rad).length_m, 1.0);
    let lifted_rad = plan.reference.from_rad + (BARE_SHARE * plan.diverged_rad).min(BARE_MOST_RAD);
    if pull_n(lifted_rad) > 0.0 {
        let length_m = simulation.lever().at_angle(plan.reference.from_rad).length_m;
        let available_n = pull_n(plan.reference.from_rad);
        let what = OutOfReach::Restless { length_mm: 1e3 * length_m, available_n, lowest_kpa: 1e-3 * lowest_pa };
        return Err((length_m, what));
    }
    Ok(())
}

/// Length of the muscle and force that is needed at an instant, if the muscle has it.
fn check_instant(
    simulation: &Simulation<'_>,
    elbow: &Elbow,
    muscle: &MusclePhysics,
    time_s: f64,
    at: ReferenceAt,
) -> Result<(f64, f64), (f64, OutOfReach)> {
    let (sine, cosine) = at.q_rad.sin_cos();
    let there = simulation.lever().at(sine, cosine);
    let needed_n = (elbow.inertia_kg_m2 * at.ddq_rad_per_s2 + elbow.gravity_n_m(sine, cosine)) / there.moment_arm_m;
    let [lowest_pa, highest_pa] = simulation.plan.control.pressure_limits_pa;
    let direction = direction(&at);
    let at_lowest_n = muscle.thrust_n(lowest_pa, there.length_m, direction);
    let at_highest_n = muscle.thrust_n(highest_pa, there.length_m, direction);
    let (q_rad, length_mm) = (at.q_rad, 1e3 * there.length_m);
    let (lowest_kpa, highest_kpa) = (1e-3 * lowest_pa, 1e-3 * highest_pa);
    let straight_mm = 1e3 * muscle.force().base().muscle().strand_length_m();
    let implausible = |force_n: f64| force_n.is_nan() || force_n.abs() > BEYOND_MUSCLES_N;
    let what = if length_mm >= straight_mm {
        OutOfReach::Overstretched { q_rad, time_s, length_mm, straight_mm }
    } else if implausible(at_lowest_n) || implausible(at_highest_n) || implausible(needed_n) {
        OutOfReach::NoForce { q_rad, time_s, length_mm, lowest_kpa, highest_kpa }
    } else if at_highest_n <= 0.0 {
        OutOfReach::Slack { q_rad, time_s, length_mm, needed_n, highest_kpa }
    } else if at_highest_n < needed_n {
        OutOfReach::TooWeak { q_rad, time_s, length_mm, needed_n, available_n: at_highest_n, highest_kpa }
    } else if at_lowest_n > needed_n {
        OutOfReach::TooStrong { q_rad, time_s, length_mm, needed_n, available_n: at_lowest_n, lowest_kpa }
    } else {
        return Ok((there.length_m, needed_n));
    };
    Err((there.length_m, what))
}
