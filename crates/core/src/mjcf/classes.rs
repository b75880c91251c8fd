//! Default classes: the attributes that `<default class="…">` sets for an element, and the element's own attributes, which
//! override them.
//!
//! One rule applies to all: a class starts as a copy of its parent, and every attribute overrides the inherited value. A list
//! overrides number by number from the front, so that `friction="0.5"` keeps the other two coefficients of the class.

use crate::kinds::choice;
use crate::mjcf::gather::listed;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::ops::Range;
use std::rc::Rc;

use super::schema::{ALTERNATIVES, AttributeType};
use crate::mjcf::keyword_map::KeywordMap;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{Attribute, ElementNode, ElementTree};
use crate::mjcf::text::values::Value;

/// Limit for the number of classes. Each copies its parent.
const MAX_CLASSES: usize = 2000;

/// The effective attributes of an element: its own, and those of its class where it has none.
#[derive(Clone, Debug, Default)]
pub(crate) struct Props {
    values: KeywordMap<(Value, Range<usize>)>,
    /// The elements whose attributes these are.
    #[cfg(test)]
    elements: Vec<&'static super::schema::Element>,
}

impl Props {
    /// The attributes of the element itself, for elements without defaults.
    pub(crate) fn written_props(node: &ElementNode) -> Props {
        let mut props = Props::default();
        props.overlay(node);
        props
    }

    /// Overrides these attributes by those of an element. Names are not copied.
    pub(crate) fn overlay(&mut self, node: &ElementNode) {
        self.overlay_within(node, &CompletionBudget::default());
    }

    /// Like [`Props::overlay`], with a budget for lists that combine numbers of the element and of its class.
    fn overlay_within(&mut self, node: &ElementNode, budget: &CompletionBudget) {
        #[cfg(test)]
        self.elements.push(node.element);
        let is_name = |a: &&Attribute| matches!(a.attr.kind, AttributeType::Name(_) | AttributeType::Class);
        for a in node.attributes.iter().filter(|a| !is_name(a)) {
            if ALTERNATIVES.contains(&a.attr.name) {
                self.values.remove(&ALTERNATIVES);
            }
            let below = self.values.get(a.attr.name).map(|(v, _)| v);
            let value = match (below, &a.value) {
                (Some(Value::Reals(below)), Value::Reals(over)) if below.len() > over.len() => {
                    Value::Reals(budget.overlaid(below, over, a))
                }
                (_, over) => over.clone(),
            };
            self.values.insert(a.attr.name, (value, a.span.clone()));
        }
    }

    /// The value of an attribute.
    fn get(&self, name: &str) -> Option<&Value> {
        #[cfg(test)]
        self.elements.iter().for_each(|element| crate::mjcf::text::seen::note(element, name));
        self.values.get(name).map(|(value, _)| value)
    }

    /// Whether the attribute is present, valid or not.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// The span of the attribute's value, in the element or in a class.
    pub(crate) fn span(&self, name: &str) -> Option<Range<usize>> {
        self.values.get(name).map(|(_, span)| span.clone())
    }

    /// The given numbers of a list.
    pub(crate) fn list(&self, name: &str) -> Option<&[f64]> {
        match self.get(name) {
            Some(Value::Reals(list)) => Some(list.as_slice()),
            _ => None,
        }
    }

    /// A number.
    pub(crate) fn real(&self, name: &str) -> Option<f64> {
        self.list(name)?.first().copied()
    }

    /// `N` numbers. Missing ones are taken from `default`.
    pub(crate) fn reals<const N: usize>(&self, name: &str, default: [f64; N]) -> [f64; N] {
        let mut all = default;
        for (x, &given) in all.iter_mut().zip(self.list(name).unwrap_or(&[])) {
            *x = given;
        }
        all
    }

    /// An integer.
    pub(crate) fn int(&self, name: &str) -> Option<i32> {
        self.ints(name)?.first().copied()
    }

    /// The numbers of a list, shared with all elements that have the same list.
    pub(crate) fn shared(&self, name: &str) -> Rc<Vec<f64>> {
        match self.get(name) {
            Some(Value::Reals(list)) => list.clone(),
            _ => Rc::default(),
        }
    }

    /// Integers.
    pub(crate) fn ints(&self, name: &str) -> Option<&[i32]> {
        match self.get(name) {
            Some(Value::Ints(list)) => Some(list.as_slice()),
            _ => None,
        }
    }

    /// The number of a keyword in MuJoCo.
    pub(crate) fn keyword(&self, name: &str) -> Option<i32> {
        match self.get(name) {
            Some(Value::Keyword(n)) => Some(*n),
            _ => None,
        }
    }

    /// Whether a keyword among `false` and `true` is `true`. `default` if it is absent.
    pub(crate) fn flag(&self, name: &str, default: bool) -> bool {
        self.keyword(name).map_or(default, |word| word == choice::TRUE)
    }

    /// A text, or `None` if it is absent or empty.
    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        match self.get(name) {
            Some(Value::Text(text)) if !text.is_empty() => Some(text),
            _ => None,
        }
    }
}

/// Limit for the numbers that complete lists from defaults. Without it, a small text could request any amount.
const MAX_COMPLETED: usize = 10_000_000;

/// The numbers that were used to complete lists.
#[derive(Debug, Default)]
struct CompletionBudget {
    spent: Cell<usize>,
    /// The first list that exceeded the limit.
    exceeded: Cell<Option<usize>>,
}

