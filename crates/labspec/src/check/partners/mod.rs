//! Claims that depend on a physically inconsistent body or servo: a run in which a program changes a parameter without its
//! coupled parameters ([`coupled`](crate::bind::coupled)).
//!
//! Every `verify` object whose labs have such a program is checked a second time, with the coupled parameters corrected
//! after every program. A claim that holds only without the correction does not hold for the physical system that the text
//! describes.

mod dependency;

use super::resolved_labs::{ResolvedLabs, resolve_labs, start_runs};
use super::{PreparedLab, setconst};
use crate::bind::coupled::{self, Coupled, PairSet};
use crate::bind::scene::Models;
use crate::bind::{ControlProgram, Programs};
use crate::finding::{Finding, Severity};
use crate::json::read::named;
use crate::ledger::State;
use crate::source::Text;
use crate::spec::{Lab, Lesson, Question, Run, Sweep, Verify};
use crate::verify::{self, BoundVerify, Judgement, Measured, QuoteState, RenderedText, RunCache};
use dependency::Dependency;
use std::cell::OnceCell;

/// Relative change of a measure above which a difference is reported; a reader does not see a smaller one.
const MIN_RELATIVE_CHANGE: f64 = 1e-3;

/// A program that writes a parameter with coupled parameters.
#[derive(Clone)]
pub(super) struct PartnerCandidate<'a> {
    text: Text,
    /// The name of the program in messages.
    subject: String,
    pairs: PairSet,
    /// Its lab; `None` for the setup of a run.
    lab: Option<&'a Lab>,
    /// Whether it belongs to this lesson.
    in_lesson: bool,
    /// Whether it is a modification of the model's text.
    change: bool,
}

impl PartnerCandidate<'_> {
    /// Describes the parameters that it does not update.
    fn left(&self) -> String {
        let mut partners: Vec<&str> = self.pairs.pairs().map(|(_, pair)| pair.left).collect();
        partners.dedup();
        format!("{} does not update {}", self.subject, partners.join(" and "))
    }
}

/// The labs of a lesson with corrected coupled parameters, and a cache of their runs.
pub(super) struct Partners<'a> {
    lesson: &'a Lesson,
    models: &'a Models,
    labs: &'a [PreparedLab<'a>],
    candidates: Vec<PartnerCandidate<'a>>,
    /// Computed on first use: most lessons change no parameter with coupled parameters.
    corrected: OnceCell<Vec<PreparedLab<'a>>>,
    stage: RunCache<'a>,
}

/// The numerics of a check.
#[derive(Clone, Copy)]
enum TestedNumerics {
    /// The numerics of the lesson.
    Nominal,
    /// All numerics under which a claim must hold.
    All,
}

/// The claims to check, with their owner.
#[derive(Clone, Copy)]
struct ClaimOwner<'c> {
    verify: &'c Verify,
    lab: Option<&'c Lab>,
    question: Option<&'c Question>,
    rendered: &'c RenderedText,
}

