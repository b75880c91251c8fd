//! What a lesson claims: every `verify` object judged, every question without one named.

use super::partners::{self, Partners};
use super::{Ready, claim_id, setconst};
use crate::bind::scene::Models;
use crate::finding::Finding;
use crate::json::read;
use crate::ledger::State;
use crate::rules;
use crate::spec::{Lab, Lesson, Question, QuestionKind, Remark, Verify, VerifyLab};
use crate::verify::{self, Answer, BoundLab, BoundVerify, Judgement, QuoteState, ShownText, Stage};
use labspec_core::Model;
use std::ops::Range;
use std::sync::Arc;

/// A question, or a lab with a `verify` object, and what became of its claims.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// What claims it: `quiz fall, question 2`, `lab #2`.
    pub name: String,
    /// Bytes of the lesson.
    pub span: Range<usize>,
    /// What became of it. A question always has an answer here, if only an unverified one; a lab never.
    pub judgement: Judgement,
}

impl Claim {
    /// Whether anything about it is not simply true: then its evidence is shown.
    pub fn is_doubtful(&self) -> bool {
        let doubtful = |state: State| matches!(state, State::False | State::Unchecked);
        let judgement = &self.judgement;
        judgement.answer.as_ref().is_some_and(|a| doubtful(a.verdict.state()))
            || judgement.quotes.iter().any(|q| q.state != QuoteState::Right)
            || judgement.exact.iter().any(|e| doubtful(e.state))
    }
}

/// Who claims something.
pub(super) enum Owner<'a> {
    /// A lab with a `verify` object.
    Lab(&'a Lab),
    /// A question, with or without one.
    Question(&'a Question),
    /// A comment in the text.
    Remark(&'a Remark),
}

impl<'a> Owner<'a> {
    /// Its `verify` object with what that uses, the lab that this is about unless it names another, and its question.
    pub(super) fn claim(
        &self,
        lesson: &'a Lesson,
    ) -> Option<(&'a Verify, Option<&'a Lab>, Option<&'a Question>)> {
        let (verify, own, question) = match self {
            Owner::Lab(lab) => (lab.verify.as_ref()?, Some(*lab), None),
            Owner::Question(q) => (q.verify.as_ref()?, q.sim(), Some(*q)),
            Owner::Remark(remark) => (&remark.verify, None, None),
        };
        Some((lesson.whole(verify), own, question))
    }

    /// The bytes that it is about, where that is not all of the lesson.
    pub(super) fn block(&self) -> Option<&'a Range<usize>> {
        match self {
            Owner::Remark(remark) => Some(&remark.over),
            _ => None,
        }
    }
}

/// Everybody who claims something, by name: labs, then questions, then comments.
pub(super) fn owners(lesson: &Lesson) -> Vec<(String, Owner<'_>)> {
    let mut all = Vec::new();
    let addressed = lesson.addressed();
    for (address, lab) in &addressed {
        all.push((format!("lab {address}"), Owner::Lab(lab)));
    }
    for lab in lesson.all_labs() {
        // Labs that stand inside `verify` objects have no address.
        if !addressed.iter().any(|(_, known)| std::ptr::eq(*known, lab)) {
            let line = lesson.file.position(lab.span.start).line;
            all.push((format!("lab in line {line}"), Owner::Lab(lab)));
        }
    }
    for quiz in &lesson.quizzes {
        let id = quiz.id.as_ref().map_or("", |t| t.as_str());
        let questions = quiz.numbered();
        all.extend(questions.map(|(n, q)| (format!("quiz {id}, question {n}"), Owner::Question(q))));
    }
    all.retain(|(_, owner)| matches!(owner, Owner::Question(_)) || owner.claim(lesson).is_some());
    for remark in &lesson.remarks {
        let line = lesson.file.position(remark.span.start).line;
        all.push((format!("comment in line {line}"), Owner::Remark(remark)));
    }
    all
}

/// The answer of a question that nobody says how to check. An open question has no keyed answer that could be right or wrong.
pub(super) fn unclaimed(question: &Question) -> Option<Answer> {
    let reason = match &question.verify {
        _ if matches!(question.kind, QuestionKind::Open { .. }) => return None,
        Some(verify) if verify.claims_answer() => return None,
        Some(_) => "its `verify` has neither `options` nor `value`",
        None => "it has no `verify`",
    };
    Some(Answer::unverified(reason))
}

/// Looks at the texts of every `verify` object, and runs nothing.
pub(super) fn bind(lesson: &Lesson, ready: &[Ready<'_>], models: &Models, findings: &mut Vec<Finding>) {
    let stage = Stage::new(models);
    for (_, owner) in owners(lesson) {
        if let Some((verify, own, _)) = owner.claim(lesson)
            && let Some(cast) = resolve_labs(lesson, ready, verify, own, &stage, findings)
            && let Some(bound) = BoundVerify::new(verify, cast.base.as_ref(), &cast.runs, &stage, findings)
        {
            verify::lint_verify(&bound, verify, findings);
        }
    }
}

/// Whether somebody claims something by formulas alone.
pub(super) fn have_formulas(lesson: &Lesson) -> bool {
    let claims = owners(lesson).into_iter().filter_map(|(_, owner)| owner.claim(lesson));
    claims.into_iter().any(|(verify, own, _)| verify.lab.is_none() && own.is_none() && verify.is_formulas())
}

/// The labs of a `verify` object: its own, and that of each of its runs.
pub(super) struct ResolvedLabs<'r> {
    pub(super) base: Option<BoundLab<'r>>,
    pub(super) runs: Vec<Vec<BoundLab<'r>>>,
}

/// The labs that a `verify` object is about, if they can run. What a run cannot change in them goes to `findings`.
pub(super) fn resolve_labs<'r>(
    lesson: &'r Lesson,
    ready: &'r [Ready<'r>],
    verify: &'r Verify,
    own: Option<&'r Lab>,
    stage: &Stage<'_>,
    findings: &mut Vec<Finding>,
) -> Option<ResolvedLabs<'r>> {
    let base = match &verify.lab {
        // Formulas need no lab: they have one in which nothing is.
        None if own.is_none() && verify.is_formulas() => {
            ready.iter().find(|r| r.lab.is_nothing()).map(Ready::scene)
        }
        None => own.and_then(|lab| scene_of(ready, lab)),
        Some(named) => named_scene(lesson, ready, named, findings),
    };
    let mut runs = Vec::new();
    for run in &verify.runs {
        let lab = match &run.lab {
            None => base.clone(),
            Some(named) => named_scene(lesson, ready, named, findings),
        };
        runs.push(stage.of_run(&lab?, run, findings)?);
    }
    (base.is_some() || !runs.is_empty()).then_some(ResolvedLabs { base, runs })
}

