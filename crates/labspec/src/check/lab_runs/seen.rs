//! What the traces and readouts of a lab show in its runs: numbers, or what no student can read.
//!
//! A gap may be meant: a text that says `NaN` itself, or reads a variable that nothing has stored yet, is silent until it
//! is certain that no run ever fills the gap.

use super::super::PreparedLab;
use crate::bind::Bound;
use crate::finding::Finding;
use crate::rules::{self, Rule};
use crate::run::{Cell, Session, Trouble};
use crate::source::Text;
use labspec_expr::Value;
use std::collections::BTreeSet;

/// What a trace or readout shows that is no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum DisplayKind {
    Nan,
    Infinite,
    Text,
}

/// A trace or a readout through all runs.
struct WatchedDisplay<'a> {
    bound: &'a Bound,
    /// Its place in a row of samples.
    column: usize,
    name: String,
    trace: bool,
    /// The text itself says that there may be gaps.
    says_gap: bool,
    says_infinite: bool,
    /// Whether it was a number, a text or a truth value in any run.
    ever: bool,
    /// A gap that may be meant: the time and the setting of the first.
    gap: Option<(f64, String)>,
    reported: BTreeSet<DisplayKind>,
}

/// All that a lab shows.
pub(super) struct Seen<'a> {
    displays: Vec<WatchedDisplay<'a>>,
    /// Traces and readouts.
    width: usize,
    /// Slots of `ctx` to which some text stores `NaN` on purpose.
    gaps: BTreeSet<u32>,
    found: Vec<Finding>,
    /// What threw before.
    troubles: Vec<(&'static Rule, Text, std::ops::Range<usize>)>,
}

/// Whether a word stands in a text.
fn says(text: &str, word: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
    text.match_indices(word).any(|(at, _)| {
        let before = text.get(..at).and_then(|t| t.chars().next_back());
        let after = text.get(at + word.len()..).and_then(|t| t.chars().next());
        !before.is_some_and(part) && !after.is_some_and(part)
    })
}

/// Whether a text says itself that there may be a gap; to ask whether something is `null` says nothing of what is shown.
fn says_gap(text: &str) -> bool {
    let mut asked = text.to_string();
    for how in ["=== ", "!== ", "== ", "!= ", "===", "!==", "==", "!="] {
        for word in ["null", "undefined"] {
            asked = asked.replace(&format!("{how}{word}"), "");
        }
    }
    ["NaN", "null", "undefined"].iter().any(|word| says(&asked, word))
}

