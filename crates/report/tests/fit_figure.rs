//! The figure of a fit, as a document: well-formed, the same every time, and there for any input.

use pam_report::{FigureError, FitFigure, FitRecording, Role, SwarmStart, fit_figure};

/// A recording of `n` samples; `drive` gives pressure, length, measured and modelled force, and direction.
fn recording(name: &str, role: Role, n: usize, drive: impl Fn(usize) -> [f64; 5]) -> FitRecording {
    let rows: Vec<[f64; 5]> = (0..n).map(drive).collect();
    let column = |index: usize| rows.iter().map(|row| row[index]).collect();
    FitRecording {
        name: name.to_owned(),
        role,
        time_s: (0..n).map(|row| 0.001 * row as f64).collect(),
        pressure_kpa: column(0),
        length_mm: column(1),
        force_n: column(2),
        model_n: column(3),
        direction: column(4),
    }
}

/// Constant pressure, two cycles of length, a ripple for noise.
fn isobaric(name: &str, role: Role, n: usize) -> FitRecording {
    recording(name, role, n, |row| {
        let phase = 4.0 * std::f64::consts::PI * row as f64 / n as f64;
        let model_n = 100.0 + 80.0 * phase.cos();
        let ripple = (row as f64 * 12.9898).sin();
        [200.0, 240.0 + 20.0 * phase.cos(), model_n + ripple, model_n, phase.sin().signum()]
    })
}

fn figure(recordings: Vec<FitRecording>) -> FitFigure {
    FitFigure {
        title: "Fit of <M> & \"friends\"".to_owned(),
        recordings,
        noise_floor_n: Some(0.7),
        rmse_estimation_n: Some(0.71),
        rmse_validation_n: Some(0.72),
        starts: vec![SwarmStart { best_rmse_n: vec![9.0, 3.0, 0.8], polished_rmse_n: Some(0.71) }],
    }
}

/// Panics unless every tag is closed, every attribute quoted and every number finite.
fn check_document(svg: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        let text = &rest[..start];
        assert!(!text.contains('>'), "stray >: {text}");
        for entity in text.split('&').skip(1) {
            let known = ["lt;", "gt;", "amp;", "quot;", "apos;"];
            assert!(known.iter().any(|name| entity.starts_with(name)), "stray &: {text}");
        }
        let end = rest[start..].find('>').map(|end| start + end);
        let tag = &rest[start + 1..end.unwrap_or_else(|| panic!("tag not closed: {rest}"))];
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        let name = tag.trim_start_matches('/').split([' ', '\n', '/']).next().unwrap_or("");
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(name);
        }
        rest = &rest[start + tag.len() + 2..];
    }
    assert!(open.is_empty() && rest.trim().is_empty(), "{open:?} {rest}");
    assert!(svg.starts_with("<svg xmlns="));
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "a number that is not finite");
}

#[test]
fn the_document_is_well_formed_and_escaped() {
    let recordings = vec![
        isobaric("a<b>&\"c\".csv", Role::Estimation, 3000),
        isobaric("validation \u{7}\u{0}", Role::Validation, 3000),
    ];
    let svg = fit_figure(&figure(recordings)).unwrap();
    check_document(&svg);
    assert!(svg.contains("<title>Fit of &lt;M&gt; &amp; \"friends\"</title>"));
    assert!(svg.contains("a&lt;b&gt;&amp;\"c\".csv"));
}

#[test]
fn equal_input_gives_equal_bytes() {
    let recordings = vec![isobaric("a.csv", Role::Estimation, 5000)];
    let once = fit_figure(&figure(recordings.clone())).unwrap();
    assert_eq!(once, fit_figure(&figure(recordings)).unwrap());
}

#[test]
fn a_long_recording_gives_a_small_document() {
    let svg = fit_figure(&figure(vec![isobaric("a.csv", Role::Estimation, 200_000)])).unwrap();
    assert!(svg.len() < 200_000, "{} bytes", svg.len());
}

