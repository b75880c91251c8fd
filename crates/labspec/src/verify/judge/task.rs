//! What a judge is asked: every run of a `verify` object with all that it depends on, so that somebody else can make it.

use crate::bind::scalar;
use crate::json::Scalar;
use crate::run::settings;
use crate::source::Text;
use crate::spec::format::RUN_LENGTH;
use crate::spec::{ControlKind, Lab, Verify};
use crate::verify::bound::BoundVerify;
use crate::verify::bound_run::{BoundRun, BoundScene};
use crate::verify::options::is_undecided;
use crate::verify::runner::is_timestep;
use labspec_expr::Value;
use serde_json::{Value as Json, json};

/// A run that a judge is asked to make.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Task {
    /// Its name: `fall`, `fall[2]`.
    pub(crate) run: String,
    /// Everything that it depends on, and what to measure; or why nobody else can make it.
    pub(crate) task: Result<Json, String>,
}

/// The runs of a `verify` object, as somebody else can make them.
pub(crate) fn tasks(bound: &BoundVerify<'_>, verify: &Verify) -> Vec<Task> {
    let texts = own_texts(bound, verify);
    let task = |(run, scene): (&BoundRun<'_>, &BoundScene<'_>)| {
        let run_name = title(run);
        Task { run: run_name, task: task(bound, run, scene, &texts) }
    };
    bound.cast().map(task).collect()
}

fn title(run: &BoundRun<'_>) -> String {
    run.swept.map_or(run.name.to_string(), |(i, _)| format!("{}[{i}]", run.name))
}

/// The texts that look at the samples themselves.
pub(super) fn own_texts<'v>(bound: &BoundVerify<'_>, verify: &'v Verify) -> Vec<&'v Text> {
    let all = verify.options.iter().chain(&verify.value).chain(&verify.wrong).chain(verify.quoted());
    bound.on_the_spot(all.filter(|text| !is_undecided(text)))
}

fn task(
    bound: &BoundVerify<'_>,
    run: &BoundRun<'_>,
    scene: &BoundScene<'_>,
    statements: &[&Text],
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
        "expressions": statements.iter().map(|t| t.value.clone()).collect::<Vec<_>>(),
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