/// The programs of all labs that write a parameter with coupled parameters.
fn candidates<'a>(lesson: &'a Lesson, labs: &[PreparedLab<'a>]) -> Vec<PartnerCandidate<'a>> {
    let all = lesson.all_labs();
    let mut candidates = Vec::new();
    for ready in labs {
        let programs = &ready.programs;
        let in_lesson = all.iter().any(|lab| std::ptr::eq(*lab, ready.lab));
        let of_lab = [("the setup", &programs.setup), ("the controller", &programs.controller)];
        let named = of_lab.into_iter().map(|(subject, bound)| (subject.to_string(), bound.as_ref()));
        let controls = programs.controls.iter().map(|(label, program)| match program {
            ControlProgram::Change(_, action) => (format!("\"{label}\""), action.run.as_ref()),
            ControlProgram::Press(run) => (format!("\"{label}\""), run.as_ref()),
        });
        for (subject, bound) in named.chain(controls) {
            let Some(bound) = bound else { continue };
            let written = PairSet::written_by(&bound.program);
            let pairs = written.without(coupled::intentionally_separate(programs, bound, written));
            let pairs = pairs.without(suppressed_pairs(lesson, &bound.text, pairs));
            candidates.push(PartnerCandidate {
                text: bound.text.clone(),
                subject,
                pairs,
                lab: Some(ready.lab),
                in_lesson,
                change: false,
            });
        }
    }
    candidates.retain(|c| !c.pairs.is_empty());
    candidates
}

/// The correction of every coupled parameter that programs do not update.
fn correction(candidates: &[PartnerCandidate<'_>]) -> Coupled {
    let programs = candidates.iter().map(|c| (c.text.clone(), c.pairs)).collect();
    Coupled { programs, others: PairSet::ALL, changes: PairSet::ALL, refresh: false }
}

/// Makes every run of the labs detect whether the correction would change it. If not, the corrected run is the same and is
/// not made. Returns the programs to correct.
pub(super) fn observe<'a>(lesson: &'a Lesson, labs: &mut [PreparedLab<'a>]) -> Vec<PartnerCandidate<'a>> {
    let candidates = candidates(lesson, labs);
    let correction = correction(&candidates);
    labs.iter_mut().for_each(|ready| ready.programs.observed = Some(correction.clone()));
    candidates
}

impl<'a> Partners<'a> {
    /// `labs` are the labs that [`observe`] changed, and `candidates` its result.
    pub(super) fn new(
        lesson: &'a Lesson,
        labs: &'a [PreparedLab<'a>],
        models: &'a Models,
        candidates: Vec<PartnerCandidate<'a>>,
    ) -> Partners<'a> {
        Partners {
            lesson,
            models,
            labs,
            candidates,
            corrected: OnceCell::new(),
            stage: RunCache::new(models, lesson.conventions.languages),
        }
    }

    /// All labs of the lesson with every coupled parameter corrected.
    fn corrected(&self) -> &[PreparedLab<'a>] {
        self.corrected.get_or_init(|| corrected(self.labs, &correction(&self.candidates)))
    }

    /// Checks a `verify` object again with corrected coupled parameters, after one of its runs changed a parameter without
    /// them. A claim that is no longer true is not true of the described system. The judgement states this, and so do
    /// findings at the claim and at the program.
    pub(super) fn settle(
        &self,
        verify: &Verify,
        lab: Option<&Lab>,
        question: Option<&Question>,
        rendered: &RenderedText,
        judgement: &mut Judgement,
        findings: &mut Vec<Finding>,
    ) {
        let case = ClaimOwner { verify, lab, question, rendered };
        let candidates = self.involved(case);
        if candidates.is_empty() {
            return;
        }
        // Perturbed numerics are tested only if the nominal results differ.
        let nominal = self.judge(case, self.corrected(), &self.stage, TestedNumerics::Nominal);
        if nominal.is_some_and(|second| !differs(judgement, &second)) {
            return;
        }
        let Some(second) = self.judge(case, self.corrected(), &self.stage, TestedNumerics::All) else {
            return;
        };
        if !differs(judgement, &second) || self.is_contrasted(case, judgement, &second) {
            return;
        }
        let causes = self.causes(case, &candidates, judgement);
        let dependency = Dependency::new(&causes, judgement, &second);
        let evidence = dependency.evidence.clone();
        dependency.apply(case, judgement, second, findings);
        for cause in causes.iter().filter(|c| c.in_lesson) {
            for (rule, pairs) in setconst::by_rule(cause.pairs) {
                let span = cause.text.span();
                if findings.iter().any(|f| f.code == rule.code && f.span == span) {
                    continue;
                }
                let with: Vec<&str> = pairs.iter().map(|p| p.corrected).collect();
                let why = format!("{evidence} with {}", with.join(" and "));
                let finding = setconst::left(rule, span, &cause.subject, &pairs, Severity::Warning);
                findings.push(if evidence.is_empty() { finding } else { finding.why(why) });
            }
        }
    }

    /// The programs of the labs of an object, and the setups of its runs.
    fn involved(&self, case: ClaimOwner<'_>) -> Vec<PartnerCandidate<'a>> {
        let ClaimOwner { verify, lab, .. } = case;
        let base = verify.lab.as_ref().map_or(lab, |named| self.lesson.named(named));
        let of_run = |run| lab_of(self.lesson, base, run);
        let labs: Vec<&Lab> = base.into_iter().chain(verify.runs.iter().filter_map(of_run)).collect();
        let follows = |c: &&PartnerCandidate<'_>| {
            labs.iter().any(|lab| c.lab.is_some_and(|of_claim| std::ptr::eq(of_claim, *lab)))
        };
        let mut all: Vec<PartnerCandidate<'a>> = self.candidates.iter().filter(follows).cloned().collect();
        for text in changes(verify) {
            let pairs = PairSet::ALL.without(suppressed_pairs(self.lesson, text, PairSet::ALL));
            let subject = format!("the change of `{}`", text.value);
            all.push(PartnerCandidate {
                text: text.clone(),
                subject,
                pairs,
                lab: None,
                in_lesson: true,
                change: true,
            });
        }
        for run in &verify.runs {
            let lab = of_run(run).and_then(|lab| self.labs.iter().find(|r| std::ptr::eq(r.lab, lab)));
            let (Some(text), Some(ready)) = (&run.setup, lab) else { continue };
            let bench = setconst::SetConstBench::new(ready.lab, &ready.model, &ready.programs);
            let Some(bound) = bench.compile(text, &text.value, None) else { continue };
            let pairs = PairSet::written_by(&bound.program);
            let pairs = pairs.without(suppressed_pairs(self.lesson, text, pairs));
            let subject = format!("the setup of the run {}", named(&run.name.value));
            if !pairs.is_empty() {
                all.push(PartnerCandidate {
                    text: text.clone(),
                    subject,
                    pairs,
                    lab: None,
                    in_lesson: true,
                    change: false,
                });
            }
        }
        all
    }

    /// Checks a `verify` object with these labs.
    fn judge(
        &self,
        case: ClaimOwner<'_>,
        labs: &[PreparedLab<'_>],
        stage: &RunCache<'_>,
        numerics: TestedNumerics,
    ) -> Option<Judgement> {
        let mut ignored = Vec::new();
        let ClaimOwner { verify, lab, question, rendered } = case;
        let ResolvedLabs { base, runs } = resolve_labs(self.lesson, labs, verify, lab, stage, &mut ignored)?;
        let bound = BoundVerify::new(verify, base.as_ref(), &runs, stage, &mut ignored)?;
        match numerics {
            TestedNumerics::Nominal => verify::check_nominal(&bound, verify, question, rendered),
            TestedNumerics::All => {
                Some(verify::check_verify(&bound, verify, question, rendered, &mut ignored))
            }
        }
    }

    /// Whether every run that the correction changes is accompanied by the corrected run: then the author shows the
    /// difference intentionally.
    fn is_contrasted(&self, case: ClaimOwner<'_>, first: &Judgement, second: &Judgement) -> bool {
        let [as_is, corrected] = [self.labs, self.corrected()].map(|labs| {
            let stage = RunCache::new(self.models, self.lesson.conventions.languages);
            let started = start_runs(self.lesson, labs, case.verify, case.lab, &stage);
            started.map_or(Vec::new(), |started| started.runs)
        });
        let changed = |run: &str| {
            let of_run = |m: &Measured| m.name.split_once('.').is_some_and(|(name, _)| name == run);
            pairs(first, second).any(|(a, b)| of_run(a) && moved(a, b))
        };
        let mut changed = corrected.iter().filter(|(run, _)| changed(run)).peekable();
        changed.peek().is_some()
            && changed.all(|(run, model)| {
                let others = as_is.iter().filter(|(other, _)| other != run).filter_map(|(_, m)| m.as_ref());
                model.as_ref().is_some_and(|model| others.into_iter().any(|m| coupled::agree(m, model)))
            })
    }

    /// The programs, and the pairs of each, whose correction alone changes the results.
    fn causes(
        &self,
        case: ClaimOwner<'_>,
        candidates: &[PartnerCandidate<'a>],
        first: &Judgement,
    ) -> Vec<PartnerCandidate<'a>> {
        let single = |c: &PartnerCandidate<'_>| c.pairs.pairs().count() == 1;
        if candidates.len() == 1 && candidates.iter().all(single) {
            return candidates.to_vec();
        }
        let mut causes = Vec::new();
        for candidate in candidates {
            let matters = |(one, _)| {
                let changes = if candidate.change { one } else { PairSet::NONE };
                let programs = vec![(candidate.text.clone(), one)];
                let alone = Coupled { programs, others: PairSet::NONE, changes, refresh: false };
                let labs = corrected(self.labs, &alone);
                let second = self.judge(
                    case,
                    &labs,
                    &RunCache::new(self.models, self.lesson.conventions.languages),
                    TestedNumerics::All,
                )?;
                differs(first, &second).then_some(one)
            };
            let pairs: PairSet = candidate.pairs.pairs().filter_map(matters).collect();
            if !pairs.is_empty() {
                causes.push(PartnerCandidate { pairs, ..candidate.clone() });
            }
        }
        if causes.is_empty() { candidates.to_vec() } else { causes }
    }
}

/// Modifications of a model's text that change a parameter without compiling its coupled parameters: explicit inertias,
/// gains and biases of general actuators.
fn changes(verify: &Verify) -> impl Iterator<Item = &Text> {
    let runs = verify.runs.iter();
    let of_runs = runs
        .flat_map(|run| run.model.iter().map(|c| &c.path).chain(run.sweep.iter().flat_map(Sweep::subjects)));
    let alone = |text: &&Text| {
        let mut words = text.value.split_whitespace();
        words.any(|word| ["inertial", "gainprm", "biasprm"].contains(&word))
    };
    of_runs.chain(verify.find.iter().map(|find| &find.what)).filter(alone)
}

/// The lab of a run.
fn lab_of<'c>(lesson: &'c Lesson, base: Option<&'c Lab>, run: &'c Run) -> Option<&'c Lab> {
    run.lab.as_ref().map_or(base, |named| lesson.named(named))
}

