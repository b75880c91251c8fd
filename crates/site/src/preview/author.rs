//! A lesson's page for its author: findings, claims and tools beside each block.

use super::backend::CourseCheck;
use crate::lesson::{LessonPage, PageBlock};
use crate::lesson_main::{embedded_models, lesson_attributes, missing_heading};
use crate::marks::{class_of, verdict};
use crate::text::escape;
use crate::verified::{hex_of, short_hash};
use labspec::check::Checked;
use labspec::finding::{Applicability, Finding, Severity};
use labspec::ledger::{Entry, Ledger, State, Subject};
use labspec::verify;
use std::fmt::Write;
use std::ops::Range;

/// The maximum number of characters of a fix that a page shows.
const MAX_FIX: usize = 200;

/// The hash of a text: a page names the text that it shows by it.
pub(super) fn text_hash(text: &str) -> String {
    hex_of(&[text.as_bytes()])
}

/// A lesson with its findings, completions and claims.
pub(super) struct AuthorView<'v> {
    pub(super) checked: &'v Checked,
    pub(super) page: &'v LessonPage,
    pub(super) course: &'v CourseCheck,
    /// The findings in the lesson, in the order in which a request names them.
    pub(super) findings: &'v [Finding],
    /// Whether labs and claims were checked.
    pub(super) is_checked: bool,
    /// Why the last check failed.
    pub(super) problem: Option<&'v str>,
    /// What the pages lack, as sentences.
    pub(super) unwritten: &'v [String],
}

/// What pages lack, as items of a list.
pub(super) fn unwritten_items(problems: &[String]) -> String {
    problems.iter().map(|why| format!("<li class=\"error\"><p>{}</p></li>", escape(why))).collect()
}

/// The block that a byte of the file belongs to: the one around it, else the next one, else the last.
pub(super) fn block_at(blocks: &[Range<usize>], offset: usize) -> Option<usize> {
    let next =
        blocks.partition_point(|span| span.end <= offset && !(span.start <= offset && offset < span.end));
    if next < blocks.len() { Some(next) } else { blocks.len().checked_sub(1) }
}

