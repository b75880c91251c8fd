//! Compiles the texts of a lab against its model: statements and expressions become programs, with the fields that they
//! access.

use super::programs::{ActionProgram, Bound, ControlProgram, Probe, Programs, include};
use super::unknown_names::UnknownNames;
use crate::finding::{Finding, Fix};
use crate::json::{Scalar, fix_in_code};
use crate::rules;
use crate::source::Text;
use crate::spec::{Action, Control, ControlKind, Lab};
use labspec_bind::{Functions, HOST_TERMS, ModelNames, Scope};
use labspec_core::reflect::FieldSet;
use labspec_core::{AccessSet, Model};
use labspec_expr::{Compiled, Compiler, Globals, ProgramId, Type, Value};

impl Programs {
    /// Compiles the texts of a lab against its model, to run it. Errors are added to `findings`, with spans in the lesson.
    pub fn compile(lab: &Lab, model: &Model, findings: &mut Vec<Finding>) -> Programs {
        compile(lab, model, &Functions::new(), |compiler| compiler, findings)
    }

    /// As [`Programs::compile`], with functions of the embedding program, and with warnings about code that is rarely intended.
    pub fn compile_and_lint(
        lab: &Lab,
        model: &Model,
        functions: &Functions,
        findings: &mut Vec<Finding>,
    ) -> Programs {
        compile(lab, model, functions, |compiler| compiler.linting(), findings)
    }
}

/// Sets what a compiler reports.
type Prepare = for<'s> fn(Compiler<'s>) -> Compiler<'s>;

fn compile(
    lab: &Lab,
    model: &Model,
    functions: &Functions,
    prepare: Prepare,
    findings: &mut Vec<Finding>,
) -> Programs {
    let names = ModelNames::new(model, Scope::Lab).with(functions);
    let mut globals = Globals::new();
    let mut texts: Vec<(ProgramId, Text)> = Vec::new();
    let mut unknown = UnknownNames::default();
    let mut work = LabCompiler {
        names: &names,
        globals: &mut globals,
        texts: &mut texts,
        unknown: &mut unknown,
        prepare,
        findings,
    };

    let setup = lab.setup.as_ref().and_then(|t| work.statements(t, None));
    let controls = lab.controls.iter().map(|c| (c.label.value.clone(), work.control(c))).collect();
    let controller = lab.controller.as_ref().and_then(|t| work.statements(t, None));
    let mut probes = Vec::new();
    for (i, plot) in lab.plots.iter().enumerate() {
        for trace in &plot.traces {
            probes.push(Probe {
                name: format!("plot/{i}/{}", trace.label.value),
                bound: work.expression(&trace.expr),
            });
        }
    }
    for readout in &lab.readouts {
        probes.push(Probe {
            name: format!("readout/{}", readout.label.value),
            bound: work.expression(&readout.expr),
        });
    }
    unknown.join(findings);
    for (id, d) in globals.unset(&HOST_TERMS) {
        if let Some((_, text)) = texts.iter().find(|(t, _)| *t == id) {
            findings.push(to_finding(&d, text));
        }
    }
    let access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
    let functions = functions.clone();
    let mut programs = Programs {
        setup,
        controller,
        controls,
        probes,
        globals,
        access,
        functions,
        model: model.identity(),
        coupled: None,
        observed: None,
    };
    let mut access = programs.access;
    for bound in programs.bound() {
        include(bound.program.effects(), &mut access);
    }
    programs.access = access;
    programs
}

/// The compilation of one lab.
struct LabCompiler<'a> {
    names: &'a ModelNames<'a>,
    globals: &'a mut Globals,
    texts: &'a mut Vec<(ProgramId, Text)>,
    unknown: &'a mut UnknownNames,
    prepare: Prepare,
    findings: &'a mut Vec<Finding>,
}

impl LabCompiler<'_> {
    fn statements(&mut self, text: &Text, value: Option<Type>) -> Option<Bound> {
        let compiled = self.compiler(value).statements(&text.value);
        self.keep(text, compiled)
    }

    fn expression(&mut self, text: &Text) -> Option<Bound> {
        let compiled = self.compiler(None).expression(&text.value);
        self.keep(text, compiled)
    }

    fn compiler(&mut self, value: Option<Type>) -> Compiler<'_> {
        // Another rule reports typographic quotes, once for a whole text.
        (self.prepare)(Compiler::new(self.names, self.globals)).with_value(value).without_quotes()
    }

    fn keep(&mut self, text: &Text, compiled: Compiled) -> Option<Bound> {
        self.unknown.add(text, &compiled.diagnostics, self.findings.len());
        self.findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, text)));
        self.texts.push((compiled.id, text.clone()));
        compiled.program.map(|program| Bound { text: text.clone(), program })
    }

    fn control(&mut self, control: &Control) -> ControlProgram {
        match &control.kind {
            ControlKind::Button { run } => ControlProgram::Press(self.statements(run, None)),
            ControlKind::Slider { value, action, .. } => {
                let action = self.action(control, action, Type::Number);
                ControlProgram::Change(Value::Number(value.value), action)
            }
            ControlKind::Select { options, value, action } => {
                let numbers = options.iter().all(|o| matches!(o.value, Scalar::Number(_)));
                let action = self.action(control, action, if numbers { Type::Number } else { Type::Any });
                ControlProgram::Change(scalar(value), action)
            }
        }
    }

    fn action(&mut self, control: &Control, action: &Action, given: Type) -> ActionProgram {
        let param = action.param.as_ref().map(|p| self.globals.define(&p.value));
        let set = action.set.as_ref().and_then(|t| {
            let compiled = self.compiler(Some(given)).assignment(&t.value);
            self.keep(t, compiled)
        });
        let apply = action.apply.as_ref().and_then(|t| self.statements(t, Some(given)));
        if let (Some(text), Some(bound)) = (&action.apply, &apply)
            && !bound.program.effects().uses_value
            // If `set` is present, it never runs, which another rule reports.
            && action.set.is_none()
        {
            self.findings.push(
                Finding::warning(rules::VALUE_UNUSED, text.span(), "these statements never use `value`")
                    .why(format!(
                        "moving \"{}\" changes nothing, because only `value` holds the chosen value",
                        control.label.value
                    ))
                    .help("write `value` where the chosen value belongs"),
            );
        }
        // A page evaluates `apply` only if there is no `set`.
        ActionProgram { param, run: set.or(apply), init: action.init, reset: action.reset }
    }
}

/// The value of a scalar of the lesson.
pub fn scalar(value: &Scalar) -> Value {
    match value {
        Scalar::Number(n) => Value::Number(n.value),
        Scalar::Text(t) => Value::String(t.value.as_str().into()),
        Scalar::Bool(b, _) => Value::Boolean(*b),
    }
}

/// A diagnostic of the language with its span in the lesson.
pub fn to_finding(d: &Finding, text: &Text) -> Finding {
    let fix = d
        .fix
        .as_ref()
        .map(|f| Fix { applicability: f.applicability, ..fix_in_code(text, f.span.clone(), &f.text) });
    Finding { span: text.span_of(d.span.clone()), fix, ..d.clone() }
}
