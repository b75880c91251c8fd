//! The overview of a check for people: what was run and verified in each lesson, and the summary.

use super::course::CourseResults;
use labspec::check::{self, Checked};
use labspec::ledger::{Entry, Ledger, State, Subject};
use labspec::report::counted;
use labspec::report::{Summary, concise, printable};
use labspec::source::SourceFile;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

/// What was run and verified in each lesson. True claims share a line; each other claim has its own line with the reason. In a
/// course of several lessons, one whose claims are all true has one line with their numbers.
pub(super) fn format_overview(results: &CourseResults, with_evidence: bool) -> String {
    let mut text = String::new();
    let mut by_path: BTreeMap<&Arc<str>, Vec<&Entry>> = BTreeMap::new();
    for entry in results.ledger.entries().iter().filter(|e| e.subject != Subject::File) {
        by_path.entry(&entry.path).or_default().push(entry);
    }
    let mut clean = Vec::new();
    for c in &results.checked {
        let path = c.lesson.file.path();
        let Some(entries) = by_path.get(path) else { continue };
        if !with_evidence && results.checked.len() > 1 && entries.iter().all(|e| is_good(e)) {
            let of_lesson = Ledger::from_iter(entries.iter().map(|e| (*e).clone()));
            clean.push((printable(path).into_owned(), of_lesson.summary()));
            continue;
        }
        let _ = writeln!(text, "{}", printable(path));
        write_lesson(&mut text, c, entries, with_evidence);
        text.push('\n');
    }
    let width = clean.iter().map(|(path, _)| path.chars().count()).max().unwrap_or(0).min(MAX_PATH);
    for (path, counts) in &clean {
        let _ = writeln!(text, "{path:<width$}  {counts}");
    }
    if !clean.is_empty() {
        text.push('\n');
    }
    text
}

/// The maximum width of the column of paths, in characters.
const MAX_PATH: usize = 50;

/// Whether a claim needs no line of its own in a course with several lessons.
fn is_good(entry: &Entry) -> bool {
    matches!(entry.state, State::True(_))
}

/// Writes the claims of a lesson, its snapshots, and the evidence of claims.
fn write_lesson(text: &mut String, c: &Checked, entries: &[&Entry], with_evidence: bool) {
    let mut written = 0;
    // Objects that use another one have its measures.
    let mut listed: Vec<Vec<String>> = Vec::new();
    while let Some(entry) = entries.get(written) {
        let count = joined_entries(&entries[written..]);
        written += count;
        if let Some(line) = format_entries(entry, count) {
            let _ = writeln!(text, "  {}", printable(&line));
        }
        let snapshot = c.snapshots.iter().find(|snapshot| {
            entry.subject == Subject::Snapshot && entry.owner.strip_prefix("lab ") == Some(&*snapshot.lab)
        });
        for change in snapshot.into_iter().flat_map(check::SnapshotResult::lines) {
            let _ = writeln!(text, "  {:<10}   {}", "", printable(&change));
        }
        let is_last = entries.get(written).is_none_or(|next| next.owner != entry.owner);
        let is_last = is_last && entry.subject != Subject::Snapshot;
        let claim = c.claims.iter().find(|claim| is_last && claim.name == entry.owner);
        let claim = claim.filter(|claim| with_evidence || claim.is_doubtful());
        if let Some(claim) = claim {
            let measures = check::measure_lines(claim);
            let is_new = measures.is_empty() || !listed.contains(&measures);
            let measured: &[String] = if is_new { &measures } else { &[] };
            for evidence in measured.iter().chain(&check::option_lines(claim)) {
                let _ = writeln!(text, "  {:<10}   {}", "", printable(evidence));
            }
            listed.push(measures);
        }
    }
}

/// The number of leading entries that share a line: consecutive ones with the same subject, owner and state
/// that are true or left out.
fn joined_entries(entries: &[&Entry]) -> usize {
    let Some(first) = entries.first() else { return 0 };
    let is_plain = matches!(first.state, State::True(_) | State::Skipped);
    if !is_plain
        || matches!(first.subject, Subject::Lab | Subject::Widget | Subject::Snapshot | Subject::Listing)
    {
        return 1;
    }
    let same = |e: &&&Entry| e.subject == first.subject && e.owner == first.owner && e.word == first.word;
    entries.iter().take_while(same).count().max(1)
}

