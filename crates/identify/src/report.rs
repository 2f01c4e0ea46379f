//! What was found, in the words and numbers of an artifact.

use pam_artifact::model::{CompositeEntry, ParameterEntry, ParameterStatus};
use pam_muscle::force::Parameter;
use pam_muscle::force::columns::{BLADDER, FRICTION};
use pam_muscle::{Dimension, MuscleFile};
use pam_optim::summary::Summary;
use pam_recording::quality::ChannelQuality;

use crate::faults::and_others;
use crate::faults::lag::Lag;
use crate::identify::Identified;
use crate::prepare::Prepared;
use crate::search_space::Free;

/// Correlation beyond which two estimates are said to be one.
const TWINS: f64 = 0.98;

/// Share of the samples at an end of a channel's range that is worth a word; those that are not counted always are.
const STUCK: f64 = 0.005;

/// Cosines between the forces of `C₁₀` and `C₀₁`, and of the two frictions, over the recordings.
pub fn twin_cosines(summary: &Summary) -> [f64; 2] {
    let cosine = |left: usize, right: usize| {
        let (mut cross, mut squares_left, mut squares_right) = (0.0, 0.0, 0.0);
        for row in 0..summary.n_columns() {
            let entries = summary.row(row);
            cross += entries[left] * entries[right];
            squares_left += entries[left] * entries[left];
            squares_right += entries[right] * entries[right];
        }
        let scale = (squares_left * squares_right).sqrt();
        if scale > 0.0 { cross / scale } else { 1.0 }
    };
    [cosine(BLADDER, BLADDER + 1), cosine(FRICTION, FRICTION + 1)]
}

/// Names of what was fitted, in the order of the coordinates.
pub fn coordinate_names(found: &Identified) -> Vec<String> {
    let dimensions = found.freed.iter().map(|dimension| dimension.parameter_name());
    found.space.free.iter().map(|free| free.name()).chain(dimensions).map(str::to_owned).collect()
}

/// Value, standard error (SI of `theta`) and whether it is at its bound, of a free parameter.
fn coordinate(found: &Identified, index: usize) -> (f64, Option<f64>, bool) {
    let (low, high) = found.space.ranges[index];
    let value = low + found.fit.x[index] * (high - low);
    let stderr = found.uncertainty.stderr[index].map(|stderr| stderr * (high - low));
    (value, stderr, found.fit.at_bound[index])
}

/// The eight parameters of eq. 11, and fitted dimensions after them.
pub fn parameters(found: &Identified) -> Vec<ParameterEntry> {
    let position = |free: Free| found.space.free.iter().position(|candidate| *candidate == free);
    let ratio = found.space.bladder_ratio;
    let mut entries: Vec<ParameterEntry> = Parameter::ALL
        .into_iter()
        .map(|parameter| {
            let value = found.model.parameters().of(parameter);
            let share = match parameter {
                Parameter::C10 => 1.0 / (1.0 + ratio),
                Parameter::C01 => ratio / (1.0 + ratio),
                _ => 0.0,
            };
            let (stderr, status) = if let Some(index) = position(Free::One(parameter)) {
                let (_, stderr, at_bound) = coordinate(found, index);
                let status = if at_bound {
                    ParameterStatus::AtBound
                } else if parameter == Parameter::RubberFriction
                    && position(Free::One(Parameter::StrandFriction)).is_none()
                {
                    ParameterStatus::Composite
                } else {
                    ParameterStatus::Fitted
                };
                (stderr, status)
            } else if let Some(index) = position(Free::BladderSum).filter(|_| share > 0.0) {
                let (_, stderr, at_bound) = coordinate(found, index);
                let status = if at_bound { ParameterStatus::AtBound } else { ParameterStatus::Composite };
                (stderr.map(|stderr| share * stderr), status)
            } else {
                (None, ParameterStatus::Fixed)
            };
            let written = parameter.from_artifact(value);
            // The modulus is the inverse of what was fitted: δE = E² δ(1/E).
            let stderr =
                stderr.map(
                    |stderr| if parameter == Parameter::StrandCompliance { stderr * written * written } else { stderr },
                );
            ParameterEntry {
                name: parameter.artifact_name().to_owned(),
                value: written,
                unit: parameter.unit().to_owned(),
                stderr,
                status,
            }
        })
        .collect();
    let n_free = found.space.free.len();
    for (index, &dimension) in found.freed.iter().enumerate() {
        let (low, high) = dimension.fit_range(&found.muscle);
        entries.push(ParameterEntry {
            name: dimension.parameter_name().to_owned(),
            value: dimension.of(&found.muscle),
            unit: dimension.unit().to_owned(),
            stderr: found.uncertainty.stderr[n_free + index].map(|stderr| stderr * (high - low)),
            status: if found.fit.at_bound[n_free + index] { ParameterStatus::AtBound } else { ParameterStatus::Fitted },
        });
    }
    entries
}

