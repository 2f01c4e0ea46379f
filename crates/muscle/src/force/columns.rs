//! Eq. 11 as a sum of columns with weights, which is what a fit sees.
//!
//! With the dimensions of the muscle fixed, the force at an instant is a scalar product: columns that
//! depend on pressure, length and direction alone, times weights that depend on the parameters alone.
//!
//! | columns | unit  | weight                                                            |
//! |---------|-------|-------------------------------------------------------------------|
//! | 0–2     | N     | [`Gas::weights`]: `k₁ (a - b)`, `-2 a k₁ k₂`, `a k₁ k₂²`             |
//! | 3       | 1     | `k₃`, in N                                                         |
//! | 4, 5    | N/Pa  | `±C₁₀`, `±C₀₁`                                                      |
//! | 6–10    | N     | polynomials in the compliance of the strands ([`ComplianceNodes`]) |
//! | 11      | N     | `f'`; the column has the sign of the direction                     |
//! | 12      | N     | `f_ss / S_scale`; likewise                                         |

use super::bladder::Bladder;
use super::braid::{Braid, ComplianceNodes, NODES};
use super::gas::Gas;
use super::rubber_friction::normal_force_n;
use super::strand_friction::StrandContact;
use super::{BaseParameters, Form, Parameter};
use crate::geometry::{Kinematics, Muscle};

/// Columns of eq. 11.
pub const N_COLUMNS: usize = 8 + NODES;

/// First column of the bladder.
pub const BLADDER: usize = 4;
/// First column of the braid.
pub const BRAID: usize = 6;
/// Column of the friction of the bladder; that between strands follows.
pub const FRICTION: usize = 6 + NODES;

/// Columns and weights of eq. 11 for one muscle.
#[derive(Debug, Clone)]
pub struct ForceColumns {
    form: Form,
    kinematics: Kinematics,
    gas: Gas,
    bladder: Bladder,
    braid: Braid,
    contact: StrandContact,
    nodes: ComplianceNodes,
}

impl ForceColumns {
    /// Columns for `muscle` and recordings whose pressure times length stays below `largest_n_per_m`.
    pub fn new(muscle: &Muscle, strand_modulus_pa: f64, form: Form, largest_n_per_m: f64) -> Self {
        let braid = Braid::new(muscle, form);
        Self {
            form,
            kinematics: Kinematics::of(muscle),
            gas: Gas::new(muscle),
            bladder: Bladder::new(muscle),
            braid,
            contact: StrandContact::new(muscle, strand_modulus_pa),
            nodes: ComplianceNodes::new(braid.max_compliance_per_pa(largest_n_per_m)),
        }
    }

    /// Largest compliance of the strands, in 1/Pa, at which the columns stand for eq. 2.
    pub fn max_compliance_per_pa(&self) -> f64 {
        self.nodes.nodes_per_pa()[NODES - 1]
    }

    /// Compliance, in 1/Pa, that the first column of the braid stands for; its weight is nearly the share of
    /// that compliance.
    pub fn first_node_per_pa(&self) -> f64 {
        self.nodes.nodes_per_pa()[0]
    }

    /// How eq. 11 is written.
    pub fn form(&self) -> Form {
        self.form
    }

    /// Gas term, for what its weights imply.
    pub fn gas(&self) -> &Gas {
        &self.gas
    }

    /// Contraction ratio at `length_m`.
    pub fn contraction_ratio(&self, length_m: f64) -> f64 {
        self.kinematics.contraction_ratio(length_m)
    }

    /// The columns at one instant; `direction` is +1 contracting, -1 extending, 0 neither.
    pub fn row(&self, pressure_pa: f64, length_m: f64, direction: f64) -> [f64; N_COLUMNS] {
        let mut row = [0.0; N_COLUMNS];
        let diameter_m = self.kinematics.diameter_m(length_m);
        row[..3].copy_from_slice(&self.gas.columns_n(pressure_pa, self.kinematics.contraction_ratio(length_m)));
        row[3] = 1.0;
        row[BLADDER..BRAID].copy_from_slice(&self.bladder.columns_at(length_m, diameter_m));
        for (column, &node) in row[BRAID..FRICTION].iter_mut().zip(self.nodes.nodes_per_pa()) {
            *column = -self.braid.force_n(pressure_pa, length_m, node);
        }
        let normal_n = normal_force_n(pressure_pa, diameter_m, length_m);
        row[FRICTION] = -direction * normal_n;
        row[FRICTION + 1] = -direction * self.contact.force_n(pressure_pa, normal_n);
        row
    }

