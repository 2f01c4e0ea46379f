//! A path that a rig can follow.

use crate::protocols::Take;

/// One row of a path that a rig can follow: straight from row to row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetPoint {
    /// Time, in s.
    pub time_s: f64,
    /// Gauge pressure, in kPa.
    pub pressure_kpa: f64,
    /// Length, in mm.
    pub length_mm: f64,
}

/// A path that a rig can follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Setpoints {
    /// With rising time.
    pub points: Vec<SetPoint>,
}

impl Setpoints {
    /// Writes the path as a table.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_csv(&self, to: &mut dyn std::io::Write) -> std::io::Result<()> {
        writeln!(to, "time_s,pressure_kPa,length_mm")?;
        for SetPoint { time_s, pressure_kpa, length_mm } in &self.points {
            writeln!(to, "{time_s:.4},{pressure_kpa:.3},{length_mm:.4}")?;
        }
        Ok(())
    }

    /// Time that the path takes, in s.
    pub fn duration_s(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.time_s)
    }

    /// Acceleration of the length on the way, root mean square, in m/s².
    pub(super) fn acceleration_m_per_s2(&self) -> f64 {
        let (mut squares, mut time_s) = (0.0, 0.0);
        for around in self.points.windows(3) {
            let steps_s = [around[1].time_s - around[0].time_s, around[2].time_s - around[1].time_s];
            let speeds = [0, 1].map(|at| 1e-3 * (around[at + 1].length_mm - around[at].length_mm) / steps_s[at]);
            let between_s = 0.5 * (steps_s[0] + steps_s[1]);
            squares += between_s * ((speeds[1] - speeds[0]) / between_s).powi(2);
            time_s += between_s;
        }
        (squares / f64::max(time_s, f64::MIN_POSITIVE)).sqrt()
    }

    pub(super) fn of(takes: &[Take]) -> Self {
        let mut points: Vec<SetPoint> = Vec::new();
        let mut start_s = 0.0;
        for take in takes {
            start_s += take.pause_before_s;
            points.extend(take.knots.iter().map(|knot| SetPoint {
                time_s: start_s + knot.time_s,
                pressure_kpa: knot.pressure_pa * 1e-3,
                length_mm: knot.length_m * 1e3,
            }));
            start_s += take.duration_s();
        }
        Self { points }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocols::{PROTOCOLS, Reach};
    use crate::rehearsal::tests::{Given, domain};

    #[test]
    fn a_sine_accelerates_as_it_should() {
        let point = |index: i32| {
            let time_s = 0.01 * f64::from(index);
            SetPoint { time_s, pressure_kpa: 300.0, length_mm: 250.0 + 5.0 * (6.0 * time_s).sin() }
        };
        let path = Setpoints { points: (0..10_000).map(point).collect() };
        let expected = 5e-3 * 36.0 / 2.0_f64.sqrt();
        assert!((path.acceleration_m_per_s2() / expected - 1.0).abs() < 1e-2);
    }

    #[test]
    fn set_points_stay_in_the_domain_and_run_forward() {
        let given = Given::of(&["isobaric-triangles"], &[]);
        let setting = given.setting();
        let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let domain = domain();
        for lowest_tension_n in [f64::NEG_INFINITY, 5.0] {
            let reach = Reach { lowest_tension_n, ..Reach::of(&domain, &state.model, false) };
            for protocol in &PROTOCOLS {
                let points = Setpoints::of(&protocol.takes(&reach)).points;
                assert!(points.len() > 5, "{}", protocol.name);
                assert!(points.windows(2).all(|pair| pair[1].time_s > pair[0].time_s), "{}", protocol.name);
                for point in &points {
                    let (pressure_pa, length_m) = (point.pressure_kpa * 1e3, point.length_mm * 1e-3);
                    let inside =
                        |value: f64, [low, high]: [f64; 2]| value >= low - 1e-9 * high && value <= high * (1.0 + 1e-9);
                    assert!(inside(pressure_pa, domain.pressure_pa), "{}: {point:?}", protocol.name);
                    assert!(inside(length_m, domain.length_m), "{}: {point:?}", protocol.name);
                }
            }
        }
    }
}
