//! The page of a diagnosis, as a document: valid, self-contained, the same every time, and there for any input.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that fails may panic, and one that skips says so"
)]

use pam_artifact::diagnosis::{
    AsGiven, BeforeAfter, Evidence, Implausible, Isolability, NextExperiment, Region, Residual, Shift, Verdict,
};
use pam_muscle::Coordinate;
use pam_muscle::effects::Symbol;
use pam_report::{
    ConfusionFigure, DiagnosisPage, FigureError, PageAlternative, PageAppendix, PageBaseParameter, PageCandidate,
    PageEffect, PageEstimate, PageInput, PageParameter, PageRecording, PageUnknown, SignatureFigure, SignaturePanel,
    SignatureSeries, confusion_figure, diagnosis_page, signature_figure,
};

const SHARP: &str = "<b>&\"'</p>\u{0}";

fn recording(name: &str, n: usize, effect: bool) -> PageRecording {
    let phase = |row: usize| 8.0 * std::f64::consts::PI * row as f64 / n as f64;
    let column = |of: &dyn Fn(usize) -> f64| (0..n).map(of).collect::<Vec<f64>>();
    let ripple = |row: usize| (row as f64 * 12.9898).sin();
    let base = |row: usize| 100.0 + 80.0 * phase(row).cos();
    PageRecording {
        name: name.to_owned(),
        time_s: column(&|row| 0.01 * row as f64),
        pressure_kpa: column(&|row| 200.0 + ripple(row)),
        contraction_percent: column(&|row| 10.0 - 10.0 * phase(row).cos()),
        speed_mm_per_s: column(&|row| 20.0 * phase(row).sin().abs()),
        travel_mm: column(&|row| 10.0 * (phase(row) / std::f64::consts::PI).fract()),
        rest_s: column(&|_| 0.0),
        cycle: column(&|row| 1.0 + (4 * row / n) as f64),
        force_n: column(&|row| base(row) + phase(row).sin().signum() + ripple(row)),
        base_force_n: column(&base),
        model_force_n: effect.then(|| column(&|row| base(row) + phase(row).sin().signum())),
        settled: (0..n).map(|row| row % 50 != 0).collect(),
        stretches: vec![(1.0, 2.0), (3.0, 3.0)],
        held_out: false,
    }
}

fn region(coordinate: Coordinate) -> Region {
    Region {
        coordinate,
        from: 0.0,
        to: 0.1,
        unit: "1".to_owned(),
        share_of_excess: 0.5,
        p_value: 1e-20,
        recording: Some(SHARP.to_owned()),
    }
}

