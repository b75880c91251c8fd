//! The claims of a lesson: checks every `verify` object, and lists the questions without one.

use super::partners::{self, Partners};
use super::resolved_labs::{ResolvedLabs, resolve_labs};
use super::{PreparedLab, claim_id, prepared_lab, setconst};
use crate::bind::scene::Models;
use crate::finding::Finding;
use crate::json::read::named;
use crate::ledger::State;
use crate::rules;
use crate::spec::{ClaimComment, Lab, Lesson, Question, QuestionKind, Verify};
use crate::verify::{self, Answer, BoundLab, BoundVerify, Judgement, QuoteState, RenderedText, RunCache};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A question, or a lab with a `verify` object, and the results of its claims.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Claim {
    /// The owner of the claims: `quiz fall, question 2`, `lab #2`.
    pub name: String,
    /// Bytes of the lesson.
    pub span: Range<usize>,
    /// The results. A question always has an answer, possibly an unverified one; a lab never has one.
    pub judgement: Judgement,
}

impl Claim {
    /// Whether any of its claims is false or unchecked: then its evidence is printed.
    pub fn is_doubtful(&self) -> bool {
        let doubtful = |state: State| matches!(state, State::False | State::Unchecked);
        let judgement = &self.judgement;
        judgement.answer.as_ref().is_some_and(|a| doubtful(a.verdict.state()))
            || judgement.quotes.iter().any(|q| q.state != QuoteState::Right)
            || judgement.exact.iter().any(|e| doubtful(e.state))
    }
}

/// The spans of the `verify` objects of questions whose answers are true.
pub(super) fn verified_answers(claims: &[Claim]) -> Vec<Range<usize>> {
    let is_true = |claim: &&Claim| {
        claim.judgement.answer.as_ref().is_some_and(|answer| matches!(answer.verdict.state(), State::True(_)))
    };
    claims.iter().filter(is_true).map(|claim| claim.span.clone()).collect()
}

