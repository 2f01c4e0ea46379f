//! The figure of a lift: where the arms went, how far off they were, and what the muscles did for it.
//!
//! | panels | show                                                  | in the paper  |
//! |--------|-------------------------------------------------------|---------------|
//! | a–c    | angle on the reference, its error, that of the velocity | Fig. 15 a b d |
//! | d      | acceleration on the reference                         | Fig. 15 e     |
//! | e, f   | pressure and tension of the muscles                   | Figs 12, 14   |
//!
//! Torques, and the length of the muscles with its velocity and acceleration, follow from these by the geometry of the arm;
//! they are columns of the track.

mod panel;

use crate::FigureError;
use crate::plot::{Anchor, Canvas, Color, Mark, palette};
use panel::{Curve, draw};

/// One arm; every column has one entry per instant. A lift that was given up is shorter than the reference.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LiftArm {
    /// Angle, in rad.
    pub angle_rad: Vec<f64>,
    /// Angular velocity, in rad/s.
    pub velocity_rad_per_s: Vec<f64>,
    /// Angular acceleration, in rad/s².
    pub acceleration_rad_per_s2: Vec<f64>,
    /// Pressure in the muscle, in kPa.
    pub pressure_kpa: Vec<f64>,
    /// Pressure that the valve is told, in kPa.
    pub command_kpa: Vec<f64>,
    /// Tension of the muscle, in N.
    pub force_n: Vec<f64>,
    /// Tension that the controller asks for, in N.
    pub command_force_n: Vec<f64>,
}

/// Everything that the figure shows.
#[derive(Debug, Clone, PartialEq)]
pub struct LiftFigure {
    /// Headline.
    pub title: String,
    /// Line below it.
    pub subtitle: String,
    /// Time, in s.
    pub time_s: Vec<f64>,
    /// Reference: angle (rad), velocity (rad/s), acceleration (rad/s²).
    pub reference: [Vec<f64>; 3],
    /// Left and right arm.
    pub arms: [LiftArm; 2],
}

/// Color of the left arm.
const LEFT: Color = palette::BLUE;
/// Color of the right arm.
const RIGHT: Color = palette::VERMILION;
/// Color of what should be.
const REFERENCE: Color = Color::new(0xC4, 0xC4, 0xC4);

/// Draws the figure, as an SVG document of 1000 × 920 pixels.
///
/// # Errors
/// [`FigureError`] if there is no instant to show.
pub fn lift_figure(figure: &LiftFigure) -> Result<String, FigureError> {
    if figure.arms.iter().all(|arm| arm.angle_rad.iter().all(|angle_rad| !angle_rad.is_finite())) {
        return Err(FigureError::NothingToDraw);
    }
    Canvas::document(1000, 920, &figure.title, |canvas, sheet| {
        let page = sheet.inset(14.0, 0.0, 14.0, 8.0);
        canvas.bold(&figure.title, (page.left + 14.0, 26.0), Anchor::Start, 19.0, palette::INK);
        canvas.text(&figure.subtitle, (page.left + 14.0, 50.0), Anchor::Start, 13.5, palette::GRAY);
        let rows = page.inset(0.0, 68.0, 0.0, 0.0).rows([1.0; 3], 8.0);
        let cells = rows.map(|row| row.columns([1.0; 2], 14.0));
        let panels = panels(figure);
        for ((panel, cell), letter) in panels.iter().zip(cells.iter().flatten()).zip("abcdef".chars()) {
            draw(canvas, *cell, &letter.to_string(), panel, &figure.time_s);
        }
    })
}

/// One panel: title, axis, curves.
struct PanelData {
    title: &'static str,
    axis: &'static str,
    curves: Vec<Curve>,
}

/// One signal of an arm.
type Signal = fn(&LiftArm) -> &Vec<f64>;

fn panels(figure: &LiftFigure) -> [PanelData; 6] {
    let [left, right] = &figure.arms;
    let [angle, velocity, acceleration] = &figure.reference;
    let pair = |signal: Signal| {
        // Where both arms do the same, the dashes let the line below them be seen.
        let [line, dashes] = [Mark::Line(2.0), Mark::Dashes(1.8)];
        [
            Curve::new("left", line, LEFT, signal(left).clone()),
            Curve::new("right", dashes, RIGHT, signal(right).clone()),
        ]
    };
    // Signals that should be what is drawn broad and gray below them.
    let on = |text: &'static str, width: f64, should: &[f64], signal: Signal| {
        let mut curves = vec![Curve::new(text, Mark::Line(width), REFERENCE, should.to_vec())];
        curves.extend(pair(signal));
        curves
    };
    let errors = |should: &[f64], signal: Signal| {
        pair(signal).map(|curve| curve.mapped(should, |should, value| 1e3 * (should - value))).into()
    };
    let panel = |title, axis, curves| PanelData { title, axis, curves };
    [
        panel("Angle of the elbows", "angle (rad)", on("reference", 6.0, angle, |arm| &arm.angle_rad)),
        panel("Tracking error, angle", "error (mrad)", errors(angle, |arm| &arm.angle_rad)),
        panel("Tracking error, velocity", "error (mrad/s)", errors(velocity, |arm| &arm.velocity_rad_per_s)),
        panel(
            "Angular acceleration",
            "acceleration (rad/s²)",
            on("reference", 6.0, acceleration, |arm| &arm.acceleration_rad_per_s2),
        ),
        panel(
            "Muscle pressure",
            "pressure (kPa)",
            on("command, left", 4.0, &left.command_kpa, |arm| &arm.pressure_kpa),
        ),
        panel("Muscle tension", "tension (N)", on("command, left", 4.0, &left.command_force_n, |arm| &arm.force_n)),
    ]
}
