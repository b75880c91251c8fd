//! Runs of a lab, unchanged and with amended programs: the tested interactions and their samples.

use super::difference::RunColumns;
use super::{ProgramSite, SuspectProgram};
use crate::bind::coupled::{self, Coupled, PairSet};
use crate::bind::{Bound, ControlProgram, ModelNames, Programs, Scope, include};
use crate::check::choices::choices;
use crate::run::{self, Cell, Play, Session, Start, StepVariant, settings};
use crate::source::Text;
use crate::spec::{Control, ControlKind, Lab, Run, Verify};
use labspec_core::reflect::FieldSet;
use labspec_core::{AccessSet, Model, Plan};
use labspec_expr::{Access, Compiler, Effects, Type, Value};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::ControlFlow;

/// Maximum number of steps of one of these runs.
const STEPS: usize = 2_000;
/// Work budget of all runs of one lab, in steps of a scene with one coordinate.
const WORK: usize = 4_000_000;
/// Maximum number of cells of one run.
const CELLS: usize = 200_000;
/// Maximum length of a text that is compared literally.
const MAX_COMPARED_TEXT: usize = 64;
/// Maximum number of runs for one program.
const MOST_TRIALS: usize = 12;

/// Maximum number of additional runs with another control moved.
const MOST_COMBINED: usize = 24;

/// An interaction at a step.
#[derive(Clone)]
enum Move {
    Set(usize, Value),
    Press(usize),
}

/// One run: its interactions, and their description for messages.
pub(super) struct BenchTrial {
    moves: Vec<(usize, Move)>,
    pub(super) description: String,
}

/// A lab with the remaining work budget.
pub(crate) struct SetConstBench<'a> {
    lab: &'a Lab,
    model: &'a Model,
    programs: &'a Programs,
    work_left: usize,
}

/// The samples of a run.
pub(super) type SampleRows = Vec<Vec<Cell>>;

/// The samples of a run, or the reason why it has none.
pub(super) type Record = Result<SampleRows, String>;

impl<'a> SetConstBench<'a> {
    pub(crate) fn new(lab: &'a Lab, model: &'a Model, programs: &'a Programs) -> SetConstBench<'a> {
        SetConstBench { lab, model, programs, work_left: WORK }
    }

    /// The columns of the samples of its runs.
    pub(super) fn columns(&self, s: &SuspectProgram<'_>) -> RunColumns<'a> {
        let whole = matches!(s.place, ProgramSite::Run(_)) || self.programs.probes.is_empty();
        RunColumns { whole, lab: self.lab, programs: self.programs }
    }

    /// The model of the lab.
    pub(super) fn model(&self) -> &'a Model {
        self.model
    }

    /// The programs of the lab.
    pub(super) fn programs(&self) -> &'a Programs {
        self.programs
    }

    /// Number of steps of the lab, or of the run of a question, limited to `STEPS`.
    pub(super) fn steps(&self, s: &SuspectProgram<'_>) -> Result<usize, String> {
        let session = Session::start(self.programs, self.model, Start::of_lab(self.lab));
        let timestep = session.world.model.opt.timestep;
        let (until, steps) = match s.place {
            ProgramSite::Run(run) => {
                (run.until.as_ref().map(|n| n.value), run.steps.as_ref().map(|n| n.value.max(0.0) as usize))
            }
            _ => (None, None),
        };
        run::count_steps(self.lab, until, steps, timestep).map(|n| n.min(STEPS)).map_err(|e| e.message)
    }

