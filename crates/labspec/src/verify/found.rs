//! The value of an expression over the results of the runs, and the evidence for it: whether it comes from a simulation,
//! whether it could be different, and the margin of a condition.

use super::bound::BoundVerify;
use super::bound_run::CompiledText;
use super::claim::reads_outside_run;
use super::compiled_claim::{ClaimInputs, CompiledClaim, TracedValue};
use super::condition::{self, ConditionMargin};
use super::evidence::{self, ClaimValue};
use super::format::{shorten, significant};
use super::layout::Slot;
use super::measure::NoValue;
use super::outcome::MeasuredRuns;
use super::value_kind::{ValueKind, kinds_of};
use crate::bind::to_finding;
use crate::finding::Finding;
use crate::ledger::Evidence;
use crate::rules;
use crate::source::Text;
use crate::spec::BreakExpectation;
use labspec_expr::{RuntimeError, Value};
use std::borrow::Cow;
use std::rc::Rc;

/// The value of an expression over the measures, and the evidence for it.
#[derive(Clone, Debug)]
pub(super) struct MeasuredValue {
    pub(super) value: Value,
    /// Whether the value depends on a simulation.
    pub(super) evidence: Evidence,
    /// Whether the text names a number of a run but never evaluates it, as in `true || m > 3`.
    pub(super) unread: bool,
    /// The name of a run that the expression reads and that broke, and how it broke. `None` if the expression reads the
    /// warnings of that run.
    pub(super) broke: Option<String>,
    /// The part of the text that was decided by a NaN, and the reason for the NaN. The value is NaN in this case.
    pub(super) undecided: Option<Undecided>,
    /// The evaluation; `None` where the value was recorded by another engine.
    trace: Option<Rc<Evaluated>>,
}

impl MeasuredValue {
    /// The compiled text; `None` where the value was recorded by another engine.
    pub(super) fn claim(&self) -> Option<&CompiledClaim> {
        self.trace.as_ref().map(|evaluated| &*evaluated.claim)
    }
}

/// An expression that is undecided because of a NaN.
#[derive(Clone, Debug)]
pub(super) struct Undecided {
    /// The comparison that the NaN decided; `None` for an expression that is itself NaN.
    pub(super) part: Option<String>,
    pub(super) cause: Option<Cause>,
}

impl Undecided {
    /// The part of the text without a value.
    pub(super) fn part_of(&self, text: &Text) -> String {
        self.part.clone().unwrap_or_else(|| text.value.trim().to_string())
    }
}

/// Where a NaN comes from.
#[derive(Clone, Debug)]
pub(super) enum Cause {
    /// A measure of a run, by their indexes, or the aggregates of the text itself in its only run.
    Measure { run: usize, measure: Option<usize>, no_value: Option<NoValue> },
    /// A search without a result, by its name.
    Search(String),
    /// A list of a sweep over several quantities without the list of values that belongs to it.
    SeveralAxes,
}

/// A claim, the inputs of its evaluation, and the result.
#[derive(Debug)]
struct Evaluated {
    claim: Rc<CompiledClaim>,
    inputs: ClaimInputs,
    traced: TracedValue,
}

/// The inputs with the repeated numbers in their places.
fn with_repeated<'i>(inputs: &'i ClaimInputs, repeated: &[(usize, usize)]) -> Cow<'i, ClaimInputs> {
    let mut inputs = Cow::Borrowed(inputs);
    for (place, original) in repeated {
        if let Some(x) = inputs.at(*original) {
            inputs.to_mut().set_value(*place, x);
        }
    }
    inputs
}

