//! Takes, and how they are built.

/// Time from one take to the next, in s.
pub(super) const PAUSE_S: f64 = 5.0;

/// Pressure and length at one time of a take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Knot {
    pub time_s: f64,
    pub pressure_pa: f64,
    pub length_m: f64,
}

/// One uninterrupted stretch: straight between knots.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Take {
    /// Time before it that need not be recorded.
    pub pause_before_s: f64,
    pub knots: Vec<Knot>,
}

impl Take {
    pub(crate) fn duration_s(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.time_s)
    }
}

/// A take under construction: each call goes on from where the last one ended.
#[derive(Debug, Clone)]
pub(super) struct Path {
    knots: Vec<Knot>,
    /// Where it ended.
    pub(super) at: Knot,
}

impl Path {
    pub(super) fn from(pressure_pa: f64, length_m: f64) -> Self {
        let at = Knot { time_s: 0.0, pressure_pa, length_m };
        Self { knots: vec![at], at }
    }

    pub(super) fn go(&mut self, pressure_pa: f64, length_m: f64, duration_s: f64) {
        if duration_s > 0.0 {
            self.at = Knot { time_s: self.at.time_s + duration_s, pressure_pa, length_m };
            self.knots.push(self.at);
        }
    }

    pub(super) fn hold(&mut self, duration_s: f64) {
        self.go(self.at.pressure_pa, self.at.length_m, duration_s);
    }

    pub(super) fn go_to_length(&mut self, length_m: f64, speed_m_per_s: f64) {
        self.go(self.at.pressure_pa, length_m, (length_m - self.at.length_m).abs() / speed_m_per_s);
    }

    pub(super) fn go_to_pressure(&mut self, pressure_pa: f64, rate_pa_per_s: f64) {
        self.go(pressure_pa, self.at.length_m, (pressure_pa - self.at.pressure_pa).abs() / rate_pa_per_s);
    }

    /// There and back `cycles` times between where the path is and `short_m`.
    pub(super) fn triangles(&mut self, short_m: f64, cycles: usize, speed_m_per_s: f64) {
        let long_m = self.at.length_m;
        for _ in 0..cycles {
            self.go_to_length(short_m, speed_m_per_s);
            self.go_to_length(long_m, speed_m_per_s);
        }
    }

    pub(super) fn take(self, pause_before_s: f64) -> Take {
        Take { pause_before_s, knots: self.knots }
    }
}
