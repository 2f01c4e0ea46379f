//! Why a lift is not simulated.

use std::path::PathBuf;

use pam_recording::toml_file::TomlFileError;

/// Why a configuration is refused.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// It cannot be read, or is no TOML of its kind.
    #[error(transparent)]
    File(#[from] TomlFileError),
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
        /// The remedy.
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

/// Why a lift cannot happen, and what would help.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the muscle cannot reach the reference: {what}{}; {help}", beyond(*recorded_mm))]
pub struct ReachError {
    /// Where it fails, and by how much.
    pub what: OutOfReach,
    /// Lengths that the model was identified on, in mm, where it fails beyond them.
    pub recorded_mm: Option<[f64; 2]>,
    /// What would help.
    pub help: Help,
}

fn beyond(recorded_mm: Option<[f64; 2]>) -> String {
    recorded_mm.map_or(String::new(), |[from, to]| {
        format!(" (extrapolated: the model was identified on {from:.1} to {to:.1} mm)")
    })
}

/// What would bring a lift into reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Help {
    /// Another mounted length, with which the lift was tried.
    MountedLength {
        /// That length, in mm.
        length_mm: f64,
    },
    /// A lighter load, with which the lift was tried.
    Mass {
        /// Its mass, in kg.
        mass_kg: f64,
    },
    /// A smaller rise, with which the lift was tried.
    Rise {
        /// Angle at its end, in rad.
        to_rad: f64,
    },
    /// None of these.
    Other,
}

impl std::fmt::Display for Help {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::MountedLength { length_mm } => write!(formatter, "arm.mounted_length_mm = {length_mm:.1} fits"),
            Self::Mass { mass_kg } => write!(formatter, "no mounted length helps; load.mass_kg = {mass_kg:.1} fits"),
            Self::Rise { to_rad } => {
                write!(formatter, "no mounted length and no lighter load helps; reference.to_rad = {to_rad:.2} fits")
            }
            Self::Other => formatter.write_str(
                "no mounted length, no lighter load and no smaller rise helps; change reference.from_rad, \
                 valve.lowest_kpa or valve.highest_kpa, lower the gains of [controller], or identify the model anew",
            ),
        }
    }
}

/// Where a lift is out of a muscle's reach.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum OutOfReach {
    /// The muscle is stretched beyond the length of its strands.
    #[error(
        "at {q_rad:.3} rad ({time_s:.2} s) it is {length_mm:.1} mm long, and its strands are straight at {straight_mm:.1} mm"
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
        "at {q_rad:.3} rad ({time_s:.2} s) it is slack, as a muscle of {length_mm:.1} mm pulls nothing even at \
         {highest_kpa:.0} kPa, and the lift needs {needed_n:.1} N"
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
        "at {q_rad:.3} rad ({time_s:.2} s, length {length_mm:.1} mm) the lift needs {needed_n:.1} N, and \
         {highest_kpa:.0} kPa give {available_n:.1} N"
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
        "at {q_rad:.3} rad ({time_s:.2} s, length {length_mm:.1} mm) the lift needs {needed_n:.1} N, and the muscle pulls \
         {available_n:.1} N already at {lowest_kpa:.0} kPa"
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
    /// Before the load is on the arms, the muscle lifts them by itself.
    #[error(
        "before the load is on the arms, a muscle of {length_mm:.1} mm pulls {available_n:.1} N at {lowest_kpa:.0} kPa and \
         lifts the bare arm by more than half of limits.diverged_rad"
    )]
    Restless {
        /// Length of the muscle at the start, in mm.
        length_mm: f64,
        /// Force at the lowest pressure there, in N.
        available_n: f64,
        /// Lowest pressure, in kPa.
        lowest_kpa: f64,
    },
    /// The model gives no force that a muscle can have.
    #[error(
        "at {q_rad:.3} rad ({time_s:.2} s, length {length_mm:.1} mm) the model gives no force that a muscle has, between \
         {lowest_kpa:.0} and {highest_kpa:.0} kPa"
    )]
    NoForce {
        /// Angle, in rad.
        q_rad: f64,
        /// Time from the start of the lift, in s.
        time_s: f64,
        /// Length of the muscle there, in mm.
        length_mm: f64,
        /// Lowest pressure, in kPa.
        lowest_kpa: f64,
        /// Highest pressure, in kPa.
        highest_kpa: f64,
    },
}
