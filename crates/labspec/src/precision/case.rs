//! A lab that is compared with itself: what it shows, and one run of it under a setting.

use super::cost::integrator_work;
use super::jumps;
use super::moments::{Finder, Moment, Sought};
use super::setting::Setting;
use crate::bind::{
    Bound, ControlProgram, ModelNames, Programs, Scope, dimensions, include, of_label, to_finding,
};
use crate::finding::Finding;
use crate::run::{self, Budget, End, Play, RunError, Session};
use crate::spec::{Lab, Plot};
use labspec_bind::units::written;
use labspec_core::reflect::{FieldId, option};
use labspec_core::{self as core, AccessSet, Data, Full, Model, Warning, state};
use labspec_expr::dimension::Measure;
use labspec_expr::{Compiler, Type, Value};
use std::ops::ControlFlow;

/// A number that the lab shows.
pub(super) struct Target<'a> {
    pub(super) label: String,
    /// Its unit, where it is known.
    pub(super) unit: Option<String>,
    pub(super) bound: &'a Bound,
    /// Its closed form.
    pub(super) exact: Option<Bound>,
    pub(super) shown: Shown,
}

/// How exactly a number is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shown {
    /// With so many decimals.
    Decimals(u32),
    /// As a curve: the ends of its axis, where they are fixed, and its height in pixels.
    Curve { ends: [Option<f64>; 2], height: f64 },
}

impl Shown {
    /// The largest error that nobody sees, for values of some range: half a unit of the last digit, half a pixel.
    pub(super) fn unseen(self, range: f64) -> f64 {
        match self {
            Shown::Decimals(digits) => 0.5 * 0.1f64.powi(digits as i32),
            Shown::Curve { ends, height } => {
                let tall = match ends {
                    [Some(low), Some(high)] if high > low => high - low,
                    _ => range,
                };
                0.5 * tall / height.max(1.0)
            }
        }
    }
}

/// Something that is not compared, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Its label.
    pub label: String,
    /// The reason.
    pub reason: &'static str,
}

/// Left out, yet compared: under another label.
pub(super) const AGAIN: &str = "it repeats another one";

/// What all runs of a comparison share.
pub(super) struct PrecisionCase<'a> {
    pub(super) lab: &'a Lab,
    pub(super) model: &'a Model,
    pub(super) programs: &'a Programs,
    pub(super) targets: Vec<Target<'a>>,
    pub(super) left_out: Vec<LeftOut>,
    pub(super) set: &'a [(String, Value)],
    /// Buttons and the times of their presses, s.
    pub(super) presses: Vec<(usize, f64)>,
    pub(super) demand: AccessSet,
    /// Time between samples of the truth, s, and their number, the start not counted.
    pub(super) interval: f64,
    pub(super) count: usize,
}

/// The samples of a run: after every step, or after so many as the truth is known at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rhythm {
    /// Steps from one sample to the next.
    pub(super) steps: usize,
    /// Samples of the truth from one to the next.
    pub(super) stride: usize,
    /// Their number, the start not counted.
    pub(super) count: usize,
}

/// Samples in which energy and momentum are looked at.
const LOOKS: usize = 100;

/// What is asked of a run.
#[derive(Clone, Copy, Default)]
pub(super) struct Ask<'s> {
    /// Every coordinate of the start is moved by this.
    pub(super) perturbation: f64,
    /// All that is shown is of the state at hand, as in the truth; else what a page shows after a step is partly of the state before
    /// it: forces, energies, contacts. A fresh run is not watched for growth of energy, as every look begins that watch anew.
    pub(super) fresh: bool,
    /// Steps are cut where controls jump.
    pub(super) cut: bool,
    /// The moments that are looked for.
    pub(super) sought: Option<&'s Sought>,
    /// The run is made for its moments alone: it is of no more use after this time, s, or when all are found.
    pub(super) stop: Option<f64>,
}

impl Ask<'_> {
    /// As a reference is run.
    pub(super) const FRESH: Ask<'static> =
        Ask { perturbation: 0.0, fresh: true, cut: false, sought: None, stop: None };
}

