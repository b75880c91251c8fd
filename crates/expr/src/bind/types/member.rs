//! Meanings of names: at the start of an expression, and after a point.

use super::binder::{Binder, Entity, MethodReceiver};
use crate::ast::{Expr, ExprKind, Name};
use crate::bind::names::{INTERNAL_MEMBERS, NAMESPACES, list_names, meant_elsewhere};
use crate::host_terms::HostTerms;
use crate::ir::{Ir, IrKind};
use crate::math;
use crate::natives;
use crate::parse::{Attempt, MAX_DIAGNOSTICS, Reported};
use crate::rules;
use crate::schema::{Entry, Field, FieldKind, Help, Schema};
use crate::types::{ObjectId, Type};
use crate::value::{Value, View};
use labspec_finding::{Finding, Span, nearest, ranked};

impl<'a> Binder<'a> {
    pub(super) fn entity_inside(&mut self, expr: &'a Expr) -> Attempt<Entity> {
        match &expr.kind {
            ExprKind::Name(name) => self.root(name, expr.span),
            ExprKind::Member { object, name, optional } => self.member(object, name, *optional, expr.span),
            ExprKind::Index { object, index, optional } => self.element(object, index, *optional, expr.span),
            ExprKind::Call { callee, args, optional } => self.call(callee, args, *optional, expr.span),
            ExprKind::Function(function) => Ok(self.new_function(function)),
            _ => self.operation(expr).map(Entity::Value),
        }
    }

    /// Binds a name at the start of an expression.
    #[inline(never)]
    pub(super) fn root(&mut self, name: &str, span: Span) -> Attempt<Entity> {
        if let Some(variable) = self.variable(name, span)? {
            let entity = self.read_variable(&variable, span)?;
            self.explain_entity(&entity, name, span);
            return Ok(entity);
        }
        if let Some(entity) = language(name, span) {
            return Ok(entity);
        }
        if self.site.is_some()
            && let Some(function) = natives::find_function(name)
        {
            return Ok(Entity::Native(function));
        }
        if let (true, Some(ty)) = (name == "value", self.value) {
            return Ok(Entity::Value(Ir::new(IrKind::Input, ty, span)));
        }
        // The first pass has already reported an unknown name.
        let Some(entry) = self.schema.root(name) else {
            self.unresolved.get_or_insert(span);
            return Err(Reported);
        };
        let entity = from_entry(entry, span);
        self.explain_entity(&entity, name, span);
        Ok(entity)
    }

    /// Records the help for a name or a member.
    #[inline(never)]
    fn explain_entity(&mut self, entity: &Entity, text: &str, span: Span) {
        let schema = self.schema;
        match entity {
            Entity::Field(field) => self.explain(span, || field_help(field, None, schema)),
            Entity::Object(id) => {
                self.explain(span, || Help { title: schema.describe(*id), lines: Vec::new() });
            }
            Entity::Function(id) => {
                let info = schema.function(*id);
                let title = self.signature(&info);
                self.explain(span, || Help { title, lines: vec![info.doc] });
            }
            Entity::Value(ir) => {
                let ty = ir.ty;
                self.explain(span, || Help { title: text.to_owned(), lines: vec![ty.describe().to_owned()] });
            }
            _ => {}
        }
    }

    /// Binds `object.name` or `object?.name`.
    #[inline(never)]
    fn member(&mut self, object: &'a Expr, name: &Name, optional: bool, span: Span) -> Attempt<Entity> {
        let entity = self.entity(object)?;
        let found = self.member_of(entity, object.span, name, optional, span)?;
        self.explain_entity(&found, &name.text, name.span);
        Ok(found)
    }

