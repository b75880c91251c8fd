//! Names of model elements written as tags: a browser reads them as HTML and shows nothing.

use super::MAX_IN_TEXT;
use crate::markdown::html::{HtmlTag, tags};
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// The text contains the name of an MJCF element as a tag.
pub const UNESCAPED_ELEMENT: &Rule = &Rule {
    code: "unescaped-element",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the text contains the name of an MJCF element as a tag",
    why: "a browser reads it as HTML: the name disappears, or a form control appears",
    bad: Example::Lesson("Both are set in the ⟦<option>⟧ element.\n"),
    good: Example::Lesson("Both are set in the `<option>` element, that is &lt;option&gt;.\n"),
};

/// Elements of MJCF that no lesson intends as HTML (XML reference of MuJoCo 3). Elements that also occur in HTML or SVG (`text`,
/// `image`, `frame`, `filter`, `layer`) are not listed.
#[rustfmt::skip]
const ELEMENTS: [&str; 64] = [
    "accelerometer", "actuator", "adhesion", "asset", "attach", "body", "camera", "compiler", "composite",
    "connect", "contact", "custom", "cylinder", "default", "deformable", "equality", "exclude", "extension",
    "fixed", "flag", "flex", "flexcomp", "force", "framepos", "framequat", "freejoint", "general", "geom",
    "global", "gyro", "headlight", "hfield", "include", "inertial", "intvelocity", "joint", "jointpos",
    "jointvel", "key", "keyframe", "light", "material", "mesh", "motor", "mujoco", "muscle", "numeric",
    "option", "pair", "plugin", "position", "quality", "replicate", "sensor", "site", "size", "skin",
    "spatial", "statistic", "tendon", "texture", "touch", "velocity", "weld",
];
const WORLD: &str = "worldbody";

/// Whether an element belongs to MJCF, and no lesson intends it as HTML.
pub(super) fn is_of_models(name: &str) -> bool {
    ELEMENTS.contains(&name) || name == WORLD
}

/// The tags of model elements in a piece of HTML: byte range and name.
fn model_tags(html: &str) -> Vec<(Range<usize>, String)> {
    let all: Vec<HtmlTag> = tags(html).collect();
    // A form with options is HTML.
    let form = all.iter().any(|tag| tag.name == "select");
    let of_models = all.into_iter().filter_map(|HtmlTag { span, name, closing, .. }| {
        let name_end = span.start + 1 + usize::from(closing) + name.len();
        // Names of model elements are in lower case. A name at the end of the text may be incomplete.
        let small = html.get(span.start..name_end).is_some_and(|text| text.ends_with(&name));
        if !small || span.end == name_end || !is_of_models(&name) || form && name == "option" {
            return None;
        }
        // Attributes are short. A `<` before the `>` means that this tag has no attributes.
        let attributes = html.get(name_end..span.end).unwrap_or("");
        let end = if attributes.contains('<') || !attributes.ends_with('>') { name_end } else { span.end };
        Some((span.start..end, name))
    });
    of_models.collect()
}

fn finding(tag: &str, span: Range<usize>) -> Finding {
    let short_tag = crate::json::read::shorten(tag);
    let escaped = tag.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    Finding::new(UNESCAPED_ELEMENT, span.clone(), format!("a browser reads `{short_tag}` as HTML"))
        .help(format!("write {}", crate::json::read::shorten(&escaped)))
        .fix(span, escaped)
}

/// Checks the HTML of Markdown text. Returns at most `most` findings.
pub(crate) fn in_markdown(text: &str, range: Range<usize>, most: usize) -> Vec<Finding> {
    let html = text.get(range.clone()).unwrap_or("");
    model_tags(html)
        .into_iter()
        .take(most)
        .map(|(tag, _)| {
            let span = range.start + tag.start..range.start + tag.end;
            let text_of_tag = html.get(tag).unwrap_or("");
            finding(text_of_tag, span).help(format!(
                "write it as code, `{text_of_tag}` between backticks, or as {}",
                text_of_tag.replace('<', "&lt;").replace('>', "&gt;")
            ))
        })
        .collect()
}

/// Checks a text of a lab or a quiz.
pub(crate) fn check_html(text: &Text, findings: &mut Vec<Finding>) {
    for (tag, _) in model_tags(text.as_str()).into_iter().take(MAX_IN_TEXT) {
        let mut found = finding(text.value.get(tag.clone()).unwrap_or(""), text.span_of(tag));
        // In JSON, the quotes of attributes are escaped, so the replacement escapes them too.
        if let Some(fix) = &mut found.fix {
            fix.text = fix.text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n");
        }
        findings.push(found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn model_elements_are_distinguished_from_html() {
        let names =
            |html| model_tags(html).into_iter().map(|(range, _)| html[range].to_string()).collect::<Vec<_>>();
        assert_eq!(
            names("in <code><option></code>, <geom size=\"1\"/> and <b>bold</b>"),
            ["<option>", "<geom size=\"1\"/>"]
        );
        assert_eq!(names("</worldbody> &lt;option&gt; 1 <geom"), ["</worldbody>"]);
        assert!(names("<select><option>a</option></select> a<body> b").len() == 1);
        assert!(names("x <key2> < option >").is_empty());
    }
}
