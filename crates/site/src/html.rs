//! The HTML of lessons. What shows text stays: a list of elements, each with a list of attributes. Everything else is left out:
//! scripts, styles, event handlers, addresses that run something.
//!
//! The text is read as tokens (the crate `html5gum`), and every token that stays is written anew, so that no part of what an
//! author wrote is copied into a page as markup. A sanitizing crate with its own tree (`ammonia`) brings a parser for style
//! sheets under a licence that is not on the list of `deny.toml`; here no style is allowed, and the tokens are enough.

use crate::text::escape;
use html5gum::{DefaultEmitter, HtmlString, StartTag, Token, Tokenizer};
use std::collections::BTreeMap;

/// Elements that stay.
const ELEMENTS: [&str; 52] = [
    "a",
    "abbr",
    "b",
    "blockquote",
    "br",
    "caption",
    "code",
    "dd",
    "del",
    "details",
    "dfn",
    "div",
    "dl",
    "dt",
    "em",
    "figcaption",
    "figure",
    "h1",
    "h2",
    "h3",
    "h4",
    "h5",
    "h6",
    "hr",
    "i",
    "img",
    "ins",
    "kbd",
    "li",
    "mark",
    "ol",
    "p",
    "pre",
    "q",
    "s",
    "samp",
    "small",
    "span",
    "strong",
    "sub",
    "summary",
    "sup",
    "table",
    "tbody",
    "td",
    "tfoot",
    "th",
    "thead",
    "tr",
    "u",
    "ul",
    "var",
];
/// Elements without an end tag.
const VOID: [&str; 3] = ["br", "hr", "img"];
/// Elements that end where the next one of their kind begins.
const ENDED_BY_NEXT: [&str; 7] = ["p", "li", "td", "th", "tr", "dt", "dd"];
/// Elements whose text is no text of the author.
const DROPPED: [&str; 12] = [
    "script", "style", "template", "iframe", "object", "noscript", "svg", "math", "textarea", "select",
    "title", "xmp",
];
/// Attributes that stay on every element.
const EVERYWHERE: [&str; 3] = ["lang", "dir", "title"];
/// The maximum nesting of elements.
const MAX_DEPTH: usize = 64;

/// The attributes of a start tag with decoded values.
pub(crate) type Attributes = BTreeMap<String, String>;

/// The HTML with some start tags edited: `edit` gets the name and the attributes of each, and returns whether it changed them.
/// All other text stays as it is.
pub(crate) fn edit_start_tags(html: &str, mut edit: impl FnMut(&str, &mut Attributes) -> bool) -> String {
    let mut emitter = DefaultEmitter::new_with_span();
    // The content of a script contains no tags.
    emitter.naively_switch_states(true);
    let mut out = String::with_capacity(html.len());
    let mut copied = 0;
    for token in Tokenizer::new_with_emitter(html, emitter).flatten() {
        let Token::StartTag(StartTag { name, attributes, self_closing, span, .. }) = token else { continue };
        let name = read(&name);
        let mut attributes: Attributes =
            attributes.iter().map(|(name, value)| (read(name), read(value))).collect();
        if !edit(&name, &mut attributes) {
            continue;
        }
        out.push_str(html.get(copied..span.start).unwrap_or(""));
        out.push_str(&format!("<{name}"));
        for (attribute, value) in &attributes {
            out.push_str(&format!(" {attribute}=\"{}\"", escape(value)));
        }
        out.push_str(if self_closing { "/>" } else { ">" });
        copied = span.end;
    }
    out + html.get(copied..).unwrap_or("")
}

/// Decides about the addresses of links and images.
pub(crate) trait Addresses {
    /// The address of a link; `None` where it must not lead anywhere.
    fn link(&mut self, target: &str) -> Option<String>;
    /// The address of an image; `None` where the page cannot show it.
    fn image(&mut self, target: &str) -> Option<String>;
    /// An id of this page that the author chose; `None` where it is taken.
    fn id(&mut self, id: &str) -> Option<String>;
}

/// The elements of the author that are open.
#[derive(Debug, Default)]
pub(crate) struct AuthorElements {
    names: Vec<&'static str>,
}

