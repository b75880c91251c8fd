//! Findings in the formats of other programs: compiler output, GitHub, GitLab, JUnit.

use super::machine::FindingRow;
use super::uri::slashed;
use super::{Summary, file_of, to_value};
use crate::finding::{Applicability, Finding, Severity};
use crate::ledger::{Entry, Ledger, State};
use crate::printable::{printable, printable_json, printable_line, printable_lines};
use crate::rules;
use crate::source::SourceFile;
use serde::Serialize;
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::Range;

/// Line and column of the beginning and the end of a finding, from 1; all 1 where its file is not available.
fn place(f: &Finding, files: &[&SourceFile]) -> [usize; 4] {
    place_of(&f.path, &f.span, files).unwrap_or([1; 4])
}

/// Line and column of the beginning and the end of a range of bytes of a file, from 1; `None` where the file is not
/// available.
pub(super) fn place_of(path: &str, span: &Range<usize>, files: &[&SourceFile]) -> Option<[usize; 4]> {
    let file = file_of(files, path)?;
    let span = file.snap(span);
    let (from, to) = (file.position(span.start), file.position(span.end));
    Some([from.line, from.column, to.line, to.column])
}

/// A line for each finding: `file:line:column: severity[code]: message`.
pub fn concise<'f>(findings: impl IntoIterator<Item = &'f Finding>, files: &[&SourceFile]) -> String {
    let mut text = String::new();
    for f in findings {
        let [line, column, ..] = place(f, files);
        let _ = writeln!(
            text,
            "{}:{line}:{column}: {}[{}]: {}",
            printable_line(&f.path),
            f.severity,
            f.code,
            printable_line(&f.message)
        );
    }
    text
}

/// One line with a JSON object for each finding, as in `json`, and a last line with the summary.
pub fn jsonl(findings: &[Finding], files: &[&SourceFile]) -> String {
    let mut text = String::new();
    for f in findings {
        let _ = writeln!(text, "{}", to_value(&FindingRow::new(f, files)));
    }
    let _ = writeln!(text, "{}", to_value(&BTreeMap::from([("summary", Summary::count(findings))])));
    printable_json(&text).into_owned()
}

/// Commands of GitHub workflows, which annotate the files with findings.
pub fn github(findings: &[Finding], files: &[&SourceFile]) -> String {
    let mut text = String::new();
    for f in findings {
        let [line, column, last, end] = place(f, files);
        let word = match f.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "notice",
        };
        let help = f.help.as_ref().map_or(String::new(), |help| format!("\n{help}"));
        // The end column is allowed only if the end is on the same line.
        let columns = if last == line { format!(",col={column},endColumn={end}") } else { String::new() };
        let _ = writeln!(
            text,
            "::{word} file={},line={line},endLine={last}{columns},title={}::{}",
            property(&slashed(&f.path)),
            property(&format!("labspec {}", f.code)),
            data(&format!("{}{help}", f.message))
        );
    }
    text
}

/// Escapes the characters that end a GitHub command. Control characters of terminals are written as escapes, because logs
/// are read in terminals.
fn data(text: &str) -> String {
    printable_lines(text).replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

/// A code quality report of GitLab.
pub fn gitlab(findings: &[Finding], files: &[&SourceFile]) -> Value {
    #[derive(Serialize)]
    struct Issue<'a> {
        description: &'a str,
        check_name: &'a str,
        fingerprint: String,
        severity: &'a str,
        location: Location<'a>,
    }
    #[derive(Serialize)]
    struct Location<'a> {
        path: Cow<'a, str>,
        lines: Lines,
    }
    #[derive(Serialize)]
    struct Lines {
        begin: usize,
        end: usize,
    }
    let mut seen = BTreeMap::new();
    let issues = findings.iter().map(|f| {
        let [begin, _, end, _] = place(f, files);
        Issue {
            description: &f.message,
            check_name: f.code,
            fingerprint: fingerprint(f, &mut seen),
            severity: match f.severity {
                Severity::Error => "major",
                Severity::Warning => "minor",
                Severity::Note => "info",
            },
            location: Location { path: slashed(&f.path), lines: Lines { begin, end } },
        }
    });
    to_value(&issues.collect::<Vec<_>>())
}

/// The identity of a finding, which does not depend on line numbers: its file, code and message, and the number of equal
/// findings before it.
pub(super) fn fingerprint(f: &Finding, seen: &mut BTreeMap<String, usize>) -> String {
    let what = format!("{}\n{}\n{}", f.path, f.code, f.message);
    let before = seen.entry(what.clone()).or_default();
    *before += 1;
    fnv(&format!("{what}\n{before}"))
}

