//! Completions in a lab or a quiz: the keys that are still missing, or the words that a key accepts.

use super::describe::{default, takes};
use super::scan::{CursorSpot, JsonScan, JsonScope, ScanStep, scan};
use super::{Family, INTEGRATORS, Key, KeyRule, LAB, Named, Object, QUIZ, Type, Word};
use crate::json::encode;
use std::borrow::Cow;
use std::ops::Range;

/// A completion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// The key or the word, without quotes.
    pub text: Cow<'static, str>,
    /// Whether it is a key of an object; otherwise it is a value.
    pub is_key: bool,
    /// The byte range to replace: the text that is already written, quotes included.
    pub replace: Range<usize>,
    /// The replacement text: JSON; for a key with a colon, unless one follows already.
    pub insert: String,
    /// Description.
    pub doc: &'static str,
    /// The type of the key, in words.
    pub takes: String,
    /// The default of the key, as JSON.
    pub default: Option<String>,
    /// Whether the object is invalid without this key.
    pub required: bool,
}

/// The names that a completion needs and only the models provide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RequestedNames<'a> {
    /// The names of all models.
    Models,
    /// The sites of the model with this name.
    SitesOf(&'a str),
    /// The sites of a model given as XML in the lab.
    SitesIn(&'a str),
}

/// Completions at a byte offset in the JSON of a lab or a quiz, or of a list of them, in the order of the reference page.
/// The text can be incomplete or malformed. The completions start with what is already written; if none does, all are
/// returned. Code and free text have no completions.
///
/// `names` provides the names: `&|asked| models.names(asked)` with [`crate::bind::scene::Models`], or `&|_| Vec::new()` if
/// no models are available.
pub fn completions(
    text: &str,
    offset: usize,
    names: &dyn Fn(RequestedNames<'_>) -> Vec<String>,
) -> Vec<Completion> {
    completions_of(None, text, offset, names)
}

/// As [`completions`], for JSON with a known kind of root object.
pub(super) fn completions_of(
    whole: Option<&'static Object>,
    text: &str,
    offset: usize,
    names: &dyn Fn(RequestedNames<'_>) -> Vec<String>,
) -> Vec<Completion> {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    let found = scan(text, offset);
    let Some(spot) = &found.spot else { return Vec::new() };
    let Some(scope) = found.scopes.get(spot.scope) else { return Vec::new() };
    let holder = holder(whole, &found, spot.scope);
    let colon = text.get(spot.written.end..).is_some_and(|t| t.trim_start().starts_with(':'));
    let all = match &spot.value {
        None => keys(&holder, scope, spot, colon),
        Some(step) => {
            let key = match (&holder, step) {
                (Holder::Keys(keys), ScanStep::Key(name)) => keys.iter().find(|k| k.name == name).copied(),
                _ => None,
            };
            match inside(&holder, step) {
                Some(Type::Name(named)) => complete_key(key, ask(named, scope, names), spot),
                ty => values(key, ty, scope, spot),
            }
        }
    };
    let written = text.get(spot.written.start..offset).unwrap_or("").trim_start_matches('"').to_lowercase();
    let begins = |c: &Completion| c.text.to_lowercase().starts_with(&written);
    match all.iter().any(begins) {
        true => all.into_iter().filter(begins).collect(),
        false => all,
    }
}

/// The declared type of an object or a list.
enum Holder {
    /// An object with these possible keys.
    Keys(Vec<&'static Key>),
    /// An object with free names, or a list, of this type.
    Of(Type),
    /// Not declared.
    Unknown,
}

fn holder(whole: Option<&'static Object>, found: &JsonScan, index: usize) -> Holder {
    // From the innermost object or list to the outermost.
    let mut ancestors = vec![index];
    while let Some((parent, _)) = ancestors.last().and_then(|&i| found.scopes.get(i)?.parent.as_ref()) {
        ancestors.push(*parent);
    }
    let mut holder = Holder::Unknown;
    for (depth, scope) in ancestors.iter().rev().filter_map(|&i| found.scopes.get(i)).enumerate() {
        let outer_list = depth == 1 && matches!(holder, Holder::Unknown);
        holder = match &scope.parent {
            None if scope.list => Holder::Unknown,
            None => whole.map_or_else(|| root(scope), |object| Holder::Keys(allowed(&[object], scope))),
            Some((_, ScanStep::Item(_))) if outer_list && !scope.list => root(scope),
            Some((_, step)) => match inside(&holder, step) {
                Some(ty) => of_type(ty, scope),
                None => Holder::Unknown,
            },
        };
    }
    holder
}

/// The root object of a text: a quiz or a lab, or either of them if its keys do not decide.
fn root(scope: &JsonScope) -> Holder {
    let has = |object: &Object| {
        let other = if object.name == LAB.name { &QUIZ } else { &LAB };
        scope.keys.iter().any(|(name, _)| object.key(name).is_some() && other.key(name).is_none())
    };
    let compares = scope.keys.iter().any(|(name, _)| name == "integrators");
    let objects: &[&'static Object] = match (has(&LAB), has(&QUIZ)) {
        _ if compares => &[&INTEGRATORS],
        (_, true) => &[&QUIZ],
        (true, false) => &[&LAB],
        (false, false) => &[&LAB, &QUIZ],
    };
    Holder::Keys(allowed(objects, scope))
}

/// The type that is expected at this key or item of an object or a list.
fn inside(holder: &Holder, step: &ScanStep) -> Option<Type> {
    match (holder, step) {
        (Holder::Keys(keys), ScanStep::Key(name)) => keys.iter().find(|k| k.name == name).map(|k| k.ty),
        (Holder::Of(Type::Map(map)), ScanStep::Key(_)) => Some(map.ty),
        (Holder::Of(Type::Switches(_)), ScanStep::Key(_)) => Some(Type::Flag),
        (Holder::Of(Type::List(item)), ScanStep::Item(_)) => Some(**item),
        (Holder::Of(Type::Pair(parts)), ScanStep::Item(i)) => parts.get(*i).map(|p| p.ty),
        _ => None,
    }
}

/// The declared type of an object or a list that is the value of this type.
fn of_type(ty: Type, scope: &JsonScope) -> Holder {
    match (ty, scope.list) {
        (Type::Either(a, b), _) => match of_type(*a, scope) {
            Holder::Unknown => of_type(*b, scope),
            found => found,
        },
        (Type::Object(object), false) => Holder::Keys(allowed(&[object], scope)),
        (Type::OneOf(family), false) => Holder::Keys(allowed(&meant(family, scope), scope)),
        (Type::Map(_) | Type::Switches(_), false) | (Type::List(_) | Type::Pair(_), true) => Holder::Of(ty),
        _ => Holder::Unknown,
    }
}

/// The objects of a family that this one can be: the object that the family key selects, otherwise those that have all its
/// keys.
fn meant(family: &'static Family, scope: &JsonScope) -> Vec<&'static Object> {
    let word = scope.keys.iter().find(|(name, _)| name == family.key).and_then(|(_, word)| word.as_deref());
    if let Some(object) = word.and_then(|w| family.object(Some(w))) {
        return vec![object];
    }
    let family_keys = family.keys();
    let is_of_family = |name: &str| family_keys.iter().any(|k| k.name == name);
    let fits = |object: &&Object| {
        scope.keys.iter().all(|(name, _)| !is_of_family(name) || object.key(name).is_some())
    };
    let some: Vec<&'static Object> = family.objects.iter().copied().filter(fits).collect();
    if some.is_empty() { family.objects.to_vec() } else { some }
}

/// The keys of these objects without duplicates, except those that a present key excludes.
fn allowed(objects: &[&'static Object], scope: &JsonScope) -> Vec<&'static Key> {
    let mut all: Vec<&'static Key> = Vec::new();
    for object in objects {
        let is_present = |name: &str| scope.keys.iter().any(|(key, _)| key == name);
        let excluded = |name: &str| {
            let other =
                |names: &[&str]| names.contains(&name) && names.iter().any(|n| *n != name && is_present(n));
            object.key_rules.iter().any(|rule| match rule {
                KeyRule::ExactlyOne(names) => other(names),
                KeyRule::AtMostOne(names) | KeyRule::FirstCounts(names) => other(names.as_slice()),
                KeyRule::AtLeastOne(_) | KeyRule::OneAdvised(_) => false,
            })
        };
        for key in object.keys {
            if !all.iter().any(|k| k.name == key.name) && (is_present(key.name) || !excluded(key.name)) {
                all.push(key);
            }
        }
    }
    all
}

fn keys(holder: &Holder, scope: &JsonScope, spot: &CursorSpot, colon: bool) -> Vec<Completion> {
    let is_present = |name: &str| scope.keys.iter().any(|(key, _)| key == name);
    let insert = |name: &str| format!("\"{name}\"{}", if colon { "" } else { ": " });
    match holder {
        Holder::Keys(keys) => keys
            .iter()
            .filter(|k| !is_present(k.name))
            .map(|k| Completion {
                text: k.name.into(),
                is_key: true,
                replace: spot.written.clone(),
                insert: insert(k.name),
                doc: k.doc,
                takes: takes(k),
                default: default(k).map(|value| value.to_string()),
                required: k.required(),
            })
            .collect(),
        Holder::Of(Type::Switches(words)) => words
            .iter()
            .filter(|w| !is_present(w.text))
            .map(|w| Completion {
                text: w.text.into(),
                is_key: true,
                replace: spot.written.clone(),
                insert: insert(w.text),
                doc: w.doc,
                takes: "true or false".into(),
                default: Some("false".into()),
                required: false,
            })
            .collect(),
        Holder::Of(_) | Holder::Unknown => Vec::new(),
    }
}

/// The words that are accepted as a value. `key` is the key of the value.
fn values(
    key: Option<&'static Key>,
    ty: Option<Type>,
    scope: &JsonScope,
    spot: &CursorSpot,
) -> Vec<Completion> {
    let value = |text: &'static str, insert: String, doc: &'static str, takes: String| Completion {
        text: text.into(),
        is_key: false,
        replace: spot.written.clone(),
        insert,
        doc,
        takes,
        default: key.and_then(default).map(|value| value.to_string()),
        required: false,
    };
    match ty {
        Some(Type::Words(words)) => {
            let takes = || words.iter().map(|w| format!("\"{}\"", w.text)).collect::<Vec<_>>().join(", ");
            let free = |w: &&Word| !scope.list || !scope.texts.iter().any(|t| t == w.text);
            words
                .iter()
                .filter(free)
                .map(|w| value(w.text, format!("\"{}\"", w.text), w.doc, takes()))
                .collect()
        }
        Some(Type::Flag) => {
            let doc = key.map_or("whether it is drawn", |k| k.doc);
            ["true", "false"].map(|word| value(word, word.into(), doc, "true or false".into())).into()
        }
        _ => Vec::new(),
    }
}

/// The names that are accepted as a value. Without a model, there are none.
fn ask(named: Named, scope: &JsonScope, names: &dyn Fn(RequestedNames<'_>) -> Vec<String>) -> Vec<String> {
    let text = |key: &str| {
        let (_, raw) = scope.keys.iter().find(|(name, _)| name == key)?;
        // The text between the quotes; an invalid escape sequence is kept unchanged.
        let raw = raw.as_ref()?;
        Some(serde_json::from_str::<String>(&format!("\"{raw}\"")).unwrap_or_else(|_| raw.clone()))
    };
    match (named, text("model"), text("xml")) {
        (Named::Model, ..) => names(RequestedNames::Models),
        (Named::Site, Some(model), _) => names(RequestedNames::SitesOf(&model)),
        (Named::Site, None, Some(xml)) => names(RequestedNames::SitesIn(&xml)),
        (Named::Site, None, None) => Vec::new(),
    }
}

/// Completions for names.
fn complete_key(key: Option<&'static Key>, names: Vec<String>, spot: &CursorSpot) -> Vec<Completion> {
    let name = |name: String| Completion {
        is_key: false,
        replace: spot.written.clone(),
        insert: format!("\"{}\"", encode(&name)),
        text: name.into(),
        doc: key.map_or("", |k| k.doc),
        takes: key.map(takes).unwrap_or_default(),
        default: key.and_then(default).map(|value| value.to_string()),
        required: false,
    };
    names.into_iter().map(name).collect()
}
