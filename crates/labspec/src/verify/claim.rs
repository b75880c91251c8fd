//! An expression over the measures: compiled once, evaluated with the numbers of each step variant, and traced. The
//! evidence for its value follows from the evaluation: which numbers it read, whether one of them was missing, and the
//! results of its comparisons.

use super::bound::BoundVerify;
use super::compiled_claim::{ClaimInputs, CompiledClaim, TracedValue, reads_ctx, reads_data, reads_run};
use super::condition;
use super::format::shorten;
use super::layout::Slot;
use super::outcome::MeasuredRuns;
use super::outcome_names::OutcomeNames;
use crate::bind::{NUMBERS, Scope, to_finding};
use crate::finding::Finding;
use crate::rules;
use crate::run::Budget;
use crate::source::{SourceMap, Text};
use labspec_expr::rules::WHOLE_ARRAY;
use labspec_expr::{Compiler, Finding as LanguageFinding, Program, RuntimeError, Watch};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::rc::Rc;

impl<'a> BoundVerify<'a> {
    /// The names of the runs that the texts read. A text with its own aggregates reads the first run.
    pub(super) fn runs_read(&self, texts: &[Text]) -> BTreeSet<&'a str> {
        let mut names = BTreeSet::new();
        for claim in texts.iter().filter_map(|text| self.claim(text)) {
            let slots = claim.reads.iter().filter_map(|place| self.layout().slots.get(*place));
            for slot in slots {
                if let Slot::Measure(run, _) | Slot::Warnings(run) = *slot {
                    names.extend(self.runs.get(run).map(|run| run.name));
                }
            }
            let on_the_spot = claim.program.as_ref().is_some_and(|p| !p.aggregates().is_empty());
            names.extend(self.runs.first().filter(|_| on_the_spot).map(|run| run.name));
        }
        names
    }

    /// The numbers of an outcome that the texts read, as bits.
    pub(super) fn read_by(&self, outcome: &MeasuredRuns, texts: &[Text]) -> Vec<u64> {
        let numbers = self.layout().numbers(outcome);
        let claims = texts.iter().filter_map(|text| self.claim(text));
        let places: BTreeSet<usize> = claims.flat_map(|claim| claim.reads.clone()).collect();
        places.iter().filter_map(|place| numbers.get(*place)).map(|x| x.to_bits()).collect()
    }

    /// Whether a text reads the value of the search with this index.
    pub(super) fn reads_found(&self, text: &Text, index: usize) -> bool {
        let is = |place: &usize| self.layout().slots.get(*place) == Some(&Slot::Found(index));
        self.claim(text).is_some_and(|claim| claim.reads.iter().any(is))
    }

    /// The compiled expression of a text, from the cache after the first use.
    pub(super) fn claim(&self, text: &Text) -> Option<Rc<CompiledClaim>> {
        if let Some(cached) = self.claims.borrow().get(&text.value) {
            return Some(cached.clone());
        }
        let claim = Rc::new(CompiledClaim::compile(self, &text.value)?);
        self.claims.borrow_mut().insert(text.value.clone(), claim.clone());
        Some(claim)
    }

    /// The expressions for the numbers of a quote: the elements of a list, or else the expression itself.
    pub(super) fn numbers_of_quote<'t>(&self, expr: &'t Text) -> Vec<Cow<'t, Text>> {
        match self.length_of_list(expr) {
            Some(length) => (0..length).map(|i| Cow::Owned(with_suffix(expr, &format!("[{i}]")))).collect(),
            None => vec![Cow::Borrowed(expr)],
        }
    }

    /// The length of the list that an expression names; `None` for any other expression.
    fn length_of_list(&self, expr: &Text) -> Option<usize> {
        let is_list = |finding: &LanguageFinding| finding.code == WHOLE_ARRAY.code;
        if !self.claim(expr)?.diagnostics.iter().any(is_list) {
            return None;
        }
        let length = with_suffix(expr, ".length");
        let program = self.claim(&length)?.program.clone()?;
        let value = self.idle(|session| session.evaluate(&program, &length))??.to_number();
        (1.0..=MOST_NUMBERS).contains(&value).then_some(value as usize)
    }

    /// Lints the names in expressions over the outcome, before the runs.
    pub(super) fn lint_texts<'t>(&self, texts: impl Iterator<Item = &'t Text>, findings: &mut Vec<Finding>) {
        for text in texts {
            let Some(claim) = self.claim(text) else { return };
            let errors = claim.diagnostics.iter().filter(|d| d.is_error());
            findings.extend(errors.map(|d| to_finding(d, text)));
            if claim.outside && claim.program.is_some() {
                findings.push(reads_outside_run(text));
            }
        }
    }
}

/// Maximum number of numbers of a quote.
const MOST_NUMBERS: f64 = 100.0;