    /// Weights of the columns for values of the parameters.
    pub fn weights(&self, parameters: &BaseParameters) -> [f64; N_COLUMNS] {
        let [k1, k2, k3, c10_pa, c01_pa, compliance_per_pa, rubber, strand] = parameters.theta;
        let mut weights = [0.0; N_COLUMNS];
        weights[..3].copy_from_slice(&self.gas.weights(k1, k2));
        weights[3] = k3;
        weights[BLADDER] = self.form.bladder_sign() * c10_pa;
        weights[BLADDER + 1] = self.form.bladder_sign() * c01_pa;
        weights[BRAID..FRICTION].copy_from_slice(&self.nodes.weights(compliance_per_pa));
        weights[FRICTION] = rubber;
        weights[FRICTION + 1] = strand;
        weights
    }

    /// Derivatives of the [weights](Self::weights): one array per parameter, in the order of
    /// [`Parameter::ALL`].
    pub fn weight_slopes(&self, parameters: &BaseParameters) -> [[f64; N_COLUMNS]; 8] {
        let mut slopes = [[0.0; N_COLUMNS]; 8];
        let [by_k1, by_k2] = self.gas.weight_slopes(parameters.of(Parameter::K1), parameters.of(Parameter::K2));
        slopes[Parameter::K1.index()][..3].copy_from_slice(&by_k1);
        slopes[Parameter::K2.index()][..3].copy_from_slice(&by_k2);
        slopes[Parameter::K3.index()][3] = 1.0;
        slopes[Parameter::C10.index()][BLADDER] = self.form.bladder_sign();
        slopes[Parameter::C01.index()][BLADDER + 1] = self.form.bladder_sign();
        let by_compliance = self.nodes.weight_slopes(parameters.of(Parameter::StrandCompliance));
        slopes[Parameter::StrandCompliance.index()][BRAID..FRICTION].copy_from_slice(&by_compliance);
        slopes[Parameter::RubberFriction.index()][FRICTION] = 1.0;
        slopes[Parameter::StrandFriction.index()][FRICTION + 1] = 1.0;
        slopes
    }
}

#[cfg(test)]
mod tests {
    use super::super::ForceModel;
    use super::super::tests::nominal_parameters;
    use super::*;
    use crate::geometry::tests::nominal;

    #[test]
    fn columns_times_weights_are_the_force_model() {
        for form in [Form::Corrected, Form::AsPrinted] {
            // Stiff enough strands for the printed form, too, to stay inside the columns' range.
            let mut parameters = nominal_parameters();
            parameters.theta[Parameter::StrandCompliance.index()] = 1.0 / 6e9;
            let columns = ForceColumns::new(&nominal(), 3e9, form, 5e5 * 0.27);
            let model = ForceModel::new(&nominal(), 3e9, form, parameters);
            let weights = columns.weights(&parameters);
            for (p, l, s) in [(5e5, 0.267, 1.0), (3e5, 0.24, -1.0), (1e4, 0.21, 0.0)] {
                let sum_n: f64 = columns.row(p, l, s).iter().zip(weights).map(|(column, weight)| column * weight).sum();
                let force_n = model.force_n(p, l, s);
                assert!((sum_n - force_n).abs() < 1e-5 * force_n.abs().max(50.0), "{form:?}: {sum_n} {force_n}");
            }
        }
    }

    #[test]
    fn weight_slopes_agree_with_finite_differences() {
        let columns = ForceColumns::new(&nominal(), 3e9, Form::Corrected, 5e5 * 0.27);
        let parameters = nominal_parameters();
        let slopes = columns.weight_slopes(&parameters);
        for parameter in Parameter::ALL {
            let step = 1e-6 * parameters.of(parameter).abs().max(1e-9);
            let shifted = |sign: f64| {
                let mut moved = parameters;
                moved.theta[parameter.index()] += sign * step;
                columns.weights(&moved)
            };
            let (up, down) = (shifted(1.0), shifted(-1.0));
            for column in 0..N_COLUMNS {
                let expected = (up[column] - down[column]) / (2.0 * step);
                let error = (slopes[parameter.index()][column] - expected).abs();
                assert!(error < 1e-5 * expected.abs().max(1e-3), "{parameter:?}, column {column}");
            }
        }
    }
}