impl BoundVerify<'_> {
    /// The value of an expression over the outcome. Errors are added to `findings`.
    pub(super) fn find(
        &self,
        outcome: &MeasuredRuns,
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
        let mut no_value = None;
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
            // The text contains aggregates, which is allowed in a lesson with one run: repeat the run to evaluate them.
            let named = CompiledText { text: Cow::Borrowed(text), program: program.clone() };
            let made = self.execute_run(run, outcome.numerics, &[&named], findings)?;
            let expect = run.spec.map_or(BreakExpectation::None, |r| r.expect);
            let how = made.broke.filter(|_| expect.forbids());
            broke = broke.or(how.map(|how| format!("the run breaks: {how}")));
            if let Some(sampled) = made.values.into_iter().next() {
                (parts, no_value) = (sampled.parts, sampled.no_value);
            }
        }
        let inputs = claim.inputs(self, outcome, parts);
        let traced = match claim.evaluate(self, &inputs, None)? {
            Ok(traced) => traced,
            Err(error) => {
                findings.push(error_finding(text, &error));
                return None;
            }
        };
        let cause = match no_value {
            Some(no_value) => Some(Cause::Measure { run: 0, measure: None, no_value: Some(no_value) }),
            None => self.missing(&claim, outcome, &inputs).or_else(|| self.reads_grid(&claim)),
        };
        let part =
            traced.lost.map(|span| text.value.get(span.start..span.end).unwrap_or(&text.value).to_string());
        let is_nan = matches!(traced.value, Value::Number(x) if x.is_nan());
        let cause = cause.filter(|cause| part.is_none() || !matches!(cause, Cause::SeveralAxes));
        let undecided = (part.is_some() || is_nan && cause.is_some()).then_some(Undecided { part, cause });
        let value = if undecided.is_some() { Value::Number(f64::NAN) } else { traced.value.clone() };
        // The length of a sweep is not a result of a run, so a condition on it is not evidence.
        let is_condition = matches!(value, Value::Boolean(_));
        let unread = nothing_read && (claim.names.numbers || claim.names.lists && is_condition);
        let trace = Some(Rc::new(Evaluated { claim, inputs, traced }));
        Some(MeasuredValue { value, evidence, unread, broke, undecided, trace })
    }

    /// How a run broke that a claim reads, unless the claim reads the warnings of that run.
    fn broken(&self, claim: &CompiledClaim, outcome: &MeasuredRuns) -> Option<String> {
        let slots = || claim.reads.iter().filter_map(|place| self.layout().slots.get(*place));
        let excused = |place: usize| slots().any(|slot| *slot == Slot::Warnings(place));
        slots().find_map(|slot| {
            let Slot::Measure(place, _) = *slot else { return None };
            let run = outcome.runs.get(place)?;
            let (_, expect) = self.run_place(place);
            let name = crate::json::read::named(&run.title());
            match &run.broke {
                Some(how) if expect.forbids() && !excused(place) => {
                    Some(format!("the run {name} breaks: {how}"))
                }
                None if expect.requires() => {
                    Some(format!("the run {name} is expected to break, but it does not"))
                }
                _ => None,
            }
        })
    }

    /// Where the first NaN comes from that a claim reads.
    fn missing(&self, claim: &CompiledClaim, outcome: &MeasuredRuns, inputs: &ClaimInputs) -> Option<Cause> {
        let nothing = |place: &&usize| inputs.numbers.get(**place).is_some_and(|x| x.is_nan());
        let place = claim.reads.iter().find(nothing)?;
        match *self.layout().slots.get(*place)? {
            Slot::Measure(run, measure) => {
                let measured = outcome.runs.get(run)?;
                let (name, _) = measured.measures.get(measure)?;
                let found = measured.without_value.iter().find(|(other, _)| other == name);
                let no_value = found.map(|(_, no_value)| no_value.clone());
                Some(Cause::Measure { run, measure: Some(measure), no_value })
            }
            Slot::SeveralAxes => Some(Cause::SeveralAxes),
            Slot::Found(i) => outcome.found.get(i).map(|(name, _)| Cause::Search(name.clone())),
            _ => None,
        }
    }

    /// Whether a claim reads lists of a sweep over several quantities: a line through one has no values of its own.
    fn reads_grid(&self, claim: &CompiledClaim) -> Option<Cause> {
        let mut slots = claim.reads.iter().filter_map(|place| self.layout().slots.get(*place));
        let is_grid = |slot: &Slot| {
            let Slot::Measure(run, _) = *slot else { return false };
            self.runs
                .get(run)
                .and_then(|run| run.swept.as_ref())
                .is_some_and(|member| member.values.len() > 1)
        };
        slots.any(is_grid).then_some(Cause::SeveralAxes)
    }

    /// Whether an expression reads the same number of two runs that are the same simulation.
    pub(super) fn compares_same_runs(&self, found: &MeasuredValue) -> bool {
        let evaluated = found.trace.as_ref();
        evaluated.is_some_and(|e| !self.repeated_numbers(&e.claim, &e.inputs).is_empty())
    }

    /// Whether a claim could have a different outcome if the runs gave other values. `says` converts a value to the
    /// outcome; if `None`, the outcome is the truth of a condition, or a number.
    pub(super) fn could_differ(&self, found: &MeasuredValue, says: Option<&dyn Fn(&Value) -> bool>) -> bool {
        // A value that another engine recorded: the claim was tested with our own values.
        let Some(evaluated) = &found.trace else { return true };
        let Evaluated { claim, inputs, .. } = &**evaluated;
        let (places, kinds) = self.places(claim, inputs);
        // A formula reads nothing of a run.
        if places.is_empty() {
            return true;
        }
        // A number of a run that is the same simulation as another one is the number of that run.
        let repeated = self.repeated_numbers(claim, inputs);
        let is_repeated = |place: usize| repeated.iter().any(|(other, _)| *other == place);
        let (places, kinds): (Vec<usize>, Vec<ValueKind>) =
            places.into_iter().zip(kinds).filter(|(place, _)| !is_repeated(*place)).unzip();
        let outlook = |inputs: &ClaimInputs| {
            let inputs = &with_repeated(inputs, &repeated);
            let traced = claim.evaluate(self, inputs, None)?.ok().filter(|t| t.lost.is_none())?;
            // NaN does not count as a different number.
            if matches!(traced.value, Value::Number(x) if x.is_nan()) {
                return None;
            }
            let look = match (says, &traced.value) {
                (Some(says), value) => ClaimValue::Holds(says(value)),
                (None, Value::Boolean(holds)) => ClaimValue::Holds(*holds),
                (None, value) => ClaimValue::Number(value.to_number()),
            };
            Some((look, traced.comparisons))
        };
        if !evidence::could_differ(inputs, &places, &kinds, &claim.constants, &mut |inputs| outlook(inputs)) {
            return false;
        }
        // A claim that is false may be true only for rare values, so it is only tested with each number alone.
        match outlook(inputs) {
            Some((current, _)) if current != ClaimValue::Holds(false) => {
                self.differs_somewhere(claim, inputs, current, &mut |inputs| Some(outlook(inputs)?.0))
            }
            _ => true,
        }
    }

    /// Whether the value of a text is a boolean, as options, words and searches require; otherwise a finding is added.
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

    /// A boolean, or a number that is 0 or 1 for all results of the runs, as that of `holds(…)`. A count that happens to be
    /// 1 is not one.
    fn is_truth(&self, found: &MeasuredValue) -> bool {
        let truth = |x: f64| x == 0.0 || x == 1.0;
        let Value::Number(x) = found.value else { return matches!(found.value, Value::Boolean(_)) };
        // A value that another engine recorded: the claim was tested with our own values.
        let Some(evaluated) = found.trace.as_ref().filter(|_| truth(x)) else { return truth(x) };
        let Evaluated { claim, inputs, .. } = &**evaluated;
        let (places, kinds) = self.places(claim, inputs);
        let decided = |inputs| claim.evaluate(self, &inputs, None)?.ok().filter(|t| t.lost.is_none());
        let mut values = evidence::draws(inputs, &places, &kinds).filter_map(decided).peekable();
        !places.is_empty()
            && values.peek().is_some()
            && values.all(|t| matches!(t.value, Value::Boolean(_)) || truth(t.value.to_number()))
    }

    /// The positions of the measured numbers of a claim, or else of all measures that it reads, and the kind of each.
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
            .map(|program| self.idle(|session| kinds_of(program, &session.world, &mut session.context)));
        let parts = parts.flatten().unwrap_or_default();
        let count = inputs.numbers.len();
        // A value that is not simulated is constant, so its kind is unknown.
        let kind = |place: &usize| match place.checked_sub(count) {
            _ if !simulated => ValueKind::ANY,
            None => self.kinds().get(*place).copied().unwrap_or(ValueKind::ANY),
            Some(part) => parts.get(part).copied().unwrap_or(ValueKind::ANY),
        };
        let kinds = places.iter().map(kind).collect();
        (places, kinds)
    }

    /// Whether a condition holds, and its margin.
    pub(super) fn evaluate_margin(&self, found: &MeasuredValue) -> ConditionMargin {
        let holds = found.value.truthy();
        let without_number = found.undecided.as_ref().map(|u| u.part.clone().unwrap_or_default());
        let Some(evaluated) = found.trace.as_ref().filter(|_| without_number.is_none()) else {
            return ConditionMargin { holds, margin: None, without_number };
        };
        let Evaluated { claim, inputs, traced } = &**evaluated;
        let measured = claim.measured(self);
        // Comparisons whose sides do not change when the measured values are perturbed depend on none of them, for example
        // comparisons of a loop counter.
        let moved = {
            let mut moved = inputs.clone();
            for (k, place) in measured.iter().enumerate() {
                // Each value is perturbed by a different fraction, so that ratios change too.
                let part = 1e-7 * (1.0 + 0.618 * k as f64);
                if let Some(x) = inputs.at(*place) {
                    moved.set_value(*place, x + part * x.abs().max(1e-6));
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

    /// The texts that contain aggregates over the samples of the only run.
    pub(super) fn on_the_spot<'t>(&self, texts: impl Iterator<Item = &'t Text>) -> Vec<&'t Text> {
        let looks = |text: &&Text| {
            let claim = self.claim(text);
            claim.is_some_and(|c| c.program.as_ref().is_some_and(|p| !p.aggregates().is_empty()))
        };
        if self.runs.len() == 1 { texts.filter(looks).collect() } else { Vec::new() }
    }
}

/// The finding about an expression that throws.
fn error_finding(text: &Text, error: &RuntimeError) -> Finding {
    Finding::error(error.rule, text.span_of(error.span.start..error.span.end), error.message.clone())
        .why("the claim cannot be checked: this expression has no value")
        .help("correct the expression, or guard it with a condition")
}

/// The finding about a number or a text where a condition is required.
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
