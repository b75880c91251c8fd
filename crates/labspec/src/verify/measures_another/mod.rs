//! Finds texts whose words name another object, setting, time, occurrence or extreme than the expression beside them reads: "the cork ball presses with
//! 29.4 N" beside `normalForce('iron')`. The other value is computed in the same run, or is that of the other run; where it is the same,
//! nothing is reported.

mod extreme;
mod moment;
mod object;
mod occurrence;
mod setting;

use super::bound::BoundVerify;
use super::bound_run::{BoundRun, CompiledText};
use super::compiled_claim::CompiledClaim;
use super::format::significant;
use super::layout::Slot;
use super::outcome::MeasuredRuns;
use super::quote::{OptionNumber, quantities_in};
use crate::bind::Scope;
use crate::finding::Finding;
use crate::json::read::named;
use crate::language::Languages;
use crate::rules;
use crate::source::Text;
use labspec_expr::{Compiler, Value};
use std::borrow::Cow;
use std::ops::Range;
use std::rc::Rc;

/// Relative difference from which a value is another one: less may not be visible in the digits of the text.
const DIFFERENT: f64 = 0.02;

/// Reports words of a text that name something else than the expression beside it reads. `words` is the text without the number that the
/// expression gives, and `place` is where it stands.
pub(super) fn check_words_of_measure(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    words: &str,
    place: Range<usize>,
    expr: &Text,
    findings: &mut Vec<Finding>,
) {
    let Some(read) = ReadMeasure::new(bound, outcome, words, expr) else { return };
    let lower = words.to_lowercase();
    let all: [fn(&ReadMeasure<'_, '_>, &str) -> Option<Other>; 7] = [
        object::other,
        setting::named_run,
        setting::other,
        setting::untested,
        moment::other,
        occurrence::other,
        extreme::other,
    ];
    let Some(other) = all.iter().find_map(|other| other(&read, &lower)) else { return };
    let message =
        format!("the text says {}, but `{}` reads {}", named(&other.words), expr.as_str(), other.read);
    let value = match &other.value {
        Value::Number(x) => format!("there it is {}", significant(*x)),
        _ => "there it does not hold".to_string(),
    };
    findings.push(
        Finding::new(rules::MEASURES_ANOTHER, place, message)
            .why(format!("{} gives another value: {value}", other.with))
            .help("correct the text, or read what it is about")
            .related(read.text.span(), "what is read"),
    );
}

/// The lower-case text before a quantity of it, whose unit may be written in another way there.
fn before_quantity<'t>(text: &'t str, quantity: &str) -> Option<&'t str> {
    let lower = quantity.to_lowercase();
    let number = lower.split_whitespace().next()?;
    text.get(..text.find(&lower).or_else(|| text.find(number))?)
}

/// What the words of a text name in place of what a claim reads.
struct Other {
    /// The words.
    words: String,
    /// What the claim reads.
    read: String,
    /// How the other value was computed: "`force('cork')` in the same run".
    with: String,
    /// The value of the claim with it.
    value: Value,
}

/// A claim that reads one measure of one run.
struct ReadMeasure<'b, 'a> {
    bound: &'b BoundVerify<'a>,
    outcome: &'b MeasuredRuns,
    /// The text beside the claim, in which units have their capital letters.
    words: &'b str,
    expr: &'b Text,
    claim: Rc<CompiledClaim>,
    /// The position of the number.
    place: usize,
    /// The index of the run, and of the measure.
    run: usize,
    measure: usize,
    /// The text of the measure.
    text: Text,
    value: Value,
    languages: Languages,
}

