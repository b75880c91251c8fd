//! The types found in the rounds of type inference.

use std::collections::BTreeMap;

use crate::types::Type;

/// The key of a type that is inferred: the call of the inlined method that declares it (0 for the text itself), the byte of
/// the declaration, and its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FactKey {
    pub(super) site: usize,
    pub(super) offset: usize,
    pub(super) what: FactKind,
}

/// The kind of a declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum FactKind {
    /// A variable.
    Name,
    /// A parameter that is destructured.
    Parameter,
    /// The result of a function.
    Result,
    /// An unnamed value that is destructured.
    Part,
    /// The counter of a loop over elements; `List` is its list.
    Counter,
    List,
}

/// Rounds in which types may widen freely. Lessons need at most three.
const ROUNDS: usize = 6;

/// The types found so far.
///
/// Why the rounds terminate quickly: a variable that is declared, never reassigned and not used before its declaration gets
/// its type before it is read. Hence every cycle of dependent types passes through a *join*: a variable that is reassigned
/// or used early, a parameter, or the result of a function. After [`ROUNDS`] rounds all joins have the type any. In the
/// round after that, no type depends on an earlier round any more, and the next round finds nothing new.
#[derive(Clone, Debug, Default)]
pub(super) struct TypeFacts {
    types: BTreeMap<FactKey, Fact>,
    /// A type has widened after it was read in this round.
    stale: bool,
    rounds: usize,
}

#[derive(Clone, Copy, Debug)]
struct Fact {
    ty: Type,
    /// The type has been read in this round.
    read: bool,
    join: bool,
}

impl TypeFacts {
    fn at(&mut self, key: FactKey) -> &mut Fact {
        self.types.entry(key).or_insert(Fact { ty: Type::Never, read: false, join: false })
    }

    /// Marks a key as a join.
    pub(super) fn join(&mut self, key: FactKey) {
        self.at(key).join = true;
    }

    /// Returns the current type of a key and marks it as read.
    pub(super) fn ty(&mut self, key: FactKey) -> Type {
        let wide = self.rounds >= ROUNDS;
        let fact = self.at(key);
        fact.read = true;
        if wide && fact.join { Type::Any } else { fact.ty }
    }

    /// The type of a key found in this round and before.
    pub(super) fn found(&self, key: FactKey) -> Type {
        match self.types.get(&key) {
            Some(fact) if fact.join && self.rounds >= ROUNDS => Type::Any,
            Some(fact) => fact.ty,
            None => Type::Never,
        }
    }

    /// Widens the type of a key by `ty`.
    pub(super) fn widen(&mut self, key: FactKey, ty: Type) {
        let wide = self.rounds >= ROUNDS;
        let fact = self.at(key);
        let joined = fact.ty.or(ty);
        if joined != fact.ty {
            fact.ty = joined;
            let read = fact.read && !(wide && fact.join);
            self.stale |= read;
        }
    }

    /// Ends a round, and returns whether another one must follow.
    pub(super) fn next_round(&mut self) -> bool {
        if !std::mem::take(&mut self.stale) {
            return false;
        }
        self.types.values_mut().for_each(|fact| fact.read = false);
        self.rounds += 1;
        true
    }

    /// The number of rounds so far.
    #[cfg(test)]
    pub(super) fn rounds(&self) -> usize {
        self.rounds + 1
    }
}
