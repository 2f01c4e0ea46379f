//! A muscle of MuJoCo without a plugin: a general actuator on a tendon, affine in length and speed, and springs of that tendon.
//!
//! ```text
//! F = max(-[p (g₀ + g₁ L + g₂ dL/dt) + b₀ + b₁ L + b₂ dL/dt], 0) + Σ k_i max(L - L_i, 0)
//! ```
//!
//! with the gauge pressure `p` as control and the tendon's length as `L`; MuJoCo counts a force of an actuator as positive where
//! it lengthens the tendon. Eq. 11 is nearly of this form: the gas pulls with `p` times a parabola in `L`, which a line follows to
//! a percent or two over a stroke, and rubber resists ever more steeply towards the rest length, as springs do that become taut
//! one after another. The coefficients are least squares over the part of the operating range in which the muscle pulls, no
//! spring below zero. Viscous damping is of this form exactly, and a lag of the pressure is the filter that MuJoCo has before its
//! actuators; friction is that of the tendon, the same at every pressure. Other effects are in it as they settle.

use std::fmt::Write as _;
use std::path::Path;

use nalgebra::{DMatrix, DVector};
use pam_artifact::model::Domain;
use pam_muscle::effects::{AugmentedModel, Term};

use crate::ExportError;
use crate::grid::{DIRECTIONS, Grid};

/// Pressure at which viscous damping is stated, in Pa; see its page in the catalogue.
const DAMPING_REFERENCE_PA: f64 = 3e5;
/// Where springs may become taut, as shares of the range of length.
const TAUT: [f64; 6] = [0.3, 0.5, 0.65, 0.8, 0.9, 0.96];
/// Limit of the force over the largest of the operating range: a guard, not a part of the model.
const FORCE_LIMIT: f64 = 1.5;

/// Coefficients of the muscle, in SI, and how far it is from the settled force.
#[derive(Debug, Clone, PartialEq)]
pub struct Actuator {
    /// `g₀`, `g₁`, `g₂`.
    pub gain: [f64; 3],
    /// `b₀`, `b₁`, `b₂`.
    pub bias: [f64; 3],
    /// `L_i` and `k_i` of every spring.
    pub springs: Vec<[f64; 2]>,
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
        let ([g0, g1, b0, b1], springs) = fitted(&points, grid).ok_or(ExportError::NoPull)?;
        let [damping, damping_with_pressure] = damping(model);
        let mut actuator = Self {
            gain: [-g0, -g1, -damping_with_pressure / DAMPING_REFERENCE_PA],
            bias: [-b0, -b1, -damping],
            springs,
            friction_n: friction_n(grid),
            lag_s: value(model, "pressure-lag", "time_constant_s").unwrap_or(0.0),
            largest_n: grid.range_n().1,
            error_n: [0.0; 2],
        };
        let (mut squares, mut largest) = (0.0, 0.0_f64);
        for ([pressure_pa, length_m], force_n) in &points {
            let residual_n = actuator.force_n(*pressure_pa, *length_m) - force_n;
            squares += residual_n * residual_n;
            largest = largest.max(residual_n.abs());
        }
        actuator.error_n = [(squares / points.len() as f64).sqrt(), largest];
        Ok(actuator)
    }

    /// Pull at rest without friction, in N.
    pub fn force_n(&self, pressure_pa: f64, length_m: f64) -> f64 {
        let [g0, g1, _] = self.gain;
        let [b0, b1, _] = self.bias;
        let active_n = f64::max(-(pressure_pa * (g0 + g1 * length_m) + b0 + b1 * length_m), 0.0);
        active_n + self.springs.iter().map(|[taut_m, n_per_m]| n_per_m * (length_m - taut_m).max(0.0)).sum::<f64>()
    }
}

/// `g₀`, `g₁`, `b₀`, `b₁` of a pull, and springs as lengths and stiffnesses; none where the points do not tell them.
fn fitted(points: &[([f64; 2], f64)], grid: &Grid) -> Option<([f64; 4], Vec<[f64; 2]>)> {
    let (shortest_m, longest_m) = (grid.length_m[0], grid.length_m[grid.length_m.len() - 1]);
    let (scale_pa, span_m) = (grid.pressure_pa[grid.pressure_pa.len() - 1], longest_m - shortest_m);
    let mut taut = TAUT.to_vec();
    loop {
        let n = 4 + taut.len();
        let (mut normal, mut right) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for ([pressure_pa, length_m], force_n) in points {
            let (p, x) = (pressure_pa / scale_pa, (length_m - shortest_m) / span_m);
            let hinges = taut.iter().map(|from| (x - from).max(0.0));
            let row = DVector::from_iterator(n, [p, p * x, 1.0, x].into_iter().chain(hinges));
            normal += &row * row.transpose();
            right += row * *force_n;
        }
        let weights = normal.cholesky()?.solve(&right);
        // A spring that would push is none: without the worst of them the others are found anew.
        let worst = (0..taut.len()).min_by(|one, other| weights[4 + one].total_cmp(&weights[4 + other]));
        match worst.filter(|&worst| weights[4 + worst] < 0.0) {
            Some(worst) => {
                taut.remove(worst);
            }
            None => {
                let [constant, slope] = [weights[0] / scale_pa, weights[1] / (scale_pa * span_m)];
                let [bias, bias_slope] = [weights[2], weights[3] / span_m];
                let springs = taut.iter().zip(weights.iter().skip(4));
                let springs = springs.map(|(from, weight)| [shortest_m + from * span_m, weight / span_m]).collect();
                let affine = [constant - slope * shortest_m, slope, bias - bias_slope * shortest_m, bias_slope];
                return Some((affine, springs));
            }
        }
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
    let Actuator { gain, bias, friction_n, lag_s, largest_n, error_n, .. } = *actuator;
    let mut about = String::new();
    for line in origin {
        let _ = writeln!(about, "    {line}");
    }
    let [rms_n, most_n] = error_n;
    let _ = write!(
        about,
        "\n    Control is the gauge pressure in Pa, the length of the tendon that of the muscle. Actuator and springs\n    \
         together differ from the settled force of the model by {rms_n:.1} N (RMS), {most_n:.1} N at most, where the muscle pulls, of up to\n    \
         {largest_n:.0} N. Friction is {friction_n:.1} N at every pressure.\n"
    );
    if !without.is_empty() {
        let _ = writeln!(about, "    In it only as they settle: {}.", without.join(", "));
    }
    // Two hyphens would end what XML takes for a comment.
    let about = about.replace("--", "- -");
    let list = |values: [f64; 3]| values.map(|value| format!("{value:?}")).join(" ");
    let lag = if lag_s > 0.0 { format!(" dyntype=\"filterexact\" dynprm=\"{lag_s:?}\"") } else { String::new() };
    let mut springs = String::new();
    for (index, [taut_m, n_per_m]) in actuator.springs.iter().enumerate() {
        let _ = write!(
            springs,
            "    <spatial name=\"{name}_rubber_{}\" springlength=\"0 {taut_m:?}\" stiffness=\"{n_per_m:?}\">\n      \
             <site site=\"{name}_origin\"/>\n      <site site=\"{name}_insertion\"/>\n    </spatial>\n",
            index + 1
        );
    }
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
{springs}  </tendon>
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
