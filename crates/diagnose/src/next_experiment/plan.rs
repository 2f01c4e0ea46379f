//! What is to be recorded, in words and as a path.

use pam_artifact::diagnosis::NextExperiment;

use super::setpoints::Setpoints;
use crate::protocols::{Protocol, Reach};

/// How to run a protocol, in words.
pub(super) fn run_it(protocol: &Protocol, reach: &Reach<'_>) -> String {
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

/// The recording that `protocol` makes within `reach`, with its path.
pub(super) fn planned(
    protocol: &Protocol,
    reach: &Reach<'_>,
    separates: Vec<String>,
    separation_n: f64,
    instruction: String,
) -> (NextExperiment, Setpoints) {
    let experiment = NextExperiment { protocol: protocol.name.to_owned(), separates, separation_n, instruction };
    (experiment, Setpoints::of(&protocol.takes(reach)))
}
