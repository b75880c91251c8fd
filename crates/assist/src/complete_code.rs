//! Completions in a source text: the names of the language, of the model and of a claim, as far as a check accepts them there.

use super::code::{CodeRole, CodeText, with_names};
use super::document::Context;
use super::item::{Completion, CompletionKind, Edit};
use labspec::bind::{NUMBERS, Programs, functions};
use labspec::json::encode;
use labspec::spec::{CodeForm, Lab, Verify};
use labspec_core::Model;
use labspec_core::reflect::{FieldId, Object, data};
use labspec_expr::{
    CompletionScope, Entry, Field, Globals, ObjectId, Schema, Suggested, Suggestion, complete,
    is_in_aggregate, is_in_brackets, variables_of,
};
use std::ops::Range;

/// The maximum number of measures of runs that are offered with the names of their runs.
const MOST_OF_RUNS: usize = 50;

/// The completions in a source text. In a claim, the measures and runs come first.
pub(crate) fn completions_in_code(piece: &CodeText<'_>, inside: usize, context: &Context) -> Vec<Completion> {
    let Some(model) = context.models.model_of_lab(piece.lab, &mut Vec::new()) else { return Vec::new() };
    let functions = context.models.functions();
    let found = with_names(piece, &model, functions, |names| {
        let limits = TextLimits::new(piece, &model, names, inside);
        let scope = CompletionScope {
            globals: limits.globals.as_ref(),
            has_value: matches!(piece.role, CodeRole::Apply | CodeRole::Target),
            has_statements: piece.form == CodeForm::Statements,
            is_target: limits.is_target,
            accepts: &|entry| limits.accepts(entry),
        };
        complete(names, &scope, &piece.text.value, inside)
    });
    let at_start = word_before(&piece.text.value, inside);
    let mut items: Vec<Completion> = match (piece.verify, &at_start) {
        (Some(verify), Some(word)) if piece.role == CodeRole::Claim => measures_of_runs(verify, piece, word),
        _ => Vec::new(),
    };
    let named = piece.verify.filter(|_| at_start.is_some());
    let whole = found.into_iter().filter(|s| piece.text.map.is_unbroken(s.replace.into()));
    items.extend(whole.map(|s| {
        let of_claim = named.and_then(|verify| of_claim(verify, &s));
        completion(piece, s, of_claim)
    }));
    items
}

fn completion(piece: &CodeText<'_>, s: Suggestion, of_claim: Option<(&str, String)>) -> Completion {
    let (kind, detail, documentation) = match of_claim {
        Some((what, code)) => (CompletionKind::Variable, what.to_string(), code),
        None => (code_kind(s.kind), s.title, s.doc),
    };
    Completion {
        edit: Edit { span: piece.text.span_of(s.replace.into()), text: encode(&s.text) },
        label: s.text,
        kind,
        detail,
        documentation,
        filter: None,
    }
}

/// What a name of a claim is, and its code.
fn of_claim<'s>(verify: &Verify, s: &Suggestion) -> Option<(&'s str, String)> {
    let code = |text: &str| format!("```js\n{text}\n```");
    let measure = verify.measure.iter().find(|(name, _)| name.value == s.text);
    let measure = measure.map(|(_, text)| ("a measure", code(&text.value)));
    let found = || {
        let find = verify.find.iter().find(|find| find.name.value == s.text)?;
        Some(("a value found by a search", code(&find.holds.value)))
    };
    let run = || verify.runs.iter().any(|run| run.name.value == s.text).then(|| ("a run", String::new()));
    measure.or_else(found).or_else(run).filter(|_| s.kind != Suggested::Function)
}

/// The measures with the names of their runs, if there are several runs: `coarse.touch`.
fn measures_of_runs(verify: &Verify, piece: &CodeText<'_>, word: &Range<usize>) -> Vec<Completion> {
    let is_plain = |name: &str| {
        name.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '$'))
            && !name.starts_with(|c: char| c.is_ascii_digit())
    };
    if verify.runs.len() < 2 || !piece.text.map.is_unbroken(word.clone()) {
        return Vec::new();
    }
    let span = piece.text.span_of(word.clone());
    let one = |run: &str, measure: &str, code: &str| {
        let label = format!("{run}.{measure}");
        Completion {
            kind: CompletionKind::Variable,
            detail: "a measure of a run".to_string(),
            documentation: format!("```js\n{code}\n```"),
            filter: None,
            edit: Edit { span: span.clone(), text: encode(&label) },
            label,
        }
    };
    let runs = verify.runs.iter().map(|run| run.name.as_str()).filter(|name| is_plain(name));
    let measures = || verify.measure.iter().filter(|(name, _)| is_plain(&name.value));
    let all = runs.flat_map(|run| measures().map(move |(name, code)| (run, name, code)));
    all.take(MOST_OF_RUNS).map(|(run, name, code)| one(run, &name.value, &code.value)).collect()
}

/// What a check refuses in a source text, at a position.
struct TextLimits<'n> {
    names: &'n dyn Schema,
    role: CodeRole,
    /// The variables that the text can read; `None` if it can read none.
    globals: Option<Globals>,
    /// Whether the position is an argument of a function over all samples.
    in_aggregate: bool,
    /// Whether the position is the target of an assignment, not an index in it.
    is_target: bool,
    /// The programs of the lab, for a closed form.
    programs: Option<Programs>,
}