    /// The runs that could show the effect of a program.
    pub(super) fn trials(&self, s: &SuspectProgram<'_>, steps: usize) -> Vec<BenchTrial> {
        let mut all = vec![BenchTrial { moves: Vec::new(), description: "as it stands".into() }];
        let half = steps / 2;
        let mut add = |first_step: usize, index: usize, value: Option<Value>| {
            let label = self.lab.controls.get(index).map_or("", |c| c.label.as_str());
            let later = if first_step > 0 { " in mid-run" } else { "" };
            let description = match &value {
                Some(value) => format!("with \"{label}\" at {value}{later}"),
                None => format!("after \"{label}\" is pressed{later}"),
            };
            let what = value.map_or(Move::Press(index), |v| Move::Set(index, v));
            all.push(BenchTrial { moves: vec![(first_step, what)], description });
        };
        match s.place {
            ProgramSite::Run(run) => return vec![self.run_of_question(run)],
            ProgramSite::Control(nominal) => {
                let Some(control) = self.lab.controls.get(nominal) else { return all };
                let values = choices(control);
                if let ControlKind::Button { .. } = control.kind {
                    add(0, nominal, None);
                    add(half, nominal, None);
                }
                for value in &values {
                    add(0, nominal, Some(value.clone()));
                }
                if let ControlKind::Slider { min, max, .. } = &control.kind {
                    let step = control.step().unwrap_or(0.0);
                    let middle = min.value + (0.5 * (max.value - min.value) / step).round() * step;
                    if middle.is_finite() {
                        add(0, nominal, Some(Value::Number(middle)));
                    }
                }
                for value in &values {
                    add(half, nominal, Some(value.clone()));
                }
            }
            // The program may write values that other controls determine.
            ProgramSite::Setup | ProgramSite::Controller => {
                for (i, control) in self.lab.controls.iter().enumerate() {
                    choices(control).into_iter().for_each(|value| add(0, i, Some(value)));
                }
            }
        }
        all.truncate(MOST_TRIALS);
        all
    }

    /// Whether a program reads values that another control of the lab writes: variables, or fields if it calls no function
    /// that reads all of them.
    pub(super) fn reads_of_others(&self, s: &SuspectProgram<'_>) -> bool {
        let effects = s.bound.program.effects();
        let written = |e: &Effects| {
            let field = |a: &Access| e.writes.iter().any(|w| w.field == a.field);
            effects.calls.is_empty() && effects.reads.iter().any(field)
        };
        let others = self.programs.controls.iter().filter_map(|(_, program)| match program {
            ControlProgram::Change(_, action) => action.run.as_ref(),
            ControlProgram::Press(run) => run.as_ref(),
        });
        let mut others = others.filter(|other| other.text != s.bound.text);
        let variables = effects.any_ctx || !effects.ctx_reads.is_empty();
        variables || effects.calls_values || others.any(|o| written(o.program.effects()))
    }

    /// Runs with another control at its ends: a ball may roll only if a ramp is tilted.
    pub(super) fn combined(&self, s: &SuspectProgram<'_>) -> Vec<BenchTrial> {
        let ProgramSite::Control(nominal) = s.place else { return Vec::new() };
        let Some(control) = self.lab.controls.get(nominal) else { return Vec::new() };
        let moves = |index: usize, control: &Control| -> Vec<(Move, String)> {
            let label = control.label.as_str();
            match control.kind {
                ControlKind::Button { .. } => {
                    vec![(Move::Press(index), format!("after \"{label}\" is pressed"))]
                }
                _ => {
                    let trial = |v: Value| (Move::Set(index, v.clone()), format!("with \"{label}\" at {v}"));
                    choices(control).into_iter().map(trial).collect()
                }
            }
        };
        let mut all = Vec::new();
        for (index, other) in self.lab.controls.iter().enumerate().filter(|(i, _)| *i != nominal) {
            for (other_move, how) in moves(index, other) {
                for (nominal_move, description) in moves(nominal, control) {
                    let description = format!("{description} and {}", how.trim_start_matches("with "));
                    all.push(BenchTrial {
                        moves: vec![(0, other_move.clone()), (0, nominal_move)],
                        description,
                    });
                }
            }
        }
        all.truncate(MOST_COMBINED);
        all
    }

