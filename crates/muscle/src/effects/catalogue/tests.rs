use std::collections::BTreeSet;

use rand::{RngExt, SeedableRng};

use super::super::moment::tests::{base, still};
use super::super::sentence::Driver;
use super::super::{Base, Kind, Moment, Page, Role, Seen};
use super::*;
use crate::geometry::tests::nominal;

/// Of the virtual bench.
const PROTOCOLS: [&str; 14] = [
    "null",
    "run-in",
    "isobaric-triangles",
    "rate-ladder",
    "minor-loops",
    "isometric-ramps",
    "length-steps",
    "pressure-steps",
    "pressure-chirp",
    "length-chirp",
    "multisine",
    "isotonic",
    "endurance",
    "dwell",
];

/// Where recordings of a muscle at work have been.
pub(super) fn seen() -> Seen {
    Seen {
        contraction_ratio: (0.0, 0.25),
        pressure_pa: (0.0, 5e5),
        force_n: (-0.5, 800.0),
        warmth_k: (0.0, 0.0),
        duration_s: 120.0,
    }
}

/// Every shape that a fit begins with, and the first and last of the grids.
fn shapes_of(effect: &dyn Effect) -> Vec<Vec<f64>> {
    let mut shapes = effect.first_shapes(&seen());
    shapes.push(effect.shape().iter().map(|shape| shape.grid[0]).collect());
    shapes.push(effect.shape().iter().map(|shape| shape.grid[shape.grid.len() - 1]).collect());
    shapes
}

#[test]
fn every_id_is_there_once_in_the_order_of_kinds() {
    let ids: BTreeSet<&str> = CATALOGUE.iter().map(|effect| effect.page().id).collect();
    assert_eq!(CATALOGUE.len(), ids.len());
    assert!(CATALOGUE.is_sorted_by_key(|effect| effect.kind()));
    for id in ids {
        assert!(id.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'-'), "{id}");
        assert_eq!(effect(id).map(|effect| effect.page().id), Some(id));
    }
    assert!(effect("gearbox").is_none());
}

#[test]
fn every_page_is_complete_and_names_what_exists() {
    for effect in CATALOGUE {
        let page = effect.page();
        let texts = [
            page.name,
            page.summary,
            page.equation,
            page.validity,
            page.source,
            page.signature,
            page.test,
            page.protocol,
        ];
        assert!(texts.iter().all(|text| !text.trim().is_empty()), "{}", page.id);
        assert!(!page.symbols.is_empty() && !page.confused_with.is_empty(), "{}", page.id);
        assert!(PROTOCOLS.contains(&page.protocol), "{}: {}", page.id, page.protocol);
        for symbol in page.symbols {
            assert!(![symbol.symbol, symbol.unit, symbol.meaning].contains(&""), "{}: {symbol:?}", page.id);
        }
        let ids: BTreeSet<&str> = page.confused_with.iter().map(|confusion| confusion.id).collect();
        assert_eq!(ids.len(), page.confused_with.len(), "{}", page.id);
        for confusion in page.confused_with {
            assert!(
                CATALOGUE.iter().any(|known| known.page().id == confusion.id) && confusion.id != page.id,
                "{}: {}",
                page.id,
                confusion.id
            );
            assert!(!confusion.because.is_empty() && !confusion.test.is_empty(), "{}", page.id);
        }
    }
}

