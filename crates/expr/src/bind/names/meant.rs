//! Suggestions for unknown names.

use super::language::LANGUAGE_NAMES;
use super::walk::{NameUse, NameWalk};
use crate::math;
use crate::schema::{Entry, Schema};
use crate::types::ObjectId;
use labspec_finding::{nearest, ranked};

impl NameUse {
    /// Whether an entry of the host can be used in this way.
    fn fits(self, entry: &Entry) -> bool {
        match (self, entry) {
            (NameUse::Callee, Entry::Function(_) | Entry::Collection(_)) => true,
            (NameUse::Callee, _) | (NameUse::Value | NameUse::Holder, Entry::Function(_)) => false,
            (NameUse::Value, Entry::Collection(_)) => false,
            (NameUse::Value | NameUse::Holder, _) => true,
        }
    }

    /// Whether a name of the language can be used in this way.
    fn fits_word(self, word: &str) -> bool {
        match word {
            "Math" | "ctx" => self == NameUse::Holder,
            "NaN" | "Infinity" | "undefined" => self == NameUse::Value,
            "Object" | "Array" => self == NameUse::Holder,
            "Number" | "String" => true,
            _ => self != NameUse::Holder,
        }
    }
}

impl NameWalk<'_, '_> {
    /// The probable meaning of a misspelt name, or of a name whose object was left out.
    pub(super) fn meant(&self, name: &str, used: NameUse) -> Option<String> {
        let schema = self.around.schema?;
        let fits = |entry: Option<Entry>| entry.is_some_and(|e| used.fits(&e));
        for (path, object) in objects(schema) {
            // A collection has no members, so a name followed by a point probably means something else.
            let entry = schema.member(object, name);
            let entry = entry.filter(|e| used == NameUse::Callee || !matches!(e, Entry::Collection(_)));
            if fits(entry) {
                return Some(format!("{path}.{name}"));
            }
        }
        let of_math = match used {
            NameUse::Callee => math::function(name).is_some(),
            _ => math::constant(name).is_some(),
        };
        if of_math {
            return Some(format!("Math.{name}"));
        }
        let mut roots = schema.root_names();
        roots.retain(|root| fits(schema.root(root)));
        let words = LANGUAGE_NAMES.into_iter().filter(|word| used.fits_word(word));
        let candidates = self.text_names().chain(roots.iter().map(String::as_str)).chain(words);
        if let Some(meant) = nearest(name, candidates) {
            return Some(meant.to_owned());
        }
        if self.lab_variables.contains(name) || self.around.globals.slot(name).is_some() {
            return Some(format!("ctx.{name}"));
        }
        // The object was not written at all, so only a nearly identical name is suggested.
        let near = if name.len() < 8 { 10 } else { 20 };
        let elsewhere = meant_elsewhere(schema, name, None, &|entry| used.fits(entry));
        elsewhere.filter(|(cost, _)| *cost <= near).map(|(_, path)| path)
    }
}

/// The objects that a name denotes, and their objects, each with its path.
fn objects(schema: &dyn Schema) -> Vec<(String, ObjectId)> {
    let mut found = Vec::new();
    for root in schema.root_names() {
        let Some(Entry::Object(id)) = schema.root(&root) else { continue };
        found.push((root, id));
    }
    for i in 0..found.len() {
        let Some((path, id)) = found.get(i).cloned() else { continue };
        for name in schema.member_names(id) {
            if let Some(Entry::Object(inner)) = schema.member(id, &name) {
                found.push((format!("{path}.{name}"), inner));
            }
        }
    }
    found
}

/// The path of the member, of any object except `but`, whose name is nearest to `name`, with its edit distance.
pub(in crate::bind) fn meant_elsewhere(
    schema: &dyn Schema,
    name: &str,
    but: Option<ObjectId>,
    fits: &dyn Fn(&Entry) -> bool,
) -> Option<(usize, String)> {
    let mut best: Option<(usize, String)> = None;
    for (path, id) in objects(schema).into_iter().filter(|(_, id)| Some(*id) != but) {
        let fits = |name: &str| schema.member(id, name).is_some_and(|entry| fits(&entry));
        let mut names = schema.member_names(id);
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
