//! The real library as a second judge: which runs it is asked to make, and what becomes of claims with its numbers in place of ours.

use super::bound::{BoundRun, BoundScene};
use super::outcome::Outcome;
use super::perform::is_timestep;
use super::{Answer, BoundVerify, NUDGED, Outcomes, Quote, ShownText, TIGHT, answer, says, significant};
use crate::bind::scalar;
use crate::finding::Finding;
use crate::json::Scalar;
use crate::rules;
use crate::run::{Numerics, settings};
use crate::source::Text;
use crate::spec::format::RUN_LENGTH;
use crate::spec::{ControlKind, Lab, Question, Verify};
use labspec_expr::Value;
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use std::ops::Range;

/// A number that differs by less than this part of itself, and by less than a thousandth of that at zero, is the same.
const SAME: f64 = 1e-6;
/// So many times what a moved start or a converged solver change a number is no other engine.
const NUMERICS: f64 = 2.0;

/// A run that a judge is asked to make.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Task {
    /// Its name: `fall`, `fall[2]`.
    pub(crate) run: String,
    /// Everything that it depends on, and what to measure; or why nobody else can make it.
    pub(crate) task: Result<Json, String>,
}

/// What a judge found in a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Taken {
    /// Measures by name, and expressions that look at the samples themselves by their text.
    pub values: BTreeMap<String, f64>,
    /// Why the others have no value.
    pub refused: BTreeMap<String, String>,
    /// Number of warnings.
    pub warnings: usize,
    /// What broke in it.
    pub broke: Option<String>,
}

/// What a judge makes of a `verify` object.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judged {
    /// Numbers that were compared.
    pub compared: usize,
    /// Those that are others, by name: ours, and the judge's.
    pub differing: Vec<(String, f64, f64)>,
    /// Those that the judge has not taken, and why.
    pub unjudged: Vec<(String, String)>,
    /// Answers and quoted numbers that were judged again.
    pub claims: usize,
    /// Those whose verdict is another one.
    pub turned: usize,
}

/// The runs of a `verify` object, as somebody else can make them.
pub(crate) fn tasks(bound: &BoundVerify<'_>, verify: &Verify) -> Vec<Task> {
    let own = own_texts(bound, verify);
    let task = |(run, scene): (&BoundRun<'_>, &BoundScene<'_>)| {
        let run_name = title(run);
        Task { run: run_name, task: task(bound, run, scene, &own) }
    };
    bound.cast().map(task).collect()
}

fn title(run: &BoundRun<'_>) -> String {
    run.swept.map_or(run.name.to_string(), |(i, _)| format!("{}[{i}]", run.name))
}

/// The texts that look at the samples themselves.
fn own_texts<'v>(bound: &BoundVerify<'_>, verify: &'v Verify) -> Vec<&'v Text> {
    let all = verify.options.iter().chain(&verify.value).chain(verify.quoted());
    bound.on_the_spot(all.filter(|text| !answer::is_undecided(text)))
}

fn task(
    bound: &BoundVerify<'_>,
    run: &BoundRun<'_>,
    scene: &BoundScene<'_>,
    own: &[&Text],
) -> Result<Json, String> {
    let here = &scene.scene;
    let lab = &*here.lab;
    let xml = bound.stage().written(here).ok_or("its model cannot be written")?;
    let timestep = here.patches.iter().any(|(p, _)| is_timestep(&p.path)).then_some(here.model.opt.timestep);
    let spec = run.spec;
    let mut set = Vec::new();
    for (label, given) in spec.iter().flat_map(|spec| &spec.set) {
        set.push(json!([label.value, chosen(lab, label, &scalar(given))?]));
    }
    if let Some((label, x)) = run.control {
        set.push(json!([label.value, chosen(lab, label, &Value::Number(x))?]));
    }
    let press: Vec<Json> =
        spec.iter().flat_map(|spec| &spec.press).map(|(label, t)| json!([label.value, t.value])).collect();
    let length = |of: Option<f64>| of.or(lab.stop_at.as_ref().map(|s| s.value)).unwrap_or(RUN_LENGTH);
    let measures: Vec<Json> = scene.measures.iter().map(|(name, m)| json!([name, m.text.value])).collect();
    let code = |text: Option<&Text>| text.map(|t| t.value.clone());
    Ok(json!({
        "lab": of_lab(lab),
        "xml": xml,
        "timestep": timestep,
        "set": set,
        "press": press,
        "setup": code(spec.and_then(|s| s.setup.as_ref())),
        "stop": code(spec.and_then(|s| s.stop.as_ref())),
        "steps": spec.and_then(|s| s.steps.as_ref()).map(|n| n.value.max(0.0).round()),
        "until": length(spec.and_then(|s| s.until.as_ref()).map(|n| n.value)),
        "measures": measures,
        "expressions": own.iter().map(|t| t.value.clone()).collect::<Vec<_>>(),
    }))
}

