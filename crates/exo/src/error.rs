//! Why a lift is not simulated.

use std::path::PathBuf;

use pam_core::spelling::unreadable;

/// Why a configuration is refused.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// The file cannot be read.
    #[error("cannot read configuration {}: {}", path.display(), unreadable(path, reason))]
    Read {
        /// File asked for.
        path: PathBuf,
        /// What the system said.
        reason: std::io::Error,
    },
    /// The text is not a configuration.
    #[error("{}:{line}:{column}: {reason}", path.display())]
    Parse {
        /// File being read.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What the parser found.
        reason: String,
    },
    /// A value outside its range, or no number.
    #[error("{}: {key} = {value} is outside {lowest} to {highest}; {remedy}", path.display())]
    OutOfRange {
        /// File being read.
        path: PathBuf,
        /// Section and key.
        key: &'static str,
        /// Value found.
        value: f64,
        /// Lowest value accepted.
        lowest: f64,
        /// Highest value accepted.
        highest: f64,
        /// What to do.
        remedy: &'static str,
    },
    /// A time that is no whole number of steps.
    #[error(
        "{}: {key} = {value} is no multiple of {step_key} = {step}; choose {below} or {above}, or another step",
        path.display()
    )]
    NotAMultiple {
        /// File being read.
        path: PathBuf,
        /// Section and key.
        key: &'static str,
        /// Value found.
        value: f64,
        /// Section and key of the step.
        step_key: &'static str,
        /// Value of the step.
        step: f64,
        /// Next multiple below, or the step itself.
        below: f64,
        /// Next multiple above.
        above: f64,
    },
    /// A lift of so many periods that its signals would not fit into memory.
    #[error(
        "{}: the lift has {n_periods:.0} periods of the controller, more than {most:.0}; shorten the times of [reference] or \
         lengthen controller.period_ms",
        path.display()
    )]
    TooLong {
        /// File being read.
        path: PathBuf,
        /// Periods of the lift.
        n_periods: f64,
        /// Most periods accepted.
        most: f64,
    },
    /// A lower limit that is not below the upper one.
    #[error("{}: {low_key} = {low} is not below {high_key} = {high}", path.display())]
    Order {
        /// File being read.
        path: PathBuf,
        /// Section and key of the lower one.
        low_key: &'static str,
        /// Its value.
        low: f64,
        /// Section and key of the upper one.
        high_key: &'static str,
        /// Its value.
        high: f64,
    },
}

/// Why the reference is out of the muscle's reach.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ReachError {
    /// The muscle is stretched beyond the length of its strands.
    #[error(
        "the muscle cannot reach the reference: at {q_rad:.3} rad ({time_s:.2} s) it is {length_mm:.1} mm long, and its \
         strands are straight at {straight_mm:.1} mm; mount it shorter (arm.mounted_length_mm)"
    )]
    Overstretched {
        /// Angle, in rad.
        q_rad: f64,
        /// Time from the start of the lift, in s.
        time_s: f64,
        /// Length of the muscle there, in mm.
        length_mm: f64,
        /// Length of its strands, in mm.
        straight_mm: f64,
    },
    /// The muscle has shortened so far that no pressure makes it pull.
    #[error(
        "the muscle cannot reach the reference: at {q_rad:.3} rad ({time_s:.2} s) it is slack, as a muscle of \
         {length_mm:.1} mm pulls nothing even at {highest_kpa:.0} kPa, and the lift needs {needed_n:.1} N; mount it \
         longer (arm.mounted_length_mm)"
    )]
    Slack {
        /// Angle, in rad.
        q_rad: f64,
        /// Time from the start of the lift, in s.
        time_s: f64,
        /// Length of the muscle there, in mm.
        length_mm: f64,
        /// Force needed, in N.
        needed_n: f64,
        /// Highest pressure, in kPa.
        highest_kpa: f64,
    },
    /// The muscle is too weak.
    #[error(
        "the muscle cannot reach the reference: at {q_rad:.3} rad ({time_s:.2} s, length {length_mm:.1} mm) the lift \
         needs {needed_n:.1} N, and {highest_kpa:.0} kPa give {available_n:.1} N; lower load.mass_kg or \
         reference.to_rad, or raise valve.highest_kpa"
    )]
    TooWeak {
        /// Angle, in rad.
        q_rad: f64,
        /// Time from the start of the lift, in s.
        time_s: f64,
        /// Length of the muscle there, in mm.
        length_mm: f64,
        /// Force needed, in N.
        needed_n: f64,
        /// Force at the highest pressure, in N.
        available_n: f64,
        /// Highest pressure, in kPa.
        highest_kpa: f64,
    },
    /// The muscle pulls more than is needed even at the lowest pressure.
    #[error(
        "the muscle cannot reach the reference: at {q_rad:.3} rad ({time_s:.2} s, length {length_mm:.1} mm) the lift \
         needs {needed_n:.1} N, and the muscle pulls {available_n:.1} N already at {lowest_kpa:.0} kPa; mount it \
         longer (arm.mounted_length_mm) or start at a larger angle"
    )]
    TooStrong {
        /// Angle, in rad.
        q_rad: f64,
        /// Time from the start of the lift, in s.
        time_s: f64,
        /// Length of the muscle there, in mm.
        length_mm: f64,
        /// Force needed, in N.
        needed_n: f64,
        /// Force at the lowest pressure, in N.
        available_n: f64,
        /// Lowest pressure, in kPa.
        lowest_kpa: f64,
    },
}