/// The Fowler–Noll–Vo hash, twice 64 bits: an identifier, not for security.
fn fnv(text: &str) -> String {
    let hash =
        |start: u64| text.bytes().fold(start, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3));
    format!("{:016x}{:016x}", hash(0xcbf2_9ce4_8422_2325), hash(0x9e37_79b9_7f4a_7c15))
}

/// A JUnit report: a suite for each file, a case for each claim of the ledger. Findings of the file itself fail a separate
/// case.
pub fn junit(ledger: &Ledger, findings: &[Finding], files: &[&SourceFile]) -> String {
    let mut by_file: BTreeMap<&str, Vec<&Entry>> = BTreeMap::new();
    for entry in ledger.entries() {
        by_file.entry(&entry.path).or_default().push(entry);
    }
    let mut found: BTreeMap<&str, Vec<&Finding>> = BTreeMap::new();
    for f in findings {
        found.entry(&f.path).or_default().push(f);
    }
    let counts = |all: &[&Entry]| {
        let n = |tag: &str| all.iter().filter(|e| outcome_tag(e.state) == tag).count();
        let numbers =
            format!("tests=\"{}\" failures=\"{}\" errors=\"{}\"", all.len(), n("failure"), n("error"));
        (numbers, n("skipped"))
    };
    let all: Vec<&Entry> = ledger.entries().iter().collect();
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    // The schema of Jenkins does not allow `skipped` here.
    let _ = writeln!(text, "<testsuites name=\"labspec\" {}>", counts(&all).0);
    for (path, entries) in by_file {
        let (numbers, skipped) = counts(&entries);
        let _ = writeln!(text, "  <testsuite name=\"{}\" {numbers} skipped=\"{skipped}\">", attribute(path));
        for e in entries {
            let what = if e.what.is_empty() { String::new() } else { format!(" \"{}\"", e.what) };
            let name = format!("{}: {}{what}", e.subject.as_str(), e.owner);
            let _ =
                write!(text, "    <testcase classname=\"{}\" name=\"{}\"", attribute(path), attribute(&name));
            let remark = if e.remark.is_empty() { String::new() } else { format!(": {}", e.remark) };
            let message = attribute(&format!("{}{remark}", e.word));
            // The case lists the findings within its span; a case of the whole file lists all.
            let inside = |f: &&Finding| {
                e.span.is_empty() || (e.span.start <= f.span.start && f.span.end <= e.span.end)
            };
            let _ = match outcome_tag(e.state) {
                "" => writeln!(text, "/>"),
                "skipped" => writeln!(text, ">\n      <skipped message=\"{message}\"/>\n    </testcase>"),
                tag => {
                    let about = found.get(path).into_iter().flatten().copied().filter(inside);
                    let more = xml(&concise(about, files));
                    writeln!(text, ">\n      <{tag} message=\"{message}\">{more}</{tag}>\n    </testcase>")
                }
            };
        }
        text.push_str("  </testsuite>\n");
    }
    text.push_str("</testsuites>\n");
    text
}

/// The element for the state of a case; empty where the claim is true.
fn outcome_tag(state: State) -> &'static str {
    match state {
        State::False => "failure",
        State::Unchecked => "error",
        State::Skipped | State::NotClaimed | State::Baselined => "skipped",
        State::True(_) => "",
    }
}

/// An XML attribute, on one line.
fn attribute(text: &str) -> String {
    xml(&printable(text))
}

/// XML text without characters that XML does not allow. Control characters of terminals are written as escapes.
fn xml(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in printable_lines(text).chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(c),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// Number of violations of each rule, the most frequent first.
pub fn statistics(findings: &[Finding]) -> String {
    let mut counts: BTreeMap<(&str, Severity), [usize; 2]> = BTreeMap::new();
    for f in findings {
        let count = counts.entry((f.code, f.severity)).or_default();
        count[0] += 1;
        let fixable = f.fix.as_ref().is_some_and(|fix| fix.applicability != Applicability::Display);
        count[1] += usize::from(fixable);
    }
    let mut rows: Vec<_> = counts.into_iter().collect();
    rows.sort_by(|a, b| b.1[0].cmp(&a.1[0]).then(a.0.cmp(&b.0)));
    let mut text = String::new();
    for ((code, severity), [count, fixable]) in rows {
        let fix = if fixable > 0 { format!(", {fixable} with a fix") } else { String::new() };
        let summary = rules::find(code).map_or("", |rule| rule.summary);
        let _ = writeln!(text, "{count:>6}  {:<8} {code}: {}{fix}", severity.as_str(), printable(summary));
    }
    let _ = writeln!(text, "{:>6}  {}", findings.len(), Summary::count(findings));
    text
}
