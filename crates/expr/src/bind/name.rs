//! Names at the start of an expression and behind a point, and what was probably meant by unknown ones.

use super::{Attempt, Binder, Receiver, Thing};
use crate::ast::{Expr, ExprKind, Name};
use crate::ir::{Ir, Kind};
use crate::math;
use crate::natives;
use crate::parse::MAX_DIAGNOSTICS;
use crate::rules;
use crate::schema::{Entry, Field, FieldKind, Help, ObjectId, Type};
use crate::value::{Value, View};
use crate::{Finding, Span};
use labspec_finding::{nearest as closest, ranked};

/// Names of the language itself.
const LANGUAGE: [&str; 14] = [
    "Math",
    "NaN",
    "Infinity",
    "undefined",
    "isNaN",
    "isFinite",
    "ctx",
    "Array",
    "Number",
    "String",
    "Boolean",
    "Object",
    "parseFloat",
    "parseInt",
];

/// Names that hold functions of the language.
const NAMESPACES: [&str; 4] = ["Array", "Number", "String", "Object"];

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
        &["Promise", "Symbol", "Reflect", "Proxy", "RegExp", "Map", "Set", "JSON", "Intl", "arguments"],
        "a lesson works on numbers of the simulation; lists and records are all it needs",
        "keep values in variables of the lab, as `ctx.peak`, in lists `[0, 1]` or in records `{a: 1}`",
    ),
];

/// Members through which JavaScript reaches the machinery behind a value.
pub(super) const MACHINERY: [&str; 5] =
    ["constructor", "prototype", "__proto__", "hasOwnProperty", "valueOf"];

/// What is done with a name: what may have been meant by an unknown one depends on it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    /// Its value is taken, or it is handed to a function.
    Value,
    /// A member or an element of it is.
    Holder,
    /// It is called.
    Callee,
}

impl Use {
    /// Whether something of the host can be used like this.
    fn fits(self, entry: &Entry) -> bool {
        match (self, entry) {
            (Use::Callee, Entry::Function(_) | Entry::Collection(_)) => true,
            (Use::Callee, _) | (Use::Value | Use::Holder, Entry::Function(_)) => false,
            (Use::Value, Entry::Collection(_)) => false,
            (Use::Value | Use::Holder, _) => true,
        }
    }

    /// Whether a word of the language can.
    fn fits_word(self, word: &str) -> bool {
        match word {
            "Math" | "ctx" => self == Use::Holder,
            "NaN" | "Infinity" | "undefined" => self == Use::Value,
            "Object" | "Array" => self == Use::Holder,
            "Number" | "String" => true,
            _ => self != Use::Holder,
        }
    }
}

impl<'a> Binder<'a> {
    /// What a part of the source stands for.
    pub(super) fn thing(&mut self, expr: &'a Expr) -> Attempt<Thing> {
        match &expr.kind {
            ExprKind::Name(name) => self.root(name, expr.span, Use::Value),
            ExprKind::Member { object, name, optional } => self.member(object, name, *optional, expr.span),
            ExprKind::Index { object, index, optional } => self.element(object, index, *optional, expr.span),
            ExprKind::Call { callee, args, optional } => self.call(callee, args, *optional, expr.span),
            ExprKind::Function(function) => Ok(self.new_function(function)),
            _ => self.operation(expr).map(Thing::Value),
        }
    }

    /// What stands before a point or an index.
    pub(super) fn holder(&mut self, object: &'a Expr) -> Attempt<Thing> {
        match &object.kind {
            ExprKind::Name(name) => self.root(name, object.span, Use::Holder),
            _ => self.thing(object),
        }
    }

    /// A name at the start of an expression.
    pub(super) fn root(&mut self, name: &str, span: Span, used: Use) -> Attempt<Thing> {
        if let Some(variable) = self.variable(name) {
            let thing = self.read_variable(&variable, span)?;
            self.explain_thing(&thing, name, span);
            return Ok(thing);
        }
        if let Some(thing) = language(name, span) {
            return Ok(thing);
        }
        if self.site.is_some()
            && let Some(function) = natives::free(name)
        {
            return Ok(Thing::Native(function));
        }
        if let (true, Some(ty)) = (name == "value", self.value) {
            self.effects.uses_value = true;
            return Ok(Thing::Value(Ir::new(Kind::Input, ty, span)));
        }
        match self.schema.root(name) {
            Some(entry) => {
                let thing = from_entry(entry, span);
                self.explain_thing(&thing, name, span);
                Ok(thing)
            }
            None => {
                let report = self.unknown_root(name, span, used);
                self.refuse(report)
            }
        }
    }