    /// Binds a member of an entity.
    #[inline(never)]
    pub(super) fn member_of(
        &mut self,
        entity: Entity,
        object: Span,
        name: &Name,
        optional: bool,
        span: Span,
    ) -> Attempt<Entity> {
        match entity {
            Entity::Object(id) => match self.schema.member(id, &name.text) {
                Some(entry) => Ok(from_entry(entry, span)),
                None => {
                    let report = self.unknown_member(id, name, span);
                    self.refuse(report)
                }
            },
            Entity::Math => self.math_member(name, span),
            Entity::Globals => self.global(&name.text, span).map(Entity::Value),
            Entity::Namespace(holder) => self.namespace_member(holder, name, span),
            Entity::Field(field) if field.is_scalar() && self.is_method(&name.text, Type::Number) => {
                let ir = self.load(&field, crate::ir::Index::At(0), object);
                self.value_member(ir, name, optional, span)
            }
            Entity::Field(field) => self.field_member(field, object, name, span),
            Entity::Picked(id, chosen) => self.computed_member(id, chosen, name, span),
            Entity::Collection(id) => {
                let report = self.collection_needs_call(id, object, Some((&name.text, span)));
                self.refuse(report)
            }
            entity @ (Entity::Function(_)
            | Entity::MathFunction(_)
            | Entity::Method(..)
            | Entity::Native(_)
            | Entity::Closure(_)) => {
                let report = self.not_called(&entity, object);
                self.refuse(report)
            }
            Entity::Value(ir) => self.value_member(ir, name, optional, span),
        }
    }

    /// Binds a member of a namespace, such as `Array.from`.
    #[inline(never)]
    fn namespace_member(&mut self, holder: &'static str, name: &Name, span: Span) -> Attempt<Entity> {
        let path = format!("{holder}.{}", name.text);
        if let Some(function) = natives::find_function(&path) {
            return Ok(Entity::Native(function));
        }
        let constants = if holder == "Number" { natives::NUMBER_CONSTANTS } else { &[] };
        if let Some((_, x)) = constants.iter().find(|(n, _)| *n == name.text) {
            return Ok(Entity::Value(Ir::number(*x, span)));
        }
        if INTERNAL_MEMBERS.contains(&name.text.as_str()) {
            return self.refuse(internal_member(&name.text, name.span));
        }
        let report =
            Finding::error(rules::UNKNOWN_FUNCTION, name.span, format!("`{holder}` has no `{}`", name.text));
        let names: Vec<&str> = natives::public_rows()
            .filter_map(|row| row.name.strip_prefix(holder)?.strip_prefix('.'))
            .chain(constants.iter().map(|(n, _)| *n))
            .collect();
        self.refuse(match nearest(&name.text, names.iter().copied()) {
            Some(meant) => report.help(format!("did you mean `{holder}.{meant}`?")).guess(name.span, meant),
            None => {
                let names: Vec<String> = names.iter().map(|n| (*n).to_owned()).collect();
                report.why(format!("it has {}", list_names(&names)))
            }
        })
    }

    /// Binds a variable of the lab that is read.
    pub(super) fn global(&mut self, name: &str, span: Span) -> Attempt<Ir> {
        self.check_internal_member(name, span)?;
        let slot = self.globals.mention(name, self.program, span, false);
        Ok(Ir::new(IrKind::Global(slot), Type::Any, span))
    }

    pub(super) fn check_internal_member(&mut self, name: &str, span: Span) -> Attempt<()> {
        if !INTERNAL_MEMBERS.contains(&name) {
            return Ok(());
        }
        self.refuse(internal_member(name, span))
    }

    #[inline(never)]
    fn math_member(&mut self, name: &Name, span: Span) -> Attempt<Entity> {
        if let Some(x) = math::constant(&name.text) {
            return Ok(Entity::Value(Ir::constant(Value::Number(x), span)));
        }
        if let Some(function) = math::function(&name.text) {
            return Ok(Entity::MathFunction(function));
        }
        if name.text == "random" {
            return self.refuse(
                Finding::error(rules::NOT_RANDOM, span, "random numbers are not in this language")
                    .why(format!(
                        "the same {} must give the same numbers every time, so that its answers can be checked",
                        self.host_terms().lesson
                    ))
                    .help(format!("use a fixed sequence, as `Math.sin(1000 * {})`", self.host_terms().number)),
            );
        }
        let report =
            Finding::error(rules::UNKNOWN_FUNCTION, name.span, format!("`Math` has no `{}`", name.text));
        let report = match nearest(&name.text, math::names()) {
            Some(meant) => report.help(format!("did you mean `Math.{meant}`?")).guess(name.span, meant),
            None => report
                .why("`Math` has the functions and constants of JavaScript")
                .help("write it with `+ - * / % **` and the available functions"),
        };
        self.refuse(report)
    }