impl<'b, 'a> ReadMeasure<'b, 'a> {
    /// `None` if a claim reads several numbers, or none.
    fn new(
        bound: &'b BoundVerify<'a>,
        outcome: &'b MeasuredRuns,
        words: &'b str,
        expr: &'b Text,
    ) -> Option<ReadMeasure<'b, 'a>> {
        let claim = bound.claim(expr)?;
        let [place] = claim.reads[..] else { return None };
        let Some(Slot::Measure(run, measure)) = bound.layout().slots.get(place).copied() else { return None };
        if !claim.program.as_ref()?.aggregates().is_empty() || bound.runs.get(run)?.swept.is_some() {
            return None;
        }
        let text = bound.measure_at(run, measure)?.text.clone().into_owned();
        let value = bound.find(outcome, expr, &mut Vec::new())?.value;
        let languages = bound.stage().languages();
        Some(ReadMeasure { bound, outcome, words, expr, claim, place, run, measure, text, value, languages })
    }

    /// Whether the measure reads the model only: it is a setting itself, beside which a text may state others.
    fn is_of_model(&self) -> bool {
        self.text.value.contains("model.") && !self.text.value.contains("data.")
    }

    /// The quantities of the text.
    fn quantities(&self) -> Vec<OptionNumber> {
        quantities_in(self.words, self.languages)
    }

    /// The value of the claim with another text of the measure in the same run, if it is another one.
    fn with_text(&self, text: String) -> Option<Value> {
        let text = Text::derived(text, self.text.span());
        self.with_number(measured_in_run(self.bound, self.outcome, self.bound.runs.get(self.run)?, text)?)
    }

    /// The number of the same measure in another run.
    fn number_of_run(&self, run: usize) -> Option<f64> {
        let slots = &self.bound.layout().slots;
        let place = slots.iter().position(|slot| *slot == Slot::Measure(run, self.measure))?;
        self.claim.inputs(self.bound, self.outcome, Vec::new()).at(place).filter(|x| x.is_finite())
    }

    /// The value of the claim with another setting of the run, if it is another one.
    fn with_setting(&self, control: &'a Text, value: Value) -> Option<Value> {
        let run = self.bound.runs.get(self.run)?.clone();
        let run = BoundRun { controls: vec![(control, value)], ..run };
        self.with_number(measured_in_run(self.bound, self.outcome, &run, self.text.clone())?)
    }

    /// The value of the claim with another number in place of the measured one, if it is another one.
    fn with_number(&self, x: f64) -> Option<Value> {
        let mut inputs = self.claim.inputs(self.bound, self.outcome, Vec::new());
        inputs.set_value(self.place, x);
        let value = self.claim.evaluate(self.bound, &inputs, None)?.ok()?.value;
        let differs = match (&value, &self.value) {
            (Value::Number(a), Value::Number(b)) => {
                a.is_finite() && (a - b).abs() > DIFFERENT * a.abs().max(b.abs())
            }
            (other, current) => !other.truthy() && current.truthy(),
        };
        differs.then_some(value)
    }
}

/// The value of a measure in a run, with this text. `None` if it is not finite.
pub(super) fn measured_in_run<'a>(
    bound: &BoundVerify<'a>,
    outcome: &MeasuredRuns,
    run: &BoundRun<'a>,
    text: Text,
) -> Option<f64> {
    let scene = bound.scene_of(run)?;
    let mut globals = scene.globals.clone();
    let program = Compiler::new(&scene.names(Scope::Measure), &mut globals).expression(&text.value).program?;
    let measure = CompiledText { text: Cow::Owned(text), program };
    let made = bound.execute_run(run, outcome.numerics, &[&measure], &mut Vec::new())?;
    made.values.first().map(|sampled| sampled.value).filter(|x| x.is_finite())
}

#[cfg(test)]
mod tests {
    /// What is found about a numeric question over two balls that fall from 1 m and 2 m for 0.3 s.
    pub(super) fn found(question: &str, measure: &str, answer: f64) -> Vec<String> {
        let xml = "<mujoco><worldbody><body name='iron' pos='0 0 1'><freejoint/><geom size='.05'/></body>\
            <body name='cork' pos='0 0 2'><freejoint/><geom size='.05'/></body><body name='scale'><geom size='.1'/></body></worldbody></mujoco>";
        let verify = serde_json::json!({"lab": {"stopAt": 0.3, "xml": xml}, "runs": {"r": {"until": 0.3}}, "measure": {"h": measure}, "value": "r.h"});
        let question = serde_json::json!({"kind": "numeric", "q": question, "answer": answer, "tol": 0.05, "unit": "m", "verify": verify});
        let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        let all = report.findings.iter().filter(|finding| finding.code == "measures-another");
        all.map(|finding| finding.message.clone()).collect()
    }

