//! Recordings and command lines that are wrong: one line with place and remedy.

use crate::bench::{Bench, TAIL, reworked, shipped};

#[test]
fn every_bad_recording_gets_one_line_with_place_and_remedy() {
    let bench = Bench::new();
    let header = "time_s,pressure_kPa,length_mm,force_N\n";
    let rows = "0,100,260,50\n0.01,110,259,55\n0.02,120,258,60\n";
    let with_row = |row: &str| format!("{header}{rows}{row}\n0.04,120,258,60\n");
    let cases: Vec<(&str, String, &str)> = vec![
        (
            "empty file",
            String::new(),
            "bad.csv: the file holds no rows; record again, or check that the logger closed the file",
        ),
        (
            "header only",
            header.to_owned(),
            "bad.csv: there are no rows; record again, or check that the logger closed the file",
        ),
        (
            "one row",
            format!("{header}0,100,260,50\n"),
            "bad.csv: there is only one row; at least 2 are needed: record for longer",
        ),
        (
            "missing column",
            "time_s,pressure_kPa,length_mm\n0,100,260\n0.01,110,259\n".to_owned(),
            "bad.csv: no column gives force; name a column force_N in the header, point to one with --map force_N=COLUMN, or give a constant with --fixed force_N=VALUE (the file has time_s, pressure_kPa, length_mm)",
        ),
        (
            "misspelt column",
            "time_s,presure_kPa,length_mm,force_N\n0,100,260,50\n0.01,110,259,55\n".to_owned(),
            "bad.csv:1:2: unknown column \"presure_kPa\"; did you mean pressure_kPa?",
        ),
        (
            "unknown unit",
            "time_s,pressure_atm,length_mm,force_N\n0,1,260,50\n0.01,1,259,55\n".to_owned(),
            "bad.csv:1:2: unknown unit \"atm\" of column \"pressure_atm\"; pressure can be in kPa, Pa, MPa, bar or psi, for example pressure_kPa (for other units see --calibrate)",
        ),
        (
            "duplicate header",
            "time_s,pressure_kPa,length_mm,force_N,force_N\n0,1,260,50,50\n0.01,1,259,55,55\n".to_owned(),
            "bad.csv:1:5: column \"force_N\" gives force again after \"force_N\"; rename one of them in the header",
        ),
        (
            "text in a number",
            with_row("0.03,abc,258,60"),
            "bad.csv:5:2: \"abc\" in column \"pressure_kPa\" is not a number; correct the row, or drop such rows with --skip-bad-rows",
        ),
        (
            "NaN",
            with_row("0.03,120,nan,60"),
            "bad.csv:5:3: \"nan\" in column \"length_mm\" is not finite; correct the row, or drop such rows with --skip-bad-rows",
        ),
        (
            "infinity",
            with_row("0.03,120,258,inf"),
            "bad.csv:5:4: \"inf\" in column \"force_N\" is not finite; correct the row, or drop such rows with --skip-bad-rows",
        ),
        (
            "clock running back",
            with_row("0.01,120,258,60"),
            "bad.csv:5:1: the clock runs back from 0.02 s to 0.01 s; cut the file there if the logger started anew, or drop such rows with --skip-bad-rows",
        ),
        (
            "short row",
            with_row("0.03,120,258"),
            "bad.csv:5:4: 3 fields where the header has 4; correct the row, or drop such rows with --skip-bad-rows",
        ),
        (
            "constant force",
            reworked(|_, [t, p, l, _]| [t, p, l, 20.0]),
            "bad.csv: force never varies (it is 20 N in every row); check the load cell and the column that holds it, or for a dead weight leave the column out and give --fixed force_N=20",
        ),
        (
            "constant time",
            reworked(|_, [_, p, l, f]| [1.0, p, l, f]),
            "bad.csv: time never varies (it is 1 s in every row); check the logger's clock and the column that holds it",
        ),
        (
            "too few rows",
            format!("{header}{rows}"),
            "bad.csv: 3 samples for 8 parameters; at least 26 are needed, record for longer",
        ),
        (
            "kPa under a header that says bar",
            reworked(|_, r| r).replace("pressure_kPa", "pressure_bar"),
            "bad.csv: pressure reaches 50188.000 kPa, 100 times too high; kPa under a header that says bar is a factor of 100; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "bar under a header that says kPa",
            reworked(|_, [t, p, l, f]| [t, 0.01 * p, l, f]),
            "bad.csv: pressure reaches 5.019 kPa, 100 times too low; bar under a header that says kPa is a factor of 100; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "milliseconds under a header that says seconds",
            reworked(|i, [_, p, l, f]| [1000.0 * i as f64, p, l, f]),
            "bad.csv: time reaches 9505000 s, one row every 1000 s, 1000 times too high; ms under a header that says s is a factor of 1000; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "seconds under a header that says milliseconds",
            reworked(|_, r| r).replace("time_s", "time_ms"),
            "bad.csv: time reaches 0.0950 s in 9506 rows, 1000 times too low; s under a header that says ms is a factor of 1000; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "millimeters under a header that says meters",
            reworked(|_, r| r).replace("length_mm", "length_m"),
            "bad.csv: length reaches 268444.000 mm, 1000 times too high; mm under a header that says m is a factor of 1000; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "kilonewtons under a header that says newtons",
            reworked(|_, [t, p, l, f]| [t, p, l, 1e-3 * f]),
            "bad.csv: force reaches 1.119 N, 1000 times too low; kN under a header that says N is a factor of 1000; name the unit of the column with --map, or go on with --accept-implausible",
        ),
        (
            "force of the wrong sign",
            reworked(|_, [t, p, l, f]| [t, p, l, -f]),
            "bad.csv: force falls as pressure rises (correlation -0.98), so its sign is turned; tension is positive: add --calibrate 'force_N = -1 * force_N', or go on with --accept-implausible",
        ),
        (
            "pressure and force swapped",
            reworked(|_, [t, p, l, f]| [t, f, l, p]),
            "bad.csv: pressure and force look swapped (correlation with an ideal muscle 0.59 as they are, 0.98 the other way round); exchange their names with --map, or go on with --accept-implausible",
        ),
        (
            "pressure and length swapped",
            reworked(|_, [t, p, l, f]| [t, l, p, f]),
            "bad.csv: pressure and length look swapped (correlation with an ideal muscle 0.75 as they are, 0.98 the other way round); exchange their names with --map, or go on with --accept-implausible",
        ),
        (
            "another muscle",
            reworked(|_, [t, p, l, f]| [t, p, l + 60.0, f]),
            "bad.csv: length runs from 270.8 to 328.4 mm, which a muscle of rest length 267.0 mm cannot have (it would be stretched by more than a tenth, or its strands straight); check that the recording and the muscle file belong together, or go on with --accept-implausible",
        ),
    ];
    for (name, content, expected) in cases {
        bench.file("bad.csv", content);
        let said = bench.refusal(&format!("bad.csv {TAIL}"));
        assert_eq!(said, format!("error: {expected}"), "{name}");
    }
}