    /// Binds `.length` or a method of an array.
    #[inline(never)]
    fn field_member(&mut self, field: Field, object: Span, name: &Name, span: Span) -> Attempt<Entity> {
        let array = !field.is_scalar();
        let text = name.text.as_str();
        if let Some(method) = natives::find_method(text).filter(|_| array && self.is_method(text, Type::View))
        {
            return Ok(Entity::Method(Box::new(MethodReceiver::Field(field)), method));
        }
        match text {
            "length" if array => Ok(Entity::Value(match field.len() {
                Some(n) => Ir::number(n as f64, span),
                None => Ir::new(IrKind::Length(view_of(&field)), Type::Number, span),
            })),
            text @ ("push" | "pop" | "shift" | "unshift" | "splice") if array => self.refuse(
                Finding::error(rules::NOT_CALLABLE, name.span, format!("`{}` has a fixed number of elements", field.path))
                    .why(format!("`{text}` changes the number of elements of a list, but this array is the memory of the {}", self.host_terms().world))
                    .help(format!("store elements, as `{}[0] = 1`, or copy it into your own list: `const list = [...{}]`", field.path, field.path)),
            ),
            text if INTERNAL_MEMBERS.contains(&text) => self.refuse(internal_member(text, name.span)),
            text if array && self.is_method(text, Type::List) => self.refuse(
                Finding::error(rules::NOT_CALLABLE, name.span, format!("`{}` has no method `{text}`", field.path))
                    .why(format!("it is a typed array in JavaScript, and only lists have `{text}`"))
                    .help(format!("call it on a list of its elements, as `[...{}].{text}(…)`", field.path)),
            ),
            text if array => {
                let report = Finding::error(
                    rules::UNKNOWN_FIELD,
                    name.span,
                    format!("`{}` has no member `{text}`", field.path),
                )
                .why("it is an array of numbers, and an index selects its elements");
                let report = match text {
                    "x" | "y" | "z" if field.len() == Some(3) => {
                        let index = ["x", "y", "z"].iter().position(|n| *n == text).unwrap_or(0);
                        let meant = format!("{}[{index}]", self.text(object));
                        report.help(format!("write `{meant}`")).fix(span, meant)
                    }
                    _ => report.help(format!("write an index, as `{}[0]`", field.path)),
                };
                self.refuse(report)
            }
            text => {
                let report = Finding::error(
                    rules::UNKNOWN_FIELD,
                    name.span,
                    format!("`{}` has no member `{text}`", field.path),
                )
                .why("it is a single number");
                let methods = self.method_names(Type::Number);
                self.refuse(match nearest(text, methods) {
                    Some(meant) => report.help(format!("did you mean `{meant}`?")).guess(name.span, meant),
                    None => report
                        .help(format!("remove `.{text}`"))
                        .guess(Span::new(object.end, name.span.end), ""),
                })
            }
        }
    }

    /// The constant index that follows a name.
    fn index_after(&self, name: Span) -> Option<usize> {
        let rest = self.source.get(name.end..)?.trim_start().strip_prefix('[')?;
        rest.split_once(']')?.0.trim().parse().ok()
    }

    pub(super) fn unknown_member(&self, id: ObjectId, name: &Name, span: Span) -> Finding {
        let object = self.schema.describe(id);
        if INTERNAL_MEMBERS.contains(&name.text.as_str()) {
            return internal_member(&name.text, name.span);
        }
        let report = Finding::error(
            rules::UNKNOWN_FIELD,
            name.span,
            format!("{} has no field `{}`", quoted(&object), name.text),
        );
        if self.diagnostics.len() > MAX_DIAGNOSTICS {
            return report;
        }
        if let Some(hint) = self.schema.hint(id, &name.text, self.index_after(name.span)) {
            return report.help(hint);
        }
        let names = self.schema.member_names(id);
        let here = ranked(&name.text, names.iter().map(String::as_str));
        let elsewhere = meant_elsewhere(self.schema, &name.text, Some(id), &|_| true);
        match (here, elsewhere) {
            // The exact name on another object is a better suggestion than a similar name on this one.
            (here, Some((cost, path))) if here.is_none_or(|(c, _)| cost < c) => {
                let (holder, meant) = path.rsplit_once('.').unwrap_or(("", &path));
                let how =
                    if meant == name.text { "a field of this name" } else { "a field with a similar name" };
                report
                    .why(format!("`{holder}` has {how}"))
                    .help(format!("did you mean `{path}`?"))
                    .fix(span, path)
            }
            (Some((_, meant)), _) => report.help(format!("did you mean `{meant}`?")).guess(name.span, meant),
            (None, _) if names.is_empty() => report.why("it has no fields"),
            (None, _) => report.why(format!("its fields are {}", list_names(&names))),
        }
    }
}

