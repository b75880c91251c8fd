//! The labs of runs: a lab with its model and programs, unchanged or with the modifications of a run.

use super::run_result::RunResult;
use crate::bind::Programs;
use crate::bind::scene::Models;
use crate::finding::Finding;
use crate::json::{Number, Scalar, encode, nearest, read::named};
use crate::language::Languages;
use crate::rules;
use crate::run::ProgramsRef;
use crate::source::Text;
use crate::spec::{Lab, Run, SweepAxis};
use labspec_core::xml::Patch;
use labspec_core::{Model, Obj};
use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// A lab with its model and programs.
#[derive(Clone, Debug)]
pub struct BoundLab<'a> {
    /// The lab.
    pub lab: Cow<'a, Lab>,
    /// Its model.
    pub model: Arc<Model>,
    /// Its programs.
    pub programs: ProgramsRef<'a>,
    /// The identity of the model of the lab in the lesson.
    origin: u64,
    /// The modifications of its model, with their spans.
    pub(super) patches: Vec<(Patch, Range<usize>)>,
    /// Whether a modification changed a parameter of the model without the parameters coupled to it.
    pub(super) has_uncoupled_change: bool,
    /// A key that distinguishes the modifications of the lab; empty for none.
    changes: String,
}

impl<'a> BoundLab<'a> {
    /// The unchanged lab of the lesson.
    pub fn new(lab: &'a Lab, model: &Arc<Model>, programs: &'a Programs) -> BoundLab<'a> {
        BoundLab {
            lab: Cow::Borrowed(lab),
            model: model.clone(),
            programs: ProgramsRef::Lent(programs),
            origin: model.identity(),
            patches: Vec::new(),
            has_uncoupled_change: false,
            changes: String::new(),
        }
    }

    /// Whether it is the same lab with the same modifications.
    pub(super) fn is(&self, other: &BoundLab<'_>) -> bool {
        self.origin == other.origin && self.lab.span == other.lab.span && self.changes == other.changes
    }
}

/// Work budget of the runs of all `verify` objects of a lesson together.
const WORK: u64 = 12_000_000_000;

/// The cache that the `verify` objects of a lesson share: modified labs and results of runs, within one work budget.
#[derive(Debug)]
pub struct RunCache<'a> {
    models: &'a Models,
    changed: RefCell<Vec<BoundLab<'static>>>,
    runs: RefCell<BTreeMap<String, RunResult>>,
    left: Cell<u64>,
    /// Whether a run since the last query changed a parameter without the parameters coupled to it.
    has_uncoupled_change: Cell<bool>,
    languages: Languages,
}