/// Labs with corrected coupled parameters.
fn corrected<'a>(labs: &[PreparedLab<'a>], coupled: &Coupled) -> Vec<PreparedLab<'a>> {
    let one = |ready: &PreparedLab<'a>| {
        let mut programs = Programs { observed: None, ..ready.programs.clone() };
        coupled.clone().install(&mut programs, &ready.model);
        PreparedLab { lab: ready.lab, model: ready.model.clone(), programs, mistakes: ready.mistakes }
    };
    labs.iter().map(one).collect()
}

/// The pairs whose rule the author has suppressed at this place.
fn suppressed_pairs(lesson: &Lesson, text: &Text, pairs: PairSet) -> PairSet {
    let start = text.span().start;
    let allowances = lesson.allowances();
    let here =
        allowances.iter().filter(|a| !a.why.is_empty() && a.over.start <= start && start <= a.over.end);
    let codes: Vec<&str> = here.flat_map(|a| &a.codes).map(|(code, _)| code.as_str()).collect();
    pairs.pairs().filter(|(_, pair)| codes.contains(&pair.rule.code)).map(|(one, _)| one).collect()
}

/// Whether a measure differs by more than the effect of half the timestep.
fn moved(a: &Measured, b: &Measured) -> bool {
    if a.value.is_nan() || b.value.is_nan() {
        return a.value.is_nan() != b.value.is_nan();
    }
    let difference = (a.value - b.value).abs();
    let numerics = a.halved.map_or(0.0, |h| (h - a.value).abs());
    difference > MIN_RELATIVE_CHANGE * a.value.abs().max(b.value.abs()) && difference > numerics
}

