use super::*;

fn region() -> Region {
    Region {
        taut: (0..41).map(|index| -0.003 + 0.006 * f64::from(index)).collect(),
        highest_pa: 4e5,
        least: -0.003,
        cycling: false,
        most: 0.2,
        rest_m: 0.25,
        fastest_m_per_s: 0.06,
        highest_hz: 5.0,
        bandwidths_hz: (8.0, 5.0),
        regulator: None,
        hang: None,
    }
}

#[test]
fn every_protocol_stays_in_its_region_and_lasts_as_long_as_asked() {
    let region = region();
    for kind in KINDS.into_iter().chain(sealed::protocol::KINDS) {
        let path = path(kind, 30.0, 2.5e-3, &mut Dice::new(1, 1), &region);
        assert_eq!(path.length_m.len(), 12_001, "{kind:?}");
        for (&pressure_pa, &length_m) in path.pressure_pa.iter().zip(&path.length_m) {
            assert!((-1.0..4.05e5).contains(&pressure_pa), "{kind:?}: {pressure_pa}");
            assert!((0.2 * 0.25 * 0.99..0.252).contains(&length_m) && length_m > 0.199, "{kind:?}: {length_m}");
        }
    }
}

#[test]
fn a_path_has_no_jumps() {
    let region = region();
    for kind in KINDS.into_iter().chain(sealed::protocol::KINDS) {
        let path = path(kind, 30.0, 2.5e-3, &mut Dice::new(2, 1), &region);
        for pair in path.length_m.windows(2) {
            assert!((pair[1] - pair[0]).abs() < 1.5e-3, "{kind:?}");
        }
    }
}