impl AuthorElements {
    /// The number of open elements.
    pub(crate) fn depth(&self) -> usize {
        self.names.len()
    }

    /// The end tags of all elements above a depth, which are then closed.
    pub(crate) fn close_to(&mut self, depth: usize) -> String {
        let mut out = String::new();
        while self.names.len() > depth {
            if let Some(name) = self.names.pop() {
                out.push_str(&format!("</{name}>"));
            }
        }
        out
    }

    /// The harmless part of some HTML. Elements below the depth `base` stay open.
    pub(crate) fn filter(&mut self, html: &str, base: usize, addresses: &mut dyn Addresses) -> String {
        let mut out = String::new();
        let mut dropped: Option<String> = None;
        // With spans, which are not read: one tokenizer in the program.
        for token in Tokenizer::new_with_emitter(html, DefaultEmitter::<usize>::new_with_span()).flatten() {
            match (token, &dropped) {
                (Token::EndTag(tag), Some(name)) if read(&tag.name) == *name => dropped = None,
                (_, Some(_)) => {}
                (Token::StartTag(tag), None) => {
                    let name = read(&tag.name);
                    if DROPPED.contains(&name.as_str()) {
                        dropped = Some(name).filter(|_| !tag.self_closing);
                        continue;
                    }
                    let attributes: Vec<(String, String)> =
                        tag.attributes.iter().map(|(name, value)| (read(name), read(value))).collect();
                    out.push_str(&self.start(&name, &attributes, base, addresses));
                }
                (Token::EndTag(tag), None) => out.push_str(&self.end(&read(&tag.name), base)),
                (Token::String(text), None) => out.push_str(&escape(&read(&text))),
                (Token::Comment(_) | Token::Doctype(_) | Token::Error(_), None) => {}
            }
        }
        out
    }

    fn start(
        &mut self,
        name: &str,
        attributes: &[(String, String)],
        base: usize,
        addresses: &mut dyn Addresses,
    ) -> String {
        let Some(name) = ELEMENTS.iter().copied().find(|n| *n == name) else { return String::new() };
        if self.names.len() >= MAX_DEPTH && !VOID.contains(&name) {
            return String::new();
        }
        let mut out = String::new();
        if ENDED_BY_NEXT.contains(&name) && self.names.len() > base && self.names.last() == Some(&name) {
            out.push_str(&self.close_to(self.names.len() - 1));
        }
        let mut written = format!("<{name}");
        let mut has_source = false;
        for (attribute, value) in attributes {
            let allowed = match (name, attribute.as_str()) {
                ("a", "href") => addresses.link(value),
                ("img", "src") => {
                    let source = addresses.image(value);
                    has_source = source.is_some();
                    source
                }
                (_, "id") | ("a", "name") => addresses.id(value),
                ("img", "alt") | ("ol", "start") | ("th", "scope") => Some(value.clone()),
                ("img", "width" | "height") | ("td" | "th", "colspan" | "rowspan") => {
                    Some(value.clone()).filter(|v| v.len() < 5 && v.bytes().all(|b| b.is_ascii_digit()))
                }
                ("details", "open") => Some(String::new()),
                (_, attribute) if EVERYWHERE.contains(&attribute) => Some(value.clone()),
                _ => None,
            };
            if let Some(value) = allowed {
                let attribute = if attribute == "name" { "id" } else { attribute };
                written.push_str(&format!(" {attribute}=\"{}\"", escape(&value)));
            }
        }
        if name == "img" && !has_source {
            let alt = attributes.iter().find(|(name, _)| name == "alt").map_or("", |(_, value)| value);
            return escape(alt);
        }
        if name == "img" && !attributes.iter().any(|(name, _)| name == "alt") {
            written.push_str(" alt=\"\"");
        }
        if !VOID.contains(&name) {
            self.names.push(name);
        }
        out.push_str(&written);
        out.push('>');
        out
    }

    fn end(&mut self, name: &str, base: usize) -> String {
        match self.names.iter().rposition(|open| *open == name) {
            Some(index) if index >= base => self.close_to(index),
            _ => String::new(),
        }
    }
}

fn read(text: &HtmlString) -> String {
    String::from_utf8_lossy(text).into_owned()
}