/// The value that a control gets, where a text of a select was given.
fn chosen(lab: &Lab, label: &Text, given: &Value) -> Result<Json, String> {
    let control = lab.control(&label.value).ok_or("a control is missing")?;
    settings::value(control, given).map(|value| plain(&value)).map_err(|e| e.0)
}

fn plain(value: &Value) -> Json {
    match value {
        Value::Number(x) => json!(x),
        Value::Boolean(b) => json!(b),
        Value::String(s) => json!(s.to_string()),
        _ => Json::Null,
    }
}

/// The lab as far as it runs.
fn of_lab(lab: &Lab) -> Json {
    let code = |text: &Option<Text>| text.as_ref().map(|t| t.value.clone());
    let start = |value: &Scalar| plain(&scalar(value));
    let controls = lab.controls.iter().map(|c| {
        let value = match &c.kind {
            ControlKind::Button { run } => return json!({"label": c.label.value, "run": run.value}),
            ControlKind::Slider { value, .. } => json!(value.value),
            ControlKind::Select { value, .. } => start(value),
        };
        let action = c.action();
        json!({
            "label": c.label.value, "value": value,
            "set": action.and_then(|a| code(&a.set)), "apply": action.and_then(|a| code(&a.apply)),
            "param": action.and_then(|a| code(&a.param)),
            "init": action.is_some_and(|a| a.init), "reset": action.is_some_and(|a| a.reset),
        })
    });
    let readouts = lab.readouts.iter().map(|r| json!([r.label.value, r.expr.value, r.digits()]));
    let traces = lab.traces().map(|t| json!([t.label.value, t.expr.value, null]));
    let called = lab.plots.iter().enumerate().flat_map(|(i, plot)| {
        plot.traces.iter().map(move |t| json!([format!("plot/{i}/{}", t.label.value), t.expr.value, null]))
    });
    let named =
        lab.readouts.iter().map(|r| json!([format!("readout/{}", r.label.value), r.expr.value, r.digits()]));
    json!({
        "key": lab.keyframe(), "setup": code(&lab.setup), "controller": code(&lab.controller),
        "controls": controls.collect::<Vec<_>>(),
        "shown": readouts.chain(traces).chain(called).chain(named).collect::<Vec<_>>(),
    })
}

/// What a judge is called, and what it found in each run of an object; `None` for a run of which it has nothing.
pub(crate) struct Witness<'w> {
    /// `MuJoCo 3.14.0`.
    pub(crate) engine: &'w str,
    /// In the order of [`tasks`]; with why nothing is there.
    pub(crate) runs: Vec<Result<&'w Taken, String>>,
}

/// Compares every measure, and judges every claim again with the numbers of the judge in place of ours. `None` when a run cannot be
/// made here.
pub(crate) fn judge(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    shown: &ShownText,
    witness: &Witness<'_>,
    findings: &mut Vec<Finding>,
) -> Option<Judged> {
    let nominal = bound.outcome(Numerics::NOMINAL, &mut Vec::new())?;
    let mut judged = Judged::default();
    let theirs = replaced(bound, verify, &nominal, witness, &mut judged);
    compare(bound, verify, &nominal, &theirs, &mut judged);
    if judged.compared == 0 {
        return Some(judged);
    }
    // The range of an answer is a matter of many runs, which no judge has made.
    let verify = &Verify { over: Vec::new(), ..verify.clone() };
    let [ours, now] = [&nominal, &theirs].map(|o| verdicts(bound, verify, question, shown, o));
    let mut turn = |place: Range<usize>, what: &str, before: &str, after: &str, values: String| {
        judged.turned += 1;
        findings.push(
            Finding::new(
                rules::ENGINE_DEPENDENT,
                place,
                format!("{what} depends on the engine: {before} here, {after} with {}", witness.engine),
            )
            .why(format!("{values}: a student whose page has another version sees something else"))
            .help(
                "ask about what does not depend on it, quote fewer digits, or name the version in the text",
            ),
        );
    };
    let most: Vec<String> = judged
        .differing
        .iter()
        .take(3)
        .map(|(name, ours, theirs)| {
            format!("`{name}` is {} here and {} there", shown_as(*ours), shown_as(*theirs))
        })
        .collect();
    let values = if most.is_empty() { "a run breaks in one of them".to_string() } else { most.join(", ") };
    if let (Some(ours), Some(now)) = (&ours.0, &now.0) {
        judged.claims += 1;
        if ours.verdict != now.verdict {
            let right = question.and_then(Question::right_option).and_then(|i| verify.options.get(i));
            let place = verify.value.as_ref().or(right).map_or(verify.span.clone(), Text::span);
            turn(place, "this answer", ours.verdict.as_str(), now.verdict.as_str(), values.clone());
        }
    }
    for (ours, now) in ours.1.iter().zip(&now.1) {
        judged.claims += 1;
        if ours.state != now.state {
            let numbers =
                format!("it is {} here and {} there", shown_as(ours.computed), shown_as(now.computed));
            turn(ours.span.clone(), &format!("\"{}\"", ours.text), ours.verdict(), now.verdict(), numbers);
        }
    }
    Some(judged)
}

