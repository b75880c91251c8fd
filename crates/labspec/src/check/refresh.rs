//! Masses and inertias that change without `mj_setConst`: whether it shows, and what to write instead, both by running.
//!
//! Constants follow from masses (subtree masses, inverse weights of contacts) and keep their old value until
//! `mj_setConst`, which also puts qpos back to the model's own. So a lab is run as it is, and with the constants
//! computed anew and the state kept; where nothing visible differs, nothing is said. The advice is run too.

use super::programs::choices;
use crate::bind::{Bound, ControlProgram, ModelNames, Programs, Scope, functions, include, warning, writes_kind};
use crate::finding::Finding;
use crate::run::{self, Breakdown, Cell, Session, settings};
use crate::source::Text;
use crate::spec::{ControlKind, Lab, Run, Verify};
use labspec_core::reflect::{FieldId, FieldSet, Kind, Object};
use labspec_core::{Demand, Model};
use labspec_expr::{Compiler, Type, Value};

/// Most steps of one of these runs.
const STEPS: usize = 2_000;
/// Most steps of all runs of one lab.
const ALL_STEPS: usize = 200_000;
/// Most runs that show one program.
const MOST_TRIALS: usize = 12;
/// A difference that cannot be seen, of the range of a trace.
const VISIBLE: f64 = 1e-9;
/// A difference that rounding makes, of the largest value.
const ROUNDING: f64 = 1e-12;

/// Where a program stands.
#[derive(Clone, Copy)]
enum Place<'a> {
    Setup,
    Controller,
    Control(usize),
    /// The setup of a run of a `verify` object.
    Run(&'a Run),
}

/// What a student does at a step.
#[derive(Clone)]
enum Move {
    Set(usize, Value),
    Press(usize),
}

/// One run: what is done, and how a message calls it.
struct Trial {
    moves: Vec<(usize, Move)>,
    said: String,
}

/// A program that changes what constants follow from.
struct Suspect<'a> {
    place: Place<'a>,
    bound: &'a Bound,
    field: FieldId,
    /// It calls mj_setConst, and writes behind it.
    late: bool,
    /// Its text is the target of a `set`.
    target: bool,
    /// The type of `value` in it.
    given: Option<Type>,
}

/// What stands behind the statements of a suspect.
#[derive(Clone, Copy, PartialEq)]
enum Advice {
    /// mj_setConst alone: for a lab whose qpos is the model's own then, or that is reset at once.
    Plain,
    /// mj_setConst with qpos kept.
    Keep,
}

impl Advice {
    fn statements(self, text: &str) -> String {
        let name = ["q", "kept", "qpos_kept"].into_iter().find(|n| !text.contains(n)).unwrap_or("qpos_as_it_was");
        match self {
            Advice::Plain => "mj.mj_setConst(model, data)".into(),
            Advice::Keep => {
                format!("const {name} = data.qpos.slice(); mj.mj_setConst(model, data); data.qpos.set({name})")
            }
        }
    }

    /// What is written behind a text.
    fn tail(self, text: &str) -> String {
        let last_line = text.lines().last().unwrap_or("");
        let between = match text.trim_end() {
            _ if last_line.contains("//") => "\n",
            t if t.ends_with(';') => " ",
            _ => "; ",
        };
        format!("{between}{}", self.statements(text))
    }
}

/// Checks the programs of a lab.
pub(super) fn check(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let own = [(Place::Setup, &programs.setup), (Place::Controller, &programs.controller)];
    let mut all: Vec<Suspect<'_>> =
        own.into_iter().filter_map(|(place, b)| suspect(place, b.as_ref()?, false, None)).collect();
    for (i, ((_, program), control)) in programs.controls.iter().zip(&lab.controls).enumerate() {
        let (bound, given) = match program {
            ControlProgram::Press(run) => (run.as_ref(), None),
            ControlProgram::Change(Value::Number(_), action) => (action.run.as_ref(), Some(Type::Number)),
            ControlProgram::Change(_, action) => (action.run.as_ref(), Some(Type::Any)),
        };
        let target = |b: &Bound| control.action().and_then(|a| a.set.as_ref()).is_some_and(|set| *set == b.text);
        all.extend(bound.and_then(|b| suspect(Place::Control(i), b, target(b), given)));
    }
    let mut bench = Bench { lab, model, programs, steps_left: ALL_STEPS };
    findings.extend(all.iter().filter_map(|s| bench.judge(s)));
}