/// The line for `n` claims with the same subject and state, or `None` if there is nothing to report.
fn format_entries(entry: &Entry, n: usize) -> Option<String> {
    let remark = if entry.remark.is_empty() { String::new() } else { format!(": {}", entry.remark) };
    let good = matches!(entry.state, State::True(_));
    let is_skipped = entry.state == State::Skipped;
    let titled = |what: &str| if what.is_empty() { String::new() } else { format!(" \"{what}\"") };
    let Entry { owner, what, word, .. } = entry;
    Some(match entry.subject {
        Subject::File => return None,
        Subject::Run if good && *word == "made" => return None,
        Subject::Answer | Subject::Lab if is_skipped => format!("{word:<10} {owner}{}", titled(what)),
        Subject::Model | Subject::Widget => format!("{word:<10} {owner}{remark}"),
        Subject::Snapshot if is_skipped => format!("{word:<10} {owner}, its snapshot"),
        _ if is_skipped => format!("{word:<10} {owner}, {}", counted(n, entry.subject.as_str())),
        Subject::Lab => {
            let title = titled(what);
            if good {
                format!("{:<10} {owner}{title}", entry.remark)
            } else {
                format!("{word:<10} {owner}{title}{remark}")
            }
        }
        Subject::Snapshot => format!("{word:<10} {owner}, its snapshot{remark}"),
        Subject::Listing => format!("{word:<10} {owner}{}{remark}", titled(what)),
        Subject::Answer if good => format!("{word:<10} {owner}"),
        Subject::Answer => format!("{word:<10} {owner}{remark}"),
        Subject::Option => format!("{word:<10} {owner}, option {what}"),
        Subject::PrintedNumber => {
            format!("{word:<10} {owner}, {} of the text", counted(n, "number"))
        }
        Subject::Quote | Subject::ClosedForm if good => {
            format!("{word:<10} {owner}, {}", counted(n, entry.subject.as_str()))
        }
        Subject::Quote | Subject::ClosedForm | Subject::Run => {
            format!("{word:<10} {owner}, {} \"{what}\"{remark}", entry.subject.as_str())
        }
    })
}

/// The last line: the number of claims by state, and the conclusion.
pub(super) fn format_summary(results: &CourseResults) -> String {
    let found = Summary::count(&results.findings);
    let found = if results.findings.is_empty() { String::new() } else { found.to_string() };
    let judgement = results.ledger.conclusion(&found);
    let interrupted = match results.checked_before_interrupt {
        Some((checked, all)) => format!("interrupted: {checked} of {all} files checked; "),
        None => String::new(),
    };
    let counts = results.ledger.summary();
    let counts = if counts.is_empty() { counts } else { format!("{counts}: ") };
    format!("{interrupted}{counts}{judgement}{}", format_suppressed(results))
}

/// The number of suppressed findings.
fn format_suppressed(results: &CourseResults) -> String {
    let suppressed = &results.suppressed;
    let ignored = Summary::count(&suppressed.ignored);
    let parts = [
        (suppressed.ignored.len(), format!("{ignored} ignored")),
        (
            suppressed.allowed.len(),
            format!("{} suppressed by the lessons", counted(suppressed.allowed.len(), "finding")),
        ),
        (
            suppressed.baselined.len(),
            format!("{} in the baseline", counted(suppressed.baselined.len(), "finding")),
        ),
    ];
    let parts: Vec<String> = parts.into_iter().filter(|(n, _)| *n > 0).map(|(_, text)| text).collect();
    if parts.is_empty() { String::new() } else { format!(" ({})", parts.join(", ")) }
}

/// The findings that lessons suppress, with the reasons.
pub(super) fn format_allowed(results: &CourseResults, sources: &[&SourceFile]) -> String {
    let mut text = String::new();
    for allowed in &results.suppressed.allowed {
        let line = concise(std::slice::from_ref(&allowed.finding), sources);
        let _ = writeln!(text, "{}\n  suppressed: {}", line.trim_end(), printable(&allowed.why));
    }
    if !text.is_empty() {
        text.push('\n');
    }
    text
}
