//! Which protocols are recorded, and how long each takes.

use crate::draw::Dice;
use crate::protocol::Kind;
use crate::world::Demands;

/// Protocols that a plan is drawn from.
pub struct Kinds {
    /// One of each is in a plan that excites everything.
    pub telling: [&'static [Kind]; 2],
    /// Any protocol.
    pub any: fn(&mut Dice) -> Kind,
    /// What is held out as a rule.
    pub held_out: fn(&mut Dice) -> Kind,
    /// The longest that a recording takes as a rule, s.
    pub longest_s: f64,
}

/// Protocols and durations in s, estimation first, and how many are for estimation.
pub fn draw(dice: &mut Dice, demands: &Demands, rate_hz: f64, from: &Kinds) -> (Vec<(Kind, f64)>, usize) {
    let rich = dice.chance(0.8) || !demands.wants.is_empty() && dice.chance(0.3);
    let count = if rich { dice.between(3, if demands.slow { 4 } else { 6 }) } else { dice.between(1, 2) };
    let mut kinds: Vec<Kind> = Vec::new();
    if !demands.wants.is_empty() {
        kinds.push(*dice.pick(&demands.wants));
    }
    if rich {
        // Enough excitation: both pressure and length vary widely.
        kinds.extend(from.telling.map(|telling| *dice.pick(telling)));
    }
    while kinds.len() < count {
        let kind = (from.any)(dice);
        if !kinds.contains(&kind) || dice.chance(0.2) {
            kinds.push(kind);
        }
    }
    kinds.truncate(count);
    dice.shuffle(&mut kinds);
    let estimation = kinds.len();
    kinds.push(if dice.chance(0.6) { (from.held_out)(dice) } else { (from.any)(dice) });
    if dice.chance(0.5) {
        kinds.push((from.any)(dice));
    }
    let rows = if demands.slow { 14_000.0 } else { 12_000.0 };
    let plan = kinds
        .into_iter()
        .map(|kind| {
            let drawn_s = if demands.slow {
                dice.log_uniform(90.0, 360.0)
            } else {
                match dice.weighted(&[0.1, 0.78, 0.12]) {
                    0 => dice.uniform(10.0, 30.0),
                    1 => dice.uniform(30.0, 90.0),
                    _ => dice.log_uniform(90.0, from.longest_s),
                }
            };
            (kind, drawn_s.min(rows / rate_hz).max(10.0).round())
        })
        .collect();
    (plan, estimation)
}