#[test]
fn a_hundred_recordings_still_fit() {
    let recordings = (0..100)
        .map(|index| {
            let role = if index % 3 == 0 { Role::Validation } else { Role::Estimation };
            isobaric(&format!("a-recording-with-a-long-name-{index}.csv"), role, 5000)
        })
        .collect();
    let svg = fit_figure(&figure(recordings)).unwrap();
    check_document(&svg);
    assert!(svg.len() < 200_000, "{} bytes", svg.len());
}

#[test]
fn a_direction_that_flips_at_every_sample_is_drawn_in_one_color() {
    let flipping = recording("flip.csv", Role::Estimation, 20_000, |row| {
        let sign = if row % 2 == 0 { 1.0 } else { -1.0 };
        [100.0 + row as f64 * 0.01, 200.0 + (row as f64 * 0.001).sin() * 20.0, 50.0 + sign, 50.0, sign]
    });
    let svg = fit_figure(&figure(vec![flipping])).unwrap();
    check_document(&svg);
    assert!(svg.len() < 200_000, "{} bytes", svg.len());
}

#[test]
fn degenerate_recordings_give_a_figure() {
    let constant = |n: usize| recording("constant", Role::Estimation, n, |_| [100.0, 200.0, 50.0, 50.0, 1.0]);
    let zero = recording("zero", Role::Validation, 10, |_| [0.0; 5]);
    let holes = recording("holes", Role::Estimation, 100, |row| {
        let hole = |every: usize| if row % every == 0 { f64::NAN } else { row as f64 };
        [hole(3), hole(5), hole(7), f64::INFINITY.min(row as f64), f64::NAN]
    });
    let huge = recording("huge", Role::Estimation, 50, |row| [1e300 * row as f64, -1e300, 1e300, -1e300, 1.0]);
    let mut backward = isobaric("backward", Role::Estimation, 100);
    backward.time_s.reverse();
    let nameless = isobaric("", Role::Validation, 1);
    let all = vec![constant(1), constant(50), zero, holes, huge, backward, nameless];
    for recording in all.clone() {
        check_document(&fit_figure(&figure(vec![recording])).unwrap());
    }
    check_document(&fit_figure(&figure(all)).unwrap());
}

#[test]
fn missing_numbers_leave_out_their_marks() {
    let mut figure = figure(vec![isobaric("a.csv", Role::Estimation, 500)]);
    (figure.noise_floor_n, figure.rmse_estimation_n, figure.rmse_validation_n) = (None, None, Some(f64::NAN));
    figure.starts = vec![SwarmStart { best_rmse_n: vec![f64::NAN, -1.0, 0.0], polished_rmse_n: Some(f64::INFINITY) }];
    let svg = fit_figure(&figure).unwrap();
    check_document(&svg);
    assert!(svg.contains("no swarm was run"));
    assert!(!svg.contains("noise alone"));
}

#[test]
fn nothing_to_draw_and_unequal_columns_are_refused() {
    assert_eq!(fit_figure(&figure(vec![])).unwrap_err(), FigureError::NothingToDraw);
    let empty = recording("gone", Role::Estimation, 10, |_| [f64::NAN; 5]);
    assert_eq!(fit_figure(&figure(vec![empty])).unwrap_err(), FigureError::NothingToDraw);
    let mut short = isobaric("short.csv", Role::Estimation, 10);
    short.model_n.pop();
    let message = fit_figure(&figure(vec![short])).unwrap_err().to_string();
    assert_eq!(message, "recording short.csv: column model_n has 9 samples, expected 10 as in time_s");
}

#[test]
fn slow_sweeps_are_curves_and_everything_else_is_shown_by_density() {
    let sweep = fit_figure(&figure(vec![isobaric("a.csv", Role::Estimation, 4000)])).unwrap();
    assert!(sweep.contains("Force against length, slow sweeps"));
    let wandering = recording("w.csv", Role::Estimation, 4000, |row| {
        let at = row as f64 * 0.01;
        let model_n = 100.0 + 50.0 * at.sin();
        [200.0 + 150.0 * (1.7 * at).sin(), 230.0 + 20.0 * (1.1 * at).cos(), model_n + 1.0, model_n, 1.0]
    });
    let density = fit_figure(&figure(vec![wandering])).unwrap();
    assert!(density.contains("Measured against modelled, estimation") && !density.contains("slow sweeps"));
    assert!(density.contains("no such recording"));
}
