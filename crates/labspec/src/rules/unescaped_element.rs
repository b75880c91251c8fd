//! Names of model elements written as tags: a browser takes them for HTML and shows nothing.

use super::MAX_IN_TEXT;
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// The text contains the name of an MJCF element as a tag.
pub const UNESCAPED_ELEMENT: &Rule = &Rule {
    code: "unescaped-element",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "the text contains the name of an MJCF element as a tag",
    why: "a browser reads it as HTML: the name disappears, or a form control appears",
    bad: Example::Lesson("Both are set in the ⟦<option>⟧ element.\n"),
    good: Example::Lesson("Both are set in the `<option>` element, that is &lt;option&gt;.\n"),
};

/// Elements of MJCF that no lesson means as HTML (XML reference of MuJoCo 3). Elements that HTML or SVG
/// fragments really use (`text`, `image`, `frame`, `filter`, `layer`) are left out.
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

/// Whether an element is one of models, which no lesson means as HTML.
pub(super) fn is_of_models(name: &str) -> bool {
    ELEMENTS.contains(&name) || name == WORLD
}

/// Tags of model elements in a piece of HTML: byte range and name.
fn tags(html: &str) -> Vec<(Range<usize>, &str)> {
    let mut found = Vec::new();
    for (at, _) in html.match_indices('<') {
        let inside = html.get(at + 1..).unwrap_or("");
        let inside = inside.strip_prefix('/').unwrap_or(inside);
        let length = inside.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(inside.len());
        let name = inside.get(..length).unwrap_or("");
        let after = inside.get(length..).unwrap_or("");
        if !after.starts_with(['>', '/', ' ', '\n', '\t']) || !is_of_models(name) {
            continue;
        }
        // Attributes end soon; a `<` before the `>` means that this tag has none.
        let start = html.len() - after.len();
        let end = after.find(['>', '<']).filter(|&i| after.get(i..).is_some_and(|a| a.starts_with('>')));
        let end = end.map_or(start, |i| start + i + 1);
        found.push((at..end, name));
    }
    // A form that really offers options is HTML.
    if html.contains("<select") {
        found.retain(|(_, name)| *name != "option");
    }
    found
}

fn finding(tag: &str, span: Range<usize>) -> Finding {
    let short_tag = crate::json::read::shorten(tag);
    let escaped = tag.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    Finding::new(UNESCAPED_ELEMENT, span.clone(), format!("a browser reads `{short_tag}` as HTML"))
        .help(format!("write {}", crate::json::read::shorten(&escaped)))
        .fix(span, escaped)
}

/// Looks into HTML that stands in the Markdown text, for so many findings at most.
pub(crate) fn in_markdown(text: &str, range: Range<usize>, most: usize) -> Vec<Finding> {
    let html = text.get(range.clone()).unwrap_or("");
    tags(html)
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

/// Looks into a text of a lab or a quiz.
pub(crate) fn check_html(text: &Text, findings: &mut Vec<Finding>) {
    for (tag, _) in tags(text.as_str()).into_iter().take(MAX_IN_TEXT) {
        let mut found = finding(text.value.get(tag.clone()).unwrap_or(""), text.span_of(tag));
        // Inside of JSON the quotes of attributes are escaped; the replacement must be so too.
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
    fn model_elements_are_told_from_html() {
        let names =
            |html| tags(html).into_iter().map(|(range, _)| html[range].to_string()).collect::<Vec<_>>();
        assert_eq!(
            names("in <code><option></code>, <geom size=\"1\"/> and <b>bold</b>"),
            ["<option>", "<geom size=\"1\"/>"]
        );
        assert_eq!(names("</worldbody> &lt;option&gt; 1 <geom"), ["</worldbody>"]);
        assert!(names("<select><option>a</option></select> a<body> b").len() == 1);
        assert!(names("x <key2> < option >").is_empty());
    }
}
