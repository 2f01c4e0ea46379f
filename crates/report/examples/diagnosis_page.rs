//! The page of a diagnosis, with invented data: a braid whose friction builds up over a distance.
//!
//! `cargo run -p pam-report --example diagnosis_page [explained|consistent|signature|confusion] > report.html`

use std::f64::consts::PI;
use std::io::Write as _;

use pam_artifact::diagnosis::{BeforeAfter, Evidence, Implausible, Isolability, NextExperiment, Region, Verdict};
use pam_muscle::Coordinate;
use pam_report::{
    ConfusionFigure, DiagnosisPage, PageAlternative, PageAppendix, PageCandidate, PageEffect, PageInput, PageParameter,
    PageRecording, PageUnknown, SignatureFigure, SignaturePanel, SignatureSeries, confusion_figure, diagnosis_page,
    signature_figure,
};

const REST_MM: f64 = 267.0;
const NOISE_N: f64 = 0.6;
const IDS: [&str; 12] = [
    "presliding-hysteresis",
    "rubber-hysteresis",
    "stribeck",
    "viscous-damping",
    "rate-dependent-hysteresis",
    "viscoelastic-relaxation",
    "pressure-creep",
    "threshold-pressure",
    "end-taper",
    "pressure-lag",
    "series-compliance",
    "force-drift",
];

/// Noise that is the same every time: uniform numbers from a congruential generator, summed to a bell.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let uniform = |state: &mut u64| {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        (0..12).map(|_| uniform(&mut self.0)).sum()
    }
}

/// One recording; `drive` gives pressure, in kPa, and length, in mm.
fn recording(name: &str, end_s: f64, effect: bool, drive: impl Fn(f64) -> (f64, f64)) -> PageRecording {
    const N: usize = 8000;
    let mut noise = Noise(name.bytes().map(u64::from).sum());
    let mut out = PageRecording { name: name.to_owned(), ..PageRecording::default() };
    let (mut memory, mut travel_mm, mut rest_s, mut sign, mut cycle) = (-1.0, 5.0, 0.0, 1.0, 1.0);
    let mut model_n = Vec::new();
    let step_s = end_s / N as f64;
    for row in 0..N {
        let time_s = step_s * row as f64;
        let (pressure_kpa, length_mm) = drive(time_s);
        let (pressure_before_kpa, length_before_mm) = drive(time_s - step_s);
        let shortening_mm = length_before_mm - length_mm;
        let moved_mm = if shortening_mm == 0.0 { 0.02 * (pressure_kpa - pressure_before_kpa) } else { shortening_mm };
        if moved_mm * sign < 0.0 {
            (sign, travel_mm) = (-sign, 0.0);
            cycle += if sign > 0.0 { 1.0 } else { 0.0 };
        }
        travel_mm += moved_mm.abs();
        rest_s = if moved_mm == 0.0 { rest_s + step_s } else { 0.0 };
        let contraction = 1.0 - length_mm / REST_MM;
        let static_n = 0.314 * pressure_kpa * (1.9 * (1.0 - contraction).powi(2) - 0.95);
        let friction_n = 2.5 + 0.016 * pressure_kpa;
        memory += (1.0 - f64::exp(-moved_mm.abs() / 1.2)) * (sign - memory);
        let share = if effect { memory } else { sign };
        out.time_s.push(time_s);
        out.pressure_kpa.push(pressure_kpa + 0.4 * noise.next());
        out.contraction_percent.push(100.0 * contraction);
        out.speed_mm_per_s.push(shortening_mm.abs() / step_s);
        out.travel_mm.push(travel_mm);
        out.rest_s.push(rest_s);
        out.cycle.push(cycle);
        out.force_n.push(static_n - friction_n * share + NOISE_N * noise.next());
        out.base_force_n.push(static_n - friction_n * sign * if effect { 0.86 } else { 1.0 });
        model_n.push(static_n - friction_n * (0.97 * share + 0.02 * sign));
        out.settled.push(travel_mm > 0.05);
    }
    if effect {
        out.model_force_n = Some(model_n);
        let turns: Vec<usize> = (1..N).filter(|&row| out.travel_mm[row] < out.travel_mm[row - 1]).collect();
        for turn in turns {
            let end = (turn..N).find(|&row| out.travel_mm[row] > 1.6).unwrap_or(N - 1);
            out.stretches.push((out.time_s[turn], out.time_s[end]));
        }
    }
    out
}

