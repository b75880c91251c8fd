//! Elements: indexes of fields, `ctx['name']`, named objects, and the messages about arrays used as a whole.

use super::binder::{Binder, Entity};
use super::member::{quoted, view_of};
use crate::ast::{Expr, ExprKind};
use crate::bind::names::list_names;
use crate::host_terms::HostTerms;
use crate::ir::{Index, Ir, IrKind};
use crate::number;
use crate::parse::{Attempt, Reported};
use crate::rules;
use crate::schema::{Field, Help};
use crate::types::{CollectionId, ObjectId, Type};
use crate::value::Value;
use labspec_finding::{DESCRIBED, Finding, Fix, Span, nearest};

/// The largest number of elements of an array that a help names one by one.
const MAX_LISTED: usize = 4;

/// The name of a `ctx` variable.
pub(super) enum GlobalName {
    Constant(String),
    Computed(Ir),
}

impl<'a> Binder<'a> {
    /// Binds `object[index]` that is read.
    #[inline(never)]
    pub(super) fn element(
        &mut self,
        object: &'a Expr,
        index: &'a Expr,
        optional: bool,
        span: Span,
    ) -> Attempt<Entity> {
        if let Some(field) = self.call_as_field(object) {
            let index = self.index(&field, index, span)?;
            return Ok(Entity::Value(self.load(&field, index, span)));
        }
        let entity = self.entity(object);
        if let Ok(Entity::Globals) = entity {
            return self.read_named_global(index, span).map(Entity::Value);
        }
        match entity {
            Ok(Entity::Field(field)) => {
                let index = self.index(&field, index, span)?;
                self.name_element(&field, &index, span);
                Ok(Entity::Value(self.load(&field, index, span)))
            }
            Ok(Entity::Value(ir)) if ir.ty.may_have_parts() || ir.ty == Type::String || optional => {
                let ir = if optional { self.present(ir) } else { ir };
                self.value_element(ir, index, span).map(Entity::Value)
            }
            Ok(other) => {
                let report = self.not_indexable(&other, object, index, span);
                self.refuse(report)
            }
            Err(Reported) => {
                // The index may contain an error that must be reported as well.
                let _ = self.value(index);
                Err(Reported)
            }
        }
    }

    /// If the index is known, records the description of an element and its spelling by object name.
    pub(super) fn name_element(&mut self, field: &Field, index: &Index, span: Span) {
        let Index::At(i) = index else { return };
        if !DESCRIBED || self.site.is_some() || !self.explains {
            return;
        }
        self.explain_element(field, *i, span);
        // Only an index of a whole array is replaced by a name.
        let whole = field.first == 0 && field.path.split('.').count() == 2 && !field.path.contains('(');
        let constant = self.text(span).ends_with(&format!("[{i}]"));
        if whole
            && constant
            && let Some(named) = self.schema.named_element(field.key, *i)
        {
            self.named.push(Fix::safe(span, named));
        }
    }

    /// Records the description of an element of a field: `joint light_free (free): z position, m`.
    fn explain_element(&mut self, field: &Field, index: usize, span: Span) {
        let (schema, key, first) = (self.schema, field.key, field.first);
        self.explain(span, || {
            let mut help = super::member::field_help(field, Some(index), schema);
            help.title = format!("{}[{index}]", field.path);
            help.lines.splice(0..0, schema.element_help(key, first + index));
            help
        });
    }

    /// Binds an element of a list or a string.
    fn value_element(&mut self, object: Ir, index: &'a Expr, span: Span) -> Attempt<Ir> {
        let index = self.value(index)?;
        if let Some(n) = self.known_length(&object)
            && let Some(Value::Number(x)) = index.as_constant()
            && (*x < 0.0 || *x >= n as f64)
        {
            let text = number::to_text(*x);
            let count = if n == 1 { "1 element".into() } else { format!("{n} elements") };
            self.report(
                Finding::error(
                    rules::INDEX_RANGE,
                    index.span,
                    format!("index {text} is past the end of this list"),
                )
                .why(format!("it has {count}, and reading past them gives `undefined`"))
                .help(format!("indexes are 0 to {}", n.saturating_sub(1))),
            );
            return Err(Reported);
        }
        let ty = if object.ty == Type::View { Type::Element } else { Type::Any };
        Ok(Ir::new(IrKind::Element(Box::new(object), Box::new(index)), ty, span))
    }

