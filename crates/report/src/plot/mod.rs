//! Parts of figures: a canvas, axes, panels, color maps, legends.
//!
//! A figure is a [`Canvas`] cut into [`Rect`]s; a [`Panel`] gives one of them axes and a frame and draws data
//! on it; [`Map`] and [`Bars`] are panels over cells and over names.

mod axis;
mod bars;
mod canvas;
mod color;
mod density;
mod legend;
mod map;
mod panel;
mod rect;
mod thin;
mod timeline;

pub use axis::Axis;
pub(crate) use axis::round_levels;
pub use bars::{Bar, Bars};
pub use canvas::{Anchor, Canvas, text_width};
pub use color::{Color, diverging, palette, sequential};
pub(crate) use density::density;
pub use legend::{Key, Mark, legend, legend_from, legend_width};
pub(crate) use map::BLANK;
pub use map::{Bins, ColorBar, Map};
pub use panel::{Panel, note, title};
pub use rect::Rect;
pub use thin::thin;
pub use timeline::Timeline;
