//! What the names of a text mean, as the first pass finds it.

use std::collections::{BTreeMap, BTreeSet};

/// What the names of a text mean. Places are bytes: that of a name, of its declaration, of a function.
#[derive(Clone, Debug, Default)]
pub(in crate::bind) struct NameTable {
    /// Names that the text declares, and those that are mistakes; all others belong to the language or the host.
    pub(super) uses: BTreeMap<usize, NameMeaning>,
    pub(super) declared: BTreeMap<usize, Declaration>,
    /// Variables of other functions that a function uses, itself or through functions that it names.
    pub(super) captured: BTreeMap<usize, BTreeSet<usize>>,
    /// There are so many functions, or they name each other so deeply, that the text is not looked at any further.
    pub(in crate::bind) stopped: bool,
}

/// What a name means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::bind) enum NameMeaning {
    /// The declaration at this byte.
    Declared(usize),
    /// It is a mistake, which has been reported.
    Wrong,
    /// Nothing of this text.
    Outside,
}

/// A declaration.
#[derive(Clone, Debug)]
pub(in crate::bind) struct Declaration {
    pub(super) name: String,
    pub(super) constant: bool,
    /// The function that it stands in.
    pub(super) function: usize,
    /// In how many places it is assigned after its declaration.
    pub(in crate::bind) assigned: usize,
    /// A function uses it that it does not stand in.
    pub(super) captured: bool,
    /// A function uses it before its declaration has run.
    pub(super) early: bool,
    pub(in crate::bind) parameter: bool,
    /// The declaration has run.
    pub(super) ready: bool,
    /// The function that it names, while nothing has named that.
    pub(super) holds: Option<usize>,
}

impl Declaration {
    /// Whether functions share one place of the variable.
    pub(in crate::bind) fn is_shared(&self) -> bool {
        self.early || self.captured && self.assigned > 0
    }

    /// Whether its type may come from a place that is bound later: every circle of types goes through such a variable.
    pub(in crate::bind) fn joins(&self) -> bool {
        self.parameter || self.early || self.assigned > 0
    }
}

impl NameTable {
    /// What the name at a byte means.
    pub(in crate::bind) fn at(&self, byte: usize) -> NameMeaning {
        self.uses.get(&byte).copied().unwrap_or(NameMeaning::Outside)
    }

    /// The declaration at a byte; none when the name could not be declared.
    pub(in crate::bind) fn declared(&self, byte: usize) -> Option<&Declaration> {
        self.declared.get(&byte)
    }

    /// The variables of other functions that the function at a byte uses.
    pub(in crate::bind) fn captured(&self, function: usize) -> impl Iterator<Item = usize> + '_ {
        self.captured.get(&function).into_iter().flatten().copied()
    }
}