    /// Binds an element of a field that is read.
    pub(super) fn load(&mut self, field: &Field, index: Index, span: Span) -> Ir {
        let view = view_of(field);
        // An index that is known to be valid gives a number; any other index gives a number or `undefined`.
        let certain = match (&index, view.count()) {
            (Index::At(_), Some(_)) => true,
            (Index::Computed(ir), Some(n)) => {
                self.range_of(ir).is_some_and(|(least, most)| least >= 0.0 && most < n as f64)
            }
            _ => false,
        };
        let ty = if certain { Type::Number } else { Type::Element };
        Ir::new(IrKind::Load(view, index), ty, span)
    }

    /// Binds the name in `ctx['name']`.
    pub(super) fn global_name(&mut self, index: &'a Expr) -> Attempt<GlobalName> {
        let ir = self.value(index)?;
        match ir.as_constant() {
            Some(name @ (Value::String(_) | Value::Number(_))) => Ok(GlobalName::Constant(name.to_string())),
            _ => {
                // `'q' + i` names only variables that begin with `q`.
                let begins = match &ir.kind {
                    IrKind::Binary(crate::ast::BinaryOp::Add, left, _) => {
                        left.as_constant().map(Value::to_string)
                    }
                    _ => None,
                };
                self.globals.mention_all(&begins.unwrap_or_default());
                Ok(GlobalName::Computed(ir))
            }
        }
    }

    fn read_named_global(&mut self, index: &'a Expr, span: Span) -> Attempt<Ir> {
        match self.global_name(index)? {
            GlobalName::Constant(name) => self.global(&name, span),
            GlobalName::Computed(ir) => Ok(Ir::new(IrKind::GlobalNamed(Box::new(ir)), Type::Any, span)),
        }
    }

    /// Binds the index of an element of a field, and checks it as far as it is known.
    pub(super) fn index(&mut self, field: &Field, index: &'a Expr, span: Span) -> Attempt<Index> {
        let ir = self.operand(index)?;
        if field.is_scalar() {
            let object = Span::new(span.start, index.span.start);
            let object = self.text(object).trim_end().trim_end_matches('[').to_owned();
            return self.refuse(
                Finding::error(
                    rules::NOT_INDEXABLE,
                    span,
                    format!("`{}` is a single number, not an array", field.path),
                )
                .why("an index selects an element of an array; on a number it gives `undefined`")
                .help(format!("write `{object}`"))
                .fix(span, object),
            );
        }
        match (ir.as_constant(), ir.ty) {
            (Some(Value::Number(x)), _) => {
                let element = self.known_index(field, *x, index.span)?;
                Ok(Index::At(element))
            }
            (None, Type::Number | Type::Any | Type::Element | Type::Never) => {
                self.check_range(field, &ir)?;
                Ok(Index::Computed(Box::new(ir)))
            }
            (_, ty) => {
                let mut report = Finding::error(
                    rules::INDEX_KIND,
                    index.span,
                    format!("the index is {}, not a number", ty.describe()),
                )
                .why(format!(
                    "the elements of `{}` are numbered{}",
                    field.path,
                    range(field)
                ));
                report = match ir.as_constant() {
                    Some(Value::String(_)) => report.help(format!(
                        "to select an object by its name, write `{}` or similar",
                        self.host_terms().choice
                    )),
                    _ => report.help("write an integer"),
                };
                self.refuse(report)
            }
        }
    }

    /// Checks an index with a known value.
    fn known_index(&mut self, field: &Field, x: f64, span: Span) -> Attempt<usize> {
        let text = number::to_text(x);
        if x < 0.0 {
            let mut report = Finding::error(rules::INDEX_NEGATIVE, span, format!("index {text} is negative"))
                .why("indexes start at 0; JavaScript gives `undefined` here and does not count from the end");
            report = match field.len() {
                Some(n) if n as f64 + x >= 0.0 && x.fract() == 0.0 => {
                    report.help(format!("to count from the end, write `{}[{}]`", field.path, n as f64 + x))
                }
                _ => report.help(format!("indexes of `{}` are{}", field.path, range(field))),
            };
            return self.refuse(report);
        }
        if x.fract() != 0.0 || !x.is_finite() {
            return self.refuse(
                Finding::error(rules::INDEX_FRACTION, span, format!("index {text} is not an integer"))
                    .why("an element has an integer index; JavaScript gives `undefined` here")
                    .help("round it, as `Math.floor(x)`, or write an integer"),
            );
        }
        // Whole numbers beyond the range of usize become usize::MAX, which is always out of range.
        let element = x as usize;
        if field.len().is_some_and(|n| element >= n) {
            let report = out_of_range(field, &text, span, self.host_terms());
            return self.refuse(report);
        }
        Ok(element)
    }