/// The names that have the same meaning in every lab.
fn language(name: &str, span: Span) -> Option<Entity> {
    let constant = |value| Some(Entity::Value(Ir::constant(value, span)));
    match name {
        "undefined" => constant(Value::Undefined),
        "NaN" => constant(Value::Number(f64::NAN)),
        "Infinity" => constant(Value::Number(f64::INFINITY)),
        "Math" => Some(Entity::Math),
        "ctx" => Some(Entity::Globals),
        // `String(x)` is a call, and `String.fromCharCode` a member of a namespace: what follows the name decides.
        _ => match NAMESPACES.iter().find(|n| **n == name) {
            Some(holder) => Some(Entity::Namespace(holder)),
            None if name.starts_with('_') || name.contains('.') => None,
            None => math::global(name)
                .map(Entity::MathFunction)
                .or_else(|| natives::find_function(name).map(Entity::Native)),
        },
    }
}

/// The help for a field, or for one of its elements, from the table of fields.
pub(super) fn field_help(field: &Field, element: Option<usize>, schema: &dyn Schema) -> Help {
    let mut lines = Vec::new();
    if !field.doc.is_empty() {
        let unit = schema.unit(field, element);
        let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
        lines.push(format!("{}{unit}", field.doc));
    }
    if !field.owner.is_empty() {
        lines.push(field.owner.clone());
    }
    let shape: Vec<String> = field.shape.iter().map(|n| n.map_or("?".into(), |n| n.to_string())).collect();
    if !shape.is_empty() {
        lines.push(format!("{} numbers", shape.join(" × ")));
    }
    lines.push(kind_in_words(&field.kind, schema.host_terms()));
    Help { title: field.path.clone(), lines }
}

/// The effect of an assignment, by the kind of the field.
fn kind_in_words(kind: &FieldKind, host_terms: &HostTerms) -> String {
    match kind {
        FieldKind::State => "state: evolves in time, can be set".into(),
        FieldKind::Input => "input: set from outside".into(),
        FieldKind::Constant => "constant: can be changed".into(),
        FieldKind::Inertial => format!("constant: a change needs {}", host_terms.recompute),
        FieldKind::Structure => format!("fixed with the {}", host_terms.model),
        FieldKind::Derived { by } if by.is_empty() => "computed".into(),
        FieldKind::Derived { by } => format!("computed by {by}"),
    }
}

fn from_entry(entry: Entry, span: Span) -> Entity {
    match entry {
        Entry::Object(id) => Entity::Object(id),
        Entry::Field(field) => Entity::Field(field),
        Entry::Collection(id) => Entity::Collection(id),
        Entry::Function(id) => Entity::Function(id),
        Entry::Constant(value) => Entity::Value(Ir::constant(value, span)),
    }
}

pub(super) fn internal_member(name: &str, span: Span) -> Finding {
    Finding::error(rules::NOT_IN_LANGUAGE, span, format!("`{name}` is not in this language"))
        .why("it gives access to JavaScript internals, which the language excludes to keep a text harmless")
        .help("use another name")
}

/// The view of all elements of a field.
pub(super) fn view_of(field: &Field) -> View {
    View::new(field.key, field.first, field.len())
}

/// `model.opt` in backquotes; `the joint "a"` unchanged.
pub(super) fn quoted(description: &str) -> String {
    if description.contains(' ') { description.to_owned() } else { format!("`{description}`") }
}