/// Every section filled; `SHARP` wherever a text may stand.
fn full() -> DiagnosisPage {
    let text = || SHARP.to_owned();
    let evidence = Evidence {
        log_ratio: 12.0,
        rmse_without_n: 2.0,
        rmse_with_n: 1.0,
        blocks_improved: 9,
        n_blocks: 10,
        p_value: 1e-5,
    };
    let fit = BeforeAfter {
        rmse_before_n: 2.0,
        rmse_after_n: 1.0,
        rmse_all_before_n: 2.2,
        rmse_all_after_n: 1.1,
        noise_floor_n: 0.7,
    };
    let estimate = || PageEstimate { value: 1.0, stderr: Some(0.01), status: text() };
    let mut held_out = recording(SHARP, 4000, true);
    held_out.held_out = true;
    DiagnosisPage {
        title: text(),
        verdict: Verdict::Explained,
        statement: text(),
        warnings: vec![text()],
        as_given: Some(AsGiven {
            estimation: Residual { rmse_n: 76.0, rmse_all_n: 77.0 },
            holdout: Some(Residual { rmse_n: 80.0, rmse_all_n: 81.0 }),
            refitted: Residual { rmse_n: 2.0, rmse_all_n: 2.1 },
            misses: true,
            instrument: Some(text()),
            holdout_missed: vec![text()],
            shifts: vec![Shift {
                parameter: text(),
                given: 0.9,
                refitted: 1.03,
                unit: text(),
                stderr: Some(0.003),
                standard_errors: Some(40.0),
            }],
        }),
        estimation: fit,
        holdout: Some(fit),
        base_parameters: vec![PageBaseParameter {
            name: text(),
            symbol: text(),
            unit: "1".to_owned(),
            before: estimate(),
            after: estimate(),
        }],
        recordings: vec![recording("a.csv", 4000, true), held_out],
        regions: Coordinate::ALL.map(region).to_vec(),
        effects: vec![PageEffect {
            id: text(),
            name: text(),
            summary: text(),
            signature: text(),
            equation: format!("F_a = {SHARP}^2"),
            symbols: vec![Symbol { symbol: SHARP, unit: SHARP, meaning: SHARP }],
            validity: text(),
            source: text(),
            parameters: vec![PageParameter {
                name: text(),
                symbol: text(),
                meaning: text(),
                value: 1.2e-3,
                unit: "m".to_owned(),
                stderr: Some(1e-4),
                status: text(),
            }],
            evidence,
            alternatives: vec![PageAlternative { id: text(), name: text(), because: text(), test: text() }],
            look_alikes: vec![PageAlternative { id: text(), name: text(), because: text(), test: text() }],
            separating_test: text(),
        }],
        empirical: None,
        static_map: false,
        candidates: vec![PageCandidate { id: text(), name: text(), evidence, explains: 0.4, outcome: text() }],
        unknown: PageUnknown {
            regions: vec![region(Coordinate::Speed)],
            implausible: vec![Implausible {
                parameter: text(),
                value: 2.0,
                unit: text(),
                plausible: [0.5, 1.5],
                likely_cause: text(),
            }],
        },
        next_experiment: Some(NextExperiment {
            protocol: text(),
            separates: vec![text(), text()],
            separation_n: 2.0,
            instruction: text(),
        }),
        isolability: Some(Isolability {
            ids: (0..26).map(|index| format!("an-effect-with-a-long-name-{index}{SHARP}")).collect(),
            visible_n: vec![0.1; 26],
            cosine: (0..26).map(|a| (0..26).map(|b| if a == b { 1.0 } else { 0.96 }).collect()).collect(),
        }),
        appendix: PageAppendix {
            tool: text(),
            muscle: text(),
            command: text(),
            date: text(),
            inputs: vec![PageInput { role: text(), path: text(), sha256: text() }],
            options: vec![(text(), text())],
        },
    }
}

/// Nothing but what every diagnosis has.
fn bare(verdict: Verdict, recordings: Vec<PageRecording>) -> DiagnosisPage {
    DiagnosisPage {
        title: "bare".to_owned(),
        verdict,
        statement: String::new(),
        warnings: Vec::new(),
        as_given: None,
        estimation: BeforeAfter {
            rmse_before_n: 0.7,
            rmse_after_n: 0.7,
            rmse_all_before_n: 0.7,
            rmse_all_after_n: 0.7,
            noise_floor_n: 0.7,
        },
        holdout: None,
        base_parameters: Vec::new(),
        recordings,
        regions: Vec::new(),
        effects: Vec::new(),
        empirical: None,
        static_map: false,
        candidates: Vec::new(),
        unknown: PageUnknown::default(),
        next_experiment: None,
        isolability: None,
        appendix: PageAppendix::default(),
    }
}

/// The document without what scripts contain, which has a grammar of its own.
fn without_scripts(html: &str) -> String {
    let mut parts = html.split("<script");
    let mut kept = parts.next().unwrap().to_owned();
    kept.extend(parts.map(|part| part.split_once("</script>").unwrap().1));
    kept
}

/// Panics unless every tag is closed, every attribute quoted, every number finite and nothing is loaded.
fn check_document(html: &str) {
    for call in ["fetch(", "XMLHttpRequest", "import(", "eval(", "http:", "https:", ".src", "WebSocket", "innerHTML"] {
        assert!(html.split("<script>").skip(1).all(|script| !script.contains(call)), "{call}");
    }
    let html = without_scripts(html);
    let html = html.as_str();
    const VOID: [&str; 3] = ["!DOCTYPE", "meta", "br"];
    let mut open: Vec<&str> = Vec::new();
    let mut rest = html;
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
        } else if !tag.ends_with('/') && !VOID.contains(&name) {
            open.push(name);
        }
        rest = &rest[start + tag.len() + 2..];
    }
    assert!(open.is_empty() && rest.trim().is_empty(), "{open:?} {rest}");
    let alone = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for foreign in ["http://", "https://", "url(", "@import", "src=", "<link", "javascript:", " onload"] {
        assert!(!alone.contains(foreign), "{foreign}");
    }
    let odd = html.find("NaN").or_else(|| html.find("inf"));
    let around = odd.map(|at| html[..at].chars().rev().take(80).collect::<Vec<_>>().iter().rev().collect::<String>());
    assert_eq!(around, None, "a number that is not finite");
}

