//! Elements that a page does not show, or shows struck out: `hidden`, `template`, `display: none`, a size of zero. What opens on a
//! click (`details`) is shown, and so is what only screen readers pass over (`aria-hidden`).

use super::tags::{read_tag, tag_end};
use std::ops::Range;

/// An element that a page does not show, from its start tag to its end tag.
#[derive(Default)]
pub(super) struct Hidden {
    /// The name of the element, and how many of this name are open; none are when everything is shown.
    name: String,
    open: usize,
}

/// Elements without an end tag.
const VOID: [&str; 13] =
    ["area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"];

/// Elements that no page shows where it runs scripts and plays media, and words that are struck out.
const UNSEEN: [&str; 14] = [
    "template", "noscript", "datalist", "head", "iframe", "object", "audio", "video", "canvas", "rp", "del",
    "s", "strike", "noframes",
];

/// Classes by which the usual style sheets hide an element.
const CLASSES: [&str; 7] =
    ["hidden", "d-none", "invisible", "sr-only", "visually-hidden", "is-hidden", "screen-reader-text"];

impl Hidden {
    /// Whether what follows is hidden.
    pub(super) fn is_on(&self) -> bool {
        self.open > 0
    }

    /// Everything is shown again.
    pub(super) fn end(&mut self) {
        self.open = 0;
    }

    /// Takes in a tag; whether it, too, belongs to what is hidden.
    pub(super) fn take_tag(&mut self, tag: &str) -> bool {
        let inside = tag.strip_prefix('<').unwrap_or("");
        let (closing, inside) = inside.strip_prefix('/').map_or((false, inside), |rest| (true, rest));
        let length = inside.find(|c: char| !c.is_ascii_alphanumeric() && c != '-').unwrap_or(inside.len());
        let (name, rest) =
            (inside.get(..length).unwrap_or("").to_ascii_lowercase(), inside.get(length..).unwrap_or(""));
        let was = self.is_on();
        if was && name == self.name && !name.is_empty() {
            self.open = if closing { self.open - 1 } else { self.open + 1 };
        } else if !was
            && !closing
            && !name.is_empty()
            && !VOID.contains(&name.as_str())
            && (UNSEEN.contains(&name.as_str()) || hides(&name, rest))
        {
            (self.name, self.open) = (name, 1);
        }
        was || self.is_on()
    }

    /// The parts of a piece of HTML that are shown.
    pub(super) fn visible_ranges(&mut self, html: &str) -> Vec<Range<usize>> {
        let (mut visible_ranges, mut at, mut from) = (Vec::new(), 0, 0);
        while let Some(next) = html.get(at..).and_then(|rest| rest.find('<')).map(|i| at + i) {
            let rest = html.get(next..).unwrap_or("");
            let was = self.is_on();
            // Comments and scripts hold no tags; a lone `<` is none.
            let Some((_, length)) = read_tag(rest) else {
                at = next + 1;
                continue;
            };
            self.take_tag(rest.get(..tag_end(rest)).unwrap_or(""));
            at = next + length;
            match (was, self.is_on()) {
                (false, true) => visible_ranges.push(from..next),
                (true, false) => from = at,
                _ => {}
            }
        }
        if !self.is_on() {
            visible_ranges.push(from..html.len());
        }
        visible_ranges
    }
}

/// The attributes of a tag, in lower case: names and values.
fn attributes(text: &str) -> Vec<(String, String)> {
    let mut all: Vec<(String, String)> = Vec::new();
    let mut rest = text.trim_end_matches('>').trim_end_matches('/');
    loop {
        rest = rest.trim_start_matches(|c: char| c.is_whitespace() || c == '/');
        let length = rest.find(|c: char| c.is_whitespace() || c == '=').unwrap_or(rest.len());
        if length == 0 {
            let Some(next) = rest.get(1..).filter(|_| rest.starts_with('=')) else { return all };
            rest = next;
            continue;
        }
        let name = rest.get(..length).unwrap_or("").to_ascii_lowercase();
        rest = rest.get(length..).unwrap_or("").trim_start();
        let mut value = String::new();
        if let Some(tail) = rest.strip_prefix('=') {
            let tail = tail.trim_start();
            let quote = tail.chars().next().filter(|c| matches!(c, '"' | '\''));
            let body = if quote.is_some() { tail.get(1..).unwrap_or("") } else { tail };
            let end = match quote {
                Some(quote) => body.find(quote),
                None => body.find(char::is_whitespace),
            };
            let end = end.unwrap_or(body.len());
            value = body.get(..end).unwrap_or("").to_ascii_lowercase();
            rest = body.get(end + usize::from(quote.is_some())..).unwrap_or("");
        }
        all.push((name, value));
    }
}

/// Whether the attributes of a tag say that its element is not shown.
fn hides(name: &str, text: &str) -> bool {
    let all = attributes(text);
    let has = |wanted: &str| all.iter().any(|(name, _)| name == wanted);
    let value = |wanted: &str| {
        all.iter().filter(|(name, _)| name == wanted).map(|(_, value)| value.as_str()).collect::<Vec<_>>()
    };
    has("hidden")
        || has("popover")
        || name == "dialog" && !has("open")
        || value("class")
            .iter()
            .flat_map(|list| list.split_whitespace())
            .any(|class| CLASSES.contains(&class))
        || value("style").into_iter().any(style_hides)
}

/// Whether a style leaves nothing to see.
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
    use super::*;

    #[test]
    fn what_is_hidden_is_not_shown() {
        let visible = |html: &str| {
            let mut hidden = Hidden::default();
            hidden.visible_ranges(html).iter().map(|r| html[r.clone()].to_string()).collect::<String>()
        };
        assert_eq!(visible("a<div hidden>b<div>c</div>d</div>e"), "ae");
        assert_eq!(visible("a<span style=\"color: red; Display: none\">b</span>c"), "ac");
        assert_eq!(visible("a<p hidden=''>b</p>c<p title='hidden'>d</p>"), "ac<p title='hidden'>d</p>");
        assert_eq!(visible("a<br hidden>b<!-- <p hidden> -->c < d"), "a<br hidden>b<!-- <p hidden> -->c < d");
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
        // Walked once, not once for each.
        assert_eq!(visible(&"<script>".repeat(200_000)).len(), 1_600_000);
    }
}
