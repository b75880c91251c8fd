//! The walk of the first pass through a source text.

use std::collections::{BTreeMap, BTreeSet};

use super::declared::{Declaration, NameMeaning, NameTable};
use super::language::{is_language, report_constant, report_not_assignable, report_too_early};
use crate::ast::{Body, Expr, ExprKind, Function, Name, Property, UnaryOp};
use crate::bind::source::{self, MAX_LEVELS, TextKind};
use crate::globals::Globals;
use crate::rules;
use crate::schema::{Entry, FunctionInfo, Param, Schema};
use crate::types::CollectionId;
use labspec_finding::{Finding, Span, order};

/// How a name is used. The suggestions for an unknown name depend on it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::bind) enum NameUse {
    /// Its value is read, or it is passed to a function.
    Value,
    /// A member or an element of it is read.
    Holder,
    /// It is called.
    Callee,
}

/// The context in which the names of a text are resolved.
#[derive(Clone, Copy)]
pub(in crate::bind) struct NameContext<'s> {
    /// `None` for functions that are written in the language itself.
    pub(in crate::bind) schema: Option<&'s dyn Schema>,
    pub(in crate::bind) globals: &'s Globals,
    pub(in crate::bind) mode: TextKind,
    /// Whether a control supplies `value`.
    pub(in crate::bind) has_value: bool,
}

/// The maximum number of functions in one text.
pub(super) const MAX_FUNCTIONS: usize = 200;

/// The text itself, as the outermost function.
pub(super) const WHOLE: usize = usize::MAX;

/// A function, the function around it, and the extent of its scope.
pub(super) struct FunctionScope<'a> {
    pub(super) function: &'a Function,
    pub(super) around: usize,
    pub(super) reach: usize,
    pub(super) visited: bool,
}

pub(in crate::bind) struct NameWalk<'a, 's> {
    pub(super) around: NameContext<'s>,
    pub(super) names: NameTable,
    pub(super) found: Vec<Finding>,
    /// Declarations in scope, inner ones last.
    pub(super) reach: Vec<usize>,
    pub(super) functions: BTreeMap<usize, FunctionScope<'a>>,
    /// The function that is being visited.
    pub(super) function: usize,
    /// Pairs of functions: the second names the first.
    pub(super) calls: BTreeSet<(usize, usize)>,
    /// Variables of the lab that the text has named so far.
    pub(super) lab_variables: BTreeSet<&'a str>,
    pub(super) levels: usize,
}

/// Resolves the names of a text.
pub(in crate::bind) fn resolve<'a>(
    around: NameContext<'_>,
    work: impl FnOnce(&mut NameWalk<'a, '_>),
) -> (NameTable, Vec<Finding>) {
    let mut walk = NameWalk {
        around,
        names: NameTable::default(),
        found: Vec::new(),
        reach: Vec::new(),
        functions: BTreeMap::new(),
        function: WHOLE,
        calls: BTreeSet::new(),
        lab_variables: BTreeSet::new(),
        levels: 0,
    };
    work(&mut walk);
    walk.propagate_captures();
    (walk.names, walk.found)
}

