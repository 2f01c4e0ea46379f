use super::*;
use crate::stream::Stream;

fn network(hidden: Activation, output: Activation) -> Network {
    Network::initial(&[3, 5, 4, 2], &[hidden, hidden, output], &mut Stream::Weights(0).random(3))
}

#[test]
fn derivatives_agree_with_finite_differences() {
    use Activation::{Linear, Sigmoid, Tanh};
    for (hidden, output) in [(Tanh, Linear), (Sigmoid, Sigmoid), (Sigmoid, Linear), (Tanh, Sigmoid)] {
        let network = network(hidden, output);
        let inputs = [[0.3], [-0.8], [1.0]];
        let seeds = [[0.7], [-1.3]];
        let cost = |network: &Network| -> f64 {
            let mut pass = network.pass();
            network.forward(&inputs, &mut pass);
            pass.outputs().iter().zip(seeds).map(|(output, seed)| output[0] * seed[0]).sum()
        };
        let mut pass = network.pass();
        network.forward(&inputs, &mut pass);
        let mut gradient = vec![[f64::NAN]; network.parameters().len()];
        network.backward(&mut pass, &seeds, &mut gradient);
        for (index, derivative) in gradient.iter().enumerate() {
            let shifted = |step: f64| {
                let mut moved = network.clone();
                moved.parameters_mut()[index] += step;
                cost(&moved)
            };
            let expected = (shifted(1e-6) - shifted(-1e-6)) / 2e-6;
            assert!((derivative[0] - expected).abs() < 1e-8, "{hidden:?} {output:?} {index}");
        }
    }
}

#[test]
fn a_network_by_hand() {
    // tanh(2·0.5 - 1·0.25 + 0.1) · 3 - 1
    let parameters = vec![2.0, -1.0, 0.1, 3.0, -1.0];
    let network = Network::new(vec![2, 1, 1], vec![Activation::Tanh, Activation::Linear], parameters);
    let mut pass = network.pass();
    network.forward(&[[0.5], [0.25]], &mut pass);
    assert!((pass.outputs()[0][0] - (3.0 * 0.85_f64.tanh() - 1.0)).abs() < 1e-15);
}
#[test]
fn samples_side_by_side_do_not_see_each_other() {
    let network = network(Activation::Tanh, Activation::Sigmoid);
    let inputs = [[0.3, -0.9, 0.0], [-0.8, 0.1, 0.5], [1.0, -1.0, 0.2]];
    let seeds = [[0.7, 1.0, -0.1], [-1.3, 2.0, 0.0]];
    let n = network.parameters().len();
    let (mut pass, mut gradient) = (network.pass(), vec![[0.0; 3]; n]);
    network.forward(&inputs, &mut pass);
    network.backward(&mut pass, &seeds, &mut gradient);
    let (mut alone, mut gradient_alone) = (network.pass(), vec![[0.0]; n]);
    for sample in 0..3 {
        network.forward(&inputs.map(|input| [input[sample]]), &mut alone);
        network.backward(&mut alone, &seeds.map(|seed| [seed[sample]]), &mut gradient_alone);
        assert!(pass.outputs().iter().zip(alone.outputs()).all(|(side, alone)| side[sample] == alone[0]));
        assert!(gradient.iter().zip(&gradient_alone).all(|(side, alone)| side[sample] == alone[0]));
    }
}
