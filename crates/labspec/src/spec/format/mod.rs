//! The format of labs, quizzes and checks, declared once as data: every object, and of every key what it takes, what
//! counts without it, what it means, and an example.
//!
//! The readers know keys, missing ones, defaults and limits from here. The reference page, the JSON Schemas and the
//! completions are written from here. A key that is not declared does not exist.

mod complete;
#[cfg(test)]
mod complete_tests;
mod control;
mod describe;
mod in_lesson;
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

pub use complete::{Asked, Completion, completions};
pub use control::{BUTTON, CONTROL, SELECT, SLIDER};
pub use in_lesson::completions_in;
pub use lab::{CAMERA, EVENTS, LAB, OVERLAYS};
pub use lint::LINT;
pub use page::page;
pub use plot::{MAX_DIGITS, PLOT, READOUT, REF_LINE, TRACE};
pub use quiz::{CODE, DEBUG, MCQ, NUMERIC, OPEN, PREDICT, QUESTION, QUIZ, TOLERANCE};
pub use schema::{Root, schema};
pub use verify::{CLOSED_FORM, COLUMN, FIND, RUN, RUN_LENGTH, SPAN, VERIFY};

use super::Form;
use labspec_finding::docs;

/// An object of the format.
#[derive(Debug)]
pub struct Object {
    /// Its name among the objects: `slider`.
    pub name: &'static str,
    /// The same with an article, for sentences: `a slider`.
    pub what: &'static str,
    /// What it is for, in a sentence or two.
    pub doc: &'static str,
    /// Where it is one of a family: the key that tells it, and the word that stands there.
    pub tag: Option<(&'static str, &'static str)>,
    /// The smallest one that is whole, as JSON.
    pub minimal: &'static str,
    /// Its keys, in the order in which people read them.
    pub keys: &'static [Key],
    /// What some of its keys ask of others.
    pub together: &'static [Together],
}

/// What some keys of an object ask of each other.
#[derive(Clone, Copy, Debug)]
pub enum Together {
    /// One of these must stand, and no more than one.
    ExactlyOne(&'static [&'static str]),
    /// One of these must stand, or several.
    AtLeastOne(&'static [&'static str]),
    /// Without any of these the object is of no use, which is a warning.
    OneAdvised(&'static [&'static str]),
    /// These two exclude each other.
    AtMostOne(&'static [&'static str; 2]),
    /// Where both of these stand, the second one does nothing, which is a warning.
    FirstCounts(&'static [&'static str; 2]),
}

/// Objects that may stand in the same place, and the key that tells which one stands there.
#[derive(Debug)]
pub struct Family {
    /// Its name: `control`.
    pub name: &'static str,
    /// The same with an article: `a control`.
    pub what: &'static str,
    /// What its objects have in common.
    pub doc: &'static str,
    /// The key that tells them apart.
    pub key: &'static str,
    /// The words that it takes.
    pub words: &'static [Word],
    /// The objects. Where the key is left out, the first one is meant.
    pub objects: &'static [&'static Object],
}

/// A key of an object.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// What it takes.
    pub of: Type,
    /// The unit of its number; empty where it has none.
    pub unit: &'static str,
    /// Whether it must stand.
    pub need: Need,
    /// What counts where it is left out.
    pub absent: Absent,
    /// What its number, or each number of its list, may be.
    pub limits: Limits,
    /// The fewest items of its list.
    pub items: usize,
    /// What it means.
    pub doc: &'static str,
    /// A value that it can take, as JSON.
    pub example: &'static str,
    /// The first version of this package that knows it.
    pub since: &'static str,
}

