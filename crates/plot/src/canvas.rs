//! The writer of SVG elements.
//!
//! Untrusted text enters a picture only through [`Canvas::text`], [`Canvas::label`], [`Canvas::named`] and the title and
//! description, which all escape it. Everything else is numbers and attributes from this crate.

use super::number::px;
use super::style::{POWER, TICK};
use super::text::{clean_label, escape, width};

/// The space after a superscript. Some renderers drop a space character there.
const SPACE: f64 = 3.5;

/// The text of a tick, which may have a superscript, as in a power of ten: `×10` `−6` `+ 0.981`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Label {
    /// The text before the superscript.
    pub(super) text: String,
    /// The superscript.
    pub(super) power: String,
    /// The text after it on the baseline.
    pub(super) rest: String,
}

impl Label {
    /// A label without a superscript.
    pub(super) fn plain(text: impl Into<String>) -> Self {
        Label { text: text.into(), ..Label::default() }
    }

    /// Estimated width in pixels.
    pub(super) fn width(&self, size: f64) -> f64 {
        width(&self.text, size) + width(&self.power, POWER) + SPACE + width(&self.rest, size)
    }
}

/// A picture that is being written.
pub(super) struct Canvas {
    out: String,
    depth: usize,
}

impl Canvas {
    /// Creates a white picture with a name and a description for screen readers.
    pub(super) fn new(size: (f64, f64), title: &str, description: &str) -> Self {
        let (w, h) = (px(size.0), px(size.1));
        let mut canvas = Canvas { out: String::new(), depth: 0 };
        canvas.push(&format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
             role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\">"
        ));
        canvas.depth = 1;
        canvas.push(&format!("<title>{}</title>", escape(&clean_label(title))));
        canvas.push(&format!("<desc>{}</desc>", escape(description)));
        canvas.push(&format!("<rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>"));
        canvas
    }

    /// Opens a group whose attributes apply to all elements until [`Canvas::close`].
    pub(super) fn open(&mut self, attributes: &str) {
        self.push(&format!("<g {attributes}>"));
        self.depth += 1;
    }

    /// Opens a group with a name, which viewers display when the pointer rests on it.
    pub(super) fn named(&mut self, attributes: &str, name: &str) {
        self.open(attributes);
        if !name.is_empty() {
            self.push(&format!("<title>{}</title>", escape(&clean_label(name))));
        }
    }

    /// Closes the innermost group.
    pub(super) fn close(&mut self) {
        self.depth = self.depth.saturating_sub(1).max(1);
        self.push("</g>");
    }

    /// Draws a straight line.
    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64)) {
        self.push(&format!(
            "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>",
            px(from.0),
            px(from.1),
            px(to.0),
            px(to.1)
        ));
    }

    /// Draws a filled rectangle between two corners.
    pub(super) fn area(&mut self, from: (f64, f64), to: (f64, f64), fill: &str) {
        self.push(&format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{fill}\"/>",
            px(from.0),
            px(from.1),
            px((to.0 - from.0).max(0.0)),
            px((to.1 - from.1).max(0.0))
        ));
    }

    /// Draws a path from data of this crate.
    pub(super) fn path(&mut self, data: &str) {
        self.push(&format!("<path d=\"{data}\"/>"));
    }

    /// Draws a filled disc.
    pub(super) fn disc(&mut self, centre: (f64, f64), radius: f64, fill: &str) {
        self.push(&format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{fill}\" stroke=\"none\"/>",
            px(centre.0),
            px(centre.1),
            px(radius)
        ));
    }

    /// Writes a line of text. `position` is on its baseline.
    pub(super) fn text(&mut self, position: (f64, f64), text: &str) {
        self.label(position, &Label::plain(text));
    }

    /// Writes a label. `position` is on its baseline.
    pub(super) fn label(&mut self, position: (f64, f64), label: &Label) {
        let mut inner = escape(&label.text);
        if !label.power.is_empty() {
            inner.push_str(&format!(
                "<tspan dy=\"-4\" font-size=\"{POWER}\">{}</tspan>",
                escape(&label.power)
            ));
            if !label.rest.is_empty() {
                inner.push_str(&format!(
                    "<tspan dx=\"{SPACE}\" dy=\"4\" font-size=\"{TICK}\">{}</tspan>",
                    escape(&label.rest)
                ));
            }
        }
        self.push(&format!("<text x=\"{}\" y=\"{}\">{inner}</text>", px(position.0), px(position.1)));
    }

    /// Returns the picture.
    pub(super) fn finish(mut self) -> String {
        self.depth = 0;
        self.push("</svg>");
        self.out
    }

    fn push(&mut self, element: &str) {
        self.out.push_str(&"  ".repeat(self.depth));
        self.out.push_str(element);
        self.out.push('\n');
    }
}

/// The distance of the baseline below the middle of a line of text.
pub(super) fn drop(size: f64) -> f64 {
    0.35 * size
}

/// Attributes of text.
pub(super) fn style(size: f64, fill: &str, anchor: &str) -> String {
    format!("font-size=\"{}\" fill=\"{fill}\" text-anchor=\"{anchor}\"", px(size))
}