    #[test]
    fn the_setting_of_another_run_is_found() {
        let xml = "<mujoco><worldbody><body><joint name='j' axis='0 1 0'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>";
        let found = |question: &str, value: &str, answer: f64| {
            let control = serde_json::json!({"label": "start (rad)", "param": "q", "min": 0, "max": 2, "step": 0.1, "value": 0.1, "reset": true});
            let lab = serde_json::json!({"stopAt": 6, "xml": xml, "controls": [control], "setup": "data.qpos[0] = ctx.q"});
            let verify = serde_json::json!({"lab": lab, "runs": {"a": {"set": {"start (rad)": 0.1}}, "b": {"set": {"start (rad)": 1.5}}},
                "measure": {"T": "period(data.qpos[0])"}, "value": value});
            let question = serde_json::json!({"kind": "numeric", "q": question, "answer": answer, "tol": 0.02, "unit": "s", "verify": verify});
            let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
            let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
            report.findings.iter().filter(|finding| finding.code == "measures-another").count()
        };
        assert_eq!(found("How long does a swing from 0.1 rad take?", "b.T", 1.65), 1);
        assert_eq!(found("Wie lange dauert eine Schwingung aus 0,1 rad?", "b.T", 1.65), 1);
        assert_eq!(found("How long does a swing from 1.5 rad take?", "b.T", 1.65), 0);
        assert_eq!(found("How long does a swing from 1.5 rad take, instead of 0.1 rad?", "b.T", 1.65), 0);
        assert_eq!(found("How long does a swing take?", "b.T", 1.65), 0);
        // No run has this setting.
        assert_eq!(found("How long does a swing from 0.5 rad take?", "b.T", 1.65), 1);
        assert_eq!(found("How long does a swing of 0.5 rad take?", "b.T", 1.65), 0);
        assert_eq!(found("How long does a swing from 7 rad take?", "b.T", 1.65), 0);
    }

    #[test]
    fn the_first_cell_of_a_row_names_what_the_others_are_about() {
        let xml = "<mujoco><worldbody><body name='iron' pos='0 0 1'><freejoint/><geom size='.05'/></body>\
            <body name='cork' pos='0 0 2'><freejoint/><geom size='.05'/></body></worldbody></mujoco>";
        let count = |rows: [&str; 2], text: &str| {
            let lab = serde_json::json!({"stopAt": 0.3, "xml": xml, "plots": []});
            let cell =
                |row: &str, is: &str| serde_json::json!({"column": "height (m)", "row": row, "is": is});
            let table = [cell("iron", rows[0]), cell("cork", rows[1])];
            let verify = serde_json::json!({"lab": "#1", "runs": {"r": {}},
                "measure": {"a": "initial(data.body('iron').xpos[2])", "b": "initial(data.body('cork').xpos[2])"}, "table": table});
            let lesson = format!("```lab simlab\n{lab}\n```\n\n<!-- labspec verify {verify} -->\n{text}");
            let report = crate::Checker::new(|_: &str| None::<String>).check("l.md", &lesson);
            assert!(report.findings.iter().all(|f| f.code != "quote-wrong"), "{:?}", report.findings);
            report.findings.iter().filter(|finding| finding.code == "measures-another").count()
        };
        let right = "| ball | height (m) |\n|---|---|\n| iron | 1.00 |\n| cork | 2.00 |\n";
        let wrong = "| ball | height (m) |\n|---|---|\n| iron | 2.00 |\n| cork | 1.00 |\n";
        assert_eq!(count(["a", "b"], right), 0);
        assert_eq!(count(["b", "a"], wrong), 2);
    }
}
