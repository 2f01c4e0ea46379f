//! A cable that stretches between drive and muscle.
//!
//! ```text
//! L_drive = L + u(F),   u(F) = F / k + u_t (1 - e^{-F/F_t})   (F > 0),   u(F) = F (1 / k + u_t / F_t)   (F ≤ 0)
//! ```
//!
//! | symbol | code         | unit | meaning                                              |
//! |--------|--------------|------|------------------------------------------------------|
//! | `u`    | `stretch_m()`| m    | stretch of the cable under a tension                 |
//! | `k`    | `stiffness_n_per_m` | N/m | stiffness when its strands have settled        |
//! | `u_t`  | `toe_m`      | m    | slack between its strands                            |
//! | `F_t`  | `toe_n`      | N    | tension over which they settle                       |
//!
//! The length of the muscle is where its tension and that of the cable are equal: a root of `L + u(F(L)) - L_drive`, which
//! grows at least as fast as `L` and so is bracketed by its own value. Friction that jumps at a reversal makes the root a jump as well: there the muscle sticks
//! while the cable takes up the change, and the tension is that of the cable. For each try the mechanisms in the cable are copied with their
//! memory; only the step that is taken is remembered.
//!
//! Source: Fung (1967), American J. Physiology 213(6), for the exponential toe of strands that straighten.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Length within which the balance is found.
const TOLERANCE_M: f64 = 1e-11;

/// Tries for one step.
const MOST_TRIES: u32 = 80;

/// The cable alone.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cable {
    compliance_m_per_n: f64,
    toe_m: f64,
    toe_n: f64,
}

impl Cable {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let (force, length) = (draw.force_scale(), draw.length_scale());
        let stretch = length / force;
        Self {
            compliance_m_per_n: draw.severe("settled_compliance", 5e-6 * stretch, 10e-6 * stretch, "m/N"),
            toe_m: draw.severe("toe", 0.8e-3 * length, 2e-3 * length, "m"),
            toe_n: draw.ratio("toe_tension", 40.0 * force, 120.0 * force, "N"),
        }
    }

    fn stretch_m(&self, tension_n: f64) -> f64 {
        let toe = if tension_n > 0.0 { -(-tension_n / self.toe_n).exp_m1() } else { tension_n / self.toe_n };
        self.compliance_m_per_n * tension_n + self.toe_m * toe
    }

    fn slope_m_per_n(&self, tension_n: f64) -> f64 {
        let toe = if tension_n > 0.0 { (-tension_n / self.toe_n).exp() } else { 1.0 };
        self.compliance_m_per_n + self.toe_m / self.toe_n * toe
    }

    /// Tension under a stretch, by Newton's method from a guess; the stretch is concave in it.
    fn tension_n(&self, stretch_m: f64, guess_n: f64) -> f64 {
        let mut tension_n = guess_n;
        for _ in 0..50 {
            let step_n = (stretch_m - self.stretch_m(tension_n)) / self.slope_m_per_n(tension_n);
            tension_n += step_n;
            if step_n.abs() < 1e-12 * tension_n.abs().max(1.0) {
                break;
            }
        }
        tension_n
    }
}

/// A muscle in its cable.
pub(crate) struct SeriesCable {
    cable: Cable,
    muscle: Vec<Box<dyn Mechanism>>,
    length_m: Option<f64>,
}

impl Clone for SeriesCable {
    fn clone(&self) -> Self {
        let muscle = self.muscle.iter().map(|link| link.duplicate()).collect();
        Self { cable: self.cable.clone(), muscle, length_m: self.length_m }
    }
}

fn act_all(chain: &mut [Box<dyn Mechanism>], muscle: &TrueMuscle, now: &mut Moment) {
    for link in chain {
        link.act(muscle, now);
    }
}

impl SeriesCable {
    pub(crate) fn new(cable: Cable, muscle: Vec<Box<dyn Mechanism>>) -> Self {
        Self { cable, muscle, length_m: None }
    }

    /// `L + u(F(L)) - L_drive` for a try.
    fn surplus_m(&self, muscle: &TrueMuscle, now: &Moment, length_m: f64) -> f64 {
        let mut chain: Vec<_> = self.muscle.iter().map(|link| link.duplicate()).collect();
        let mut trial = Moment { muscle_length_m: length_m, ..now.clone() };
        act_all(&mut chain, muscle, &mut trial);
        length_m + self.cable.stretch_m(trial.tension.total_n()) - now.drive_length_m
    }

