//! Duplicate texts where texts must differ.

use crate::finding::Finding;
use crate::json::read::named;
use crate::source::Text;
use labspec_finding::Rule;
use std::collections::HashMap;

/// The help text about duplicate labels.
pub(crate) const DISTINCT: &str = "change one of the labels, so that they differ";

/// Reports every text that equals an earlier one.
pub(crate) fn repeated<'a>(
    rule: &Rule,
    what: &str,
    help: &str,
    texts: impl Iterator<Item = &'a Text>,
    findings: &mut Vec<Finding>,
) {
    let mut first: HashMap<&str, &Text> = HashMap::new();
    for text in texts {
        match first.get(text.as_str()) {
            Some(before) => findings.push(
                Finding::new(rule, text.span(), format!("two {what} {}", named(text.as_str())))
                    .related(before.span(), "the first one")
                    .help(help),
            ),
            None => {
                first.insert(text.as_str(), text);
            }
        }
    }
}
