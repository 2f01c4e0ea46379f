use super::*;

fn si(name: &str, value: f64) -> f64 {
    match Name::read(name) {
        Name::Channel(_, unit) => unit.si(value),
        other => panic!("{name}: {other:?}"),
    }
}

#[test]
fn every_unit_converts_to_si() {
    let table = [
        ("time_s", 2.0, 2.0),
        ("time_ms", 2.0, 0.002),
        ("time_us", 2.0, 2e-6),
        ("pressure_Pa", 2.0, 2.0),
        ("pressure_kPa", 2.0, 2e3),
        ("pressure_MPa", 2.0, 2e6),
        ("pressure_bar", 2.0, 2e5),
        ("length_m", 2.0, 2.0),
        ("length_cm", 2.0, 0.02),
        ("length_mm", 159.5, 0.1595),
        ("length_in", 2.0, 0.0508),
        ("force_N", 2.0, 2.0),
        ("force_kN", 2.0, 2e3),
        ("force_lbf", 2.0, 8.896_443_230_521),
        ("force_kgf", 2.0, 19.6133),
        ("temperature_C", 20.0, 293.15),
        ("temperature_K", 20.0, 20.0),
    ];
    for (name, value, expected) in table {
        assert_eq!(si(name, value), expected, "{name}");
        assert_eq!(si(&name.to_ascii_uppercase(), value), expected, "{name}");
    }
    // NIST SP 811, appendix B: 1 psi = 6894.757 Pa.
    assert!((si("pressure_psi", 1.0) - 6_894.757_293_168_361).abs() < 1e-9);
}

#[test]
fn names_near_a_quantity_are_told_from_other_columns() {
    for (name, right) in [
        ("presure_kPa", "pressure_kPa"),
        ("presure_bar", "pressure_bar"),
        ("lenght_mm", "length_mm"),
        ("forze_N", "force_N"),
        ("tempreature_C", "temperature_C"),
        ("tiem", "time_s"),
    ] {
        assert!(matches!(Name::read(name), Name::Misspelt(_, suggestion) if suggestion == right), "{name}");
    }
    for name in
        ["state_1inflate_2deflate", "torque_Nm", "valve", "source", "tare_N", "ai0", "", "_", "pressure_set_kPa"]
    {
        assert_eq!(Name::read(name), Name::Other, "{name}");
    }
    for (name, value, expected) in
        [("Druck [bar]", 2.0, 2e5), ("Force (kN)", 2.0, 2e3), ("Länge[mm]", 2.0, 0.002), ("Zeit_ms", 2.0, 0.002)]
    {
        assert_eq!(si(name, value), expected, "{name}");
    }
    assert_eq!(si("Temperatur [°C]", 20.0), 293.15);
    for name in ["Weg [mm]", "Druck Soll [bar]", "P [V]"] {
        assert_eq!(Name::read(name), Name::Other, "{name}");
    }
    assert_eq!(Name::read("Kraft [V]"), Name::UnitUnknown(Quantity::Force, "V".to_owned()));
    assert_eq!(Name::read("force_Nm"), Name::UnitUnknown(Quantity::Force, "Nm".to_owned()));
    assert_eq!(Name::read("Force"), Name::UnitMissing(Quantity::Force));
}
