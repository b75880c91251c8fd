//! The format of labs, quizzes and checks, declared as data: all objects with their keys, and for each key the type, the
//! default, a description and an example.
//!
//! The readers take the keys, the required keys, the defaults and the limits from this declaration. The reference page, the
//! JSON Schemas and the completions are generated from it. A key that is not declared does not exist.

mod complete;
#[cfg(test)]
mod complete_tests;
mod control;
mod describe;
mod in_lesson;
mod integrators;
mod lab;
mod lint;
mod page;
mod plot;
mod quiz;
mod scan;
mod schema;
#[cfg(test)]
mod tests;
mod verify;

pub use complete::{Completion, RequestedNames, completions};
pub use control::{BUTTON, CONTROL, SELECT, SLIDER};
pub use in_lesson::completions_in;
pub use integrators::{INTEGRATOR_NAMES, INTEGRATORS};
pub use lab::{CAMERA, EVENTS, LAB, OVERLAYS};
pub use lint::LINT;
pub use page::page;
pub use plot::{MAX_DIGITS, PLOT, READOUT, REF_LINE, TRACE};
pub use quiz::{
    CODE, DEBUG, HASH, MCQ, MULTIPLE, NUMERIC, OPEN, PREDICT, QUESTION, QUIZ, TOLERANCE, TRUEFALSE,
};
pub use schema::{Root, schema};
pub use verify::{CLOSED_FORM, COLUMN, FILE_VALUES, FIND, LISTING, RUN, RUN_LENGTH, SPAN, VERIFY};

use super::CodeForm;
use labspec_finding::docs;

/// An object of the format.
#[derive(Debug)]
pub struct Object {
    /// Its name: `slider`.
    pub name: &'static str,
    /// The name with an article, for sentences: `a slider`.
    pub what: &'static str,
    /// Its purpose, in one or two sentences.
    pub doc: &'static str,
    /// For an object of a family: the key that selects it, and the value of this key.
    pub tag: Option<(&'static str, &'static str)>,
    /// The smallest complete object, as JSON.
    pub minimal: &'static str,
    /// The keys, in reading order.
    pub keys: &'static [Key],
    /// Rules for combinations of its keys.
    pub key_rules: &'static [KeyRule],
}

/// A rule for a combination of keys.
#[derive(Clone, Copy, Debug)]
pub enum KeyRule {
    /// Exactly one of these must be present.
    ExactlyOne(&'static [&'static str]),
    /// At least one of these must be present.
    AtLeastOne(&'static [&'static str]),
    /// Without any of these, the object has no use; this is a warning.
    OneAdvised(&'static [&'static str]),
    /// These two exclude each other.
    AtMostOne(&'static [&'static str; 2]),
    /// If both are present, the second one has no effect; this is a warning.
    FirstCounts(&'static [&'static str; 2]),
}

/// Alternative objects, and the key that selects one of them.
#[derive(Debug)]
pub struct Family {
    /// Its name: `control`.
    pub name: &'static str,
    /// The name with an article: `a control`.
    pub what: &'static str,
    /// What its objects have in common.
    pub doc: &'static str,
    /// The key that selects the object.
    pub key: &'static str,
    /// The words that this key accepts.
    pub words: &'static [Word],
    /// The objects. If the key is absent, it is the first one.
    pub objects: &'static [&'static Object],
}

/// A key of an object.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// The type of its value.
    pub ty: Type,
    /// The unit of its number; empty if it has none.
    pub unit: &'static str,
    /// Whether it is required.
    pub need: Need,
    /// The default.
    pub absent: Absent,
    /// The allowed range of its number, or of each number of its list.
    pub limits: Limits,
    /// The smallest allowed number of items in its list.
    pub items: usize,
    /// Description.
    pub doc: &'static str,
    /// A possible value, as JSON.
    pub example: &'static str,
    /// The first version of this package that supports it.
    pub since: &'static str,
}