impl<'a> NameWalk<'a, '_> {
    /// Resolves a single function.
    pub(in crate::bind) fn inside(&mut self, function: &'a Function) {
        self.define(function);
        self.visit(function.span.start);
    }

    /// Resolves an expression whose value is read.
    pub(in crate::bind) fn value(&mut self, expr: &'a Expr) {
        self.expr(expr, NameUse::Value);
    }

    pub(super) fn values(&mut self, items: &'a [Expr]) {
        items.iter().for_each(|item| self.value(item));
    }

    pub(super) fn expr(&mut self, expr: &'a Expr, used: NameUse) {
        if self.levels >= MAX_LEVELS {
            return self.too_deep(expr.span);
        }
        self.levels += 1;
        match &expr.kind {
            ExprKind::Name(name) => self.name(name, expr.span, used),
            ExprKind::Member { object, name, .. } => {
                if matches!(&object.kind, ExprKind::Name(n) if n == "ctx") {
                    self.lab_variables.insert(&name.text);
                }
                self.expr(object, NameUse::Holder);
            }
            ExprKind::Index { object, index, .. } => {
                self.expr(object, NameUse::Holder);
                self.value(index);
            }
            ExprKind::Call { callee, args, .. } => self.call(callee, args),
            ExprKind::Function(function) => self.inside(function),
            ExprKind::Unary { op: UnaryOp::Not, operand } => self.test(operand),
            ExprKind::Unary { operand, .. } => self.value(operand),
            ExprKind::Binary { left, right, .. } => {
                self.value(left);
                self.value(right);
            }
            ExprKind::Logical { left, right, .. } => {
                self.test(left);
                self.value(right);
            }
            ExprKind::Conditional { test, then, otherwise } => {
                self.test(test);
                self.value(then);
                self.value(otherwise);
            }
            ExprKind::Array(items) => self.values(items),
            ExprKind::Template { values, .. } => self.values(values),
            ExprKind::Object(properties) => properties.iter().for_each(|property| self.property(property)),
            ExprKind::Chain(inner) => self.expr(inner, used),
            ExprKind::Spread(inner) => self.value(inner),
            // Assignments in a text that only reads are refused as a whole, later.
            ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Update { .. } => {
                if self.around.mode == TextKind::Statements {
                    self.change(expr);
                }
            }
            ExprKind::Sequence(_)
            | ExprKind::Number(_)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Null
            | ExprKind::Error => {}
        }
        self.levels -= 1;
    }

    fn property(&mut self, property: &'a Property) {
        match property {
            Property::Named { value, .. } | Property::Spread(value) => self.value(value),
            Property::Computed { key, value } => {
                self.value(key);
                self.value(value);
            }
        }
    }

    /// Resolves a condition. An assignment in its place is refused as a whole, later.
    pub(super) fn test(&mut self, test: &'a Expr) {
        if !matches!(test.kind, ExprKind::Assign { .. }) {
            self.value(test);
        }
    }

    /// Resolves an assignment, `++` or `--`.
    pub(super) fn change(&mut self, expr: &'a Expr) {
        match &expr.kind {
            ExprKind::Assign { target, value, .. } | ExprKind::AssignLogical { target, value, .. } => {
                self.place(target);
                self.change(value);
            }
            ExprKind::Update { target, .. } => self.place(target),
            _ => self.value(expr),
        }
    }

    /// Resolves the target of an assignment.
    pub(in crate::bind) fn place(&mut self, target: &'a Expr) {
        match &target.kind {
            ExprKind::Name(name) => self.assigned(name, target.span),
            ExprKind::Member { .. } | ExprKind::Index { .. } => self.value(target),
            _ => {} // not a valid target: refused as a whole, later
        }
    }

    #[inline(never)]
    pub(super) fn call(&mut self, callee: &'a Expr, args: &'a [Expr]) {
        self.expr(callee, NameUse::Callee);
        let entry = self.entry(callee);
        let info = match (&entry, self.around.schema) {
            (Some(Entry::Function(id)), Some(schema)) => Some(schema.function(*id)),
            _ => None,
        };
        // The arguments of an aggregate are evaluated over a whole run, where the local names have no value.
        let hidden = match &info {
            Some(FunctionInfo { aggregate: true, .. }) => std::mem::take(&mut self.reach),
            _ => Vec::new(),
        };
        for (i, arg) in args.iter().enumerate() {
            let collection = match (&entry, info.as_ref().and_then(|info| info.params.get(i))) {
                (Some(Entry::Collection(id)), _) | (_, Some(Param::Name(id))) => Some(*id),
                _ => None,
            };
            if !self.lacks_quotes(collection, arg) {
                self.value(arg);
            }
        }
        if !hidden.is_empty() {
            self.reach = hidden;
        }
    }

    /// The entry of the host that a path of plain names denotes.
    pub(super) fn entry(&self, path: &Expr) -> Option<Entry> {
        let schema = self.around.schema?;
        match &path.kind {
            ExprKind::Name(name) if self.names.at(path.span.start) == NameMeaning::Outside => {
                schema.root(name)
            }
            ExprKind::Member { object, name, optional: false } => match self.entry(object)? {
                Entry::Object(id) => schema.member(id, &name.text),
                _ => None,
            },
            _ => None,
        }
    }

    /// Refuses the name of an object that is not in quotes.
    #[inline(never)]
    fn lacks_quotes(&mut self, collection: Option<CollectionId>, arg: &Expr) -> bool {
        let (Some(id), Some(schema), ExprKind::Name(word)) = (collection, self.around.schema, &arg.kind)
        else {
            return false;
        };
        if self.lookup(word).is_some() || !schema.names(id).contains(word) {
            return false;
        }
        self.names.uses.insert(arg.span.start, NameMeaning::Wrong);
        self.found.push(
            Finding::error(
                rules::COMPUTED_NAME,
                arg.span,
                format!("the name of a {} must be in quotes", schema.noun(id)),
            )
            .why("without quotes it is the name of a variable")
            .help(format!("write `'{word}'`"))
            .fix(arg.span, format!("'{word}'")),
        );
        true
    }

    /// The declaration to which a name refers here.
    pub(super) fn lookup(&self, name: &str) -> Option<usize> {
        let is = |byte: &usize| self.names.declared.get(byte).is_some_and(|d| d.name == name);
        self.reach.iter().rev().copied().find(is)
    }

    /// Resolves a name that is read.
    #[inline(never)]
    pub(super) fn name(&mut self, name: &'a str, span: Span, used: NameUse) {
        let meaning = match self.lookup(name) {
            Some(byte) => self.use_of(byte, span),
            None if self.is_outside(name) => return,
            None => {
                let report = self.unknown(name, span, used);
                self.found.push(report);
                NameMeaning::Wrong
            }
        };
        self.names.uses.insert(span.start, meaning);
    }

    /// Whether the language or the host defines a name.
    fn is_outside(&self, name: &str) -> bool {
        let Some(schema) = self.around.schema else { return true };
        match name {
            "value" => self.around.has_value || schema.root(name).is_some(),
            _ => is_language(name) || schema.root(name).is_some(),
        }
    }

    /// Resolves a name that is assigned.
    #[inline(never)]
    pub(super) fn assigned(&mut self, name: &'a str, span: Span) {
        let refusal = match self.lookup(name) {
            Some(byte) => {
                let meaning = self.use_of(byte, span);
                self.names.uses.insert(span.start, meaning);
                let Some(declared) = self.names.declared.get_mut(&byte) else { return };
                if meaning == NameMeaning::Wrong {
                    return;
                }
                if !declared.constant {
                    declared.assigned += 1;
                    return;
                }
                report_constant(name, span)
            }
            None if is_language(name) => report_not_assignable(name, span),
            None if self.is_outside(name) => return,
            None => self.undeclared(name, span),
        };
        self.found.push(refusal);
        self.names.uses.insert(span.start, NameMeaning::Wrong);
    }

    /// Records a use of a declaration: the functions between the use and the declaration capture the variable.
    fn use_of(&mut self, byte: usize, span: Span) -> NameMeaning {
        let function = self.function;
        let Some(declared) = self.names.declared.get_mut(&byte) else { return NameMeaning::Wrong };
        let home = declared.function;
        if !declared.ready {
            if home == function {
                self.found.push(report_too_early(&declared.name, span));
                return NameMeaning::Wrong;
            }
            // The function may run later, when the variable has a value.
            declared.early = true;
        }
        declared.captured |= home != function;
        let holds = declared.holds;
        self.take(byte, home);
        if let Some(inner) = holds {
            self.calls.insert((inner, function));
            self.visit(inner);
        }
        NameMeaning::Declared(byte)
    }

    /// Records that the functions from the current one up to `home` capture a variable.
    pub(super) fn take(&mut self, byte: usize, home: usize) {
        let mut function = self.function;
        while function != home {
            self.names.captured.entry(function).or_default().insert(byte);
            let Some(scope) = self.functions.get(&function) else { return };
            function = scope.around;
        }
    }

    /// Propagates captures to callers: a function that names another one captures what that one captures, except its own
    /// variables.
    fn propagate_captures(&mut self) {
        let mut changed = order::set(self.names.captured.keys().copied());
        while let Some(callee) = changed.pop_last() {
            let captured: Vec<usize> = self.names.captured(callee).collect();
            let callers = self.calls.range((callee, 0)..=(callee, usize::MAX));
            for &(_, caller) in callers {
                for &byte in &captured {
                    let home = self.names.declared.get(&byte).map_or(WHOLE, |d| d.function);
                    let mut function = caller;
                    while function != home && function != WHOLE {
                        if self.names.captured.entry(function).or_default().insert(byte) {
                            changed.insert(function);
                        }
                        function = self.functions.get(&function).map_or(WHOLE, |scope| scope.around);
                    }
                }
            }
        }
    }

    /// Registers a function that the text defines here.
    pub(super) fn define(&mut self, function: &'a Function) {
        if self.functions.len() >= MAX_FUNCTIONS && !std::mem::replace(&mut self.names.stopped, true) {
            self.found.push(
                Finding::error(
                    rules::TOO_LONG,
                    function.span,
                    format!("the text has more than {MAX_FUNCTIONS} functions"),
                )
                .help("split the text"),
            );
        }
        let scope =
            FunctionScope { function, around: self.function, reach: self.reach.len(), visited: false };
        self.functions.insert(function.span.start, scope);
    }

    /// Visits a function, at most once.
    #[inline(never)]
    pub(super) fn visit(&mut self, byte: usize) {
        if self.names.stopped {
            return;
        }
        let Some(scope) = self.functions.get_mut(&byte).filter(|scope| !scope.visited) else { return };
        scope.visited = true;
        let (function, reach) = (scope.function, scope.reach.min(self.reach.len()));
        if self.levels >= MAX_LEVELS {
            return self.too_deep(function.span);
        }
        // The body sees the names in scope at its definition, not those at its use.
        let hidden = self.reach.split_off(reach);
        let outer = std::mem::replace(&mut self.function, byte);
        self.levels += 1;
        for param in &function.params {
            self.parameter(&param.target, reach);
        }
        for param in &function.params {
            self.element(param);
        }
        match &function.body {
            Body::Value(expr) => self.change(expr),
            Body::Block(statements) => self.block(statements),
        }
        self.levels -= 1;
        self.function = outer;
        self.leave(reach);
        self.reach.extend(hidden);
    }

    pub(super) fn too_deep(&mut self, span: Span) {
        if !std::mem::replace(&mut self.names.stopped, true) {
            self.found.push(source::too_deep(span));
        }
    }

    /// Declares a name; its declaration has not been executed yet.
    pub(super) fn declare(&mut self, name: &Name, constant: bool, parameter: bool) {
        let byte = name.span.start;
        let declared = Declaration {
            name: name.text.clone(),
            constant,
            function: self.function,
            assigned: 0,
            captured: false,
            early: false,
            parameter,
            ready: false,
            holds: None,
        };
        self.names.declared.insert(byte, declared);
        self.reach.push(byte);
    }
}
