use super::*;

fn moving(speed_m_per_s: f64) -> Moment {
    let state = speed_m_per_s.signum();
    Moment { speed_m_per_s, state, dt_s: 1e-3, length_m: 0.2, force_n: 200.0, contraction: 0.1, ..Moment::default() }
}

#[test]
fn stribeck_is_whole_at_rest_and_gone_when_fast() {
    for law in [Towards::Secant, Towards::Stretched(0.6), Towards::Lagged(0.01)] {
        let mut rise = Stribeck { law, excess: 0.5, speed_m_per_s: 2e-3, followed_m_per_s: 0.0 };
        assert!((rise.friction_factor(&moving(0.0)) - 1.5).abs() < 1e-9, "{law:?}");
        let mut last = 0.0;
        for _ in 0..500 {
            last = rise.friction_factor(&moving(0.4));
        }
        assert!((last - 1.0).abs() < 1e-3, "{law:?}: {last}");
    }
}

#[test]
fn a_memory_of_speed_makes_friction_late() {
    let mut rise = Stribeck { law: Towards::Lagged(0.02), excess: 0.5, speed_m_per_s: 2e-3, followed_m_per_s: 0.0 };
    assert!(rise.friction_factor(&moving(0.01)) > 1.4);
}

#[test]
fn damping_and_load_friction_only_ever_take_work() {
    let muscle_n = |mechanism: &mut dyn Mechanism, speed| mechanism.added_n(&moving(speed)) * speed;
    for speed in [-0.05, -0.001, 0.002, 0.06] {
        for thinning in [None, Some((1e-2, 0.5))] {
            assert!(muscle_n(&mut Damping { n_s_per_m: 100.0, thinning, rest_m: 0.25 }, speed) < 0.0);
        }
        assert!(muscle_n(&mut Load::Contacts(0.05, 300.0), speed) < 0.0);
        assert!(muscle_n(&mut Load::Wound(0.1, (0.0, 0.2)), speed) < 0.0);
    }
}

#[test]
fn a_thinning_film_is_newtonian_when_slow_and_weaker_when_fast() {
    let mut film = Damping { n_s_per_m: 100.0, thinning: Some((1e-2, 0.5)), rest_m: 0.25 };
    assert!((film.added_n(&moving(1e-4)) + 1e-2).abs() < 1e-5);
    assert!(film.added_n(&moving(0.1)) > -100.0 * 0.1 * 0.4);
}

#[test]
fn rate_and_state_jump_by_the_rate_and_settle_by_both() {
    let (mut law, slow, fast) =
        (RateState { rate: 0.1, state_share: 0.4, speed_m_per_s: 1e-4, slip_m: 1e-3, followed: 0.0 }, 1e-3, 2e-2);
    let mut at =
        |speed: f64, steps: usize| (0..steps).map(|_| law.friction_factor(&moving(speed))).last().unwrap_or(0.0);
    let before = at(slow, 20_000);
    let (first, settled) = (at(fast, 1), at(fast, 2000));
    let e_folds = (fast / 1e-4_f64).ln_1p() - (slow / 1e-4_f64).ln_1p();
    assert!((first - before - 0.1 * e_folds).abs() < 0.01, "{first} {before}");
    assert!((settled - before - 0.06 * e_folds).abs() < 1e-3, "{settled} {before}");
}
