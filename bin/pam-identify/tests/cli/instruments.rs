//! Instruments that are wrong, and files that say how to read them.

use crate::bench::{Bench, TAIL, reworked, shipped};

#[test]
fn an_absolute_gauge_and_a_zero_that_is_off_are_named_beside_the_physics_that_does_the_same() {
    let bench = Bench::new();
    for (shift_kpa, words) in
        [(101.3, "the pressure is absolute"), (40.0, "the zero of the gauge is too high"), (-20.0, "too low")]
    {
        bench.file("shifted.csv", reworked(|_, [t, p, l, f]| [t, p + shift_kpa, l, f]));
        let output = bench.run(&format!("shifted.csv {TAIL}"));
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains(words), "{shift_kpa}: {said}");
        assert_eq!(said.contains("threshold pressure"), shift_kpa > 0.0, "{said}");
    }
}

#[test]
fn a_spike_is_located_and_does_not_count_and_one_beyond_everything_is_refused() {
    let bench = Bench::new();
    let with_spike = |by_n: f64| reworked(move |row, [t, p, l, f]| [t, p, l, if row == 4000 { f + by_n } else { f }]);
    bench.file("high.csv", with_spike(5000.0));
    let said = bench.refusal(&format!("high.csv {TAIL}"));
    assert!(
        said.contains("high.csv: force leaps from its neighbors and back: 6118.720 N at 40.000 s")
            && said.contains("(row 4001)"),
        "{said}"
    );
    let rmse = |log: &str| {
        let output = bench.run(&format!("{log} {TAIL}"));
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let (model, _) = pam_artifact::ModelArtifact::read(&bench.folder.path().join("model.json")).unwrap();
        (model.fit.estimation, model.warnings)
    };
    let (clean, _) = rmse("good.csv");
    bench.file("low.csv", with_spike(300.0));
    let (spiked, warnings) = rmse("low.csv");
    assert!((spiked.rmse_n - clean.rmse_n).abs() < 0.01, "{} {}", spiked.rmse_n, clean.rmse_n);
    assert_eq!(spiked.n_unsettled, clean.n_unsettled + 1);
    assert!(
        warnings.iter().any(|words| words.contains("low.csv: a sample leaps") && words.contains("(row 4001)")),
        "{warnings:?}"
    );
}

#[test]
fn a_force_that_freezes_half_way_is_refused_with_the_time() {
    let bench = Bench::new();
    let at = std::cell::Cell::new(0.0);
    let text = reworked(|row, [t, p, l, f]| {
        if row <= 4700 {
            at.set(f);
        }
        [t, p, l, at.get()]
    });
    bench.file("frozen.csv", text);
    let said = bench.refusal(&format!("frozen.csv {TAIL}"));
    assert!(said.contains("frozen.csv: force stands at ") && said.contains("it froze"), "{said}");
}

#[test]
fn a_unit_under_the_name_of_another_is_named() {
    let bench = Bench::new();
    for (pressure, force, words) in [
        (1.0 / 6.895, 1.0, "psi under a header that says kPa is a factor of 6.895"),
        (1.0, 1.0 / 4.448, "lbf under a header that says N is a factor of 4.448"),
        (1.0, 1.0 / 9.807, "kgf under a header that says N is a factor of 9.807"),
    ] {
        bench.file("unit.csv", reworked(|_, [t, p, l, f]| [t, pressure * p, l, force * f]));
        let said = bench.refusal(&format!("unit.csv {TAIL}"));
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn the_same_recording_twice_is_known_by_its_samples() {
    let bench = Bench::new();
    let good = bench.folder.path().join("good.csv");
    std::fs::hard_link(&good, bench.folder.path().join("link.csv")).unwrap();
    let units = reworked(|_, [t, p, l, f]| [t, p / 100.0, l / 25.4, f]);
    bench.file("units.csv", units.replace("pressure_kPa,length_mm", "pressure_bar,length_in"));
    let part: Vec<String> = reworked(|_, row| row).lines().take(4000).map(str::to_owned).collect();
    bench.file("part.csv", part.join("\n"));
    for name in ["link.csv", "units.csv", "part.csv", "./good.csv"] {
        let fitted = bench.refusal(&format!("good.csv {name} {TAIL}"));
        assert!(
            fitted.contains(&format!("{name}: has the same samples as good.csv, which is fitted as well")),
            "{fitted}"
        );
        let held_out = bench.refusal(&format!("good.csv --holdout {name} {TAIL}"));
        assert!(
            held_out.contains(&format!("{name}: has the same samples as good.csv, which is fitted;")),
            "{held_out}"
        );
    }
}

/// The good recording without a header, in volts as the example of a channels file has it.
fn in_volts() -> String {
    shipped("isobaric-triangles.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let mut fields = line.split(',').map(|field| field.parse::<f64>().unwrap());
            let [t, p, l, f] = [(); 4].map(|()| fields.next().unwrap());
            format!("{t},{},{l},{}\n", (p + 125.0) / 250.0, f / 100.0)
        })
        .collect()
}

#[test]
fn the_example_of_a_channels_file_reads_volts_without_a_header() {
    let bench = Bench::new();
    assert_eq!(bench.run("--example=channels --out bench.toml").status.code(), Some(0));
    bench.file("volts.csv", in_volts());
    let output = bench.run("volts.csv --muscle m.toml --channels bench.toml --out model.json --quiet --starts 1");
    let model: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(bench.folder.path().join("model.json")).unwrap()).unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let roles: Vec<&str> =
        model["inputs"].as_array().unwrap().iter().map(|input| input["role"].as_str().unwrap()).collect();
    assert_eq!(roles, ["muscle", "configuration", "estimation"]);
    // Beyond the range of the load cell no sample counts.
    let counted = |model: &serde_json::Value| model["fit"]["estimation"]["n_samples"].as_u64().unwrap();
    let within = counted(&model);
    let text = std::fs::read_to_string(bench.folder.path().join("bench.toml")).unwrap();
    bench.file("narrow.toml", text.replace("[-500.0, 500.0]", "[-500.0, 300.0]"));
    bench.run("volts.csv --muscle m.toml --channels narrow.toml --out narrow.json --quiet --starts 1");
    let narrow = std::fs::read_to_string(bench.folder.path().join("narrow.json")).unwrap();
    assert!(counted(&serde_json::from_str(&narrow).unwrap()) < within);
}

#[test]
fn a_channels_file_that_is_wrong_gets_one_line_with_its_place() {
    let bench = Bench::new();
    bench.file("bench.toml", "[pressure]\ncolumn = \"ai0\"\nunit = \"atm\"\n");
    assert_eq!(
        bench.refusal(&format!("good.csv --channels bench.toml {TAIL}")),
        "error: bench.toml:1:1: [pressure] has the unit \"atm\", which is not known; write kPa, Pa, MPa, bar or psi, and gain and \
         offset for any other"
    );
    bench.file("bench.toml", "[pressure]\ncolumn = \"ai0\"\nunit = \"bar\"\n");
    assert_eq!(
        bench.refusal(&format!("good.csv --channels bench.toml {TAIL}")),
        "error: good.csv: bench.toml [pressure] names column \"ai0\", which the file lacks; it has time_s, pressure_kPa, \
         length_mm, force_N"
    );
    // The command line wins.
    let output = bench.run("good.csv --channels bench.toml --map pressure_kPa=pressure_kPa --muscle m.toml --check");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(
        bench.refusal(&format!("good.csv --channels gone.toml {TAIL}")),
        "error: cannot read channels file gone.toml: no such file; check the path"
    );
}
