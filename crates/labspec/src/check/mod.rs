//! The whole check of a lesson: structure, names, runs of every lab, verdicts of every question.

mod programs;
mod trial;

use crate::bind::Programs;
use crate::bind::scene::{Models, finding};
use crate::finding::{self, Finding};
use crate::spec::{Lab, LabAddress, Lesson, Question, Verify, VerifyLab};
use crate::verify::{self, BoundVerify, Claim, Verdict};
use labspec_core::Model;
use std::sync::Arc;

/// A lab that was run, for the report.
#[derive(Clone, Debug, PartialEq)]
pub struct RanLab {
    /// Its address in the lesson.
    pub address: LabAddress,
    /// Its title, possibly empty.
    pub title: String,
    /// Number of runs: as it stands, and with each control moved to its ends.
    pub runs: usize,
    /// `false` when it could not be run.
    pub ran: bool,
}

/// A lesson with everything that is known about it.
#[derive(Debug)]
pub struct Checked {
    /// The lesson.
    pub lesson: Lesson,
    /// Everything that is wrong, in order.
    pub findings: Vec<Finding>,
    /// The labs.
    pub labs: Vec<RanLab>,
    /// The questions and the labs with claims.
    pub claims: Vec<Claim>,
}

/// What a check does beyond structure and names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth {
    /// Run every lab.
    pub labs: bool,
    /// Verify every claim.
    pub claims: bool,
}

/// A lab with its model and programs.
struct Ready<'l> {
    lab: &'l Lab,
    model: Arc<Model>,
    programs: Programs,
}

/// Checks a lesson that has been read. Findings of model files are left in `models`.
pub fn check(lesson: Lesson, models: &mut Models, depth: Depth) -> Checked {
    let mut findings = Vec::new();
    let (labs, claims) = {
        let ready: Vec<Ready<'_>> =
            lesson.all_labs().into_iter().filter_map(|lab| prepare(lab, models, &mut findings)).collect();
        let labs = if depth.labs { trial::run_labs(&lesson, &ready, &mut findings) } else { Vec::new() };
        let claims = if depth.claims { claims(&lesson, &ready, &mut findings) } else { Vec::new() };
        (labs, claims)
    };
    let mut all = lesson.findings.clone();
    lesson.withhold_fixes(&mut findings);
    all.extend(findings.into_iter().map(|f| f.at(&lesson.file)));
    finding::sort(&mut all);
    Checked { lesson, findings: all, labs, claims }
}

/// Loads the model of a lab and binds its programs.
fn prepare<'l>(lab: &'l Lab, models: &mut Models, findings: &mut Vec<Finding>) -> Option<Ready<'l>> {
    let model = models.of(lab, findings)?;
    if let Some(key) = lab.key.as_ref().filter(|k| k.value >= model.nkey as f64) {
        findings.push(
            finding("keyframe-missing", key.span.clone(), format!("the model has no keyframe {}", key.value))
                .why("the page then silently starts from the default configuration")
                .help(match model.nkey {
                    0 => "the model has no keyframes: leave `key` out, or add <keyframe><key …/></keyframe> to it".to_string(),
                    n => format!("its keyframes are 0 to {}", n - 1),
                }),
        );
    }
    let programs = Programs::compile(lab, &model, findings);
    programs::check(lab, &programs, findings);
    Some(Ready { lab, model, programs })
}

/// Checks every `verify` object; questions without one are listed as unverified.
fn claims(lesson: &Lesson, ready: &[Ready<'_>], findings: &mut Vec<Finding>) -> Vec<Claim> {
    let mut list = Vec::new();
    for (address, lab) in lesson.addressed() {
        if let Some(verify) = &lab.verify {
            let name = format!("lab {address}");
            list.push(claim(name, verify, Some(lab), None, lesson, ready, findings));
        }
    }
    for quiz in &lesson.quizzes {
        let id = quiz.id.as_ref().map_or("", |t| t.as_str());
        for (number, question) in quiz.numbered() {
            let name = format!("quiz {id}, question {number}");
            match &question.verify {
                Some(verify) => {
                    list.push(claim(name, verify, question.sim(), Some(question), lesson, ready, findings))
                }
                None => list.push(Claim {
                    name,
                    span: question.span.clone(),
                    verdict: Verdict::Unverified,
                    measures: Vec::new(),
                    quotes: 0,
                }),
            }
        }
    }
    list
}

fn claim(
    name: String,
    verify: &Verify,
    own: Option<&Lab>,
    question: Option<&Question>,
    lesson: &Lesson,
    ready: &[Ready<'_>],
    findings: &mut Vec<Finding>,
) -> Claim {
    let lab = match &verify.lab {
        None => own,
        Some(VerifyLab::Inline(lab)) => Some(&**lab),
        Some(VerifyLab::Reference(_, address)) => lesson.lab(address),
        Some(VerifyLab::Broken) => None,
    };
    let target = lab.and_then(|lab| ready.iter().find(|r| std::ptr::eq(r.lab, lab)));
    let bound = target.and_then(|r| BoundVerify::new(verify, r.lab, &r.model, &r.programs, findings));
    let judgement = bound.map(|b| verify::check(&b, verify, question, lesson, findings));
    let (verdict, measures, quotes) =
        judgement.map_or((Verdict::Failed, Vec::new(), 0), |j| (j.verdict, j.measures, j.quotes));
    Claim { name, span: verify.span.clone(), verdict, measures, quotes }
}
