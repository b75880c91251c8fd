//! What the rounds find out about types.

use std::collections::BTreeMap;

use crate::types::Type;

/// A place whose type is looked for: the call whose written method declares it (0 for the text itself), the byte of what
/// declares it, and what it is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FactKey {
    pub(super) site: usize,
    pub(super) at: usize,
    pub(super) what: FactKind,
}

/// What is declared at a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum FactKind {
    /// A variable.
    Name,
    /// A parameter that is taken apart at once.
    Parameter,
    /// What a function gives.
    Result,
    /// A value that is kept without a name, to be taken apart.
    Part,
    /// The counter and the list of a loop over elements.
    Counter,
    List,
}

/// Rounds in which types grow as far as they must. Lessons take three at most.
const ROUNDS: usize = 6;

/// The types found so far.
///
/// Why the rounds end, and soon: a variable that is declared, never assigned again and not used before its declaration gets its
/// type before anything reads it. So every circle, in which a type follows from itself, goes through a *join*: a variable that is
/// assigned again or used early, a parameter, or what a function gives. After [`ROUNDS`] rounds all joins are taken to hold
/// anything. In the round after that no type depends on an earlier round any more, and the one after it finds nothing new.
#[derive(Clone, Debug, Default)]
pub(super) struct TypeFacts {
    types: BTreeMap<FactKey, Fact>,
    /// A type has grown after it was read in this round.
    stale: bool,
    rounds: usize,
}

#[derive(Clone, Copy, Debug)]
struct Fact {
    ty: Type,
    /// It has been read in this round.
    read: bool,
    join: bool,
}

impl TypeFacts {
    fn at(&mut self, key: FactKey) -> &mut Fact {
        self.types.entry(key).or_insert(Fact { ty: Type::Never, read: false, join: false })
    }

    /// The place is a join.
    pub(super) fn join(&mut self, key: FactKey) {
        self.at(key).join = true;
    }

    /// What is known of the type at a place.
    pub(super) fn ty(&mut self, key: FactKey) -> Type {
        let wide = self.rounds >= ROUNDS;
        let fact = self.at(key);
        fact.read = true;
        if wide && fact.join { Type::Any } else { fact.ty }
    }

    /// What was found at a place in this round and before.
    pub(super) fn found(&self, key: FactKey) -> Type {
        match self.types.get(&key) {
            Some(fact) if fact.join && self.rounds >= ROUNDS => Type::Any,
            Some(fact) => fact.ty,
            None => Type::Never,
        }
    }

    /// One more type at a place.
    pub(super) fn see(&mut self, key: FactKey, ty: Type) {
        let wide = self.rounds >= ROUNDS;
        let fact = self.at(key);
        let joined = fact.ty.or(ty);
        if joined != fact.ty {
            fact.ty = joined;
            let read = fact.read && !(wide && fact.join);
            self.stale |= read;
        }
    }

    /// Ends a round: whether another one must follow.
    pub(super) fn next_round(&mut self) -> bool {
        if !std::mem::take(&mut self.stale) {
            return false;
        }
        self.types.values_mut().for_each(|fact| fact.read = false);
        self.rounds += 1;
        true
    }

    /// Rounds until now.
    #[cfg(test)]
    pub(super) fn rounds(&self) -> usize {
        self.rounds + 1
    }
}
