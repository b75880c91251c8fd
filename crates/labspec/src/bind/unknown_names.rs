//! The same unknown name in several texts of a lab: one mistake, and one finding.
//!
//! An author who writes `T = 2` in `setup` and reads `T` in a readout makes one mistake. Its help names what to write in all of
//! these places.

use crate::finding::Finding;
use crate::source::Text;
use labspec_expr::rules::UNKNOWN_NAME;
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of places of one finding.
const MAX_PLACES: usize = 20;

/// An unknown name without a similar name.
struct UnknownName {
    name: String,
    /// The index of its finding.
    finding: usize,
    /// The index of its text in the lab.
    text: usize,
    /// Whether it is assigned here.
    assigned: bool,
}

/// The unknown names of the texts of a lab.
#[derive(Default)]
pub(super) struct UnknownNames {
    all: Vec<UnknownName>,
    texts: usize,
}

impl UnknownNames {
    /// Records the unknown names of the next text, whose findings start at `first`. `reported` are the same findings with spans
    /// in the text.
    pub(super) fn add(&mut self, text: &Text, reported: &[Finding], first: usize) {
        for (i, found) in reported.iter().enumerate() {
            if found.code != UNKNOWN_NAME.code || found.fix.is_some() {
                continue;
            }
            let Some(name) = text.value.get(found.span.clone()) else { continue };
            let rest = text.value.get(found.span.end..).unwrap_or("").trim_start();
            let assigned = rest.starts_with('=') && !rest.starts_with("==") && !rest.starts_with("=>");
            let name = name.to_string();
            self.all.push(UnknownName { name, finding: first + i, text: self.texts, assigned });
        }
        self.texts += 1;
    }

    /// Joins the findings about the same name: at its assignment, or at its first use.
    pub(super) fn join(self, findings: &mut Vec<Finding>) {
        let mut by_name: BTreeMap<&str, Vec<&UnknownName>> = BTreeMap::new();
        self.all.iter().for_each(|one| by_name.entry(&one.name).or_default().push(one));
        let mut redundant = BTreeSet::new();
        for (name, uses) in by_name {
            let Some(main) = uses.iter().find(|one| one.assigned).or(uses.first()) else { continue };
            let others = uses.iter().filter(|one| one.finding != main.finding);
            let places = others.clone().filter_map(|one| findings.get(one.finding));
            let spans: Vec<_> = places.take(MAX_PLACES).map(|f| f.span.clone()).collect();
            let elsewhere = uses.iter().any(|one| one.text != main.text);
            let Some(finding) = findings.get_mut(main.finding) else { continue };
            for span in spans {
                *finding = finding.clone().related(span, "the same name");
            }
            if main.assigned && elsewhere {
                finding.help =
                    Some(format!("write `ctx.{name}` instead of `{name}` here and where the lab reads it"));
            }
            redundant.extend(others.map(|one| one.finding));
        }
        let mut index = 0;
        findings.retain(|_| {
            index += 1;
            !redundant.contains(&(index - 1))
        });
    }
}