impl<'n> TextLimits<'n> {
    fn new(piece: &CodeText<'_>, model: &Model, names: &'n dyn Schema, inside: usize) -> TextLimits<'n> {
        let code = &piece.text.value;
        let in_aggregate =
            piece.scope == labspec::bind::Scope::Measure && is_in_aggregate(names, code, inside);
        let is_form = piece.role == CodeRole::Form;
        let programs = is_form.then(|| Programs::compile(piece.lab, model, &mut Vec::new()));
        let reads_variables = match piece.role {
            CodeRole::Claim | CodeRole::Search(_) => in_aggregate,
            _ => true,
        };
        let globals = reads_variables.then(|| match &programs {
            Some(programs) => constant_variables(programs),
            None => variables_of_lab(piece.lab, names),
        });
        let is_target = piece.form == CodeForm::Target && !is_in_brackets(code, inside);
        TextLimits { names, role: piece.role, globals, in_aggregate, is_target, programs }
    }

    /// Whether a check accepts a name of the host here.
    fn accepts(&self, entry: &Entry) -> bool {
        let aggregate = |entry: &Entry| match entry {
            Entry::Function(id) => self.names.function(*id).aggregate,
            _ => false,
        };
        match self.role {
            _ if self.is_target => self.leads_to_target(entry),
            CodeRole::Stop => !aggregate(entry),
            _ if self.in_aggregate => !aggregate(entry),
            CodeRole::Claim | CodeRole::Search(_) => aggregate(entry) || !self.reads_simulation(entry),
            CodeRole::Form => !self.reads_simulation(entry) && !self.is_written(entry),
            _ => true,
        }
    }

    /// Whether a name can be the target of a control, or leads to one.
    fn leads_to_target(&self, entry: &Entry) -> bool {
        match entry {
            Entry::Field(field) => field.is_assignable(),
            Entry::Object(id) => {
                let name = self.names.describe(*id);
                !["mj", "sim", "lib"].contains(&name.as_str())
            }
            Entry::Collection(id) => {
                let first = self.names.names(*id).first().and_then(|name| self.names.lookup(*id, name));
                first.is_some_and(|object| self.has_target(object))
            }
            Entry::Function(_) | Entry::Constant(_) => false,
        }
    }

    /// Whether a named object has a field that can be assigned.
    fn has_target(&self, object: ObjectId) -> bool {
        let members = self.names.member_names(object).into_iter();
        let mut members = members.filter_map(|name| self.names.member(object, &name));
        members.any(|entry| matches!(entry, Entry::Field(field) if field.is_assignable()))
    }

    /// Whether a name reads the simulation at one time. A closed form may read the time.
    fn reads_simulation(&self, entry: &Entry) -> bool {
        let is_form = self.role == CodeRole::Form;
        match entry {
            Entry::Field(field) => is_of_data(field) && !(is_form && is_time(field)),
            Entry::Function(id) => functions::reads(*id),
            // Everything in `data` but the time belongs to a sample.
            Entry::Object(id) => !is_form && self.names.describe(*id) == "data",
            Entry::Collection(_) | Entry::Constant(_) => false,
        }
    }

    /// Whether the lab writes a field while it runs.
    fn is_written(&self, entry: &Entry) -> bool {
        let (Entry::Field(field), Some(programs)) = (entry, &self.programs) else { return false };
        let mut running = running_effects(programs);
        !is_time(field)
            && running.any(|e| e.writes_everything || e.writes.iter().any(|w| w.field == field.key))
    }
}

fn is_of_data(field: &Field) -> bool {
    field.key != NUMBERS
        && FieldId::new(field.key.0 as usize).is_some_and(|f| f.info().object == Object::Data)
}

fn is_time(field: &Field) -> bool {
    FieldId::new(field.key.0 as usize) == Some(data::time)
}

/// The effects of the programs that run during the simulation.
fn running_effects(programs: &Programs) -> impl Iterator<Item = &labspec_expr::Effects> {
    let probes = programs.probes.iter().filter_map(|probe| probe.bound.as_ref());
    programs.controller.iter().chain(probes).map(|bound| bound.program.effects())
}

/// The variables that a lab does not write while it runs.
fn constant_variables(programs: &Programs) -> Globals {
    let mut all = Globals::new();
    for slot in 0..programs.globals.len() as u32 {
        let is_written = running_effects(programs).any(|e| e.any_ctx || e.ctx_writes.contains(&slot));
        if !is_written {
            all.define(programs.globals.name(slot));
        }
    }
    all
}

/// The variables that the texts of a lab name, and those that its controls store.
fn variables_of_lab(lab: &Lab, names: &dyn Schema) -> Globals {
    let texts = lab.code().into_iter().map(|(_, text)| text.value.as_str());
    let mut globals = variables_of(names, texts);
    let actions = lab.controls.iter().filter_map(|control| control.action());
    actions.filter_map(|action| action.param.as_ref()).for_each(|param| {
        globals.define(&param.value);
    });
    globals
}

fn code_kind(kind: Suggested) -> CompletionKind {
    match kind {
        Suggested::Object => CompletionKind::Object,
        Suggested::Field => CompletionKind::Field,
        Suggested::Function => CompletionKind::Function,
        Suggested::Name => CompletionKind::Name,
        Suggested::Variable => CompletionKind::Variable,
        Suggested::Constant => CompletionKind::Constant,
    }
}

/// The part of a name before an offset; `None` after a dot, where members are written, and in a string.
fn word_before(text: &str, inside: usize) -> Option<Range<usize>> {
    let before = text.get(..inside)?;
    let start = before.trim_end_matches(|c: char| c.is_alphanumeric() || matches!(c, '_' | '$')).len();
    let is_member = before.get(..start)?.trim_end().ends_with('.');
    (!is_member).then_some(start..inside)
}
