//! An actuator of MuJoCo without a plugin: a general actuator on a tendon, affine in length and speed.
//!
//! ```text
//! -F = p (g₀ + g₁ L + g₂ dL/dt) + b₀ + b₁ L + b₂ dL/dt
//! ```
//!
//! with the gauge pressure `p` as control and the tendon's length as `L`; MuJoCo counts a force as positive where it lengthens
//! the tendon. Eq. 11 is nearly of this form: the gas pulls with `p` times a parabola in `L`, which a line follows to a percent or
//! two over a stroke, and rubber with a curve. The coefficients are least squares over the part of the operating range in which
//! the muscle pulls. Viscous damping is of this form exactly, and a lag of the pressure is the filter that MuJoCo has before its
//! actuators; friction is that of the tendon, the same at every pressure. Other effects are in it as they settle.

use std::fmt::Write as _;
use std::path::Path;

use nalgebra::{Matrix4, Vector4};
use pam_core::artifact::model::Domain;
use pam_core::effects::{AugmentedModel, Term};

use crate::ExportError;
use crate::grid::{DIRECTIONS, Grid};

/// Pressure at which viscous damping is stated, in Pa; see its page in the catalogue.
const DAMPING_REFERENCE_PA: f64 = 3e5;
/// Limit of the force over the largest of the operating range: a guard, not a part of the model.
const FORCE_LIMIT: f64 = 1.5;

/// Coefficients of the actuator, in SI, and how far it is from the settled force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Actuator {
    /// `g₀`, `g₁`, `g₂`.
    pub gain: [f64; 3],
    /// `b₀`, `b₁`, `b₂`.
    pub bias: [f64; 3],
    /// Friction of the tendon, in N.
    pub friction_n: f64,
    /// Time constant of the pressure, in s; 0 where it has none.
    pub lag_s: f64,
    /// Largest pull of the operating range, in N.
    pub largest_n: f64,
    /// Deviation from the settled force without friction where the muscle pulls: root mean square, and largest, in N.
    pub error_n: [f64; 2],
}

impl Actuator {
    /// The actuator nearest to `model`, whose settled force is `grid`.
    ///
    /// # Errors
    /// [`ExportError::NoPull`] where the muscle hardly pulls anywhere.
    pub fn of(model: &AugmentedModel, grid: &Grid) -> Result<Self, ExportError> {
        let points: Vec<([f64; 2], f64)> = points(grid).filter(|(_, force_n)| *force_n > 0.0).collect();
        let [scale_pa, scale_m] = [grid.pressure_pa[grid.pressure_pa.len() - 1], grid.length_m[0]];
        let row = |[pressure_pa, length_m]: [f64; 2]| {
            let (p, l) = (pressure_pa / scale_pa, length_m / scale_m);
            Vector4::new(p, p * l, 1.0, l)
        };
        let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
        for (at, force_n) in &points {
            let row = row(*at);
            normal += row * row.transpose();
            right += row * *force_n;
        }
        let weights = normal.cholesky().map(|factor| factor.solve(&right)).ok_or(ExportError::NoPull)?;
        let (mut squares, mut largest) = (0.0, 0.0_f64);
        for (at, force_n) in &points {
            let residual_n = row(*at).dot(&weights) - force_n;
            squares += residual_n * residual_n;
            largest = largest.max(residual_n.abs());
        }
        let [damping, damping_with_pressure] = damping(model);
        let [g0, g1, b0, b1] =
            [weights[0] / scale_pa, weights[1] / (scale_pa * scale_m), weights[2], weights[3] / scale_m];
        Ok(Self {
            gain: [-g0, -g1, -damping_with_pressure / DAMPING_REFERENCE_PA],
            bias: [-b0, -b1, -damping],
            friction_n: friction_n(grid),
            lag_s: value(model, "pressure-lag", "time_constant_s").unwrap_or(0.0),
            largest_n: grid.range_n().1,
            error_n: [(squares / points.len() as f64).sqrt(), largest],
        })
    }
}

/// Pressure and length with the force without friction, in N.
fn points(grid: &Grid) -> impl Iterator<Item = ([f64; 2], f64)> {
    let neither = DIRECTIONS.len() / 2;
    grid.length_m.iter().enumerate().flat_map(move |(column, &length_m)| {
        let rows = grid.pressure_pa.iter().enumerate();
        rows.map(move |(row, &pressure_pa)| ([pressure_pa, length_m], grid.at(row, column, neither)))
    })
}