    /// Notes what a name or a member is.
    pub(super) fn explain_thing(&mut self, thing: &Thing, text: &str, span: Span) {
        let schema = self.schema;
        match thing {
            Thing::Field(field) => self.explain(span, || field_help(field)),
            Thing::Object(id) => {
                self.explain(span, || Help { title: schema.describe(*id), lines: Vec::new() });
            }
            Thing::Function(id) => {
                let info = schema.function(*id);
                let title = self.signature(&info);
                self.explain(span, || Help { title, lines: vec![info.doc] });
            }
            Thing::Value(ir) => {
                let ty = ir.ty;
                self.explain(span, || Help { title: text.to_owned(), lines: vec![ty.describe().to_owned()] });
            }
            _ => {}
        }
    }

    fn unknown_root(&self, name: &str, span: Span, used: Use) -> Finding {
        if name == "value" {
            return Finding::error(rules::NO_VALUE_HERE, span, "there is no `value` here")
                .why("`value` is what a slider or select gives to its own `set` or `apply`")
                .help("give the control a `param` and read it as `ctx.<param>`");
        }
        if let Some((_, why, help)) = GLOBALS.iter().find(|(names, _, _)| names.contains(&name)) {
            return Finding::error(rules::NOT_IN_LANGUAGE, span, format!("`{name}` is not in this language"))
                .why(*why)
                .help(*help);
        }
        let report = match used {
            Use::Callee => {
                Finding::error(rules::UNKNOWN_FUNCTION, span, format!("unknown function `{name}`"))
            }
            _ => Finding::error(rules::UNKNOWN_NAME, span, format!("unknown name `{name}`")),
        };
        if self.diagnostics.len() > MAX_DIAGNOSTICS {
            return report; // nobody will read it: not worth a search for what was meant
        }
        match self.meant_by_root(name, used) {
            Some(meant) => report.help(format!("did you mean `{meant}`?")).guess(span, meant),
            None => {
                let own = match used {
                    Use::Callee => {
                        "to make a function of your own, write `const f = (x) => …` before".to_owned()
                    }
                    _ => {
                        format!("to keep a number of your own, write `ctx.{name} = …` or `const {name} = …`")
                    }
                };
                let mut known = self.schema.root_names();
                known.extend(["ctx".to_owned(), "Math".to_owned()]);
                report.why(format!("the names here are {}", list(&known))).help(own)
            }
        }
    }