/// The type of the value of a key.
#[derive(Clone, Copy, Debug)]
pub enum Type {
    /// Text, displayed unchanged.
    Text,
    /// The name of an element of the models.
    Name(Named),
    /// Text that can contain HTML.
    Html,
    /// Code in the language of the lab.
    Code(CodeForm),
    /// A number.
    Number,
    /// An integer.
    Whole,
    /// `true` or `false`.
    Flag,
    /// `null`, for a place in a list that is left empty.
    Null,
    /// A number, a text, or a boolean.
    Scalar,
    /// One of these words.
    Words(&'static [Word]),
    /// A list of items of one type.
    List(&'static Type),
    /// A list with exactly this number of numbers.
    Numbers(usize),
    /// A list of two values, with the type of each.
    Pair(&'static [PairHalf; 2]),
    /// An object whose keys are names chosen by the author.
    Map(&'static Map),
    /// An object whose keys are some of these words, each with a boolean.
    Switches(&'static [Word]),
    /// An object of the format.
    Object(&'static Object),
    /// One object of a family.
    OneOf(&'static Family),
    /// One of two types.
    Either(&'static Type, &'static Type),
}

/// What a name refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Named {
    /// A model in the model folder.
    Model,
    /// A site of the model of the lab.
    Site,
}

/// A word that a key accepts, with its description.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// The word.
    pub text: &'static str,
    /// Description.
    pub doc: &'static str,
}

/// One element of a pair.
#[derive(Debug)]
pub struct PairHalf {
    /// Its meaning: `the label of a button`.
    pub what: &'static str,
    /// Its type.
    pub ty: Type,
}

/// An object with free names.
#[derive(Debug)]
pub struct Map {
    /// What its keys are: `the label of a trace`.
    pub names: &'static str,
    /// The type of its values.
    pub ty: Type,
}

/// Whether a key is required.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// It is optional.
    Optional,
    /// Its absence is a warning, for this reason.
    Advised(&'static str),
    /// Its absence is an error, for this reason.
    Must(&'static str),
}

/// The default of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Absent {
    /// No default.
    Nothing,
    /// This number.
    Number(f64),
    /// This text.
    Text(&'static str),
    /// `false`
    False,
    /// These numbers.
    Numbers(&'static [f64]),
    /// An empty list, or an empty object.
    Empty,
    /// A default that depends on other values, described in words.
    Described(&'static str),
}

/// The allowed range of a number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// The exclusive lower limit.
    pub above: Option<f64>,
    /// The inclusive lower limit.
    pub least: Option<f64>,
    /// The inclusive upper limit.
    pub most: Option<f64>,
}

impl Limits {
    /// Whether a number is within the limits.
    pub fn allow(&self, x: f64) -> bool {
        self.above.is_none_or(|a| x > a)
            && self.least.is_none_or(|l| x >= l)
            && self.most.is_none_or(|m| x <= m)
    }
}

/// The first version of the format.
const FIRST: &str = "0.1";

/// An optional key.
const fn key(name: &'static str, ty: Type, doc: &'static str, example: &'static str) -> Key {
    Key {
        name,
        ty,
        unit: "",
        need: Need::Optional,
        absent: match ty {
            Type::Flag => Absent::False,
            _ => Absent::Nothing,
        },
        limits: Limits { above: None, least: None, most: None },
        items: 0,
        doc: docs(doc),
        example: docs(example),
        since: FIRST,
    }
}

impl Key {
    const fn unit(self, unit: &'static str) -> Key {
        Key { unit, ..self }
    }

    const fn must(self, why: &'static str) -> Key {
        Key { need: Need::Must(why), ..self }
    }

    const fn advised(self, why: &'static str) -> Key {
        Key { need: Need::Advised(why), ..self }
    }

    /// Sets the default.
    const fn or(self, absent: Absent) -> Key {
        Key { absent, ..self }
    }

    const fn positive(self) -> Key {
        Key { limits: Limits { above: Some(0.0), least: None, most: None }, ..self }
    }

    const fn at_least(self, least: f64) -> Key {
        Key { limits: Limits { above: None, least: Some(least), most: None }, ..self }
    }

    const fn between(self, least: f64, most: f64) -> Key {
        Key { limits: Limits { above: None, least: Some(least), most: Some(most) }, ..self }
    }

    const fn items(self, items: usize) -> Key {
        Key { items, ..self }
    }
}

/// All objects, in the order of the reference page.
pub static OBJECTS: [&Object; 29] = [
    &LAB,
    &INTEGRATORS,
    &CAMERA,
    &SLIDER,
    &SELECT,
    &BUTTON,
    &PLOT,
    &TRACE,
    &REF_LINE,
    &READOUT,
    &QUIZ,
    &MCQ,
    &DEBUG,
    &PREDICT,
    &MULTIPLE,
    &TRUEFALSE,
    &NUMERIC,
    &OPEN,
    &CODE,
    &HASH,
    &LINT,
    &VERIFY,
    &RUN,
    &SPAN,
    &FILE_VALUES,
    &LISTING,
    &FIND,
    &COLUMN,
    &CLOSED_FORM,
];

impl Object {
    /// The key with this name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|k| k.name == name)
    }

    /// The numeric default of this key. NaN if the declaration has none; a test excludes this.
    pub(crate) fn number(&self, name: &str) -> f64 {
        match self.key(name).map(|k| k.absent) {
            Some(Absent::Number(x)) => x,
            _ => f64::NAN,
        }
    }

    /// The default of this key, as a list of numbers.
    pub(crate) fn numbers(&self, name: &str) -> &'static [f64] {
        match self.key(name).map(|k| k.absent) {
            Some(Absent::Numbers(all)) => all,
            _ => &[],
        }
    }

    /// The default of this key, as a text.
    pub(crate) fn text(&self, name: &str) -> &'static str {
        match self.key(name).map(|k| k.absent) {
            Some(Absent::Text(text)) => text,
            _ => "",
        }
    }

    /// Whether this number is allowed as the value of a key.
    pub(crate) fn allows(&self, name: &str, x: f64) -> bool {
        self.key(name).is_none_or(|k| k.limits.allow(x))
    }
}

impl Family {
    /// The object that a word selects; without a word the first one.
    pub fn object(&self, word: Option<&str>) -> Option<&'static Object> {
        let has_tag = |o: &&&'static Object| o.tag.is_some_and(|(_, w)| Some(w) == word);
        match word {
            None => self.objects.first().copied(),
            Some(_) => self.objects.iter().find(has_tag).copied(),
        }
    }

    /// The keys of all its objects, without duplicates.
    pub fn keys(&self) -> Vec<&'static Key> {
        let mut all: Vec<&'static Key> = Vec::new();
        for key in self.objects.iter().flat_map(|o| o.keys) {
            if !all.iter().any(|k| k.name == key.name) {
                all.push(key);
            }
        }
        all
    }
}

/// The texts of the words.
pub(crate) fn texts(words: &'static [Word]) -> impl Iterator<Item = &'static str> + Clone {
    words.iter().map(|w| w.text)
}