fn scene_of<'r>(ready: &'r [Ready<'r>], lab: &Lab) -> Option<BoundLab<'r>> {
    ready.iter().find(|r| std::ptr::eq(r.lab, lab)).map(Ready::scene)
}

/// The lab that is named. Why one of another lesson is not there, or cannot run, goes to `findings`.
fn named_scene<'r>(
    lesson: &'r Lesson,
    ready: &'r [Ready<'r>],
    named: &'r VerifyLab,
    findings: &mut Vec<Finding>,
) -> Option<BoundLab<'r>> {
    let scene = lesson.named(named).and_then(|lab| scene_of(ready, lab));
    let (VerifyLab::Elsewhere(text, ..), None) = (named, &scene) else { return scene };
    let name = read::named(text.as_str());
    let message = match lesson.other(&text.span()).map(|other| &other.lab) {
        Some(Ok(_)) => format!("{name} cannot run, because its model or its code has errors"),
        Some(Err(why)) => format!("{name} does not exist: {why}"),
        None => format!("{name} does not exist: only this lesson was given, or it names too many others"),
    };
    findings.push(
        Finding::error(rules::UNKNOWN_LAB, text.span(), message)
            .why("claims about it cannot be checked")
            .help("check that lesson; name a lab of another lesson by its path from this one: other.md#2"),
    );
    None
}

/// A `verify` object bound to its labs. `None` where they have mistakes.
pub(super) fn bound<'r>(
    lesson: &'r Lesson,
    ready: &'r [Ready<'r>],
    verify: &'r Verify,
    own: Option<&'r Lab>,
    stage: &'r Stage<'r>,
) -> Option<BoundVerify<'r>> {
    let ResolvedLabs { base, runs } = resolve_labs(lesson, ready, verify, own, stage, &mut Vec::new())?;
    BoundVerify::new(verify, base.as_ref(), &runs, stage, &mut Vec::new())
}

/// What a `verify` object rests on.
pub(super) struct Begun {
    /// The model of its lab.
    pub(super) model: Option<Arc<Model>>,
    /// The model of every run as it begins.
    pub(super) runs: Vec<(String, Option<Model>)>,
}

/// Sets up the runs of a `verify` object, and makes none. `None` where they have mistakes.
pub(super) fn begun<'r>(
    lesson: &'r Lesson,
    ready: &'r [Ready<'r>],
    verify: &'r Verify,
    own: Option<&'r Lab>,
    stage: &'r Stage<'r>,
) -> Option<Begun> {
    let ResolvedLabs { base, runs } = resolve_labs(lesson, ready, verify, own, stage, &mut Vec::new())?;
    let bound = BoundVerify::new(verify, base.as_ref(), &runs, stage, &mut Vec::new())?;
    Some(Begun { runs: bound.begun(), model: base.map(|scene| scene.model) })
}

/// What the labs show in the runs of a `verify` object, up to so many; nothing where they have mistakes.
pub(super) fn curves<'r>(
    lesson: &'r Lesson,
    ready: &'r [Ready<'r>],
    verify: &'r Verify,
    own: Option<&'r Lab>,
    stage: &'r Stage<'r>,
    most: usize,
) -> Vec<verify::Curves> {
    let ignored = &mut Vec::new();
    let cast = resolve_labs(lesson, ready, verify, own, stage, ignored);
    let bound =
        cast.and_then(|cast| BoundVerify::new(verify, cast.base.as_ref(), &cast.runs, stage, ignored));
    bound.map_or(Vec::new(), |bound| bound.curves(most))
}

