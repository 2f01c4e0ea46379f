//! Both arms by the general formulas of rigid bodies (eqs 32–51, corrected).
//!
//! Each body hangs on one elbow. Its pose is a product of transforms, parent first; Jacobians follow from the
//! pose, kinetic and potential energy from the Jacobians, and Lagrange's equation from the energies:
//!
//! ```text
//! T_body = T_joint(q) T_center                                            eqs 32–34, in this order
//! J_p = ∂(x, y, z)/∂q,   J_o = axis of the joint                          eqs 37–41
//! T = Σ ½ ωᵀ (R I Rᵀ) ω + ½ m vᵀ v,   U = Σ m g y                          eqs 42–47
//! M = Σ J_oᵀ (R I Rᵀ) J_o + m J_pᵀ J_p,   G = ∂U/∂q
//! C_i = Σ_jk (∂M_ij/∂q_k - ½ ∂M_jk/∂q_i) q̇_j q̇_k                          eq. 51
//! M(q) q̈ + C(q, q̇) + G(q) = τ                                            eq. 50
//! ```
//!
//! The load is a body here and therefore no passive torque on top: eq. 50 as printed counts it twice. The order
//! of eq. 34 as printed makes the position independent of `q`. Eq. 37's rates of Euler angles are no angular
//! velocity in general; the axis of the joint is.
//!
//! | symbol  | code              | unit  | meaning                                     |
//! |---------|-------------------|-------|---------------------------------------------|
//! | `q`     | `q_rad`           | rad   | both elbows, left and right                 |
//! | `T_*`   | [`Matrix4`]       | 1, m  | pose; x forward, y up, z along the elbows   |
//! | `M`     | [`mass_matrix`]   | kg m² | 2 × 2                                       |
//! | `C`     | [`coriolis_n_m`]  | N m   | two entries                                 |
//! | `G`     | [`gravity_n_m`]   | N m   | two entries                                 |
//!
//! Valid for rigid bodies on fixed elbows. The loop itself uses what this reduces to, [`Elbow`](super::Elbow).

use nalgebra::{Matrix2, Matrix3, Matrix4, Vector2, Vector3};

use super::GRAVITY_M_PER_S2;

/// A rigid body on one elbow.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// 0 left, 1 right.
    pub joint: usize,
    /// In kg.
    pub mass_kg: f64,
    /// About the center of mass, in the axes of the forearm, in kg m².
    pub inertia_kg_m2: Matrix3<f64>,
    /// Center of mass in the axes of the forearm (x along it, y across, z along the elbow's axis), in m.
    pub center_m: Vector3<f64>,
}

/// Distance of either elbow from the middle, in m; nothing here depends on it.
const HALF_WIDTH_M: f64 = 0.2;

/// Pose of an elbow's frame in the world (eq. 32).
pub fn joint_pose(joint: usize, q_rad: f64) -> Matrix4<f64> {
    let (sine, cosine) = q_rad.sin_cos();
    let side_m = if joint == 0 { -HALF_WIDTH_M } else { HALF_WIDTH_M };
    Matrix4::new(
        cosine, -sine, 0.0, 0.0, //
        sine, cosine, 0.0, 0.0, //
        0.0, 0.0, 1.0, side_m, //
        0.0, 0.0, 0.0, 1.0,
    )
}

/// Pose of a body's center in the world (eqs 33 and 34).
pub fn body_pose(body: &Body, q_rad: &Vector2<f64>) -> Matrix4<f64> {
    joint_pose(body.joint, q_rad[body.joint]) * Matrix4::new_translation(&body.center_m)
}

/// Jacobians of position and orientation (eqs 37–41): one column for each elbow.
fn jacobians(body: &Body, pose: &Matrix4<f64>) -> ([Vector3<f64>; 2], [Vector3<f64>; 2]) {
    let (mut position, mut orientation) = ([Vector3::zeros(); 2], [Vector3::zeros(); 2]);
    let from_elbow = Vector3::new(pose[(0, 3)], pose[(1, 3)], 0.0);
    position[body.joint] = Vector3::z().cross(&from_elbow);
    orientation[body.joint] = Vector3::z();
    (position, orientation)
}

/// `M(q)`, in kg m².
pub fn mass_matrix(bodies: &[Body], q_rad: &Vector2<f64>) -> Matrix2<f64> {
    let mut mass = Matrix2::zeros();
    for body in bodies {
        let pose = body_pose(body, q_rad);
        let rotation = pose.fixed_view::<3, 3>(0, 0).into_owned();
        let inertia = rotation * body.inertia_kg_m2 * rotation.transpose();
        let (position, orientation) = jacobians(body, &pose);
        for row in 0..2 {
            for column in 0..2 {
                mass[(row, column)] += orientation[row].dot(&(inertia * orientation[column]))
                    + body.mass_kg * position[row].dot(&position[column]);
            }
        }
    }
    mass
}

/// `C(q, q̇)`, in N m, from the slopes of the mass matrix by central differences.
pub fn coriolis_n_m(bodies: &[Body], q_rad: &Vector2<f64>, dq_rad_per_s: &Vector2<f64>) -> Vector2<f64> {
    const STEP_RAD: f64 = 1e-4;
    let slope = |joint: usize| {
        let mut step = Vector2::zeros();
        step[joint] = STEP_RAD;
        (mass_matrix(bodies, &(q_rad + step)) - mass_matrix(bodies, &(q_rad - step))) / (2.0 * STEP_RAD)
    };
    let slopes = [slope(0), slope(1)];
    let mut coriolis = Vector2::zeros();
    for i in 0..2 {
        for j in 0..2 {
            for k in 0..2 {
                let symbol = slopes[k][(i, j)] - 0.5 * slopes[i][(j, k)];
                coriolis[i] += symbol * dq_rad_per_s[j] * dq_rad_per_s[k];
            }
        }
    }
    coriolis
}