/// Half of the loop between both directions, on average where the muscle pulls in both, in N.
fn friction_n(grid: &Grid) -> f64 {
    let (mut sum_n, mut n) = (0.0, 0.0);
    for column in 0..grid.length_m.len() {
        for row in 0..grid.pressure_pa.len() {
            let (extending_n, contracting_n) = (grid.at(row, column, 0), grid.at(row, column, DIRECTIONS.len() - 1));
            if contracting_n > 0.0 {
                sum_n += 0.5 * (extending_n - contracting_n);
                n += 1.0;
            }
        }
    }
    if n > 0.0 { f64::max(sum_n / n, 0.0) } else { 0.0 }
}

/// Coefficients of viscous damping, in N s/m.
fn damping(model: &AugmentedModel) -> [f64; 2] {
    ["damping_n_s_per_m", "damping_with_pressure_n_s_per_m"]
        .map(|name| value(model, "viscous-damping", name).unwrap_or(0.0))
}

/// A parameter of an effect that the model has.
fn value(model: &AugmentedModel, id: &str, name: &str) -> Option<f64> {
    let term: &Term = model.terms().iter().find(|term| term.effect.page().id == id)?;
    let shapes = term.effect.shape().iter().map(|shape| shape.name);
    let names = shapes.chain(term.effect.amplitudes().iter().map(|amplitude| amplitude.name));
    names.zip(term.shape.iter().chain(&term.amplitudes)).find(|(known, _)| *known == name).map(|(_, value)| *value)
}

/// A scene with a mass that hangs on the muscle, for a file at `path`: tendon and actuator are for scenes of others. `origin` says
/// what it was written from, `without` which effects are in it only as they settle.
///
/// # Errors
/// [`ExportError::NoName`] where the file's name gives none.
pub fn scene(
    path: &Path,
    actuator: &Actuator,
    domain: &Domain,
    origin: &[String],
    without: &[&str],
) -> Result<String, ExportError> {
    let prefix = crate::c::prefix(path)?;
    let name = prefix.trim_end_matches('_');
    let Actuator { gain, bias, friction_n, lag_s, largest_n, error_n } = *actuator;
    let mut about = String::new();
    for line in origin {
        let _ = writeln!(about, "    {line}");
    }
    let [rms_n, most_n] = error_n;
    let _ = write!(
        about,
        "\n    Control is the gauge pressure in Pa, the length of the tendon that of the muscle. The actuator is affine in the length: it\n    \
         differs from the settled force of the model by {rms_n:.1} N (RMS), {most_n:.1} N at most, where the muscle pulls, of up to\n    \
         {largest_n:.0} N. Friction is {friction_n:.1} N at every pressure.\n"
    );
    if !without.is_empty() {
        let _ = writeln!(about, "    In it only as they settle: {}.", without.join(", "));
    }
    // Two hyphens would end what XML takes for a comment.
    let about = about.replace("--", "- -");
    let list = |values: [f64; 3]| values.map(|value| format!("{value:?}")).join(" ");
    let lag = if lag_s > 0.0 { format!(" dyntype=\"filterexact\" dynprm=\"{lag_s:?}\"") } else { String::new() };
    let [lowest_pa, highest_pa] = domain.pressure_pa;
    let (lowest_pa, longest_m, limit_n) = (lowest_pa.min(0.0), domain.length_m[1], FORCE_LIMIT * largest_n);
    Ok(format!(
        "<mujoco model=\"{name}\">
  <!-- A pneumatic muscle that holds a mass of 5 kg. Take tendon and actuator into a scene of your own.

{about}  -->
  <option timestep=\"0.001\" integrator=\"implicitfast\"/>
  <worldbody>
    <site name=\"{name}_origin\"/>
    <body name=\"{name}_load\" pos=\"0 0 {:?}\">
      <joint name=\"{name}_slide\" type=\"slide\" axis=\"0 0 1\"/>
      <geom type=\"sphere\" size=\"0.05\" mass=\"5\" contype=\"0\" conaffinity=\"0\"/>
      <site name=\"{name}_insertion\"/>
    </body>
  </worldbody>
  <tendon>
    <spatial name=\"{name}\" frictionloss=\"{friction_n:?}\">
      <site site=\"{name}_origin\"/>
      <site site=\"{name}_insertion\"/>
    </spatial>
  </tendon>
  <actuator>
    <general name=\"{name}\" tendon=\"{name}\" ctrllimited=\"true\" ctrlrange=\"{lowest_pa:?} {highest_pa:?}\"
             forcelimited=\"true\" forcerange=\"{:?} 0\"{lag}
             gaintype=\"affine\" gainprm=\"{}\"
             biastype=\"affine\" biasprm=\"{}\"/>
  </actuator>
</mujoco>
",
        -longest_m,
        -limit_n,
        list(gain),
        list(bias)
    ))
}