impl CompletionBudget {
    /// The list `below`, with its first numbers replaced by `over`.
    fn overlaid(&self, below: &[f64], over: &Rc<Vec<f64>>, a: &Attribute) -> Rc<Vec<f64>> {
        // Short lists do not count.
        let spent = self.spent.get() + if below.len() > SHORT { below.len() } else { 0 };
        if spent > MAX_COMPLETED {
            self.exceeded.set(self.exceeded.get().or(Some(a.span.start)));
            return over.clone();
        }
        self.spent.set(spent);
        Rc::new(listed(over.iter().chain(below.iter().skip(over.len())).copied()))
    }
}

/// Lists of parameters are not longer than this.
const SHORT: usize = 20;

/// A class: its attributes for each kind of element, including those inherited from its parents.
#[derive(Debug, Default)]
struct Class {
    parent: usize,
    /// Shared with the classes that add no attributes.
    entries: KeywordMap<Rc<Props>>,
    /// The elements of the class itself, in the order of the text.
    nodes: Vec<usize>,
}

/// All default classes of a model.
#[derive(Debug)]
pub(crate) struct Classes {
    list: Vec<Class>,
    names: BTreeMap<String, usize>,
    main: usize,
    budget: CompletionBudget,
}

impl Classes {
    /// Reads all `default` sections.
    ///
    /// A further section at the top level continues the class `main`. Classes that are defined before keep what they copied from
    /// it, as in MuJoCo. An attached model has its own main class, under the renamed name of its section.
    pub(crate) fn read(tree: &ElementTree, report: &mut Diagnostics) -> Classes {
        let mut classes = Classes {
            list: vec![Class::default()],
            names: BTreeMap::new(),
            main: 0,
            budget: CompletionBudget::default(),
        };
        let mut of_node: Vec<Option<usize>> = vec![None; tree.nodes.len()];
        for (i, node) in tree.nodes.iter().enumerate().filter(|(_, n)| n.element.name == "default") {
            let nested_in = node.parent.and_then(|p| *of_node.get(p)?);
            let attached = nested_in.is_none() && node.model > 0;
            let parent = match (nested_in, attached) {
                (Some(class), _) => class,
                (None, false) => classes.main,
                (None, true) => node.text("class").and_then(|name| classes.find(name)).unwrap_or(0),
            };
            let mut entries =
                classes.list.get(parent).map_or_else(KeywordMap::default, |c| c.entries.clone());
            let mut nodes = Vec::new();
            for (child, entry) in tree.children(i).filter(|(_, e)| e.element.name != "default") {
                let props = Rc::make_mut(entries.or_default(entry.element.name));
                props.overlay_within(entry, &classes.budget);
                nodes.push(child);
            }
            let index = classes.list.len();
            if index > MAX_CLASSES {
                let message = format!("the model has more than {MAX_CLASSES} default classes");
                report.error(rules::LIMIT, node.span.clone(), message);
                break;
            }
            classes.list.push(Class { parent, entries, nodes });
            of_node[i] = Some(index);
            match (nested_in, node.text("class")) {
                (None, Some(name)) if attached => {
                    classes.names.insert(name.to_string(), index);
                }
                (None, _) => classes.main = index,
                (Some(_), Some(name)) => {
                    classes.names.entry(name.to_string()).or_insert(index);
                }
                (Some(_), None) => {}
            }
        }
        let main = classes.main;
        classes.names.insert("main".into(), main);
        classes
    }

    /// The index of a class, or `None` if there is no class of this name.
    pub(crate) fn find(&self, name: &str) -> Option<usize> {
        self.names.get(name).copied()
    }

    /// The names of all classes.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.names.keys().map(String::as_str)
    }

    /// The class of an element: its `class`, else the nearest `childclass` of the bodies around it, else `main`.
    pub(crate) fn class_of(&self, node: &ElementNode, childclass: Option<usize>) -> usize {
        let written_class = node.text("class").and_then(|name| self.find(name));
        written_class.or(childclass).unwrap_or(self.main)
    }

    /// All classes: the index of the parent, which precedes its children, and the elements of the class itself. The first class
    /// has no parent; its index is used instead.
    pub(crate) fn elements(&self) -> impl Iterator<Item = (usize, &[usize])> {
        self.list.iter().map(|c| (c.parent, c.nodes.as_slice()))
    }

    /// Reports the first list that exceeded the budget for completion by defaults.
    pub(crate) fn report_exceeded_budget(&self, report: &mut Diagnostics) {
        if let Some(offset) = self.budget.exceeded.get() {
            let message = format!("lists completed by defaults have more than {MAX_COMPLETED} numbers");
            report
                .error(rules::LIMIT, offset..offset, message)
                .why("each element would have its own long list")
                .help("write the lists out, or shorten the list of the default");
        }
    }

    /// The effective attributes of an element: its own, and those of its class where it has none.
    pub(crate) fn props(&self, node: &ElementNode, childclass: Option<usize>) -> Props {
        self.props_of(node.element.name, node, childclass)
    }

    /// Like [`Classes::props`], for an element whose defaults have another name: all tendons share `tendon`.
    pub(crate) fn props_of(&self, entry: &str, node: &ElementNode, childclass: Option<usize>) -> Props {
        let entry = self.list.get(self.class_of(node, childclass)).and_then(|c| c.entries.get(entry));
        let mut props = entry.map_or_else(Props::default, |p| Props::clone(p));
        props.overlay_within(node, &self.budget);
        props
    }
}
