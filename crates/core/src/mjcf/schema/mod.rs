//! The schema of MJCF: every element in every position, with every attribute, as in MuJoCo 3.14.0.
//!
//! One table determines which elements and attributes are read, which are accepted and ignored, and which are refused by name.
//! The checks of `tree.rs`, the suggestions for misspelt names and the compatibility page are generated from it. Names are those
//! of MuJoCo's XML reference; a test compares them with the list that the library prints.

mod actuators;
mod body;
mod custom;
mod default;
mod equalities;
mod extension;
mod flexible;
mod key;
mod option;
mod pairs;
mod sensor;
mod tendon;
mod visual;

/// What the compiler does with an element or an attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Read, with the same meaning as in MuJoCo.
    Supported,
    /// Accepted without effect on any computed number. The text states its purpose.
    Ignored(&'static str),
    /// Accepted with this value only, which is MuJoCo's default.
    Only(&'static str),
    /// Refused as not supported yet.
    Unsupported,
}

/// A keyword of an attribute.
#[derive(Debug)]
pub struct Keyword {
    /// The keyword.
    pub text: &'static str,
    /// The number of the keyword in MuJoCo.
    pub value: i32,
    /// `false` if MuJoCo has the keyword and labspec refuses it as not supported yet.
    pub supported: bool,
}

/// The type of an attribute's value.
#[derive(Clone, Copy, Debug)]
pub enum AttributeType {
    /// Between `min` and `max` real numbers.
    Reals(usize, usize),
    /// Between `min` and `max` integers.
    Ints(usize, usize),
    /// One of these keywords.
    Keywords(&'static [Keyword]),
    /// The name of the object itself, unique among objects of this kind.
    Name(&'static str),
    /// The name of another object, of this kind.
    Ref(&'static str),
    /// The name of a defaults class.
    Class,
    /// Free text.
    Text,
}

impl AttributeType {
    /// Whether the value consists of numbers, at least one.
    pub(crate) fn counts(self) -> bool {
        matches!(self, AttributeType::Reals(1.., _) | AttributeType::Ints(1.., _))
    }
}

impl AttributeType {
    /// The type in words, for documentation and messages.
    pub fn describe(self) -> String {
        let count = |min: usize, max: usize, noun: &str| match (min, max) {
            (1, 1) => format!("one {noun}"),
            (_, usize::MAX) => format!("{noun}s"),
            (a, b) if a == b => format!("{a} {noun}s"),
            (a, b) => format!("{a} to {b} {noun}s"),
        };
        match self {
            AttributeType::Reals(min, max) => count(min, max, "number"),
            AttributeType::Ints(min, max) => count(min, max, "integer"),
            AttributeType::Keywords(words) => {
                let list: Vec<_> = listed(words.iter().map(|w| w.text));
                format!("one of {}", list.join(", "))
            }
            AttributeType::Name(_) => "a name".into(),
            AttributeType::Ref(kind) => format!("the name of a {kind}"),
            AttributeType::Class => "the name of a default class".into(),
            AttributeType::Text => "text".into(),
        }
    }
}

/// An attribute.
#[derive(Debug)]
pub struct Attr {
    /// Its name.
    pub name: &'static str,
    /// The type of its value.
    pub kind: AttributeType,
    /// What the compiler does with it.
    pub status: Status,
}

/// An element in one position of the tree.
#[derive(Debug)]
pub struct Element {
    /// Its name.
    pub name: &'static str,
    /// What the compiler does with it.
    pub status: Status,
    /// Whether it may occur only once in its parent.
    pub once: bool,
    /// Its attributes, in groups that are shared between elements.
    pub attributes: &'static [&'static [Attr]],
    /// The elements that it may contain.
    pub children: &'static [&'static Element],
}

impl Element {
    const fn new(name: &'static str, attributes: &'static [&'static [Attr]]) -> Element {
        Element { name, status: Status::Supported, once: false, attributes, children: &[] }
    }

    const fn children(self, children: &'static [&'static Element]) -> Element {
        Element { children, ..self }
    }

    const fn once(self) -> Element {
        Element { once: true, ..self }
    }

    const fn status(self, status: Status) -> Element {
        Element { status, ..self }
    }

    const fn refused(self) -> Element {
        self.status(Status::Unsupported)
    }

    /// The attribute of this name.
    pub fn attribute(&self, name: &str) -> Option<&'static Attr> {
        self.attributes().find(|a| a.name == name)
    }

    /// All attributes.
    pub fn attributes(&self) -> impl Iterator<Item = &'static Attr> + use<> {
        self.attributes.iter().copied().flatten()
    }

    /// The names of the child elements.
    pub fn child_names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.children.iter().map(|c| c.name)
    }

    /// The child element of this name.
    pub fn child(&self, name: &str) -> Option<&'static Element> {
        self.children.iter().copied().find(|c| c.name == name)
    }
}

/// Attributes, one line for each type: `KIND => names [status];`.
macro_rules! attributes {
    (@ [$($rows:tt)*]) => { &[$($rows)*] };
    (@ [$($rows:tt)*] $kind:expr => $($name:ident)+; $($rest:tt)*) => {
        $crate::mjcf::schema::attributes!(@ [$($rows)* $(
            $crate::mjcf::schema::Attr {
                name: stringify!($name),
                kind: $kind,
                status: $crate::mjcf::schema::Status::Supported,
            },
        )+] $($rest)*)
    };
    (@ [$($rows:tt)*] $kind:expr => $($name:ident)+ [$status:expr]; $($rest:tt)*) => {
        $crate::mjcf::schema::attributes!(@ [$($rows)* $(
            $crate::mjcf::schema::Attr { name: stringify!($name), kind: $kind, status: $status },
        )+] $($rest)*)
    };
    ($($rows:tt)*) => { $crate::mjcf::schema::attributes!(@ [] $($rows)*) };
}
use crate::kinds::choice;
use crate::mjcf::gather::listed;
use attributes;

