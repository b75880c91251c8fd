//! A lesson: the contents of its blocks, in order, with the labs and the claims.

use super::address::LabAddress;
use super::comment::{ClaimComment, Definition};
use super::conventions::Conventions;
use super::lab::{Lab, Verify, VerifyLab};
use super::problem::Problem;
use super::quiz::Quiz;
use crate::finding::{Finding, Severity};
use crate::markdown::Scan;
use crate::source::{SourceFile, Sources, Text};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A lesson or a standalone JSON file, with all problems in its structure.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// The file.
    pub file: SourceFile,
    /// The labs, in order: `#1`, `#2`, …
    pub labs: Vec<LabEntry>,
    /// The quizzes, in order.
    pub quizzes: Vec<Quiz>,
    /// Blocks of other widgets, which are not run.
    pub widgets: Vec<Widget>,
    /// Byte ranges of the blocks with JSON that the page cannot parse. Their probable meaning is read and checked
    /// nevertheless.
    pub broken: Vec<Range<usize>>,
    /// The fences, the HTML and the listings of the Markdown.
    pub scan: Scan,
    /// Claims about blocks of the text, in comments before these blocks.
    pub claim_comments: Vec<ClaimComment>,
    /// Runs and measures with a name, which `verify` objects use.
    pub definitions: Vec<Definition>,
    /// The `verify` objects with a `use`, merged with the objects that they use.
    pub wholes: Vec<Verify>,
    /// Labs of other lessons that this one refers to. The code that has access to the files reads them.
    pub others: Vec<Other>,
    /// Problems found while reading.
    pub problems: Vec<Problem>,
    /// Findings of the structure rules, in order. Empty until [`lint`](crate::lint) has run.
    pub findings: Vec<Finding>,
    /// The stored snapshot of the results of its labs, or the reason that it cannot be read; `None` if there is none.
    pub snapshot: Option<Result<SourceFile, String>>,
    /// The files with values that its claims refer to.
    pub data: Vec<DataFile>,
    /// How its texts are read. Whoever reads the settings of the course sets it.
    pub conventions: Conventions,
    /// The path of the file, and the sources of its related files; `None` until these files were searched for.
    pub place: Option<(PathBuf, Sources)>,
}

/// A lab of a lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct LabEntry {
    /// Its number, from 1. A lab that could not be read also counts.
    pub number: usize,
    /// Byte range of the fence, or of the object in a JSON file.
    pub span: Range<usize>,
    /// Whether its JSON is malformed, so that the page cannot parse it. Such a lab must not be reported as clean.
    pub broken: bool,
    /// The lab; `None` if it could not be read, which is reported.
    pub lab: Option<Lab>,
}

/// A lab of another lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct Other {
    /// Byte range of the reference in this lesson. All ranges in the lab are equal to this one.
    pub span: Range<usize>,
    /// The file that contains it.
    pub path: String,
    /// The text of that file.
    pub text: String,
    /// The lab, or the reason that there is none.
    pub lab: Result<Lab, String>,
}

/// A file with values that a claim refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile {
    /// Its path.
    pub path: PathBuf,
    /// Its text, or the reason that it cannot be read.
    pub text: Result<Arc<str>, String>,
}

/// A block of another widget.
#[derive(Clone, Debug, PartialEq)]
pub struct Widget {
    /// The name of the widget.
    pub name: String,
    /// Byte range of the fence.
    pub span: Range<usize>,
    /// The model that it refers to.
    pub model: Option<Text>,
}

impl Lesson {
    /// The lab with this address.
    pub fn lab(&self, address: &LabAddress) -> Option<&Lab> {
        match address {
            LabAddress::Lab(n) => self.labs.get(n.checked_sub(1)?)?.lab.as_ref(),
            LabAddress::Sim { quiz, question } => {
                let quiz = self.quizzes.iter().find(|q| q.id.as_ref().is_some_and(|id| id.value == *quiz))?;
                quiz.questions.get(question.checked_sub(1)?)?.as_ref()?.sim()
            }
        }
    }

    /// The lab that a `verify` object or one of its runs refers to; `None` if there is none, or if it could not be read.
    pub fn named<'a>(&'a self, lab: &'a VerifyLab) -> Option<&'a Lab> {
        match lab {
            VerifyLab::Inline(lab) => Some(lab),
            VerifyLab::Reference(_, address) => self.lab(address),
            VerifyLab::Elsewhere(text, ..) => self.other(&text.span())?.lab.as_ref().ok(),
            VerifyLab::Broken => None,
        }
    }

    /// The lab of another lesson that is referred to in this byte range, if it was searched for.
    pub fn other(&self, span: &Range<usize>) -> Option<&Other> {
        self.others.iter().find(|other| other.span == *span)
    }

    /// All `verify` objects: first those of labs, then those of questions, then those in comments.
    pub fn verifies(&self) -> impl Iterator<Item = &Verify> {
        self.scoped().map(|(verify, _)| verify)
    }

    /// All `verify` objects, each with the byte range in which its quotes are searched for; `None` means the whole lesson.
    pub fn scoped(&self) -> impl Iterator<Item = (&Verify, Option<&Range<usize>>)> {
        let labs = self.all_labs().into_iter().filter_map(|lab| lab.verify.as_ref());
        let questions = self.quizzes.iter().flat_map(Quiz::numbered).filter_map(|(_, q)| q.verify.as_ref());
        let claim_comments = self.claim_comments.iter().map(|comment| (&comment.verify, Some(&comment.over)));
        labs.chain(questions).map(|verify| (verify, None)).chain(claim_comments)
    }

    /// All labs with an address: the labs in order, then the sims of the questions.
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

    /// All labs, including the inline labs of `verify` objects.
    pub fn all_labs(&self) -> Vec<&Lab> {
        let mut open: Vec<&Lab> = self.addressed().into_iter().map(|(_, lab)| lab).collect();
        let questions = self.quizzes.iter().flat_map(|q| q.numbered());
        open.extend(questions.filter_map(|(_, q)| q.verify.as_ref()).flat_map(inline));
        open.extend(self.claim_comments.iter().flat_map(|comment| inline(&comment.verify)));
        let mut all = Vec::new();
        // An inline lab can contain a `verify` object with another inline lab. The JSON depth limits the length of this
        // chain.
        while let Some(lab) = open.pop() {
            open.extend(lab.verify.iter().flat_map(inline));
            all.push(lab);
        }
        all
    }

    /// Whether this byte range is in a block whose JSON is malformed, so that the page cannot parse it.
    pub fn is_broken(&self, span: &Range<usize>) -> bool {
        self.broken.iter().any(|b| b.start <= span.start && span.end <= b.end)
    }

    pub(super) fn blocks_are_broken(&self) -> bool {
        !self.broken.is_empty()
    }

    /// Whether there is a finding with severity error.
    pub fn has_errors(&self) -> bool {
        self.findings.iter().any(|f| f.severity == Severity::Error)
    }
}

/// The inline labs of a `verify` object.
fn inline(verify: &Verify) -> impl Iterator<Item = &Lab> {
    verify.labs().filter_map(|lab| match lab {
        VerifyLab::Inline(lab) => Some(&**lab),
        _ => None,
    })
}