    pub(super) fn not_indexable(&self, entity: &Entity, object: &Expr, index: &Expr, span: Span) -> Finding {
        let text = self.text(object.span);
        let error = |message: String| Finding::error(rules::NOT_INDEXABLE, span, message);
        let name = match &index.kind {
            ExprKind::String(name) => Some(name.as_str()),
            _ => None,
        };
        match (entity, name) {
            (Entity::Collection(id), _) => {
                self.collection_needs_call(*id, object.span, name.map(|n| (n, span)))
            }
            (Entity::Object(_) | Entity::Math, Some(name)) => {
                error(format!("members of `{text}` are not selected with brackets"))
                    .why("names are resolved before the run, so they need a point")
                    .help(format!("write `{text}.{name}`"))
                    .fix(span, format!("{text}.{name}"))
            }
            (Entity::Object(id), None) => {
                error(format!("{} is not an array", quoted(&self.schema.describe(*id))))
                    .help("select a field first, with a point")
            }
            (Entity::Value(ir), _) if matches!(ir.kind, IrKind::Load(..)) => {
                error(format!("`{text}` is already a single number"))
                    .why("arrays are flat: one index selects one number, and the rows follow each other")
                    .help(format!(
                        "write one index, as `{}[3 * i + k]` for row i, column k",
                        self.host_terms().matrix
                    ))
            }
            (Entity::Value(_), _) => {
                error(format!("`{text}` is a single value, not an array")).help("remove the index")
            }
            (
                Entity::Function(_)
                | Entity::MathFunction(_)
                | Entity::Method(..)
                | Entity::Native(_)
                | Entity::Closure(_),
                _,
            ) => self.not_called(entity, object.span),
            _ => error(format!("`{text}` is not an array"))
                .help(format!("select a field with a point, as `{}`", self.host_terms().array)),
        }
    }

    /// The finding for a whole array where a single number is required.
    #[inline(never)]
    pub(super) fn whole_array(&self, field: &Field, span: Span) -> Finding {
        let text = self.text(span);
        let report = Finding::error(
            rules::WHOLE_ARRAY,
            span,
            format!("`{}` is an array, not a single number", field.path),
        );
        match field.len() {
            Some(1) => report
                .why("an array with one element is still an array")
                .help(format!("write `{text}[0]`"))
                .fix(span.after(), "[0]"),
            Some(n) => report
                .why(format!("{}a computation needs a single element", owner(field, n)))
                .help(select_element(text, n)),
            None => report
                .why("its length changes during the run, and a computation needs a single element")
                .help(format!("select an element, as `{text}[0]`")),
        }
    }

    /// The finding for a collection such as `data.joint` that is not called with a name.
    pub(super) fn collection_needs_call(
        &self,
        id: CollectionId,
        object: Span,
        name: Option<(&str, Span)>,
    ) -> Finding {
        let (text, noun) = (self.text(object), self.schema.noun(id));
        let report =
            |span| Finding::error(rules::NOT_A_VALUE, span, format!("`{text}` needs the name of a {noun}"));
        let names = self.schema.names(id);
        match name {
            Some((name, span)) if names.iter().any(|n| n == name) => {
                let meant = format!("{text}(\"{name}\")");
                report(span).help(format!("write `{meant}`")).fix(span, meant)
            }
            _ => match names.first() {
                Some(first) => report(object).help(format!("write `{text}(\"{first}\")`")),
                None => report(object)
                    .why(format!("no {noun} has a name here"))
                    .help(format!("give the {noun} a name in the {}", self.host_terms().model)),
            },
        }
    }

    /// Binds `data.joint("name")`.
    pub(super) fn named(
        &mut self,
        id: CollectionId,
        callee: Span,
        args: &'a [Expr],
        span: Span,
    ) -> Attempt<Entity> {
        let noun = self.schema.noun(id).to_owned();
        let [arg] = args else {
            let message =
                format!("`{}` takes the name of one {noun}, not {} arguments", self.text(callee), args.len());
            return self.refuse(
                Finding::error(rules::ARGUMENT_COUNT, span, message)
                    .help(format!("write `{}(\"…\")`", self.text(callee))),
            );
        };
        match self.object_name(id, arg)? {
            ObjectChoice::Constant(object) => Ok(Entity::Object(object)),
            ObjectChoice::Computed(name) => Ok(Entity::Picked(id, name)),
        }
    }

