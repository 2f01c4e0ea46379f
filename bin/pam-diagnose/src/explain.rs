//! The catalogue on the terminal, and the figure of an effect.

use std::ops::Range;

use anyhow::Context as _;
use pam_cli::{Console, Output, Verdict, publish, write_file};
use pam_diagnosis::explain::{Driven, signature};
use pam_muscle::Coordinate;
use pam_muscle::effects::{Effect, Page, Symbol};
use pam_report::text::{hanging, wrapped};
use pam_report::{PictureFormat, SignatureFigure, SignaturePanel, SignatureSeries, Table, signature_figure};

use crate::args::Args;
use crate::own::OwnEffects;

/// Prints the page of effect `id`, or every id, and writes the figure if one is wanted.
pub(crate) fn explain(args: &Args, own: &OwnEffects, console: &Console, id: &str) -> anyhow::Result<Verdict> {
    if id == "all" {
        anyhow::ensure!(args.figure.is_none(), "--figure draws one effect; name it instead of all");
        write_file("-", list(own))?;
        return Ok(Verdict::Accepted);
    }
    let effect = own.known(id).context("--explain")?;
    let figure = args.figure.as_deref().filter(|_| !args.run.check).map(Output::open_figure).transpose()?;
    write_file("-", text(effect.page()))?;
    if let Some(output) = figure {
        let format = PictureFormat::of_path(output.path());
        publish(vec![(output, format.write(figure_of(effect)?)?)], console)?;
    }
    Ok(Verdict::Accepted)
}

/// Every id with its name.
fn list(own: &OwnEffects) -> String {
    let mut table = Table::new(["id", "name"]);
    for effect in own.all() {
        table.row([effect.page().id, effect.page().name]);
    }
    table.to_terminal()
}

/// The page of an effect.
fn text(page: &Page) -> String {
    let mut text = format!("{} ({})\n\n{}\n", capitalized(page.name), page.id, wrapped(page.summary, ""));
    text.push_str("\nEquation\n");
    for line in page.equation.split(",  ") {
        text.push_str(&format!("{}\n", hanging(line.trim(), "  ", "      ")));
    }
    text.push_str("\nSymbols\n");
    let widest =
        |of: fn(&Symbol) -> &str| page.symbols.iter().map(|symbol| of(symbol).chars().count()).max().unwrap_or(0);
    let (names, units) = (widest(|symbol| symbol.symbol), widest(|symbol| symbol.unit));
    for Symbol { symbol, unit, meaning } in page.symbols {
        let first = format!("  {symbol:<names$}  {unit:<units$}  ");
        let indent = " ".repeat(first.chars().count());
        text.push_str(&format!("{}\n", hanging(meaning, &first, &indent)));
    }
    for (title, words) in [("Assumptions", page.validity), ("Source", page.source), ("Signature", page.signature)] {
        text.push_str(&format!("\n{title}\n{}\n", wrapped(words, "  ")));
    }
    if !page.confused_with.is_empty() {
        text.push_str("\nConfused with\n");
    }
    for confusion in page.confused_with {
        let words =
            format!("{}: {}. To tell them apart: {}.", confusion.id, ended(confusion.because), ended(confusion.test));
        text.push_str(&wrapped(&words, "  "));
        text.push('\n');
    }
    text.push_str(&format!("\nTest\n{}\n", wrapped(page.test, "  ")));
    text.push_str(&format!("  pam-bench --protocol {} records it on the virtual bench\n", page.protocol));
    text
}

fn ended(text: &str) -> &str {
    text.trim_end_matches('.')
}

fn capitalized(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or(String::new(), |first| first.to_uppercase().chain(characters).collect())
}

/// The figure of an effect as SVG.
fn figure_of(effect: &'static dyn Effect) -> anyhow::Result<String> {
    let found = signature(effect);
    let (driven_scale, driven_label) = match found.driven {
        Driven::Contraction => (1e2, "contraction (%)"),
        Driven::Pressure => (1e-3, "pressure (kPa)"),
        Driven::Time => (1.0, "time (s)"),
    };
    let (scale, label) = match found.coordinate {
        Coordinate::Time => (1.0, "time (s)"),
        Coordinate::Pressure => (1e-3, "pressure (kPa)"),
        Coordinate::Contraction => (1e2, "contraction (%)"),
        Coordinate::Speed => (1e3, "speed (mm/s)"),
        Coordinate::TravelSinceReversal => (1e3, "travel since reversal (mm)"),
        Coordinate::TimeSinceLastMove => (1.0, "time since last move (s)"),
        Coordinate::Cycle => (1.0, "cycle"),
        Coordinate::Force => (1.0, "force (N)"),
    };
    let scaled = |values: &[f64], scale: f64| -> Vec<f64> { values.iter().map(|value| value * scale).collect() };
    let xs = scaled(&found.driven_values, driven_scale);
    let is_chirp = found.cycles.is_some();
    let series =
        |name: &str, xs: Vec<f64>, ys: Vec<f64>| SignatureSeries { name: name.to_owned(), xs, ys, dots: false };
    let residual_n = found.with_n.iter().zip(&found.without_n).map(|(with, without)| with - without).collect();
    let forces = match found.cycles {
        None => {
            vec![series("eq. 11", xs.clone(), found.without_n), series("with the effect", xs, found.with_n)]
        }
        // Every cycle of a chirp over the others is a blot.
        Some([slow, fast]) => {
            let of = |rows: &Range<usize>, values: &[f64]| values[rows.clone()].to_vec();
            vec![
                series("eq. 11", of(&slow, &xs), of(&slow, &found.without_n)),
                series("with the effect, slow", of(&slow, &xs), of(&slow, &found.with_n)),
                series("fast", of(&fast, &xs), of(&fast, &found.with_n)),
            ]
        }
    };
    let residual = series("residual", scaled(&found.coordinate_values, scale), residual_n);
    let page = effect.page();
    Ok(signature_figure(&SignatureFigure {
        title: format!("{}: {}", capitalized(page.name), found.path),
        panels: vec![
            SignaturePanel {
                title: "Force".to_owned(),
                x_label: driven_label.to_owned(),
                y_label: "force (N)".to_owned(),
                series: forces,
            },
            SignaturePanel {
                title: "Residual of eq. 11, not refitted".to_owned(),
                x_label: label.to_owned(),
                y_label: "residual (N)".to_owned(),
                series: vec![SignatureSeries { dots: is_chirp, ..residual }],
            },
        ],
    })?)
}
