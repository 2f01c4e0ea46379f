//! One evaluation of a network, and of the exact inverse, over points that change every time.

use divan::{Bencher, black_box};
use pam_artifact::inverse::Activation;
use pam_inverse_model::design::{Draw, points};
use pam_inverse_model::domain::InverseBox;
use pam_inverse_model::network::Network;
use pam_inverse_model::samples::Scaling;
use pam_inverse_model::stream::Stream;
use pam_inverse_model::{ExactInverse, InverseNetwork};
use pam_muscle::Muscle;
use pam_muscle::force::{BaseParameters, ForceModel, Form};

fn main() {
    divan::main();
}

fn exact() -> ExactInverse {
    let muscle = Muscle::nominal();
    let theta = [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.0];
    let model = ForceModel::new(&muscle, 3e9, Form::Corrected, BaseParameters { theta });
    let inverse_box = InverseBox { pressure_pa: [500.0, 5e5], length_m: [0.211, 0.268], force_n: [4.5, 1119.0] };
    ExactInverse::new(model, inverse_box, 0.05)
}

#[divan::bench(args = [16, 20, 24])]
fn network(bencher: Bencher<'_, '_>, hidden: usize) {
    let exact = exact();
    let activations = [Activation::Tanh, Activation::Linear];
    let network = Network::initial(&[3, hidden, 1], &activations, &mut Stream::Weights(0).random(1));
    let scaling = Scaling::of(exact.inverse_box(), Activation::Linear);
    let inverse = InverseNetwork::new(network, scaling, exact.domain());
    let drawn = points(&exact, 1000, Draw::Independent, 1);
    let mut next = drawn.iter().cycle();
    bencher.bench_local(|| {
        let point = next.next().expect("a cycle has no end");
        inverse.pressure_pa(black_box(point.force_n), black_box(point.length_m), black_box(point.direction))
    });
}

#[divan::bench]
fn exact_inverse(bencher: Bencher<'_, '_>) {
    let exact = exact();
    let drawn = points(&exact, 1000, Draw::Independent, 1);
    let mut next = drawn.iter().cycle();
    bencher.bench_local(|| {
        let point = next.next().expect("a cycle has no end");
        exact.pressure_pa(black_box(point.force_n), black_box(point.length_m), black_box(point.direction))
    });
}