/// Checks the setups of the runs of a `verify` object, as `check` does those of the lab.
pub(super) fn check_runs(
    verify: &Verify,
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    findings: &mut Vec<Finding>,
) {
    let mut bench = Bench { lab, model, programs, steps_left: ALL_STEPS };
    for run in &verify.runs {
        let bound = run.setup.as_ref().and_then(|text| bench.compile(text, &text.value, None));
        let found = bound.and_then(|b| suspect(Place::Run(run), &b, false, None).and_then(|s| bench.judge(&s)));
        findings.extend(found);
    }
}

fn suspect<'a>(place: Place<'a>, bound: &'a Bound, target: bool, given: Option<Type>) -> Option<Suspect<'a>> {
    let inertial = |f: &FieldId| f.info().object == Object::Model && f.info().kind == Kind::Inertial;
    let set_const = bound.program.effects().calls.iter().find(|&&f| functions::name(f) == Some("mj_setConst"));
    let (field, late) = match set_const {
        None => (writes_kind(bound, Object::Model, &[Kind::Inertial])?, false),
        Some(&call) => {
            let after = bound.program.writes_after(call)?;
            (after.iter().map(|a| FieldId(a.field.0 as u16)).find(inertial)?, true)
        }
    };
    Some(Suspect { place, bound, field, late, target, given })
}

/// What is run.
struct Bench<'a> {
    lab: &'a Lab,
    model: &'a Model,
    programs: &'a Programs,
    steps_left: usize,
}

/// A run: its samples, or why it says nothing.
type Record = Result<Vec<Vec<Cell>>, String>;

