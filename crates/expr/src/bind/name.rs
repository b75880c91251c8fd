//! Names at the start of an expression and behind a point, and what was probably meant by unknown ones.

use super::{Attempt, Binder, Meaning, Method, Reported, Thing};
use crate::ast::{Expr, ExprKind, Name};
use crate::code;
use crate::diagnostic::{Diagnostic, Span};
use crate::ir::{Ir, Kind, View};
use crate::math;
use crate::parse::MAX_DIAGNOSTICS;
use crate::schema::{Entry, Field, ObjectId, Type};
use crate::suggest::{closest, ranked};
use crate::value::Value;

/// Names of the language itself.
const LANGUAGE: [&str; 7] = ["Math", "NaN", "Infinity", "undefined", "isNaN", "isFinite", "ctx"];

/// Objects of a browser or of Node that a lesson does not have, and why.
const GLOBALS: &[(&[&str], &str, &str)] = &[
    (
        &[
            "window",
            "document",
            "globalThis",
            "self",
            "global",
            "localStorage",
            "sessionStorage",
            "navigator",
        ],
        "a lesson runs without a page: in a browser, on a command line, in a notebook",
        "use the names of the lab: `model`, `data`, `ctx`",
    ),
    (&["console", "alert", "prompt"], "there is nowhere to print", "show the value in a readout or a trace"),
    (
        &["fetch", "XMLHttpRequest", "WebSocket", "require", "process", "Worker"],
        "a lesson reaches nothing outside itself",
        "put the data into the lab",
    ),
    (
        &["eval", "Function"],
        "text that becomes code while running could not be checked before the run",
        "write the expression itself",
    ),
    (
        &["Date", "performance", "setTimeout", "setInterval", "requestAnimationFrame"],
        "the clock of the wall would make every run different",
        "use the time of the simulation, `data.time`",
    ),
    (
        &[
            "Promise",
            "Symbol",
            "Reflect",
            "Proxy",
            "Object",
            "Array",
            "RegExp",
            "Map",
            "Set",
            "JSON",
            "Intl",
            "arguments",
        ],
        "a lesson works on numbers of the simulation; it has no objects of its own",
        "keep numbers in variables of the lab, as `ctx.peak`",
    ),
];

/// Members through which JavaScript reaches the machinery behind a value.
pub(super) const MACHINERY: [&str; 5] =
    ["constructor", "prototype", "__proto__", "hasOwnProperty", "toString"];

