//! Where the rig takes pressure and length: straight lines between knots, in takes.
//!
//! A take is what the logger writes without interruption. Between takes the logger is off while the rig
//! goes to where the next take begins, as one does when a pin is moved or a weight is changed.

/// Pressure and length at one time of a take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// Time since the start of the take.
    pub time_s: f64,
    /// Gauge pressure.
    pub pressure_pa: f64,
    /// Length, clamp to clamp.
    pub length_m: f64,
}

/// One uninterrupted stretch of a protocol.
#[derive(Debug, Clone, PartialEq)]
pub struct Take {
    /// Time for which the logger is off before the take; the rig goes to its start meanwhile.
    pub pause_before_s: f64,
    /// Knots, with rising time; between them the rig goes straight.
    pub knots: Vec<Knot>,
}

impl Take {
    /// Duration of the take.
    pub fn duration_s(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.time_s)
    }
}

/// A protocol made for one muscle.
#[derive(Debug, Clone, PartialEq)]
pub struct Command {
    /// Name of the protocol.
    pub protocol: &'static str,
    /// Takes in order; never empty.
    pub takes: Vec<Take>,
}

impl Command {
    /// Duration with pauses; those of the first take count as well.
    pub fn duration_s(&self) -> f64 {
        self.takes.iter().map(|take| take.pause_before_s + take.duration_s()).sum()
    }

    /// Duration that is logged.
    pub fn logged_s(&self) -> f64 {
        self.takes.iter().map(Take::duration_s).sum()
    }

    /// Lowest and highest pressure.
    pub fn pressure_range_pa(&self) -> (f64, f64) {
        range(self.takes.iter().flat_map(|take| &take.knots).map(|knot| knot.pressure_pa))
    }

    /// Shortest and longest length.
    pub fn length_range_m(&self) -> (f64, f64) {
        range(self.takes.iter().flat_map(|take| &take.knots).map(|knot| knot.length_m))
    }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// A take under construction: each call goes on from where the last one ended.
#[derive(Debug, Clone)]
pub(crate) struct Path {
    knots: Vec<Knot>,
    pressure_pa: f64,
    length_m: f64,
    time_s: f64,
}

impl Path {
    pub(crate) fn from(pressure_pa: f64, length_m: f64) -> Self {
        Self { knots: vec![Knot { time_s: 0.0, pressure_pa, length_m }], pressure_pa, length_m, time_s: 0.0 }
    }

    /// Goes straight to a pressure and a length within `duration_s`.
    pub(crate) fn go_to(&mut self, pressure_pa: f64, length_m: f64, duration_s: f64) {
        if duration_s > 0.0 {
            self.time_s += duration_s;
            (self.pressure_pa, self.length_m) = (pressure_pa, length_m);
            self.knots.push(Knot { time_s: self.time_s, pressure_pa, length_m });
        }
    }

    /// Stays where it is.
    pub(crate) fn hold(&mut self, duration_s: f64) {
        self.go_to(self.pressure_pa, self.length_m, duration_s);
    }

    /// Changes the length at a speed, in m/s; the pressure stays.
    pub(crate) fn go_to_length(&mut self, length_m: f64, speed_m_per_s: f64) {
        self.go_to(self.pressure_pa, length_m, (length_m - self.length_m).abs() / speed_m_per_s);
    }

    /// Changes the pressure at a rate, in Pa/s; the length stays.
    pub(crate) fn go_to_pressure(&mut self, pressure_pa: f64, rate_pa_per_s: f64) {
        self.go_to(pressure_pa, self.length_m, (pressure_pa - self.pressure_pa).abs() / rate_pa_per_s);
    }

    /// Length where the path is.
    pub(crate) fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Pressure where the path is.
    pub(crate) fn pressure_pa(&self) -> f64 {
        self.pressure_pa
    }

    /// Follows a curve: `curve` maps the time since its start to pressure and length.
    pub(crate) fn follow(&mut self, duration_s: f64, step_s: f64, mut curve: impl FnMut(f64) -> (f64, f64)) {
        let steps = (duration_s / step_s).ceil().max(1.0);
        let step_s = duration_s / steps;
        for index in 1..=steps as usize {
            let (pressure_pa, length_m) = curve(index as f64 * step_s);
            self.go_to(pressure_pa, length_m, step_s);
        }
    }

    pub(crate) fn take(self, pause_before_s: f64) -> Take {
        Take { pause_before_s, knots: self.knots }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_takes_the_time_that_its_speeds_ask_for() {
        let mut path = Path::from(1e5, 0.26);
        path.go_to_length(0.25, 0.005);
        path.hold(3.0);
        path.go_to_pressure(3e5, 1e5);
        let take = path.take(0.0);
        assert!((take.duration_s() - 7.0).abs() < 1e-12);
        assert_eq!(take.knots.last().map(|knot| (knot.pressure_pa, knot.length_m)), Some((3e5, 0.25)));
    }

    #[test]
    fn a_move_of_no_length_adds_no_knot() {
        let mut path = Path::from(1e5, 0.26);
        path.go_to_length(0.26, 0.005);
        assert_eq!(path.take(0.0).knots.len(), 1);
    }
}
