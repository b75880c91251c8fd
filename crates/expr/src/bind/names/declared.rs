//! The result of the first pass: the meaning of every name of a source text.

use std::collections::{BTreeMap, BTreeSet};

/// The meanings of the names of a source text. Names, declarations and functions are identified by their byte offsets.
#[derive(Clone, Debug, Default)]
pub(in crate::bind) struct NameTable {
    /// Names that the text declares, and names with errors. All others belong to the language or the host.
    pub(super) uses: BTreeMap<usize, NameMeaning>,
    pub(super) declared: BTreeMap<usize, Declaration>,
    /// For each function, the variables of enclosing functions that it captures, directly or through functions that it
    /// names.
    pub(super) captured: BTreeMap<usize, BTreeSet<usize>>,
    /// There are too many functions, or their references are nested too deeply, so that the analysis stopped.
    pub(in crate::bind) stopped: bool,
}

/// What a name means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::bind) enum NameMeaning {
    /// The declaration at this byte.
    Declared(usize),
    /// The name has an error, which has been reported.
    Wrong,
    /// The text does not declare the name.
    Outside,
}

/// A declaration.
#[derive(Clone, Debug)]
pub(in crate::bind) struct Declaration {
    pub(super) name: String,
    pub(super) constant: bool,
    /// The function that contains the declaration.
    pub(super) function: usize,
    /// The number of assignments after the declaration.
    pub(in crate::bind) assigned: usize,
    /// Whether another function uses the variable.
    pub(super) captured: bool,
    /// Whether a function uses the variable before its declaration has been executed.
    pub(super) early: bool,
    pub(in crate::bind) parameter: bool,
    /// Whether the declaration has been executed at this point of the walk.
    pub(super) ready: bool,
    /// The function to which the name is bound, until the first use of the name.
    pub(super) holds: Option<usize>,
}

impl Declaration {
    /// Whether several functions share the storage of the variable.
    pub(in crate::bind) fn is_shared(&self) -> bool {
        self.early || self.captured && self.assigned > 0
    }

    /// Whether the type may come from code that is bound later. Every cycle of types passes through such a variable.
    pub(in crate::bind) fn joins(&self) -> bool {
        self.parameter || self.early || self.assigned > 0
    }
}

impl NameTable {
    /// The meaning of the name at a byte.
    pub(in crate::bind) fn at(&self, byte: usize) -> NameMeaning {
        self.uses.get(&byte).copied().unwrap_or(NameMeaning::Outside)
    }

    /// The declaration at a byte, or `None` if the name could not be declared.
    pub(in crate::bind) fn declared(&self, byte: usize) -> Option<&Declaration> {
        self.declared.get(&byte)
    }

    /// The variables of enclosing functions that the function at a byte captures.
    pub(in crate::bind) fn captured(&self, function: usize) -> impl Iterator<Item = usize> + '_ {
        self.captured.get(&function).into_iter().flatten().copied()
    }
}
