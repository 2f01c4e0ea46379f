//! Points as a network sees them: scaled, and parted into those that train and those that decide when to stop.

use pam_artifact::inverse::{Activation, ChannelScaling};
use rand::seq::SliceRandom as _;

use crate::design::Point;
use crate::domain::InverseBox;
use crate::stream::Stream;

/// How force, length, direction and pressure become numbers without unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Scaling {
    /// Force, length and direction, each from -1 to 1.
    pub inputs: [ChannelScaling; 3],
    /// Pressure: from -1 to 1, or from 0.1 to 0.9 for an output that ends at 0 and 1.
    pub output: ChannelScaling,
}

impl Scaling {
    /// The scaling of a box.
    pub fn of(inverse_box: &InverseBox, output: Activation) -> Self {
        let half = |name: &str, unit: &str, [from, to]: [f64; 2]| ChannelScaling {
            name: name.to_owned(),
            unit: unit.to_owned(),
            offset: 0.5 * (from + to),
            scale: 0.5 * (to - from),
        };
        let mut pressure = half("pressure", "Pa", inverse_box.pressure_pa);
        match output {
            Activation::Linear => {}
            // Tanh ends at ±1 and never gets there.
            Activation::Tanh => pressure.scale *= 1.0 / 0.8,
            Activation::Sigmoid => {
                let scale = inverse_box.pressure_span_pa() / 0.8;
                pressure = ChannelScaling { offset: inverse_box.pressure_pa[0] - 0.1 * scale, scale, ..pressure };
            }
        }
        Self {
            inputs: [
                half("force", "N", inverse_box.force_n),
                half("length", "m", inverse_box.length_m),
                half("direction", "1", [-1.0, 1.0]),
            ],
            output: pressure,
        }
    }

    /// Inputs of the network for a point.
    pub fn inputs(&self, force_n: f64, length_m: f64, direction: f64) -> [f64; 3] {
        let scaled = |value: f64, scaling: &ChannelScaling| (value - scaling.offset) / scaling.scale;
        let [force, length, sign] = &self.inputs;
        [scaled(force_n, force), scaled(length_m, length), scaled(direction, sign)]
    }

    /// Output of the network that stands for a pressure.
    pub fn output(&self, pressure_pa: f64) -> f64 {
        (pressure_pa - self.output.offset) / self.output.scale
    }
}

/// Samples of a network with three inputs and one output.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Samples {
    /// Scaled force, length and direction.
    pub inputs: Vec<[f64; 3]>,
    /// Scaled pressure.
    pub targets: Vec<f64>,
}

impl Samples {
    /// The samples of `points`.
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Point>, scaling: &Scaling) -> Self {
        let mut samples = Self::default();
        for point in points {
            samples.inputs.push(scaling.inputs(point.force_n, point.length_m, point.direction));
            samples.targets.push(scaling.output(point.pressure_pa));
        }
        samples
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.targets.len()
    }

    /// The first `n`; all where there are fewer.
    pub fn first(&self, n: usize) -> Self {
        let n = n.min(self.len());
        Self { inputs: self.inputs[..n].to_vec(), targets: self.targets[..n].to_vec() }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }
}

/// Parts `points` at random into (training, validation); both in the order in which they came.
pub fn part(points: &[Point], validation_share: f64, seed: u64) -> (Vec<Point>, Vec<Point>) {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.shuffle(&mut Stream::Validation.random(seed));
    let n_validation = (validation_share * points.len() as f64).round() as usize;
    let mut validates = vec![false; points.len()];
    for &index in &order[..n_validation.min(points.len())] {
        validates[index] = true;
    }
    let pick = |wanted: bool| points.iter().zip(&validates).filter(move |pair| *pair.1 == wanted).map(|pair| *pair.0);
    (pick(false).collect(), pick(true).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::tests::BOX;

    #[test]
    fn the_box_becomes_what_the_output_can_reach() {
        for (output, [low, high]) in
            [(Activation::Linear, [-1.0, 1.0]), (Activation::Sigmoid, [0.1, 0.9]), (Activation::Tanh, [-0.8, 0.8])]
        {
            let scaling = Scaling::of(&BOX, output);
            assert!((scaling.output(BOX.pressure_pa[0]) - low).abs() < 1e-12, "{output:?}");
            assert!((scaling.output(BOX.pressure_pa[1]) - high).abs() < 1e-12, "{output:?}");
        }
    }

    #[test]
    fn parting_loses_no_point() {
        let point = |index: usize| Point { pressure_pa: index as f64, length_m: 0.2, direction: 1.0, force_n: 0.0 };
        let points: Vec<Point> = (0..100).map(point).collect();
        let (training, validation) = part(&points, 0.2, 1);
        assert_eq!((training.len(), validation.len()), (80, 20));
        let mut all = [training, validation].concat();
        all.sort_by(|a, b| a.pressure_pa.total_cmp(&b.pressure_pa));
        assert_eq!(all, points);
    }
}
