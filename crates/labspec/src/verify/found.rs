//! The value of an expression over what the runs gave, and what it rests on: whether it is a simulation's, whether it could have come
//! out otherwise, and how far a condition is from the opposite.

use super::bound::BoundVerify;
use super::bound_run::CompiledText;
use super::claim::reads_outside_run;
use super::compiled_claim::{ClaimInputs, CompiledClaim, TracedValue};
use super::condition::{self, ConditionMargin};
use super::evidence::{self, Outlook};
use super::format::{shorten, significant};
use super::layout::Slot;
use super::outcome::Outcome;
use super::value_kind::{ValueKind, kinds_of};
use crate::bind::to_finding;
use crate::finding::Finding;
use crate::ledger::Evidence;
use crate::rules;
use crate::source::Text;
use labspec_expr::{RuntimeError, Value};
use std::rc::Rc;

/// The value of an expression over the measures, and what it rests on.
#[derive(Clone, Debug)]
pub(super) struct MeasuredValue {
    pub(super) value: Value,
    /// Whether a simulation says it.
    pub(super) evidence: Evidence,
    /// The text names a number of a run and never comes to it, as in `true || m > 3`.
    pub(super) unread: bool,
    /// A run that it rests on broke: its name and how, unless the expression reads the warnings of that run.
    pub(super) broke: Option<String>,
    /// The part of the text in which a NaN decided, and why there is one; the value is NaN then.
    pub(super) undecided: Option<Undecided>,
    /// How it was evaluated; `None` where somebody else did it.
    trace: Option<Rc<Evaluated>>,
}

/// An expression that nothing decides.
#[derive(Clone, Debug)]
pub(super) struct Undecided {
    pub(super) part: String,
    /// What has no number, and why.
    pub(super) because: Option<String>,
}

/// A claim, the numbers that it was evaluated with, and what came of it.
#[derive(Debug)]
struct Evaluated {
    claim: Rc<CompiledClaim>,
    inputs: ClaimInputs,
    traced: TracedValue,
}