    /// The run of a question: its settings, then its setup, then its presses.
    fn run_of_question(&self, run: &Run) -> BenchTrial {
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
        BenchTrial {
            moves: set.chain(press).collect(),
            description: format!("in the run {}", crate::json::read::named(&run.name.value)),
        }
    }

    /// Makes a run of the unchanged or amended lab, sampled after every step.
    pub(super) fn record(
        &mut self,
        s: &SuspectProgram<'_>,
        amended: Option<&AmendedLab>,
        trial: &BenchTrial,
        steps: usize,
    ) -> Record {
        self.record_under(s, amended, trial, steps, StepVariant::NOMINAL)
    }

    /// Like [`SetConstBench::record`], under perturbed numerics: half the timestep, or a perturbed start.
    pub(super) fn record_under(
        &mut self,
        s: &SuspectProgram<'_>,
        amended: Option<&AmendedLab>,
        trial: &BenchTrial,
        steps: usize,
        numerics: StepVariant,
    ) -> Record {
        let programs = amended.map_or(self.programs, |a| &a.programs);
        let setup = match s.place {
            ProgramSite::Run(_) => Some(amended.map_or(s.bound, |a| &a.bound)),
            _ => None,
        };
        let whole = self.columns(s).whole || !s.pairs.is_empty();
        let run = self.execute_run(programs, setup, whole, trial, steps, numerics)?;
        Ok(run.rows)
    }

    /// Makes a run of a lab that observes coupled parameters. Returns whether a program changed a parameter without them.
    pub(super) fn observe(
        &mut self,
        s: &SuspectProgram<'_>,
        amended: &AmendedLab,
        trial: &BenchTrial,
        steps: usize,
    ) -> Result<(SampleRows, bool), String> {
        let setup = matches!(s.place, ProgramSite::Run(_)).then_some(&amended.bound);
        let whole = self.columns(s).whole || !s.pairs.is_empty();
        let run = self.execute_run(&amended.programs, setup, whole, trial, steps, StepVariant::NOMINAL)?;
        Ok((run.rows, run.has_uncoupled_change))
    }

    /// Makes a run with these programs; `whole` samples all coordinates too.
    fn execute_run(
        &mut self,
        programs: &Programs,
        setup: Option<&Bound>,
        whole: bool,
        trial: &BenchTrial,
        steps: usize,
        numerics: StepVariant,
    ) -> Result<CompletedRun, String> {
        // Half the timestep needs twice the steps, so that events occur at the same time.
        let finer = if numerics.timestep < 1.0 { 2 } else { 1 };
        let steps = steps * finer;
        let mut session = self.start(programs, setup);
        let sets = |m: &Move| matches!(m, Move::Set(..));
        let width = 1 + programs.probes.len() + if whole { self.model.nq } else { 0 };
        let every = (steps / finer + 1).saturating_mul(width).div_ceil(CELLS).max(1) * finer;
        let mut rows = Vec::new();
        let mut too_long = false;
        run::play(&mut session, &Play::steps(steps), |session, step| {
            if step > 0 {
                let (nv, rows) = (self.model.nv, session.world.data.fields().nefc);
                let work = 1 + nv + self.model.ngeom + rows.saturating_mul(nv) / 8;
                let Some(left) = self.work_left.checked_sub(work) else {
                    too_long = true;
                    return ControlFlow::Break(());
                };
                self.work_left = left;
            }
            let due = trial.moves.iter().filter(|(at_step, _)| *at_step * finer == step).map(|(_, m)| m);
            let (set, press): (Vec<&Move>, Vec<&Move>) = due.partition(|m| sets(m));
            let moved = step == 0 || !set.is_empty() || !press.is_empty();
            set.into_iter().for_each(|m| act(session, m));
            if let Some(bound) = setup.filter(|_| step == 0) {
                session.run_statements(&bound.program, &bound.text);
            }
            press.into_iter().for_each(|m| act(session, m));
            if moved && numerics != StepVariant::NOMINAL {
                // A control that resets the lab removes the perturbation of the start.
                session.perturb(numerics, step > 0);
            }
            if step % every == 0 || step == steps {
                let mut row: Vec<Cell> = session.sample().into_iter().map(short).collect();
                if whole {
                    row.extend(session.world.data.fields().qpos.iter().map(|q| Cell::Number(*q)));
                }
                rows.push(row);
            }
            ControlFlow::Continue(())
        });
        if too_long {
            return Err("it takes too long".to_string());
        }
        check_completion(&session, programs)?;
        Ok(CompletedRun { rows, has_uncoupled_change: session.has_uncoupled_change() })
    }

