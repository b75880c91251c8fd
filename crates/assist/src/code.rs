//! The source texts in a lesson, each with the lab to which it belongs.

use labspec::bind::{ModelNames, Scope};
use labspec::source::Text;
use labspec::spec::{CodeForm, Lab, Lesson, Run, Verify};
use labspec_core::Model;
use labspec_expr::{Compiled, Compiler, Globals, Type};

/// A source text.
#[derive(Clone, Copy, Debug)]
pub struct CodeText<'l> {
    /// How it is written.
    pub form: CodeForm,
    /// Which functions exist.
    pub scope: Scope,
    /// The text, with its place in the lesson.
    pub text: &'l Text,
    /// The lab whose model it uses.
    pub lab: &'l Lab,
    /// The claim that contains it.
    pub verify: Option<&'l Verify>,
}

/// All source texts, in the order of the lesson.
pub fn code_texts(lesson: &Lesson) -> Vec<CodeText<'_>> {
    let mut all = Vec::new();
    for lab in lesson.all_labs() {
        let code = lab.code().into_iter();
        all.extend(code.map(|(form, text)| CodeText { form, scope: Scope::Lab, text, lab, verify: None }));
        if let Some(verify) = &lab.verify {
            add_claim(lesson, verify, Some(lab), &mut all);
        }
    }
    for (_, question) in lesson.quizzes.iter().flat_map(|quiz| quiz.numbered()) {
        if let Some(verify) = &question.verify {
            add_claim(lesson, verify, question.sim(), &mut all);
        }
    }
    for remark in &lesson.remarks {
        add_claim(lesson, &remark.verify, None, &mut all);
    }
    all
}

fn add_claim<'l>(lesson: &'l Lesson, verify: &'l Verify, lab: Option<&'l Lab>, all: &mut Vec<CodeText<'l>>) {
    let whole = lesson.whole(verify);
    let base = whole.lab.as_ref().map_or(lab, |named| lesson.named(named));
    let scope = |form| if form == CodeForm::Statements { Scope::Lab } else { Scope::Measure };
    let mut add = |texts: Vec<(CodeForm, &'l Text)>, lab: Option<&'l Lab>| {
        let Some(lab) = lab else { return };
        let piece = |(form, text)| CodeText { form, scope: scope(form), text, lab, verify: Some(whole) };
        all.extend(texts.into_iter().map(piece));
    };
    let lab_of = |run: &'l Run| run.lab.as_ref().map_or(base, |named| lesson.named(named));
    for run in &verify.runs {
        add(run.code().collect(), lab_of(run));
    }
    add(verify.expressions().collect(), base.or_else(|| whole.runs.iter().find_map(lab_of)));
}

/// The source text at a byte of the lesson, and the offset in the text.
pub fn code_at(lesson: &Lesson, byte: usize) -> Option<(CodeText<'_>, usize)> {
    let all = code_texts(lesson);
    let piece = all.into_iter().find(|p| {
        let span = p.text.span();
        span.start <= byte && byte <= span.end
    })?;
    Some((piece, offset_in_text(piece.text, byte)))
}

/// The offset in a text for a byte of the file. The mapping is monotonic.
pub(crate) fn offset_in_text(text: &Text, byte: usize) -> usize {
    let (mut low, mut high) = (0, text.value.len());
    while low < high {
        let middle = low + (high - low) / 2;
        if text.map.span(middle..middle).start < byte {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    labspec_expr::floor(&text.value, low)
}

/// Compiles a source text with help for each of its parts.
pub fn explained(piece: &CodeText<'_>, model: &Model, globals: &mut Globals) -> Compiled {
    let readouts = labspec::verify::labels(piece.lab);
    let names = ModelNames::new(model, piece.scope).showing(&readouts);
    let mut compiler = Compiler::new(&names, globals).with_value(Some(Type::Any)).explaining();
    match piece.form {
        CodeForm::Expression => compiler.expression(&piece.text.value),
        CodeForm::Statements => compiler.statements(&piece.text.value),
        CodeForm::Target => compiler.assignment(&piece.text.value),
    }
}
