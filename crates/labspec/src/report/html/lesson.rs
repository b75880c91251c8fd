//! One lesson of the page: its summary, findings, questions and labs.

use super::context::LessonContext;
use super::coverage::NumberCoverage;
use super::evidence::evidence;
use super::material::Material;
use super::question::{self, QuestionPage};
use super::text::{Names, code, plain, text};
use super::verdict::{severity, verdict};
use crate::check::{Checked, Claim, SuppressedFinding};
use crate::finding::Finding;
use crate::ledger::{Entry, Ledger, State, Subject};
use crate::printable::counted;
use crate::source::SourceFile;
use crate::spec::{Quiz, Verify};
use crate::verify::RenderedText;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Maximum number of listed unclaimed numbers.
const LISTED: usize = 200;

/// The data of a lesson's page.
pub(super) struct LessonReport<'a> {
    /// The anchor for links to it.
    pub(super) anchor: String,
    /// Its file.
    pub(super) name: &'a str,
    pub(super) summary: String,
    pub(super) findings: Vec<&'a Finding>,
    pub(super) allowed: Vec<&'a SuppressedFinding>,
    pub(super) coverage: NumberCoverage,
    pub(super) questions: Vec<QuestionPage<'a>>,
    checked: &'a Checked,
    context: LessonContext<'a>,
}

impl<'a> LessonReport<'a> {
    pub(super) fn new(
        number: usize,
        checked: &'a Checked,
        page: &Material<'a>,
        names: &'a Names,
    ) -> LessonReport<'a> {
        let lesson = &checked.lesson;
        let path = lesson.file.path();
        let mut ledger = Ledger::default();
        let mut entries: BTreeMap<_, Vec<&Entry>> = BTreeMap::new();
        for e in page.ledger.entries().iter().filter(|e| e.path == *path) {
            ledger.add(e.clone());
            entries.entry((e.subject, e.span.start, e.span.end)).or_default().push(e);
        }
        let curves = page.curves.get(number - 1).map_or(&[][..], Vec::as_slice);
        let context = LessonContext {
            lesson,
            names,
            curves,
            rendered: RenderedText::of_lesson(lesson),
            basis: page.bases.get(number - 1),
            entries,
        };
        let anchor = format!("lesson-{number}");
        let questions = asked(checked, &context, &anchor);
        LessonReport {
            name: names.short(path),
            summary: ledger.summary(),
            findings: page.findings.iter().filter(|f| f.path == *path).collect(),
            allowed: page.allowed.iter().filter(|a| a.finding.path == *path).collect(),
            coverage: NumberCoverage::measure(checked),
            anchor,
            questions,
            checked,
            context,
        }
    }
}

/// Every question of a lesson, with its claim.
fn asked<'a>(checked: &'a Checked, context: &LessonContext<'a>, anchor: &str) -> Vec<QuestionPage<'a>> {
    let claims: BTreeMap<(usize, usize), &Claim> =
        checked.claims.iter().map(|c| ((c.span.start, c.span.end), c)).collect();
    let mut all = Vec::new();
    for quiz in &checked.lesson.quizzes {
        let id = quiz.id.as_ref().map_or("", |t| t.as_str());
        for (n, question) in Quiz::numbered(quiz) {
            let span = question.verify.as_ref().map_or(&question.span, |v| &v.span);
            let entry = context.entry(Subject::Answer, span, "");
            all.push(QuestionPage {
                anchor: format!("{anchor}-question-{}", all.len() + 1),
                name: format!("quiz {id}, question {n}"),
                question,
                claim: claims.get(&(span.start, span.end)).copied(),
                state: entry.map_or(State::NotClaimed, |e| e.state),
                word: entry.map_or("open", |e| e.word),
                remark: entry.map_or("", |e| &e.remark),
            });
        }
    }
    all
}

/// Writes the section of a lesson.
pub(super) fn write(part: &LessonReport<'_>) -> String {
    let LessonReport { anchor, name, summary, findings, allowed, questions, context, .. } = part;
    let mut out = format!("<section class=\"lesson\" id=\"{anchor}\">\n<h2>{}</h2>\n", text(name));
    if let Some(title) = context.lesson.file.text().lines().find_map(|line| line.strip_prefix("# ")) {
        let _ = writeln!(out, "<p class=\"title\">{}</p>", text(title));
    }
    let _ = writeln!(out, "<p class=\"summary\">{}</p>", plain(summary));
    out.push_str(&found(findings, &[&context.lesson.file], context.names));
    if !allowed.is_empty() {
        let _ = writeln!(
            out,
            "<details><summary>{} suppressed by the lesson</summary>\n<ul>",
            counted(allowed.len(), "finding")
        );
        for a in allowed {
            let Finding { code: rule, message, span, .. } = &a.finding;
            let line = context.line(span.start);
            let _ = writeln!(
                out,
                "<li>line {line}: {} {}. Allowed: {}</li>",
                code(rule),
                text(message),
                text(&a.why)
            );
        }
        out.push_str("</ul></details>\n");
    }
    if !questions.is_empty() {
        out.push_str("<h3>Questions</h3>\n");
        questions.iter().for_each(|asked| out.push_str(&question::write(asked, context)));
    }
    out.push_str(&labs(part));
    out.push_str(&unclaimed(part));
    out.push_str("</section>\n");
    out
}