/// What a run showed.
#[derive(Clone, Debug, Default)]
pub(super) struct Run {
    /// Values of each target at the run's samples, and of its closed form (NaN without one).
    pub(super) values: Vec<Vec<f64>>,
    pub(super) exact: Vec<Vec<f64>>,
    /// When bodies first touch, when each target first passes through zero, when each first turns back; empty where nobody asked.
    pub(super) moments: Vec<Moment>,
    /// When the last of them was sure to be one, s.
    pub(super) settled: f64,
    /// Whether bodies touch at the start.
    pub(super) touching: bool,
    /// Whether a force could jump: dry friction, a limit or a contact pushed.
    pub(super) jumps: bool,
    /// Energy, J, and momentum (three of motion, three of turning), where they were looked at.
    pub(super) energy: Vec<f64>,
    pub(super) momentum: Vec<[f64; 6]>,
    /// The largest kinetic energy among them, J.
    pub(super) kinetic: f64,
    /// How deep bodies were in each other at most, m.
    pub(super) penetration: f64,
    /// What became of it.
    pub(super) fate: Fate,
    /// Everything that was told about it.
    pub(super) reported: Vec<String>,
    /// Work, in the engine's own units, per simulated second.
    pub(super) work: f64,
}

/// What became of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fate {
    /// It came to its end.
    #[default]
    Good,
    /// A number was not finite, or too large, and the engine reset the scene.
    Diverged,
    /// It gained energy that nothing gave.
    Grows,
    /// The engine warned of something else: full buffers, bodies without inertia, a control that is no number.
    Warned,
    /// It threw, or took more work than a run may.
    Stopped,
}

impl Fate {
    /// In one word.
    pub fn word(self) -> &'static str {
        match self {
            Fate::Good => "good",
            Fate::Diverged => "diverged",
            Fate::Grows => "gains energy",
            Fate::Warned => "warned",
            Fate::Stopped => "stopped",
        }
    }
}

/// The unit that a label states, or else that of what is measured; a plain number has none.
fn unit_of(label: &str, measured: Option<Measure>) -> Option<String> {
    let stated = of_label(label).map(|(text, _)| text.to_string());
    let computed = || match measured? {
        Measure::Known(dimension) => Some(written(&dimension)),
        _ => None,
    };
    // A unit times a number has no name.
    stated.or_else(computed).filter(|unit| unit != "1" && !unit.contains(", times"))
}

