//! What a lesson claims: every `verify` object judged, every question without one named.

use super::{Ready, refresh};
use crate::finding::Finding;
use crate::ledger::State;
use crate::spec::{Lab, Lesson, Question, QuestionKind, Verify, VerifyLab};
use crate::verify::{self, Allowance, Answer, BoundVerify, Judgement, QuoteState, ShownText};
use std::ops::Range;

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

/// Judges every `verify` object of a lesson; questions without one are listed with an unverified answer.
pub(super) fn check(lesson: &Lesson, ready: &[Ready<'_>], findings: &mut Vec<Finding>) -> Vec<Claim> {
    let shown = ShownText::of(lesson);
    let mut court = Court { lesson, ready, shown, allowance: Allowance::default(), list: Vec::new() };
    let addressed = lesson.addressed();
    for (address, lab) in &addressed {
        court.judge_lab(format!("lab {address}"), lab, findings);
    }
    for lab in lesson.all_labs() {
        // Labs that stand inside `verify` objects have no address.
        if !addressed.iter().any(|(_, known)| std::ptr::eq(*known, lab)) {
            let line = lesson.file.position(lab.span.start).line;
            court.judge_lab(format!("lab in line {line}"), lab, findings);
        }
    }
    for quiz in &lesson.quizzes {
        let id = quiz.id.as_ref().map_or("", |t| t.as_str());
        for (number, question) in quiz.numbered() {
            court.judge_question(format!("quiz {id}, question {number}"), question, findings);
        }
    }
    court.list
}

struct Court<'a> {
    lesson: &'a Lesson,
    ready: &'a [Ready<'a>],
    shown: ShownText,
    allowance: Allowance,
    list: Vec<Claim>,
}

impl Court<'_> {
    fn judge_lab(&mut self, name: String, lab: &Lab, findings: &mut Vec<Finding>) {
        if let Some(verify) = &lab.verify {
            let judgement = self.judge(verify, Some(lab), None, findings);
            self.list.push(Claim { name, span: verify.span.clone(), judgement });
        }
    }

    fn judge_question(&mut self, name: String, question: &Question, findings: &mut Vec<Finding>) {
        let mut judgement = match &question.verify {
            Some(verify) => self.judge(verify, question.sim(), Some(question), findings),
            None => Judgement::default(),
        };
        // An open question has no keyed answer that could be right or wrong.
        if judgement.answer.is_none() && !matches!(question.kind, QuestionKind::Open { .. }) {
            let reason = match question.verify {
                Some(_) => "its `verify` has neither `options` nor `value`",
                None => "it has no `verify`",
            };
            judgement.answer = Some(Answer::unverified(reason));
        }
        let span = question.verify.as_ref().map_or(&question.span, |v| &v.span).clone();
        if judgement != Judgement::default() {
            self.list.push(Claim { name, span, judgement });
        }
    }

    fn judge(
        &self,
        verify: &Verify,
        own: Option<&Lab>,
        question: Option<&Question>,
        findings: &mut Vec<Finding>,
    ) -> Judgement {
        let lab = match &verify.lab {
            None => own,
            Some(VerifyLab::Inline(lab)) => Some(&**lab),
            Some(VerifyLab::Reference(_, address)) => self.lesson.lab(address),
            Some(VerifyLab::Broken) => None,
        };
        let Some(target) = lab.and_then(|lab| self.ready.iter().find(|r| std::ptr::eq(r.lab, lab))) else {
            return verify::unmade(verify, question, "its lab cannot run");
        };
        let Ready { lab, model, programs, .. } = target;
        refresh::check_runs(verify, lab, model, programs, findings);
        match BoundVerify::new(verify, lab, model, programs, &self.allowance, findings) {
            Some(bound) => verify::check(&bound, verify, question, &self.shown, findings),
            None => verify::unmade(verify, question, "its runs or measures have mistakes"),
        }
    }
}
