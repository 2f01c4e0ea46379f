//! Transport delay of a whole number of steps.

/// A line in which every value waits for a fixed number of steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Delay {
    line: Vec<f64>,
    next: usize,
}

impl Delay {
    /// A line of `steps` steps that holds `value` at first.
    pub fn new(steps: usize, value: f64) -> Self {
        Self { line: vec![value; steps], next: 0 }
    }

    /// Puts a value in at one end; gives the one that comes out at the other.
    pub fn pass(&mut self, value: f64) -> f64 {
        let Some(slot) = self.line.get_mut(self.next) else { return value };
        let out = std::mem::replace(slot, value);
        self.next = (self.next + 1) % self.line.len();
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_comes_out_after_as_many_steps() {
        let mut line = Delay::new(2, 0.5);
        let out: Vec<f64> = [1.0, 2.0, 3.0, 4.0].map(|value| line.pass(value)).into();
        assert_eq!(out, [0.5, 0.5, 1.0, 2.0]);
        assert!((Delay::new(0, 0.0).pass(7.0) - 7.0).abs() < f64::EPSILON);
    }
}
