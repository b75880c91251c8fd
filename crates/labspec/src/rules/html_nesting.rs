use super::MAX_IN_TEXT;
use super::html_element::{SELF_CLOSING, VOID, is_element, unknown};
use super::unescaped_element::is_of_models;
use crate::json::read::shorten;
use crate::markdown::html::{HtmlTag, tags};
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// HTML elements in a lab or a quiz are not closed in the order in which they are opened.
pub const HTML_NESTING: &Rule = &Rule {
    code: "html-nesting",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "HTML elements in a lab or a quiz are not closed in the order in which they are opened",
    why: "a browser guesses where they end, and the rest of the page may look like code or a heading",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "<p>What is ⟦<code>⟧qpos?</p>"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "<p>What is <code>qpos</code>?</p>"}]}"#,
    ),
};

/// Foreign elements, which contain elements that are not HTML.
const FOREIGN_ELEMENTS: [&str; 2] = ["svg", "math"];

/// The maximum number of tags of a text that are checked.
const MAX_TAGS: usize = 3000;

/// What is wrong with a tag.
#[derive(Debug, PartialEq)]
enum MarkupFault {
    /// HTML has no such element.
    Unknown,
    /// No tag closes it.
    Unclosed,
    /// No open element matches the closing tag.
    Unopened,
    /// It closes an element while this inner element is open.
    Crossed(String),
}

fn faults(html: &str) -> Vec<(Range<usize>, String, MarkupFault)> {
    let mut faults = Vec::new();
    let mut open: Vec<HtmlTag> = Vec::new();
    let mut all = tags(html);
    for tag in all.by_ref().take(MAX_TAGS) {
        let foreign = open.iter().any(|t| FOREIGN_ELEMENTS.contains(&t.name.as_str()));
        let name = tag.name.as_str();
        let of_html = is_element(name);
        let opening = open.iter().rposition(|t| t.name == tag.name);
        if tag.closing {
            match opening {
                // A lone `</p>` makes an empty paragraph, and a lone `</br>` a line break: readers see no difference.
                None if is_of_models(name) || VOID.contains(&name) => {}
                None if !of_html && !foreign => faults.push((tag.span, tag.name, MarkupFault::Unknown)),
                None => faults.push((tag.span, tag.name, MarkupFault::Unopened)),
                Some(i) => {
                    let inner = open.split_off(i);
                    let crossed = inner.iter().skip(1).find(|t| !SELF_CLOSING.contains(&t.name.as_str()));
                    if let Some(other) = crossed {
                        faults.push((other.span.clone(), other.name.clone(), MarkupFault::Crossed(tag.name)));
                    }
                }
            }
        } else if is_of_models(name) && !foreign {
            // Another rule reports elements of models.
        } else if !of_html && !foreign && !name.contains('-') {
            faults.push((tag.span, tag.name, MarkupFault::Unknown));
        } else if !(VOID.contains(&name)
            || foreign && html.get(tag.span.clone()).is_some_and(|tag| tag.ends_with("/>")))
        {
            open.push(tag);
        }
    }
    // If the limit is reached, open elements may be closed later.
    if all.next().is_some() {
        open.clear();
    }
    let left = open.into_iter().filter(|t| !SELF_CLOSING.contains(&t.name.as_str()));
    faults.extend(left.map(|t| (t.span, t.name, MarkupFault::Unclosed)));
    faults
}

/// Checks a text of a lab or a quiz.
pub(crate) fn check_markup(text: &Text, findings: &mut Vec<Finding>) {
    for (span, name, fault) in faults(text.as_str()).into_iter().take(MAX_IN_TEXT) {
        let short_text = shorten(text.value.get(span.clone()).unwrap_or(""));
        let (message, help) = match fault {
            MarkupFault::Unknown => {
                findings.push(unknown(text.span_of(span), &name));
                continue;
            }
            MarkupFault::Unclosed => {
                (format!("`{short_text}` is not closed"), format!("write </{name}> where it ends"))
            }
            MarkupFault::Unopened => (
                format!("`{short_text}` closes nothing"),
                format!("delete it, or write <{name}> where the element begins"),
            ),
            MarkupFault::Crossed(outer) => (
                format!("`{short_text}` is still open where `</{outer}>` closes the element around it"),
                format!("write </{name}> before </{outer}>"),
            ),
        };
        findings.push(Finding::new(HTML_NESTING, text.span_of(span), message).help(help));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_that_browsers_correct_is_reported() {
        let faults_in =
            |html: &str| faults(html).into_iter().map(|(_, name, fault)| (name, fault)).collect::<Vec<_>>();
        let named = |name: &str, fault| vec![(name.to_string(), fault)];
        assert_eq!(faults_in("<p>one <b>two</b><p>three <br> <img src='a'> 1 < 2 <code>x</code>"), []);
        assert_eq!(faults_in("<ul><li>a<li>b</ul> <!-- <b> --> <svg><path d=''/><g></g></svg>"), []);
        assert_eq!(faults_in("<p>a <code>x</p>"), named("code", MarkupFault::Crossed("p".into())));
        assert_eq!(faults_in("a <code>x"), named("code", MarkupFault::Unclosed));
        assert_eq!(faults_in("a</b>"), named("b", MarkupFault::Unopened));
        assert_eq!(faults_in("<strnog>a</strnog>").len(), 2);
        assert_eq!(faults_in("if a<bc and d>e"), named("bc", MarkupFault::Unknown));
        // Another rule reports these.
        assert_eq!(faults_in("set in <option>, <geom size='1'/>"), []);
    }
}
