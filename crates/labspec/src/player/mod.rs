//! A lab on a page: it can be loaded, changed, played, read and saved. Every frontend maps this one object.
//!
//! The order of events is that of [`Session`]; a call does what a student can do on the page, and nothing else. No call
//! panics, whatever its arguments. An impossible call is an [`Error`], and a breakdown while the lab plays is a
//! [`Finding`].

mod applied_force;
mod control;
mod displayed;
mod load;
mod scene;

pub use control::{Control, ControlKey, ControlKind};
pub use displayed::{DisplayedIn, DisplayedValue};

use crate::bind::Playback;
use crate::error::{Error, located};
use crate::finding::Finding;
use crate::rules;
use crate::run::{self, Budget, Cell, End, Play, Session, settings};
use crate::source::SourceFile;
use crate::spec::Lab;
use labspec_core::reflect::{FieldSet, Object};
use labspec_core::{Data, Fields, Model, Planned};
use labspec_expr::Value;
use labspec_finding::order;
use scene::Scene;
use std::ops::ControlFlow;
use std::sync::Arc;

/// A lab that is open on a page. A clone continues independently with equal results.
#[derive(Clone, Debug)]
pub struct Player {
    lab: Arc<Lab>,
    file: SourceFile,
    /// The findings when it was loaded.
    loaded: Vec<Finding>,
    controls: Vec<Control>,
    displayed: Vec<DisplayedValue>,
    current: Saved,
    scene: Option<Scene>,
}

/// A state of a lab: everything that determines how it continues, including the model and the `ctx` variables.
#[derive(Clone, Debug)]
pub struct Saved {
    lab: Arc<Lab>,
    session: Session<'static>,
    cells: Vec<Cell>,
    numbers: Vec<f64>,
}

/// The pairs of geoms that touched in the last step, in ascending order.
pub fn touching_pairs(fields: &Fields) -> Vec<(usize, usize)> {
    let pairs = fields.contact.iter().filter(|c| c.exclude == 0).map(|c| (c.geom1, c.geom2));
    let mut pairs: Vec<(usize, usize)> = pairs.collect();
    order::sort_by(&mut pairs, Ord::cmp);
    pairs.dedup();
    pairs
}

impl Player {
    /// The controls, in the order in which they are drawn.
    pub fn controls(&self) -> &[Control] {
        &self.controls
    }

    /// The traces of the plots, then the readouts: the order of [`Player::values`] and [`Player::numbers`].
    pub fn displayed(&self) -> &[DisplayedValue] {
        &self.displayed
    }

    /// The lab of the lesson: title, camera, plots.
    pub fn lab(&self) -> &Lab {
        &self.lab
    }

    /// The current value of each trace and readout.
    pub fn values(&self) -> &[Cell] {
        &self.current.cells
    }

    /// The current values as numbers; NaN for other values.
    pub fn numbers(&self) -> &[f64] {
        &self.current.numbers
    }

    /// What each readout shows now, as the page prints it.
    pub fn readout_texts(&self) -> Vec<String> {
        let all = self.displayed.iter().zip(&self.current.cells);
        let text = |(displayed, cell): (&DisplayedValue, &Cell)| match displayed.place {
            DisplayedIn::Readout(digits) => Some(cell.rounded(digits)),
            DisplayedIn::Plot(_) => None,
        };
        all.filter_map(text).collect()
    }

