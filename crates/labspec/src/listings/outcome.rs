//! What the run of a listing means for its lesson: findings, and the state of the claim.

use super::compare::{Difference, DifferenceKind, Differences, clip, compare_lines, trimmed_lines};
use super::pairing::{DisplayedOutput, Listing, displayed_lines};
use super::table::printed_rows;
use super::traceback::{last_line, line_in_file};
use crate::finding::{ClaimId, Finding};
use crate::ledger::{Evidence, State};
use crate::markdown::Block;
use crate::printable::counted;
use crate::rules::{LISTING_FAILS, LISTING_OUTPUT};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The run of a listing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ListingRun {
    /// It ended without an error, and printed this.
    Finished(String),
    /// It ended without an error in two runs, and printed two different outputs.
    Varies(String, String),
    /// It ended with this exit code, and wrote this to the standard error.
    Failed(i32, String),
    /// A limit ended it: how, and what to do.
    Stopped(String, String),
    /// It could not be run: the reason, and what to do.
    NotRun(String, String),
}

/// The word for a listing that prints another output than the lesson displays.
const NOT_AS_DISPLAYED: &str = "not as displayed";

/// What became of the output of a listing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ListingResult {
    /// Its name: `listing #1`.
    pub name: String,
    /// The path of its `file=`, or empty.
    pub file: String,
    /// The bytes of the displayed output.
    pub span: Range<usize>,
    /// The state of the claim.
    pub state: State,
    /// The state in words.
    pub word: &'static str,
    /// The reason why it is not true, or empty.
    pub remark: String,
}

/// Whether the lesson displays this output below the listing.
pub fn is_as_displayed(listing: &Listing<'_>, printed: &str) -> bool {
    compare_output(listing, printed, &mut Vec::new()) == 0
}

/// Compares the run of a listing with the displayed output. Adds the findings.
pub fn check_listing(listing: &Listing<'_>, run: &ListingRun, findings: &mut Vec<Finding>) -> ListingResult {
    let before = findings.len();
    let (state, word, remark) = match run {
        _ if listing.path().is_none() => {
            findings.push(path_finding(listing));
            (State::False, "refused", "its path leaves the folder of the run".to_string())
        }
        ListingRun::NotRun(why, help) => (State::Unchecked, "not run", format!("{why}; {help}")),
        ListingRun::Stopped(why, help) => {
            findings.push(failure(listing, listing.info.clone(), why, help));
            (State::False, "fails", why.clone())
        }
        ListingRun::Failed(code, errors) => {
            let why = failure_reason(*code, errors);
            findings.push(failure_finding(listing, errors, &why));
            (State::False, "fails", why)
        }
        ListingRun::Varies(first, second) => {
            findings.push(variation(listing, first, second));
            (State::False, NOT_AS_DISPLAYED, "it prints another output in each run".to_string())
        }
        ListingRun::Finished(printed) => match compare_output(listing, printed, findings) {
            0 => (State::True(Evidence::Simulated), "as displayed", String::new()),
            n => (State::False, NOT_AS_DISPLAYED, counted(n, "difference")),
        },
    };
    for finding in findings.iter_mut().skip(before) {
        let result = finding.message.clone();
        finding.claim = Some(Box::new(ClaimId { owner: listing.name(), part: String::new(), result }));
    }
    let file = listing.file.unwrap_or("").to_string();
    ListingResult { name: listing.name(), file, span: listing.span(), state, word, remark }
}

/// The finding about two runs with different outputs.
fn variation(listing: &Listing<'_>, first: &str, second: &str) -> Finding {
    let [first_lines, second_lines] = [first, second].map(trimmed_lines);
    let longest = first_lines.len().max(second_lines.len());
    let line = |lines: &[&str], i: usize| clip(lines.get(i).copied().unwrap_or(""));
    let differs = |i: &usize| first_lines.get(*i) != second_lines.get(*i);
    let i = (0..longest).find(differs).unwrap_or(0);
    let [one, other] = [line(&first_lines, i), line(&second_lines, i)];
    let message = format!("the listing prints another output in each run: first `{one}`, then `{other}`");
    Finding::new(LISTING_OUTPUT, listing.span(), message)
        .why("no output that the lesson displays is that of the next run")
        .help("give random numbers a seed, and do not print times, addresses or temporary paths")
}

fn path_finding(listing: &Listing<'_>) -> Finding {
    let path = clip(listing.file.unwrap_or(""));
    let message = format!("`file={path}` leaves the folder in which the listing runs");
    Finding::plain(LISTING_FAILS, listing.info.clone(), message)
        .why("the listing is not run")
        .help("write a relative path without `..`, such as `file=examples/drop.py`")
}

fn failure(listing: &Listing<'_>, span: Range<usize>, why: &str, help: &str) -> Finding {
    let name = listing.file.map_or(String::new(), |file| format!(" {}", clip(file)));
    Finding::new(LISTING_FAILS, span, format!("the listing{name} fails: {why}")).help(help)
}

/// The exception, or the exit code.
fn failure_reason(code: i32, errors: &str) -> String {
    let line = clip(last_line(errors));
    match line.as_str() {
        "" => format!("exit code {code}"),
        line if errors.contains("Traceback (most recent call last)") || line.contains("Error: ") => {
            line.into()
        }
        line => format!("exit code {code}: {line}"),
    }
}