impl BoundVerify<'_> {
    /// The value of an expression over the outcome. What is wrong with it goes to `findings`.
    pub(super) fn find(
        &self,
        outcome: &Outcome,
        text: &Text,
        findings: &mut Vec<Finding>,
    ) -> Option<MeasuredValue> {
        let claim = self.claim(text)?;
        findings.extend(claim.diagnostics.iter().map(|d| to_finding(d, text)));
        let program = claim.program.as_ref()?;
        if claim.outside {
            findings.push(reads_outside_run(text));
            return None;
        }
        let mut broke = self.broken(&claim, outcome);
        let measured = claim.measured(self);
        let nothing_read = claim.reads.is_empty() && program.aggregates().is_empty();
        let evidence = if measured.is_empty() { Evidence::Computed } else { Evidence::Simulated };
        let mut parts = Vec::new();
        let mut doubt = None;
        if !program.aggregates().is_empty() {
            let [run] = self.runs.as_slice() else { return None };
            if let Some(x) = outcome.measured_elsewhere(&text.value) {
                return Some(MeasuredValue {
                    value: Value::Number(x),
                    evidence,
                    unread: nothing_read && claim.names.numbers,
                    broke,
                    undecided: None,
                    trace: None,
                });
            }
            // Measured on the spot, as a lesson with one run may write it: the same run once more.
            let named = CompiledText { text, program: program.clone() };
            let made = self.perform(run, outcome.numerics, &[&named], findings)?;
            let expected = run.spec.is_some_and(|r| r.breaks);
            let how = made.broke.filter(|_| !expected);
            broke = broke.or(how.map(|how| format!("the run breaks: {how}")));
            if let Some(sampled) = made.values.into_iter().next() {
                (parts, doubt) = (sampled.parts, sampled.doubt);
            }
        }
        let inputs = claim.inputs(self, outcome, parts);
        let traced = match claim.evaluate(self, &inputs, None)? {
            Ok(traced) => traced,
            Err(error) => {
                findings.push(threw(text, &error));
                return None;
            }
        };
        let undecided = traced.lost.map(|span| Undecided {
            part: text.value.get(span.start..span.end).unwrap_or(&text.value).to_string(),
            because: doubt.map(|d| d.to_string()).or_else(|| self.missing(&claim, outcome, &inputs)),
        });
        let value = if undecided.is_some() { Value::Number(f64::NAN) } else { traced.value.clone() };
        // The length of a sweep is no number that a run gives; a condition on it says nothing about one.
        let is_condition = matches!(value, Value::Boolean(_));
        let unread = nothing_read && (claim.names.numbers || claim.names.lists && is_condition);
        let trace = Some(Rc::new(Evaluated { claim, inputs, traced }));
        Some(MeasuredValue { value, evidence, unread, broke, undecided, trace })
    }

    /// How a run broke that a claim rests on, unless it reads the warnings of that run.
    fn broken(&self, claim: &CompiledClaim, outcome: &Outcome) -> Option<String> {
        let slots = || claim.reads.iter().filter_map(|place| self.layout().slots.get(*place));
        let excused = |place: usize| slots().any(|slot| *slot == Slot::Warnings(place));
        slots().find_map(|slot| {
            let Slot::Measure(place, _) = *slot else { return None };
            let run = outcome.runs.get(place)?;
            let (_, expected) = self.run_place(place);
            let name = crate::json::read::named(&run.title());
            match &run.broke {
                Some(how) if !(expected || excused(place)) => Some(format!("the run {name} breaks: {how}")),
                None if expected => Some(format!("the run {name} is expected to break, but it does not")),
                _ => None,
            }
        })
    }

    /// The first number that a claim reads and that there is not, with the reason.
    fn missing(&self, claim: &CompiledClaim, outcome: &Outcome, inputs: &ClaimInputs) -> Option<String> {
        let nothing = |place: &&usize| inputs.numbers.get(**place).is_some_and(|x| x.is_nan());
        let place = claim.reads.iter().find(nothing)?;
        match self.layout().slots.get(*place)? {
            Slot::Measure(run, measure) => {
                let run = outcome.runs.get(*run)?;
                let (name, _) = run.measures.get(*measure)?;
                let title = format!("{}.{name}", run.title());
                Some(match run.doubts.iter().find(|(doubted, _)| doubted == name) {
                    Some((_, doubt)) => format!("`{title}` has no value: {doubt}"),
                    None => format!("`{title}` has no value: its event does not happen in the run"),
                })
            }
            Slot::Found(i) => outcome.found.get(*i).map(|(name, _)| format!("`{name}` was not found")),
            _ => None,
        }
    }

    /// Whether a claim could have come out otherwise, had the runs given something else. `says` tells what the claim says with a
    /// value; the truth of a condition, or a number, where it is `None`.
    pub(super) fn could_differ(&self, found: &MeasuredValue, says: Option<&dyn Fn(&Value) -> bool>) -> bool {
        // What somebody else evaluated was evaluated here, too.
        let Some(evaluated) = &found.trace else { return true };
        let Evaluated { claim, inputs, .. } = &**evaluated;
        let (places, kinds) = self.places(claim, inputs);
        // A formula reads nothing of a run.
        if places.is_empty() {
            return true;
        }
        let outlook = |inputs: &ClaimInputs| {
            let traced = claim.evaluate(self, inputs, None)?.ok().filter(|t| t.lost.is_none())?;
            // A number that is not there is no other number.
            if matches!(traced.value, Value::Number(x) if x.is_nan()) {
                return None;
            }
            let look = match (says, &traced.value) {
                (Some(says), value) => Outlook::Holds(says(value)),
                (None, Value::Boolean(holds)) => Outlook::Holds(*holds),
                (None, value) => Outlook::Number(value.to_number()),
            };
            Some((look, traced.comparisons))
        };
        if !evidence::could_differ(inputs, &places, &kinds, &claim.constants, &mut |inputs| outlook(inputs)) {
            return false;
        }
        // What does not hold may be rare, and is looked for with each number alone.
        match outlook(inputs) {
            Some((now, _)) if now != Outlook::Holds(false) => {
                self.differs_somewhere(claim, inputs, now, &mut |inputs| Some(outlook(inputs)?.0))
            }
            _ => true,
        }
    }

    /// Whether the value of a text says that something holds or not, as options, words and searches need it; a finding where not.
    pub(super) fn is_condition(
        &self,
        found: &MeasuredValue,
        text: &Text,
        findings: &mut Vec<Finding>,
    ) -> bool {
        let is = self.is_truth(found);
        if !is {
            findings.push(no_condition(text, &found.value));
        }
        is
    }

    /// A truth value, or a number that is 0 or 1 whatever the runs give, as that of `holds(…)`: a count that happens to be 1 is none.
    fn is_truth(&self, found: &MeasuredValue) -> bool {
        let truth = |x: f64| x == 0.0 || x == 1.0;
        let Value::Number(x) = found.value else { return matches!(found.value, Value::Boolean(_)) };
        // What somebody else evaluated was tried here, too.
        let Some(evaluated) = found.trace.as_ref().filter(|_| truth(x)) else { return truth(x) };
        let Evaluated { claim, inputs, .. } = &**evaluated;
        let (places, kinds) = self.places(claim, inputs);
        let decided = |inputs| claim.evaluate(self, &inputs, None)?.ok().filter(|t| t.lost.is_none());
        let mut values = evidence::draws(inputs, &places, &kinds).filter_map(decided).peekable();
        !places.is_empty()
            && values.peek().is_some()
            && values.all(|t| matches!(t.value, Value::Boolean(_)) || truth(t.value.to_number()))
    }

    /// The places of what a claim measures, or else of what it reads of a run at all, and of which kind each is.
    fn places(&self, claim: &CompiledClaim, inputs: &ClaimInputs) -> (Vec<usize>, Vec<ValueKind>) {
        let mut places = claim.measured(self);
        let simulated = !places.is_empty();
        if !simulated {
            let of_run = |place: &usize| matches!(self.layout().slots.get(*place), Some(Slot::Measure(..)));
            places.extend(claim.reads.iter().copied().filter(of_run));
        }
        let parts = claim
            .program
            .as_ref()
            .map(|program| self.idle(|session| kinds_of(program, &session.world, &session.context)));
        let parts = parts.flatten().unwrap_or_default();
        let count = inputs.numbers.len();
        // What is not simulated has the one value that it has, which tells nothing of its kind.
        let kind = |place: &usize| match place.checked_sub(count) {
            _ if !simulated => ValueKind::ANY,
            None => self.kinds().get(*place).copied().unwrap_or(ValueKind::ANY),
            Some(part) => parts.get(part).copied().unwrap_or(ValueKind::ANY),
        };
        let kinds = places.iter().map(kind).collect();
        (places, kinds)
    }

    /// How a condition came out, and how far it is from the opposite.
    pub(super) fn evaluate_margin(&self, found: &MeasuredValue) -> ConditionMargin {
        let holds = found.value.truthy();
        let without_number = found.undecided.as_ref().map(|u| u.part.clone());
        let Some(evaluated) = found.trace.as_ref().filter(|_| without_number.is_none()) else {
            return ConditionMargin { holds, margin: None, without_number };
        };
        let Evaluated { claim, inputs, traced } = &**evaluated;
        let measured = claim.measured(self);
        // Comparisons that stay as they are when what was measured moves decide nothing about it: those of a loop.
        let moved = {
            let mut moved = inputs.clone();
            for (k, place) in measured.iter().enumerate() {
                // Each by another part of itself, so that no ratio stays.
                let part = 1e-7 * (1.0 + 0.618 * k as f64);
                if let Some(x) = inputs.at(*place) {
                    moved.put(*place, x + part * x.abs().max(1e-6));
                }
            }
            claim.evaluate(self, &moved, None).and_then(Result::ok)
        };
        let moved = moved.filter(|m| m.comparisons.len() == traced.comparisons.len());
        let decides = |i: usize| {
            let pair = moved.as_ref().and_then(|m| m.comparisons.get(i)).zip(traced.comparisons.get(i));
            measured.is_empty() || pair.is_none_or(|(a, b)| a.left != b.left || a.right != b.right)
        };
        let mut turn = |i: usize| {
            let turned = claim.evaluate(self, inputs, Some(i))?.ok()?;
            Some(turned.value.truthy())
        };
        condition::evaluate(holds, &traced.comparisons, &decides, &mut turn)
    }

    /// Those of the texts that look at the samples of the only run themselves.
    pub(super) fn on_the_spot<'t>(&self, texts: impl Iterator<Item = &'t Text>) -> Vec<&'t Text> {
        let looks = |text: &&Text| {
            let claim = self.claim(text);
            claim.is_some_and(|c| c.program.as_ref().is_some_and(|p| !p.aggregates().is_empty()))
        };
        if self.runs.len() == 1 { texts.filter(looks).collect() } else { Vec::new() }
    }
}

/// What an expression throws.
fn threw(text: &Text, error: &RuntimeError) -> Finding {
    Finding::error(error.rule, text.span_of(error.span.start..error.span.end), error.message.clone())
        .why("the claim cannot be checked: this expression has no value")
        .help("correct the expression, or guard it with a condition")
}

/// A number or a text where a condition belongs.
fn no_condition(text: &Text, value: &Value) -> Finding {
    let what = match value {
        Value::Number(x) => format!("the number {}", significant(*x)),
        Value::String(_) => "a text".to_string(),
        other => format!("`{other}`"),
    };
    let message = format!("`{}` gives {what}, but a condition is needed", shorten(text.value.trim()));
    Finding::error(rules::CONSTANT_CLAIM, text.span(), message)
        .why("every number but 0 counts as true, so the claim would hold whatever the number is")
        .help("compare it: `lands < 0.5`, `abs(speed - 2.4) < 0.1`")
}
