//! Elements that a page does not display, or displays struck out: `hidden`, `template`, `display: none`, a size of zero.
//! Content that opens on a click (`details`) counts as displayed, and so does content that only screen readers skip
//! (`aria-hidden`).

use crate::markdown::html::HtmlTag;

/// An element that a page does not display, from its start tag to its end tag.
#[derive(Default)]
pub(super) struct HiddenElement {
    /// The name of the element, and how many elements of this name are open; zero when the text is displayed.
    name: String,
    open: usize,
}

/// Elements without an end tag.
const VOID: [&str; 13] =
    ["area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"];

/// Elements that a page with scripts and media does not display as text, and struck-out words.
const HIDDEN_ELEMENTS: [&str; 17] = [
    "template", "script", "style", "title", "noscript", "datalist", "head", "iframe", "object", "audio",
    "video", "canvas", "rp", "del", "s", "strike", "noframes",
];

/// Classes by which common style sheets hide an element.
const CLASSES: [&str; 7] =
    ["hidden", "d-none", "invisible", "sr-only", "visually-hidden", "is-hidden", "screen-reader-text"];

impl HiddenElement {
    /// Whether the following text is hidden.
    pub(super) fn is_on(&self) -> bool {
        self.open > 0
    }

    /// Ends the hidden element.
    pub(super) fn end(&mut self) {
        self.open = 0;
    }

    /// Processes a tag. Returns whether the tag itself is hidden.
    pub(super) fn take_tag(&mut self, tag: &HtmlTag) -> bool {
        let was = self.is_on();
        if was && tag.name == self.name {
            self.open = if tag.closing { self.open - 1 } else { self.open + 1 };
        } else if !was && !tag.closing && !VOID.contains(&tag.name.as_str()) && hides(tag) {
            (self.name, self.open) = (tag.name.clone(), 1);
        }
        was || self.is_on()
    }
}

/// Whether a page does not display the element of a start tag.
fn hides(tag: &HtmlTag) -> bool {
    let (mut hidden, mut closed) = (HIDDEN_ELEMENTS.contains(&tag.name.as_str()), tag.name == "dialog");
    for (name, value) in &tag.attributes {
        let value = value.to_ascii_lowercase();
        hidden |= match name.as_str() {
            "hidden" | "popover" => true,
            "class" => value.split_whitespace().any(|class| CLASSES.contains(&class)),
            "style" => style_hides(&value),
            _ => false,
        };
        closed &= name != "open";
    }
    hidden || closed
}

/// Whether a style makes an element invisible.
fn style_hides(style: &str) -> bool {
    let plain: String = style.chars().filter(|c| !c.is_whitespace()).collect();
    let pairs: Vec<(&str, &str)> = plain.split(';').filter_map(|pair| pair.split_once(':')).collect();
    let zero = |value: &str| {
        let digits = value.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(value.len());
        value.get(..digits).and_then(|d| d.parse::<f64>().ok()).is_some_and(|x| x < 0.02)
    };
    let clips = pairs.iter().any(|(name, value)| name.starts_with("overflow") && value.starts_with("hidden"));
    pairs.iter().any(|(name, value)| {
        let value = value.trim_end_matches("!important");
        match *name {
            "display" => value == "none",
            "visibility" => matches!(value, "hidden" | "collapse"),
            "content-visibility" => value == "hidden",
            "opacity" | "font-size" | "zoom" => zero(value),
            "font" => value.starts_with("0"),
            "color" | "-webkit-text-fill-color" => {
                value == "transparent"
                    || (value.starts_with("rgba(") || value.starts_with("hsla(")) && value.ends_with(",0)")
                    || value.len() == 9 && value.starts_with('#') && value.ends_with("00")
            }
            "clip" => value.starts_with("rect(0"),
            "clip-path" => {
                value.starts_with("inset(100")
                    || value.starts_with("inset(50")
                    || value.starts_with("circle(0")
            }
            "transform" | "scale" => value == "0" || value.contains("scale(0)") || value.contains("scale(0,"),
            "text-indent" | "left" | "top" | "right" | "bottom" | "margin-left" | "margin-top" => {
                value.starts_with("-9")
            }
            "width" | "height" | "max-width" | "max-height" => clips && (zero(value) || value == "1px"),
            "text-decoration" | "text-decoration-line" => value.contains("line-through"),
            _ => false,
        }
    })
}

#[cfg(test)]
mod tests {
    use crate::verify::quote::html::{TEXT_SEPARATOR, strip};

    #[test]
    fn hidden_elements_are_not_rendered() {
        let visible = |html: &str| strip(html).0.replace(TEXT_SEPARATOR, "");
        assert_eq!(visible("a<div hidden>b<div>c</div>d</div>e"), "ae");
        assert_eq!(visible("a<span style=\"color: red; Display: none\">b</span>c"), "ac");
        assert_eq!(visible("a<p hidden=''>b</p>c<p title='hidden'>d</p>"), "acd");
        assert_eq!(visible("a<br hidden>b<!-- <p hidden> -->c < d"), "a bc < d");
        assert_eq!(visible("a<p hidden>b"), "a");
        assert_eq!(visible("a<script hidden>'<p hidden>'</script>b"), "ab");
        for open in [
            "template",
            "noscript",
            "del",
            "p hidden",
            "p HIDDEN",
            "p style='visibility:hidden'",
            "p style=\"opacity: 0\"",
            "p style='font-size:0px'",
            "p style='color:transparent'",
            "p style='color: rgba(0, 0, 0, 0)'",
            "p class='x sr-only'",
            "p style='height:0;overflow:hidden'",
            "p style='display:none !important'",
            "p style=display:none",
            "dialog",
            "p style='position:absolute;left:-9999px'",
        ] {
            let name = open.split(' ').next().unwrap();
            assert_eq!(visible(&format!("a<{open}>b</{name}>c")), "ac", "{open}");
        }
        for open in [
            "details",
            "p aria-hidden='true'",
            "p style='opacity:0.5'",
            "p class='hiddenlake'",
            "dialog open",
            "p style='left:0'",
        ] {
            assert!(visible(&format!("a<{open}>b</p>c")).contains('b'), "{open}");
        }
        // Read once, not once for each tag.
        assert_eq!(visible(&"<script>".repeat(200_000)), "");
    }
}
