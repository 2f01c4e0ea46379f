//! Noise of sensors, by color.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::draw::Dice;

/// Color of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Color {
    /// White.
    White,
    /// First order, with this correlation from sample to sample.
    Ar1(f64),
    /// One over frequency, as a sum of first orders a decade apart.
    OneOverF,
    /// White, with mains hum of this share of the power.
    Hum(f64),
    /// Student's distribution with four degrees of freedom: white, with outliers.
    Heavy,
    /// Half white, half a frame that rings at this frequency in Hz with this damping ratio.
    Ringing(f64, f64),
    /// White, with the first, third and fifth harmonic of 60 Hz of this share of the power.
    Harmonics(f64),
}

impl Color {
    /// Name, for the truth.
    pub fn name(self) -> &'static str {
        match self {
            Self::White => "white",
            Self::Ar1(_) => "ar1",
            Self::OneOverF => "one-over-f",
            Self::Hum(_) => "mains-hum",
            Self::Heavy => "heavy-tails",
            Self::Ringing(..) => "ringing-frame",
            Self::Harmonics(_) => "mains-harmonics",
        }
    }

    /// Noise of deviation 1.
    pub(crate) fn series(self, count: usize, period_s: f64, dice: &mut Dice) -> Vec<f64> {
        match self {
            Self::Heavy => return (0..count).map(|_| student(dice)).collect(),
            Self::Ringing(hz, ratio) => return ringing(hz, ratio, count, period_s, dice),
            _ => {}
        }
        let mut first_order = |correlation: f64| -> Vec<f64> {
            let scale = (1.0 - correlation * correlation).sqrt();
            let mut value = dice.normal();
            (0..count)
                .map(|_| {
                    value = correlation * value + scale * dice.normal();
                    value
                })
                .collect()
        };
        match self {
            Self::White => first_order(0.0),
            Self::Ar1(correlation) => first_order(correlation),
            Self::OneOverF => {
                let parts: Vec<Vec<f64>> = [0.0, 0.6, 0.94, 0.994].map(&mut first_order).into();
                (0..count).map(|index| parts.iter().map(|part| 0.5 * part[index]).sum()).collect()
            }
            Self::Hum(share) => {
                let white = first_order(0.0);
                let (hz, phase) = (50.0 + dice.uniform(-0.05, 0.05), dice.uniform(0.0, TAU));
                let (hum, rest) = ((2.0 * share).sqrt(), (1.0 - share).sqrt());
                let wave = |index: usize| (TAU * hz * index as f64 * period_s + phase).sin();
                white.iter().enumerate().map(|(index, value)| rest * value + hum * wave(index)).collect()
            }
            Self::Harmonics(share) => {
                let white = first_order(0.0);
                let hz = 60.0 + dice.uniform(-0.05, 0.05);
                let lines = [(1.0, 0.7), (3.0, 0.2), (5.0, 0.1)].map(|(order, part): (f64, f64)| {
                    (TAU * hz * order * period_s, (2.0 * share * part).sqrt(), dice.uniform(0.0, TAU))
                });
                let wave = |index: usize| -> f64 {
                    lines.iter().map(|(step, size, phase)| size * (step * index as f64 + phase).sin()).sum()
                };
                let rest = (1.0 - share).sqrt();
                white.iter().enumerate().map(|(index, value)| rest * value + wave(index)).collect()
            }
            Self::Heavy | Self::Ringing(..) => Vec::new(),
        }
    }
}

/// Student's distribution with four degrees of freedom, brought to deviation 1 and cut at six.
fn student(dice: &mut Dice) -> f64 {
    let value = dice.normal();
    let chi_square: f64 = (0..4).map(|_| dice.normal().powi(2)).sum();
    (value / (0.25 * chi_square).sqrt() / 2f64.sqrt()).clamp(-6.0, 6.0)
}

/// White noise, and as much of a second order that it shakes (an autoregression with the frame's poles).
fn ringing(hz: f64, ratio: f64, count: usize, period_s: f64, dice: &mut Dice) -> Vec<f64> {
    // Beyond half of the sampling rate a frame would be seen at another frequency.
    let natural = TAU * hz.min(0.35 / period_s);
    let radius = (-ratio * natural * period_s).exp();
    let angle = natural * period_s * (1.0 - ratio * ratio).sqrt();
    let (first, second) = (2.0 * radius * angle.cos(), -radius * radius);
    // Variance of the autoregression (Box and Jenkins 1970).
    let variance = (1.0 - second) / ((1.0 + second) * ((1.0 - second).powi(2) - first * first));
    let scale = (0.5 / variance).sqrt();
    let (mut last, mut before) = (dice.normal() * variance.sqrt(), dice.normal() * variance.sqrt());
    (0..count)
        .map(|_| {
            let next = first * last + second * before + dice.normal();
            (before, last) = (last, next);
            scale * next + 0.5f64.sqrt() * dice.normal()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_color_has_the_deviation_it_was_asked_for() {
        let (heavy, ringing) = (Color::Heavy, Color::Ringing(18.0, 0.05));
        for color in
            [Color::White, Color::Ar1(0.8), Color::OneOverF, Color::Hum(0.5), heavy, ringing, Color::Harmonics(0.4)]
        {
            let series = color.series(20_000, 0.004, &mut Dice::new(1, 9));
            let power = series.iter().map(|value| value * value).sum::<f64>() / 20_000.0;
            assert!((0.8..1.25).contains(&power), "{color:?}: {power}");
        }
    }
}