/// Enough digits to see that two numbers are not the same.
pub(crate) fn shown_as(x: f64) -> String {
    let short = significant(x);
    if x.is_finite() && short.parse::<f64>().is_ok_and(|y| y != x) {
        format!("{x:.9e}").parse::<f64>().map_or(short, |y| y.to_string())
    } else {
        short
    }
}

/// Our outcome with the judge's numbers in place of ours, where it has them.
fn replaced(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    nominal: &Outcome,
    witness: &Witness<'_>,
    judged: &mut Judged,
) -> Outcome {
    let mut theirs = nominal.clone();
    let unknown = || Err("nothing is recorded of its run".to_string());
    for (i, run) in theirs.runs.iter_mut().enumerate() {
        let title = run.title();
        let taken = match witness.runs.get(i).cloned().unwrap_or_else(unknown) {
            Ok(taken) => taken,
            Err(why) => {
                let names = run.measures.iter().map(|(m, _)| (format!("{title}.{m}"), why.clone()));
                judged.unjudged.extend(names);
                continue;
            }
        };
        for (name, x) in &mut run.measures {
            match taken.values.get(name) {
                Some(value) => *x = *value,
                None => {
                    let why = taken.refused.get(name).map_or("nothing is recorded of it", String::as_str);
                    judged.unjudged.push((format!("{title}.{name}"), why.to_string()));
                }
            }
        }
        // What only we notice, energy from nothing, stays noticed; a bad number that only one of both has does not.
        let only_ours = run.warnings > 0 && taken.warnings == 0;
        run.broke = taken.broke.clone().or(run.broke.take().filter(|_| !only_ours));
        run.warnings = taken.warnings;
    }
    let searched = "a search is not made again".to_string();
    judged.unjudged.extend(theirs.found.iter().map(|(name, _)| (name.clone(), searched.clone())));
    for text in own_texts(bound, verify) {
        let taken = witness.runs.first().and_then(|run| run.as_ref().ok());
        match taken.and_then(|t| t.values.get(&text.value)) {
            Some(x) => theirs.elsewhere.push((text.value.clone(), *x)),
            None => {
                let why = taken.and_then(|t| t.refused.get(&text.value));
                let why = why.map_or("nothing is recorded of it", String::as_str);
                judged.unjudged.push((text.value.clone(), why.to_string()));
            }
        }
    }
    theirs
}

/// Compares the numbers of both.
fn compare(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    nominal: &Outcome,
    theirs: &Outcome,
    judged: &mut Judged,
) {
    let mut other: Option<Vec<Vec<f64>>> = None;
    let numbers = |outcome: &Outcome| -> Vec<(String, f64)> {
        let own = own_texts(bound, verify).into_iter().map(|text| {
            let found = bound.find(outcome, text, &mut Vec::new());
            (text.value.clone(), found.map_or(f64::NAN, |f| f.value.to_number()))
        });
        let titled = outcome.runs.iter().flat_map(|run| {
            let title = run.title();
            run.measures.iter().map(move |(m, x)| (format!("{title}.{m}"), *x))
        });
        titled.chain(own).collect()
    };
    for (i, ((name, a), (_, b))) in numbers(nominal).into_iter().zip(numbers(theirs)).enumerate() {
        if judged.unjudged.iter().any(|(known, _)| *known == name) {
            continue;
        }
        judged.compared += 1;
        let apart = (a - b).abs();
        let same = a == b || a.is_nan() && b.is_nan() || apart <= SAME * a.abs().max(b.abs()) + 1e-3 * SAME;
        if same {
            continue;
        }
        let others = other.get_or_insert_with(|| {
            let made = [NUDGED, TIGHT].map(|n| bound.outcome(n, &mut Vec::new()));
            made.iter().flatten().map(|o| numbers(o).into_iter().map(|(_, x)| x).collect()).collect()
        });
        let moved = others.iter().filter_map(|list| list.get(i)).map(|x| (x - a).abs()).fold(0.0, f64::max);
        if apart.is_nan() || apart > NUMERICS * moved {
            judged.differing.push((name, a, b));
        }
    }
}

/// The answer and the quoted numbers, as these numbers have them.
fn verdicts(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    question: Option<&Question>,
    shown: &ShownText,
    outcome: &Outcome,
) -> (Option<Answer>, Vec<Quote>) {
    let outcomes =
        Outcomes { nominal: outcome.clone(), perturbed: [const { None }; super::CHANGES], nudged_back: None };
    let ignored = &mut Vec::new();
    let answer = question.and_then(|q| answer::check(bound, &outcomes, verify, q, ignored));
    let court = says::Court { bound, outcomes: &outcomes, shown };
    (answer, says::check(court, verify, question, ignored))
}
