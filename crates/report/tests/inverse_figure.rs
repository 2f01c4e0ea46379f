//! The figure of an inverse, as a document: the same every time, and there for any input.

use pam_report::{FigureError, InverseCell, InverseFigure, InverseMap, RegionBar, SlopeCell, SlopeMap, inverse_figure};

/// A map whose upper half is out of reach, with a gap in the inverse above it.
fn map(cell: impl Fn(usize, usize) -> InverseCell) -> InverseMap {
    let cells = (0..12).flat_map(|row| (0..16).map(move |column| (row, column)));
    InverseMap {
        length_mm: [211.0, 268.0],
        force_n: [4.5, 1119.0],
        n_columns: 16,
        cells: cells.map(|(row, column)| cell(row, column)).collect(),
    }
}

fn half(row: usize, column: usize) -> InverseCell {
    let exact_kpa = 40.0 * row as f64 + column as f64;
    match row {
        0..6 => InverseCell::Found { network_kpa: exact_kpa + 0.1 * (column as f64).sin(), exact_kpa },
        6 => InverseCell::Missing,
        _ => InverseCell::OutOfReach,
    }
}

fn figure() -> InverseFigure {
    let slopes = [SlopeCell::Rising(1.2), SlopeCell::Missing, SlopeCell::OutOfReach, SlopeCell::Rising(0.4)];
    InverseFigure {
        title: "Inverse of <M>".to_owned(),
        facts: vec!["pressure RMSE 0.1 kPa".to_owned()],
        maps: [map(half), map(half)],
        slopes: SlopeMap {
            length_mm: [211.0, 268.0],
            pressure_kpa: [0.5, 500.0],
            n_columns: 2,
            cells: slopes.to_vec(),
        },
        training_rmse_kpa: vec![120.0, 3.0, 0.2],
        validation_rmse_kpa: vec![121.0, 3.2, 0.3],
        best_epoch: 2,
        errors_kpa: [vec![0.1, -0.2, 0.05], vec![0.3, f64::NAN]],
        regions: vec![RegionBar { name: "contracting".to_owned(), rmse_kpa: 0.1, p95_kpa: 0.2 }],
    }
}

#[test]
fn the_figure_shows_every_panel_and_names_what_is_missing() {
    let svg = inverse_figure(&figure()).unwrap();
    for text in ["Inverse of &lt;M&gt;", "no inverse", "outside the domain", "Training", "95 % below", "contracting"] {
        assert!(svg.contains(text), "{text}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    assert_eq!(svg, inverse_figure(&figure()).unwrap());
}

#[test]
fn an_inverse_that_exists_everywhere_speaks_of_no_gap() {
    let whole = |row: usize, column: usize| InverseCell::Found {
        network_kpa: 40.0 * row as f64 + column as f64,
        exact_kpa: 40.0 * row as f64 + column as f64,
    };
    let mut figure = InverseFigure { maps: [map(whole), map(whole)], ..figure() };
    figure.slopes.cells = vec![SlopeCell::Rising(1.0); 4];
    assert!(!inverse_figure(&figure).unwrap().contains("no inverse"));
}

#[test]
fn without_training_errors_or_regions_the_panels_say_so() {
    let bare = InverseFigure {
        training_rmse_kpa: Vec::new(),
        validation_rmse_kpa: Vec::new(),
        errors_kpa: [Vec::new(), Vec::new()],
        regions: Vec::new(),
        ..figure()
    };
    let svg = inverse_figure(&bare).unwrap();
    assert!(svg.contains("no epoch was run") && svg.contains("no point was judged"));
}

#[test]
fn nothing_to_invert_is_an_error() {
    let nowhere = |_, _| InverseCell::OutOfReach;
    let figure = InverseFigure { maps: [map(nowhere), map(nowhere)], ..figure() };
    assert_eq!(inverse_figure(&figure), Err(FigureError::NothingToInvert));
}

#[test]
fn a_figure_of_full_size_is_no_half_megabyte() {
    let fine = |extent: f64| {
        let cells = (0..36).flat_map(|row| (0..56).map(move |column| (row, column)));
        let cell = |(row, column): (usize, usize)| {
            if row * 2 > column + 20 {
                return InverseCell::OutOfReach;
            }
            let exact_kpa = 12.0 * row as f64 + 2.0 * column as f64;
            let wave = (0.3 * row as f64).sin() * (0.25 * column as f64 + extent).cos();
            InverseCell::Found { network_kpa: exact_kpa + 0.1 * wave, exact_kpa }
        };
        InverseMap { n_columns: 56, cells: cells.map(cell).collect(), ..map(half) }
    };
    let cells = (0..40).flat_map(|row| {
        (0..56).map(move |column| SlopeCell::Rising(0.04 * f64::from(column) + 0.002 * f64::from(row)))
    });
    let slopes = SlopeMap { n_columns: 56, cells: cells.collect(), ..figure().slopes };
    let errors: Vec<f64> = (0..2000).map(|index| 0.001 * f64::from(index).sin()).collect();
    let curve: Vec<f64> = (0..200).map(|epoch| 100.0 / f64::from(epoch + 1)).collect();
    let figure = InverseFigure {
        maps: [fine(0.0), fine(1.0)],
        slopes,
        errors_kpa: [errors.clone(), errors],
        training_rmse_kpa: curve.clone(),
        validation_rmse_kpa: curve,
        ..figure()
    };
    let svg = inverse_figure(&figure).unwrap();
    assert!(svg.len() < 200_000, "{}", svg.len());
    assert!(svg.matches("<rect").count() < 1700, "{}", svg.matches("<rect").count());
}