fn pairs<'j>(a: &'j Judgement, b: &'j Judgement) -> impl Iterator<Item = (&'j Measured, &'j Measured)> {
    a.measures.iter().zip(&b.measures).filter(|(x, y)| x.name == y.name)
}

/// Whether the claims depend on the correction: a measure differs, or the truth of a claim.
fn differs(a: &Judgement, b: &Judgement) -> bool {
    let held = |j: &Judgement| {
        let answer = j.answer.iter().map(|a| matches!(a.verdict.state(), State::True(_)));
        let quotes = j.quotes.iter().map(|q| q.state == QuoteState::Right);
        let exact = j.exact.iter().map(|e| matches!(e.state, State::True(_)));
        answer.chain(quotes).chain(exact).collect::<Vec<_>>()
    };
    held(a) != held(b) || pairs(a, b).any(|(x, y)| moved(x, y))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use crate::lint::{ModelFolder, load_lesson_file};
    use crate::run::{Session, Start};
    use crate::stress::{self, Action, Interaction, InteractionKind};
    use std::path::{Path, PathBuf};

    /// The lessons of a folder, `.md` and `.json`.
    fn lessons(folder: &Path) -> Vec<PathBuf> {
        let mut all: Vec<PathBuf> =
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        all.retain(|path| path.extension().is_some_and(|e| e == "md" || e == "json"));
        all.sort();
        all
    }

    /// The bits of the state and of the displayed values after each of some steps.
    fn bits(ready: &PreparedLab<'_>, programs: &Programs, actions: &[Action]) -> (Vec<u64>, bool) {
        let mut session = Session::start(programs, &ready.model, Start::of_lab(ready.lab));
        for action in actions {
            match &action.value {
                Some(value) => session.set_control(action.control, value.clone()),
                None => session.press(action.control),
            }
        }
        let mut all = Vec::new();
        for _ in 0..200 {
            session.step();
            let d = session.world.data.fields();
            all.extend(d.qpos.iter().chain(&d.qvel).chain(&d.act).map(|x| x.to_bits()));
            all.extend(session.sample().iter().map(|cell| cell.number().to_bits()));
        }
        (all, session.has_uncoupled_change())
    }

    /// A run that reports no omitted coupled parameter equals the corrected run bit for bit, so `verify` does not make the
    /// corrected run.
    #[test]
    fn a_run_without_uncoupled_changes_equals_the_corrected_one() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let specs = (root.join("specs/lessons"), root.join("specs/models"));
        let corpus = root.join("../shared/corpus");
        let folders = [specs, (corpus.join("labs"), corpus.join("models"))];
        let (mut clean, mut left) = (0, 0);
        for (folder, models) in folders {
            if folder.starts_with(&corpus) && !corpus.is_dir() {
                assert!(std::env::var_os("LABSPEC_REQUIRE").is_none(), "{} is missing", corpus.display());
                println!("skipped: there is no folder {}", corpus.display());
                continue;
            }
            let models = Models::new(ModelFolder::open(&models).unwrap());
            for path in lessons(&folder) {
                let lesson = load_lesson_file(&path, models.folder()).unwrap();
                let labs = lesson.all_labs().into_iter();
                let bound = |lab| {
                    let (model, programs, mistakes) = super::super::bind(lab, &models, &mut Vec::new())?;
                    Some(PreparedLab { lab, model, programs, mistakes })
                };
                let mut labs: Vec<PreparedLab<'_>> = labs.filter_map(bound).collect();
                let correction = correction(&observe(&lesson, &mut labs));
                for (ready, amended) in labs.iter().zip(corrected(&labs, &correction)) {
                    let base = Interaction { kind: InteractionKind::AsItStands, actions: Vec::new() };
                    for interaction in stress::list_interactions(ready.lab, 1.0, &base).0 {
                        let (seen, behind) = bits(ready, &ready.programs, &interaction.actions);
                        let (expected, _) = bits(&amended, &amended.programs, &interaction.actions);
                        let what = interaction.describe(&ready.programs);
                        assert!(behind || seen == expected, "{}: {what}", path.display());
                        if behind { left += 1 } else { clean += 1 }
                    }
                }
            }
        }
        // Both kinds must occur, otherwise the comparison has no content.
        assert!(clean > 50 && left > 0, "{clean} clean, {left} left behind");
    }
}
