//! The requests for a reference engine: every run of a `verify` object with everything that it depends on, so that another
//! program can execute it.

use crate::bind::scalar;
use crate::run::settings;
use crate::source::Text;
use crate::spec::format::RUN_LENGTH;
use crate::spec::{Control, ControlKind, Lab, Readout, Trace, Verify};
use crate::verify::bound::BoundVerify;
use crate::verify::bound_run::{BoundRun, BoundScene};
use crate::verify::options::is_undecided;
use crate::verify::runner::is_timestep;
use labspec_expr::Value;
use serde::Serialize;
use serde_json::Value as Json;

/// A run for a reference engine.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Task {
    /// Its name: `fall`, `fall[2]`.
    pub(crate) run: String,
    /// The request, or the reason why another program cannot execute the run.
    pub(crate) task: Result<RunTask, String>,
}

/// Everything that a run depends on, and its measures, in the form that is written to a request.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunTask {
    lab: LabTask,
    xml: String,
    timestep: Option<f64>,
    set: Vec<(String, Json)>,
    press: Vec<(String, f64)>,
    setup: Option<String>,
    stop: Option<String>,
    steps: Option<f64>,
    until: f64,
    /// The time at which the run ends, s, if the lab ends it: a program that resets the time does not change that.
    #[serde(rename = "stopAt")]
    stop_at: Option<f64>,
    measures: Vec<(String, String)>,
    expressions: Vec<String>,
}

/// The parts of a lab that affect a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct LabTask {
    key: Option<usize>,
    setup: Option<String>,
    controller: Option<String>,
    controls: Vec<ControlTask>,
    /// Names of displayed values, their expressions and decimals.
    #[serde(rename = "shown")]
    displayed: Vec<(String, String, Option<u32>)>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
enum ControlTask {
    Button {
        label: String,
        run: String,
    },
    Setting {
        label: String,
        value: Json,
        set: Option<String>,
        apply: Option<String>,
        param: Option<String>,
        init: bool,
        reset: bool,
    },
}

/// The runs of a `verify` object as requests.
pub(crate) fn tasks(bound: &BoundVerify<'_>, verify: &Verify) -> Vec<Task> {
    let texts = own_texts(bound, verify);
    let task = |(run, scene): (&BoundRun<'_>, &BoundScene<'_>)| {
        let run_name = title(run);
        Task { run: run_name, task: task(bound, run, scene, &texts) }
    };
    bound.runs_with_scenes().map(task).collect()
}

fn title(run: &BoundRun<'_>) -> String {
    run.title()
}

/// The texts that contain their own aggregates.
pub(super) fn own_texts<'v>(bound: &BoundVerify<'_>, verify: &'v Verify) -> Vec<&'v Text> {
    let all = verify.options.iter().chain(&verify.value).chain(&verify.wrong).chain(verify.quoted());
    bound.on_the_spot(all.filter(|text| !is_undecided(text)))
}

fn task(
    bound: &BoundVerify<'_>,
    run: &BoundRun<'_>,
    scene: &BoundScene<'_>,
    statements: &[&Text],
) -> Result<RunTask, String> {
    let here = &scene.scene;
    let lab = &*here.lab;
    let xml = bound.stage().written(here).ok_or("its model cannot be written")?;
    let timestep = here.patches.iter().any(|(p, _)| is_timestep(&p.path)).then_some(here.model.opt.timestep);
    let spec = run.spec;
    let mut set = Vec::new();
    for (label, given) in spec.iter().flat_map(|spec| &spec.set) {
        set.push((label.value.clone(), chosen(lab, label, &scalar(given))?));
    }
    for (label, value) in &run.controls {
        set.push((label.value.clone(), chosen(lab, label, value)?));
    }
    let length = |given: Option<f64>| given.or(lab.stop_at.as_ref().map(|s| s.value)).unwrap_or(RUN_LENGTH);
    let has_length = spec.is_some_and(|s| s.until.is_some() || s.steps.is_some());
    Ok(RunTask {
        lab: lab_task(lab),
        xml,
        timestep,
        set,
        press: spec.iter().flat_map(|s| &s.press).map(|(label, t)| (label.value.clone(), t.value)).collect(),
        setup: code(spec.and_then(|s| s.setup.as_ref())),
        stop: code(spec.and_then(|s| s.stop.as_ref())),
        steps: spec.and_then(|s| s.steps.as_ref()).map(|n| n.value.max(0.0).round()),
        stop_at: lab.stop_at.as_ref().map(|s| s.value).filter(|time| *time > 0.0 && !has_length),
        until: length(spec.and_then(|s| s.until.as_ref()).map(|n| n.value)),
        measures: scene.measures.iter().map(|(name, m)| (name.to_string(), m.text.value.clone())).collect(),
        expressions: statements.iter().map(|t| t.value.clone()).collect(),
    })
}

fn code(text: Option<&Text>) -> Option<String> {
    text.map(|t| t.value.clone())
}

/// The value that a control gets. For a select, the text that was given is converted.
fn chosen(lab: &Lab, label: &Text, given: &Value) -> Result<Json, String> {
    let control = lab.control(&label.value).ok_or("a control is missing")?;
    settings::value(control, given).map(|value| plain(&value)).map_err(|e| e.message)
}

fn plain(value: &Value) -> Json {
    match value {
        Value::Number(x) => (*x).into(),
        Value::Boolean(b) => (*b).into(),
        Value::String(s) => s.to_string().into(),
        _ => Json::Null,
    }
}

fn lab_task(lab: &Lab) -> LabTask {
    let plots = || lab.plots.iter().enumerate().flat_map(|(i, plot)| plot.traces.iter().map(move |t| (i, t)));
    let readout = |name: String, r: &Readout| (name, r.expr.value.clone(), Some(r.digits()));
    let trace = |name: String, t: &Trace| (name, t.expr.value.clone(), None);
    let readouts = lab.readouts.iter().map(|r| readout(r.label.value.clone(), r));
    let traces = plots().map(|(_, t)| trace(t.label.value.clone(), t));
    let plotted = plots().map(|(i, t)| trace(format!("plot/{i}/{}", t.label.value), t));
    let named = lab.readouts.iter().map(|r| readout(format!("readout/{}", r.label.value), r));
    LabTask {
        key: lab.keyframe(),
        setup: code(lab.setup.as_ref()),
        controller: code(lab.controller.as_ref()),
        controls: lab.controls.iter().map(control_task).collect(),
        displayed: readouts.chain(traces).chain(plotted).chain(named).collect(),
    }
}

fn control_task(c: &Control) -> ControlTask {
    let label = c.label.value.clone();
    let (value, action) = match &c.kind {
        ControlKind::Button { run } => return ControlTask::Button { label, run: run.value.clone() },
        ControlKind::Slider { value, action, .. } => (value.value.into(), action),
        ControlKind::Select { value, action, .. } => (plain(&scalar(value)), action),
    };
    ControlTask::Setting {
        label,
        value,
        set: code(action.set.as_ref()),
        apply: code(action.apply.as_ref()),
        param: code(action.param.as_ref()),
        init: action.init,
        reset: action.reset,
    }
}