    /// The current value of a control; `None` when there is no such control, `undefined` for a button.
    pub fn value<'w>(&self, which: impl Into<ControlKey<'w>>) -> Option<&Value> {
        self.current.session.values().get(self.index(which.into()).ok()?)
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.current.session.world.data.time()
    }

    /// Current length of a step, s.
    pub fn timestep(&self) -> f64 {
        self.model().opt.timestep
    }

    /// The model, as changed by controls and programs.
    pub fn model(&self) -> &Model {
        &self.current.session.world.model
    }

    /// The data after the last step: state, inputs, and the fields that the programs of the lab read. [`Player::scene`] has
    /// all fields.
    pub fn data(&self) -> &Data<Planned> {
        &self.current.session.world.data
    }

    /// Whether the lab does not continue without a reset: it reached its `stopAt`, or it is frozen.
    pub fn is_over(&self) -> bool {
        self.current.session.ended().is_some() || self.stop().is_some_and(|stop| self.time() >= stop)
    }

    /// Moves a slider, or chooses an option by its value or its text.
    ///
    /// # Errors
    /// There is no such control, it is a button, a student cannot choose this value, or the lab is frozen.
    pub fn set<'w>(
        &mut self,
        which: impl Into<ControlKey<'w>>,
        value: impl Into<Value>,
    ) -> Result<(), Error> {
        let index = self.index(which.into())?;
        let Some(control) = self.lab.controls.get(index) else { return Err(self.unknown(index)) };
        let value = settings::value(control, &value.into())?;
        self.act(|session| session.set_control(index, value))
    }

    /// Presses a button.
    ///
    /// # Errors
    /// There is no such control, it is not a button, or the lab is frozen.
    pub fn press<'w>(&mut self, which: impl Into<ControlKey<'w>>) -> Result<(), Error> {
        let index = self.index(which.into())?;
        let Some(control) = self.controls.get(index) else { return Err(self.unknown(index)) };
        let ControlKind::Button = control.kind else {
            let label = &control.label;
            return Err(Error::Call(format!("\"{label}\" is not a button: set it instead of pressing it")));
        };
        self.act(|session| session.press(index))
    }

    /// Performs one step.
    ///
    /// # Errors
    /// The lab is frozen.
    pub fn step(&mut self) -> Result<(), Error> {
        self.act(Session::step)
    }

    /// Resets the lab like the button of the page: controls, model and `ctx` keep their values. A frozen lab plays again.
    pub fn reset(&mut self) {
        self.current.session.renew(Budget::TRIAL);
        self.current.session.start_over();
        self.observe();
    }

    /// Plays until a time, s, or until the lab stops by itself. Returns the number of steps; zero for a time in the past.
    ///
    /// # Errors
    /// The time is NaN, it is too many steps away, or the lab freezes before that time.
    pub fn play_to(&mut self, time: f64) -> Result<usize, Error> {
        self.play(time, |_, _| ())
    }

    /// Like [`Player::play_to`], for a page that draws curves: `each` is called with the time and the values after every
    /// step.
    ///
    /// # Errors
    /// As for [`Player::play_to`].
    pub fn play_with(&mut self, time: f64, mut each: impl FnMut(f64, &[Cell])) -> Result<usize, Error> {
        self.play(time, |session, made| {
            if made > 0
                && let Some((_, values)) = session.sample().split_first()
            {
                each(session.world.data.time(), values);
            }
        })
    }

    /// Plays at most `most` steps towards a time, and stops early where `each` breaks. `each` is called with the data and
    /// the values after every step.
    ///
    /// # Errors
    /// As for [`Player::play_to`].
    pub fn play_while(
        &mut self,
        time: f64,
        most: usize,
        mut each: impl FnMut(&Data<Planned>, &[Cell]) -> ControlFlow<()>,
    ) -> Result<usize, Error> {
        self.play_steps(time, most, |session, made| match made {
            0 => ControlFlow::Continue(()),
            _ => {
                let row = session.sample();
                each(&session.world.data, row.get(1..).unwrap_or(&[]))
            }
        })
    }

    fn play(&mut self, time: f64, mut each: impl FnMut(&mut Session<'_>, usize)) -> Result<usize, Error> {
        self.play_steps(time, usize::MAX, |session, made| {
            each(session, made);
            ControlFlow::Continue(())
        })
    }

    fn play_steps(
        &mut self,
        time: f64,
        most: usize,
        mut each: impl FnMut(&mut Session<'_>, usize) -> ControlFlow<()>,
    ) -> Result<usize, Error> {
        if time.is_nan() {
            return Err(Error::Call("a lab cannot run to the time NaN; pass a time in seconds".into()));
        }
        let ahead = (time - self.time()).max(0.0);
        let steps = run::count_steps(&self.lab, Some(ahead), None, self.timestep())?.min(most);
        let stop = self.stop().unwrap_or(f64::INFINITY).min(time);
        self.current.session.renew(Budget::ASKED);
        let made = run::play(&mut self.current.session, &Play::steps(steps), |session, made| {
            each(session, made)?;
            if session.world.data.time() >= stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        self.observe();
        self.frozen().map_or(Ok(made), Err)
    }

    /// What the programs of the lab have asked of the page since the last call: to play, to pause, or to do the other of the
    /// two (`sim.play()`, `sim.pause()`, `sim.toggle()`).
    pub fn take_playback(&mut self) -> Option<Playback> {
        self.current.session.world.playback.take()
    }

    /// All findings: those of loading the lab, and breakdowns since, with their times.
    pub fn findings(&self) -> Vec<Finding> {
        let session = &self.current.session;
        let done = self.done();
        let mut all = self.loaded.clone();
        let program_errors = session.program_errors.iter().map(|t| run::error_finding(t, &done));
        let breakdowns = run::breakdowns_of(session).into_iter();
        let broken = breakdowns.map(|b| run::describe_breakdown(&b, &done, self.lab.place()));
        all.extend(program_errors.chain(broken).chain(self.spent()).map(|f| located(f, &self.file)));
        all
    }

    /// The state, for [`Player::restore`].
    pub fn save(&self) -> Saved {
        self.current.clone()
    }

    /// Restores a saved state. The lab then continues with equal results, bit for bit.
    ///
    /// # Errors
    /// It was saved by another lab.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), Error> {
        if !Arc::ptr_eq(&self.lab, &saved.lab) {
            return Err(Error::Call(
                "this state belongs to another lab, or was saved before this lab was loaded again".into(),
            ));
        }
        self.current.clone_from(saved);
        self.mark_scene_stale();
        Ok(())
    }

    /// The fields that the programs of the lab read: `data.qpos`, `model.opt.timestep`.
    pub fn reads(&self) -> Vec<String> {
        names(&self.current.session.programs().access.reads)
    }

    /// The fields that the programs of the lab write.
    pub fn writes(&self) -> Vec<String> {
        names(&self.current.session.programs().access.writes)
    }

    fn stop(&self) -> Option<f64> {
        self.lab.stop_at.as_ref().map(|stop| stop.value)
    }

    /// Changes the lab, and updates the displayed values.
    fn act(&mut self, what: impl FnOnce(&mut Session<'static>)) -> Result<(), Error> {
        if let Some(frozen) = self.frozen() {
            return Err(frozen);
        }
        self.current.session.renew(Budget::TRIAL);
        what(&mut self.current.session);
        self.observe();
        self.frozen().map_or(Ok(()), Err)
    }

    /// Updates the displayed values.
    fn observe(&mut self) {
        self.mark_scene_stale();
        let mut row = self.current.session.sample().into_iter();
        // The first cell is the time.
        row.next();
        self.current.cells.clear();
        self.current.cells.extend(row);
        self.current.numbers.clear();
        self.current.numbers.extend(self.current.cells.iter().map(Cell::number));
    }

    fn mark_scene_stale(&mut self) {
        self.scene.iter_mut().for_each(|scene| scene.is_stale = true);
    }

    /// Why the lab is frozen, if an error stopped it.
    fn frozen(&self) -> Option<Error> {
        let session = &self.current.session;
        session.ended()?;
        let program_errors = session.program_errors.last().map(|t| run::error_finding(t, &self.done()));
        let all: Vec<Finding> =
            self.spent().or(program_errors).map(|f| located(f, &self.file)).into_iter().collect();
        Some(if all.is_empty() {
            Error::Call("the engine refused a call: reset the lab".into())
        } else {
            Error::Findings(all)
        })
    }

    /// The finding about a lab that needs more work than a page allows.
    fn spent(&self) -> Option<Finding> {
        let Some(End::Budget { time }) = self.current.session.ended() else { return None };
        let what = format!(
            "the lab was stopped at t = {} s: it needs more work than a page allows",
            run::time(*time)
        );
        let finding = Finding::error(rules::RUN_IMPOSSIBLE, self.lab.place(), what);
        Some(
            finding.why("without this limit, the page would hang").help("simplify the scene or its programs"),
        )
    }

    /// Describes the changed controls, for findings.
    fn done(&self) -> String {
        let moved = self
            .controls
            .iter()
            .zip(self.current.session.values())
            .filter(|(c, current)| c.start != **current);
        let list: Vec<String> = moved.map(|(c, current)| format!("\"{}\" at {current}", c.label)).collect();
        if list.is_empty() { "as it stands".into() } else { format!("with {}", list.join(", ")) }
    }

    fn index(&self, which: ControlKey<'_>) -> Result<usize, Error> {
        match which {
            ControlKey::Index(index) if index < self.controls.len() => Ok(index),
            ControlKey::Index(index) => Err(self.unknown(index)),
            ControlKey::Label(label) => {
                let programs = self.current.session.programs();
                let found = programs.control(label).map(|(index, _)| index);
                found.ok_or_else(|| settings::unknown_control(label, programs).into())
            }
        }
    }

    fn unknown(&self, index: usize) -> Error {
        Error::Call(match self.controls.len() {
            0 => "this lab has no controls".into(),
            n => format!("the control {index} does not exist: this lab has {n}, counted from 0"),
        })
    }
}

/// The names of fields, as programs write them.
fn names(fields: &FieldSet) -> Vec<String> {
    let name = |f: labspec_core::reflect::FieldId| {
        let info = f.info();
        let holder = match info.object {
            Object::Data => "data",
            Object::Model => "model",
            Object::Option => "model.opt",
            Object::Statistic => "model.stat",
        };
        format!("{holder}.{}", info.name)
    };
    fields.iter().map(name).collect()
}
