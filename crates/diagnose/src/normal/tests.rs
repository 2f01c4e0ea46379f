use crate::coordinates::Coordinates;
use crate::nuisance::NONE;
use crate::rehearsal::tests::Given;

#[test]
fn nuisances_that_were_eliminated_come_back_as_least_squares_has_them() {
    let mut given = Given::of(&["isobaric-triangles", "isometric-ramps"], &[]);
    for instant in &mut given.track.instants {
        instant.force_n += 30.0 * (40.0 * instant.moment.contraction_ratio).sin();
    }
    let nuisance = NONE.with_map(&given.track, &Coordinates::of(&given.track));
    let plain = given.setting();
    let setting = plain.beside(&nuisance);
    let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
    let residuals_n = setting.residuals_n(&state);
    // At the minimum of |r|² + Σ λ c² every column's product with the residual is λ c.
    for (column, (size, precision)) in state.fit.nuisances.iter().zip(&nuisance.precision).enumerate() {
        let counted = (0..residuals_n.len()).filter(|&at| given.track.counted[at]);
        let product: f64 = counted.map(|at| nuisance.row(at)[column] * residuals_n[at]).sum();
        let scale = residuals_n.len() as f64;
        assert!((product - precision * size).abs() < 1e-6 * scale, "{column}: {product} {}", precision * size);
    }
}

#[test]
fn a_block_leaves_what_its_residuals_leave() {
    let mut given = Given::of(&["isobaric-triangles", "isometric-ramps"], &[]);
    for instant in &mut given.track.instants {
        instant.force_n += 30.0 * (40.0 * instant.moment.contraction_ratio).sin();
    }
    let nuisance = NONE.with_map(&given.track, &Coordinates::of(&given.track));
    let plain = given.setting();
    let setting = plain.beside(&nuisance);
    let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
    let residuals_n = setting.residuals_n(&state);
    for (block, range) in given.track.blocks.iter().enumerate() {
        let expected: f64 = range.clone().filter(|&at| given.track.counted[at]).map(|at| residuals_n[at].powi(2)).sum();
        let found = state.normal.alone().square_sum(block, &state.fit.weights, &state.fit.nuisances);
        assert!((found - expected).abs() < 1e-6 * expected.max(1.0), "{block}: {found} {expected}");
    }
}