impl AuthorView<'_> {
    /// The attributes of the main part.
    pub(super) fn attributes(&self) -> String {
        format!(
            " data-page=\"{}\" data-hash=\"{}\" data-checked=\"{}\"{}",
            escape(&self.page.name),
            text_hash(self.checked.lesson.file.text()),
            self.is_checked,
            lesson_attributes(self.page)
        )
    }

    /// The main part.
    pub(super) fn main(&self) -> String {
        let spans: Vec<Range<usize>> = self.page.blocks.iter().map(|block| block.span.clone()).collect();
        let mut notes: Vec<String> = vec![String::new(); spans.len()];
        let mut loose = String::new();
        for (number, finding) in self.findings.iter().enumerate() {
            let note = self.finding(number, finding);
            match block_at(&spans, finding.span.start).and_then(|index| notes.get_mut(index)) {
                Some(notes) => notes.push_str(&note),
                None => loose.push_str(&note),
            }
        }
        self.add_claims(&spans, &mut notes);
        let blocks: String =
            self.page.blocks.iter().zip(&notes).map(|(block, notes)| self.block(block, notes)).collect();
        format!(
            "{}{}{}{blocks}{}",
            self.status(),
            self.elsewhere(&loose),
            missing_heading(self.page),
            embedded_models(self.page)
        )
    }

    /// One line about the lesson.
    fn status(&self) -> String {
        let mut ledger = Ledger::default();
        let path = self.checked.lesson.file.path();
        self.course.ledger.entries().iter().filter(|e| e.path == *path).for_each(|e| ledger.add(e.clone()));
        let any = |state| ledger.entries().iter().any(|e| e.state == state && e.subject != Subject::File);
        let (class, text) = match (self.problem, self.is_checked) {
            (Some(problem), _) => ("status-false", format!("The last check failed: {problem}")),
            (None, false) => ("status-open", "Checking …".to_string()),
            (None, true) if any(State::False) => ("status-false", ledger.summary()),
            (None, true) if any(State::Unchecked) => ("status-open", ledger.summary()),
            (None, true) => ("status-true", ledger.summary()),
        };
        let left = verify::counted(&self.checked.lesson).left.len();
        let numbers = match left {
            0 => String::new(),
            1 => " · 1 number without a claim".into(),
            n => format!(" · {n} numbers without a claim"),
        };
        format!("<p class=\"status {class}\" role=\"status\">{}{numbers}</p>\n", escape(&text))
    }

    /// Findings that belong to no block, and those in other files.
    fn elsewhere(&self, loose: &str) -> String {
        let is_lesson = |path: &str| self.course.lessons.iter().any(|c| &**c.lesson.file.path() == path);
        let others = self.course.findings.iter().filter(|f| !is_lesson(&f.path));
        let others: String = others
            .map(|f| {
                let line = f.position.map_or(String::new(), |position| format!(", line {}", position.line));
                let file = f.path.rsplit(['/', '\\']).next().unwrap_or("");
                format!(
                    "<li class=\"{}\"><p>{}{line}: {}</p></li>",
                    f.severity.as_str(),
                    escape(file),
                    escape(&f.message)
                )
            })
            .collect();
        let all = format!("{loose}{others}{}", unwritten_items(self.unwritten));
        let list = if all.is_empty() { String::new() } else { format!("<ul>{all}</ul>") };
        format!("<aside class=\"elsewhere notes\" aria-label=\"Other findings\">{list}</aside>\n")
    }

    fn block(&self, block: &PageBlock, notes: &str) -> String {
        let PageBlock { kind, span, content, after } = block;
        let text = self.checked.lesson.file.slice(span.clone());
        let is_fence = matches!(*kind, "lab" | "quiz");
        let key = if is_fence { content.split('"').nth(1).unwrap_or("") } else { "" };
        let same = if *kind == "text" { "" } else { content.as_str() };
        let line = |offset: usize| self.checked.lesson.file.position(offset).line;
        let last = span.end.saturating_sub(usize::from(text.ends_with('\n')));
        let lines = match (line(span.start), line(last)) {
            (first, last) if first == last => format!("line {first}"),
            (first, last) => format!("lines {first} to {last}"),
        };
        let propose = match *kind {
            "code" => String::new(),
            _ => format!(
                "<button type=\"button\" data-do=\"propose\" aria-label=\"Propose claims for {lines}\">Propose claims</button>"
            ),
        };
        let fence = if is_fence { " fence" } else { "" };
        let notes = if notes.is_empty() { String::new() } else { format!("<ul>{notes}</ul>") };
        format!(
            "<section class=\"block {kind}\" data-key=\"{key}\" data-hash=\"{}\" data-source=\"{}\" data-start=\"{}\" data-end=\"{}\">\n\
             <div class=\"content{fence}\">{content}</div>\n<div class=\"after\">{after}</div>\n\
             <div class=\"notes\">{notes}</div>\n\
             <div class=\"tools\"><button type=\"button\" data-do=\"edit\" aria-label=\"Edit {lines}\">Edit</button>{propose}<p class=\"message\" role=\"alert\"></p></div>\n</section>\n",
            block.hash(),
            short_hash(&[text.as_bytes(), same.as_bytes()]),
            span.start,
            span.end
        )
    }

    fn finding(&self, number: usize, f: &Finding) -> String {
        let position = self.checked.lesson.file.position(f.span.start);
        let mut out = format!(
            "<li class=\"{}\"><p><b>{}</b> <code>{}</code> <small>line {}</small></p><p>{}</p>",
            f.severity.as_str(),
            match f.severity {
                Severity::Error => "✗ error",
                Severity::Warning => "! warning",
                Severity::Note => "i note",
            },
            escape(f.code),
            position.line,
            escape(&f.message)
        );
        for (word, text) in [("Why", &f.why), ("Help", &f.help)] {
            if let Some(text) = text.as_ref().filter(|text| !text.is_empty()) {
                let _ = write!(out, "<p><small>{word}: {}</small></p>", escape(text));
            }
        }
        if let Some(fix) = &f.fix {
            let old: String =
                self.checked.lesson.file.slice(fix.span.clone()).chars().take(MAX_FIX).collect();
            let new: String = fix.text.chars().take(MAX_FIX).collect();
            let replacement = format!("<code>{}</code> → <code>{}</code>", escape(&old), escape(&new));
            let button = match fix.applicability {
                Applicability::Safe => "Apply",
                Applicability::Unsafe => "Apply (a guess)",
                Applicability::Display => "",
            };
            let _ = match button {
                "" => write!(out, "<p><small>Write: {replacement}</small></p>"),
                text => write!(
                    out,
                    "<p><button type=\"button\" data-do=\"fix\" data-finding=\"{number}\">{text}</button> <small>{replacement}</small></p>"
                ),
            };
        }
        out.push_str("</li>");
        out
    }

    /// Adds the claims of labs, quizzes and comments, and the numbers inside fences that nothing claims.
    fn add_claims(&self, spans: &[Range<usize>], notes: &mut [String]) {
        let path = self.checked.lesson.file.path();
        let mut of_block: Vec<Vec<&Entry>> = vec![Vec::new(); spans.len()];
        let entries = self.course.ledger.entries().iter();
        for entry in
            entries.filter(|e| e.path == *path && !matches!(e.subject, Subject::File | Subject::Widget))
        {
            if let Some(index) = block_at(spans, entry.span.start)
                && let Some(of_block) = of_block.get_mut(index)
            {
                of_block.push(entry);
            }
        }
        for (entries, notes) in of_block.iter().zip(notes.iter_mut()) {
            if !entries.is_empty() {
                notes.push_str(&claims(entries));
            }
        }
        for stated in verify::counted(&self.checked.lesson).left {
            let Some(index) = block_at(spans, stated.span.start) else { continue };
            let is_fence = self.page.blocks.get(index).is_some_and(|block| block.kind != "text");
            if let Some(notes) = notes.get_mut(index).filter(|_| is_fence) {
                let _ = write!(
                    notes,
                    "<li class=\"claim-none\"><p>○ no claim states <b>{}</b></p></li>",
                    escape(&stated.quote)
                );
            }
        }
    }
}

/// The claims of one block: those that are not true each on a line, the others in a list that can be opened.
fn claims(entries: &[&Entry]) -> String {
    let one = |entry: &&Entry| {
        let (class, sign) = class_of(entry.state);
        let what =
            if entry.what.is_empty() { String::new() } else { format!(" “{}”", escape(&entry.what)) };
        format!(
            "<li class=\"{class}\"><p>{sign} {}{what}: {}</p></li>",
            entry.subject.as_str(),
            escape(&verdict(entry))
        )
    };
    let is_true = |entry: &&&Entry| matches!(entry.state, State::True(_));
    let bad: String = entries.iter().filter(|e| !is_true(e)).map(one).collect();
    let good: Vec<String> = entries.iter().filter(is_true).map(one).collect();
    let good = match good.len() {
        0 => String::new(),
        n => format!(
            "<li class=\"claim-true\"><details><summary>✓ {n} checked and true</summary><ul>{}</ul></details></li>",
            good.concat()
        ),
    };
    format!("{bad}{good}")
}
