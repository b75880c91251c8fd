//! The `ctx` variables of one lab: their slots, shared by all programs, and which programs store and read them.

use std::collections::BTreeMap;

use crate::global_names::GlobalNames;
use crate::host_terms::HostTerms;
use crate::rules;
use labspec_finding::{Finding, Span, nearest};

/// The id of a compiled text, counted from 0 in the order of compilation with one [`Globals`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ProgramId(pub u32);

/// The variables of a lab. A variable exists once any program mentions it, and is `undefined` until it is stored.
#[derive(Clone, Debug, Default)]
pub struct Globals {
    slots: BTreeMap<String, u32>,
    names: Vec<String>,
    /// The same names, shared with the contexts in which programs run.
    shared_names: GlobalNames,
    /// Whether the host itself stores the variable.
    given: Vec<bool>,
    uses: Vec<GlobalUse>,
    /// Prefixes of variable names that programs compute.
    computed: Vec<String>,
    programs: u32,
}

/// A state of the uses to which they can be reset.
#[derive(Clone, Copy, Debug)]
pub struct GlobalsMark {
    uses: usize,
    computed: usize,
}

/// A mention of a variable.
#[derive(Clone, Copy, Debug)]
struct GlobalUse {
    slot: u32,
    program: ProgramId,
    span: Span,
    stores: bool,
}

impl Globals {
    /// Returns an empty set of variables.
    pub fn new() -> Globals {
        Globals::default()
    }

    /// Returns the slot of a variable that the host stores (the `param` of a control).
    pub fn define(&mut self, name: &str) -> u32 {
        let slot = self.intern(name);
        if let Some(given) = self.given.get_mut(slot as usize) {
            *given = true;
        }
        slot
    }

    /// Returns the slot of a variable that has been mentioned.
    pub fn slot(&self, name: &str) -> Option<u32> {
        self.slots.get(name).copied()
    }

    /// Returns the name of a slot, or an empty string if the slot does not exist.
    pub fn name(&self, slot: u32) -> &str {
        self.names.get(slot as usize).map_or("", String::as_str)
    }

    /// The number of slots.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether there are no variables.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// The programs that may store a variable, in order, possibly repeated.
    pub fn writers(&self, slot: u32) -> impl Iterator<Item = ProgramId> + '_ {
        self.uses.iter().filter(move |u| u.slot == slot && u.stores).map(|u| u.program)
    }

    /// The programs that may read a variable, in order, possibly repeated.
    pub fn readers(&self, slot: u32) -> impl Iterator<Item = ProgramId> + '_ {
        self.uses.iter().filter(move |u| u.slot == slot && !u.stores).map(|u| u.program)
    }

    /// Warns about variables that programs read and nothing stores: one warning for the first read in each program. Must be
    /// called after all texts of the lab are compiled.
    pub fn unset(&self, host_terms: &HostTerms) -> Vec<(ProgramId, Finding)> {
        let mut stored = self.given.clone();
        for usage in self.uses.iter().filter(|u| u.stores) {
            if let Some(is_stored) = stored.get_mut(usage.slot as usize) {
                *is_stored = true;
            }
        }
        let is_stored = |slot: u32| {
            let computed = |name: &str| self.computed.iter().any(|c| name.starts_with(c.as_str()));
            stored.get(slot as usize).copied().unwrap_or(false) || computed(self.name(slot))
        };
        let stored_names: Vec<&str> =
            (0..self.names.len() as u32).filter(|s| is_stored(*s)).map(|s| self.name(s)).collect();
        let mut found: Vec<(u32, ProgramId)> = Vec::new();
        let mut reports = Vec::new();
        for usage in self.uses.iter().filter(|u| !u.stores && !is_stored(u.slot)) {
            if found.contains(&(usage.slot, usage.program)) {
                continue;
            }
            found.push((usage.slot, usage.program));
            reports.push((
                usage.program,
                unset_report(self.name(usage.slot), usage.span, &stored_names, host_terms),
            ));
        }
        reports
    }

    /// The number of the next text that is compiled.
    pub fn next_program(&mut self) -> ProgramId {
        let id = ProgramId(self.programs);
        self.programs += 1;
        id
    }

    /// Records that a program stores and reads variables whose computed names have this prefix.
    pub fn mention_all(&mut self, beginning: &str) {
        self.computed.push(beginning.to_owned());
    }

    /// All names, for the contexts in which programs run.
    pub fn shared_names(&self) -> &GlobalNames {
        &self.shared_names
    }

    /// This point in the work.
    pub fn mark(&self) -> GlobalsMark {
        GlobalsMark { uses: self.uses.len(), computed: self.computed.len() }
    }

    /// Removes the uses since a mark. Names keep their slots.
    pub fn back_to(&mut self, mark: GlobalsMark) {
        self.uses.truncate(mark.uses);
        self.computed.truncate(mark.computed);
    }

    /// The slot of a variable that a program stores or reads.
    pub fn mention(&mut self, name: &str, program: ProgramId, span: Span, stores: bool) -> u32 {
        let slot = self.intern(name);
        self.uses.push(GlobalUse { slot, program, span, stores });
        slot
    }

    fn intern(&mut self, name: &str) -> u32 {
        if let Some(&slot) = self.slots.get(name) {
            return slot;
        }
        let slot = self.names.len() as u32;
        self.slots.insert(name.to_owned(), slot);
        self.names.push(name.to_owned());
        self.shared_names.push(name);
        self.given.push(false);
        slot
    }
}

fn unset_report(name: &str, span: Span, stored_names: &[&str], host_terms: &HostTerms) -> Finding {
    let report = Finding::warning(rules::UNSET_GLOBAL, span, format!("nothing ever stores `ctx.{name}`"))
        .why("it is `undefined` in every run, and a computation with it gives NaN");
    match nearest(name, stored_names.iter().copied()) {
        Some(meant) => {
            report.help(format!("did you mean `ctx.{meant}`?")).guess(span, format!("ctx.{meant}"))
        }
        None => report.help(host_terms.store.replace("{name}", name)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_read_but_never_stored_is_reported_once_per_program() {
        let mut globals = Globals::new();
        let (first, second) = (globals.next_program(), globals.next_program());
        globals.define("angle");
        globals.mention("peak", first, Span::new(0, 8), true);
        globals.mention("peek", second, Span::new(4, 12), false);
        globals.mention("peek", second, Span::new(14, 22), false);
        globals.mention("angle", second, Span::new(24, 33), false);
        let found = globals.unset(&HostTerms::PLAIN);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].0, second);
        assert_eq!(found[0].1.help.as_deref(), Some("did you mean `ctx.peak`?"));
        assert_eq!(globals.writers(1).collect::<Vec<_>>(), [first]);
        assert_eq!(globals.readers(0).collect::<Vec<_>>(), [second]);
    }
}
