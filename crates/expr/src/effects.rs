//! The effects of a program. They are known before it runs, and plans and lints depend on them alone.

use crate::schema::AccessedFields;
use crate::types::{FieldKey, FunctionId};
use labspec_finding::order;

/// Elements of a field that a program reads or writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Access {
    /// The field.
    pub field: FieldKey,
    /// The first element, counted from the start of the whole field.
    pub first: usize,
    /// The number of elements; `None` means all from `first` on.
    pub count: Option<usize>,
}

/// The effects of one program. Lists are in order of first use, without duplicates. The effects of the arguments of an
/// aggregate belong to the programs of those arguments, see [`crate::Aggregate`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Effects {
    /// Elements that it may read; a computed index reads the whole view.
    pub reads: Vec<Access>,
    /// Elements that it may write.
    pub writes: Vec<Access>,
    /// Functions of the host that it may call, without aggregates.
    pub calls: Vec<FunctionId>,
    /// Slots of `ctx` variables that it may read.
    pub ctx_reads: Vec<u32>,
    /// Slots of `ctx` variables that it may store.
    pub ctx_writes: Vec<u32>,
    /// Whether it calls a function that may read everything.
    pub reads_everything: bool,
    /// Whether it calls a function that may write everything.
    pub writes_everything: bool,
    /// Whether it computes the name of a `ctx` variable, so that it may read and store any of them.
    pub any_ctx: bool,
    /// Whether it calls functions that are known only at run time, such as a function that another program stored in `ctx`. The
    /// effects of such a function belong to the program that defines it.
    pub calls_values: bool,
    /// Whether it stores elements of lists and arrays that are known only at run time.
    pub(crate) stores_items: bool,
    /// Whether it uses `value`.
    pub uses_value: bool,
    /// Whether it contains aggregates.
    pub aggregates: bool,
    /// Whether a run may end in a [`crate::RuntimeError`].
    pub can_throw: bool,
}

impl Effects {
    /// Whether every run returns the same value and changes nothing.
    pub fn constant(&self) -> bool {
        let reads = self.reads_everything || self.uses_value || self.aggregates || !self.ctx_reads.is_empty();
        let reads = reads || self.any_ctx || self.calls_values;
        !reads && self.reads.is_empty() && self.calls.is_empty() && self.pure()
    }

    /// Whether a run changes nothing.
    pub fn pure(&self) -> bool {
        let ctx = !self.ctx_writes.is_empty() || self.any_ctx;
        self.writes.is_empty() && !ctx && !self.writes_everything && !self.stores_items && !self.calls_values
    }

    /// Whether a run may store elements of lists and arrays that are known only at run time.
    pub fn stores_items(&self) -> bool {
        self.stores_items
    }

    pub(crate) fn read(&mut self, access: Access) {
        add(&mut self.reads, access);
    }

    pub(crate) fn write(&mut self, access: Access) {
        add(&mut self.writes, access);
        self.can_throw = true;
    }

    pub(crate) fn call(&mut self, function: FunctionId, reads: &AccessedFields, writes: &AccessedFields) {
        add(&mut self.calls, function);
        self.can_throw = true;
        add_accessed(reads, &mut self.reads, &mut self.reads_everything);
        add_accessed(writes, &mut self.writes, &mut self.writes_everything);
    }

    pub(crate) fn read_global(&mut self, slot: u32) {
        add(&mut self.ctx_reads, slot);
    }

    pub(crate) fn write_global(&mut self, slot: u32) {
        add(&mut self.ctx_writes, slot);
    }
}

fn add<T: PartialEq>(list: &mut Vec<T>, item: T) {
    if !list.contains(&item) {
        list.push(item);
    }
}

fn add_accessed(accessed: &AccessedFields, list: &mut Vec<Access>, everything: &mut bool) {
    match accessed {
        AccessedFields::Nothing => {}
        AccessedFields::Everything => *everything = true,
        AccessedFields::Fields(fields) => {
            let whole = |a: &&Access| a.first == 0 && a.count.is_none();
            let whole_fields = order::set(list.iter().filter(whole).map(|a| a.field));
            let new = fields.iter().filter(|f| !whole_fields.contains(f));
            list.extend(new.map(|&field| Access { field, first: 0, count: None }));
        }
    }
}
