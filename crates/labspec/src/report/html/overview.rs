//! The top of the page: the summary, and how much of the course is claimed.

use super::lesson::LessonReport;
use super::question::QuestionPage;
use super::text::{plain, text};
use super::verdict::{bar, verdict};
use crate::finding::Finding;
use crate::ledger::State;
use crate::printable::counted;
use crate::report::Summary;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Writes the overview of the course.
pub(super) fn write(parts: &[LessonReport<'_>], summary: &str) -> String {
    let mut out = format!("<header>\n<h1>{}, checked</h1>\n", counted(parts.len(), "lesson"));
    let _ = writeln!(out, "<p class=\"summary\">{}</p>\n</header>", plain(summary));
    out.push_str("<section id=\"coverage\">\n<h2>How much is claimed</h2>\n");
    out.push_str(&whole(parts));
    out.push_str(&table(parts));
    out.push_str("</section>\n");
    out.push_str(&verdicts(parts));
    out
}

/// Questions that have a keyed answer.
fn keyed<'p, 'a>(part: &'p LessonReport<'a>) -> impl Iterator<Item = &'p QuestionPage<'a>> {
    part.questions.iter().filter(|q| q.word != "open")
}

fn is_claimed(asked: &&QuestionPage<'_>) -> bool {
    asked.state != State::NotClaimed
}

/// Writes the counts of numbers and questions of the course.
fn whole(parts: &[LessonReport<'_>]) -> String {
    let sum = |count: &dyn Fn(&LessonReport<'_>) -> usize| parts.iter().map(count).sum::<usize>();
    let (questions, checked) = (sum(&|p| keyed(p).count()), sum(&|p| keyed(p).filter(is_claimed).count()));
    let (numbers, claimed) = (sum(&|p| p.coverage.all()), sum(&|p| p.coverage.claimed));
    let mut out = String::from("<dl class=\"whole\">\n");
    for (what, part, all, done) in [
        ("Questions", checked, questions, "have a check"),
        ("Numbers with units", claimed, numbers, "are claimed"),
    ] {
        let _ = writeln!(out, "<div><dt>{what}</dt><dd>{} {part} of {all} {done}</dd></div>", bar(part, all));
    }
    out.push_str("</dl>\n");
    out
}

/// Writes a table with a row for each lesson.
fn table(parts: &[LessonReport<'_>]) -> String {
    let mut out = String::from("<div class=\"box\"><table>\n<thead><tr>");
    for head in ["lesson", "answers", "numbers with units", "findings"] {
        let _ = write!(out, "<th scope=\"col\">{head}</th>");
    }
    out.push_str("</tr></thead>\n<tbody>\n");
    for part in parts {
        let mut words: BTreeMap<(State, &str), usize> = BTreeMap::new();
        keyed(part).for_each(|q| *words.entry((q.state, q.word)).or_default() += 1);
        let answers: Vec<String> = words
            .iter()
            .map(|((state, word), n)| verdict(*state, &format!("{n} {}", called(*state, word))))
            .collect();
        let (all, claimed) = (part.coverage.all(), part.coverage.claimed);
        let numbers = if all == 0 {
            "none".into()
        } else {
            format!("<span class=\"number\">{} {claimed} of {all}</span>", bar(claimed, all))
        };
        let findings: Vec<Finding> = part.findings.iter().map(|f| (*f).clone()).collect();
        let _ = writeln!(
            out,
            "<tr><td><a href=\"#{}\">{}</a></td><td>{}</td><td>{numbers}</td><td>{}</td></tr>",
            part.anchor,
            text(part.name),
            if answers.is_empty() { "none".to_string() } else { answers.join(" ") },
            if findings.is_empty() { "none".to_string() } else { Summary::count(&findings).to_string() }
        );
    }
    out.push_str("</tbody></table></div>\n");
    out
}

/// The name of a verdict in a list.
fn called(state: State, word: &str) -> &str {
    if state == State::NotClaimed { "without a check" } else { word }
}

/// Writes the questions by verdict, and those with undecided options.
fn verdicts(parts: &[LessonReport<'_>]) -> String {
    let mut by_word: BTreeMap<(State, &str), Vec<(&LessonReport<'_>, &QuestionPage<'_>)>> = BTreeMap::new();
    let mut undecided = Vec::new();
    let mut options = 0;
    for part in parts {
        for q in keyed(part) {
            by_word.entry((q.state, q.word)).or_default().push((part, q));
            if q.undecided() > 0 {
                options += q.undecided();
                undecided.push((part, q));
            }
        }
    }
    if by_word.is_empty() {
        return String::new();
    }
    let mut out = String::from("<section id=\"questions\">\n<h2>Questions by verdict</h2>\n");
    // Verdicts that need work come first, true ones last.
    let good = |state: &State| matches!(state, State::True(_));
    let (last, first): (Vec<_>, Vec<_>) = by_word.iter().partition(|((state, _), _)| good(state));
    for ((state, word), all) in first.into_iter().chain(last) {
        let title = verdict(*state, &format!("{} {}", counted(all.len(), "question"), called(*state, word)));
        out.push_str(&list(&title, all, !good(state)));
    }
    if !undecided.is_empty() {
        let title = verdict(State::NotClaimed, &format!("{} undecided", counted(options, "option")));
        out.push_str(&list(&title, &undecided, false));
    }
    out.push_str("</section>\n");
    out
}

fn list(title: &str, all: &[(&LessonReport<'_>, &QuestionPage<'_>)], open: bool) -> String {
    let open = if open { " open=\"open\"" } else { "" };
    let mut out = format!("<details{open}><summary>{title}</summary>\n<ul>\n");
    for (part, q) in all {
        let _ =
            writeln!(out, "<li><a href=\"#{}\">{}: {}</a></li>", q.anchor, text(part.name), text(&q.name));
    }
    out.push_str("</ul></details>\n");
    out
}
