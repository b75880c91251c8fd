//! `verify` objects that refer to nothing, or claim nothing.

use super::ranges::positive;
use crate::finding::{Finding, Severity};
use crate::json::{encode, nearest, read::named};
use crate::source::Text;
use crate::spec::format::RUN;
use crate::spec::{ControlKind, Lab, Lesson, QuestionKind, Verify, VerifyLab};
use labspec_finding::{Example, Layer, Rule};

/// A lab that the lesson does not have.
pub static UNKNOWN_LAB: Rule = Rule {
    code: "unknown-lab",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a `verify` object refers to a lab that the lesson does not have",
    why: "nothing can be run, so nothing is checked",
    bad: Example::Quiz(
        r##"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 3.924, "verify": {"lab": "#1", "runs": {"run": {"until": 0.4}}, "value": "final(-data.qvel[2])"}}]}"##,
    ),
    good: Example::Lesson(
        "```lab simlab\n{\"model\": \"ball\"}\n```\n\n```quiz\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"numeric\", \"q\": \"How fast?\", \"answer\": 3.924, \"verify\": {\"lab\": \"#1\", \"runs\": {\"run\": {\"until\": 0.4}}, \"value\": \"final(-data.qvel[2])\"}}]}\n```\n",
    ),
};

/// No lab to run.
pub static NO_LAB: Rule = Rule {
    code: "verify-without-lab",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a `verify` object has no lab to run",
    why: "the question has no `sim`, so `verify` must say which lab it is about",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 3.924, "verify": {"runs": {"run": {"until": 0.4}}, "value": "final(-data.qvel[2])"}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 3.924, "verify": {"lab": {"model": "ball"}, "runs": {"run": {"until": 0.4}}, "value": "final(-data.qvel[2])"}}]}"#,
    ),
};

/// A run that sets or presses a control that the lab does not have.
pub static UNKNOWN_CONTROL: Rule = Rule {
    code: "unknown-control",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a run sets or presses a control that the lab does not have",
    why: "the run would not be the one that the text talks about",
    bad: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 5, "value": 1}], "verify": {"runs": {"heavy": {"set": {"fricton": 2}}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 5, "value": 1}], "verify": {"runs": {"heavy": {"set": {"friction": 2}, "until": 2}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
};

/// Conditions that do not match the options, or a value where there is no number.
pub static ANSWERS: Rule = Rule {
    code: "verify-answer",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "`verify` has no condition for each option, or a value where no number is asked",
    why: "exactly the condition of the right option must hold, so every option needs one",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "predict", "q": "What does it do?", "options": ["falls", "rises", "stays"], "answer": 0, "sim": {"model": "ball"}, "verify": {"runs": {"run": {"until": 0.4}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["z < 0.9", "z > 1.1"]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "predict", "q": "What does it do?", "options": ["falls", "rises", "stays"], "answer": 0, "sim": {"model": "ball"}, "verify": {"runs": {"run": {"until": 0.4}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["z < 0.9", "z > 1.1", "0.9 <= z && z <= 1.1"]}}]}"#,
    ),
};

