//! What passes over a text find out about its variables and functions, by the place of their declaration.

use std::collections::{BTreeMap, BTreeSet};

use crate::schema::Type;

/// The place of a declaration: the call whose prelude method declares it (0 for the text itself), and the byte.
pub(crate) type Key = (usize, usize);

/// Everything found so far. It only ever grows, so that the passes come to an end.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Facts {
    /// What is stored in a variable, or returned by a function.
    types: BTreeMap<Key, Type>,
    /// Variables that are assigned after their declaration, with the places of the assignments.
    reassigned: BTreeMap<Key, BTreeSet<usize>>,
    /// Variables of one function that another one uses.
    captured: BTreeSet<Key>,
    /// Variables that a function uses before their declaration has run.
    early: BTreeSet<Key>,
    /// Variables that a function uses, by the place of the function.
    uses: BTreeMap<Key, Vec<Key>>,
    /// Types that change no more: all are unknown.
    unknown: bool,
}

impl Facts {
    /// What is known of the type at a place.
    pub(super) fn ty(&self, key: Key) -> Type {
        match self.types.get(&key) {
            Some(_) if self.unknown => Type::Any,
            Some(ty) => *ty,
            None => Type::Never,
        }
    }

    /// One more type at a place.
    pub(super) fn see(&mut self, key: Key, ty: Type) {
        let seen = self.types.entry(key).or_insert(Type::Never);
        *seen = seen.or(ty);
    }

    pub(super) fn reassign(&mut self, key: Key, at: usize) {
        self.reassigned.entry(key).or_default().insert(at);
    }

    /// In how many places a variable is assigned after its declaration.
    pub(super) fn assignments(&self, key: Key) -> usize {
        self.reassigned.get(&key).map_or(0, BTreeSet::len)
    }

    /// A function uses a variable of another one.
    pub(super) fn capture(&mut self, function: Key, variable: Key) {
        self.captured.insert(variable);
        let uses = self.uses.entry(function).or_default();
        if !uses.contains(&variable) {
            uses.push(variable);
        }
    }

    pub(super) fn use_early(&mut self, key: Key) {
        self.early.insert(key);
    }

    /// Whether functions share one place of a variable.
    pub(super) fn is_shared(&self, key: Key) -> bool {
        self.early.contains(&key) || self.captured.contains(&key) && self.reassigned.contains_key(&key)
    }

    /// The variables that a function uses.
    pub(super) fn uses(&self, function: Key) -> Vec<Key> {
        self.uses.get(&function).cloned().unwrap_or_default()
    }

    /// Types still change after many passes: from now on all are unknown.
    pub(super) fn give_up(&mut self) {
        self.unknown = true;
    }
}
