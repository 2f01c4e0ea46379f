//! Numbers of a [`Point`] that may differ from then.

use pam_identification::search_space::Free;
use pam_muscle::force::Parameter;

use super::point::Point;

/// Zero or gain of a channel: `read = (1 + gain) · true + zero`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Channel {
    ForceZero,
    ForceGain,
    PressureZero,
    PressureGain,
    LengthZero,
}

impl Channel {
    /// Every one of them, in order.
    pub(crate) const ALL: [Self; 5] =
        [Self::ForceZero, Self::ForceGain, Self::PressureZero, Self::PressureGain, Self::LengthZero];

    pub(crate) fn index(self) -> usize {
        self as usize
    }

    /// Id in artifacts.
    pub(crate) fn id(self) -> &'static str {
        match self {
            Self::ForceZero => "force-zero",
            Self::ForceGain => "force-gain",
            Self::PressureZero => "pressure-zero",
            Self::PressureGain => "pressure-gain",
            Self::LengthZero => "length-zero",
        }
    }

    /// What it is, in words.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::ForceZero => "zero of the load cell",
            Self::ForceGain => "gain of the load cell",
            Self::PressureZero => "zero of the pressure gauge",
            Self::PressureGain => "gain of the pressure gauge",
            Self::LengthZero => "zero of the length sensor",
        }
    }

    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::ForceZero => "N",
            Self::PressureZero => "Pa",
            Self::LengthZero => "m",
            Self::ForceGain | Self::PressureGain => "1",
        }
    }

    /// What a rig may come to have; more is a fault of another kind.
    fn range(self) -> (f64, f64) {
        let most = match self {
            Self::ForceZero => 200.0,
            Self::PressureZero => 1e5,
            Self::LengthZero => 0.02,
            Self::ForceGain | Self::PressureGain => 0.3,
        };
        (-most, most)
    }
}

/// A number that may differ from then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Quantity {
    /// A base parameter, or the sum of the bladder's; the share of `C₀₁` in it is kept.
    Base(Free),
    /// An amplitude of a term.
    Amplitude { term: usize, index: usize },
    /// A shape of a term.
    Shape { term: usize, index: usize },
    /// Zero or gain of a channel.
    Channel(Channel),
}

impl Quantity {
    /// Value at `point`, SI; of a modulus its inverse.
    pub(crate) fn of(self, point: &Point) -> f64 {
        match self {
            Self::Base(Free::One(parameter)) => point.theta.of(parameter),
            Self::Base(Free::BladderSum) => point.theta.of(Parameter::C10) + point.theta.of(Parameter::C01),
            Self::Amplitude { term, index } => point.terms[term].amplitudes[index],
            Self::Shape { term, index } => point.terms[term].shape[index],
            Self::Channel(channel) => point.channels[channel.index()],
        }
    }

    /// `point` with another value.
    pub(crate) fn set(self, point: &mut Point, value: f64) {
        match self {
            Self::Base(Free::One(parameter)) => point.theta.theta[parameter.index()] = value,
            Self::Base(Free::BladderSum) => {
                let [c10, c01] = [Parameter::C10, Parameter::C01].map(|parameter| point.theta.of(parameter));
                let share = if c10 + c01 > 0.0 { c10 / (c10 + c01) } else { 0.5 };
                point.theta.theta[Parameter::C10.index()] = share * value;
                point.theta.theta[Parameter::C01.index()] = (1.0 - share) * value;
            }
            Self::Amplitude { term, index } => point.terms[term].amplitudes[index] = value,
            Self::Shape { term, index } => point.terms[term].shape[index] = value,
            Self::Channel(channel) => point.channels[channel.index()] = value,
        }
    }

    /// What it may be.
    pub(crate) fn range(self, point: &Point) -> (f64, f64) {
        match self {
            Self::Base(free) => free.ranges(point.strand_modulus_pa()).search,
            Self::Amplitude { term, index } => point.terms[term].effect.amplitudes()[index].range,
            Self::Shape { term, index } => point.terms[term].effect.shape()[index].range,
            Self::Channel(channel) => channel.range(),
        }
    }

    /// Step of a difference quotient, signed so that it stays within the range.
    pub(crate) fn step(self, point: &Point) -> f64 {
        let ((low, high), value) = (self.range(point), self.of(point));
        let size = match self {
            // Nothing is smooth in a shape that decides when something slides.
            Self::Shape { .. } => (0.02 * value.abs()).max(1e-4 * (high - low)),
            Self::Amplitude { .. } => (0.01 * value.abs()).max(1e-3 * (high - low).min(1e12)),
            Self::Base(_) | Self::Channel(_) => 1e-4 * (high - low),
        };
        if value + size > high && value - size >= low { -size } else { size }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    #[test]
    fn a_channel_that_reads_more_is_corrected_to_what_there_is() {
        let given = Given::of(&["isobaric-triangles"], &[]);
        let mut point = Point::of(&given.model.clone().into());
        let before_n = point.force_n(&given.track);
        Quantity::Channel(Channel::ForceZero).set(&mut point, 5.0);
        Quantity::Channel(Channel::ForceGain).set(&mut point, 0.1);
        for (after_n, before_n) in point.force_n(&given.track).iter().zip(before_n) {
            assert!((after_n - (1.1 * before_n + 5.0)).abs() < 1e-9);
        }
    }

    #[test]
    fn the_sum_of_the_bladder_keeps_its_shares() {
        let given = Given::of(&["isobaric-triangles"], &[]);
        let mut point = Point::of(&given.model.clone().into());
        let sum = Quantity::Base(Free::BladderSum);
        let (c10, all) = (point.theta.of(Parameter::C10), sum.of(&point));
        sum.set(&mut point, 0.5 * all);
        assert!((sum.of(&point) - 0.5 * all).abs() < 1e-9 * all);
        assert!((point.theta.of(Parameter::C10) - 0.5 * c10).abs() < 1e-9 * all);
    }
}
