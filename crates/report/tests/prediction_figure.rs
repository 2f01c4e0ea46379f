//! The figure of a prediction, as a document.

use pam_report::{FigureError, PredictionFigure, prediction_figure};

fn figure(n: usize) -> PredictionFigure {
    let column = |of: &dyn Fn(f64) -> f64| (0..n).map(|row| of(0.01 * row as f64)).collect::<Vec<f64>>();
    PredictionFigure {
        title: "run <3>: measured and modelled".to_owned(),
        facts: vec!["RMSE 1 N".to_owned()],
        time_s: column(&|t| t),
        pressure_kpa: column(&|t| 250.0 + 200.0 * t.sin()),
        length_mm: column(&|t| 240.0 + 20.0 * (0.7 * t).cos()),
        force_n: column(&|t| 300.0 + 200.0 * t.sin() + (50.0 * t).sin()),
        model_n: column(&|t| 300.0 + 200.0 * t.sin()),
        half_width_n: column(&|_| 2.0),
        level: 0.95,
        counted: (0..n).map(|row| row % 100 > 5).collect(),
        extrapolated: (0..n).map(|row| row % 1000 > 900).collect(),
        identified_kpa: [100.0, 400.0],
        identified_mm: [225.0, 255.0],
    }
}

#[test]
fn band_residual_and_extrapolation_are_there() {
    let svg = prediction_figure(&figure(20_000)).unwrap();
    for text in
        ["run &lt;3&gt;", "95 % band", "Residual", "Operating range", "extrapolated", "not counted", "identified on"]
    {
        assert!(svg.contains(text), "{text}");
    }
    assert!(!svg.contains("NaN") && svg.len() < 200_000, "{}", svg.len());
}

#[test]
fn without_a_force_there_is_no_residual() {
    let mut figure = figure(2000);
    figure.force_n.clear();
    let svg = prediction_figure(&figure).unwrap();
    assert!(!svg.contains("Residual") && svg.contains("Operating range") && !svg.contains(">measured<"));
}

#[test]
fn nothing_to_draw_and_unequal_columns_are_refused() {
    assert_eq!(prediction_figure(&PredictionFigure::default()), Err(FigureError::NothingToDraw));
    let mut short = figure(10);
    short.counted.pop();
    assert!(matches!(prediction_figure(&short), Err(FigureError::UnequalColumns { column: "counted", .. })));
}