/// The owner of claims.
pub(super) enum Owner<'a> {
    /// A lab with a `verify` object.
    Lab(&'a Lab),
    /// A question, with or without a `verify` object.
    Question(&'a Question),
    /// A comment in the text.
    ClaimComment(&'a ClaimComment),
}

impl<'a> Owner<'a> {
    /// Its `verify` object including shared parts, the lab that it refers to unless it names another, and its question.
    pub(super) fn claim(
        &self,
        lesson: &'a Lesson,
    ) -> Option<(&'a Verify, Option<&'a Lab>, Option<&'a Question>)> {
        let (verify, lab, question) = match self {
            Owner::Lab(lab) => (lab.verify.as_ref()?, Some(*lab), None),
            Owner::Question(q) => (q.verify.as_ref()?, q.sim(), Some(*q)),
            Owner::ClaimComment(comment) => (&comment.verify, None, None),
        };
        Some((lesson.whole(verify), lab, question))
    }

    /// The bytes that it refers to, unless it refers to the whole lesson.
    pub(super) fn block(&self) -> Option<&'a Range<usize>> {
        match self {
            Owner::ClaimComment(comment) => Some(&comment.over),
            _ => None,
        }
    }
}

/// All owners of claims by name: labs, then questions, then comments.
pub(super) fn owners(lesson: &Lesson) -> Vec<(String, Owner<'_>)> {
    let mut all = Vec::new();
    let addressed = lesson.addressed();
    for (address, lab) in &addressed {
        all.push((format!("lab {address}"), Owner::Lab(lab)));
    }
    for lab in lesson.all_labs() {
        // Labs inside `verify` objects have no address.
        if !addressed.iter().any(|(_, addressed_lab)| std::ptr::eq(*addressed_lab, lab)) {
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
    for comment in &lesson.claim_comments {
        let line = lesson.file.position(comment.span.start).line;
        all.push((format!("comment in line {line}"), Owner::ClaimComment(comment)));
    }
    all
}

/// The answer of a question without a check. An open question has no keyed answer that could be right or wrong.
pub(super) fn unclaimed(question: &Question) -> Option<Answer> {
    let reason = match &question.verify {
        _ if matches!(question.kind, QuestionKind::Open { .. }) => return None,
        Some(verify) if verify.claims_answer() => return None,
        Some(_) => "its `verify` has neither `options` nor `value`",
        None => "it has no `verify`",
    };
    Some(Answer::unverified(reason))
}

/// Lints the texts of every `verify` object without executing runs.
pub(super) fn bind(lesson: &Lesson, ready: &[PreparedLab<'_>], models: &Models, findings: &mut Vec<Finding>) {
    let stage = RunCache::new(models, lesson.conventions.languages);
    for (_, owner) in owners(lesson) {
        if let Some((verify, lab, _)) = owner.claim(lesson)
            && let Some(resolved) = resolve_labs(lesson, ready, verify, lab, &stage, findings)
            && let Some(bound) =
                BoundVerify::new(verify, resolved.base.as_ref(), &resolved.runs, &stage, findings)
        {
            verify::lint_verify(&bound, verify, findings);
        }
    }
}

/// Whether a claim consists of formulas alone.
pub(super) fn have_formulas(lesson: &Lesson) -> bool {
    let claims = owners(lesson).into_iter().filter_map(|(_, owner)| owner.claim(lesson));
    claims.into_iter().any(|(verify, lab, _)| verify.lab.is_none() && lab.is_none() && verify.is_formulas())
}

/// Checks every `verify` object of a lesson. Questions without one are listed with an unverified answer.
pub(super) fn check_claims<'l>(
    lesson: &'l Lesson,
    ready: &mut [PreparedLab<'l>],
    models: &Models,
    findings: &mut Vec<Finding>,
) -> Vec<Claim> {
    let rendered = RenderedText::of_lesson(lesson);
    let candidates = partners::observe(lesson, ready);
    let ready = &*ready;
    let partners = Partners::new(lesson, ready, models, candidates);
    let mut checker = ClaimChecker {
        lesson,
        ready,
        rendered,
        stage: RunCache::new(models, lesson.conventions.languages),
        partners,
        list: Vec::new(),
    };
    for (name, owner) in owners(lesson) {
        match owner {
            Owner::Lab(lab) => checker.judge_lab(name, lab, findings),
            Owner::Question(question) => checker.judge_question(name, question, findings),
            Owner::ClaimComment(comment) => checker.judge_comment(name, comment, findings),
        }
    }
    checker.list
}

struct ClaimChecker<'a> {
    lesson: &'a Lesson,
    ready: &'a [PreparedLab<'a>],
    rendered: RenderedText,
    stage: RunCache<'a>,
    partners: Partners<'a>,
    list: Vec<Claim>,
}

impl ClaimChecker<'_> {
    fn judge_lab(&mut self, name: String, lab: &Lab, findings: &mut Vec<Finding>) {
        if let Some(verify) = &lab.verify {
            let judgement = self.judge_as(&name, verify, Some(lab), None, &self.rendered, findings);
            self.list.push(Claim { name, span: verify.span.clone(), judgement });
        }
    }

    fn judge_question(&mut self, name: String, question: &Question, findings: &mut Vec<Finding>) {
        let mut judgement = match &question.verify {
            Some(verify) => {
                self.judge_as(&name, verify, question.sim(), Some(question), &self.rendered, findings)
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

    fn judge_comment(&mut self, name: String, comment: &ClaimComment, findings: &mut Vec<Finding>) {
        let rendered = self.rendered.within(&comment.over, &comment.verify);
        let judgement = self.judge_as(&name, &comment.verify, None, None, &rendered, findings);
        self.list.push(Claim { name, span: comment.verify.span.clone(), judgement });
    }

    /// Checks a claim, and sets its identity in the findings.
    fn judge_as(
        &self,
        name: &str,
        verify: &Verify,
        lab: Option<&Lab>,
        question: Option<&Question>,
        rendered: &RenderedText,
        findings: &mut Vec<Finding>,
    ) -> Judgement {
        // An object with errors is incomplete, so its remaining part may differ from what the author meant.
        let inside = |f: &&Finding| verify.span.start <= f.span.start && f.span.end <= verify.span.end;
        if self.lesson.findings.iter().filter(inside).any(Finding::is_error) {
            return verify::not_executable(self.lesson.whole(verify), question, "its `verify` has errors");
        }
        let mut found = Vec::new();
        let judgement = self.judge(verify, lab, question, rendered, &mut found);
        claim_id::identify(name, self.lesson.whole(verify), question, &judgement, &mut found);
        // Several objects can use the measures of one.
        let code = rules::MEASURE_WITHOUT_VALUE.code;
        found.retain(|f| {
            f.code != code || !findings.iter().any(|other| other.code == code && other.span == f.span)
        });
        findings.extend(found);
        judgement
    }

    fn judge(
        &self,
        verify: &Verify,
        lab: Option<&Lab>,
        question: Option<&Question>,
        rendered: &RenderedText,
        findings: &mut Vec<Finding>,
    ) -> Judgement {
        let verify = self.lesson.whole(verify);
        let before = findings.len();
        let Some(ResolvedLabs { base, runs }) =
            resolve_labs(self.lesson, self.ready, verify, lab, &self.stage, findings)
        else {
            let reported = findings.len() > before;
            let reason = if reported { "a run cannot be executed" } else { "its lab cannot run" };
            return verify::not_executable(verify, question, reason);
        };
        for (run, scenes) in verify.runs.iter().zip(&runs) {
            if let Some(BoundLab { lab, model, programs, .. }) = scenes.first() {
                setconst::check_run(verify, run, lab, model, programs, findings);
            }
        }
        match BoundVerify::new(verify, base.as_ref(), &runs, &self.stage, findings) {
            Some(bound) => {
                if let Some(reason) = incomplete_lab(verify, base.as_ref(), &runs) {
                    verify::lint_verify(&bound, verify, findings);
                    return verify::not_executable(verify, question, &reason);
                }
                self.stage.take_uncoupled_change();
                let mut judgement = verify::check_verify(&bound, verify, question, rendered, findings);
                // If no run changed a parameter without its coupled parameters, the corrected runs are the same.
                if self.stage.take_uncoupled_change() {
                    self.partners.settle(verify, lab, question, rendered, &mut judgement, findings);
                }
                judgement
            }
            None => verify::not_executable(verify, question, "its runs or measures have errors"),
        }
    }
}

/// Why the runs of a `verify` object are not what its lab describes: a program that they execute has errors, which are
/// reported. Nothing is concluded from such runs.
fn incomplete_lab(
    verify: &Verify,
    base: Option<&BoundLab<'_>>,
    runs: &[Vec<BoundLab<'_>>],
) -> Option<String> {
    let reason = |scene: &BoundLab<'_>, pressed: &[&str]| {
        if scene.lab.stop_at.as_ref().is_some_and(|stop| stop.value <= 0.0) {
            return Some("the `stopAt` of its lab is not positive".to_string());
        }
        if scene.lab.unread_controls {
            return Some("a control of its lab cannot be read".to_string());
        }
        if let Some(key) = scene.lab.unread_key {
            return Some(format!("the `{key}` of its lab cannot be read"));
        }
        prepared_lab::program_with_errors(&scene.lab, &scene.programs, pressed)
    };
    let unread = verify.runs.iter().find_map(|run| Some((run, run.unread_key?)));
    if let Some((run, key)) = unread {
        return Some(format!("the `{key}` of its run {} cannot be read", named(run.name.as_str())));
    }
    let of_runs = verify.runs.iter().zip(runs).find_map(|(run, scenes)| {
        let pressed: Vec<&str> = run.press.iter().map(|(label, _)| label.as_str()).collect();
        scenes.iter().find_map(|scene| reason(scene, &pressed))
    });
    of_runs.or_else(|| base.filter(|_| runs.is_empty()).and_then(|scene| reason(scene, &[])))
}