impl<'a> RunCache<'a> {
    /// An empty cache. `models` resolves the models that labs name; `languages` are those of the lesson.
    pub fn new(models: &'a Models, languages: Languages) -> RunCache<'a> {
        RunCache {
            models,
            changed: RefCell::default(),
            runs: RefCell::default(),
            left: Cell::new(WORK),
            has_uncoupled_change: Cell::new(false),
            languages,
        }
    }

    /// The languages of the lesson.
    pub(super) fn languages(&self) -> Languages {
        self.languages
    }

    /// The text of the model of a lab, with its modifications.
    pub(super) fn written(&self, scene: &BoundLab<'_>) -> Option<String> {
        let patches: Vec<Patch> = scene.patches.iter().map(|(p, _)| p.clone()).collect();
        self.models.written(&scene.lab, &patches)
    }

    /// The cached result of a run.
    pub(super) fn cached_run(&self, run: &str) -> Option<RunResult> {
        self.runs.borrow().get(run).cloned()
    }

    /// Stores the result of a run.
    pub(super) fn keep(&self, run: String, made: &RunResult) {
        self.runs.borrow_mut().insert(run, made.clone());
    }

    /// Records whether a run changed a parameter without the parameters coupled to it.
    pub(super) fn note(&self, has_uncoupled_change: bool) {
        self.has_uncoupled_change.set(self.has_uncoupled_change.get() || has_uncoupled_change);
    }

    /// Whether a run since the last call changed a parameter without the parameters coupled to it, as far as the programs
    /// observe that.
    pub(crate) fn take_uncoupled_change(&self) -> bool {
        self.has_uncoupled_change.take()
    }

    /// The remaining work.
    pub(super) fn left(&self) -> u64 {
        self.left.get()
    }

    /// Whether at least half of the work remains.
    pub(super) fn has_half_its_work(&self) -> bool {
        self.left.get() >= WORK / 2
    }

    /// Subtracts work from the budget.
    pub(super) fn spend(&self, work: u64) {
        self.left.set(self.left.get().saturating_sub(work));
    }

    /// The lab of a run with the modifications of the run; one for each member of a sweep. Errors are added to `findings`.
    pub fn of_run<'s>(
        &self,
        base: &BoundLab<'s>,
        run: &Run,
        findings: &mut Vec<Finding>,
    ) -> Option<Vec<BoundLab<'s>>> {
        let patches: Vec<(Patch, Range<usize>)> = run
            .model
            .iter()
            .map(|c| (Patch { path: c.path.value.clone(), value: c.value.clone() }, c.path.span()))
            .collect();
        let key = match &run.key {
            Some(key) => Some(keyframe(&base.model, key, findings)?),
            None => None,
        };
        let controller = run.controller.as_ref();
        let Some(sweep) = &run.sweep else {
            return Some(vec![self.changed(base, &patches, key, controller, findings)?]);
        };
        let is_attribute = |axis: &&SweepAxis| base.lab.control(&axis.what.value).is_none();
        let mut attributes = sweep.axes.iter().filter(is_attribute);
        if let Some(unknown) = attributes.find_map(|axis| misspelt(&base.lab, &axis.what)) {
            findings.push(unknown);
            return None;
        }
        let member = |index: usize| {
            let set = sweep.values(index).filter(|(axis, _)| is_attribute(axis));
            let set = set.map(|(axis, value)| {
                (Patch { path: axis.what.value.clone(), value: value.to_string() }, axis.what.span())
            });
            let patches: Vec<_> = patches.iter().cloned().chain(set).collect();
            self.changed(base, &patches, key, controller, findings)
        };
        (0..sweep.count()).map(member).collect()
    }

    /// A lab with a modified model, another keyframe, or another controller.
    pub(super) fn changed<'s>(
        &self,
        base: &BoundLab<'s>,
        patches: &[(Patch, Range<usize>)],
        key: Option<usize>,
        controller: Option<&Text>,
        findings: &mut Vec<Finding>,
    ) -> Option<BoundLab<'s>> {
        if patches.is_empty() && key.is_none() && controller.is_none() {
            return Some(base.clone());
        }
        let patches: Vec<_> = base.patches.iter().chain(patches).cloned().collect();
        let list: Vec<&Patch> = patches.iter().map(|(p, _)| p).collect();
        let text = controller.map(|c| &c.value);
        let changes = format!("{}{list:?} {key:?} {text:?}", base.changes);
        let requested = BoundLab { changes, patches: patches.clone(), ..base.clone() };
        if let Some(made) = self.changed.borrow().iter().find(|made| made.is(&requested)) {
            return Some(made.clone());
        }
        let lab = changed_lab(&base.lab, key, controller);
        let model =
            if patches.is_empty() { base.model.clone() } else { self.model(&lab, &patches, findings)? };
        let observed = &base.programs.observed;
        let left = observed.as_ref().is_some_and(|o| o.leaves_coupled(&base.model, &model));
        let model = match &base.programs.coupled {
            Some(coupled) => {
                let mut corrected = (*model).clone();
                coupled.changed(&base.model, &mut corrected);
                Arc::new(corrected)
            }
            None => model,
        };
        let mut problems = Vec::new();
        let mut programs = Programs::compile_and_lint(&lab, &model, self.models.functions(), &mut problems);
        if let Some(coupled) = &base.programs.coupled {
            coupled.clone().install(&mut programs, &model);
        }
        programs.observed.clone_from(observed);
        // Errors in the other parts of the lab are already reported.
        let in_controller = |f: &Finding| controller.is_some_and(|c| inside(&f.span, &c.span()));
        let before = findings.len();
        findings.extend(problems.into_iter().filter(in_controller));
        let good = controller.is_none() || lab.controller.is_none() || programs.controller.is_some();
        if !good {
            if findings.len() == before {
                findings.extend(controller.map(|c| cannot(c.span(), "its controller has errors".into())));
            }
            return None;
        }
        let programs = ProgramsRef::Shared(Arc::new(programs));
        let has_uncoupled_change = base.has_uncoupled_change || left;
        let scene = BoundLab { lab: Cow::Owned(lab), model, programs, has_uncoupled_change, ..requested };
        self.changed.borrow_mut().push(scene.clone());
        Some(scene)
    }

    fn model(
        &self,
        lab: &Lab,
        patches: &[(Patch, Range<usize>)],
        findings: &mut Vec<Finding>,
    ) -> Option<Arc<Model>> {
        let list: Vec<Patch> = patches.iter().map(|(p, _)| p.clone()).collect();
        match self.models.changed(lab, &list) {
            Ok(model) => Some(model),
            Err((which, refusal)) => {
                let (_, place) = which.map_or(patches.last(), |i| patches.get(i))?;
                let finding = cannot(place.clone(), refusal.message);
                findings.push(if refusal.help.is_empty() { finding } else { finding.help(refusal.help) });
                None
            }
        }
    }
}

