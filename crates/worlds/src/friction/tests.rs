use super::*;

fn elements() -> Vec<Element> {
    vec![
        Element::Stop { reach_m: 2e-5, state: 0.0 },
        Element::Dahl { reach_m: 1e-3, state: 0.0 },
        Element::LuGre { reach_m: 1e-3, damping_s: 1e-3, state: 0.0, rate: 0.0 },
        Element::slip(&[2e-4, 8e-4, 3e-3], &[1.0, 2.0, 1.0], 0.0),
        Element::BoucWen { reach_m: 1e-3, exponent: 1.5, beta: 0.6, state: 0.0 },
        Element::Shaped { shape: Shape::Endochronic(0.7), reach_m: 1e-3, state: 0.0 },
    ]
}

#[test]
fn every_element_slides_at_its_limit_in_both_directions() {
    for mut element in elements() {
        for _ in 0..2000 {
            element.step(2e-5, 1e-3);
        }
        assert!((element.state() - 1.0).abs() < 0.02, "{element:?}");
        for _ in 0..2000 {
            element.step(-2e-5, 1e-3);
        }
        assert!((element.state() + 1.0).abs() < 0.02, "{element:?}");
    }
}

#[test]
fn a_closed_loop_never_gives_work_back() {
    for mut element in elements() {
        let mut work = 0.0;
        for step in 0..40_000 {
            let travel_m = 3e-5 * (f64::from(step) * 0.005).cos();
            element.step(travel_m, 1e-3);
            work += element.state() * travel_m;
        }
        assert!(work > 0.0, "{element:?}: {work}");
    }
}

#[test]
fn at_standstill_only_the_chosen_law_moves_the_friction() {
    let amplitude = Amplitude { by_surface: 1e-3, by_contact: 0.0, constant_n: 0.0, asymmetry: 0.0 };
    let after = |standstill, rise_pa: f64| {
        let element = Element::Stop { reach_m: 2e-5, state: -1.0 };
        let mut friction = Friction { amplitude, element, standstill };
        for _ in 0..100 {
            friction.step(0.0, rise_pa / 100.0, 1e-3);
        }
        friction.element.state()
    };
    assert_eq!(after(Standstill::Held, 5e4), -1.0);
    assert_eq!(after(Standstill::FollowsPressure, 5e4), 1.0);
    assert!((after(Standstill::SlidesAfter(2e4), 1e4) + 0.5).abs() < 1e-9);
    assert!((after(Standstill::GivesPartly { reach_pa: 1e4, most: 0.4 }, 5e4) - 0.4).abs() < 1e-9);
    let late = Standstill::GivesLate { band_pa: 5e3, reach_pa: 1e4, place_pa: 0.0 };
    assert_eq!(after(late, 4e3), -1.0);
    assert!((after(late, 1e4) + 0.5).abs() < 1e-9);
}
