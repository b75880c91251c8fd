//! A question: its text, its key, and the result of each option.

use super::context::LessonContext;
use super::evidence::evidence;
use super::formula;
use super::text::{code, plain, text};
use super::verdict::{condition, verdict};
use crate::check::Claim;
use crate::ledger::State;
use crate::spec::{Question, QuestionKind, Verify};
use crate::verify::{self, Answer, Weight, significant};
use std::fmt::Write;

/// A question of a lesson, with the result of its check.
pub(super) struct QuestionPage<'a> {
    /// The anchor for links to it.
    pub(super) anchor: String,
    /// `quiz fall, question 2`.
    pub(super) name: String,
    pub(super) question: &'a Question,
    pub(super) claim: Option<&'a Claim>,
    /// Its state, and the word for it.
    pub(super) state: State,
    pub(super) word: &'a str,
    /// The reason.
    pub(super) remark: &'a str,
}

impl QuestionPage<'_> {
    /// Number of undecided options.
    pub(super) fn undecided(&self) -> usize {
        self.answer().map_or(0, |a| a.weights.iter().filter(|w| w.holds.is_none()).count())
    }

    fn answer(&self) -> Option<&Answer> {
        self.claim.and_then(|claim| claim.judgement.answer.as_ref())
    }

    fn weight(&self, option: Option<usize>) -> Option<&Weight> {
        self.answer()?.weights.iter().find(|w| w.option == option)
    }
}

/// Writes the section of a question.
pub(super) fn write(asked: &QuestionPage<'_>, context: &LessonContext<'_>) -> String {
    let QuestionPage { anchor, name, question, claim, state, word, remark } = asked;
    let spec = question.verify.as_ref();
    let line = context.line(question.span.start);
    let mut out = format!(
        "<article class=\"claim\" id=\"{anchor}\">\n<h4>{} <span class=\"name\">{}</span> <span class=\"soft\">line {line}</span></h4>\n",
        verdict(*state, word),
        text(name)
    );
    let _ = writeln!(out, "<p class=\"asked\">{}</p>", formula::of_html(&question.q.value));
    out.push_str(&format_answer(asked, spec));
    if !remark.is_empty() {
        let _ = writeln!(out, "<p class=\"why\">{}</p>", text(&context.names.shorten(remark)));
    }
    if let Some(explain) = &question.explain {
        let _ = writeln!(
            out,
            "<details><summary>Explanation</summary>\n<p class=\"explained\">{}</p></details>",
            formula::of_html(&explain.value)
        );
    }
    if let Some(claim) = claim {
        out.push_str(&evidence(claim, spec, context));
    }
    out.push_str("</article>\n");
    out
}

/// The options or the key of a question, with their conditions.
fn format_answer(asked: &QuestionPage<'_>, spec: Option<&Verify>) -> String {
    let mut out = String::new();
    match &asked.question.kind {
        QuestionKind::Choice { options, .. } => {
            // Options are counted from 0, as in conditions and messages.
            out.push_str("<ol class=\"options\" start=\"0\">\n");
            let right = asked.question.keyed().unwrap_or_default();
            for (i, option) in options.iter().enumerate() {
                let keyed = right.contains(&i);
                let (class, key) =
                    if keyed { (" class=\"key\"", " <b class=\"badge\">key</b>") } else { ("", "") };
                let _ = write!(out, "<li{class}><p>{}{key}</p>", formula::of_html(&option.value));
                let written = spec.and_then(|v| v.options.get(i)).map(|t| t.value.as_str());
                out.push_str(&format_condition(written, asked.weight(Some(i))));
                out.push_str("</li>\n");
            }
            out.push_str("</ol>\n");
        }
        QuestionKind::Numeric { unit, .. } => {
            let unit = unit.as_ref().map_or(String::new(), |u| format!(" {}", text(u.as_str())));
            let keyed = match asked.question.numeric() {
                Some((x, tol)) => {
                    let [x, tol] = [x, tol].map(|x| plain(&significant(x)));
                    format!("{x} ± {tol}{unit} <b class=\"badge\">key</b>")
                }
                None => "no answer is keyed".to_string(),
            };
            let _ = writeln!(out, "<p class=\"key\">{keyed}</p>");
            let written = spec.and_then(|v| v.value.as_ref()).map(|t| t.value.as_str());
            out.push_str(&format_condition(written, asked.weight(None)));
        }
        QuestionKind::TrueFalse { .. } => {
            let keyed = match asked.question.keyed().as_deref() {
                Some([]) => "The statement is false. <b class=\"badge\">key</b>",
                Some(_) => "The statement is true. <b class=\"badge\">key</b>",
                None => "no answer is keyed",
            };
            let _ = writeln!(out, "<p class=\"key\">{keyed}</p>");
            let written = spec.and_then(|v| v.options.first()).map(|t| t.value.as_str());
            out.push_str(&format_condition(written, asked.weight(Some(0))));
        }
        QuestionKind::Open { .. } => {
            out.push_str("<p class=\"soft\">An open question: no answer is keyed.</p>\n");
        }
    }
    out
}

/// A condition, and its margin.
fn format_condition(written: Option<&str>, weight: Option<&Weight>) -> String {
    let Some(written) = written else { return String::new() };
    let held = weight.map_or(String::new(), |w| condition(w.holds, &w.describe()));
    if written.trim() == verify::UNDECIDED {
        return format!("<p class=\"condition\">{held}</p>\n");
    }
    format!("<p class=\"condition\">{} {held}</p>\n", code(written))
}
