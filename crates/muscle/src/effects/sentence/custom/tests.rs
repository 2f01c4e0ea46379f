use super::*;
use crate::coordinate::Coordinate;
use crate::effects::moment::tests::{base, pull, still};
use crate::geometry::tests::nominal;

const GUARD: &str = r#"
    [[effect]]
    id = "touching-guard"
    name = "a guard that touches the muscle"
    driver = "contraction"
    shape = { saturation = { from = [0.08, 0.2], over = [0.002, 0.05] } }
    amplitude = [0.0, 300.0]
"#;

#[test]
fn a_file_gives_an_effect_with_its_ranges_as_shapes() {
    let effects = custom_effects(GUARD).expect("effects");
    let effect = effects[0];
    assert_eq!((effect.page().id, effect.page().coordinate), ("touching-guard", Coordinate::Contraction));
    let shapes: Vec<_> = effect.shape().iter().map(|shape| (shape.name, shape.unit, shape.range)).collect();
    assert_eq!(shapes, [("from", "1", (0.08, 0.2)), ("over", "1", (0.002, 0.05))]);
    assert!(effect.shape().iter().all(|shape| shape.grid.is_sorted()));
    assert_eq!((effect.shape()[0].grid.len(), effect.shape()[1].grid.len()), (LOOKS.1, LOOKS.0));
    let amplitude = effect.amplitudes()[0];
    assert_eq!((amplitude.name, amplitude.unit, amplitude.range), ("limit", "N", (0.0, 300.0)));
    assert!(effect.is_static() && effect.is_local());
}

#[test]
fn what_acts_in_a_part_of_the_time_is_local_and_not_static() {
    let of_time = GUARD.replace("driver = \"contraction\"", "driver = \"time\"");
    let effect = custom_effects(&of_time).expect("effects")[0];
    assert!(!effect.is_static() && effect.is_local() && !effect.is_odd());
}

#[test]
fn it_pulls_as_its_sentence_at_that_shape_does() {
    let effect = custom_effects(GUARD).expect("effects")[0];
    let sentence = effect.sentence_at(&[0.09, 0.01]).expect("a sentence");
    assert_eq!(sentence.shape, Curve::Saturation { from: 0.09, over: 0.01 });
    let mut memory = effect.start(&nominal(), &[0.09, 0.01]);
    let contraction = still().contraction_ratio;
    let expected = -(contraction - 0.09).signum() * (-(contraction - 0.09).abs() / 0.01).exp_m1();
    assert!((pull(&mut *memory, &still(), &base())[0] - expected).abs() < 1e-12);
}

#[test]
fn what_no_fit_could_use_is_refused_by_name() {
    let refusal = |from: &str, to: &str| {
        custom_effects(&GUARD.replace(from, to))
            .expect_err("a refusal")
            .to_string()
            .lines()
            .next()
            .unwrap_or("")
            .to_owned()
    };
    let messages = [
        refusal("touching-guard", "stribeck"),
        refusal("touching-guard", "Touching guard"),
        refusal("[0.08, 0.2]", "[0.2, 0.08]"),
        refusal("[0.002, 0.05]", "[0.0, 0.05]"),
        refusal("[0.0, 300.0]", "[10.0, 300.0]"),
        refusal("[0.0, 300.0]", "[0.0, 3e5]"),
        refusal("\"contraction\"", "\"strain\""),
        refusal("saturation", "step"),
    ];
    insta::assert_snapshot!(messages.join("\n"), @r#"
    effect "stribeck": the id is taken; give it another
    effect "Touching guard": an id has lower-case letters, digits and hyphens, as touching-guard
    effect "touching-guard": from is no range; give its ends as [low, high]
    effect "touching-guard": over is no range; give its ends as [low, high], both above zero
    effect "touching-guard": amplitude is [10, 300]; give the least and the largest, with zero between them
    effect "touching-guard": amplitude is [0, 300000]; no muscle wants more than 10000 of this scale
    effect "touching-guard": unknown variant `strain`, expected one of `pressure`, `contraction`, `speed`, `force`, `time`, `travel-since-reversal`, `time-since-last-move`, `time-since-pressure-moved`, `cycle`
    effect "touching-guard": unknown variant `step`, expected one of `line`, `saturation`, `bump`, `monotone`, `spline`
    "#);
}
