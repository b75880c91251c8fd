//! Statements that write the state and then read values derived from it. Running the lab with an `mj_forward` between them shows
//! whether the difference is visible.

use crate::bind::{Bound, ControlProgram, Programs, include};
use crate::check::choices::choices;
use crate::check::observations::{Move, ObservationBench, ObservedLab};
use crate::check::setconst;
use crate::run::Cell;
use crate::spec::Lab;
use labspec_core::AccessSet;
use labspec_core::reflect::{FieldId, FieldSet, Kind, Object};
use labspec_expr::{Type, Value};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Statements write the state, then read values that are computed from the old state.
pub const STALE_READ: &Rule = &Rule {
    code: "stale-read",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "statements write the state, then read values that are computed from the old state",
    why: "`mj_forward` and a step compute world positions, sensors, contacts and forces from `qpos` and `qvel`; after a write they still belong to the old state",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "⟦data.qpos[2] = 0.5; ctx.start = data.xpos[5]⟧", "stopAt": 0.2, "readouts": [{"label": "starts at", "expr": "ctx.start"}, {"label": "height", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "data.qpos[2] = 0.5; mj.mj_forward(model, data); ctx.start = data.xpos[5]", "stopAt": 0.2, "readouts": [{"label": "starts at", "expr": "ctx.start"}, {"label": "height", "expr": "data.qpos[2]"}]}"#,
    ),
};

/// The number of steps of the compared runs.
const STEPS: usize = 200;
/// The smallest visible difference, as a fraction of the range of a curve.
const VISIBLE_FRACTION: f64 = 1e-3;
const FORWARD: &str = "mj.mj_forward(model, data)";

/// The place of a program in a lab.
#[derive(Clone, Copy)]
enum ProgramSite {
    Setup,
    Control(usize),
}

pub(crate) fn check_stale_reads(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let programs = &ready.programs;
    let controls = programs.controls.iter().enumerate().filter_map(|(i, (_, c))| {
        let (run, given) = match c {
            ControlProgram::Press(run) => (run, None),
            ControlProgram::Change(Value::Number(_), action) => (&action.run, Some(Type::Number)),
            ControlProgram::Change(_, action) => (&action.run, Some(Type::Any)),
        };
        Some((ProgramSite::Control(i), run.as_ref()?, given))
    });
    let setup = programs.setup.iter().map(|b| (ProgramSite::Setup, b, None));
    for (place, bound, given) in setup.chain(controls) {
        let Some(text) = reads_after_write(bound).then(|| with_forward(&bound.text.value)).flatten() else {
            continue;
        };
        let Some(amended) = lab_with_statements(observed, place, bound, &text, given) else { continue };
        if let Some(description) = first_visible_difference(observed, place, &amended) {
            findings.push(
                Finding::warning(
                    STALE_READ,
                    bound.text.span(),
                    "this reads a value that still belongs to the old state",
                )
                .why(description)
                .help(format!("call `{FORWARD}` between the write and the read; a test run confirms it")),
            );
        }
    }
}

/// Whether a program writes the state and then reads derived values.
fn reads_after_write(bound: &Bound) -> bool {
    let is = |a: &labspec_expr::Access, kinds: &[Kind]| {
        FieldId::new(a.field.0 as usize)
            .is_some_and(|f| f.info().object == Object::Data && kinds.contains(&f.info().kind))
    };
    let effects = bound.program.effects();
    effects.reads.iter().any(|a| is(a, &[Kind::Derived]))
        && bound.program.own_writes().iter().any(|a| is(a, &[Kind::State, Kind::Input]))
}

/// The top-level statements of a text. `None` if there are comments between them.
pub(super) fn parts(text: &str) -> Option<Vec<String>> {
    let mut depth = 0_i32;
    let mut quote = None;
    let mut parts = vec![String::new()];
    for c in text.chars() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (None, '\'' | '"' | '`') => quote = Some(c),
            (None, '(' | '[' | '{') => depth += 1,
            (None, ')' | ']' | '}') => depth -= 1,
            _ => {}
        }
        if c == ';' && depth == 0 && quote.is_none() {
            parts.push(String::new());
        } else if let Some(last) = parts.last_mut() {
            last.push(c);
        }
    }
    (!text.contains("//") && !text.contains("/*")).then_some(parts)
}

