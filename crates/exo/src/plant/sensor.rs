//! A sensor: white noise, then steps.

use rand::RngExt as _;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

/// A sensor of one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Standard deviation of the noise, in the quantity's unit.
    pub noise: f64,
    /// Step of the reading, likewise; 0 for none.
    pub step: f64,
}

impl Sensor {
    /// A reading of `value`.
    pub fn read(&self, value: f64, rng: &mut Pcg64) -> f64 {
        let noise: f64 = rng.sample(StandardNormal);
        let noisy = value + self.noise * noise;
        if self.step > 0.0 { (noisy / self.step).round() * self.step } else { noisy }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_scatter_as_stated_and_lie_on_steps() {
        let sensor = Sensor { noise: 0.2e-3, step: 0.1e-3 };
        let mut rng = Pcg64::new(7, 1);
        let readings: Vec<f64> = (0..20_000).map(|_| sensor.read(0.1, &mut rng)).collect();
        let variance = readings.iter().map(|reading| (reading - 0.1).powi(2)).sum::<f64>() / 20_000.0;
        let expected = sensor.noise.powi(2) + sensor.step.powi(2) / 12.0;
        assert!((variance / expected - 1.0).abs() < 0.05, "{variance:e}");
        assert!(readings.iter().all(|reading| (reading / 1e-4 - (reading / 1e-4).round()).abs() < 1e-9));
    }
}
