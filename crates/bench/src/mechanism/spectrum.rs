//! Linear memory over many decades of time.
//!
//! ```text
//! h(t) = Σ g_i (f(t) - q_i(t)),   τ_i dq_i/dt = f - q_i,   τ_i = three for each decade
//! ```
//!
//! | symbol | code        | unit        | meaning                                       |
//! |--------|-------------|-------------|-----------------------------------------------|
//! | `f`    | `driver`    | that of `h` | what is remembered                            |
//! | `q_i`  | `states`    | that of `h` | what has been forgotten, by each element      |
//! | `g_i`  | `weights`   | 1           | share of an element                           |
//! | `τ_i`  | `times_s`   | s           | its time                                      |
//! | `h`    | return value|             | what still is remembered: `Σ g_i` of a step at first, then less and less |
//!
//! Three elements a decade follow any smooth spectrum within a percent, so that the sum behaves as the continuous spectrum of a
//! fractional element and not as a few exponentials. Each is stepped exactly for a driver that goes straight between steps.
//!
//! Source: Oustaloup, Levron, Mathieu and Nanot (2000), IEEE Trans. Circuits and Systems I 47(1), for fractional elements as ladders
//! of poles.

/// Elements for each decade of time.
const PER_DECADE: f64 = 3.0;

/// A ladder of first-order elements.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Spectrum {
    times_s: Vec<f64>,
    weights: Vec<f64>,
    states: Vec<f64>,
    decays: Vec<(f64, f64)>,
    decays_for_s: f64,
    driver: Option<f64>,
}

impl Spectrum {
    /// Times between two, three a decade, with a weight for each.
    pub(crate) fn new(shortest_s: f64, longest_s: f64, weight: impl Fn(f64) -> f64) -> Self {
        let count = ((longest_s / shortest_s).log10() * PER_DECADE).round() as i32;
        let times_s: Vec<f64> =
            (0..=count).map(|index| shortest_s * 10.0_f64.powf(f64::from(index) / PER_DECADE)).collect();
        let weights: Vec<f64> = times_s.iter().map(|time_s| weight(*time_s)).collect();
        let states = vec![0.0; times_s.len()];
        Self { times_s, weights, states, decays: Vec::new(), decays_for_s: f64::NAN, driver: None }
    }

    /// Width of an element in the logarithm of time.
    pub(crate) fn log_width() -> f64 {
        10.0_f64.ln() / PER_DECADE
    }

    /// The same with weights that add up to `sum`.
    pub(crate) fn with_sum(mut self, sum: f64) -> Self {
        let total: f64 = self.weights.iter().sum();
        self.weights.iter_mut().for_each(|weight| *weight *= sum / total);
        self
    }

    /// Moves on by a step at whose end the driver has a value; nothing is remembered at first.
    pub(crate) fn follow(&mut self, driver: f64, step_s: f64) -> f64 {
        let Some(before) = self.driver.replace(driver) else {
            self.states.fill(driver);
            return 0.0;
        };
        if step_s != self.decays_for_s {
            self.decays = self.times_s.iter().map(|time_s| decay(step_s / time_s)).collect();
            self.decays_for_s = step_s;
        }
        let mut remembered = 0.0;
        for ((state, weight), (kept, lag)) in self.states.iter_mut().zip(&self.weights).zip(&self.decays) {
            // Exact for a driver that rises straight from `before` to `driver`.
            *state = driver + (*state - before) * kept - (driver - before) * lag;
            remembered += weight * (driver - *state);
        }
        remembered
    }
}

/// `e^{-h}` and `(1 - e^{-h}) / h`.
fn decay(h: f64) -> (f64, f64) {
    let lag = if h > 0.0 { -(-h).exp_m1() / h } else { 1.0 };
    ((-h).exp(), lag)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_spectrum_forgets_a_step_as_the_logarithm_of_time() {
        let mut spectrum = Spectrum::new(1e-3, 1e5, |_| Spectrum::log_width());
        spectrum.follow(0.0, 0.0);
        spectrum.follow(1.0, 1e-9);
        let mut time_s = 0.0;
        let mut after = |until_s: f64| {
            let remembered = spectrum.follow(1.0, until_s - time_s);
            time_s = until_s;
            remembered
        };
        let (one, ten, hundred) = (after(1.0), after(10.0), after(100.0));
        // Between the ends of the spectrum, each e-fold of time takes one.
        assert!((one - ten - 10.0_f64.ln()).abs() < 0.02, "{}", one - ten);
        assert!((ten - hundred - 10.0_f64.ln()).abs() < 0.02);
    }

    #[test]
    fn a_ramp_is_followed_alike_in_one_step_and_in_many() {
        let ramp = |steps: u32| {
            let mut spectrum = Spectrum::new(0.01, 100.0, |_| 0.1);
            spectrum.follow(0.0, 0.0);
            (1..=steps).fold(0.0, |_, step| spectrum.follow(f64::from(step) / f64::from(steps), 1.0 / f64::from(steps)))
        };
        assert!((ramp(1) - ramp(1000)).abs() < 1e-12);
    }

    #[test]
    fn a_steady_driver_is_forgotten_from_the_start() {
        let mut spectrum = Spectrum::new(0.01, 100.0, |_| 0.1);
        assert!((0..10).all(|_| spectrum.follow(5.0, 1.0) == 0.0));
    }
}