/// `G(q)`, in N m.
pub fn gravity_n_m(bodies: &[Body], q_rad: &Vector2<f64>) -> Vector2<f64> {
    let mut gravity = Vector2::zeros();
    for body in bodies {
        let (position, _) = jacobians(body, &body_pose(body, q_rad));
        for joint in 0..2 {
            gravity[joint] += body.mass_kg * GRAVITY_M_PER_S2 * position[joint].y;
        }
    }
    gravity
}

/// `T + U`, in J.
pub fn energy_j(bodies: &[Body], q_rad: &Vector2<f64>, dq_rad_per_s: &Vector2<f64>) -> f64 {
    let kinetic_j = 0.5 * dq_rad_per_s.dot(&(mass_matrix(bodies, q_rad) * dq_rad_per_s));
    let height = |body: &Body| body_pose(body, q_rad)[(1, 3)];
    kinetic_j + bodies.iter().map(|body| body.mass_kg * GRAVITY_M_PER_S2 * height(body)).sum::<f64>()
}

/// Accelerations under torques at the elbows (eq. 50 solved), in rad/s²; none where a mass is missing.
pub fn accelerations_rad_per_s2(
    bodies: &[Body],
    q_rad: &Vector2<f64>,
    dq_rad_per_s: &Vector2<f64>,
    torque_n_m: &Vector2<f64>,
) -> Option<Vector2<f64>> {
    let rest_n_m = torque_n_m - coriolis_n_m(bodies, q_rad, dq_rad_per_s) - gravity_n_m(bodies, q_rad);
    mass_matrix(bodies, q_rad).try_inverse().map(|inverse| inverse * rest_n_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bodies() -> Vec<Body> {
        let body = |joint, mass_kg, x, y| Body {
            joint,
            mass_kg,
            inertia_kg_m2: Matrix3::new(0.02, -0.003, 0.0, -0.003, 0.03, -0.001, 0.0, -0.001, 0.025),
            center_m: Vector3::new(x, y, 0.05),
        };
        vec![body(0, 2.5, 0.30, 0.04), body(1, 2.5, 0.30, 0.04), body(0, 1.6, 0.14, 0.0)]
    }

    #[test]
    fn mass_and_gravity_are_the_closed_forms_of_one_revolute_joint() {
        // M = I_zz + m (c_x² + c_y²), G = m g (c_x cos q - c_y sin q), C = 0.
        let q_rad = Vector2::new(0.25, -0.1);
        let mass = mass_matrix(&bodies(), &q_rad);
        let left = 0.025 + 2.5 * (0.30 * 0.30 + 0.04 * 0.04) + 0.025 + 1.6 * 0.14 * 0.14;
        assert!((mass[(0, 0)] - left).abs() < 1e-12);
        assert!(mass[(0, 1)].abs() < 1e-15);
        let gravity = gravity_n_m(&bodies(), &q_rad);
        let (sine, cosine) = 0.25_f64.sin_cos();
        let expected = GRAVITY_M_PER_S2 * (2.5 * (0.30 * cosine - 0.04 * sine) + 1.6 * 0.14 * cosine);
        assert!((gravity[0] - expected).abs() < 1e-12);
        assert!(coriolis_n_m(&bodies(), &q_rad, &Vector2::new(2.0, -3.0)).norm() < 1e-9);
    }

    #[test]
    fn gravity_is_the_slope_of_the_energy() {
        let (q_rad, rest, step) = (Vector2::new(0.4, 0.2), Vector2::zeros(), 1e-6);
        for joint in 0..2 {
            let mut shift = Vector2::zeros();
            shift[joint] = step;
            let slope = (energy_j(&bodies(), &(q_rad + shift), &rest) - energy_j(&bodies(), &(q_rad - shift), &rest))
                / (2.0 * step);
            assert!((gravity_n_m(&bodies(), &q_rad)[joint] - slope).abs() < 1e-6);
        }
    }

    #[test]
    fn energy_is_conserved_where_nothing_drives() {
        let (mut q, mut dq) = (Vector2::new(0.5, -0.3), Vector2::new(0.2, 1.0));
        let bodies = bodies();
        let start_j = energy_j(&bodies, &q, &dq);
        let free =
            |q: &Vector2<f64>, dq: &Vector2<f64>| accelerations_rad_per_s2(&bodies, q, dq, &Vector2::zeros()).unwrap();
        let step_s = 1e-3;
        for _ in 0..2000 {
            // Classical Runge–Kutta.
            let (k1, l1) = (dq, free(&q, &dq));
            let (k2, l2) = (dq + 0.5 * step_s * l1, free(&(q + 0.5 * step_s * k1), &(dq + 0.5 * step_s * l1)));
            let (k3, l3) = (dq + 0.5 * step_s * l2, free(&(q + 0.5 * step_s * k2), &(dq + 0.5 * step_s * l2)));
            let (k4, l4) = (dq + step_s * l3, free(&(q + step_s * k3), &(dq + step_s * l3)));
            q += step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            dq += step_s / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
        }
        let end_j = energy_j(&bodies, &q, &dq);
        assert!((end_j - start_j).abs() < 1e-7 * start_j.abs().max(1.0), "{start_j} {end_j}");
    }
}