#[test]
fn the_page_is_valid_and_escaped() {
    let html = diagnosis_page(&full()).unwrap();
    check_document(&html);
    assert!(html.starts_with("<!DOCTYPE html>\n<html lang=\"en\">"));
    assert!(html.contains("<title>&lt;b&gt;&amp;\"'&lt;/p&gt;</title>"));
    assert!(!html.contains("<b>") && !html.contains('\u{0}'));
    assert!(html.contains("prefers-color-scheme: dark") && html.contains("@media print"));
}

#[test]
fn equal_input_gives_equal_bytes() {
    assert_eq!(diagnosis_page(&full()).unwrap(), diagnosis_page(&full()).unwrap());
}

#[test]
fn every_color_of_a_figure_has_a_counterpart_in_the_dark() {
    let html = diagnosis_page(&full()).unwrap();
    let (style, body) = html.split_once("</style>").unwrap();
    for attribute in ["fill=\"#", "stroke=\"#"] {
        for rest in body.split(attribute).skip(1) {
            let color = &rest[..6];
            assert!(style.contains(&format!("[{attribute}{color}\"]")), "{attribute}{color}");
        }
    }
}

#[test]
fn agreement_without_anything_else_is_a_page() {
    let html = diagnosis_page(&bare(Verdict::Consistent, vec![recording("a.csv", 3000, false)])).unwrap();
    check_document(&html);
    for text in ["Model and recordings agree", "no recording was held out", "Nowhere: no stretch", "Nothing was added"]
    {
        assert!(html.contains(text), "{text}");
    }
    assert!(!html.contains(">after<"), "a legend names what is not drawn");
}

#[test]
fn a_mismatch_without_a_name_is_a_page() {
    let html = diagnosis_page(&bare(Verdict::Unexplained, Vec::new())).unwrap();
    check_document(&html);
    assert!(html.contains("No effect of the catalogue explains"));
    assert!(html.contains("No samples were handed over"));
}

#[test]
fn effects_without_a_hold_out_say_so() {
    let mut page = full();
    page.holdout = None;
    page.recordings.truncate(1);
    let html = diagnosis_page(&page).unwrap();
    check_document(&html);
    assert!(html.contains("No recording was held out"));
    assert!(html.contains("A loop before and after"));
}

#[test]
fn degenerate_samples_give_a_page() {
    let mut still = recording("still", 60, true);
    for column in [&mut still.contraction_percent, &mut still.travel_mm, &mut still.cycle, &mut still.pressure_kpa] {
        column.fill(0.0);
    }
    still.settled.fill(false);
    let mut holes = recording("holes", 500, true);
    for row in 0..500 {
        if row % 3 == 0 {
            holes.force_n[row] = f64::NAN;
        }
        holes.cycle[row] = f64::NAN;
        holes.travel_mm[row] = f64::INFINITY;
        holes.pressure_kpa[row] = if row % 2 == 0 { f64::NAN } else { 100.0 };
    }
    let mut gone = recording("gone", 20, false);
    gone.base_force_n.fill(f64::NAN);
    let all = vec![recording("one", 1, true), recording("none", 0, false), still, holes, gone];
    for recording in all.clone() {
        check_document(&diagnosis_page(&bare(Verdict::Unexplained, vec![recording.clone()])).unwrap());
        let mut page = full();
        page.recordings = vec![recording];
        check_document(&diagnosis_page(&page).unwrap());
    }
    let mut page = bare(Verdict::Unexplained, all);
    page.estimation = BeforeAfter {
        rmse_before_n: f64::NAN,
        rmse_after_n: f64::NAN,
        rmse_all_before_n: f64::NAN,
        rmse_all_after_n: f64::NAN,
        noise_floor_n: f64::NAN,
    };
    page.holdout = Some(BeforeAfter {
        rmse_before_n: 0.0,
        rmse_after_n: 0.0,
        rmse_all_before_n: 0.0,
        rmse_all_after_n: 0.0,
        noise_floor_n: 0.0,
    });
    check_document(&diagnosis_page(&page).unwrap());
}

