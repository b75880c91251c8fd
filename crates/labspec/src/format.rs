//! The formatter: formats the code in a lesson, replaces bare indexes by the names of their objects, and lays out the JSON of
//! labs, quizzes and claims. The Markdown around them is unchanged, byte for byte.
//!
//! A text is not changed if it has errors or comments, or if the file does not contain it as plain JSON (a repaired quote). JSON
//! is not laid out if a page cannot read it, or if it is in a quote or a list item. Only changes that certainly preserve the
//! meaning are made.

use crate::bind::scene::Models;
use crate::bind::{ModelNames, Scope};
use crate::json;
use crate::lint::{ModelFolder, reload_lesson};
use crate::markdown::{self, BlockKind};
use crate::source::{SourceFile, Text};
use crate::spec::{CodeForm, FileKind, Lab, Lesson, claims_in_comments, kind_of};
use labspec_core::Model;
use labspec_expr::{Compiled, Compiler, Globals, Program, Type, format_expression, format_statements};
use std::ops::Range;
use std::path::Path;

/// A lesson with formatted code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formatted {
    /// The whole file.
    pub text: String,
    /// Number of texts of code that changed.
    pub changed: usize,
    /// Number of texts of code.
    pub total: usize,
    /// Number of blocks, files and comments whose JSON has another layout.
    pub laid_out: usize,
    /// The replaced bytes of the file before, and their replacements, from the end to the start.
    pub edits: Vec<(Range<usize>, String)>,
}

/// Why a lesson is not formatted: the result would not have the same labs, claims and findings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeaningChanged;

/// Formats like [`format()`], and reads the result again with the same related files.
///
/// # Errors
/// The result is not equivalent to the lesson, which would be an error of the formatter.
pub fn format_checked(
    lesson: &Lesson,
    folder: &ModelFolder,
    models: Option<&mut Models>,
) -> Result<Formatted, MeaningChanged> {
    let done = format(lesson, models);
    if !done.edits.is_empty() && !is_equivalent(lesson, &reload_lesson(lesson, &done.text, folder)) {
        return Err(MeaningChanged);
    }
    Ok(done)
}

/// Formats all code of a lesson. With models, bare indexes become names: `data.qpos[9]` becomes
/// `data.joint('light_free').qpos[2]`, which is the same element of this model.
pub fn format(lesson: &Lesson, mut models: Option<&mut Models>) -> Formatted {
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    let mut total = 0;
    for lab in lesson.all_labs() {
        let model = models.as_mut().and_then(|m| m.model_of_lab(lab, &mut Vec::new()));
        let mut globals = Globals::new();
        for (form, text) in lab.code() {
            let named = model.as_ref().and_then(|m| modernized(&text.value, form, m, &mut globals));
            let code = named.as_deref().unwrap_or(&text.value);
            edits.extend(edit(lesson, text, &format_code(code, form).unwrap_or_else(|| code.to_owned())));
            total += 1;
        }
    }
    for (form, text) in claims(lesson) {
        edits.extend(format_code(&text.value, form).and_then(|code| edit(lesson, text, &code)));
        total += 1;
    }
    // From the end to the start, so that offsets remain valid. A lab that is named twice is edited once.
    edits.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    edits.dedup_by(|a, b| a.0 == b.0);
    let changed = edits.len();
    let laid_out = lay_out_blocks(lesson, &mut edits);
    Formatted { text: edited(lesson, &edits), changed, total, laid_out, edits }
}

/// The text of a lesson with edits, which go from its end to its start.
fn edited(lesson: &Lesson, edits: &[(Range<usize>, String)]) -> String {
    let mut text = lesson.file.text().to_owned();
    for (span, replacement) in edits {
        text.replace_range(span.clone(), replacement);
    }
    text
}

/// Lays out the JSON of a lesson. The edits of the code in a block become part of the edit of the block. Returns the number of
/// blocks that change.
fn lay_out_blocks(lesson: &Lesson, edits: &mut Vec<(Range<usize>, String)>) -> usize {
    let coded = SourceFile::new(lesson.file.path().clone(), edited(lesson, edits));
    let (before, after) = (json_ranges(&lesson.file), json_ranges(&coded));
    if before.len() != after.len() {
        debug_assert!(false, "formatted code does not add or remove blocks");
        return 0;
    }
    let windows = coded.text().contains("\r\n");
    let mut count = 0;
    for (old, new) in before.into_iter().zip(after) {
        let (text, column) = (coded.slice(new.clone()), coded.position(new.start).column - 1);
        let lines = if windows { text.replace("\r\n", "\n") } else { text.to_string() };
        let Some(mut json) = json::lay_out(&lines, column) else { continue };
        if windows {
            json = json.replace('\n', "\r\n");
        }
        if json == text {
            continue;
        }
        edits.retain(|(span, _)| span.start < old.start || span.end > old.end);
        edits.push((old, json));
        count += 1;
    }
    edits.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    count
}

