//! Elements of fields and views: where they are, reading and storing them.

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
    /// An element at a known place of a field.
    #[inline(always)]
    pub(super) fn load(
        &mut self,
        dst: Num,
        field: FieldKey,
        index: u32,
        unit: &MachineFunction,
        f: RegisterFrame,
        at: usize,
    ) {
        match self.host.get(field, index as usize) {
            Some(x) => self.put(f, dst, x),
            None => {
                let view = View::new(field, 0, None);
                self.note(EventKind::ReadPastEnd, unit, at, view, f64::from(index));
                self.put(f, dst, f64::NAN);
            }
        }
    }

    /// An element at a known place of a view, as a value.
    #[inline(always)]
    pub(super) fn load_value(
        &mut self,
        dst: Val,
        view: View,
        index: u32,
        unit: &MachineFunction,
        f: RegisterFrame,
        at: usize,
    ) {
        let place = (view.first as usize).saturating_add(index as usize);
        match self.host.get(view.field, place) {
            Some(x) => self.put_value(f, dst, Value::Number(x)),
            None => {
                self.note(EventKind::ReadPastEnd, unit, at, view, f64::from(index));
                self.put_value(f, dst, Value::Undefined);
            }
        }
    }

    /// An element of a view, as a value.
    #[inline(always)]
    pub(super) fn load_value_at(
        &mut self,
        dst: Val,
        view: View,
        index: Num,
        unit: &MachineFunction,
        f: RegisterFrame,
        at: usize,
    ) {
        match self.element(view, self.num(f, index), unit, at) {
            Some(x) => self.put_value(f, dst, Value::Number(x)),
            None => self.put_value(f, dst, Value::Undefined),
        }
    }

    /// Number of elements of a view, now.
    pub(super) fn length(&self, view: View) -> usize {
        view.count().unwrap_or_else(|| self.host.len(view.field).saturating_sub(view.first as usize))
    }

    /// The element of the whole field at index `written` of a view, `None` when there is none.
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
        at: usize,
    ) -> Option<f64> {
        // No field has more elements than that. The comparison is false for NaN, and for what is not whole.
        let index = written as u32;
        let found = if f64::from(index) == written && view.count().is_none_or(|n| (index as usize) < n) {
            // Of a field without a known length the host knows where it ends.
            self.host.get(view.field, (view.first as usize).saturating_add(index as usize))
        } else {
            None
        };
        if found.is_none() {
            self.note(EventKind::ReadPastEnd, unit, at, view, written);
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
        at: usize,
        view: View,
        index: f64,
    ) {
        let len = self.length(view);
        self.context.note(RuntimeEvent { kind, span: span_of(unit, at), field: view.field, index, len });
    }
}