#[test]
fn parameter_names_end_in_their_unit() {
    let suffixes = [
        ("s", "_s"),
        ("m", "_m"),
        ("m/s", "_m_per_s"),
        ("m/N", "_m_per_n"),
        ("N", "_n"),
        ("N/s", "_n_per_s"),
        ("N s/m", "_n_s_per_m"),
        ("Pa", "_pa"),
        ("kg", "_kg"),
        ("Hz", "_hz"),
        ("1/N", "_per_n"),
        ("1/K", "_per_kelvin"),
        ("1/s", "_per_s"),
    ];
    for effect in CATALOGUE {
        let id = effect.page().id;
        let shapes = effect.shape().iter().map(|shape| (shape.name, shape.unit, shape.range));
        let amplitudes = effect.amplitudes().iter().map(|amplitude| (amplitude.name, amplitude.unit, amplitude.range));
        let parameters: Vec<_> = shapes.chain(amplitudes).collect();
        for &(name, unit, (lowest, highest)) in &parameters {
            assert!(name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_'), "{id}: {name}");
            if unit != "1" {
                let suffix = suffixes.iter().find(|(known, _)| *known == unit).map(|(_, suffix)| *suffix);
                assert!(suffix.is_some_and(|suffix| name.ends_with(suffix)), "{id}: {name} in {unit}");
            }
            assert!(lowest < highest, "{id}: {name}");
        }
        let names: BTreeSet<&str> = parameters.iter().map(|(name, ..)| *name).collect();
        assert_eq!(names.len(), parameters.len(), "{id}");
    }
}

#[test]
fn every_effect_has_a_typical_size_within_what_physics_allows() {
    for effect in CATALOGUE {
        let (id, typical) = (effect.page().id, effect.page().typical);
        assert_eq!(typical.amplitudes.len(), effect.amplitudes().len(), "{id}");
        for (size, amplitude) in typical.amplitudes.iter().zip(effect.amplitudes()) {
            assert!((amplitude.range.0..=amplitude.range.1).contains(size), "{id}");
        }
        assert!(!typical.shapes.is_empty() || effect.kind() == Kind::Event, "{id}");
        for shape in typical.shapes {
            assert_eq!(shape.len(), effect.shape().len(), "{id}");
            for (value, parameter) in shape.iter().zip(effect.shape()) {
                assert!((parameter.range.0..=parameter.range.1).contains(value), "{id}: {}", parameter.name);
            }
        }
    }
}

#[test]
fn drivers_and_regions_of_a_page_exist_and_stand_there_once() {
    let (above_m_per_s, above_pa_per_s) = (0.01, 1e4);
    let known = [
        Driver::Pressure,
        Driver::Contraction,
        Driver::Speed,
        Driver::Force,
        Driver::Time,
        Driver::TravelSinceReversal,
        Driver::TimeSinceLastMove { above_m_per_s, above_pa_per_s },
        Driver::TimeSincePressureMoved { above_pa_per_s },
        Driver::Cycle,
    ]
    .map(|driver| driver.name());
    for effect in CATALOGUE {
        let Page { id, drivers, regions, .. } = effect.page();
        assert!(!drivers.is_empty() && drivers.iter().all(|driver| known.contains(driver)), "{id}: {drivers:?}");
        assert_eq!(drivers.iter().collect::<BTreeSet<_>>().len(), drivers.len(), "{id}");
        assert_eq!(regions.iter().map(|region| region.name()).collect::<BTreeSet<_>>().len(), regions.len(), "{id}");
    }
}

#[test]
fn grids_and_amplitudes_fit_their_roles() {
    for effect in CATALOGUE {
        let id = effect.page().id;
        assert!(effect.shape().len() <= 3, "{id}");
        assert_eq!(effect.amplitudes().is_empty(), effect.role() != Role::Pulls, "{id}");
        for shape in effect.shape() {
            assert!((1..=7).contains(&shape.grid.len()) && shape.grid.is_sorted(), "{id}: {}", shape.name);
            assert!(shape.grid.iter().all(|value| (shape.range.0..=shape.range.1).contains(value)), "{id}");
        }
        for amplitude in effect.amplitudes() {
            assert!(amplitude.range.0 <= 0.0 && amplitude.range.1 > 0.0, "{id}: zero must be allowed");
        }
        for values in shapes_of(*effect) {
            assert_eq!(values.len(), effect.shape().len(), "{id}");
            for (value, shape) in values.iter().zip(effect.shape()) {
                assert!((shape.range.0..=shape.range.1).contains(value), "{id}: {} = {value}", shape.name);
            }
        }
    }
}

/// Friction that is there at rest: with the direction in which the muscle came.
const OF_DIRECTION: [&str; 3] = ["rubber-hysteresis", "stribeck", "load-dependent-friction"];

#[test]
fn a_settled_muscle_shows_no_dynamic_effect() {
    for effect in CATALOGUE {
        let id = effect.page().id;
        let is_dynamic = !effect.is_static() && effect.kind() != Kind::Event && !OF_DIRECTION.contains(&id);
        for shape in shapes_of(*effect) {
            let mut memory = effect.start(&nominal(), &shape);
            let mut columns = vec![f64::NAN; effect.amplitudes().len()];
            memory.pulls(&still(), &base(), &mut columns);
            if is_dynamic {
                assert!(columns.iter().all(|column| column.abs() < 1e-12), "{id}: {columns:?}");
            }
            // It stays so as long as nothing moves, whatever the clock says of other effects than a drift.
            let later = Moment { time_s: 50.0, step_s: 50.0, ..still() };
            memory.pulls(&later, &base(), &mut columns);
            if is_dynamic && id != "force-drift" {
                assert!(columns.iter().all(|column| column.abs() < 1e-12), "{id}: {columns:?}");
            }
            let slides = memory.slides(&still());
            assert!((slides - still().direction).abs() < 1e-12, "{id}: {slides}");
            let mut seen = still();
            effect.start(&nominal(), &shape).sees(&mut seen);
            if effect.kind() == Kind::Muscle && !effect.is_static() {
                assert_eq!(seen, still(), "{id}");
            }
        }
    }
}

#[test]
fn every_memory_is_finite_along_a_random_path() {
    let muscle = nominal();
    let mut generator = rand_pcg::Pcg64::seed_from_u64(7);
    for effect in CATALOGUE {
        for shape in shapes_of(*effect) {
            let mut memory = effect.start(&muscle, &shape);
            let mut columns = vec![0.0; effect.amplitudes().len()];
            let mut time_s = 0.0;
            for index in 0..300 {
                let gap = index % 100 == 0;
                // From a tenth of a millisecond to minutes.
                let step_s = if gap { 0.0 } else { 10.0_f64.powf(generator.random_range(-4.0..2.0)) };
                time_s += if gap && index > 0 { 30.0 } else { step_s };
                let contraction_ratio = generator.random_range(-0.02..0.3);
                let pressure_pa = generator.random_range(-2e3..6e5);
                let mut now = Moment {
                    recording: 0,
                    time_s,
                    step_s,
                    pressure_pa,
                    pressure_rate_pa_per_s: 0.0,
                    length_m: muscle.length_m(contraction_ratio),
                    contraction_ratio,
                    speed_m_per_s: generator.random_range(-0.5..0.5),
                    slide_speed_m_per_s: generator.random_range(-0.1..0.1),
                    acceleration_m_per_s2: generator.random_range(-50.0..50.0),
                    direction: [-1.0, 0.0, 1.0][index % 3],
                    came: index % 2 == 0,
                    slide_m: generator.random_range(-0.01..0.1),
                    rest_slide_m: generator.random_range(-1e-3..1e-3),
                    force_n: generator.random_range(-50.0..900.0),
                    warmth_k: generator.random_range(-5.0..30.0),
                };
                memory.sees(&mut now);
                let slides = memory.slides(&now);
                columns.fill(f64::NAN);
                memory.pulls(&now, &base(), &mut columns);
                let reads_n = memory.reads(now.force_n);
                let _ = memory.cuts(now.force_n);
                let id = effect.page().id;
                assert!(now.pressure_pa.is_finite() && now.length_m.is_finite(), "{id}");
                assert!(slides.abs() <= 1.0 + 1e-12 && reads_n.is_finite(), "{id}");
                assert!(columns.iter().all(|column| column.is_finite()), "{id}: {columns:?}");
            }
        }
    }
}

#[test]
fn without_a_muscle_to_pull_there_is_little_to_add() {
    // Force derived from eq. 11 alone vanishes with it.
    for id in ["stribeck", "load-dependent-friction", "pressure-creep", "fatigue-wear", "thermal-softening"] {
        let effect = effect(id).expect("an id of the catalogue");
        let mut memory = effect.start(&nominal(), &shapes_of(effect)[0]);
        let mut columns = vec![f64::NAN; effect.amplitudes().len()];
        for step_s in [0.0, 1.0] {
            memory.pulls(
                &Moment { step_s, time_s: step_s, speed_m_per_s: 0.1, ..still() },
                &Base::default(),
                &mut columns,
            );
            assert!(columns.iter().all(|column| column.abs() < 1e-12), "{id}: {columns:?}");
        }
    }
}
