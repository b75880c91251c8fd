//! The source texts in a lesson, each with the lab to which it belongs.

use labspec::bind::{Functions, ModelNames, Scope};
use labspec::source::Text;
use labspec::spec::{CodeForm, Lab, Lesson, Run, Verify};
use labspec::verify::{ClaimNames, labels};
use labspec_core::Model;
use labspec_expr::{Compiled, Compiler, Globals, Schema, Type};

/// What a source text is for, which decides what it may read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeRole {
    /// A text of a lab, or statements of a run.
    Lab,
    /// Statements that see the chosen value as `value`.
    Apply,
    /// The target of a control.
    Target,
    /// The condition that ends a run: it looks at one sample.
    Stop,
    /// A measure over a run.
    Measure,
    /// The condition of the search with this index, among those of the whole claim.
    Search(usize),
    /// A closed form.
    Form,
    /// An option, a value or a quote: an expression over the measures.
    Claim,
}

/// A source text.
#[derive(Clone, Copy, Debug)]
pub struct CodeText<'l> {
    /// How it is written.
    pub form: CodeForm,
    /// What it is for.
    pub role: CodeRole,
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
        all.extend(code.map(|(form, text)| CodeText {
            form,
            role: role_in_lab(lab, form, text),
            scope: Scope::Lab,
            text,
            lab,
            verify: None,
        }));
        if let Some(verify) = &lab.verify {
            add_claim(lesson, verify, Some(lab), &mut all);
        }
    }
    for (_, question) in lesson.quizzes.iter().flat_map(|quiz| quiz.numbered()) {
        if let Some(verify) = &question.verify {
            add_claim(lesson, verify, question.sim(), &mut all);
        }
    }
    for comment in &lesson.claim_comments {
        add_claim(lesson, &comment.verify, None, &mut all);
    }
    all
}

fn role_in_lab(lab: &Lab, form: CodeForm, text: &Text) -> CodeRole {
    let mut applied = lab.controls.iter().filter_map(|c| c.action()?.apply.as_ref());
    match form {
        CodeForm::Target => CodeRole::Target,
        CodeForm::Statements if applied.any(|apply| std::ptr::eq(apply, text)) => CodeRole::Apply,
        _ => CodeRole::Lab,
    }
}

fn add_claim<'l>(lesson: &'l Lesson, verify: &'l Verify, lab: Option<&'l Lab>, all: &mut Vec<CodeText<'l>>) {
    let whole = lesson.whole(verify);
    let base = whole.lab.as_ref().map_or(lab, |named| lesson.named(named));
    let mut add = |role: CodeRole, text: &'l Text, lab: Option<&'l Lab>| {
        let (form, scope) = match role {
            CodeRole::Lab => (CodeForm::Statements, Scope::Lab),
            CodeRole::Form => (CodeForm::Expression, Scope::Lab),
            _ => (CodeForm::Expression, Scope::Measure),
        };
        all.extend(lab.map(|lab| CodeText { form, role, scope, text, lab, verify: Some(whole) }));
    };
    let lab_of = |run: &'l Run| run.lab.as_ref().map_or(base, |named| lesson.named(named));
    for run in &verify.runs {
        let statements = run.setup.iter().chain(&run.controller);
        statements.for_each(|text| add(CodeRole::Lab, text, lab_of(run)));
        run.stop.iter().for_each(|text| add(CodeRole::Stop, text, lab_of(run)));
    }
    let lab = base.or_else(|| whole.runs.iter().find_map(lab_of));
    verify.measure.iter().for_each(|(_, text)| add(CodeRole::Measure, text, lab));
    verify.exact.iter().for_each(|exact| add(CodeRole::Form, &exact.form, lab));
    for find in &verify.find {
        let index = whole.find.iter().position(|f| f.name.value == find.name.value);
        add(CodeRole::Search(index.unwrap_or(0)), &find.holds, lab);
    }
    let claims = verify.options.iter().chain(&verify.value).chain(&verify.wrong).chain(verify.quoted());
    claims.for_each(|text| add(CodeRole::Claim, text, lab));
}

/// Calls `work` with the names that a source text can use.
pub fn with_names<T>(
    piece: &CodeText<'_>,
    model: &Model,
    functions: &Functions,
    work: impl FnOnce(&dyn Schema) -> T,
) -> T {
    let displayed = labels(piece.lab);
    let names = ModelNames::new(model, piece.scope).with(functions).showing(&displayed);
    let claims = piece.verify.and_then(|verify| match piece.role {
        CodeRole::Claim => Some(ClaimNames::of_claims(verify)),
        CodeRole::Search(i) => verify.find.get(i).map(|find| ClaimNames::of_search(verify, find)),
        _ => None,
    });
    match claims {
        Some(claims) => work(&claims.over(names)),
        None => work(&names),
    }
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
pub fn explained(
    piece: &CodeText<'_>,
    model: &Model,
    functions: &Functions,
    globals: &mut Globals,
) -> Compiled {
    with_names(piece, model, functions, |names| {
        let mut compiler = Compiler::new(names, globals).with_value(Some(Type::Any)).explaining();
        match piece.form {
            CodeForm::Expression => compiler.expression(&piece.text.value),
            CodeForm::Statements => compiler.statements(&piece.text.value),
            CodeForm::Target => compiler.assignment(&piece.text.value),
        }
    })
}

/// The code of the measure or the search of a claim that a chain reads: `touch`, `fall.touch`.
pub(crate) fn measured_as<'l>(piece: &CodeText<'l>, chain: &str) -> Option<(&'l str, &'l Text)> {
    let verify = piece.verify.filter(|_| matches!(piece.role, CodeRole::Claim | CodeRole::Search(_)))?;
    let name = match chain.split_once('.') {
        Some((run, name)) => verify.runs.iter().any(|r| r.name.value == run).then_some(name)?,
        None => chain,
    };
    let measure = verify.measure.iter().find(|(measure, _)| measure.value == name);
    let found = || verify.find.iter().find(|find| find.name.value == name);
    let measure = measure.map(|(_, code)| ("a measure", code));
    measure.or_else(|| found().map(|find| ("a value found by a search", &find.holds)))
}
