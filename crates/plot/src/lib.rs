//! Plots as SVG: lines over time, cost against error, and maps of cells.
//!
//! Plain data in, one self-contained picture out. The pictures need no style sheet, font or script, hold no ids
//! (several can stand in one page), and are the same bytes on every platform: numbers are rounded here, and no
//! function of the platform's mathematics library is called. Labels are untrusted text.
//!
//! * [`line_chart`]: traces of a lab over time
//! * [`work_precision`]: what accuracy costs, for several methods, both axes logarithmic
//! * [`cells`]: what becomes of something over two settings
//!
//! With the feature `png` a picture is drawn in pixels, too.
//!
//! Inside: `number` and `text` turn values into characters, `canvas` writes elements, `axis` chooses ranges and
//! ticks, `curve` turns samples into few points, `frame`, `legend` and `labels` draw what is common.

mod axis;
mod canvas;
mod cells;
mod curve;
mod frame;
mod labels;
mod legend;
mod lines;
mod number;
mod precision;
#[cfg(feature = "png")]
mod raster;
mod style;
#[cfg(test)]
mod tests;
mod text;

pub use cells::{Cells, cells};
pub use lines::{Chart, Series, line_chart};
pub use precision::{Method, MethodPoint, WorkPrecision, work_precision};
#[cfg(feature = "png")]
pub use raster::{is_png_of_ours, png};