/// The finding about an exception, at the line of the listing that the traceback names.
fn failure_finding(listing: &Listing<'_>, errors: &str, why: &str) -> Finding {
    let line = line_in_file(errors, listing.path().unwrap_or("")).and_then(|line| line_span(listing, line));
    let help = if why.starts_with("ModuleNotFoundError") {
        "add the module to `requirements` or to the `project`, or its file to `files`, under [listings] in labspec.toml"
    } else if why.starts_with("FileNotFoundError") {
        "add the file to `files` under [listings] in labspec.toml"
    } else if why.starts_with("MemoryError") {
        "use less memory, or raise `memory` under [listings] in labspec.toml"
    } else {
        "correct the listing"
    };
    failure(listing, line.unwrap_or_else(|| listing.info.clone()), why, help)
}

/// The bytes in the file of a line of the listing, from 1.
fn line_span(listing: &Listing<'_>, number: usize) -> Option<Range<usize>> {
    let mut lines = listing.code.value.split_inclusive('\n');
    let before: usize = lines.by_ref().take(number.checked_sub(1)?).map(str::len).sum();
    let line = lines.next()?;
    let start = before + line.len() - line.trim_start().len();
    let end = before + line.trim_end().len();
    (start < end).then(|| listing.code.span_of(start..end))
}

/// Adds the findings about an output, and returns the number of differences.
pub(super) fn compare_output(listing: &Listing<'_>, printed: &str, findings: &mut Vec<Finding>) -> usize {
    let lines = trimmed_lines(printed);
    let (differences, fix) = match &listing.output {
        DisplayedOutput::Table(table) => {
            let printed = printed_rows(&lines, table.rows.len());
            (compare_lines(&table.rows, &printed, table.span.end), None)
        }
        DisplayedOutput::Block(block, raw) => {
            let words: Vec<Vec<&str>> = lines.iter().map(|line| line.split_whitespace().collect()).collect();
            let differences = compare_lines(&displayed_lines(&block.body), &words, block.info.end);
            (differences, replacement(block, raw, &lines))
        }
    };
    let Differences { listed, more } = differences;
    let start = findings.len();
    findings.extend(listed.iter().map(difference_finding));
    if more > 0 {
        let differences = if more == 1 { "difference" } else { "differences" };
        let message = format!("the output has {more} more {differences}");
        let place = listing.span();
        findings.push(Finding::new(LISTING_OUTPUT, place.start..place.start, message).help("see the others"));
    }
    if let (Some((span, text)), Some(first)) = (fix, findings.get_mut(start)) {
        *first = first.clone().fix(span, text);
    }
    listed.len() + more
}

fn difference_finding(difference: &Difference) -> Finding {
    let Difference { kind, span, displayed, printed } = difference;
    let (message, help) = match kind {
        DifferenceKind::Changed => {
            let message = format!("the lesson shows `{displayed}`, the listing prints `{printed}`");
            let help = match printed.contains(char::is_control) {
                true => "print without control characters, such as colours".to_string(),
                false => format!("write `{printed}`"),
            };
            (message, help)
        }
        DifferenceKind::MissingWords => {
            (format!("the listing prints `{printed}` here"), format!("add `{printed}`"))
        }
        DifferenceKind::ExtraWords => {
            (format!("the listing does not print `{displayed}` here"), "delete it".into())
        }
        DifferenceKind::ExtraLine => {
            (format!("the listing does not print this line: `{displayed}`"), "delete it".into())
        }
        DifferenceKind::MissingLines(1) => {
            (format!("the listing prints a line after this place: `{printed}`"), format!("add `{printed}`"))
        }
        DifferenceKind::MissingLines(n) => {
            let message = format!("the listing prints {n} lines after this place; the first is `{printed}`");
            (message, "add them".into())
        }
    };
    Finding::new(LISTING_OUTPUT, span.clone(), message).help(help)
}

/// The maximum size of a replacement, in bytes.
const MAX_REPLACEMENT: usize = 64 << 10;

/// The bytes of the displayed output, and the printed one. `None` if the block has prefixes on its lines (a quote, a list), or
/// could not contain the output.
fn replacement(block: &Block, raw: &str, printed: &[&str]) -> Option<(Range<usize>, String)> {
    let body = &block.body;
    let is_harmless = |line: &&str| {
        let is_fence = line.trim_start().starts_with("```") || line.trim_start().starts_with("~~~");
        !is_fence && line.chars().all(|c| c == '\t' || !c.is_control())
    };
    let size: usize = printed.iter().map(|line| line.len() + 2).sum();
    let is_plain = !raw.is_empty() && raw.replace("\r\n", "\n") == body.value.replace("\r\n", "\n");
    if !is_plain || size > MAX_REPLACEMENT || !printed.iter().all(is_harmless) {
        return None;
    }
    let end = if raw.contains("\r\n") { "\r\n" } else { "\n" };
    let last = if raw.ends_with('\n') { end } else { "" };
    Some((body.span(), format!("{}{last}", printed.join(end))))
}