    /// The length at which the forces are equal, or next to which the friction jumps.
    fn balance_m(&self, muscle: &TrueMuscle, now: &Moment) -> f64 {
        let start_m = self.length_m.unwrap_or(now.drive_length_m);
        let start = self.surplus_m(muscle, now, start_m);
        let (mut near, mut far) = ((start_m, start), (start_m - start, f64::NAN));
        if start.abs() < TOLERANCE_M {
            return start_m;
        }
        far.1 = self.surplus_m(muscle, now, far.0);
        if far.1 * start > 0.0 {
            return far.0;
        }
        for attempt in 0..MOST_TRIES {
            let width_m = (far.0 - near.0).abs();
            if width_m < TOLERANCE_M || near.1.abs() < TOLERANCE_M || far.1.abs() < TOLERANCE_M {
                break;
            }
            // False position, and every third time the middle, so that a jump is closed in on as well.
            let share = if attempt % 3 == 2 { 0.5 } else { near.1 / (near.1 - far.1) };
            let middle_m = near.0 + share * (far.0 - near.0);
            let value = self.surplus_m(muscle, now, middle_m);
            if value * near.1 > 0.0 { near = (middle_m, value) } else { far = (middle_m, value) }
        }
        // A root at the start itself is a muscle that sticks: it keeps its place to the last bit.
        if near.0 == start_m && (far.0 - near.0).abs() < TOLERANCE_M {
            start_m
        } else if near.1.abs() < far.1.abs() {
            near.0
        } else {
            far.0
        }
    }
}

impl Mechanism for SeriesCable {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        if self.cable.compliance_m_per_n <= 0.0 {
            act_all(&mut self.muscle, muscle, now);
            return;
        }
        let length_m = self.balance_m(muscle, now);
        self.length_m = Some(length_m);
        now.muscle_length_m = length_m;
        act_all(&mut self.muscle, muscle, now);
        let muscle_n = now.tension.total_n();
        let cable_n = self.cable.tension_n(now.drive_length_m - length_m, muscle_n);
        // What the cable does not carry, friction holds.
        now.tension.friction_n += muscle_n - cable_n;
    }

    fn begin(&mut self, seed: u64) {
        self.muscle.iter_mut().for_each(|link| link.begin(seed));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::BraidFriction;
    use crate::mechanism::moment::rig::{go, run};
    use crate::mechanism::{BraidMotion, PassiveTension};

    const CABLE: Cable = Cable { compliance_m_per_n: 8e-6, toe_m: 1e-3, toe_n: 60.0 };

    fn moments(cable: &Cable, path: &[(f64, f64)]) -> Vec<Moment> {
        let muscle: Vec<Box<dyn Mechanism>> =
            vec![Box::new(BraidMotion::new()), Box::new(PassiveTension), Box::new(BraidFriction)];
        run(vec![Box::new(SeriesCable::new(cable.clone(), muscle))], path)
    }

    fn there_and_back() -> Vec<(f64, f64)> {
        let mut path = vec![(3e5, 0.265)];
        go(&mut path, 3e5, 0.25, 300);
        go(&mut path, 3e5, 0.265, 300);
        path
    }

    #[test]
    fn cable_and_muscle_together_are_as_long_as_the_drive_says() {
        for now in moments(&CABLE, &there_and_back()) {
            let stretch_m = CABLE.stretch_m(now.tension.total_n());
            assert!((now.muscle_length_m + stretch_m - now.drive_length_m).abs() < 1e-11);
            assert!(now.muscle_length_m < now.drive_length_m);
        }
    }

    #[test]
    fn a_muscle_that_slides_pulls_what_its_length_and_friction_say() {
        let moments = moments(&CABLE, &there_and_back());
        for index in [200, 550] {
            let now = &moments[index];
            let direction = if index < 300 { 1.0 } else { -1.0 };
            let expected_n = TrueMuscle::nominal().force_n(3e5, now.muscle_length_m, direction);
            assert!((now.tension.total_n() - expected_n).abs() < 1e-4);
        }
    }

    #[test]
    fn a_reversal_is_taken_up_by_the_cable_while_the_muscle_sticks() {
        let moments = moments(&CABLE, &there_and_back());
        assert_eq!(moments[302].muscle_length_m, moments[301].muscle_length_m);
        let largest_n = moments[300..]
            .windows(2)
            .map(|pair| (pair[1].tension.total_n() - pair[0].tension.total_n()).abs())
            .fold(0.0, f64::max);
        // 50 µm of drive at no more than the stiffness of the cable; nothing jumps by twice the friction.
        assert!(largest_n < 50e-6 / 8e-6, "{largest_n}");
    }

    #[test]
    fn a_cable_gets_stiffer_with_its_tension_and_its_inverse_is_its_inverse() {
        assert!(CABLE.slope_m_per_n(300.0) < 0.5 * CABLE.slope_m_per_n(10.0));
        for tension_n in [-20.0, 0.0, 5.0, 100.0, 800.0] {
            assert!((CABLE.tension_n(CABLE.stretch_m(tension_n), 50.0) - tension_n).abs() < 1e-9);
        }
    }
}
