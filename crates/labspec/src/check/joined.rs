//! One mistake that several findings report.
//!
//! A misspelt definition: every use of the intended name is reported, although the mistake is in one place. If nothing uses
//! the defined name, these findings become one, which names the definition. The names of runs in place of their measures, and
//! names without quotes: an author who writes them so in one condition of a `verify` object does so in all.

use crate::finding::{Finding, Fix};
use crate::spec::Lesson;
use labspec_expr::rules::{COMPUTED_NAME, NOT_A_VALUE, UNKNOWN_FIELD, UNKNOWN_NAME, UNKNOWN_OBJECT};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Maximum number of names whose definitions are searched.
const MAX_NAMES: usize = 50;
/// Maximum number of places of one finding.
const MAX_PLACES: usize = 20;

/// Rules about the use of a name that is defined in the lesson.
fn is_about_use(code: &str) -> bool {
    [UNKNOWN_NAME.code, UNKNOWN_FIELD.code, UNKNOWN_OBJECT.code].contains(&code)
}

/// Joins the findings about several uses of a name whose definition is misspelt.
pub(super) fn join_uses(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let mut groups: BTreeMap<(&str, String), Vec<usize>> = BTreeMap::new();
    for (i, found) in findings.iter().enumerate().filter(|(_, f)| is_about_use(f.code) && f.fix.is_some()) {
        groups.entry((found.code, found.message.clone())).or_default().push(i);
    }
    let mut redundant: BTreeSet<usize> = BTreeSet::new();
    // Each name is searched in the whole text.
    for mut uses in groups.into_values().filter(|uses| uses.len() > 1).take(MAX_NAMES) {
        uses.sort_by_key(|i| findings.get(*i).map(|f| f.span.start));
        let [first, others @ ..] = uses.as_slice() else { continue };
        let spans: Vec<Range<usize>> =
            others.iter().take(MAX_PLACES).filter_map(|i| findings.get(*i)).map(|f| f.span.clone()).collect();
        let Some(finding) = findings.get_mut(*first) else { continue };
        let Some(joined) = at_definition(lesson, finding, spans) else { continue };
        *finding = joined;
        redundant.extend(others);
    }
    remove(findings, &redundant);
}

/// Joins the findings about the same mistake in several expressions of a `verify` object,
/// and lists what to write in each of them.
pub(super) fn join_repeated(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let claims: Vec<Range<usize>> = lesson.verifies().map(|verify| verify.span.clone()).collect();
    let mut groups: BTreeMap<(&str, usize, String), Vec<usize>> = BTreeMap::new();
    for (i, found) in findings.iter().enumerate() {
        if ![COMPUTED_NAME.code, NOT_A_VALUE.code].contains(&found.code) {
            continue;
        }
        let inside = |span: &Range<usize>| span.start <= found.span.start && found.span.end <= span.end;
        let Some(claim) = claims.iter().position(inside) else { continue };
        groups.entry((found.code, claim, without_names(&found.message))).or_default().push(i);
    }
    let mut redundant: BTreeSet<usize> = BTreeSet::new();
    for mut same in groups.into_values().filter(|same| same.len() > 1) {
        same.sort_by_key(|i| findings.get(*i).map(|f| f.span.start));
        let [first, others @ ..] = same.as_slice() else { continue };
        let places = others.iter().take(MAX_PLACES).filter_map(|i| findings.get(*i));
        let places: Vec<_> = places.map(|f| (f.span.clone(), f.help.clone().unwrap_or_default())).collect();
        let Some(finding) = findings.get_mut(*first) else { continue };
        let helps = places.iter().map(|(_, help)| help.as_str());
        let mut joined = finding.clone();
        joined.help = finding.help.as_deref().map(|first| join_helps(first, helps));
        for (span, _) in &places {
            joined = joined.related(span.clone(), "here as well");
        }
        // A fix of one place would leave the others.
        joined.fix = None;
        *finding = joined;
        redundant.extend(others);
    }
    remove(findings, &redundant);
}

/// One help for several places: what each of them quotes is listed once.
fn join_helps<'h>(first: &'h str, others: impl Iterator<Item = &'h str>) -> String {
    let (words, quoted) = first.split_at(first.find('`').unwrap_or(first.len()));
    let mut all = vec![quoted];
    for other in others.filter_map(|help| help.strip_prefix(words)) {
        if !all.contains(&other) {
            all.push(other);
        }
    }
    format!("{words}{}", all.join(", "))
}

/// A message without the names that it quotes.
fn without_names(message: &str) -> String {
    message.split('`').step_by(2).collect::<Vec<_>>().join("`")
}

fn remove(findings: &mut Vec<Finding>, redundant: &BTreeSet<usize>) {
    let mut index = 0;
    findings.retain(|_| {
        index += 1;
        !redundant.contains(&(index - 1))
    });
}

/// The finding about the first use, with a fix of the definition. `None` if the defined name is used elsewhere.
fn at_definition(lesson: &Lesson, finding: &Finding, others: Vec<Range<usize>>) -> Option<Finding> {
    let quote = |c: char| matches!(c, '\'' | '"' | '\\');
    let text = lesson.file.text();
    let used = text.get(finding.span.clone())?.trim_matches(quote);
    let Fix { text: defined, .. } = finding.fix.as_ref()?;
    let defined = defined.trim_matches(quote);
    let definition = only_place(text, defined)?;
    let mut joined = finding
        .clone()
        .help(format!("write `{used}` instead of `{defined}`, where it is defined: nothing uses `{defined}`"))
        .guess(definition.clone(), used)
        .related(definition, "the definition");
    for span in others {
        joined = joined.related(span, "the same name");
    }
    Some(joined)
}

/// The only place of a text that contains a word.
fn only_place(text: &str, word: &str) -> Option<Range<usize>> {
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
    let is_word = |offset: &usize| {
        let (before, after) = (text.get(..*offset), text.get(offset + word.len()..));
        !before.is_some_and(|t| t.ends_with(is_part)) && !after.is_some_and(|t| t.starts_with(is_part))
    };
    let mut places = text.match_indices(word).map(|(offset, _)| offset).filter(is_word);
    let first = places.next().filter(|_| !word.is_empty())?;
    places.next().is_none().then(|| first..first + word.len())
}