/// The statements with an `mj_forward` after each one that writes the state. `None` if the text does not show which do.
fn with_forward(text: &str) -> Option<String> {
    let parts = parts(text)?;
    let writes = |part: &str| {
        let part = part.trim();
        let state = ["data.qpos", "data.qvel", "data.mocap_", "data.act[", "data.joint("];
        state.iter().any(|s| part.starts_with(s))
            && (part.contains('=') || part.contains(".set(") || part.contains(".fill("))
    };
    let last = parts.len() - 1;
    if !parts.iter().take(last).any(|p| writes(p)) {
        return None;
    }
    let all: Vec<String> =
        parts.iter().map(|p| if writes(p) { format!("{p}; {FORWARD}") } else { p.clone() }).collect();
    Some(all.join(";"))
}

/// The lab with other statements at a place.
fn lab_with_statements(
    observed: &ObservedLab<'_>,
    place: ProgramSite,
    bound: &Bound,
    text: &str,
    given: Option<Type>,
) -> Option<Programs> {
    let ready = observed.bench.ready;
    let bench = setconst::SetConstBench::new(ready.lab, &ready.model, &ready.programs);
    let bound = bench.compile(&bound.text, text, given)?;
    let mut programs = ready.programs.clone();
    match place {
        ProgramSite::Setup => programs.setup = Some(bound),
        ProgramSite::Control(i) => match programs.controls.get_mut(i).map(|(_, c)| c) {
            Some(ControlProgram::Change(_, action)) => action.run = Some(bound),
            Some(ControlProgram::Press(run)) => *run = Some(bound),
            None => return None,
        },
    }
    let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
    programs.bound().for_each(|b| include(b.program.effects(), &mut access));
    programs.access = access;
    Some(programs)
}

/// The actions of a student that execute a program, with descriptions.
fn trials(lab: &Lab, place: ProgramSite) -> Vec<(Vec<Move>, String)> {
    let mut all = vec![(Vec::new(), "as the lab stands".to_string())];
    let ProgramSite::Control(i) = place else { return all };
    let Some(control) = lab.controls.get(i) else { return all };
    let label = &control.label.value;
    let values = choices(control);
    if values.is_empty() {
        all = vec![(
            vec![Move { step: STEPS / 4, control: i, value: None }],
            format!("after \"{label}\" is pressed"),
        )];
    }
    for value in values {
        let description = format!("with \"{label}\" at {value}");
        all.push((vec![Move { step: STEPS / 4, control: i, value: Some(value) }], description));
    }
    all
}

/// Describes the first visible difference.
fn first_visible_difference(
    observed: &mut ObservedLab<'_>,
    place: ProgramSite,
    amended: &Programs,
) -> Option<String> {
    let ready = observed.bench.ready;
    for (moves, description) in trials(ready.lab, place) {
        let with_move = observed.bench.run(&moves, STEPS)?;
        let mut other = ObservationBench { ready, programs: amended, left: observed.bench.left, runs: 0 };
        let anew = other.run(&moves, STEPS)?;
        observed.bench.left = other.left;
        for (c, probe) in ready.programs.probes.iter().enumerate() {
            let cells = || {
                with_move
                    .rows
                    .iter()
                    .zip(&anew.rows)
                    .filter_map(|(a, b)| Some((a.first()?, a.get(c + 1)?, b.get(c + 1)?)))
            };
            let numbers = cells().flat_map(|(_, a, b)| [a.number(), b.number()]).filter(|x| x.is_finite());
            let (low, high) =
                numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            let readout = c.checked_sub(ready.lab.traces().count()).and_then(|i| ready.lab.readouts.get(i));
            let differ = |a: &Cell, b: &Cell| match readout {
                Some(r) => {
                    a.rounded(r.digits()) != b.rounded(r.digits())
                        && (a.number() - b.number()).abs() > 1e-9 * high.abs().max(low.abs())
                }
                None => (a.number() - b.number()).abs() > VISIBLE_FRACTION * (high - low),
            };
            if let Some((time, a, b)) = cells().find(|(_, a, b)| differ(a, b)) {
                let name = probe.name.splitn(3, '/').last().unwrap_or("");
                let [a, b] = [a, b].map(|x| setconst::digits(x.number(), 5));
                return Some(format!(
                    "{description}, \"{name}\" is {a} at t = {} s, but {b} with `{FORWARD}` after the write",
                    setconst::digits(time.number(), 4)
                ));
            }
        }
    }
    None
}