/// A `verify` object that claims nothing.
pub static NOTHING: Rule = Rule {
    code: "verify-nothing",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a `verify` object claims nothing",
    why: "its runs are made, but nothing is compared with them",
    bad: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": {"runs": {"drop": {"until": 2}}}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": {"runs": {"drop": {"until": 2}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
};

/// A run with two lengths.
pub static RUN_LENGTH: Rule = Rule {
    code: "run-length",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a run has both `until` and `steps`",
    why: "they may contradict each other",
    bad: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": {"runs": {"drop": {"until": 2, "steps": 500}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": {"runs": {"drop": {"until": 2}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
};

pub(in crate::lint) const RULES: &[&Rule] =
    &[&UNKNOWN_LAB, &NO_LAB, &UNKNOWN_CONTROL, &ANSWERS, &NOTHING, &RUN_LENGTH];

pub(in crate::lint) fn check(lesson: &Lesson, findings: &mut Vec<Finding>) {
    for lab in lesson.all_labs() {
        let Some(verify) = &lab.verify else { continue };
        let target = target(verify, Some(lab), lesson, findings);
        check_one(verify, target, findings);
        for text in verify.options.first().into_iter().chain(&verify.value) {
            findings.push(
                Finding::new(&ANSWERS, text.span(), "a lab has no answer to compare this with")
                    .help("move it to the question, or say it as [quote, expression] under `says`"),
            );
        }
    }
    for (_, question) in lesson.quizzes.iter().flat_map(|q| q.numbered()) {
        let Some(verify) = &question.verify else { continue };
        let target = target(verify, question.sim(), lesson, findings);
        check_one(verify, target, findings);
        let options = match &question.kind {
            QuestionKind::Choice { options, .. } => options.len(),
            _ => 0,
        };
        let conditions = verify.options.len();
        if conditions > 0 && conditions != options {
            let span = verify.options.first().map_or(verify.span.clone(), Text::span);
            findings.push(
                Finding::new(&ANSWERS, span, format!("{conditions} conditions for {options} options"))
                    .help("write one condition per option, in their order"),
            );
        }
        if let Some(value) = &verify.value
            && !matches!(question.kind, QuestionKind::Numeric { .. })
        {
            findings.push(
                Finding::new(&ANSWERS, value.span(), "this question asks for no number")
                    .help("`value` is for questions of kind numeric; use `options` or `says`"),
            );
        }
    }
}

/// An object without claims, found while it is read.
pub(crate) fn claims_nothing(verify: std::ops::Range<usize>) -> Finding {
    Finding::new(&NOTHING, verify.start..verify.start + 1, "nothing is compared with these runs")
        .help("add `options`, `value`, `says` or `exact`")
}

/// The lab that a `verify` object is about.
fn target<'a>(
    verify: &'a Verify,
    own: Option<&'a Lab>,
    lesson: &'a Lesson,
    findings: &mut Vec<Finding>,
) -> Option<&'a Lab> {
    match &verify.lab {
        Some(VerifyLab::Inline(lab)) => Some(lab),
        Some(VerifyLab::Broken) => None,
        Some(VerifyLab::Reference(text, address)) => {
            let found = lesson.lab(address);
            let broken = matches!(address, crate::spec::LabAddress::Lab(n) if *n <= lesson.labs.len());
            if found.is_none() && !broken {
                let all: Vec<String> =
                    lesson.addressed().iter().take(12).map(|(a, _)| a.to_string()).collect();
                let finding = Finding::new(
                    &UNKNOWN_LAB,
                    text.span(),
                    format!("there is no lab {} in this lesson", named(text.as_str())),
                );
                findings.push(if all.is_empty() {
                    finding.help("write a lab object here, or put a lab into the lesson")
                } else {
                    finding.help(format!("the lesson has {}", all.join(", ")))
                });
            }
            found
        }
        None => {
            if own.is_none() {
                findings.push(
                    Finding::new(
                        &NO_LAB,
                        verify.span.start..verify.span.start + 1,
                        "there is no lab that could run",
                    )
                    .help("add \"lab\": \"#1\" for the first lab of the lesson, or a lab object"),
                );
            }
            own
        }
    }
}

fn check_one(verify: &Verify, lab: Option<&Lab>, findings: &mut Vec<Finding>) {
    // A hostile object can set thousands of controls; the first mistakes are enough.
    let most = findings.len() + 50;
    for run in &verify.runs {
        positive(&RUN, "until", run.until.as_ref(), "the length of the run in seconds", findings);
        positive(&RUN, "steps", run.steps.as_ref(), "the length of the run in steps", findings);
        if let (Some(until), Some(steps)) = (&run.until, &run.steps) {
            findings.push(
                Finding::new(&RUN_LENGTH, steps.span.clone(), "this run has both `until` and `steps`")
                    .related(until.span.clone(), "its length in seconds")
                    .help("keep one of the two"),
            );
        }
        if let Some(lab) = lab.filter(|_| findings.len() < most) {
            for (label, _) in run.set.iter().take(200) {
                control(label, lab, false, findings);
            }
            for (label, _) in run.press.iter().take(200) {
                control(label, lab, true, findings);
            }
        }
    }
}

/// Whether the lab has a control of this label that can be set, or pressed.
fn control(label: &Text, lab: &Lab, press: bool, findings: &mut Vec<Finding>) {
    let fits = |kind: &ControlKind| matches!(kind, ControlKind::Button { .. }) == press;
    // A control that could not be read may be the one that is meant.
    if lab.unread_controls || lab.control(label.as_str()).is_some_and(|c| fits(&c.kind)) {
        return;
    }
    let what = if press { "button" } else { "slider or select" };
    let labels: Vec<&str> =
        lab.controls.iter().filter(|c| fits(&c.kind)).map(|c| c.label.as_str()).take(200).collect();
    let finding = Finding::new(
        &UNKNOWN_CONTROL,
        label.span(),
        format!("the lab has no {what} {}", named(label.as_str())),
    );
    findings.push(match nearest(label.as_str(), labels.iter().copied()) {
        Some(right) => finding.help(format!("did you mean `{right}`?")).fix(label.span(), encode(right)),
        None if labels.is_empty() => finding.help(format!("the lab has no {what} at all")),
        None => finding.help(format!("it has {}", labels.join(", "))),
    });
}
