//! Colors of the page, in the light and in the dark.
//!
//! # Design
//! Figures are drawn once, in the light. For dark screens the style sheet replaces every color that a figure may
//! have by its dark counterpart, attribute by attribute; so figures of the page use no other colors than these, and
//! color maps have a fixed number of steps.

use std::fmt::Write as _;

use crate::plot::{Color, diverging, palette, sequential};

/// Residuals of the base model.
pub(crate) const BEFORE: Color = palette::VERMILION;
/// Residuals of base model and effects.
pub(crate) const AFTER: Color = palette::BLUE;
/// The band of the noise; not the gray of samples that are not counted.
pub(crate) const NOISE: Color = palette::GREEN.faded(0.24);
/// Regions.
pub(crate) const MARKED: Color = palette::ORANGE.faded(0.2);

/// Steps of a color map on each side of its middle.
const STEPS: i32 = 12;
const STYLE: &str = include_str!("style.css");

/// Color for a mean residual, −1 to 1 for a share from 0 to 1.
pub(crate) fn mean_color(share: f64) -> Color {
    mean_at(step(2.0 * share - 1.0))
}

/// Color for a size, 0 to 1.
pub(crate) fn size_color(share: f64) -> Color {
    size_at(step(share.max(0.0)))
}

/// The middle is gray, or cells without a residual would look like cells without samples.
fn mean_at(value: f64) -> Color {
    diverging(value).toward(Color::new(0xE2, 0xE5, 0xE9), (1.0 - 3.0 * value.abs()).max(0.0))
}

fn size_at(value: f64) -> Color {
    sequential(value).toward(Color::new(0xE6, 0xEC, 0xF2), (1.0 - 4.0 * value).max(0.0))
}

fn step(value: f64) -> f64 {
    (value.clamp(-1.0, 1.0) * f64::from(STEPS)).round() / f64::from(STEPS)
}

/// The whole style sheet.
pub(crate) fn style() -> String {
    let mut style = STYLE.to_owned();
    style.push_str("@media screen and (prefers-color-scheme: dark) {\n");
    let mut replace = |light: Color, dark: Color| {
        let (light, dark) = (hex(light), hex(dark));
        // Writing to a string cannot fail.
        let _ = writeln!(style, "svg [fill=\"{light}\"]{{fill:{dark}}} svg [stroke=\"{light}\"]{{stroke:{dark}}}");
    };
    for (light, dark) in DARK {
        replace(light, dark);
    }
    for index in -STEPS..=STEPS {
        let share = f64::from(index) / f64::from(STEPS);
        let end = if share < 0.0 { COLD } else { WARM };
        replace(mean_at(share), MIDDLE.toward(end, share.abs().powf(0.8)));
    }
    for index in 0..=STEPS {
        let share = f64::from(index) / f64::from(STEPS);
        replace(size_at(share), MIDDLE.toward(COLD, share));
    }
    style.push_str("}\n");
    style
}

/// Middle and ends of the color maps in the dark.
const MIDDLE: Color = Color::new(0x29, 0x30, 0x39);
const COLD: Color = Color::new(0x8F, 0xD0, 0xFF);
const WARM: Color = Color::new(0xFF, 0xA3, 0x7A);

/// Colors of the palette and what becomes of them in the dark.
const DARK: [(Color, Color); 10] = [
    (palette::WHITE, Color::new(0x14, 0x17, 0x1B)),
    (crate::plot::BLANK, Color::new(0x18, 0x1C, 0x21)),
    (palette::INK, Color::new(0xE6, 0xE8, 0xEB)),
    (palette::GRAY, Color::new(0xA9, 0xB1, 0xBB)),
    (palette::SILVER, Color::new(0x6F, 0x78, 0x83)),
    (palette::MIST, Color::new(0x2A, 0x2F, 0x36)),
    (palette::BLUE, Color::new(0x5F, 0xB3, 0xEC)),
    (palette::VERMILION, Color::new(0xF5, 0x8A, 0x4B)),
    (palette::GREEN, Color::new(0x3C, 0xC7, 0x9B)),
    (palette::ORANGE, Color::new(0xF2, 0xB8, 0x3A)),
];

fn hex(color: Color) -> String {
    let [red, green, blue] = color.rgb;
    format!("#{red:02X}{green:02X}{blue:02X}")
}