/// An expression with a suffix; its span is that of the whole.
pub(super) fn with_suffix(expr: &Text, suffix: &str) -> Text {
    Text::derived(format!("({}){suffix}", expr.value), expr.span())
}

impl CompiledClaim {
    /// Compiles a text for the runs and measures of an object.
    pub(super) fn compile(bound: &BoundVerify<'_>, text: &str) -> Option<CompiledClaim> {
        let base = bound.base()?;
        let layout = bound.layout();
        let names = OutcomeNames::new(layout, base.names(Scope::Measure));
        let mut globals = base.globals.clone();
        let compiled = Compiler::new(&names, &mut globals).linting().expression(text);
        let mut reads = Vec::new();
        let mut outside = false;
        if let Some(program) = &compiled.program {
            let effects = program.effects();
            for access in effects.reads.iter().filter(|a| a.field == NUMBERS) {
                let count = access.count.unwrap_or(layout.slots.len().saturating_sub(access.first));
                reads.extend(access.first..access.first.saturating_add(count).min(layout.slots.len()));
            }
            reads.sort_unstable();
            reads.dedup();
            outside = reads_data(effects) || effects.any_ctx || !effects.ctx_reads.is_empty();
        }
        let constants = condition::numbers_in(text);
        let nowhere = Text { value: String::new(), map: SourceMap::whole(0, 0..0) };
        let reads_simulated_ctx = compiled
            .program
            .as_ref()
            .is_some_and(|program| bound.depends_on_simulated_ctx(0, program, &nowhere));
        Some(CompiledClaim {
            program: compiled.program,
            diagnostics: compiled.diagnostics,
            reads,
            outside,
            names: names.names_read(),
            constants,
            reads_simulated_ctx,
        })
    }

    /// The numbers of an outcome with which the claim is evaluated.
    pub(super) fn inputs(
        &self,
        bound: &BoundVerify<'_>,
        outcome: &MeasuredRuns,
        parts: Vec<f64>,
    ) -> ClaimInputs {
        ClaimInputs { numbers: bound.layout().numbers(outcome), parts }
    }

    /// The positions of the measured numbers: first those of the layout, then those of the parts.
    pub(super) fn measured(&self, bound: &BoundVerify<'_>) -> Vec<usize> {
        let slots = &bound.layout().slots;
        let simulated = |place: &usize| match slots.get(*place) {
            Some(Slot::Measure(run, m)) => bound.is_simulated(*run, *m),
            Some(Slot::Warnings(_) | Slot::Found(_)) => true,
            Some(Slot::Swept(..) | Slot::Missing | Slot::SeveralAxes) | None => false,
        };
        let taken_here = self.program.iter().flat_map(|p| p.aggregates().iter().enumerate());
        let stops = bound.runs.first().is_some_and(|run| run.stop.is_some());
        let reads = |arg: &Program| reads_run(arg, stops) || self.reads_simulated_ctx && reads_ctx(arg);
        let taken_here = taken_here.filter(|(_, a)| a.args.iter().any(reads));
        let taken_here = taken_here.map(|(i, _)| slots.len() + i);
        self.reads.iter().copied().filter(simulated).chain(taken_here).collect()
    }

    /// Evaluates the claim with these numbers. `None` if it has no program.
    ///
    /// # Errors
    /// The program throws, for example when it reads a member of a missing list element.
    pub(super) fn evaluate(
        &self,
        bound: &BoundVerify<'_>,
        inputs: &ClaimInputs,
        turned: Option<usize>,
    ) -> Option<Result<TracedValue, RuntimeError>> {
        let program = self.program.as_ref()?;
        bound.idle(|session| {
            session.world.numbers.clone_from(&inputs.numbers);
            for (aggregate, x) in program.aggregates().iter().zip(&inputs.parts) {
                session.context.set_aggregate(aggregate.slot, *x);
            }
            session.context.allow(Budget::SAMPLE.left);
            session.context.watch(Some(Box::new(Watch::comparing(turned))));
            let value = program.run(&mut session.world, &mut session.context, None);
            let missing = session.context.events().first().map(|event| event.span);
            let watch = session.context.watch(None).map_or(Watch::default(), |watch| *watch);
            let lost = watch.lost.or(missing);
            value.map(|value| TracedValue { value, lost, comparisons: watch.comparisons })
        })
    }
}

/// The finding about a text that reads a field outside of an aggregate.
pub(super) fn reads_outside_run(text: &Text) -> Finding {
    let written = shorten(text.value.trim());
    Finding::error(
        rules::READ_OUTSIDE_RUN,
        text.span(),
        format!("`{written}` reads the simulation without choosing a time of the run"),
    )
    .why("a run has many samples, and this expression does not say which one it means; it would read the lab before the run")
    .help("choose a sample: `final(…)` at the end, `initial(…)` at the start, `max(…)`, `mean(…)`, or `at(condition, …)`")
}