/// What a key takes.
#[derive(Clone, Copy, Debug)]
pub enum Type {
    /// Text, shown as it is.
    Text,
    /// The name of something that the models have.
    Name(Named),
    /// Text that may hold HTML.
    Html,
    /// Code of the lab's language.
    Code(Form),
    /// A number.
    Number,
    /// A number without decimals.
    Whole,
    /// `true` or `false`.
    Flag,
    /// A number, a text, `true` or `false`.
    Scalar,
    /// One of these words.
    Words(&'static [Word]),
    /// A list of items of one type.
    List(&'static Type),
    /// A list of exactly so many numbers.
    Numbers(usize),
    /// A list of two: what comes first, and what comes second.
    Pair(&'static [PairHalf; 2]),
    /// An object whose keys are names that the author chooses.
    Map(&'static Map),
    /// An object whose keys are some of these words, each with `true` or `false`.
    Switches(&'static [Word]),
    /// An object of the format.
    Object(&'static Object),
    /// One object of a family.
    OneOf(&'static Family),
    /// One or the other.
    Either(&'static Type, &'static Type),
}

/// What a name is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Named {
    /// A model of the folder of models.
    Model,
    /// A site of the lab's own model.
    Site,
}

/// A word that a key takes, and what it means.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// The word.
    pub text: &'static str,
    /// What it means.
    pub doc: &'static str,
}

/// One half of a pair.
#[derive(Debug)]
pub struct PairHalf {
    /// What it is: `the label of a button`.
    pub what: &'static str,
    /// What it takes.
    pub of: Type,
}

/// An object of names.
#[derive(Debug)]
pub struct Map {
    /// What its keys are: `the label of a trace`.
    pub names: &'static str,
    /// What each of them takes.
    pub of: Type,
}

/// Whether a key must stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// It may be left out.
    Optional,
    /// Leaving it out is a warning, for this reason.
    Advised(&'static str),
    /// Leaving it out is an error, for this reason.
    Must(&'static str),
}

/// What counts where a key is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Absent {
    /// Nothing.
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
    /// Something that depends on the rest, in words.
    Said(&'static str),
}

/// What a number may be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// It must be greater than this.
    pub above: Option<f64>,
    /// It must be at least this.
    pub least: Option<f64>,
    /// It must be at most this.
    pub most: Option<f64>,
}

impl Limits {
    /// Whether a number keeps to them.
    pub fn allow(&self, x: f64) -> bool {
        self.above.is_none_or(|a| x > a)
            && self.least.is_none_or(|l| x >= l)
            && self.most.is_none_or(|m| x <= m)
    }
}

/// The version with which the format began.
const FIRST: &str = "0.1";

/// A key that may be left out.
const fn key(name: &'static str, of: Type, doc: &'static str, example: &'static str) -> Key {
    Key {
        name,
        of,
        unit: "",
        need: Need::Optional,
        absent: match of {
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

    /// What counts without it.
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

/// Every object, in the order of the reference page.
pub static OBJECTS: [&Object; 23] = [
    &LAB,
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
    &NUMERIC,
    &OPEN,
    &CODE,
    &LINT,
    &VERIFY,
    &RUN,
    &SPAN,
    &FIND,
    &COLUMN,
    &CLOSED_FORM,
];

impl Object {
    /// The key of this name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|k| k.name == name)
    }

    /// The number that counts where this key is left out. NaN when the declaration has none, which a test rules out.
    pub(crate) fn number(&self, name: &str) -> f64 {
        match self.key(name).map(|k| k.absent) {
            Some(Absent::Number(x)) => x,
            _ => f64::NAN,
        }
    }

    /// The numbers that count where this key is left out.
    pub(crate) fn numbers(&self, name: &str) -> &'static [f64] {
        match self.key(name).map(|k| k.absent) {
            Some(Absent::Numbers(all)) => all,
            _ => &[],
        }
    }

    /// The text that counts where this key is left out.
    pub(crate) fn text(&self, name: &str) -> &'static str {
        match self.key(name).map(|k| k.absent) {
            Some(Absent::Text(text)) => text,
            _ => "",
        }
    }

    /// Whether this number may stand at a key.
    pub(crate) fn allows(&self, name: &str, x: f64) -> bool {
        self.key(name).is_none_or(|k| k.limits.allow(x))
    }
}

impl Family {
    /// The object that a word tells; without a word the first one.
    pub fn object(&self, word: Option<&str>) -> Option<&'static Object> {
        let has_tag = |o: &&&'static Object| o.tag.is_some_and(|(_, w)| Some(w) == word);
        match word {
            None => self.objects.first().copied(),
            Some(_) => self.objects.iter().find(has_tag).copied(),
        }
    }

    /// The keys of all its objects, each name once.
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

/// The texts of words.
pub(crate) fn texts(words: &'static [Word]) -> impl Iterator<Item = &'static str> + Clone {
    words.iter().map(|w| w.text)
}