fn isobaric(pressure_kpa: f64, effect: bool) -> PageRecording {
    recording(&format!("isobaric-{pressure_kpa}kPa.csv"), 60.0, effect, move |time_s| {
        let phase = 2.0 * PI * time_s / 20.0;
        (pressure_kpa + 2.0 * phase.sin(), REST_MM - 27.0 * (1.0 - phase.cos()))
    })
}

fn isometric(length_mm: f64, effect: bool) -> PageRecording {
    recording(&format!("isometric-{length_mm}mm.csv"), 60.0, effect, move |time_s| {
        // Ramps with a hold between.
        let phase = (time_s / 20.0).rem_euclid(1.0);
        let share = if phase < 0.5 { (3.0 * phase).min(1.0) } else { (1.0 - 3.0 * (phase - 0.5)).max(0.0) };
        (60.0 + 460.0 * share, length_mm)
    })
}

fn evidence(log_ratio: f64, rmse_with_n: f64, blocks_improved: usize, p_value: f64) -> Evidence {
    Evidence { log_ratio, rmse_without_n: 2.29, rmse_with_n, blocks_improved, n_blocks: 24, p_value }
}

fn candidates() -> Vec<PageCandidate> {
    let rows = [
        (0, "pre-sliding hysteresis of the braid", evidence(61.4, 0.66, 24, 3e-14), 0.97, "named"),
        (10, "compliance in series", evidence(22.0, 1.31, 20, 4e-7), 0.61, "explains nothing beside pre-sliding"),
        (1, "hysteresis of the rubber", evidence(19.7, 1.4, 19, 2.3e-6), 0.55, "worse: it does not grow with pressure"),
        (9, "lag of the pressure line", evidence(3.1, 2.1, 15, 0.031), 0.12, "explains nothing beside pre-sliding"),
        (3, "viscous damping", evidence(0.4, 2.26, 13, 0.61), 0.01, "no evidence"),
        (11, "drift of the load cell", evidence(-0.9, 2.31, 9, 1.0), 0.0, "no evidence"),
    ];
    let candidate = |(id, name, evidence, explains, outcome): (usize, &str, Evidence, f64, &str)| PageCandidate {
        id: IDS[id].to_owned(),
        name: name.to_owned(),
        evidence,
        explains,
        outcome: outcome.to_owned(),
    };
    rows.map(candidate).to_vec()
}

fn effect() -> PageEffect {
    PageEffect {
        id: IDS[0].to_owned(),
        name: "pre-sliding hysteresis of the braid".to_owned(),
        summary: "Strands that rub against one another bend before they slide, so after each reversal the friction \
                  builds up over a distance of the order of a millimetre instead of jumping at once. Its full value \
                  grows with the pressure."
            .to_owned(),
        signature: "The residual sits in the first millimetres after every reversal and changes sign with the kind \
                    of reversal; it does not depend on speed, nor on how long the muscle rested."
            .to_owned(),
        equation: "F = F_static(p, L) - F_c(p, L) z,  z = Σ w_i z_i,  z_i ← clamp(z_i + Δx / r_i, -1, 1),  \
                   r_i = δ (0.15 … 4.5)"
            .to_owned(),
        symbols: Vec::new(),
        validity: String::new(),
        source: "Al-Bender, Lampaert and Swevers (2005), IEEE Trans. Automatic Control 50(11)".to_owned(),
        parameters: vec![
            PageParameter {
                name: "slip_distance_m".to_owned(),
                symbol: "δ".to_owned(),
                meaning: "63 % of the friction are there after it".to_owned(),
                value: 1.21e-3,
                unit: "m".to_owned(),
                stderr: Some(3.4e-5),
                status: "fitted".to_owned(),
            },
            PageParameter {
                name: "friction_share".to_owned(),
                symbol: String::new(),
                meaning: "share of the friction of eq. 11".to_owned(),
                value: 0.973,
                unit: "1".to_owned(),
                stderr: Some(0.012),
                status: "fitted".to_owned(),
            },
        ],
        evidence: evidence(61.4, 0.66, 24, 3e-14),
        alternatives: vec![PageAlternative {
            id: IDS[10].to_owned(),
            name: "compliance in series".to_owned(),
            because: "a soft fixture also makes the slope after a reversal finite".to_owned(),
            test: "minor loops at several pressures: the slope of a fixture is the same at all of them".to_owned(),
        }],
        look_alikes: Vec::new(),
        separating_test: "nested minor loops of 10, 5, 2 and 1 mm at constant pressure, at two speeds".to_owned(),
    }
}

