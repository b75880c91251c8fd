//! The formatter: formats the code in a lesson, and replaces bare indexes by the names of their objects. The JSON and the
//! Markdown around the code are unchanged, byte for byte.
//!
//! A text is not changed if it has errors or comments, or if the file does not contain it as plain JSON (a repaired quote):
//! only changes that certainly preserve the meaning are made.

use crate::bind::scene::Models;
use crate::bind::{ModelNames, Scope};
use crate::source::Text;
use crate::spec::{CodeForm, Lab, Lesson};
use labspec_core::Model;
use labspec_expr::{Compiled, Compiler, Globals, Program, Type, format_expression, format_statements};
use std::ops::Range;

/// A lesson with formatted code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formatted {
    /// The whole file.
    pub text: String,
    /// Number of texts of code that changed.
    pub changed: usize,
    /// Number of texts of code.
    pub total: usize,
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
    let mut text = lesson.file.text().to_owned();
    for (span, code) in edits {
        text.replace_range(span, &code);
    }
    Formatted { text, changed, total }
}

/// Whether two versions of a lesson contain the same labs and claims, and have the same findings.
pub fn is_equivalent(before: &Lesson, after: &Lesson) -> bool {
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