    /// Whether another run of the same object equals the corrected version of this run: then the author shows the
    /// difference intentionally.
    pub(super) fn is_contrasted(
        &mut self,
        s: &SuspectProgram<'_>,
        verify: &Verify,
        anew: &AmendedLab,
    ) -> bool {
        let ProgramSite::Run(nominal) = s.place else { return false };
        let Ok(steps) = self.steps(s) else { return false };
        let trial = self.run_of_question(nominal);
        let Ok(anew) = self.record(s, Some(anew), &trial, steps) else { return false };
        verify.runs.iter().filter(|run| run.name != nominal.name).any(|run| {
            let setup = run.setup.as_ref().map(|text| self.compile(text, &text.value, None));
            let Some(setup) = setup.map_or(Some(None), |bound| bound.map(Some)) else { return false };
            let trial = self.run_of_question(run);
            let other =
                self.execute_run(self.programs, setup.as_ref(), true, &trial, steps, StepVariant::NOMINAL);
            other.is_ok_and(|other| self.columns(s).difference(&anew, &other.rows).is_none())
        })
    }

    /// Whether another run of the same object starts with the parameters, including the coupled ones, of the corrected
    /// version of this run: then the author shows the difference intentionally.
    pub(super) fn paired(&self, s: &SuspectProgram<'_>, verify: &Verify) -> bool {
        let ProgramSite::Run(nominal) = s.place else { return false };
        let right = self.corrected(s, s.pairs);
        let right = self.start_model(&right.programs, Some(&right.bound), nominal);
        if coupled::agree(&self.start_model(self.programs, Some(s.bound), nominal), &right) {
            return false;
        }
        verify.runs.iter().filter(|run| run.name != nominal.name).any(|run| {
            let setup = run.setup.as_ref().and_then(|text| self.compile(text, &text.value, None));
            coupled::agree(&self.start_model(self.programs, setup.as_ref(), run), &right)
        })
    }