impl<'a> PrecisionCase<'a> {
    /// The numbers that a lab shows, with their closed forms. Mistakes in these go to `findings`. Times are still missing.
    pub(super) fn new(
        lab: &'a Lab,
        model: &'a Model,
        programs: &'a Programs,
        set: &'a [(String, Value)],
        findings: &mut Vec<Finding>,
    ) -> PrecisionCase<'a> {
        let mut case = PrecisionCase {
            lab,
            model,
            programs,
            targets: Vec::new(),
            left_out: Vec::new(),
            set,
            presses: Vec::new(),
            demand: programs.demand,
            interval: 0.0,
            count: 0,
        };
        let names = ModelNames::new(model, Scope::Lab).with(&programs.functions);
        let exact = lab.verify.as_ref().map_or(&[][..], |v| &v.exact);
        let curve = |plot: &Plot| Shown::Curve {
            ends: [&plot.ymin, &plot.ymax].map(|end| end.as_ref().map(|x| x.value)),
            height: plot.height(),
        };
        let curves = |plot: &'a Plot| plot.traces.iter().map(move |t| (&t.label.value, curve(plot)));
        let traces = lab.plots.iter().flat_map(curves);
        let readouts = lab.readouts.iter().map(|r| (&r.label.value, Shown::Decimals(r.digits())));
        let measured = dimensions(lab, model, programs).probes;
        let probes = programs.probes.iter().zip(measured.into_iter().chain(std::iter::repeat(None)));
        for ((label, shown), (probe, measured)) in traces.chain(readouts).zip(probes) {
            let Some(bound) = &probe.bound else { continue };
            let unit = unit_of(label, measured.map(|m| m.value));
            let closed =
                exact.iter().find(|e| e.trace.value == *label && matches!(shown, Shown::Curve { .. }));
            let closed = closed.and_then(|e| {
                let mut globals = programs.globals.clone();
                let compiled = Compiler::new(&names, &mut globals).expression(&e.form.value);
                findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, &e.form)));
                compiled.program.map(|program| Bound { text: e.form.clone(), program })
            });
            case.take((label, unit), shown, bound, closed);
        }
        case
    }

    fn take(
        &mut self,
        (label, unit): (&str, Option<String>),
        shown: Shown,
        bound: &'a Bound,
        exact: Option<Bound>,
    ) {
        let effects = bound.program.effects();
        let reads = |id| effects.reads.iter().any(|a| FieldId::new(a.field.0 as usize) == Some(id));
        let reason = if !matches!(bound.program.result_type(), Type::Number | Type::Any) {
            "it is not a number"
        } else if exact.is_none() && (reads(option::timestep) || reads(option::integrator)) {
            "it depends on the timestep or the integrator, so it has no closed form"
        } else if self.targets.iter().any(|t| t.bound.text.value == bound.text.value && t.shown == shown) {
            AGAIN
        } else {
            if let Some(e) = &exact {
                include(e.program.effects(), &mut self.demand);
            }
            self.targets.push(Target { label: label.to_string(), unit, bound, exact, shown });
            return;
        };
        self.left_out.push(LeftOut { label: label.to_string(), reason });
    }

    /// Whether a program runs at every step: its controls are held for a step, so that the step is part of what the lab does.
    pub(super) fn controlled(&self) -> bool {
        self.programs.controller.is_some()
    }

    /// What sets the timestep while the lab runs, so that no other can be tried.
    pub(super) fn steps_itself(&self) -> Option<String> {
        let timestep = Some(option::timestep);
        let writes = |bound: &Bound| {
            let effects = bound.program.effects();
            effects.writes.iter().any(|w| FieldId::new(w.field.0 as usize) == timestep)
        };
        if self.programs.controller.as_ref().is_some_and(writes) {
            return Some("the controller".to_string());
        }
        self.presses.iter().find_map(|(i, _)| match self.programs.controls.get(*i) {
            Some((label, ControlProgram::Press(Some(bound)))) if writes(bound) => {
                Some(format!("the button \"{label}\""))
            }
            _ => None,
        })
    }

    /// The lab as it starts, with its controls set; under a setting, or as it stands.
    ///
    /// # Errors
    /// A control that cannot be set so.
    pub(super) fn start(&self, setting: Option<&Setting>) -> Result<Session<'a>, RunError> {
        let mut model = self.model.clone();
        if let Some(s) = setting {
            s.apply(&mut model);
        }
        let key = self.lab.keyframe();
        let mut session = Session::start_within(self.programs, &model, key, &self.demand, Budget::COMPARED);
        run::set_controls(&mut session, self.lab, self.programs, self.set)?;
        if let Some(s) = setting {
            // The lab's own code may have set others.
            s.apply(&mut session.world.model);
        }
        Ok(session)
    }

    /// Length of the runs, s.
    pub(super) fn length(&self) -> f64 {
        self.count as f64 * self.interval
    }

    /// When a run with some timestep is looked at: after each of its own steps, as a page shows them, where the truth is known
    /// as often.
    pub(super) fn rhythm(&self, timestep: f64) -> Rhythm {
        let whole = |x: f64| x.round().max(1.0) as usize;
        let stride = whole(timestep / self.interval);
        Rhythm { steps: whole(self.interval / timestep), stride, count: self.count / stride }
    }

    /// A run under a setting.
    pub(super) fn run(&self, setting: &Setting, ask: Ask<'_>) -> Result<Run, RunError> {
        let mut session = self.start(Some(setting))?;
        if ask.perturbation != 0.0 {
            session.perturb(
                run::StepVariant { perturbation: ask.perturbation, ..run::StepVariant::NOMINAL },
                true,
            );
        }
        let rhythm = self.rhythm(setting.timestep);
        let steps = rhythm.count * rhythm.steps;
        let n = self.targets.len();
        let mut seen = Run {
            values: vec![Vec::with_capacity(rhythm.count + 1); n],
            exact: vec![Vec::with_capacity(rhythm.count + 1); n],
            ..Run::default()
        };
        let mut look = Look::new(&session.world.model);
        let mut finder = ask.sought.map(|s| Finder::new(s, &session.world.model, setting));
        let evaluate = |session: &mut Session<'_>, i: usize| self.value(session, i);
        let every = rhythm.count.div_ceil(LOOKS).max(1);
        let before = session.spent();
        let mut sampling = 0;
        let mut now = vec![0.0; n];
        let sample = |session: &mut Session<'_>, made: usize| {
            let began = session.spent();
            let sampled = made.is_multiple_of(rhythm.steps);
            if ask.fresh && made > 0 {
                session.refresh();
            }
            for (i, target) in self.targets.iter().enumerate() {
                now[i] = self.value(session, i);
                if sampled {
                    seen.values[i].push(now[i]);
                    let exact = target.exact.as_ref().and_then(|b| session.evaluate(&b.program, &b.text));
                    seen.exact[i].push(exact.map_or(f64::NAN, |v| v.to_number()));
                }
            }
            seen.observe(session);
            if let Some(finder) = &mut finder {
                finder.see(session, &now, &evaluate);
            }
            if sampled && (made / rhythm.steps).is_multiple_of(every) {
                look.take(session, &mut seen);
            }
            sampling += session.spent() - began;
            let time = session.world.data.time();
            let found = finder.as_ref().is_some_and(Finder::is_complete);
            match ask.stop.is_some_and(|stop| found || time > stop) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let played = Play { steps, every: 1, presses: &self.presses, watched: !ask.fresh };
        let made = match ask.cut {
            true => jumps::play(&mut session, &played, setting.timestep, sample),
            false => run::play(&mut session, &played, sample),
        };
        let simulated = made as f64 * setting.timestep;
        let counted = (session.spent() - before - sampling) as f64;
        let of_steps = made as f64 * integrator_work(&session, setting.integrator);
        seen.work = (counted + of_steps) / simulated.max(setting.timestep);
        if let Some(finder) = finder {
            (seen.touching, seen.settled) = (finder.touches_at_start(), finder.settled());
            seen.moments = finder.finish();
        }
        // Where a run ended before its time, nothing is known.
        seen.values
            .iter_mut()
            .chain(&mut seen.exact)
            .for_each(|list| list.resize(rhythm.count + 1, f64::NAN));
        seen.judge(&session);
        Ok(seen)
    }

    fn value(&self, session: &mut Session<'_>, target: usize) -> f64 {
        let bound = self.targets.get(target).map(|t| t.bound);
        let value = bound.and_then(|b| session.evaluate(&b.program, &b.text));
        value.map_or(f64::NAN, |v| v.to_number())
    }
}