/// The byte ranges of the JSON in a file: of whole lines, so that they can have more lines, and of comments at the start of a line.
fn json_ranges(file: &SourceFile) -> Vec<Range<usize>> {
    let text = file.text();
    let trimmed = |range: Range<usize>| {
        let inside = file.slice(range.clone());
        let start = range.start + inside.len() - inside.trim_start().len();
        start..start + inside.trim().len()
    };
    if kind_of(Path::new(&**file.path())) == FileKind::Json {
        return vec![trimmed(0..text.len())];
    }
    let scan = markdown::scan(file);
    let at_line_start =
        |offset: usize| offset == 0 || text.get(..offset).is_some_and(|before| before.ends_with('\n'));
    let bodies = scan.blocks.iter().filter(|block| !matches!(block.kind, BlockKind::Code { .. })).filter_map(
        |block| {
            let body = block.body.span();
            // Line breaks of Windows are single characters in a block.
            let is_as_written = file.slice(body.clone()).replace("\r\n", "\n") == *block.body.value;
            let is_plain = block.whole && is_as_written && at_line_start(body.start);
            is_plain.then(|| trimmed(body))
        },
    );
    let comments =
        claims_in_comments(text, &scan).into_iter().filter(|(comment, _)| at_line_start(comment.start));
    let mut all: Vec<_> = bodies.chain(comments.map(|(_, json)| trimmed(json))).collect();
    all.sort_by_key(|range| range.start);
    all
}

/// Whether two versions of a lesson contain the same labs and claims, and have the same findings.
fn is_equivalent(before: &Lesson, after: &Lesson) -> bool {
    let texts = |lesson: &Lesson| {
        let labs = lesson.all_labs().into_iter().flat_map(|lab| lab.code()).map(|(form, _)| form);
        labs.chain(claims(lesson).into_iter().map(|(form, _)| form)).collect::<Vec<_>>()
    };
    let codes = |lesson: &Lesson| {
        let mut codes: Vec<&str> = lesson.findings.iter().map(|f| f.code).collect();
        codes.sort_unstable();
        codes
    };
    texts(before) == texts(after) && codes(before) == codes(after)
}

/// The code of all `verify` objects.
fn claims(lesson: &Lesson) -> Vec<(CodeForm, &Text)> {
    let of_labs = lesson.all_labs().into_iter().filter_map(|lab: &Lab| lab.verify.as_ref());
    let questions = lesson.quizzes.iter().flat_map(|q| q.numbered());
    let of_questions = questions.filter_map(|(_, q)| q.verify.as_ref());
    of_labs.chain(of_questions).flat_map(|v| v.code()).collect()
}

fn format_code(code: &str, form: CodeForm) -> Option<String> {
    match form {
        CodeForm::Statements => format_statements(code),
        CodeForm::Expression | CodeForm::Target => format_expression(code),
    }
}

/// The bytes of the file that contain a text, and their replacement; `None` when nothing changes, or when the file does not
/// contain the text as plain JSON.
fn edit(lesson: &Lesson, text: &Text, code: &str) -> Option<(Range<usize>, String)> {
    let span = text.span();
    let written = format!("\"{}\"", lesson.file.slice(span.clone()));
    let plain = serde_json::from_str::<String>(&written).is_ok_and(|value| value == text.value);
    if !plain || code == text.value {
        return None;
    }
    let quoted = serde_json::to_string(code).ok()?;
    Some((span, quoted.get(1..quoted.len() - 1)?.to_owned()))
}

/// A text with names for its bare indexes; `None` when it has none, or errors. Both versions read, write and call the same
/// elements.
pub fn modernized(code: &str, form: CodeForm, model: &Model, globals: &mut Globals) -> Option<String> {
    let names = ModelNames::new(model, Scope::Lab);
    let mut compile = |code: &str| compile(code, form, &names, globals);
    let before = compile(code);
    let named = before.modernized(code);
    if named == code {
        return None;
    }
    let after = compile(&named);
    let same = |a: &Program, b: &Program| a.effects() == b.effects() && a.result_type() == b.result_type();
    match (before.program, after.program) {
        (Some(a), Some(b)) if same(&a, &b) => Some(named),
        _ => None,
    }
}

fn compile(code: &str, form: CodeForm, names: &ModelNames<'_>, globals: &mut Globals) -> Compiled {
    let mut compiler = Compiler::new(names, globals).with_value(Some(Type::Any)).explaining();
    match form {
        CodeForm::Expression => compiler.expression(code),
        CodeForm::Statements => compiler.statements(code),
        CodeForm::Target => compiler.assignment(code),
    }
}