fn region(coordinate: Coordinate, from: f64, to: f64, share_of_excess: f64, p_value: f64) -> Region {
    Region { coordinate, from, to, unit: coordinate.unit().to_owned(), share_of_excess, p_value, recording: None }
}

fn isolability() -> Isolability {
    let near = |a: usize, b: usize| match (a.min(b), a.max(b)) {
        (0, 10) => 0.97,
        (0, 1) => 0.88,
        (1, 10) => 0.83,
        (3, 4) => 0.72,
        (5, 6) => 0.64,
        (7, 8) => -0.93,
        (a, b) if a == b => 1.0,
        (a, b) => ((a * 7 + b * 13) % 11) as f64 * 0.04,
    };
    Isolability {
        ids: IDS.map(str::to_owned).to_vec(),
        visible_n: vec![2.1, 1.4, 0.9, 0.7, 0.8, 1.9, 0.4, 2.6, 1.2, 0.5, 1.7, 0.25],
        cosine: (0..12).map(|a| (0..12).map(|b| near(a, b)).collect()).collect(),
    }
}

/// Root mean squares over settled samples, before and after.
fn fit(recordings: &[PageRecording], held_out: bool) -> BeforeAfter {
    let rmse_n = |after: bool| {
        let squares: Vec<f64> = recordings
            .iter()
            .filter(|recording| recording.held_out == held_out)
            .flat_map(|recording| {
                let model = recording.model_force_n.as_ref().filter(|_| after).unwrap_or(&recording.base_force_n);
                recording.force_n.iter().zip(model).map(|(force, model)| (force - model).powi(2))
            })
            .collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let (before_n, after_n) = (rmse_n(false), rmse_n(true));
    BeforeAfter {
        rmse_before_n: before_n,
        rmse_after_n: after_n,
        rmse_all_before_n: before_n,
        rmse_all_after_n: after_n,
        noise_floor_n: NOISE_N,
    }
}

fn page(effect_is_there: bool) -> DiagnosisPage {
    let mut recordings = vec![
        isobaric(150.0, effect_is_there),
        isobaric(450.0, effect_is_there),
        isometric(235.0, effect_is_there),
        isobaric(300.0, effect_is_there),
    ];
    recordings[3].held_out = true;
    let (estimation, holdout) = (fit(&recordings, false), fit(&recordings, true));
    let inputs = [("model", "model.json"), ("estimation", "isobaric-150kPa.csv"), ("held out", "isobaric-300kPa.csv")];
    let mut page = DiagnosisPage {
        title: "Diagnosis of the 267 mm muscle".to_owned(),
        verdict: Verdict::Consistent,
        statement: "Model and recordings differ by no more than the noise of the load cell.".to_owned(),
        warnings: Vec::new(),
        as_given: None,
        estimation,
        holdout: Some(holdout),
        base_parameters: Vec::new(),
        recordings,
        regions: Vec::new(),
        effects: Vec::new(),
        empirical: None,
        static_map: false,
        candidates: Vec::new(),
        unknown: PageUnknown::default(),
        next_experiment: None,
        isolability: Some(isolability()),
        appendix: PageAppendix {
            tool: "pam-diagnose 0.1.0".to_owned(),
            muscle: "muscle A".to_owned(),
            command: "pam-diagnose a.csv b.csv --model model.json".to_owned(),
            date: "2024-02-29".to_owned(),
            inputs: inputs
                .map(|(role, path)| PageInput {
                    role: role.to_owned(),
                    path: path.to_owned(),
                    sha256: "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08".to_owned(),
                })
                .to_vec(),
            options: [("matters above", "half of the noise floor"), ("most effects", "3"), ("seed", "1")]
                .map(|(name, value)| (name.to_owned(), value.to_owned()))
                .to_vec(),
        },
    };
    if effect_is_there {
        page.verdict = Verdict::Ambiguous;
        page.statement = "The model leaves out pre-sliding hysteresis of the braid; a compliance in series would look \
                          the same in these recordings."
            .to_owned();
        page.warnings = vec!["Pressures below 60 kPa were not recorded; thresholds cannot be judged.".to_owned()];
        page.regions = vec![
            region(Coordinate::TravelSinceReversal, 5e-5, 1.6e-3, 0.71, 2e-12),
            region(Coordinate::Pressure, 380e3, 520e3, 0.44, 8e-5),
            region(Coordinate::Contraction, 0.0, 0.03, 0.31, 0.004),
        ];
        page.effects = vec![effect()];
        page.candidates = candidates();
        page.unknown = PageUnknown {
            regions: vec![region(Coordinate::Speed, 0.0, 0.4e-3, 0.02, 0.03)],
            implausible: vec![Implausible {
                parameter: "k1".to_owned(),
                value: 1.19,
                unit: "1".to_owned(),
                plausible: [0.9, 1.1],
                likely_cause: "a pressure gauge that reads too low, or a rest radius that is too small".to_owned(),
            }],
        };
        page.next_experiment = Some(NextExperiment {
            protocol: "minor-loops".to_owned(),
            separates: vec![IDS[0].to_owned(), IDS[10].to_owned()],
            separation_n: 1.8,
            instruction: "hold 150, 300 and 450 kPa in turn; at each, move the clamp in loops of 10, 5, 2 and 1 mm \
                          about the middle of the stroke, at 1 and 10 mm/s."
                .to_owned(),
        });
    }
    page
}

fn signature() -> SignatureFigure {
    let recording = isobaric(300.0, true);
    let rows = 2667..5334;
    let take = |values: &[f64]| values[rows.clone()].to_vec();
    let series =
        |name: &str, xs: Vec<f64>, ys: Vec<f64>| SignatureSeries { name: name.to_owned(), xs, ys, dots: false };
    let model = recording.model_force_n.clone().unwrap_or_default();
    let x = take(&recording.contraction_percent);
    let residual = model.iter().zip(&recording.base_force_n).map(|(model, base)| model - base).collect::<Vec<_>>();
    SignatureFigure {
        title: "pre-sliding hysteresis of the braid".to_owned(),
        panels: vec![
            SignaturePanel {
                title: "Force over a loop at 300 kPa".to_owned(),
                x_label: "contraction (%)".to_owned(),
                y_label: "force (N)".to_owned(),
                series: vec![
                    series("without", x.clone(), take(&recording.base_force_n)),
                    series("with the effect", x, take(&model)),
                ],
            },
            SignaturePanel {
                title: "Residual after a reversal".to_owned(),
                x_label: "travel since reversal (mm)".to_owned(),
                y_label: "residual (N)".to_owned(),
                series: vec![series("residual", take(&recording.travel_mm), take(&residual))],
            },
        ],
    }
}

fn confusion() -> ConfusionFigure {
    let mut names = IDS.map(str::to_owned).to_vec();
    names.push("nothing".to_owned());
    let count = |row: usize, column: usize| match (row, column) {
        (row, column) if row == column => 18 + (row * 5) % 7,
        (0, 10) | (8, 7) => 2,
        (5, 6) | (3, 12) => 1,
        _ => 0,
    };
    ConfusionFigure {
        title: "Effects concealed and effects named".to_owned(),
        counts: (0..13).map(|row| (0..13).map(|column| count(row, column)).collect()).collect(),
        concealed: names.clone(),
        named: names,
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = match std::env::args().nth(1).as_deref() {
        Some("consistent") => diagnosis_page(&page(false))?,
        Some("signature") => signature_figure(&signature())?,
        Some("confusion") => confusion_figure(&confusion())?,
        _ => diagnosis_page(&page(true))?,
    };
    std::io::stdout().lock().write_all(text.as_bytes())?;
    Ok(())
}
