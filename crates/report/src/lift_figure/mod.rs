//! The figure of a lift: tracking, errors, torques and forces, and what the muscles do.
//!
//! | panels | show                                                                    | in the paper     |
//! |--------|-------------------------------------------------------------------------|------------------|
//! | a–c    | angle, velocity and acceleration of both arms on the reference          | Figs 9, 15 a c e |
//! | d–f    | their errors                                                            | Fig. 15 b d f    |
//! | g–i    | torque of the load and of the muscle; pressure; tension                 | Figs 12, 14      |
//! | j–l    | deformation of the muscles, its velocity and its acceleration           | Fig. 13          |

mod panel;

use crate::FigureError;
use crate::plot::{Anchor, Canvas, Color, palette};
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
    /// Torque of the load, in N m; negative.
    pub load_torque_n_m: Vec<f64>,
    /// Torque of the muscle, in N m.
    pub muscle_torque_n_m: Vec<f64>,
    /// Pressure in the muscle, in kPa.
    pub pressure_kpa: Vec<f64>,
    /// Pressure that the valve is told, in kPa.
    pub command_kpa: Vec<f64>,
    /// Tension of the muscle, in N.
    pub force_n: Vec<f64>,
    /// Tension that the controller asks for, in N.
    pub command_force_n: Vec<f64>,
    /// Length of the muscle less that at the start, in mm.
    pub deformation_mm: Vec<f64>,
    /// Rate of the length, in mm/s.
    pub length_rate_mm_per_s: Vec<f64>,
    /// Acceleration of the length, in mm/s².
    pub length_acceleration_mm_per_s2: Vec<f64>,
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

/// Draws the figure, as an SVG document of 1500 × 1330 pixels.
///
/// # Errors
/// [`FigureError`] if there is no instant to show.
pub fn lift_figure(figure: &LiftFigure) -> Result<String, FigureError> {
    if figure.arms.iter().all(|arm| arm.angle_rad.iter().all(|angle_rad| !angle_rad.is_finite())) {
        return Err(FigureError::NothingToDraw);
    }
    Canvas::document(1500, 1330, &figure.title, |canvas, sheet| {
        let page = sheet.inset(14.0, 0.0, 14.0, 8.0);
        canvas.bold(&figure.title, (page.left + 14.0, 26.0), Anchor::Start, 19.0, palette::INK);
        canvas.text(&figure.subtitle, (page.left + 14.0, 50.0), Anchor::Start, 13.5, palette::GRAY);
        let rows = page.inset(0.0, 68.0, 0.0, 0.0).rows([1.0; 4], 8.0);
        let cells = rows.map(|row| row.columns([1.0; 3], 14.0));
        let panels = panels(figure);
        for ((panel, cell), letter) in panels.iter().zip(cells.iter().flatten()).zip("abcdefghijkl".chars()) {
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

fn panels(figure: &LiftFigure) -> Vec<PanelData> {
    let [left, right] = &figure.arms;
    let pair = |column: fn(&LiftArm) -> &Vec<f64>| {
        [Curve::new("left", 2.0, LEFT, column(left).clone()), Curve::new("right", 1.0, RIGHT, column(right).clone())]
    };
    let states: [(&str, &str, &str, &str, f64, Signal); 3] = [
        ("Angle of the elbows", "angle (rad)", "Error of the angle", "error (mrad)", 1e3, |arm| &arm.angle_rad),
        ("Angular velocity", "velocity (rad/s)", "Error of the velocity", "error (mrad/s)", 1e3, |arm| {
            &arm.velocity_rad_per_s
        }),
        ("Angular acceleration", "acceleration (rad/s²)", "Error of the acceleration", "error (rad/s²)", 1.0, |arm| {
            &arm.acceleration_rad_per_s2
        }),
    ];
    let mut panels = Vec::new();
    for ((title, axis, ..), reference) in states.iter().zip(&figure.reference) {
        let column = states[panels.len()].5;
        let mut curves = vec![Curve::new("reference", 6.0, REFERENCE, reference.clone())];
        curves.extend(pair(column));
        panels.push(PanelData { title, axis, curves });
    }
    for ((_, _, title, axis, scale, column), reference) in states.iter().zip(&figure.reference) {
        let mut curves: Vec<Curve> = pair(*column).into();
        for curve in &mut curves {
            for (value, should) in curve.values.iter_mut().zip(reference) {
                *value = scale * (should - *value);
            }
        }
        panels.push(PanelData { title, axis, curves });
    }
    let mut torque =
        vec![Curve::new("load", 6.0, REFERENCE, left.load_torque_n_m.iter().map(|torque| -torque).collect())];
    torque.extend(pair(|arm| &arm.muscle_torque_n_m));
    torque[1].text = "muscle, left";
    panels.push(PanelData { title: "Torque at the elbow", axis: "torque (N m)", curves: torque });
    let commanded = |text, column: fn(&LiftArm) -> &Vec<f64>, actual: fn(&LiftArm) -> &Vec<f64>| {
        let mut curves = vec![Curve::new(text, 0.8, palette::SILVER, column(left).clone())];
        curves.extend(pair(actual));
        curves
    };
    panels.push(PanelData {
        title: "Pressure in the muscles",
        axis: "pressure (kPa)",
        curves: commanded("command", |arm| &arm.command_kpa, |arm| &arm.pressure_kpa),
    });
    panels.push(PanelData {
        title: "Tension of the muscles",
        axis: "tension (N)",
        curves: commanded("command", |arm| &arm.command_force_n, |arm| &arm.force_n),
    });
    let lengths: [(&str, &str, Signal); 3] = [
        ("Deformation of the muscles", "length less that at the start (mm)", |arm| &arm.deformation_mm),
        ("Velocity of the length", "velocity (mm/s)", |arm| &arm.length_rate_mm_per_s),
        ("Acceleration of the length", "acceleration (mm/s²)", |arm| &arm.length_acceleration_mm_per_s2),
    ];
    panels.extend(lengths.map(|(title, axis, column)| PanelData { title, axis, curves: pair(column).into() }));
    panels
}