/// Combinations that the data determine where the members cannot be told apart.
pub fn composites(found: &Identified) -> Vec<CompositeEntry> {
    let mut entries = Vec::new();
    for (index, free) in found.space.free.iter().enumerate() {
        let (value, stderr, _) = coordinate(found, index);
        match free {
            Free::BladderSum => entries.push(CompositeEntry {
                name: "c10 + c01".to_owned(),
                value,
                unit: "Pa".to_owned(),
                stderr,
                reason: format!(
                    "the two act almost alike (cosine {:.3} between their forces in these recordings); the sum is \
                     fitted and shared at c01/c10 = {:.3}",
                    found.twin_cosines[0], found.space.bladder_ratio
                ),
            }),
            Free::One(Parameter::RubberFriction)
                if !found.space.free.contains(&Free::One(Parameter::StrandFriction)) =>
            {
                entries.push(CompositeEntry {
                    name: "rubber_friction (strand_friction in it)".to_owned(),
                    value,
                    unit: "1".to_owned(),
                    stderr,
                    reason: format!(
                        "friction on the bladder and between strands act almost alike (cosine {:.3} in these \
                         recordings); the first is fitted and stands for both",
                        found.twin_cosines[1]
                    ),
                });
            }
            Free::One(Parameter::K1) => {
                let radius_m = found.muscle.rest_radius_m;
                entries.push(CompositeEntry {
                    name: "k1 rest_radius^2".to_owned(),
                    value: value * radius_m * radius_m,
                    unit: "m^2".to_owned(),
                    stderr: stderr.map(|stderr| stderr * radius_m * radius_m),
                    reason: "the gas term holds k1 and the radius as this product alone; the radius is taken from \
                             the muscle file"
                        .to_owned(),
                });
            }
            Free::One(_) => {}
        }
    }
    entries
}

/// Channels that are stuck at an end of their range, in words.
pub fn out_of_range<'a, I: Iterator<Item = &'a Prepared>>(prepared: impl Fn() -> I) -> Vec<String> {
    let mut warnings = Vec::new();
    for (name, unit) in [("pressure", "Pa"), ("length", "m"), ("force", "N")] {
        for end in ["low", "high"] {
            let stuck: Vec<(&str, f64, f64, bool)> = prepared()
                .filter_map(|prepared| {
                    let channel = prepared.quality.channel(name)?;
                    let (share, value, beyond) = if end == "low" {
                        (channel.clipped_low_share, channel.lowest, channel.ends_low())
                    } else {
                        (channel.clipped_high_share, channel.highest, channel.ends_high())
                    };
                    (share > STUCK || beyond).then_some((prepared.recording.path.as_str(), share, value, beyond))
                })
                .collect();
            if let Some((path, share, value, beyond)) =
                stuck.iter().copied().max_by(|left, right| left.1.total_cmp(&right.1))
            {
                warnings.push(format!(
                    "{path}{}: {name} is stuck at its {end} end ({value:.4} {unit}) in up to {:.1} % of the samples: the \
                     sensor or its converter is out of range there{}",
                    and_others(stuck.len() - 1),
                    100.0 * share,
                    if beyond { ", and those samples are not counted" } else { "" }
                ));
            }
        }
    }
    warnings
}

