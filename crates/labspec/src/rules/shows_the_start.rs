use crate::check::observations::{Move, ObservedLab, same, single_moves};
use crate::check::setconst::digits;
use crate::run::{self, Cell, Play};
use labspec_core::reflect::{FieldId, Object};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::ControlFlow;

/// A readout shows the initial value of a coordinate that moves.
pub const SHOWS_THE_START: &Rule = &Rule {
    code: "shows-the-start",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a readout shows the initial value of a coordinate that moves",
    why: "`model.qpos0` holds the initial coordinates and never changes; `data.qpos` holds the current ones. The rule reports it if the coordinate moves in a run and the label does not mention the start",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "⟦model.qpos0[2]⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}, {"label": "height at the start (m)", "expr": "model.qpos0[2]"}]}"#,
    ),
};

/// Fields with the initial coordinates.
const STARTS: [&str; 2] = ["qpos0", "key_qpos"];
/// Prefixes of words by which a label states that it shows the start, and complete words.
const START_PREFIXES: [&str; 6] = ["start", "begin", "initial", "referen", "nominal", "origin"];
const START_WORDS: [&str; 7] = ["rest", "zero", "home", "neutral", "first", "key", "0"];
/// The number of steps of the observed runs.
const STEPS: usize = 500;
/// The minimum displacement that counts as motion, m or rad.
const MIN_MOTION: f64 = 1e-6;

pub(crate) fn check_beginning(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let traces = ready.lab.traces().count();
    for (i, readout) in ready.lab.readouts.iter().enumerate() {
        let label = readout.label.as_str().to_lowercase();
        let Some(bound) = ready.programs.probes.get(traces + i).and_then(|p| p.bound.as_ref()) else {
            continue;
        };
        let effects = bound.program.effects();
        let more = effects.reads_everything
            || effects.any_ctx
            || effects.calls_values
            || !effects.ctx_reads.is_empty();
        let fields =
            || effects.reads.iter().filter_map(|a| Some((FieldId::new(a.field.0 as usize)?.info(), a)));
        let live = fields().any(|(f, _)| f.object == Object::Data);
        let start = fields().find(|(f, a)| STARTS.contains(&f.name) && a.count == Some(1));
        let (Some((field, access)), false) = (start, more || live || mentions_start(&label)) else {
            continue;
        };
        let column =
            || observed.records.iter().flat_map(|r| &r.rows).filter_map(|row| row.get(1 + traces + i));
        let Some(first_cell) = column().next().filter(|c| matches!(c, Cell::Number(_))) else { continue };
        let coordinate = access.first % ready.model.nq.max(1);
        if !column().all(|c| same(c, first_cell)) {
            continue;
        }
        let Some((from, to, done)) = moves(observed, coordinate) else { continue };
        let [first_cell, from, to] = [first_cell.number(), from, to].map(|x| digits(x, 4));
        findings.push(
            Finding::warning(
                SHOWS_THE_START,
                readout.expr.span(),
                format!(
                    "\"{}\" shows the initial value of a coordinate, not the current one",
                    readout.label.as_str()
                ),
            )
            .why(format!(
                "it is {first_cell} in every run, but {done} `data.qpos[{coordinate}]` goes from {from} to {to}"
            ))
            .help(format!(
                "read `data.qpos` for the current value: `model.{}` holds the initial one",
                field.name
            )),
        );
    }
}

/// Whether a label states that it shows the start.
fn mentions_start(label: &str) -> bool {
    let mut words = label.split(|c: char| !c.is_alphanumeric());
    words.any(|w| {
        START_PREFIXES.iter().any(|b| w.starts_with(b)) || START_WORDS.contains(&w) || w.ends_with(['0', '₀'])
    })
}

/// The first run in which a coordinate moves: the initial and final value, and the action.
fn moves(observed: &ObservedLab<'_>, coordinate: usize) -> Option<(f64, f64, String)> {
    single_moves(observed.bench.ready.lab).into_iter().find_map(|(done, description)| {
        let mut session = observed.bench.start();
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        run::play(&mut session, &Play { every: 5, ..Play::steps(STEPS) }, |session, step| {
            match &done {
                Some(Move { control, value: Some(value), .. }) if step == 0 => {
                    session.set_control(*control, value.clone());
                }
                Some(Move { control, value: None, .. }) if step == 5 => session.press(*control),
                _ => {}
            }
            let x = session.world.data.fields().qpos.get(coordinate).copied().unwrap_or(f64::NAN);
            (low, high) = (low.min(x), high.max(x));
            ControlFlow::Continue(())
        });
        (session.ended().is_none() && high - low > MIN_MOTION).then_some((low, high, description))
    })
}