    /// The lab with the given programs, for a run with a setup.
    fn start<'p>(&self, programs: &'p Programs, setup: Option<&Bound>) -> Session<'p> {
        let mut access = programs.access;
        setup.into_iter().for_each(|b| include(b.program.effects(), &mut access));
        let plan = Some(Plan::new(self.model, &access));
        Session::start(programs, self.model, Start { plan, ..Start::of_lab(self.lab) })
    }

    /// The model at the start of a run.
    fn start_model(&self, programs: &Programs, setup: Option<&Bound>, run: &Run) -> Model {
        let mut session = self.start(programs, setup);
        let trial = self.run_of_question(run);
        let sets = trial.moves.iter().filter(|(_, m)| matches!(m, Move::Set(..)));
        sets.for_each(|(_, m)| act(&mut session, m));
        if let Some(bound) = setup {
            session.run_statements(&bound.program, &bound.text);
        }
        session.world.model
    }

    /// The lab with these pairs corrected after the program, and with constants recomputed where that is missing.
    pub(super) fn corrected(&self, s: &SuspectProgram<'_>, pairs: PairSet) -> AmendedLab {
        let mut programs = self.programs.clone();
        coupled_in(s, pairs).install(&mut programs, self.model);
        AmendedLab { programs, bound: s.bound.clone() }
    }

    /// The lab that observes the coupled parameters of the program, with constants recomputed if `refreshed`.
    pub(super) fn observed(&self, s: &SuspectProgram<'_>, refreshed: bool) -> AmendedLab {
        let mut programs = self.programs.clone();
        if refreshed {
            coupled_in(s, PairSet::NONE).install(&mut programs, self.model);
        }
        programs.observed = Some(coupled_in(s, s.pairs));
        AmendedLab { programs, bound: s.bound.clone() }
    }

    /// The lab with other statements in place of the program.
    pub(super) fn amended(&self, s: &SuspectProgram<'_>, statements: &str) -> Option<AmendedLab> {
        let bound = self.compile(&s.bound.text, statements, s.given)?;
        let mut programs = self.programs.clone();
        match s.place {
            ProgramSite::Setup => programs.setup = Some(bound.clone()),
            ProgramSite::Controller => programs.controller = Some(bound.clone()),
            ProgramSite::Control(i) => match programs.controls.get_mut(i).map(|(_, c)| c) {
                Some(ControlProgram::Change(_, action)) => action.run = Some(bound.clone()),
                Some(ControlProgram::Press(run)) => *run = Some(bound.clone()),
                None => return None,
            },
            ProgramSite::Run(_) => {}
        }
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
        programs.bound().for_each(|b| include(b.program.effects(), &mut access));
        programs.access = access;
        Some(AmendedLab { programs, bound })
    }

    /// Compiles statements of the lab. `place` is the text that they replace.
    pub(crate) fn compile(&self, place: &Text, source: &str, given: Option<Type>) -> Option<Bound> {
        let names = ModelNames::new(self.model, Scope::Lab).with(&self.programs.functions);
        let mut globals = self.programs.globals.clone();
        let mut compiler = Compiler::new(&names, &mut globals).with_value(given);
        let program = compiler.statements(source).program?;
        Some(Bound { text: place.clone(), program })
    }
}

/// The correction of these pairs of a program, and of its constants where they are missing.
fn coupled_in(s: &SuspectProgram<'_>, pairs: PairSet) -> Coupled {
    Coupled {
        programs: vec![(s.bound.text.clone(), pairs)],
        others: PairSet::NONE,
        changes: PairSet::NONE,
        refresh: s.inertial.is_some(),
    }
}

/// A completed run.
struct CompletedRun {
    rows: SampleRows,
    /// Whether a program changed a parameter without the parameters coupled to it, as far as programs observe that.
    has_uncoupled_change: bool,
}

/// A lab with other statements.
pub(super) struct AmendedLab {
    programs: Programs,
    bound: Bound,
}

/// Replaces a long text by its beginning and a hash.
fn short(cell: Cell) -> Cell {
    match cell {
        Cell::Text(t) if t.len() > MAX_COMPARED_TEXT => {
            let start: String = t.chars().take(MAX_COMPARED_TEXT / 2).collect();
            let mut hash = DefaultHasher::new();
            t.hash(&mut hash);
            Cell::Text(format!("{start}… ({:016x})", hash.finish()))
        }
        other => other,
    }
}

fn act(session: &mut Session<'_>, what: &Move) {
    match what {
        Move::Set(i, value) => session.set_control(*i, value.clone()),
        Move::Press(i) => session.press(*i),
    }
}

/// Whether a run was completed.
///
/// # Errors
/// A statement failed, the simulation broke, or the run ended early. Errors in a trace or a readout have separate findings.
fn check_completion(session: &Session<'_>, programs: &Programs) -> Result<(), String> {
    let probe = |t: &Text| programs.probes.iter().any(|p| p.bound.as_ref().is_some_and(|b| b.text == *t));
    if let Some(program_error) = session.program_errors.iter().find(|t| !probe(&t.text)) {
        return Err(format!("its statements fail: {}", program_error.message));
    }
    match (run::worst_breakdown(session), session.ended()) {
        (Some(broken), _) => Err(format!("the simulation breaks: {}", broken.what)),
        (None, Some(_)) => Err("it ends early".to_string()),
        (None, None) => Ok(()),
    }
}