impl<'a> Seen<'a> {
    /// Nothing was seen yet.
    pub(super) fn new(ready: &'a PreparedLab<'a>) -> Seen<'a> {
        let programs = &ready.programs;
        let displays = programs.probes.iter().enumerate().filter_map(|(i, p)| {
            let bound = p.bound.as_ref()?;
            let (kind, label) = p.name.split_once('/').unwrap_or(("", &p.name));
            let trace = kind == "plot";
            // `plot/0/label`
            let label = if trace { label.split_once('/').map_or(label, |(_, l)| l) } else { label };
            let text = &bound.text.value;
            Some(WatchedDisplay {
                bound,
                column: i + 1,
                name: format!("the {} \"{label}\"", if trace { "trace" } else { "readout" }),
                trace,
                says_gap: says_gap(text),
                says_infinite: says(text, "Infinity"),
                ever: false,
                gap: None,
                reported: BTreeSet::new(),
            })
        });
        let on_purpose = programs.bound().filter(|b| says_gap(&b.text.value));
        let gaps = on_purpose.flat_map(|b| b.program.effects().ctx_writes.iter().copied()).collect();
        Seen {
            displays: displays.collect(),
            width: programs.probes.len(),
            gaps,
            found: Vec::new(),
            troubles: Vec::new(),
        }
    }

    /// Looks at everything that is shown now. Returns the time, and what is shown.
    pub(super) fn observe(&mut self, session: &mut Session<'_>, done: &str) -> Vec<Cell> {
        let mut row = Vec::with_capacity(self.width + 1);
        row.push(Cell::Number(session.world.data.time()));
        row.resize(self.width + 1, Cell::Nothing);
        for display in &mut self.displays {
            let value = session.evaluate(&display.bound.program, &display.bound.text);
            if session.ended().is_some_and(|e| matches!(e, crate::run::End::Budget { .. })) {
                return row;
            }
            // What threw is a finding of its own.
            let Some(value) = value else { continue };
            if let Some(cell) = row.get_mut(display.column) {
                *cell = Cell::from(value.clone());
            }
            let kind = match &value {
                Value::Number(x) if x.is_nan() => DisplayKind::Nan,
                Value::Number(x) if x.is_infinite() && !display.says_infinite => DisplayKind::Infinite,
                Value::Undefined | Value::Null => DisplayKind::Nan,
                Value::String(_) if display.trace => DisplayKind::Text,
                _ => {
                    display.ever = true;
                    continue;
                }
            };
            let time = session.world.data.time();
            if kind == DisplayKind::Nan && (display.says_gap || unset(display.bound, session, &self.gaps)) {
                // A gap that is said may be filled by what no run does, unless it is all that the text says.
                if !display.says_gap || display.bound.program.effects().constant() {
                    display.gap.get_or_insert_with(|| (time, done.to_owned()));
                }
            } else if display.reported.insert(kind) {
                self.found.push(display.finding(kind, &value, time, done));
            }
        }
        row
    }

    /// The findings since the last time.
    pub(super) fn take(&mut self) -> Vec<Finding> {
        std::mem::take(&mut self.found)
    }

    /// When all runs are made: what was never anything but a gap.
    pub(super) fn never(&mut self, all: bool) -> Vec<Finding> {
        let empty = self.displays.iter().filter(|s| all && !s.ever && s.reported.is_empty());
        let gap_finding = |s: &WatchedDisplay<'_>| {
            s.gap.as_ref().map(|_| {
                Finding::warning(
                    rules::SHOWS_NAN,
                    s.bound.text.span(),
                    format!("{} shows nan in every run", s.name),
                )
                .why("a student sees nan, or no curve at all, at every setting")
                .help(match s.says_gap {
                    true => "write an expression to display: this one is only a gap",
                    false => "store the variable that it reads: nothing ever does",
                })
            })
        };
        empty.filter_map(gap_finding).collect()
    }

    /// Whether a program has not thrown like this in a run before.
    pub(super) fn is_new(&mut self, t: &Trouble) -> bool {
        let is_reported = |(code, text, span): &(&'static Rule, Text, std::ops::Range<usize>)| {
            *code == t.rule && *text == t.text && *span == t.span
        };
        let new = !self.troubles.iter().any(is_reported);
        if new {
            self.troubles.push((t.rule, t.text.clone(), t.span.clone()));
        }
        new
    }
}

/// Whether a text reads a variable that holds nothing yet, or NaN because some text stored that on purpose.
fn unset(bound: &Bound, session: &Session<'_>, gaps: &BTreeSet<u32>) -> bool {
    let effects = bound.program.effects();
    let empty = |slot: &u32| match session.context.get(*slot) {
        Value::Undefined | Value::Null => true,
        Value::Number(x) => x.is_nan() && gaps.contains(slot),
        // Lists and records may have gaps of their own.
        Value::List(_) | Value::Record(_) => true,
        _ => false,
    };
    effects.any_ctx || effects.calls_values || effects.ctx_reads.iter().any(empty)
}

impl WatchedDisplay<'_> {
    fn finding(&self, kind: DisplayKind, value: &Value, time: f64, done: &str) -> Finding {
        let (name, at) = (&self.name, format!("{done}, at t = {} s", crate::run::time(time)));
        let [sees, what] = if self.trace {
            ["the curve has a gap there, and nothing explains it", "trace"]
        } else {
            ["a student cannot tell whether the lab or the physics is broken", "readout"]
        };
        let (rule, message, why, help) = match kind {
            DisplayKind::Nan => (
                rules::SHOWS_NAN,
                format!("{name} shows nan ({at})"),
                sees,
                format!(
                    "guard it with a condition, or write `NaN` for an intended gap, as `data.ncon > 0 ? … : NaN` in this {what}: 0 / 0, the root of a negative number or a missing element gives nan"
                ),
            ),
            DisplayKind::Infinite => (
                rules::SHOWS_INFINITE,
                format!("{name} shows {} ({at})", if value.to_number() > 0.0 { "inf" } else { "-inf" }),
                sees,
                "guard the division by 0 with a condition, or write `NaN` for an intended gap".to_owned(),
            ),
            DisplayKind::Text => (
                rules::TEXT_IN_PLOT,
                format!("{name} is a string, \"{}\" ({at})", shortened(value)),
                "a plot draws numbers: the curve is missing, or shows what the page makes of the string",
                "remove what makes it a string, such as `.toFixed(…)`, or display it as a readout".to_owned(),
            ),
        };
        Finding::warning(rule, self.bound.text.span(), message).why(why).help(help)
    }
}

/// The first words of a text.
fn shortened(value: &Value) -> String {
    let text = value.to_string();
    let short: String = text.chars().take(30).collect();
    if short.len() < text.len() { format!("{short}…") } else { short }
}