/// Writes the list of findings.
pub(super) fn found(findings: &[&Finding], sources: &[&SourceFile], names: &Names) -> String {
    if findings.is_empty() {
        return String::new();
    }
    let mut out = String::from("<h3>Findings</h3>\n<ul class=\"findings\">\n");
    for f in findings {
        let file = sources.iter().find(|s| s.path() == &f.path);
        let position = f.position.or_else(|| file.map(|file| file.position(f.span.start)));
        let place = position.map_or(String::new(), |position| {
            format!(" <span class=\"soft\">line {}, column {}</span>", position.line, position.column)
        });
        let _ = write!(
            out,
            "<li>{} {}{place}<p>{}</p>",
            severity(f.severity),
            code(f.code),
            text(&names.shorten(&f.message))
        );
        for (word, sentence) in [("why", &f.why), ("help", &f.help)] {
            if let Some(sentence) = sentence.as_ref().filter(|s| !s.is_empty()) {
                let _ = write!(out, "<p class=\"soft\">{word}: {}</p>", text(&names.shorten(sentence)));
            }
        }
        out.push_str("</li>\n");
    }
    out.push_str("</ul>\n");
    out
}

/// Writes the labs: the results of their runs, and their claims.
fn labs(part: &LessonReport<'_>) -> String {
    let LessonReport { checked, context, questions, .. } = part;
    let claims_of = |verify: Option<&Verify>| {
        verify.and_then(|v| checked.claims.iter().find(|claim| claim.span == v.span))
    };
    let mut out = String::new();
    let mut write = |name: &str, title: &str, entry: Option<&Entry>, line: usize, verify: Option<&Verify>| {
        let _ = write!(out, "<article class=\"claim\">\n<h4>");
        if let Some(e) = entry {
            let _ = write!(out, "{} ", verdict(e.state, e.word));
        }
        let title = if title.is_empty() { String::new() } else { format!(" {}", text(title)) };
        let _ = writeln!(
            out,
            "<span class=\"name\">{}{title}</span> <span class=\"soft\">line {line}</span></h4>",
            text(name)
        );
        if let Some(e) = entry.filter(|e| !e.remark.is_empty()) {
            let _ = writeln!(out, "<p class=\"why\">{}</p>", text(&context.names.shorten(&e.remark)));
        }
        if let Some(claim) = claims_of(verify) {
            out.push_str(&evidence(claim, verify, context));
        }
        out.push_str("</article>\n");
    };
    let addressed = context.lesson.addressed();
    for (address, lab) in &addressed {
        let entry = context.entry(Subject::Lab, &lab.span, lab.title());
        let line = context.line(lab.span.start);
        write(&format!("lab {address}"), lab.title(), entry, line, lab.verify.as_ref());
    }
    // Labs inside `verify` objects with claims of their own.
    let is_written = |claim: &Claim| {
        let asked = questions.iter().any(|q| q.claim.is_some_and(|c| c.span == claim.span));
        asked || addressed.iter().any(|(_, lab)| lab.verify.as_ref().is_some_and(|v| v.span == claim.span))
    };
    for claim in checked.claims.iter().filter(|claim| !is_written(claim)) {
        let verify = context.lesson.verifies().find(|v| v.span == claim.span);
        write(&claim.name, "", None, context.line(claim.span.start), verify);
    }
    if out.is_empty() { out } else { format!("<h3>Labs</h3>\n{out}") }
}

/// Writes the numbers with units that no claim covers.
fn unclaimed(part: &LessonReport<'_>) -> String {
    let all = &part.coverage.unclaimed;
    if all.is_empty() {
        return String::new();
    }
    let mut out = format!(
        "<details class=\"numbers\"><summary>{} that nothing claims</summary>\n<ul>\n",
        counted(all.len(), "number with a unit").replace("number with a units", "numbers with units")
    );
    for s in all.iter().take(LISTED) {
        let line = part.context.line(s.span.start);
        let unit = if s.quote.ends_with(&s.unit) { String::new() } else { format!(" {}", text(&s.unit)) };
        let _ = writeln!(
            out,
            "<li><b>{}</b>{unit} <span class=\"soft\">line {line}: {}</span></li>",
            text(&s.quote),
            text(&s.context)
        );
    }
    if all.len() > LISTED {
        let _ = writeln!(out, "<li>and {} more</li>", all.len() - LISTED);
    }
    out.push_str("</ul></details>\n");
    out
}