#[test]
fn long_and_many_recordings_give_a_page_of_bounded_size() {
    let mut page = full();
    page.recordings = (0..4).map(|index| recording(&format!("{index}.csv"), 20_000, true)).collect();
    let html = diagnosis_page(&page).unwrap();
    assert!(html.len() < 1_500_000, "{} bytes", html.len());
    page.recordings = (0..60).map(|index| recording(&format!("{index}.csv"), 5_000, true)).collect();
    let html = diagnosis_page(&page).unwrap();
    assert!(html.len() < 1_500_000, "{} bytes", html.len());
    assert!(html.contains("The 12 of 60 recordings"));
}

#[test]
fn unequal_columns_are_refused() {
    let mut page = bare(Verdict::Consistent, vec![recording("short.csv", 10, false)]);
    page.recordings[0].settled.pop();
    let message = diagnosis_page(&page).unwrap_err().to_string();
    assert_eq!(message, "recording short.csv: column settled has 9 samples, expected 10 as in time_s");
}

#[test]
fn a_signature_is_drawn_and_an_empty_one_refused() {
    let series =
        |name: &str, xs: Vec<f64>, ys: Vec<f64>| SignatureSeries { name: name.to_owned(), xs, ys, dots: false };
    let panel = |series| SignaturePanel {
        title: SHARP.to_owned(),
        x_label: "x (m)".to_owned(),
        y_label: "y (N)".to_owned(),
        series,
    };
    let figure = |panels| SignatureFigure { title: SHARP.to_owned(), panels };
    let x: Vec<f64> = (0..5000).map(|index| f64::from(index % 1000)).collect();
    let lines = vec![series(SHARP, x.clone(), x.clone()), series("b", vec![0.0, f64::NAN, 2.0], vec![1.0; 3])];
    let svg = signature_figure(&figure(vec![panel(lines), panel(vec![series("c", x.clone(), x)])])).unwrap();
    check_document(&svg);
    assert_eq!(signature_figure(&figure(vec![panel(vec![])])).unwrap_err(), FigureError::NothingToDraw);
    let unequal = signature_figure(&figure(vec![panel(vec![series("d", vec![1.0; 3], vec![1.0; 2])])]));
    assert!(matches!(unequal, Err(FigureError::UnequalColumns { expected: 3, found: 2, .. })));
}

#[test]
fn a_confusion_matrix_grows_with_its_names_and_bears_holes() {
    for n in [0, 1, 26] {
        let names: Vec<String> = (0..n).map(|index| format!("effect-{index}{SHARP}")).collect();
        let counts = (0..n).map(|row| vec![row; n - row]).collect();
        let figure =
            ConfusionFigure { title: SHARP.to_owned(), concealed: names.clone(), named: names.clone(), counts };
        check_document(&confusion_figure(&figure).unwrap());
    }
}

/// Opens the page in a browser, where there is one.
#[test]
fn a_browser_shows_the_page_without_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.html");
    let mut page = full();
    page.recordings[1].name = "held-out.csv".to_owned();
    std::fs::write(&path, diagnosis_page(&page).unwrap()).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scripts/check-report");
    let Ok(output) = std::process::Command::new("python3").arg(script).arg(&path).output() else {
        return println!("skipped: python3 is not installed");
    };
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{said}");
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_page_of_many_long_recordings_stays_small() {
    let mut page = full();
    page.recordings = (0..30).map(|index| recording(&format!("{index}.csv"), 20_000, true)).collect();
    let html = diagnosis_page(&page).unwrap();
    assert!(html.len() < 1_500_000, "{} bytes", html.len());
    assert!(html.contains("The 12 of 30 recordings that differ most."));
}

#[test]
fn what_explains_nothing_is_folded_away() {
    let mut page = full();
    let mut idle = page.candidates[0].clone();
    (idle.name, idle.explains, idle.outcome) = ("idle effect".to_owned(), 0.0, "explains nothing".to_owned());
    page.candidates.push(idle);
    let html = diagnosis_page(&page).unwrap();
    let folded = html.split("<summary>1 more that explain nothing</summary>").nth(1).unwrap();
    assert!(folded.split("</details>").next().unwrap().contains("idle effect"));
}