impl Run {
    /// Looks at contacts and constraints after a step.
    fn observe(&mut self, session: &Session<'_>) {
        let d = session.world.data.fields();
        self.jumps |= d.nefc > d.ne;
        let deepest = d.contact.iter().map(|c| -c.dist).fold(f64::NAN, f64::max);
        if deepest > 0.0 {
            self.penetration = self.penetration.max(deepest);
        }
    }

    /// What became of the run that ends here.
    fn judge(&mut self, session: &Session<'_>) {
        let bad = [Warning::BadQpos, Warning::BadQvel, Warning::BadQacc, Warning::BadCtrl];
        self.reported = run::breakdowns_of(session).into_iter().map(|b| b.what).collect();
        self.fate = match session.ended() {
            _ if bad.iter().any(|&w| session.warnings[w as usize].number > 0) => Fate::Diverged,
            _ if session.growth().is_some() => Fate::Grows,
            Some(End::Budget { time }) => {
                self.reported.push(format!("the work budget ran out, so the run ends at {time} s"));
                Fate::Stopped
            }
            Some(_) => Fate::Stopped,
            None if !self.reported.is_empty() => Fate::Warned,
            None => Fate::Good,
        };
        if let Some(trouble) = session.troubles.first() {
            self.reported.push(trouble.message.clone());
        }
    }
}

/// Energy and momentum, seen with data of its own so that looking leaves the run alone.
struct Look {
    own: Data<Full>,
}

impl Look {
    fn new(m: &Model) -> Look {
        Look { own: Data::new(m) }
    }

    fn take(&mut self, session: &Session<'_>, seen: &mut Run) {
        let m = &session.world.model;
        // Of one model: nothing can be refused.
        let _ = state::copy(m, &session.world.data, &mut self.own, state::INTEGRATION);
        let energy = core::mechanical_energy(m, &mut self.own).ok().flatten();
        seen.energy.push(energy.map_or(f64::NAN, |e| e.kinetic + e.potential()));
        seen.kinetic = seen.kinetic.max(energy.map_or(0.0, |e| e.kinetic));
        let d = &mut self.own;
        let moving = core::forward(m, d).and_then(|()| core::subtree_vel(m, d));
        let mut momentum = [f64::NAN; 6];
        let of = |list: &[f64], k: usize| list.get(k).copied().unwrap_or(f64::NAN);
        if moving.is_ok() {
            let mass = of(&m.body_subtreemass, 0);
            for k in 0..3 {
                momentum[k] = mass * of(&d.subtree_linvel, k);
                momentum[3 + k] = of(&d.subtree_angmom, k);
            }
        }
        seen.momentum.push(momentum);
    }
}
