//! Colors that stay apart for every kind of color vision.

/// A color in sRGB with an opacity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Color {
    /// Red, green, blue.
    pub rgb: [u8; 3],
    /// From 0, invisible, to 1.
    pub opacity: f64,
}

impl Color {
    /// An opaque color.
    pub const fn new(red: u8, green: u8, blue: u8) -> Self {
        Self { rgb: [red, green, blue], opacity: 1.0 }
    }

    /// The same color, see-through.
    pub const fn faded(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// The color that lies `share` of the way to `other`.
    pub fn toward(self, other: Self, share: f64) -> Self {
        let mut rgb = self.rgb;
        for (channel, end) in rgb.iter_mut().zip(other.rgb) {
            *channel = (f64::from(*channel) + share * (f64::from(end) - f64::from(*channel))).round() as u8;
        }
        Self { rgb, opacity: self.opacity + share * (other.opacity - self.opacity) }
    }

    /// Black or white, whichever is read better on this color.
    pub fn readable_on(self) -> Self {
        let [red, green, blue] = self.rgb.map(f64::from);
        // Luma of Rec. 709; below the middle, white letters have the higher contrast.
        if 0.2126 * red + 0.7152 * green + 0.0722 * blue < 130.0 { palette::WHITE } else { palette::INK }
    }
}

/// The palette of Okabe and Ito, "Color universal design" (2008), and the grays around it.
pub mod palette {
    use super::Color;

    /// Sky blue.
    pub const SKY: Color = Color::new(0x56, 0xB4, 0xE9);
    /// Blue.
    pub const BLUE: Color = Color::new(0x00, 0x72, 0xB2);
    /// Bluish green.
    pub const GREEN: Color = Color::new(0x00, 0x9E, 0x73);
    /// Yellow.
    pub const YELLOW: Color = Color::new(0xF0, 0xE4, 0x42);
    /// Orange.
    pub const ORANGE: Color = Color::new(0xE6, 0x9F, 0x00);
    /// Vermilion.
    pub const VERMILION: Color = Color::new(0xD5, 0x5E, 0x00);
    /// Reddish purple.
    pub const PURPLE: Color = Color::new(0xCC, 0x79, 0xA7);
    /// Titles and lines that matter.
    pub const INK: Color = Color::new(0x22, 0x22, 0x22);
    /// Labels.
    pub const GRAY: Color = Color::new(0x55, 0x55, 0x55);
    /// Axes.
    pub const SILVER: Color = Color::new(0x99, 0x99, 0x99);
    /// Grid lines.
    pub const MIST: Color = Color::new(0xE7, 0xE7, 0xE7);
    /// Paper.
    pub const WHITE: Color = Color::new(0xFF, 0xFF, 0xFF);
}

/// Blue for −1, white for 0, red for 1: the map "RdBu" of ColorBrewer (Brewer, 2003) upside down.
pub fn diverging(value: f64) -> Color {
    const STOPS: [Color; 11] = [
        Color::new(0x05, 0x30, 0x61),
        Color::new(0x21, 0x66, 0xAC),
        Color::new(0x43, 0x93, 0xC3),
        Color::new(0x92, 0xC5, 0xDE),
        Color::new(0xD1, 0xE5, 0xF0),
        Color::new(0xF7, 0xF7, 0xF7),
        Color::new(0xFD, 0xDB, 0xC7),
        Color::new(0xF4, 0xA5, 0x82),
        Color::new(0xD6, 0x60, 0x4D),
        Color::new(0xB2, 0x18, 0x2B),
        Color::new(0x67, 0x00, 0x1F),
    ];
    between(&STOPS, 0.5 + 0.5 * value)
}

/// White for 0, dark blue for 1: the map "Blues" of ColorBrewer (Brewer, 2003).
pub fn sequential(value: f64) -> Color {
    const STOPS: [Color; 5] = [
        Color::new(0xF7, 0xFB, 0xFF),
        Color::new(0xC6, 0xDB, 0xEF),
        Color::new(0x6B, 0xAE, 0xD6),
        Color::new(0x21, 0x71, 0xB5),
        Color::new(0x08, 0x30, 0x6B),
    ];
    between(&STOPS, value)
}

fn between(stops: &[Color], share: f64) -> Color {
    let position = share.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let below = (position as usize).min(stops.len() - 2);
    stops[below].toward(stops[below + 1], position - below as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_diverging_map_is_neutral_at_zero_and_saturates() {
        assert_eq!(diverging(0.0).rgb, [0xF7; 3]);
        assert_eq!(diverging(7.0), diverging(1.0));
        assert_eq!(diverging(-1.0).rgb, [0x05, 0x30, 0x61]);
    }
}
