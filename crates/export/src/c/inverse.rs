//! The inverse network as constants and loops.

use std::fmt::Write as _;

use pam_artifact::inverse::Activation;
use pam_inverse_model::InverseNetwork;

use super::constants::{defines, number};
use super::parts;

/// Weights, scaling and domain of `network`, and the functions that evaluate it.
pub(super) fn part(network: &InverseNetwork) -> String {
    let layers = network.network().layers();
    let widest = layers.iter().copied().max().unwrap_or(1);
    let mut text = defines(&scaling_and_domain(network));
    // Integers, as sizes of arrays have to be.
    let n_reach = network.domain().reach.len();
    let _ = writeln!(text, "#define PAM_N_REACH {n_reach}\n#define PAM_WIDTH {widest}");
    text.push_str("enum { PAM_TANH, PAM_SIGMOID, PAM_LINEAR };\n\n");
    let mut calls = String::new();
    let (mut before, mut after) = ("one", "other");
    for (layer, activation) in network.network().activations().iter().enumerate() {
        let (inputs, outputs, number) = (layers[layer], layers[layer + 1], layer + 1);
        let (weights, biases) = network.network().layer(layer);
        let _ = writeln!(text, "/* Layer {number}: {outputs} neurons on {inputs}, weights row by row. */");
        text.push_str(&array(&format!("weights_{number}"), weights));
        text.push_str(&array(&format!("biases_{number}"), biases));
        let name = match activation {
            Activation::Tanh => "PAM_TANH",
            Activation::Sigmoid => "PAM_SIGMOID",
            Activation::Linear => "PAM_LINEAR",
        };
        let _ = writeln!(
            calls,
            "    pam_layer(pam_weights_{number}, pam_biases_{number}, {inputs}, {outputs}, {name}, {before}, {after});"
        );
        std::mem::swap(&mut before, &mut after);
    }
    text.push_str(&reach(network));
    text.push_str(&parts::INVERSE.replace("@LAYERS@", &calls).replace("@ANSWER@", before));
    text
}

fn scaling_and_domain(network: &InverseNetwork) -> Vec<(String, f64)> {
    let scaling = network.scaling();
    let channels = scaling.inputs.iter().chain([&scaling.output]);
    let mut constants: Vec<(String, f64)> = channels
        .flat_map(|channel| {
            let name = channel.name.to_uppercase();
            [(format!("{name}_OFFSET"), channel.offset), (format!("{name}_SCALE"), channel.scale)]
        })
        .collect();
    let domain = network.domain();
    let [shortest_m, longest_m] = domain.length_m;
    let lengths_per_m = (domain.reach.len() - 1) as f64 / (longest_m - shortest_m);
    for (name, value) in [
        ("SHORTEST_M", shortest_m),
        ("LONGEST_M", longest_m),
        ("LENGTHS_PER_M", lengths_per_m),
        ("FORCE_MARGIN_N", network.force_margin_n()),
    ] {
        constants.push((name.to_owned(), value));
    }
    constants
}

fn array(name: &str, values: &[f64]) -> String {
    let mut text = format!("static const double pam_{name}[{}] = {{", values.len());
    for (index, value) in values.iter().enumerate() {
        text.push_str(if index % 4 == 0 { "\n    " } else { " " });
        let _ = write!(text, "{},", number(*value));
    }
    text.push_str("\n};\n");
    text
}

/// Forces that have a pressure, per length.
fn reach(network: &InverseNetwork) -> String {
    let mut text =
        "\n/* Lowest and highest force while extending, then while contracting, in N, over equal steps of length. */\n\
                    static const double pam_reach[PAM_N_REACH][4] = {\n"
            .to_owned();
    for reach in &network.domain().reach {
        let none = [f64::NAN; 2];
        let ([a, b], [c, d]) = (reach.extending_force_n.unwrap_or(none), reach.contracting_force_n.unwrap_or(none));
        let _ = writeln!(text, "    {{{}}},", [a, b, c, d].map(number).join(", "));
    }
    text.push_str("};\n\n");
    text
}