impl Binder<'_> {
    /// What a part of the source stands for.
    pub(super) fn thing(&mut self, expr: &Expr) -> Attempt<Thing> {
        match &expr.kind {
            ExprKind::Name(name) => self.root(name, expr.span),
            ExprKind::Member { object, name } => self.member(object, name, expr.span),
            ExprKind::Index { object, index } => self.element(object, index, expr.span),
            ExprKind::Call { callee, args } => self.call(callee, args, expr.span),
            _ => self.operation(expr).map(Thing::Value),
        }
    }

    /// A name at the start of an expression.
    fn root(&mut self, name: &str, span: Span) -> Attempt<Thing> {
        if let Some(local) = self.locals.iter().rev().find(|l| l.name == name) {
            return match &local.meaning {
                Meaning::Slot(slot, ty) => Ok(Thing::Value(Ir::new(Kind::Local(*slot), *ty, span))),
                Meaning::Alias(thing) => Ok(thing.clone()),
                Meaning::Unknown => Err(Reported),
            };
        }
        if let Some(thing) = language(name, span) {
            return Ok(thing);
        }
        if let (true, Some(ty)) = (name == "value", self.value) {
            self.effects.uses_value = true;
            return Ok(Thing::Value(Ir::new(Kind::Input, ty, span)));
        }
        match self.schema.root(name) {
            Some(entry) => Ok(from_entry(entry, span)),
            None => {
                let report = self.unknown_root(name, span);
                self.refuse(report)
            }
        }
    }

    fn unknown_root(&self, name: &str, span: Span) -> Diagnostic {
        if self.declared_later.iter().any(|n| n == name) {
            return Diagnostic::error(
                code::USED_TOO_EARLY,
                span,
                format!("`{name}` is used before its declaration"),
            )
            .why("statements run from top to bottom: here the name has no value yet")
            .help(format!("move the declaration of `{name}` up"));
        }
        if name == "value" {
            return Diagnostic::error(code::NO_VALUE_HERE, span, "there is no `value` here")
                .why("`value` is what a slider or select gives to its own `set` or `apply`")
                .help("give the control a `param` and read it as `ctx.<param>`");
        }
        if let Some((_, why, help)) = GLOBALS.iter().find(|(names, _, _)| names.contains(&name)) {
            return Diagnostic::error(
                code::NOT_IN_LANGUAGE,
                span,
                format!("`{name}` is not in this language"),
            )
            .why(*why)
            .help(*help);
        }
        let report = Diagnostic::error(code::UNKNOWN_NAME, span, format!("unknown name `{name}`"));
        if self.diagnostics.len() > MAX_DIAGNOSTICS {
            return report; // nobody will read it: not worth a search for what was meant
        }
        match self.meant_by_root(name) {
            Some(meant) => report.help(format!("did you mean `{meant}`?")).fix(span, meant),
            None => {
                let mut known = self.schema.root_names();
                known.extend(["ctx".to_owned(), "Math".to_owned()]);
                report.why(format!("the names here are {}", list(&known))).help(format!(
                    "to keep a number of your own, write `ctx.{name} = …` or `const {name} = …`"
                ))
            }
        }
    }

    /// What a misspelt name, or one whose object was left out, probably means.
    fn meant_by_root(&self, name: &str) -> Option<String> {
        let roots = self.schema.root_names();
        for object in self.objects() {
            if self.schema.member(object.1, name).is_some() {
                return Some(format!("{}.{name}", object.0));
            }
        }
        if math::function(name).is_some() || math::constant(name).is_some() {
            return Some(format!("Math.{name}"));
        }
        let locals = self.locals.iter().map(|l| l.name.as_str());
        let known = locals.chain(roots.iter().map(String::as_str)).chain(LANGUAGE);
        if let Some(meant) = closest(name, known) {
            return Some(meant.to_owned());
        }
        if self.globals.slot(name).is_some() {
            return Some(format!("ctx.{name}"));
        }
        self.meant_elsewhere(name, None).map(|(_, path)| path)
    }

    /// The objects that a name leads to, and their objects, each with its path.
    fn objects(&self) -> Vec<(String, ObjectId)> {
        let mut found = Vec::new();
        for root in self.schema.root_names() {
            let Some(Entry::Object(id)) = self.schema.root(&root) else { continue };
            found.push((root, id));
        }
        for i in 0..found.len() {
            let Some((path, id)) = found.get(i).cloned() else { continue };
            for name in self.schema.member_names(id) {
                if let Some(Entry::Object(inner)) = self.schema.member(id, &name) {
                    found.push((format!("{path}.{name}"), inner));
                }
            }
        }
        found
    }

    /// The member of any object, except `but`, whose name is nearest to what was written, with its distance.
    fn meant_elsewhere(&self, name: &str, but: Option<ObjectId>) -> Option<(usize, String)> {
        let mut best: Option<(usize, String)> = None;
        for (path, id) in self.objects().into_iter().filter(|(_, id)| Some(*id) != but) {
            let exact = self.schema.member(id, name).map(|_| (0, name.to_owned()));
            let names = self.schema.member_names(id);
            let near = ranked(name, names.iter().map(String::as_str)).map(|(cost, n)| (cost, n.to_owned()));
            let Some((cost, near)) = exact.or(near) else { continue };
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, format!("{path}.{near}")));
            }
        }
        best
    }

    /// `object.name`
    fn member(&mut self, object: &Expr, name: &Name, span: Span) -> Attempt<Thing> {
        match self.thing(object)? {
            Thing::Object(id) => match self.schema.member(id, &name.text) {
                Some(entry) => Ok(from_entry(entry, span)),
                None => {
                    let report = self.unknown_member(id, name, span);
                    self.refuse(report)
                }
            },
            Thing::Math => self.math_member(name, span),
            Thing::Globals => self.global(&name.text, span).map(Thing::Value),
            Thing::Field(field) => self.field_member(field, object.span, name, span),
            Thing::Collection(id) => {
                let report = self.collection_needs_call(id, object.span, Some((&name.text, span)));
                self.refuse(report)
            }
            thing @ (Thing::Function(_) | Thing::MathFunction(_) | Thing::Method(..)) => {
                let report = self.not_called(&thing, object.span);
                self.refuse(report)
            }
            Thing::Value(_) => {
                let report = self.no_members(name);
                self.refuse(report)
            }
        }
    }

    /// A variable of the lab, read.
    pub(super) fn global(&mut self, name: &str, span: Span) -> Attempt<Ir> {
        self.check_machinery(name, span)?;
        let slot = self.globals.mention(name, self.program, span, false);
        self.effects.read_global(slot);
        Ok(Ir::new(Kind::Global(slot), Type::Any, span))
    }

    pub(super) fn check_machinery(&mut self, name: &str, span: Span) -> Attempt<()> {
        if !MACHINERY.contains(&name) {
            return Ok(());
        }
        self.refuse(machinery(name, span))
    }

    fn no_members(&self, name: &Name) -> Diagnostic {
        if MACHINERY.contains(&name.text.as_str()) {
            return machinery(&name.text, name.span);
        }
        Diagnostic::error(
            code::NOT_SUPPORTED,
            name.span,
            format!("`.{}` of a single value is not supported yet", name.text),
        )
        .why("a value here is a number, a boolean or a string, and has no members")
        .help("write a field of an object, as `data.qpos`")
    }

    fn math_member(&mut self, name: &Name, span: Span) -> Attempt<Thing> {
        if let Some(x) = math::constant(&name.text) {
            return Ok(Thing::Value(Ir::constant(Value::Number(x), span)));
        }
        if let Some(function) = math::function(&name.text) {
            return Ok(Thing::MathFunction(function));
        }
        if name.text == "random" {
            return self.refuse(
                Diagnostic::error(code::NOT_RANDOM, span, "random numbers are not in this language")
                    .why("the same lesson must give the same numbers every time, or its answers cannot be checked")
                    .help("use a fixed sequence, as `Math.sin(1000 * data.time)`, or a control"),
            );
        }
        let report =
            Diagnostic::error(code::UNKNOWN_FUNCTION, name.span, format!("`Math` has no `{}`", name.text));
        let report = match closest(&name.text, math::names()) {
            Some(meant) => report.help(format!("did you mean `Math.{meant}`?")).fix(name.span, meant),
            None => report
                .why("`Math` has the functions and constants of JavaScript")
                .help("write it with `+ - * / % **` and the functions there are"),
        };
        self.refuse(report)
    }

    /// `.length`, `.fill` and `.set` of an array.
    fn field_member(&mut self, field: Field, object: Span, name: &Name, span: Span) -> Attempt<Thing> {
        let array = !field.is_scalar();
        match name.text.as_str() {
            "length" if array => Ok(Thing::Value(match field.len() {
                Some(n) => Ir::constant(Value::Number(n as f64), span),
                None => {
                    let view = view_of(&field);
                    self.read(view, None);
                    Ir::new(Kind::Length(view), Type::Number, span)
                }
            })),
            "fill" if array => Ok(Thing::Method(Method::Fill, field)),
            "set" if array => Ok(Thing::Method(Method::Set, field)),
            text if MACHINERY.contains(&text) => self.refuse(machinery(text, name.span)),
            "map" | "reduce" | "slice" | "join" | "forEach" | "filter" | "some" | "every" | "at"
            | "indexOf"
                if array =>
            {
                let message = format!("the method `{}` is not supported yet", name.text);
                self.refuse(
                    Diagnostic::error(code::NOT_SUPPORTED, name.span, message)
                        .help(format!("write the elements out, as `{}[0]`", field.path)),
                )
            }
            text if array => {
                let report = Diagnostic::error(
                    code::UNKNOWN_FIELD,
                    name.span,
                    format!("`{}` has no member `{text}`", field.path),
                )
                .why("it is an array of numbers: its elements are chosen by index");
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
                let report = Diagnostic::error(
                    code::UNKNOWN_FIELD,
                    name.span,
                    format!("`{}` has no member `{text}`", field.path),
                )
                .why("it is one number")
                .help(format!("remove `.{text}`"))
                .fix(Span::new(object.end, name.span.end), "");
                self.refuse(report)
            }
        }
    }

    fn unknown_member(&self, id: ObjectId, name: &Name, span: Span) -> Diagnostic {
        let object = self.schema.describe(id);
        if MACHINERY.contains(&name.text.as_str()) {
            return machinery(&name.text, name.span);
        }
        let report = Diagnostic::error(
            code::UNKNOWN_FIELD,
            name.span,
            format!("{} has no field `{}`", quoted(&object), name.text),
        );
        if self.diagnostics.len() > MAX_DIAGNOSTICS {
            return report;
        }
        if let Some(hint) = self.schema.hint(id, &name.text) {
            return report.help(hint);
        }
        let names = self.schema.member_names(id);
        let here = ranked(&name.text, names.iter().map(String::as_str));
        let elsewhere = self.meant_elsewhere(&name.text, Some(id));
        match (here, elsewhere) {
            // The right name on the wrong object is nearer than another name on this one.
            (here, Some((cost, path))) if here.is_none_or(|(c, _)| cost < c) => {
                let (holder, meant) = path.rsplit_once('.').unwrap_or(("", &path));
                let how =
                    if meant == name.text { "a field of this name" } else { "a field with a name like it" };
                report
                    .why(format!("`{holder}` has {how}"))
                    .help(format!("did you mean `{path}`?"))
                    .fix(span, path)
            }
            (Some((_, meant)), _) => report.help(format!("did you mean `{meant}`?")).fix(name.span, meant),
            (None, _) if names.is_empty() => report.why("it has no fields at all"),
            (None, _) => report.why(format!("its fields are {}", list(&names))),
        }
    }
}

