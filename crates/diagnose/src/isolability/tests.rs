use super::*;
use crate::rehearsal::tests::Given;

fn of(protocols: &[&str]) -> Isolability {
    let given = Given::of(protocols, &[]);
    let setting = given.setting();
    let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
    isolability(&setting, &state, 0.3, 0.2 * given.track.n() as f64)
}

fn cosine(found: &Isolability, left: &str, right: &str) -> f64 {
    let index = |id: &str| found.ids.iter().position(|known| known == id).expect("an id");
    found.cosine[index(left)][index(right)]
}

fn visible_n(found: &Isolability, id: &str) -> f64 {
    found.visible_n[found.ids.iter().position(|known| known == id).expect("an id")]
}

/// In a synthetic study damping and a late length are one group in an isobaric sweep, at 0.995.
#[test]
fn damping_and_a_late_channel_look_alike_in_an_isobaric_sweep() {
    let sweep = of(&["length-chirp"]);
    assert!(cosine(&sweep, "viscous-damping", "channel-delay") > 0.85);
    assert!(cosine(&sweep, "viscous-damping", "presliding-hysteresis") < 0.7);
    // An isometric sweep moves nothing that damping could act on.
    let isometric = of(&["pressure-chirp"]);
    assert!(visible_n(&isometric, "channel-delay") > 1.0);
    assert!(visible_n(&isometric, "viscous-damping") < 1e-6);
    assert_eq!(cosine(&isometric, "viscous-damping", "channel-delay"), 0.0);
}

#[test]
fn a_lag_and_a_delay_look_alike_in_slow_ramps() {
    let ramps = of(&["isometric-ramps"]);
    assert!(cosine(&ramps, "pressure-lag", "channel-delay") > 0.95);
    assert!(cosine(&ramps, "pressure-lag", "presliding-hysteresis") < 0.7);
}

#[test]
fn a_matrix_is_symmetric_and_the_same_on_any_number_of_threads() {
    let given = Given::of(&["multisine"], &[]);
    let setting = given.setting();
    let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| isolability(&setting, &state, 0.3, 1000.0))
    };
    let found = run(1);
    assert_eq!(found, run(2));
    for (i, row) in found.cosine.iter().enumerate() {
        assert_eq!(row[i], 1.0);
        for (j, value) in row.iter().enumerate() {
            assert_eq!(value.to_bits(), found.cosine[j][i].to_bits());
            assert!((0.0..=1.0).contains(value));
        }
    }
}

/// In a synthetic study random pressure and length leave damping and a late length (0.98), lag and delay of the pressure
/// (0.97).
#[test]
fn of_a_random_path_the_known_groups_are_left() {
    let random = of(&["multisine"]);
    assert!(cosine(&random, "viscous-damping", "channel-delay") > 0.9);
    assert!(cosine(&random, "pressure-lag", "channel-delay") > 0.9);
    assert!(cosine(&random, "fatigue-wear", "force-drift") > 0.9);
    for other in ["viscous-damping", "channel-delay", "viscoelastic-relaxation", "threshold-pressure", "braid-lockup"] {
        assert!(cosine(&random, "presliding-hysteresis", other) < 0.7, "{other}");
    }
    assert!(visible_n(&random, "presliding-hysteresis") > 1.0);
}

#[test]
fn what_the_noise_covers_is_like_nothing() {
    let random = of(&["multisine"]);
    assert!(visible_n(&random, "inertia") < 0.06);
    let index = random.ids.iter().position(|id| id == "inertia").expect("an id");
    assert_eq!(random.cosine[index].iter().filter(|&&cosine| cosine != 0.0).count(), 1);
}