    /// Binds the name of an object of a collection.
    pub(super) fn object_name(&mut self, id: CollectionId, arg: &'a Expr) -> Attempt<ObjectChoice> {
        let noun = self.schema.noun(id).to_owned();
        let names = self.schema.names(id);
        let ir = self.value(arg)?;
        let name = match (ir.as_constant(), ir.ty) {
            (Some(Value::String(name)), _) => name.clone(),
            (None, Type::String | Type::Any | Type::Never) => {
                if names.is_empty() {
                    return self.refuse(
                        Finding::error(rules::UNKNOWN_OBJECT, arg.span, format!("no {noun} has a name here"))
                            .help(format!("give the {noun} a name in the {}", self.host_terms().model)),
                    );
                }
                return Ok(ObjectChoice::Computed(ir));
            }
            _ => {
                let text = if names.is_empty() {
                    String::new()
                } else {
                    format!("; the names are {}", list_names(&names))
                };
                return self.refuse(
                    Finding::error(
                        rules::ARGUMENT_TYPE,
                        arg.span,
                        format!("a {noun} must be selected by its name, not by {}", ir.ty.describe()),
                    )
                    .why(format!(
                        "the indexes of objects change when the {} changes",
                        self.host_terms().model
                    ))
                    .help(format!("write the name in quotes{text}")),
                );
            }
        };
        let name = &*name;
        if let Some(object) = self.schema.lookup(id, name) {
            let title = self.schema.describe(object);
            self.explain(arg.span, || Help { title, lines: Vec::new() });
            return Ok(ObjectChoice::Constant(object));
        }
        let report =
            Finding::error(rules::UNKNOWN_OBJECT, arg.span, format!("there is no {noun} named \"{name}\""));
        let report = match nearest(name, names.iter().map(String::as_str)) {
            Some(meant) => {
                report.help(format!("did you mean \"{meant}\"?")).guess(arg.span, format!("\"{meant}\""))
            }
            None if names.is_empty() => report
                .why(format!("no {noun} has a name here"))
                .help(format!("give the {noun} a name in the {}", self.host_terms().model)),
            None => report.why(format!("the names are {}", list_names(&names))).help("use one of them"),
        };
        self.refuse(report)
    }
}

/// The object to which a name refers.
pub(super) enum ObjectChoice {
    Constant(ObjectId),
    /// Known only at run time.
    Computed(Ir),
}

/// ` 0 to 13`, for the end of a sentence about indexes.
pub(super) fn range(field: &Field) -> String {
    match field.len() {
        Some(0) => ", but there are none".into(),
        Some(1) => " 0 only".into(),
        Some(n) => format!(" 0 to {}", n - 1),
        None => " from 0 on".into(),
    }
}

/// The advice to select an element of an array: one of few, or any of many.
pub(super) fn select_element(text: &str, n: usize) -> String {
    let all: Vec<String> = (0..n.min(MAX_LISTED)).map(|i| format!("`{text}[{i}]`")).collect();
    match all.split_last() {
        Some((last, others)) if !others.is_empty() && n <= MAX_LISTED => {
            format!("select an element: {} or {last}", others.join(", "))
        }
        _ => format!("select an element, as `{text}[0]`"),
    }
}

/// `the model has 14 coordinates; `, or the size if the host gives no description.
fn owner(field: &Field, n: usize) -> String {
    if field.owner.is_empty() { format!("it has {n} elements; ") } else { format!("{}; ", field.owner) }
}

/// The finding for an index past the end.
fn out_of_range(field: &Field, text: &str, span: Span, host_terms: &HostTerms) -> Finding {
    let what = match field.is_empty() {
        true => format!("`{}` has no elements", field.path),
        false => format!("index {text} is past the end of `{}`", field.path),
    };
    past_the_end(field, span, what, host_terms)
}

/// The finding for an access to elements that do not exist.
pub(super) fn past_the_end(field: &Field, span: Span, what: String, host_terms: &HostTerms) -> Finding {
    let n = field.len().unwrap_or(0);
    let report = Finding::error(rules::INDEX_RANGE, span, what);
    let shape = if field.shape.len() > 1 && n > 0 {
        format!("{n} numbers, {} in each row", row(field))
    } else {
        format!("{n} elements")
    };
    let why = match (field.owner.is_empty(), n) {
        (true, _) => format!("it has {shape}"),
        (false, _) if field.shape.len() > 1 => format!("{}: {shape}", field.owner),
        (false, _) => field.owner.clone(),
    };
    match n {
        0 => report
            .why(why)
            .help(format!("add the missing object to the {}, or use another field", host_terms.model)),
        _ => report.why(format!("{why}, and reading past the end gives `undefined`")).help(match n {
            1 => "use index 0, the only one".to_string(),
            _ => format!("indexes are{}", range(field)),
        }),
    }
}

/// The number of elements in a row of a multidimensional field.
fn row(field: &Field) -> usize {
    field.shape.iter().skip(1).map(|n| n.unwrap_or(1)).product()
}
