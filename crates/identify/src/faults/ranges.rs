//! Ranges that no muscle has, and the unit that would explain them.

use pam_muscle::Muscle;

use super::Fault;
use crate::prepare::Gated;

/// Highest gauge pressure that braided and molded muscles are run at, with room to spare, in Pa.
const HIGHEST_PRESSURE_PA: f64 = 2.0e6;
/// A pressure that never passes this pulls with a few newtons at most, in Pa.
const LOWEST_PEAK_PRESSURE_PA: f64 = 20.0e3;
/// Peak force beyond that of an ideal muscle that no rubber and no stretch explain.
const MOST_TIMES_IDEAL: f64 = 5.0;
/// Beyond these contractions no braid works: 10 % stretched, half shortened.
const CONTRACTION: (f64, f64) = (-0.10, 0.50);

/// Checks pressure, length, force and clock of one recording against what a muscle can do.
pub fn check(gate: &Gated, muscle: &Muscle) -> Option<Fault> {
    pressure(gate, muscle).or_else(|| length(gate, muscle)).or_else(|| force(gate, muscle)).or_else(|| clock(gate))
}

fn slip(
    gate: &Gated,
    channel: &'static str,
    reached: String,
    factor: f64,
    direction: &'static str,
    guess: &'static str,
) -> Fault {
    let factor = if factor >= 10.0 { format!("{factor:.0}") } else { format!("{factor:.1}") };
    Fault::UnitSlip { path: gate.recording.path.clone(), channel, reached, factor, direction, guess }
}

/// Peak force as recorded, and as an ideal muscle has it at the highest pressure and the longest length.
fn peak_forces_n(gate: &Gated, muscle: &Muscle) -> Option<(f64, f64)> {
    let force = gate.quality.channel("force")?;
    let pressure = gate.quality.channel("pressure")?;
    let length = gate.quality.channel("length")?;
    let contraction = muscle.contraction_ratio(length.highest).clamp(-0.02, 0.9 * muscle.max_contraction_ratio());
    let ideal_n = pam_muscle::force::gas::Gas::new(muscle).force_n(pressure.highest, contraction, 1.0, 1.0);
    Some((force.highest.max(-force.lowest), ideal_n))
}

fn pressure(gate: &Gated, muscle: &Muscle) -> Option<Fault> {
    let channel = gate.quality.channel("pressure")?;
    let peak_pa = channel.highest.max(-channel.lowest);
    let reached = || format!("{:.3} kPa", peak_pa * 1e-3);
    if peak_pa > HIGHEST_PRESSURE_PA {
        // A unit that would bring the peak to a few bar.
        let (factor, guess) = match peak_pa / 3e5 {
            ratio if ratio < 300.0 => (100.0, "kPa under a header that says bar is a factor of 100"),
            ratio if ratio < 5000.0 => (1000.0, "kPa under a header that says MPa, or Pa as kPa, is a factor of 1000"),
            _ => (1e5, "Pa under a header that says bar is a factor of 100000"),
        };
        return Some(slip(gate, "pressure", reached(), factor, "high", guess));
    }
    let (peak_n, ideal_n) = peak_forces_n(gate, muscle)?;
    if peak_pa < LOWEST_PEAK_PRESSURE_PA && peak_pa > 0.0 && peak_n > MOST_TIMES_IDEAL * ideal_n.max(1.0) {
        let (factor, guess) = match 3e5 / peak_pa {
            ratio if ratio < 300.0 => (100.0, "bar under a header that says kPa is a factor of 100"),
            ratio if ratio < 5000.0 => (1000.0, "MPa under a header that says kPa, or kPa as Pa, is a factor of 1000"),
            _ => (1e5, "bar under a header that says Pa is a factor of 100000"),
        };
        return Some(slip(gate, "pressure", reached(), factor, "low", guess));
    }
    None
}

fn length(gate: &Gated, muscle: &Muscle) -> Option<Fault> {
    let channel = gate.quality.channel("length")?;
    let (shortest, longest) = (muscle.contraction_ratio(channel.highest), muscle.contraction_ratio(channel.lowest));
    if shortest >= CONTRACTION.0 && longest <= CONTRACTION.1 && channel.highest < muscle.strand_length_m() {
        return None;
    }
    let ratio = channel.highest / muscle.rest_length_m;
    let reached = || format!("{:.3} mm", channel.highest * 1e3);
    for (factor, guess) in [
        (1000.0, "mm under a header that says m is a factor of 1000"),
        (25.4, "mm under a header that says in is a factor of 25.4"),
        (10.0, "mm under a header that says cm is a factor of 10"),
    ] {
        if (ratio / factor - 0.9).abs() < 0.25 {
            return Some(slip(gate, "length", reached(), factor, "high", guess));
        }
    }
    for (factor, guess) in [
        (1000.0, "m under a header that says mm is a factor of 1000"),
        (25.4, "in under a header that says mm is a factor of 25.4"),
        (10.0, "cm under a header that says mm is a factor of 10"),
    ] {
        if (ratio * factor - 0.9).abs() < 0.25 {
            return Some(slip(gate, "length", reached(), factor, "low", guess));
        }
    }
    Some(Fault::AnotherMuscle {
        path: gate.recording.path.clone(),
        shortest_mm: channel.lowest * 1e3,
        longest_mm: channel.highest * 1e3,
        rest_mm: muscle.rest_length_m * 1e3,
        reason: if longest > CONTRACTION.1 {
            "it would be shortened by more than half"
        } else {
            "it would be stretched by more than a tenth, or its strands straight"
        },
    })
}

fn force(gate: &Gated, muscle: &Muscle) -> Option<Fault> {
    let (peak_n, ideal_n) = peak_forces_n(gate, muscle)?;
    let reached = || format!("{peak_n:.3} N");
    if ideal_n > 1.0 && peak_n > 100.0 * ideal_n {
        return Some(slip(
            gate,
            "force",
            reached(),
            1000.0,
            "high",
            "N under a header that says kN is a factor of 1000",
        ));
    }
    if ideal_n > 20.0 && peak_n < 0.005 * ideal_n {
        return Some(slip(
            gate,
            "force",
            reached(),
            1000.0,
            "low",
            "kN under a header that says N is a factor of 1000",
        ));
    }
    None
}

fn clock(gate: &Gated) -> Option<Fault> {
    let period_s = gate.quality.period_s;
    if period_s > 0.0 && period_s < 2e-5 {
        return Some(slip(
            gate,
            "time",
            format!("{:.4} s in {} rows", gate.quality.duration_s, gate.quality.n_rows),
            1000.0,
            "low",
            "s under a header that says ms is a factor of 1000",
        ));
    }
    // Whole seconds between rows and motion slower than any bench makes.
    let crawls = gate.quality.length_rate_m_per_s < 5e-5 && gate.quality.pressure_rate_pa_per_s < 1e3;
    if period_s >= 1.0 && (period_s - period_s.round()).abs() < 1e-9 && crawls {
        return Some(slip(
            gate,
            "time",
            format!("{:.0} s, one row every {period_s} s", gate.quality.duration_s),
            1000.0,
            "high",
            "ms under a header that says s is a factor of 1000",
        ));
    }
    None
}
