//! Plots as SVG: lines over time, cost against error, and maps of cells.
//!
//! The input is plain data, the output one self-contained picture. Pictures need no style sheet, font or script, and contain no
//! ids, so that a page can contain several of them. They consist of the same bytes on every platform: numbers are rounded here,
//! and no function of the platform's mathematics library is called. Labels are untrusted text.
//!
//! * [`line_chart`]: traces of a lab over time
//! * [`work_precision`]: cost against error for several methods, both axes logarithmic
//! * [`cells`]: an outcome as a function of two settings
//!
//! With the feature `png`, a picture can also be rasterized.
//!
//! Internal modules: `number` and `text` format values, `canvas` writes elements, `axis` chooses ranges and ticks, `curve`
//! reduces samples to few points, and `frame`, `legend` and `labels` draw the common parts.

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
pub use raster::{is_own_png, png};