    /// What a misspelt name, or one whose object was left out, probably means.
    fn meant_by_root(&self, name: &str, used: Use) -> Option<String> {
        let fits = |entry: Option<Entry>| entry.is_some_and(|e| used.fits(&e));
        for (path, object) in self.objects() {
            // A choice by name has no members: behind a point something else was probably meant.
            let entry = self.schema.member(object, name);
            let entry = entry.filter(|e| used == Use::Callee || !matches!(e, Entry::Collection(_)));
            if fits(entry) {
                return Some(format!("{path}.{name}"));
            }
        }
        let of_math = match used {
            Use::Callee => math::function(name).is_some(),
            _ => math::constant(name).is_some(),
        };
        if of_math {
            return Some(format!("Math.{name}"));
        }
        let mut roots = self.schema.root_names();
        roots.retain(|root| fits(self.schema.root(root)));
        let locals = self.variables.iter().filter(|_| self.site.is_none()).map(|v| v.name.as_str());
        let words = LANGUAGE.into_iter().filter(|word| used.fits_word(word));
        let known = locals.chain(roots.iter().map(String::as_str)).chain(words);
        if let Some(meant) = closest(name, known) {
            return Some(meant.to_owned());
        }
        if self.globals.slot(name).is_some() {
            return Some(format!("ctx.{name}"));
        }
        // On an object that was not even written, only a name that is nearly the same was meant.
        let near = if name.len() < 8 { 10 } else { 20 };
        let elsewhere = self.meant_elsewhere(name, None, &|entry| used.fits(entry));
        elsewhere.filter(|(cost, _)| *cost <= near).map(|(_, path)| path)
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
    fn meant_elsewhere(
        &self,
        name: &str,
        but: Option<ObjectId>,
        fits: &dyn Fn(&Entry) -> bool,
    ) -> Option<(usize, String)> {
        let mut best: Option<(usize, String)> = None;
        for (path, id) in self.objects().into_iter().filter(|(_, id)| Some(*id) != but) {
            let fits = |name: &str| self.schema.member(id, name).is_some_and(|entry| fits(&entry));
            let mut names = self.schema.member_names(id);
            let exact = fits(name).then(|| (0, name.to_owned()));
            let near = || {
                names.retain(|n| fits(n));
                ranked(name, names.iter().map(String::as_str)).map(|(cost, n)| (cost, n.to_owned()))
            };
            let Some((cost, near)) = exact.or_else(near) else { continue };
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, format!("{path}.{near}")));
            }
        }
        best
    }

    /// `object.name`, or `object?.name`
    fn member(&mut self, object: &'a Expr, name: &Name, optional: bool, span: Span) -> Attempt<Thing> {
        let thing = self.holder(object)?;
        let found = self.member_of(thing, object.span, name, optional, span)?;
        self.explain_thing(&found, &name.text, name.span);
        Ok(found)
    }

    /// A member of what stands before the point.
    pub(super) fn member_of(
        &mut self,
        thing: Thing,
        object: Span,
        name: &Name,
        optional: bool,
        span: Span,
    ) -> Attempt<Thing> {
        match thing {
            Thing::Object(id) => match self.schema.member(id, &name.text) {
                Some(entry) => Ok(from_entry(entry, span)),
                None => {
                    let report = self.unknown_member(id, name, span);
                    self.refuse(report)
                }
            },
            Thing::Math => self.math_member(name, span),
            Thing::Globals => self.global(&name.text, span).map(Thing::Value),
            Thing::Namespace(holder) => self.namespace_member(holder, name, span),
            Thing::Field(field) if field.is_scalar() && self.is_method(&name.text, Type::Number) => {
                let ir = self.load(&field, crate::ir::Index::At(0), object);
                self.value_member(ir, name, optional, span)
            }
            Thing::Field(field) => self.field_member(field, object, name, span),
            Thing::Picked(id, chosen) => self.picked_member(id, chosen, name, span),
            Thing::Collection(id) => {
                let report = self.collection_needs_call(id, object, Some((&name.text, span)));
                self.refuse(report)
            }
            thing @ (Thing::Function(_)
            | Thing::MathFunction(_)
            | Thing::Method(..)
            | Thing::Native(_)
            | Thing::Closure(_)) => {
                let report = self.not_called(&thing, object);
                self.refuse(report)
            }
            Thing::Value(ir) => self.value_member(ir, name, optional, span),
        }
    }

    /// `Array.from` and its like.
    fn namespace_member(&mut self, holder: &'static str, name: &Name, span: Span) -> Attempt<Thing> {
        let path = format!("{holder}.{}", name.text);
        if let Some(function) = natives::free(&path) {
            return Ok(Thing::Native(function));
        }
        let constants = if holder == "Number" { natives::NUMBER_CONSTANTS } else { &[] };
        if let Some((_, x)) = constants.iter().find(|(n, _)| *n == name.text) {
            return Ok(Thing::Value(Ir::number(*x, span)));
        }
        if MACHINERY.contains(&name.text.as_str()) {
            return self.refuse(machinery(&name.text, name.span));
        }
        let report =
            Finding::error(rules::UNKNOWN_FUNCTION, name.span, format!("`{holder}` has no `{}`", name.text));
        let names: Vec<&str> = natives::rows()
            .filter_map(|row| row.name.strip_prefix(holder)?.strip_prefix('.'))
            .chain(constants.iter().map(|(n, _)| *n))
            .collect();
        self.refuse(match closest(&name.text, names.iter().copied()) {
            Some(meant) => report.help(format!("did you mean `{holder}.{meant}`?")).guess(name.span, meant),
            None => {
                let names: Vec<String> = names.iter().map(|n| (*n).to_owned()).collect();
                report.why(format!("it has {}", list(&names)))
            }
        })
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

    fn math_member(&mut self, name: &Name, span: Span) -> Attempt<Thing> {
        if let Some(x) = math::constant(&name.text) {
            return Ok(Thing::Value(Ir::constant(Value::Number(x), span)));
        }
        if let Some(function) = math::function(&name.text) {
            return Ok(Thing::MathFunction(function));
        }
        if name.text == "random" {
            return self.refuse(
                Finding::error(rules::NOT_RANDOM, span, "random numbers are not in this language")
                    .why("the same lesson must give the same numbers every time, or its answers cannot be checked")
                    .help("use a fixed sequence, as `Math.sin(1000 * data.time)`, or a control"),
            );
        }
        let report =
            Finding::error(rules::UNKNOWN_FUNCTION, name.span, format!("`Math` has no `{}`", name.text));
        let report = match closest(&name.text, math::names()) {
            Some(meant) => report.help(format!("did you mean `Math.{meant}`?")).guess(name.span, meant),
            None => report
                .why("`Math` has the functions and constants of JavaScript")
                .help("write it with `+ - * / % **` and the functions there are"),
        };
        self.refuse(report)
    }

    /// `.length` and the methods of an array.
    fn field_member(&mut self, field: Field, object: Span, name: &Name, span: Span) -> Attempt<Thing> {
        let array = !field.is_scalar();
        let text = name.text.as_str();
        if let Some(method) = natives::name(text).filter(|_| array && self.is_method(text, Type::View)) {
            return Ok(Thing::Method(Box::new(Receiver::Field(field)), method));
        }
        match text {
            "length" if array => Ok(Thing::Value(match field.len() {
                Some(n) => Ir::number(n as f64, span),
                None => {
                    let view = view_of(&field);
                    self.read(view, None);
                    Ir::new(Kind::Length(view), Type::Number, span)
                }
            })),
            text @ ("push" | "pop" | "shift" | "unshift" | "splice") if array => self.refuse(
                Finding::error(rules::NOT_CALLABLE, name.span, format!("`{}` has a fixed number of elements", field.path))
                    .why(format!("`{text}` changes the number of elements of a list; this array is the memory of the simulation"))
                    .help(format!("store elements, as `{}[0] = 1`, or copy it into a list of your own: `const list = [...{}]`", field.path, field.path)),
            ),
            text if MACHINERY.contains(&text) => self.refuse(machinery(text, name.span)),
            text if array => {
                let report = Finding::error(
                    rules::UNKNOWN_FIELD,
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
                let report = Finding::error(
                    rules::UNKNOWN_FIELD,
                    name.span,
                    format!("`{}` has no member `{text}`", field.path),
                )
                .why("it is one number");
                let methods = self.method_names(Type::Number);
                self.refuse(match closest(text, methods.into_iter()) {
                    Some(meant) => report.help(format!("did you mean `{meant}`?")).guess(name.span, meant),
                    None => report
                        .help(format!("remove `.{text}`"))
                        .fix(Span::new(object.end, name.span.end), ""),
                })
            }
        }
    }

    pub(super) fn unknown_member(&self, id: ObjectId, name: &Name, span: Span) -> Finding {
        let object = self.schema.describe(id);
        if MACHINERY.contains(&name.text.as_str()) {
            return machinery(&name.text, name.span);
        }
        let report = Finding::error(
            rules::UNKNOWN_FIELD,
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
        let elsewhere = self.meant_elsewhere(&name.text, Some(id), &|_| true);
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
            (Some((_, meant)), _) => report.help(format!("did you mean `{meant}`?")).guess(name.span, meant),
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
        // `String(x)` is a function and `String` a holder of others: which is meant shows behind the name.
        _ => match NAMESPACES.iter().find(|n| **n == name) {
            Some(holder) => Some(Thing::Namespace(holder)),
            None if name.starts_with('_') || name.contains('.') => None,
            None => {
                math::global(name).map(Thing::MathFunction).or_else(|| natives::free(name).map(Thing::Native))
            }
        },
    }
}

/// What a field is, in the words of its table.
pub(super) fn field_help(field: &Field) -> Help {
    let mut lines = Vec::new();
    if !field.doc.is_empty() {
        let unit = if field.unit.is_empty() { String::new() } else { format!(", {}", field.unit) };
        lines.push(format!("{}{unit}", field.doc));
    }
    if !field.owner.is_empty() {
        lines.push(field.owner.clone());
    }
    let shape: Vec<String> = field.shape.iter().map(|n| n.map_or("?".into(), |n| n.to_string())).collect();
    if !shape.is_empty() {
        lines.push(format!("{} numbers", shape.join(" × ")));
    }
    lines.push(kind_in_words(&field.kind));
    Help { title: field.path.clone(), lines }
}

/// What assigning means.
fn kind_in_words(kind: &FieldKind) -> String {
    match kind {
        FieldKind::State => "state: evolves in time, may be set".into(),
        FieldKind::Input => "input: set from outside".into(),
        FieldKind::Constant => "constant: a change takes effect at the next step".into(),
        FieldKind::Inertial => "constant: a change needs `mj_setConst`".into(),
        FieldKind::Structure => "fixed with the model".into(),
        FieldKind::Derived { by } if by.is_empty() => "computed".into(),
        FieldKind::Derived { by } => format!("computed by {by}"),
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

pub(super) fn machinery(name: &str, span: Span) -> Finding {
    Finding::error(rules::NOT_IN_LANGUAGE, span, format!("`{name}` is not in this language"))
        .why(
            "it leads behind the values, into JavaScript itself; that this is closed keeps a lesson harmless",
        )
        .help("use another name")
}

/// The elements of a field.
pub(super) fn view_of(field: &Field) -> View {
    View::new(field.key, field.first, field.len())
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