/// What a person should know before using the model.
pub fn warnings(found: &Identified, lags: &[Lag], muscle: &MuscleFile) -> Vec<String> {
    let prepared = || found.estimation.iter().chain(&found.validation);
    let mut warnings = out_of_range(prepared);
    if let Some(fit) = &found.estimation_fit.together
        && fit.rmse_n > BEYOND_NOISE * found.noise_floor_n
    {
        warnings.push(format!(
            "the model leaves {:.2} N, {:.0} times what noise of the sensors alone would leave: eq. 11 lacks physics of this muscle, \
             or an instrument reads wrong; pam-diagnose tells which",
            fit.rmse_n,
            fit.rmse_n / found.noise_floor_n
        ));
    }
    if found.told_by_validation {
        warnings.push(format!(
            "in no recording that was fitted does the pressure move while the length rests, so that what was held out decides \
             what friction does there ({}); add such a recording to those that are fitted, or say it with --standstill",
            found.laws[0].standstill.words()
        ));
    }
    let pressures = || found.estimation.iter().filter_map(|prepared| prepared.quality.channel("pressure"));
    let lowest_pa = pressures().map(|channel| channel.lowest).fold(f64::INFINITY, f64::min);
    let highest_pa = pressures().map(|channel| channel.highest).fold(f64::NEG_INFINITY, f64::max);
    // White noise covers some ten standard deviations in a million samples.
    if highest_pa - lowest_pa <= 12.0 * pressures().map(ChannelQuality::any_noise).fold(0.0, f64::max) {
        warnings.push(format!(
            "pressure stays near {:.1} kPa in every estimation recording, so that only the shape of the force over length tells the \
             gas from the rubber: trust this model at that pressure alone, or add a recording at another",
            0.5e-3 * (lowest_pa + highest_pa)
        ));
    }
    let doubtful: Vec<(&str, f64)> = prepared()
        .map(|prepared| {
            let n_rows = prepared.recording.samples.n_rows().max(1) as f64;
            (prepared.recording.path.as_str(), prepared.direction.n_unsettled() as f64 / n_rows)
        })
        .filter(|(_, share)| *share > 0.1)
        .collect();
    if let Some((path, share)) = doubtful.iter().copied().max_by(|left, right| left.1.total_cmp(&right.1)) {
        warnings.push(format!(
            "{path}{}: up to {:.0} % of the samples lie around reversals or beyond a sensor's range and are not counted; \
             where a gauge rings at every pulse of the valve, raise --pressure-play-kpa above the ringing",
            and_others(doubtful.len() - 1),
            100.0 * share
        ));
    }
    for lag in lags {
        let (milliseconds, order) =
            (1e3 * lag.force_later_s.abs(), if lag.force_later_s > 0.0 { "later than" } else { "ahead of" });
        warnings.push(format!(
            "force comes {milliseconds:.0} ms {order} {}: with that shift {:.2} N stay unexplained in the fastest \
             stretches instead of {:.2} N; a sensor's filter, a tube or a clock does this",
            lag.channel, lag.rmse_n.1, lag.rmse_n.0
        ));
    }
    for free in &found.unidentifiable {
        warnings.push(format!(
            "{}: these recordings cannot identify it, and it is held at its nominal value; {}",
            free.name(),
            remedy(*free)
        ));
    }
    for (index, free) in found.space.free.iter().enumerate() {
        let (value, _, at_bound) = coordinate(found, index);
        let (low, high) = plausible(*free, muscle.strand_modulus_pa);
        let above = value > high;
        if at_bound {
            // As a reader of the artifact sees it: the modulus is the inverse of what is fitted.
            let is_upper = (found.fit.x[index] > 0.5) != (*free == Free::One(Parameter::StrandCompliance));
            let end = if is_upper { "upper" } else { "lower" };
            warnings.push(format!(
                "{} is at the {end} end of its range ({}): eq. 11 lacks something that it stands in for, or {}",
                free.name(),
                written(*free, value),
                free.likely_cause(found.fit.x[index] > 0.5)
            ));
        } else if value < low || above {
            warnings.push(format!(
                "{} = {} is {} what braided muscles have ({} to {}); a likely cause is {}",
                free.name(),
                written(*free, value),
                beside(*free, above),
                written(*free, if *free == Free::One(Parameter::StrandCompliance) { high } else { low }),
                written(*free, if *free == Free::One(Parameter::StrandCompliance) { low } else { high }),
                free.likely_cause(above)
            ));
        }
    }
    let names = coordinate_names(found);
    let correlation = &found.uncertainty.correlation;
    for row in 0..names.len() {
        for column in row + 1..names.len() {
            if correlation[(row, column)].abs() > TWINS {
                warnings.push(format!(
                    "{} and {} cannot be told apart in these recordings (correlation {:.3}): trust neither alone",
                    names[row],
                    names[column],
                    correlation[(row, column)]
                ));
            }
        }
    }
    if found.freed.contains(&Dimension::RestRadius) {
        warnings.push("rest_radius is fitted, so k1 is held: the gas term holds their product alone".to_owned());
    }
    warnings
}

/// What a braided muscle has. Strands as stiff or as soft as the muscle file says are none the less plausible: aramid has
/// 70 GPa and more, and yarn gives in by more than its fibers do.
fn plausible(free: Free, strand_modulus_pa: f64) -> (f64, f64) {
    let (low, high) = free.ranges(strand_modulus_pa).plausible;
    if free == Free::One(Parameter::StrandCompliance) {
        (low.min(1.0 / (2.0 * strand_modulus_pa)), high.max(4.0 / strand_modulus_pa))
    } else {
        (low, high)
    }
}