impl Bench<'_> {
    /// The finding, unless nothing visible differs.
    fn judge(&mut self, s: &Suspect<'_>) -> Option<Finding> {
        let name = s.field.info().name;
        let when = if s.late { "after the last" } else { "without" };
        let text = &s.bound.text;
        let finding = warning(
            "missing-setconst",
            text.span(),
            format!("`model.{name}` is changed {when} `mj.mj_setConst(model, data)`"),
        );
        let why = "constants that follow from it (subtree masses, inverse weights of contacts) keep the old value";
        let advised = |advice: Advice| match (s.target, advice) {
            (true, _) => {
                let set = format!("{} = value; {}", text.value, advice.statements(&text.value));
                format!("instead of \"set\", write \"apply\": {}", serde_json::Value::from(set))
            }
            (false, _) => format!("add `{}`", advice.tail(&text.value).replace('\n', " ").trim()),
        };
        match self.compare(s) {
            Ok(None) => None,
            Ok(Some((evidence, advice))) => {
                let finding = finding.why(format!("{why}: {evidence}"));
                let reason = match advice {
                    Advice::Plain => "; tried, the lab then runs with the right constants",
                    Advice::Keep => "; tried. `mj_setConst` alone would also put qpos back to the model's own, so qpos is kept around it",
                };
                let finding = finding.help(format!("{}{reason}", advised(advice)));
                if s.target {
                    return Some(finding);
                }
                let end = text.span().end;
                let tail = serde_json::Value::from(advice.tail(&text.value)).to_string();
                Some(finding.fix(end..end, tail.trim_matches('"')))
            }
            Err(reason) => Some(
                finding
                    .why(format!("{why}: a heavier ball then sinks deeper into the floor than any real one"))
                    .help(format!(
                        "{}, which keeps qpos; whether it shows in this lab could not be tried: {reason}",
                        advised(Advice::Keep)
                    )),
            ),
        }
    }

    /// What differs, in words, and the advice that was run; `Err` says why it could not be tried.
    fn compare(&mut self, s: &Suspect<'_>) -> Result<Option<(String, Advice)>, String> {
        let refreshed = self.amended(s, Advice::Keep).ok_or("the statements cannot be amended")?;
        let steps = self.steps(s)?;
        let trials = self.trials(s, steps);
        let mut untried = None;
        let mut found = None;
        let mut kept = Vec::new();
        for (i, trial) in trials.iter().enumerate() {
            let records = self.record(s, None, trial, steps).and_then(|a| {
                let b = self.record(s, Some(&refreshed), trial, steps)?;
                Ok((a, b))
            });
            match records {
                Ok((as_is, anew)) => {
                    if found.is_none() {
                        found = self.difference(&as_is, &anew).map(|d| d.said(&trial.said));
                    }
                    kept.push((i, anew));
                }
                Err(reason) => untried = untried.or(Some(format!("{}, {reason}", trial.said))),
            }
        }
        let Some(evidence) = found else { return untried.map_or(Ok(None), Err) };
        let plain = self.amended(s, Advice::Plain);
        let mut gives_the_same = |program: &Amended| {
            kept.iter().all(|(i, anew)| {
                let again = trials.get(*i).map(|trial| self.record(s, Some(program), trial, steps));
                again.is_some_and(|r| r.is_ok_and(|r| self.difference(anew, &r).is_none()))
            })
        };
        let advice = if plain.as_ref().is_some_and(&mut gives_the_same) { Advice::Plain } else { Advice::Keep };
        Ok(Some((evidence, advice)))
    }

    /// Number of steps of the lab, or of the run of a question, within bounds.
    fn steps(&self, s: &Suspect<'_>) -> Result<usize, String> {
        let session = Session::start(self.programs, self.model, self.lab.keyframe(), &self.programs.demand);
        let timestep = session.world.model.opt.timestep;
        let (until, steps) = match s.place {
            Place::Run(run) => {
                (run.until.as_ref().map(|n| n.value), run.steps.as_ref().map(|n| n.value.max(0.0) as usize))
            }
            _ => (None, None),
        };
        run::count_steps(self.lab, until, steps, timestep).map(|n| n.min(STEPS)).map_err(|e| e.0)
    }

    /// The runs that could show it.
    fn trials(&self, s: &Suspect<'_>, steps: usize) -> Vec<Trial> {
        let mut all = vec![Trial { moves: Vec::new(), said: "as it stands".into() }];
        let half = steps / 2;
        let mut add = |at: usize, index: usize, value: Option<Value>| {
            let label = self.lab.controls.get(index).map_or("", |c| c.label.as_str());
            let later = if at > 0 { " in mid-run" } else { "" };
            let said = match &value {
                Some(value) => format!("with \"{label}\" at {value}{later}"),
                None => format!("after \"{label}\" is pressed{later}"),
            };
            let what = value.map_or(Move::Press(index), |v| Move::Set(index, v));
            all.push(Trial { moves: vec![(at, what)], said });
        };
        match s.place {
            Place::Run(run) => return vec![self.as_asked(run)],
            Place::Control(own) => {
                let Some(control) = self.lab.controls.get(own) else { return all };
                let values = choices(control);
                if let ControlKind::Button { .. } = control.kind {
                    add(0, own, None);
                    add(half, own, None);
                }
                for value in &values {
                    add(0, own, Some(value.clone()));
                }
                if let ControlKind::Slider { min, max, .. } = &control.kind {
                    let step = control.step().unwrap_or(0.0);
                    let middle = min.value + (0.5 * (max.value - min.value) / step).round() * step;
                    if middle.is_finite() {
                        add(0, own, Some(Value::Number(middle)));
                    }
                }
                for value in &values {
                    add(half, own, Some(value.clone()));
                }
            }
            // What other controls choose may be what it writes.
            Place::Setup | Place::Controller => {
                for (i, control) in self.lab.controls.iter().enumerate() {
                    choices(control).into_iter().for_each(|value| add(0, i, Some(value)));
                }
            }
        }
        all.truncate(MOST_TRIALS);
        all
    }

    /// The run of a question: its settings, then its setup, then its presses.
    fn as_asked(&self, run: &Run) -> Trial {
        let index = |label: &Text| self.lab.controls.iter().position(|c| c.label.value == label.value);
        let set = run.set.iter().filter_map(|(label, value)| {
            let i = index(label)?;
            let value = settings::value(self.lab.controls.get(i)?, &crate::bind::scalar(value)).ok()?;
            Some((0, Move::Set(i, value)))
        });
        let timestep = self.model.opt.timestep;
        let press = run.press.iter().filter_map(|(label, time)| {
            Some(((time.value / timestep).ceil().max(0.0) as usize, Move::Press(index(label)?)))
        });
        Trial { moves: set.chain(press).collect(), said: format!("in the run `{}`", run.name.value) }
    }

    /// Makes a run, as it is or amended, sampled after every step.
    fn record(&mut self, s: &Suspect<'_>, amended: Option<&Amended>, trial: &Trial, steps: usize) -> Record {
        self.steps_left = self.steps_left.checked_sub(steps.max(1)).ok_or("it takes too many runs")?;
        let programs = amended.map_or(self.programs, |a| &a.programs);
        let setup = match s.place {
            Place::Run(_) => Some(amended.map_or(s.bound, |a| &a.bound)),
            _ => None,
        };
        let mut demand = programs.demand;
        setup.into_iter().for_each(|b| include(b.program.effects(), &mut demand));
        let whole = matches!(s.place, Place::Run(_)) || programs.probes.is_empty();
        let mut session = Session::start(programs, self.model, self.lab.keyframe(), &demand);
        let sets = |m: &Move| matches!(m, Move::Set(..));
        let mut rows = Vec::with_capacity(steps + 1);
        for step in 0..=steps {
            let mut due: Vec<&Move> = trial.moves.iter().filter(|(at, _)| *at == step).map(|(_, m)| m).collect();
            due.sort_by_key(|m| !sets(m));
            let (set, press): (Vec<&Move>, Vec<&Move>) = due.into_iter().partition(|m| sets(m));
            set.into_iter().for_each(|m| act(&mut session, m));
            if let Some(bound) = setup.filter(|_| step == 0) {
                session.run_statements(&bound.program, &bound.text);
            }
            press.into_iter().for_each(|m| act(&mut session, m));
            let mut row = session.sample();
            if whole {
                row.extend(session.world.data.qpos.iter().map(|q| Cell::Number(*q)));
            }
            rows.push(row);
            if step < steps {
                session.step();
            }
        }
        let probe = |t: &Text| programs.probes.iter().any(|p| p.bound.as_ref().is_some_and(|b| b.text == *t));
        if let Some(trouble) = session.troubles.iter().find(|t| !probe(&t.text)) {
            return Err(format!("its statements fail: {}", trouble.message));
        }
        match Breakdown::of(&session) {
            Some(broken) => Err(format!("the simulation breaks: {}", broken.what)),
            None => Ok(rows),
        }
    }

    /// The lab with what is advised behind the statements.
    fn amended(&self, s: &Suspect<'_>, advice: Advice) -> Option<Amended> {
        let text = &s.bound.text.value;
        let source = if s.target { format!("{text} = value") } else { text.clone() };
        let bound = self.compile(&s.bound.text, &format!("{source}{}", advice.tail(&source)), s.given)?;
        let mut programs = self.programs.clone();
        match s.place {
            Place::Setup => programs.setup = Some(bound.clone()),
            Place::Controller => programs.controller = Some(bound.clone()),
            Place::Control(i) => match programs.controls.get_mut(i).map(|(_, c)| c) {
                Some(ControlProgram::Change(_, action)) => action.run = Some(bound.clone()),
                Some(ControlProgram::Press(run)) => *run = Some(bound.clone()),
                None => return None,
            },
            Place::Run(_) => {}
        }
        let mut demand = Demand { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
        programs.bound().for_each(|b| include(b.program.effects(), &mut demand));
        programs.demand = demand;
        Some(Amended { programs, bound })
    }

    /// Statements of the lab, with the place of the text that they stand for.
    fn compile(&self, place: &Text, source: &str, given: Option<Type>) -> Option<Bound> {
        let names = ModelNames { model: self.model, scope: Scope::Lab };
        let mut globals = self.programs.globals.clone();
        let mut compiler = Compiler::new(&names, &mut globals);
        compiler.value = given;
        let program = compiler.statements(source).program?;
        Some(Bound { text: place.clone(), program })
    }

    /// The largest visible difference of two runs.
    fn difference(&self, a: &[Vec<Cell>], b: &[Vec<Cell>]) -> Option<Difference> {
        let width = a.first().map_or(0, Vec::len);
        let mut worst: Option<(f64, Difference)> = None;
        for column in 1..width {
            let cells = || a.iter().zip(b).filter_map(|(x, y)| Some((x.first()?, x.get(column)?, y.get(column)?)));
            let numbers = cells().flat_map(|(_, x, y)| [x.number(), y.number()]).filter(|x| x.is_finite());
            let (low, high) =
                numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            let (range, largest) = (high - low, low.abs().max(high.abs()));
            for (time, x, y) in cells() {
                let Some(size) = self.visible(column, x, y, range, largest) else { continue };
                if worst.as_ref().is_none_or(|(most, _)| size > *most) {
                    let name = self.column(column);
                    worst = Some((size, Difference { name, time: time.number(), cells: (x.clone(), y.clone()) }));
                }
            }
        }
        worst.map(|(_, d)| d)
    }

    /// How much of the range two samples differ by; `None` when nobody can see it.
    fn visible(&self, column: usize, x: &Cell, y: &Cell, range: f64, largest: f64) -> Option<f64> {
        let (Cell::Number(p), Cell::Number(q)) = (x, y) else { return (x != y).then_some(1.0) };
        if !(p.is_finite() && q.is_finite()) {
            return (p.to_bits() != q.to_bits() && !(p.is_nan() && q.is_nan())).then_some(1.0);
        }
        let apart = (p - q).abs();
        let readout = column.checked_sub(1 + self.lab.traces().count()).and_then(|i| self.lab.readouts.get(i));
        let printed = readout.is_some_and(|r| run::shown(*p, r.digits()) != run::shown(*q, r.digits()));
        let seen = apart > VISIBLE * range || printed;
        (seen && apart > ROUNDING * largest).then_some(apart / range)
    }

    /// What a column is called.
    fn column(&self, column: usize) -> String {
        match self.programs.probes.get(column - 1) {
            Some(probe) => format!("\"{}\"", probe.name.splitn(3, '/').last().unwrap_or("")),
            None => format!("data.qpos[{}]", column - 1 - self.programs.probes.len()),
        }
    }
}

/// A lab with other statements.
struct Amended {
    programs: Programs,
    bound: Bound,
}

fn act(session: &mut Session<'_>, what: &Move) {
    match what {
        Move::Set(i, value) => session.set_control(*i, value.clone()),
        Move::Press(i) => session.press(*i),
    }
}

/// A sample that differs between the lab as it is and with its constants computed anew.
struct Difference {
    name: String,
    time: f64,
    cells: (Cell, Cell),
}

impl Difference {
    fn said(&self, trial: &str) -> String {
        let (x, y) = match &self.cells {
            (Cell::Number(x), Cell::Number(y)) => {
                // As many digits as tell them apart.
                let shown = |n| (digits(*x, n), digits(*y, n));
                (4..17).map(shown).find(|(a, b)| a != b).unwrap_or_else(|| shown(17))
            }
            (x, y) => (x.shown(4), y.shown(4)),
        };
        format!("{trial}, {} is {x} at t = {} s, and {y} with the constants computed anew", self.name, digits(self.time, 6))
    }
}

/// A number with so many significant digits, without trailing zeros.
pub(super) fn digits(x: f64, count: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", count.saturating_sub(1)).parse().unwrap_or(x);
    Value::Number(rounded).to_string()
}
