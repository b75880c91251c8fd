//! A lesson: what its fences hold, in order, and the labs and claims in it.

use super::address::LabAddress;
use super::comment::Remark;
use super::lab::{Lab, Verify, VerifyLab};
use super::problem::Problem;
use super::quiz::Quiz;
use crate::finding::{Finding, Severity};
use crate::markdown::Scan;
use crate::source::{SourceFile, Sources, Text};
use std::ops::Range;
use std::path::PathBuf;

/// A lesson, or a stand-alone JSON file, with everything that was found wrong in its structure.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// The file.
    pub file: SourceFile,
    /// The labs, in order: `#1`, `#2`, …
    pub labs: Vec<LabEntry>,
    /// The quizzes, in order.
    pub quizzes: Vec<Quiz>,
    /// Blocks of widgets that are not ours to run.
    pub widgets: Vec<Widget>,
    /// Bytes of the blocks whose JSON a page cannot read. What they were meant to be is read and checked all the same.
    pub broken: Vec<Range<usize>>,
    /// The fences, the HTML and the listings of its Markdown.
    pub scan: Scan,
    /// Claims about blocks of the text, in comments before them.
    pub remarks: Vec<Remark>,
    /// `verify` objects that use the runs and measures of others, with these.
    pub wholes: Vec<Verify>,
    /// Labs of other lessons that this one names. Whoever has the files reads them.
    pub others: Vec<Other>,
    /// What was wrong where it was read.
    pub problems: Vec<Problem>,
    /// What the rules of structure say of it, in order; nothing until [`lint`](crate::lint) has looked.
    pub findings: Vec<Finding>,
    /// What is stored beside it of what its labs show, or why that cannot be read; `None` where nothing is.
    pub snapshot: Option<Result<SourceFile, String>>,
    /// Where it lies, and where its neighbours were read from; `None` until somebody has looked for them.
    pub place: Option<(PathBuf, Sources)>,
}

/// A lab of a lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct LabEntry {
    /// Its number, from 1. A lab that could not be read keeps its number.
    pub number: usize,
    /// Bytes of the fence, or of the object in a JSON file.
    pub span: Range<usize>,
    /// Its JSON is broken: a page cannot read it. No verdict about it may say that it is clean.
    pub broken: bool,
    /// The lab; `None` when it could not be read, which is reported.
    pub lab: Option<Lab>,
}

/// A lab of another lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct Other {
    /// Bytes of its name in this lesson. All places in the lab are these.
    pub span: Range<usize>,
    /// The file that it stands in.
    pub path: String,
    /// What stands in that file.
    pub text: String,
    /// The lab, or why there is none.
    pub lab: Result<Lab, String>,
}

/// A block of another widget.
#[derive(Clone, Debug, PartialEq)]
pub struct Widget {
    /// The widget's name.
    pub name: String,
    /// Bytes of the fence.
    pub span: Range<usize>,
    /// The model it names.
    pub model: Option<Text>,
}

impl Lesson {
    /// The lab at an address.
    pub fn lab(&self, address: &LabAddress) -> Option<&Lab> {
        match address {
            LabAddress::Lab(n) => self.labs.get(n.checked_sub(1)?)?.lab.as_ref(),
            LabAddress::Sim { quiz, question } => {
                let quiz = self.quizzes.iter().find(|q| q.id.as_ref().is_some_and(|id| id.value == *quiz))?;
                quiz.questions.get(question.checked_sub(1)?)?.as_ref()?.sim()
            }
        }
    }

    /// The lab that a `verify` object or one of its runs names; `None` when there is none, or when it could not be read.
    pub fn named<'a>(&'a self, lab: &'a VerifyLab) -> Option<&'a Lab> {
        match lab {
            VerifyLab::Inline(lab) => Some(lab),
            VerifyLab::Reference(_, address) => self.lab(address),
            VerifyLab::Elsewhere(text, ..) => self.other(&text.span())?.lab.as_ref().ok(),
            VerifyLab::Broken => None,
        }
    }

    /// The lab of another lesson that is named at these bytes, where somebody has looked for it.
    pub fn other(&self, span: &Range<usize>) -> Option<&Other> {
        self.others.iter().find(|other| other.span == *span)
    }

    /// Every `verify` object: those of labs, then those of questions, then those in comments.
    pub fn verifies(&self) -> impl Iterator<Item = &Verify> {
        self.scoped().map(|(verify, _)| verify)
    }

    /// The same, each with the bytes that its quotes are looked for in, where that is not all of the lesson.
    pub fn scoped(&self) -> impl Iterator<Item = (&Verify, Option<&Range<usize>>)> {
        let labs = self.all_labs().into_iter().filter_map(|lab| lab.verify.as_ref());
        let questions = self.quizzes.iter().flat_map(Quiz::numbered).filter_map(|(_, q)| q.verify.as_ref());
        let remarks = self.remarks.iter().map(|remark| (&remark.verify, Some(&remark.over)));
        labs.chain(questions).map(|verify| (verify, None)).chain(remarks)
    }

    /// Every lab that has an address: labs in order, then the sims of the questions.
    pub fn addressed(&self) -> Vec<(LabAddress, &Lab)> {
        let mut all: Vec<_> =
            self.labs.iter().filter_map(|e| Some((LabAddress::Lab(e.number), e.lab.as_ref()?))).collect();
        for quiz in &self.quizzes {
            let id = quiz.id.as_ref().map_or("", Text::as_str);
            for (number, question) in quiz.numbered() {
                if let Some(sim) = question.sim() {
                    all.push((LabAddress::Sim { quiz: id.to_string(), question: number }, sim));
                }
            }
        }
        all
    }

    /// Every lab there is, those written inside `verify` objects included.
    pub fn all_labs(&self) -> Vec<&Lab> {
        let mut open: Vec<&Lab> = self.addressed().into_iter().map(|(_, lab)| lab).collect();
        let questions = self.quizzes.iter().flat_map(|q| q.numbered());
        open.extend(questions.filter_map(|(_, q)| q.verify.as_ref()).flat_map(inline));
        open.extend(self.remarks.iter().flat_map(|remark| inline(&remark.verify)));
        let mut all = Vec::new();
        // An inline lab may carry a verify object with another inline lab; JSON depth bounds the chain.
        while let Some(lab) = open.pop() {
            open.extend(lab.verify.iter().flat_map(inline));
            all.push(lab);
        }
        all
    }

    /// Whether a page cannot read the block that holds these bytes: its JSON is broken.
    pub fn is_broken(&self, span: &Range<usize>) -> bool {
        self.broken.iter().any(|b| b.start <= span.start && span.end <= b.end)
    }

    pub(super) fn blocks_are_broken(&self) -> bool {
        !self.broken.is_empty()
    }

    /// Whether anything is an error.
    pub fn has_errors(&self) -> bool {
        self.findings.iter().any(|f| f.severity == Severity::Error)
    }
}

/// The labs that are written in a `verify` object.
fn inline(verify: &Verify) -> impl Iterator<Item = &Lab> {
    verify.labs().filter_map(|lab| match lab {
        VerifyLab::Inline(lab) => Some(&**lab),
        _ => None,
    })
}