/// Names that mean the same in every lab.
fn language(name: &str, span: Span) -> Option<Thing> {
    let constant = |value| Some(Thing::Value(Ir::constant(value, span)));
    match name {
        "undefined" => constant(Value::Undefined),
        "NaN" => constant(Value::Number(f64::NAN)),
        "Infinity" => constant(Value::Number(f64::INFINITY)),
        "Math" => Some(Thing::Math),
        "ctx" => Some(Thing::Globals),
        _ => math::global(name).map(Thing::MathFunction),
    }
}

/// Whether the language itself gives a meaning to a name.
pub(super) fn is_language(name: &str) -> bool {
    LANGUAGE.contains(&name) || name == "value"
}

fn from_entry(entry: Entry, span: Span) -> Thing {
    match entry {
        Entry::Object(id) => Thing::Object(id),
        Entry::Field(field) => Thing::Field(field),
        Entry::Collection(id) => Thing::Collection(id),
        Entry::Function(id) => Thing::Function(id),
        Entry::Constant(value) => Thing::Value(Ir::constant(value, span)),
    }
}

fn machinery(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(code::NOT_IN_LANGUAGE, span, format!("`{name}` is not in this language"))
        .why("values have no prototypes and no methods of objects here; this is also what keeps a lesson harmless")
        .help("use another name")
}

/// The elements of a field.
pub(super) fn view_of(field: &Field) -> View {
    View { field: field.key, first: field.first, count: field.len() }
}

/// `model.opt` in backquotes; `the joint "a"` as it is.
pub(super) fn quoted(description: &str) -> String {
    if description.contains(' ') { description.to_owned() } else { format!("`{description}`") }
}

/// A list of names for a message, cut when it is long.
pub(super) fn list(names: &[String]) -> String {
    const SHOWN: usize = 8;
    let shown: Vec<String> = names.iter().take(SHOWN).map(|n| format!("`{n}`")).collect();
    let more = names.len().saturating_sub(SHOWN);
    if more > 0 { format!("{} and {more} more", shown.join(", ")) } else { shown.join(", ") }
}