/// Judges every `verify` object of a lesson; questions without one are listed with an unverified answer.
pub(super) fn check<'l>(
    lesson: &'l Lesson,
    ready: &mut [Ready<'l>],
    models: &Models,
    findings: &mut Vec<Finding>,
) -> Vec<Claim> {
    let shown = ShownText::of(lesson);
    let candidates = partners::observe(lesson, ready);
    let ready = &*ready;
    let partners = Partners::new(lesson, ready, models, candidates);
    let mut court =
        ClaimChecker { lesson, ready, shown, stage: Stage::new(models), partners, list: Vec::new() };
    for (name, owner) in owners(lesson) {
        match owner {
            Owner::Lab(lab) => court.judge_lab(name, lab, findings),
            Owner::Question(question) => court.judge_question(name, question, findings),
            Owner::Remark(remark) => court.judge_remark(name, remark, findings),
        }
    }
    court.list
}

struct ClaimChecker<'a> {
    lesson: &'a Lesson,
    ready: &'a [Ready<'a>],
    shown: ShownText,
    stage: Stage<'a>,
    partners: Partners<'a>,
    list: Vec<Claim>,
}

impl ClaimChecker<'_> {
    fn judge_lab(&mut self, name: String, lab: &Lab, findings: &mut Vec<Finding>) {
        if let Some(verify) = &lab.verify {
            let judgement = self.judge_as(&name, verify, Some(lab), None, &self.shown, findings);
            self.list.push(Claim { name, span: verify.span.clone(), judgement });
        }
    }

    fn judge_question(&mut self, name: String, question: &Question, findings: &mut Vec<Finding>) {
        let mut judgement = match &question.verify {
            Some(verify) => {
                self.judge_as(&name, verify, question.sim(), Some(question), &self.shown, findings)
            }
            None => Judgement::default(),
        };
        if judgement.answer.is_none() {
            judgement.answer = unclaimed(question);
        }
        let span = question.verify.as_ref().map_or(&question.span, |v| &v.span).clone();
        if judgement != Judgement::default() {
            self.list.push(Claim { name, span, judgement });
        }
    }

    fn judge_remark(&mut self, name: String, remark: &Remark, findings: &mut Vec<Finding>) {
        let shown = self.shown.within(&remark.over, &remark.verify);
        let judgement = self.judge_as(&name, &remark.verify, None, None, &shown, findings);
        self.list.push(Claim { name, span: remark.verify.span.clone(), judgement });
    }

    /// The judgement of a claim; its findings carry the identity of the claim.
    fn judge_as(
        &self,
        name: &str,
        verify: &Verify,
        own: Option<&Lab>,
        question: Option<&Question>,
        shown: &ShownText,
        findings: &mut Vec<Finding>,
    ) -> Judgement {
        let mut found = Vec::new();
        let mut judgement = self.judge(verify, own, question, shown, &mut found);
        // What is left of an object with mistakes may say something else than what was meant.
        let inside = |f: &&Finding| verify.span.start <= f.span.start && f.span.end <= verify.span.end;
        if self.lesson.findings.iter().filter(inside).any(Finding::is_error) {
            judgement.withdraw("its `verify` has errors");
        }
        claim_id::identify(name, self.lesson.whole(verify), question, &judgement, &mut found);
        findings.extend(found);
        judgement
    }

    fn judge(
        &self,
        verify: &Verify,
        own: Option<&Lab>,
        question: Option<&Question>,
        shown: &ShownText,
        findings: &mut Vec<Finding>,
    ) -> Judgement {
        let verify = self.lesson.whole(verify);
        let before = findings.len();
        let Some(ResolvedLabs { base, runs }) =
            resolve_labs(self.lesson, self.ready, verify, own, &self.stage, findings)
        else {
            let told = findings.len() > before;
            let reason = if told { "a run cannot be made" } else { "its lab cannot run" };
            return verify::unmade(verify, question, reason);
        };
        for (run, scenes) in verify.runs.iter().zip(&runs) {
            if let Some(BoundLab { lab, model, programs, .. }) = scenes.first() {
                setconst::check_run(verify, run, lab, model, programs, findings);
            }
        }
        match BoundVerify::new(verify, base.as_ref(), &runs, &self.stage, findings) {
            Some(bound) => {
                self.stage.take_left_behind();
                let mut judgement = verify::check(&bound, verify, question, shown, findings);
                // Where no partner was left behind, there is nothing to correct, and every run with corrections is the same.
                if self.stage.take_left_behind() {
                    self.partners.settle(verify, own, question, shown, &mut judgement, findings);
                }
                judgement
            }
            None => verify::unmade(verify, question, "its runs or measures have errors"),
        }
    }
}
