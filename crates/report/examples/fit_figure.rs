//! Draws the figure of a fit for made-up recordings, to look at: `isobaric`, `isometric` or `mixed` on the
//! command line, SVG on standard output.

use std::f64::consts::PI;
use std::io::Write as _;

use pam_report::{FitFigure, FitRecording, Role, SwarmStart, fit_figure};

/// Rest length, in mm.
const REST_MM: f64 = 267.0;

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

fn static_force_n(pressure_kpa: f64, length_mm: f64) -> f64 {
    let shortened = 1.0 - length_mm / REST_MM;
    0.314 * pressure_kpa * (1.9 * (1.0 - shortened).powi(2) - 0.95)
}

/// One recording; `drive` gives pressure and length at a time and whether the muscle contracts.
fn recording(name: &str, role: Role, end_s: f64, drive: impl Fn(f64) -> (f64, f64, bool)) -> FitRecording {
    let mut noise = Noise(name.bytes().map(u64::from).sum());
    let mut recording = FitRecording {
        name: name.to_owned(),
        role,
        time_s: Vec::new(),
        pressure_kpa: Vec::new(),
        length_mm: Vec::new(),
        force_n: Vec::new(),
        model_n: Vec::new(),
        direction: Vec::new(),
    };
    let (mut memory_n, mut model_memory_n) = (0.0, 0.0);
    for step in 0..4000 {
        let time_s = end_s * f64::from(step) / 4000.0;
        let (pressure_kpa, length_mm, contracting) = drive(time_s);
        let sign = if contracting { 1.0 } else { -1.0 };
        let friction_n = -sign * (1.5 + 0.02 * pressure_kpa);
        memory_n += 0.03 * (friction_n - memory_n);
        model_memory_n += 0.2 * (friction_n - model_memory_n);
        let static_n = static_force_n(pressure_kpa, length_mm);
        recording.time_s.push(time_s);
        recording.pressure_kpa.push(pressure_kpa + 0.4 * noise.next());
        recording.length_mm.push(length_mm + 0.02 * noise.next());
        // Missing in the model: a taper of the ends that grows with contraction.
        let taper_n = 0.004 * pressure_kpa * ((REST_MM - length_mm) / 40.0).powi(3);
        recording.force_n.push(static_n + memory_n - taper_n + 0.9 * noise.next());
        recording.model_n.push(static_n + model_memory_n);
        recording.direction.push(sign);
    }
    recording
}

fn triangle(phase: f64) -> (f64, bool) {
    let phase = phase.rem_euclid(1.0);
    if phase < 0.5 { (2.0 * phase, true) } else { (2.0 - 2.0 * phase, false) }
}

fn isobaric(pressure_kpa: f64, role: Role) -> FitRecording {
    recording(&format!("isobaric-{pressure_kpa}kPa.csv"), role, 60.0, move |time_s| {
        let (share, contracting) = triangle(time_s / 20.0);
        (pressure_kpa + 2.0 * (2.0 * PI * time_s / 20.0).sin(), REST_MM - 55.0 * share, contracting)
    })
}

fn isometric(length_mm: f64, role: Role) -> FitRecording {
    recording(&format!("isometric-{length_mm}mm.csv"), role, 40.0, move |time_s| {
        let (share, contracting) = triangle(time_s / 40.0);
        let steps = 12.0 * share;
        // Each step settles within a second or so.
        let settled = steps.floor()
            + if contracting { (8.0 * steps.fract()).min(1.0) } else { (8.0 * steps.fract() - 7.0).max(0.0) };
        (50.0 * settled, length_mm, contracting)
    })
}

fn starts() -> Vec<SwarmStart> {
    (0..8)
        .map(|start| {
            let mut noise = Noise(start);
            let mut best = 90.0 + 20.0 * noise.next();
            let floor = if start == 5 { 3.4 } else { 1.08 + 0.03 * start as f64 };
            let best_rmse_n = (0..120)
                .map(|_| {
                    if noise.next() > 0.2 {
                        best = floor + (best - floor) * (0.75 + 0.1 * noise.next()).clamp(0.3, 1.0);
                    }
                    best
                })
                .collect();
            SwarmStart { best_rmse_n, polished_rmse_n: Some(if start == 5 { 3.1 } else { 1.052 }) }
        })
        .collect()
}

fn rmse_n(recordings: &[FitRecording], role: Role) -> Option<f64> {
    let chosen = recordings.iter().filter(|recording| recording.role == role);
    let squares: Vec<f64> =
        chosen.flat_map(|r| r.force_n.iter().zip(&r.model_n).map(|(force, model)| (force - model).powi(2))).collect();
    (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    use Role::{Estimation, Validation};
    let which = std::env::args().nth(1).unwrap_or_else(|| "isobaric".to_owned());
    let mut recordings = Vec::new();
    if which != "isometric" {
        recordings.extend([100.0, 200.0, 300.0, 400.0].map(|pressure_kpa| isobaric(pressure_kpa, Estimation)));
        recordings.push(isobaric(250.0, Validation));
    }
    if which != "isobaric" {
        recordings.extend([220.0, 235.0, 250.0, 265.0].map(|length_mm| isometric(length_mm, Estimation)));
        recordings.push(isometric(242.0, Validation));
    }
    let figure = FitFigure {
        title: "Fit of the 267 mm muscle".to_owned(),
        noise_floor_n: Some(0.9),
        rmse_estimation_n: rmse_n(&recordings, Estimation),
        rmse_validation_n: rmse_n(&recordings, Validation),
        recordings,
        starts: starts(),
    };
    std::io::stdout().lock().write_all(fit_figure(&figure)?.as_bytes())?;
    Ok(())
}
