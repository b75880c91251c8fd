//! Reading and storing of elements of fields and views.

use super::index::whole_index;
use super::machine::{Machine, RegisterFrame, span_of};
use crate::code::MachineFunction;
use crate::natives::NativeError;
use crate::rules;
use crate::runtime_event::{EventKind, RuntimeEvent};
use crate::ssa::{Num, Val};
use crate::types::FieldKey;
use crate::value::{Value, View};

impl Machine<'_> {
    /// Reads an element of a field at a constant index.
    #[inline(always)]
    pub(super) fn load(
        &mut self,
        dst: Num,
        field: FieldKey,
        index: u32,
        unit: &MachineFunction,
        f: RegisterFrame,
        pc: usize,
    ) {
        match self.host.get(field, index as usize) {
            Some(x) => self.put(f, dst, x),
            None => {
                let view = View::new(field, 0, None);
                self.note(EventKind::ReadPastEnd, unit, pc, view, f64::from(index));
                self.put(f, dst, f64::NAN);
            }
        }
    }

    /// Reads an element of a view at a constant index, as a value.
    #[inline(always)]
    pub(super) fn load_value(
        &mut self,
        dst: Val,
        view: View,
        index: u32,
        unit: &MachineFunction,
        f: RegisterFrame,
        pc: usize,
    ) {
        let place = (view.first as usize).saturating_add(index as usize);
        match self.host.get(view.field, place) {
            Some(x) => self.put_value(f, dst, Value::Number(x)),
            None => {
                self.note(EventKind::ReadPastEnd, unit, pc, view, f64::from(index));
                self.put_value(f, dst, Value::Undefined);
            }
        }
    }

    /// Reads an element of a view, as a value.
    #[inline(always)]
    pub(super) fn load_value_at(
        &mut self,
        dst: Val,
        view: View,
        index: Num,
        unit: &MachineFunction,
        f: RegisterFrame,
        pc: usize,
    ) {
        match self.element(view, self.num(f, index), unit, pc) {
            Some(x) => self.put_value(f, dst, Value::Number(x)),
            None => self.put_value(f, dst, Value::Undefined),
        }
    }

    /// The current number of elements of a view.
    pub(super) fn length(&self, view: View) -> usize {
        view.count().unwrap_or_else(|| self.host.len(view.field).saturating_sub(view.first as usize))
    }

    /// The index in the whole field of the element at index `written` of a view, or `None` if it does not exist.
    pub(super) fn position(&self, view: View, written: f64) -> Option<usize> {
        let index = whole_index(written)?;
        if index < self.length(view) { (view.first as usize).checked_add(index) } else { None }
    }

    #[inline]
    pub(super) fn element(
        &mut self,
        view: View,
        written: f64,
        unit: &MachineFunction,
        pc: usize,
    ) -> Option<f64> {
        // No field has more than 2^32 elements. The comparison is false for NaN and for fractions.
        let index = written as u32;
        let found = if f64::from(index) == written && view.count().is_none_or(|n| (index as usize) < n) {
            // If the length of the field is unknown, the host determines whether the element exists.
            self.host.get(view.field, (view.first as usize).saturating_add(index as usize))
        } else {
            None
        };
        if found.is_none() {
            self.note(EventKind::ReadPastEnd, unit, pc, view, written);
        }
        found
    }

    pub(super) fn store(&mut self, field: FieldKey, index: usize, x: f64) -> Result<(), NativeError> {
        self.host.set(field, index, x).map_err(|message| NativeError::new(rules::HOST_STORE, message))
    }

    #[cold]
    pub(super) fn note(
        &mut self,
        kind: EventKind,
        unit: &MachineFunction,
        pc: usize,
        view: View,
        index: f64,
    ) {
        let len = self.length(view);
        self.context.note(RuntimeEvent { kind, span: span_of(unit, pc), field: view.field, index, len });
    }
}