const REAL: AttributeType = AttributeType::Reals(1, 1);
const INT: AttributeType = AttributeType::Ints(1, 1);
const TEXT: AttributeType = AttributeType::Text;
const FLAG: AttributeType =
    AttributeType::Keywords(&[keyword("false", choice::FALSE), keyword("true", choice::TRUE)]);
const AUTO: AttributeType = AttributeType::Keywords(&[
    keyword("false", choice::FALSE),
    keyword("true", choice::TRUE),
    keyword("auto", choice::AUTO),
]);

/// Exactly `n` numbers.
const fn reals(n: usize) -> AttributeType {
    AttributeType::Reals(n, n)
}
/// One to `n` numbers. Missing ones have their defaults.
const fn upto(n: usize) -> AttributeType {
    AttributeType::Reals(1, n)
}
/// As many numbers as the model requires.
const LIST: AttributeType = AttributeType::Reals(0, usize::MAX);
/// Any number of integers.
const INTS: AttributeType = AttributeType::Ints(0, usize::MAX);

const fn keyword(text: &'static str, value: i32) -> Keyword {
    Keyword { text, value, supported: true }
}
const fn unsupported_keyword(text: &'static str, value: i32) -> Keyword {
    Keyword { text, value, supported: false }
}

/// Attributes and elements that affect rendering only.
const APPEARANCE: Status = Status::Ignored("appearance");
/// Attributes that have an effect only together with elements that are refused.
const MOOT: Status = Status::Ignored("acts only with elements that are themselves refused");
const USER: Status = Status::Ignored("data for programs; the engine does not read it");

/// The five forms of an orientation.
const ORIENTATION: &[Attr] = attributes! {
    reals(4) => quat axisangle;
    reals(3) => euler zaxis;
    reals(6) => xyaxes;
};

pub(crate) use body::{BODY, FRAME};
pub(crate) use extension::INCLUDE;

/// The root of the table: the element `mujoco`.
pub(crate) static ROOT: Element = Element::new("mujoco", &[attributes! { TEXT => model; }]).children(&[
    &option::COMPILER,
    &option::OPTION,
    &option::SIZE,
    &option::STATISTIC,
    &visual::VISUAL,
    &visual::ASSET,
    &default::DEFAULT,
    &body::WORLDBODY,
    &extension::EXTENSION,
    &custom::CUSTOM,
    &pairs::CONTACT,
    &flexible::DEFORMABLE,
    &equalities::EQUALITY,
    &tendon::TENDON,
    &actuators::ACTUATOR,
    &sensor::SENSOR,
    &key::KEYFRAME,
    &INCLUDE,
]);

/// The root of the schema: the element `mujoco`, with everything that it may contain.
pub fn schema_root() -> &'static Element {
    &ROOT
}

/// A row of the compatibility table.
#[derive(Clone, Debug)]
pub struct SchemaRow {
    /// Elements from the root to this one, joined by `/`.
    pub path: String,
    /// The attribute; `None` for the row of the element itself.
    pub attribute: Option<&'static Attr>,
    /// What the compiler does with it.
    pub status: Status,
}

/// The whole schema as rows, in the order of the table, elements before their attributes. An element that may contain itself
/// (`body`, `default`, `frame`) is listed once.
pub fn schema_rows() -> Vec<SchemaRow> {
    let mut rows = Vec::new();
    let mut stack = vec![(String::new(), &ROOT, false)];
    while let Some((parent, element, refused)) = stack.pop() {
        // The children of a refused element are refused.
        let element_status = if refused { Status::Unsupported } else { element.status };
        let path =
            if parent.is_empty() { element.name.to_string() } else { format!("{parent}/{}", element.name) };
        rows.push(SchemaRow { path: path.clone(), attribute: None, status: element_status });
        rows.extend(element.attributes().map(|a| SchemaRow {
            path: path.clone(),
            attribute: Some(a),
            status: if element_status == Status::Supported { a.status } else { element_status },
        }));
        for child in element.children.iter().rev() {
            if !path.split('/').any(|name| name == child.name) {
                stack.push((path.clone(), child, element_status == Status::Unsupported));
            }
        }
    }
    rows
}

/// The names of all possible parents of an element. Refused parents are returned only if there is no other. `body` represents
/// the elements that have the same children.
pub(crate) fn parents_of(name: &str) -> Vec<&'static str> {
    let mut parents: [Vec<&'static str>; 2] = Default::default();
    let mut seen: Vec<&'static Element> = vec![&ROOT];
    let mut next = 0;
    while let Some(&element) = seen.get(next) {
        next += 1;
        if let Some(child) = element.child(name) {
            let refused = [element.status, child.status].contains(&Status::Unsupported);
            let [open, closed] = &mut parents;
            let list = if refused { closed } else { open };
            let as_body = matches!(element.name, "frame" | "replicate");
            if !list.contains(&element.name) && !as_body {
                list.push(element.name);
            }
        }
        for child in element.children {
            if !seen.iter().any(|s| std::ptr::eq(*s, *child)) {
                seen.push(child);
            }
        }
    }
    let [open, closed] = parents;
    if open.is_empty() { closed } else { open }
}

/// The attributes that give an orientation and override a quaternion. They exclude each other.
pub(crate) const ALTERNATIVES: [&str; 4] = ["euler", "axisangle", "xyaxes", "zaxis"];

/// Whether an attribute gives an orientation.
pub(crate) fn is_form(name: &str) -> bool {
    name == "quat" || ALTERNATIVES.contains(&name) || name == "fullinertia"
}
