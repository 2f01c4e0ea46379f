//! Protocols in which a load decides where the muscle goes.

use super::Setting;
use crate::path::{Path, Take};
use crate::reach::rising_root;

/// Time between knots.
const KNOT_STEP_S: f64 = 0.01;

/// P11: pressure triangles at 25 kPa/s under four constant loads; the length follows from the balance of
/// forces, and stands still at each reversal until the pressure has changed by what friction holds.
pub(super) fn isotonic(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let muscle = reach.muscle();
    let (cycles, stretch) = setting.pace.cycles(2);
    let (long_m, short_m) = (reach.length_m(0.0), reach.length_m(0.21));
    let mut takes = Vec::new();
    for load_n in [20.0, 60.0, 120.0, 250.0].map(|newtons| reach.force_n(newtons)) {
        let balance_pa = |length_m| {
            rising_root(
                |pressure_pa| muscle.force_n(pressure_pa, length_m, 1.0) - load_n,
                0.0,
                reach.highest_pressure_pa(),
            )
        };
        let (low_pa, high_pa) = (balance_pa(long_m), balance_pa(short_m));
        if high_pa <= low_pa {
            continue;
        }
        let mut path = Path::from(low_pa, long_m);
        let duration_s = (high_pa - low_pa) / (reach.pressure_pa(25.0) / stretch);
        for (from_pa, to_pa) in [(low_pa, high_pa), (high_pa, low_pa)].repeat(cycles as usize) {
            let mut length_m = path.length_m();
            path.follow(duration_s, KNOT_STEP_S, |time_s| {
                let pressure_pa = from_pa + (to_pa - from_pa) * (time_s / duration_s).min(1.0);
                let surplus_n = |length_m, direction| muscle.force_n(pressure_pa, length_m, direction) - load_n;
                if surplus_n(length_m, 1.0) > 0.0 {
                    length_m = rising_root(|length_m| surplus_n(length_m, 1.0), short_m, length_m);
                } else if surplus_n(length_m, -1.0) < 0.0 {
                    length_m = rising_root(|length_m| surplus_n(length_m, -1.0), length_m, long_m);
                }
                (pressure_pa, length_m)
            });
        }
        takes.push(path.take(5.0));
    }
    takes
}

/// The elbow of the exoskeleton: the muscle spans the two sides of a triangle about the joint.
mod elbow {
    /// Joint to upper end of the muscle, in m.
    const UPPER_M: f64 = 0.165;
    /// Joint to lower end of the muscle, in m.
    const LOWER_M: f64 = 0.21;
    /// Joint to payload, in m.
    const LOAD_ARM_M: f64 = 0.30;
    /// Acceleration of free fall, in m/s².
    const GRAVITY_M_PER_S2: f64 = 9.81;
    /// Angle to which the elbow lifts, in rad.
    const LIFT_RAD: f64 = 0.3;

    /// Angle at a share of the lift's duration: rest to rest without a jump in acceleration.
    pub(super) fn angle_rad(share: f64) -> f64 {
        LIFT_RAD * share.powi(3) * (10.0 - 15.0 * share + 6.0 * share * share)
    }

    /// Length of the muscle, in m, by the law of cosines; the angle is counted from horizontal.
    fn muscle_length_m(angle_rad: f64) -> f64 {
        (UPPER_M * UPPER_M + LOWER_M * LOWER_M - 2.0 * UPPER_M * LOWER_M * angle_rad.sin()).sqrt()
    }

    /// Contraction of a muscle that is at rest length at angle zero.
    pub(super) fn contraction_ratio(angle_rad: f64) -> f64 {
        1.0 - muscle_length_m(angle_rad) / muscle_length_m(0.0)
    }

    /// Force of the muscle, in N, that holds half of a payload: one arm of two.
    pub(super) fn force_n(payload_kg: f64, angle_rad: f64) -> f64 {
        let torque_n_m = 0.5 * payload_kg * GRAVITY_M_PER_S2 * LOAD_ARM_M * angle_rad.cos();
        let moment_arm_m = UPPER_M * LOWER_M * angle_rad.cos() / muscle_length_m(angle_rad);
        torque_n_m / moment_arm_m
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn validates_against_published_lengths_and_forces() {
            assert!((muscle_length_m(0.0) - 0.26707).abs() < 1e-5);
            assert!((muscle_length_m(0.3) - 0.22549).abs() < 1e-5);
            assert!((force_n(5.0, 0.0) - 56.7).abs() < 0.05);
            assert!((force_n(5.0, 0.3) - 47.9).abs() < 0.05);
        }
    }
}

/// The elbow lifts 5, 2.5 and 7.5 kg from 0 to 0.3 rad in 5 s and lowers them again; the pressure is what
/// the load needs between the two directions of friction.
pub(super) fn lift(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let muscle = reach.muscle();
    let rise_s = setting.pace.duration_s(5.0);
    let hold_s = setting.pace.duration_s(1.0);
    let state = |payload_kg: f64, share: f64| {
        let angle_rad = elbow::angle_rad(share);
        let length_m = reach.length_m(elbow::contraction_ratio(angle_rad));
        let load_n = reach.force_n(elbow::force_n(payload_kg, angle_rad));
        let pressure_pa = rising_root(
            |pressure_pa| muscle.force_n(pressure_pa, length_m, 0.0) - load_n,
            0.0,
            reach.highest_pressure_pa(),
        );
        (pressure_pa, length_m)
    };
    let mut path: Option<Path> = None;
    for payload_kg in [5.0, 2.5, 7.5] {
        let (pressure_pa, length_m) = state(payload_kg, 0.0);
        let path = path.get_or_insert_with(|| Path::from(pressure_pa, length_m));
        path.go_to(pressure_pa, length_m, if path.pressure_pa() == pressure_pa { 0.0 } else { hold_s });
        path.follow(rise_s, KNOT_STEP_S, |time_s| state(payload_kg, (time_s / rise_s).min(1.0)));
        path.hold(hold_s);
        path.follow(rise_s, KNOT_STEP_S, |time_s| state(payload_kg, (1.0 - time_s / rise_s).max(0.0)));
        path.hold(hold_s);
    }
    path.map(|path| path.take(0.0)).into_iter().collect()
}