/// A whole text of HTML, such as a question. Formulas between dollar signs become elements that the page draws.
pub(crate) fn harmless(html: &str, addresses: &mut dyn Addresses) -> String {
    let mut open = AuthorElements::default();
    let mut out = open.filter(html, 0, addresses);
    out.push_str(&open.close_to(0));
    with_formulas(&out)
}

/// Formulas between dollar signs as elements. The text is written already: what is between the signs stays escaped.
fn with_formulas(html: &str) -> String {
    let parts: Vec<&str> = html.split('$').collect();
    let mut out = String::new();
    let mut i = 0;
    while let Some(part) = parts.get(i) {
        let inside = parts.get(i + 1).filter(|_| i + 2 < parts.len());
        out.push_str(part);
        match inside {
            Some(tex) if !tex.is_empty() && !tex.contains(['\n', '<']) => {
                out.push_str(&format!("<span class=\"math\">{tex}</span>"));
                i += 2;
            }
            _ => {
                out.push_str(if i + 1 < parts.len() { "$" } else { "" });
                i += 1;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_start_tags_are_edited() {
        let link = |name: &str, attributes: &mut Attributes| {
            let is_link = name == "a";
            is_link.then(|| attributes.insert("rel".into(), "noopener".into()));
            is_link
        };
        let text =
            "<p>Write <code>&lt;a href=\"http://x\"> <b id=q></code></p><script>\"<a href='y'>\"</script>";
        assert_eq!(edit_start_tags(text, link), text);
        let html = format!("{text}<a id=\"1\" href='?a&amp;b=\"'>ä</a> <A HREF=http://x>b</a><br/>");
        let edited = format!(
            "{text}<a href=\"?a&amp;b=&quot;\" id=\"1\" rel=\"noopener\">ä</a> <a href=\"http://x\" rel=\"noopener\">b</a><br/>"
        );
        assert_eq!(edit_start_tags(&html, link), edited);
        assert_eq!(edit_start_tags("<a href=", link), "<a href=");
    }

    /// Links to the web only.
    struct Web;

    impl Addresses for Web {
        fn link(&mut self, target: &str) -> Option<String> {
            target.starts_with("https:").then(|| target.to_string())
        }

        fn image(&mut self, _: &str) -> Option<String> {
            None
        }

        fn id(&mut self, id: &str) -> Option<String> {
            Some(id.to_string())
        }
    }

    #[test]
    fn what_runs_is_left_out() {
        for (html, left) in [
            ("a<script>alert(1)</script>b", "ab"),
            ("<img src=x onerror=alert(1) alt=picture>", "picture"),
            ("<a href='javascript:alert(1)' onclick=x>t</a>", "<a>t</a>"),
            ("<p style='position:fixed'>t", "<p>t</p>"),
            ("<svg><script>1</script></svg>t", "t"),
            ("<iframe srcdoc='<script>1</script>'></iframe>t", "t"),
            ("<b id=\"x&quot; onclick=&quot;1\">t</b>", "<b id=\"x&quot; onclick=&quot;1\">t</b>"),
            ("<math><mtext><style><img src onerror=1>", ""),
            ("</div></main>t<sim-lab>u</sim-lab>", "tu"),
            ("<meta http-equiv=refresh content=0><base href=//x>t", "t"),
            ("<!-- <b> -->t&lt;u", "t&lt;u"),
            ("<details open><summary>s</summary>t", "<details open=\"\"><summary>s</summary>t</details>"),
            ("<ul><li>a<li>b</ul>", "<ul><li>a</li><li>b</li></ul>"),
        ] {
            assert_eq!(harmless(html, &mut Web), left, "{html}");
        }
        assert!(harmless(&"<div>".repeat(100_000), &mut Web).len() < 2000);
    }

    #[test]
    fn formulas_are_elements_and_money_is_not() {
        assert_eq!(harmless("a $x &lt; y$ b", &mut Web), "a <span class=\"math\">x &lt; y</span> b");
        assert_eq!(harmless("5 $", &mut Web), "5 $");
        assert_eq!(harmless("$<b>x</b>$", &mut Web), "$<b>x</b>$");
    }
}