/// A lab with another keyframe and another controller, where these are given; an empty text removes the controller.
fn changed_lab(lab: &Lab, key: Option<usize>, controller: Option<&Text>) -> Lab {
    let key = key.map(|k| Number { value: k as f64, span: 0..0 });
    Lab {
        key: key.or_else(|| lab.key.clone()),
        controller: match controller {
            Some(text) => Some(text.clone()).filter(|text| !text.value.trim().is_empty()),
            None => lab.controller.clone(),
        },
        ..lab.clone()
    }
}

/// The finding about a name that is not an attribute of the model but is similar to that of a control.
pub(super) fn misspelt(lab: &Lab, what: &Text) -> Option<Finding> {
    let right = nearest(&what.value, lab.controls.iter().map(|c| c.label.as_str()))?;
    let message = format!("the lab has no control {}", named(&what.value));
    let found = Finding::new(rules::UNKNOWN_CONTROL, what.span(), message);
    Some(found.help(format!("did you mean `{right}`?")).guess(what.span(), encode(right)))
}

fn inside(span: &Range<usize>, outer: &Range<usize>) -> bool {
    outer.start <= span.start && span.end <= outer.end
}

fn cannot(place: Range<usize>, message: String) -> Finding {
    Finding::error(rules::RUN_IMPOSSIBLE, place, format!("the run cannot be executed: {message}"))
}

/// The index of a keyframe.
fn keyframe(model: &Model, key: &Scalar, findings: &mut Vec<Finding>) -> Option<usize> {
    let names = || model.names.of_kind(Obj::Key).iter().map(String::as_str).filter(|n| !n.is_empty());
    let message = match key {
        Scalar::Number(n) if n.value >= 0.0 && n.value.fract() == 0.0 && (n.value as usize) < model.nkey => {
            return Some(n.value as usize);
        }
        Scalar::Text(t) => match model.names.id(Obj::Key, &t.value) {
            Some(i) => return Some(i),
            None => format!("the model has no keyframe {}", named(&t.value)),
        },
        Scalar::Number(n) => format!("the model has no keyframe {}", n.value),
        Scalar::Bool(..) => "a keyframe must be a name or an index".to_string(),
    };
    let finding = cannot(key.span(), message);
    let near = match key {
        Scalar::Text(t) => nearest(&t.value, names()),
        _ => None,
    };
    let list: Vec<&str> = names().take(12).collect();
    findings.push(match (near, model.nkey) {
        (Some(right), _) => finding.help(format!("did you mean `{right}`?")),
        (None, 0) => finding.help("add a keyframe: the model has none"),
        (None, n) if list.is_empty() => finding.help(format!("use one of its keyframes, 0 to {}", n - 1)),
        (None, _) => finding.help(format!("use one of its keyframes: {}", list.join(", "))),
    });
    None
}