#[test]
fn a_short_piece_of_a_small_loop_has_its_channels_where_they_are() {
    let bench = Bench::new();
    let steps = shipped("length-steps.csv");
    let piece: Vec<&str> = steps.lines().take(1).chain(steps.lines().skip(46).take(261)).collect();
    bench.file("piece.csv", piece.join("\n"));
    let output = bench.run(&format!("piece.csv --check {TAIL}"));
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn one_pressure_is_fitted_with_a_word_where_its_gauge_is_alive() {
    let bench = Bench::new();
    let at_300_kpa = |text: &str| -> String {
        let rows = text.lines().enumerate().filter(|(line, text)| {
            *line == 0 || text.split(',').nth(1).is_some_and(|p| (p.parse::<f64>().unwrap() - 300.0).abs() < 1.5)
        });
        rows.map(|(_, text)| format!("{text}\n")).collect()
    };
    bench.file("one.csv", at_300_kpa(&shipped("isobaric-triangles.csv")));
    let output = bench.run(&format!("one.csv {TAIL}"));
    let said = String::from_utf8(output.stderr).unwrap();
    assert_ne!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("trust this model at that pressure alone, or add a recording at another"), "{said}");
}

#[test]
fn every_bad_command_line_gets_one_line_with_the_remedy() {
    let bench = Bench::new();
    bench.file("flat.csv", reworked(|_, [t, _, l, f]| [t, 300.0, l, f]));
    bench.file("worse.toml", "rest_length_mm = 267\nrest_radius_mm = 10\nbraid_angle = 25\n");
    bench.file("other.csv", reworked(|_, [t, p, l, f]| [t, p, l, 1.8 * f]));
    bench.file("sub", "");
    let cases: Vec<(String, &str)> = vec![
        (format!("missing.csv {TAIL}"), "missing.csv: no such file; check the path"),
        (format!(". {TAIL}"), ".: is a directory; name the recordings in it"),
        (
            format!("flat.csv {TAIL}"),
            "flat.csv: pressure stays at 300.0 kPa in every estimation recording, which cannot tell the gas from the rubber; add a recording at another pressure",
        ),
        (
            format!("good.csv other.csv {TAIL}"),
            "other.csv: at equal pressure and length the force is 1.80 times that of good.csv; they are of different muscles, or a gain changed between them: identify them apart, or go on with --accept-implausible",
        ),
        (
            format!("good.csv --holdout good.csv {TAIL}"),
            "good.csv: is fitted and held out as well; hold out a recording that the fit does not see",
        ),
        (
            format!("good.csv --holdout other.csv {TAIL}"),
            "other.csv: at equal pressure and length the force is 1.80 times that of good.csv; they are of different muscles, or a gain changed between them: identify them apart, or go on with --accept-implausible",
        ),
        (
            "good.csv --muscle none.toml --out model.json".to_owned(),
            "cannot read muscle file none.toml: no such file; check the path",
        ),
        (
            "good.csv --muscle worse.toml --out model.json".to_owned(),
            "worse.toml:3:1: unknown field `braid_angle`; did you mean `braid_angle_deg`?",
        ),
        (
            "good.csv --muscle m.toml --out sub/model.json".to_owned(),
            "cannot write sub/model.json: sub is not a folder; name another path",
        ),
        (
            "good.csv --muscle m.toml --out nowhere/model.json".to_owned(),
            "cannot write nowhere/model.json: folder nowhere does not exist; create it with `mkdir -p nowhere`",
        ),
        (
            "good.csv --muscle m.toml --out good.csv".to_owned(),
            "cannot write good.csv: it is also an input, which the run would destroy; name another",
        ),
        ("good.csv --muscle m.toml --out .".to_owned(), "cannot write .: it is a folder; name a file inside it"),
        (
            "good.csv --muscle m.toml --out /dev/full".to_owned(),
            "cannot write /dev/full: no space left on the device; free some or name a path elsewhere",
        ),
        (
            "good.csv --muscle m.toml".to_owned(),
            "the following required arguments were not provided: --out <MODEL.json>; see --help",
        ),
        (
            format!("good.csv {TAIL} --fix k4=1"),
            "invalid value 'k4=1' for '--fix <NAME=VALUE>': no parameter is called \"k4\"; expected one of k1, k2, k3, c10, c01, strand_modulus, rubber_friction, strand_friction; see --help",
        ),
        (
            format!("good.csv {TAIL} --fix strand_modulus=0"),
            "invalid value 'strand_modulus=0' for '--fix <NAME=VALUE>': strand_modulus cannot be 0; give 1e6 to 1e18; see --help",
        ),
        (
            format!("good.csv {TAIL} --free k1"),
            "invalid value 'k1' for '--free <NAME>': expected c01 or strand_friction; see --help",
        ),
        (
            format!("good.csv {TAIL} --map pressure_kPa=volt"),
            "good.csv: --map names column \"volt\", which the file lacks; it has time_s, pressure_kPa, length_mm, force_N",
        ),
        (
            format!("good.csv {TAIL} --columns time_s,force_N"),
            "good.csv:1:1: the file has a header of its own; leave --columns away and rename its columns with --map",
        ),
        (
            format!("good.csv {TAIL} --calibrate pressure_kPa~=~sin(x)"),
            "invalid value 'pressure_kPa = sin(x)' for '--calibrate <NAME=LINE>': '(' cannot be used in \"sin(x)\"; expected for example 'pressure_kPa = 125 * ai0 - 12.5'; see --help",
        ),
        (
            format!("good.csv {TAIL} --max-rmse-n -1"),
            "invalid value '-1' for '--max-rmse-n <X>': expected a number above 0; see --help",
        ),
        (
            format!("good.csv {TAIL} --holdut x.csv"),
            "unexpected argument '--holdut' found; did you mean --holdout? See --help",
        ),
    ];
    for (arguments, expected) in cases {
        assert_eq!(bench.refusal(&arguments), format!("error: {expected}"), "{arguments}");
    }
}

#[test]
fn the_remedies_that_the_messages_name_do_help() {
    let bench = Bench::new();
    bench.file("turned.csv", reworked(|_, [t, p, l, f]| [t, p, l, -f]));
    bench.file("swapped.csv", reworked(|_, [t, p, l, f]| [t, f, l, p]));
    bench.file("slip.csv", reworked(|_, row| row).replace("pressure_kPa", "pressure_bar"));
    bench.file("rows.csv", format!("{}nonsense\n", shipped("isobaric-triangles.csv")));
    for arguments in [
        "turned.csv --calibrate force_N~=~-1~*~force_N",
        "swapped.csv --map pressure_kPa=force_N --map force_N=pressure_kPa",
        "slip.csv --map pressure_kPa=pressure_bar",
        "rows.csv --skip-bad-rows",
        "slip.csv --accept-implausible --check",
    ] {
        let output = bench.run(&format!("{arguments} {TAIL}"));
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments}: {said}");
    }
}