/// Standard errors that an estimate must lie beyond what muscles have, for the model to be called implausible.
const CERTAIN: f64 = 3.0;
/// By how much of the width of what muscles have.
const FAR: f64 = 0.5;
/// A constant force that this share of the range of the force explains: a tare that nobody set to zero.
const TARE_SHARE: f64 = 0.02;

/// Share of the variation of the force that a model of it must explain at least; and, for it to be said, what it leaves: times the
/// noise floor, and of the range of the force. A force that hardly varies leaves little to explain.
const EXPLAINED: f64 = 0.5;
const BEYOND_NOISE: f64 = 5.0;
const OF_RANGE: f64 = 0.1;

/// Why the parameters are not those of a muscle as eq. 11 describes it, in words; none where they may be.
///
/// One parameter beside what muscles have may be a tare, a datum or a muscle of its own kind, which a warning says. A model
/// is implausible where at least half of what was fitted is there or at its bound, or where gas, bladder or the constant
/// are far off.
pub fn implausible(found: &Identified) -> Option<String> {
    let modulus_pa = found.model.strand_modulus_pa();
    let ends = |side: fn(f64, f64) -> f64, first: f64, pick: fn(&ChannelQuality) -> f64| {
        found.estimation.iter().filter_map(|prepared| prepared.quality.channel("force")).map(pick).fold(first, side)
    };
    let range_n =
        ends(f64::max, f64::NEG_INFINITY, |force| force.highest) - ends(f64::min, f64::INFINITY, |force| force.lowest);
    if let Some(fit) = &found.estimation_fit.together
        && fit.fit_percent < 100.0 * EXPLAINED
        && fit.rmse_n > BEYOND_NOISE * found.noise_floor_n
        && fit.rmse_n > OF_RANGE * range_n
    {
        return Some(format!(
            "which leaves {:.1} N of a force that varies by {range_n:.0} N (fit {:.0} %)",
            fit.rmse_n, fit.fit_percent
        ));
    }
    let (mut odd, mut far) = (Vec::new(), Vec::new());
    for (index, &free) in found.space.free.iter().enumerate() {
        let (value, stderr, at_bound) = coordinate(found, index);
        let (low, high) = plausible(free, modulus_pa);
        let beyond = (low - value).max(value - high);
        let is_certain = stderr.is_none_or(|stderr| beyond > CERTAIN * stderr);
        let said = || format!("{} = {}", free.name(), written(free, value));
        if at_bound || (beyond > 0.0 && is_certain) {
            odd.push(said());
        }
        let allowed = match free {
            Free::One(Parameter::K1 | Parameter::K2) | Free::BladderSum => FAR * (high - low),
            Free::One(Parameter::K3) => (FAR * (high - low)).max(TARE_SHARE * range_n),
            Free::One(_) => f64::INFINITY,
        };
        if beyond > allowed && is_certain {
            far.push(said());
        }
    }
    if !far.is_empty() {
        return Some(format!("with {}", far.join(", ")));
    }
    (odd.len() > 1 && 2 * odd.len() >= found.space.free.len()).then(|| {
        format!(
            "since {} of {} are at a bound or beside what muscles have ({})",
            odd.len(),
            found.space.free.len(),
            odd.join(", ")
        )
    })
}

/// "above" or "below" as a reader of the artifact sees it: the modulus is the inverse of what is fitted.
fn beside(free: Free, above: bool) -> &'static str {
    if above == (free == Free::One(Parameter::StrandCompliance)) { "below" } else { "above" }
}

/// A value as a person reads it.
fn written(free: Free, value: f64) -> String {
    match free {
        Free::One(Parameter::StrandCompliance) => format!("{:.3} GPa", 1e-9 / value),
        Free::One(Parameter::C10 | Parameter::C01) | Free::BladderSum => format!("{:.1} kPa", value * 1e-3),
        Free::One(Parameter::K3) => format!("{value:.2} N"),
        Free::One(Parameter::RubberFriction) => format!("{value:.3e}"),
        Free::One(_) => format!("{value:.3}"),
    }
}

/// What to record so that a parameter can be identified.
fn remedy(free: Free) -> &'static str {
    match free {
        Free::One(Parameter::K1 | Parameter::StrandCompliance) => "record several pressures at one length",
        Free::One(Parameter::K2) => "record several lengths at one pressure",
        Free::One(Parameter::K3) => "record the vented muscle as well",
        Free::One(Parameter::C10 | Parameter::C01) | Free::BladderSum => "record several lengths at low pressure",
        Free::One(Parameter::RubberFriction | Parameter::StrandFriction) => {
            "record motion both ways at several pressures"
        }
    }
}
