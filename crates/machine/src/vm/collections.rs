//! Operations on lists and records.

use std::sync::Arc;

use super::index::{index_of, whole_index};
use super::machine::{Machine, RegisterFrame, StepError};
use crate::code::{MachineCode, MachineFunction};
use crate::heap::HeapObject;
use crate::math;
use crate::natives::{self, NativeError};
use crate::rules;
use crate::ssa::{Args, Num, Op, Val};
use crate::tables::MemberTable;
use crate::value::{Value, View};

impl Machine<'_> {
    /// Executes an operation on lists, records or functions. It is one `match`, so that the dispatch is a single jump; arms
    /// longer than a few lines are separate functions.
    #[expect(
        clippy::too_many_lines,
        reason = "one match over the operations: a split costs a jump for each that runs"
    )]
    pub(super) fn step_collection(
        &mut self,
        op: Op,
        code: &Arc<MachineCode>,
        unit: &MachineFunction,
        f: RegisterFrame,
    ) -> Result<(), StepError> {
        self.collect_garbage();
        match op {
            Op::MathOver(dst, function, list) => self.math_over(code, dst, function, list, f)?,
            Op::List(dst, items) => {
                let items = self.operand_values(items, unit, f);
                let list = self.context.heap.list(items)?;
                self.put_value(f, dst, list);
            }
            Op::Append(list, item, spread) => self.append(code, list, item, spread, f)?,
            Op::NewRecord(dst) => {
                let record = self.context.heap.record(Vec::new())?;
                self.put_value(f, dst, record);
            }
            Op::Put(record, key, value) => self.put_entry(code, record, key, value, f)?,
            Op::PutAll(record, from) => self.put_all(code, record, from, f)?,
            Op::Element(dst, object, index) => {
                let value = self.item(code, f, object, index)?;
                self.put_value(f, dst, value);
            }
            Op::ElementAt(dst, object, index) => self.element_at(code, dst, object, index, f)?,
            Op::Member(dst, object, name) => self.read_member(code, dst, object, name, f)?,
            Op::StoreItem(object, index, value, _) => self.assign_item(code, object, index, value, f)?,
            Op::StoreMember(object, name, value, _) => self.assign_member(code, object, name, value, f)?,
            Op::Method(dst, name, args) => self.call_method(code, unit, dst, name, args, f)?,
            Op::MethodList(dst, name, receiver, list) => {
                self.call_method_with_list(code, unit, dst, name, (receiver, list), f)?
            }
            Op::Native(dst, function, args) => {
                let args = self.operand_values(args, unit, f);
                let value = natives::call_free(&mut self.env(code), function, &args)?;
                self.put_value(f, dst, value);
            }
            Op::NativeList(dst, function, list) => self.call_free_with_list(code, dst, function, list, f)?,
            Op::Closure(dst, callee, captures) => {
                let captures = self.operand_values(captures, unit, f);
                let value = self.context.heap.closure(code.clone(), callee, captures)?;
                self.put_value(f, dst, value);
            }
            Op::Invoke(dst, callee, args) => {
                let (callee, args) = (self.val(f, callee).clone(), self.operand_values(args, unit, f));
                let value = self.invoke_with(unit, f, &callee, &args)?;
                self.put_value(f, dst, value);
            }
            Op::InvokeList(dst, callee, list) => self.invoke_with_list(code, unit, dst, callee, list, f)?,
            Op::NewCell(dst, src) => {
                let value = self.val(f, src).clone();
                let cell = self.context.heap.cell(Some(value))?;
                self.put_value(f, dst, cell);
            }
            Op::EmptyCell(dst) => {
                let cell = self.context.heap.cell(None)?;
                self.put_value(f, dst, cell);
            }
            Op::CellGet(dst, cell) => self.read_cell(dst, cell, f)?,
            Op::CellSet(cell, src, declares) => self.write_cell(cell, src, declares, f)?,
            Op::Pick(dst, table, name) => {
                let value = self.computed_member(code, f, table, name)?;
                self.put_value(f, dst, value);
            }
            Op::PickNumber(dst, table, name) => self.computed_number(code, dst, table, name, f)?,
            _ => {} // handled in `execute` and `step`
        }
        Ok(())
    }

    /// Stores a member of a record that is being created.
    #[inline]
    fn put_entry(
        &mut self,
        code: &Arc<MachineCode>,
        record: Val,
        key: Val,
        value: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let (record, value) = (self.val(f, record).clone(), self.val(f, value).clone());
        let key = self.key(code, f, key)?;
        self.put_member(&record, key, value)
    }

    #[inline]
    fn read_member(
        &mut self,
        code: &Arc<MachineCode>,
        dst: Val,
        object: Val,
        name: u32,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let name = code.form.texts.get(name as usize).cloned().unwrap_or_else(|| "".into());
        let object = self.val(f, object).clone();
        let value = self.member(code, &object, &name)?;
        self.put_value(f, dst, value);
        Ok(())
    }

    #[inline]
    fn assign_item(
        &mut self,
        code: &Arc<MachineCode>,
        object: Val,
        index: Val,
        value: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let (object, index) = (self.val(f, object).clone(), self.val(f, index).clone());
        let value = self.val(f, value).clone();
        self.store_item(code, &object, &index, value)
    }

    #[inline]
    fn assign_member(
        &mut self,
        code: &Arc<MachineCode>,
        object: Val,
        name: u32,
        value: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let name = code.form.texts.get(name as usize).cloned().unwrap_or_else(|| "".into());
        let (object, value) = (self.val(f, object).clone(), self.val(f, value).clone());
        self.store_member(code, &object, name, value)
    }

    /// Evaluates a function of `Math` over all elements of a list.
    #[inline]
    fn math_over(
        &mut self,
        code: &MachineCode,
        dst: Num,
        function: math::MathFunction,
        list: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let list = self.val(f, list).clone();
        let mut env = self.env(code);
        let items = env.spread(&list)?;
        let mut numbers = Vec::with_capacity(items.len());
        for item in &items {
            numbers.push(env.number(item)?);
        }
        self.put(f, dst, function.apply(&numbers));
        Ok(())
    }

    /// Appends a value, or its elements, to a list that is being created.
    #[inline]
    fn append(
        &mut self,
        code: &MachineCode,
        list: Val,
        item: Val,
        spread: bool,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let (list, item) = (self.val(f, list).clone(), self.val(f, item).clone());
        let mut env = self.env(code);
        let items = if spread { env.spread(&item)? } else { vec![item] };
        for item in &items {
            env.heap.grow(item)?;
        }
        if let Some(HeapObject::List(all)) = env.heap.object_mut(&list) {
            all.extend(items);
        }
        Ok(())
    }

    /// Copies the members of one record into another.
    #[inline]
    fn put_all(
        &mut self,
        code: &MachineCode,
        record: Val,
        from: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let (record, from) = (self.val(f, record).clone(), self.val(f, from).clone());
        let entries = match self.context.heap.object(&from) {
            HeapObject::Record(entries) => entries.clone(),
            _ if from.is_nothing() => Vec::new(),
            _ => {
                let items = self.env(code).spread(&from).unwrap_or_default();
                items.into_iter().enumerate().map(|(i, v)| (i.to_string().into(), v)).collect()
            }
        };
        self.env(code).spend(entries.len())?;
        for (key, value) in entries {
            self.put_member(&record, key, value)?;
        }
        Ok(())
    }

    /// Evaluates `object[index]` with a numeric index.
    #[inline]
    fn element_at(
        &mut self,
        code: &Arc<MachineCode>,
        dst: Val,
        object: Val,
        index: Num,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let x = self.num(f, index);
        let object = self.val(f, object);
        let value = match object {
            Value::List(_) => match self.context.heap.object(object) {
                HeapObject::List(items) => {
                    whole_index(x).and_then(|i| items.get(i).cloned()).unwrap_or_default()
                }
                HeapObject::Numbers(items, _) => {
                    whole_index(x).and_then(|i| items.get(i)).map_or(Value::Undefined, |x| Value::Number(*x))
                }
                _ => Value::Undefined,
            },
            _ => {
                let object = object.clone();
                self.item_of(code, &object, &Value::Number(x))?
            }
        };
        self.put_value(f, dst, value);
        Ok(())
    }

    /// Reads the number that belongs to the object with a computed name.
    #[inline]
    fn computed_number(
        &mut self,
        code: &Arc<MachineCode>,
        dst: Num,
        table: u32,
        name: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let x = match self.computed_member(code, f, table, name)? {
            Value::View(view) => self.host.get(view.field, view.first as usize).unwrap_or(f64::NAN),
            other => other.to_number(),
        };
        self.put(f, dst, x);
        Ok(())
    }

    /// The values of a list of operands.
    pub(super) fn operand_values(&self, args: Args, unit: &MachineFunction, f: RegisterFrame) -> Vec<Value> {
        args.operands(&unit.args).iter().map(|a| self.val(f, Val(*a)).clone()).collect()
    }

    /// Returns the member of the object with a computed name.
    fn computed_member(
        &mut self,
        code: &Arc<MachineCode>,
        f: RegisterFrame,
        table: u32,
        name: Val,
    ) -> Result<Value, NativeError> {
        let name = self.val(f, name).clone();
        let name = self.env(code).text(&name)?;
        let Some(picks) = code.form.picks.get(table as usize) else { return Ok(Value::Undefined) };
        let MemberTable { noun, members, .. } = &**picks;
        match members.binary_search_by(|(n, _)| (**n).cmp(&name)) {
            Ok(index) => Ok(members.get(index).map(|(_, v)| v.clone()).unwrap_or_default()),
            Err(_) => {
                let near = labspec_finding::nearest(&name, members.iter().map(|(n, _)| &**n));
                let meant = near.map(|n| format!("; did you mean \"{n}\"?")).unwrap_or_default();
                Err(NativeError::new(
                    rules::UNKNOWN_OBJECT,
                    format!("there is no {noun} named \"{name}\"{meant}"),
                ))
            }
        }
    }

    fn key(&mut self, code: &Arc<MachineCode>, f: RegisterFrame, key: Val) -> Result<Arc<str>, NativeError> {
        match self.val(f, key) {
            Value::String(text) => Ok(text.clone()),
            other => {
                let other = other.clone();
                Ok(self.env(code).text(&other)?.into())
            }
        }
    }

    fn put_member(&mut self, record: &Value, key: Arc<str>, value: Value) -> Result<(), NativeError> {
        self.context.heap.grow(&value)?;
        if let Some(HeapObject::Record(entries)) = self.context.heap.object_mut(record) {
            match entries.iter_mut().find(|(k, _)| *k == key) {
                Some((_, place)) => *place = value,
                None => entries.push((key, value)),
            }
        }
        Ok(())
    }

    fn item(
        &mut self,
        code: &Arc<MachineCode>,
        f: RegisterFrame,
        object: Val,
        index: Val,
    ) -> Result<Value, NativeError> {
        let (object, index) = (self.val(f, object).clone(), self.val(f, index).clone());
        self.item_of(code, &object, &index)
    }

    /// Evaluates `object[index]`.
    fn item_of(
        &mut self,
        code: &Arc<MachineCode>,
        object: &Value,
        index: &Value,
    ) -> Result<Value, NativeError> {
        match object {
            Value::List(_) | Value::View(_) | Value::String(_) => {
                let x = index_of(index);
                match whole_index(x) {
                    Some(i) => Ok(match object {
                        Value::View(view) => self.env(code).view_item(*view, i),
                        Value::String(text) => {
                            let unit = text.encode_utf16().nth(i);
                            match unit {
                                Some(unit) => Value::String(natives::whole(&[unit])?.into()),
                                None => Value::Undefined,
                            }
                        }
                        _ => self.context.heap.item(object, i).unwrap_or_default(),
                    }),
                    None => match index {
                        Value::String(name) => self.member(code, object, &name.clone()),
                        _ => Ok(Value::Undefined),
                    },
                }
            }
            _ => {
                let name = self.env(code).text(index)?;
                self.member(code, object, &name)
            }
        }
    }

    /// Evaluates `object.name`.
    fn member(&mut self, code: &Arc<MachineCode>, object: &Value, name: &str) -> Result<Value, NativeError> {
        match object {
            Value::Undefined | Value::Null => Err(NativeError::new(
                rules::NO_PARTS,
                format!("`{name}` of {object} was read before anything stored it"),
            )),
            Value::Record(_) => Ok(self.context.heap.get(object, name).unwrap_or_default()),
            Value::String(text) if name == "length" => Ok(Value::Number(text.encode_utf16().count() as f64)),
            Value::List(_) | Value::View(_) if name == "length" => {
                Ok(Value::Number(self.env(code).len(object) as f64))
            }
            _ => Ok(Value::Undefined),
        }
    }

    /// Executes `object[index] = value`.
    fn store_item(
        &mut self,
        code: &Arc<MachineCode>,
        object: &Value,
        index: &Value,
        value: Value,
    ) -> Result<(), NativeError> {
        match object {
            Value::View(view) => {
                let x = self.env(code).number(&value)?;
                self.store_in_view(code, *view, index, x)
            }
            Value::List(_) => {
                let Some(i) = whole_index(index_of(index)) else { return Ok(()) };
                let typed = matches!(self.context.heap.object(object), HeapObject::Numbers(..));
                let x = if typed { self.env(code).number(&value)? } else { 0.0 };
                let n = self.context.heap.len(object).unwrap_or(0);
                if !typed && i >= n {
                    // As in JavaScript, an assignment can extend a list; holes become `undefined`.
                    if i - n > 1_000_000 {
                        return Err(NativeError::new(
                            rules::MEMORY,
                            format!("element {i} of a list of {n} elements"),
                        ));
                    }
                    self.env(code).spend(i - n)?;
                    for _ in n..=i {
                        self.context.heap.grow(&Value::Undefined)?;
                    }
                }
                self.context.heap.grow(&value)?;
                match self.context.heap.object_mut(object) {
                    Some(HeapObject::List(items)) => {
                        if i >= items.len() {
                            items.resize(i + 1, Value::Undefined);
                        }
                        if let Some(place) = items.get_mut(i) {
                            *place = value;
                        }
                    }
                    Some(HeapObject::Numbers(items, elem)) => {
                        if let Some(place) = items.get_mut(i) {
                            *place = elem.keep(x);
                        }
                    }
                    _ => {}
                }
                Ok(())
            }
            _ => {
                let name = self.env(code).text(index)?;
                self.store_member(code, object, name.into(), value)
            }
        }
    }

    fn store_in_view(
        &mut self,
        code: &Arc<MachineCode>,
        view: View,
        index: &Value,
        x: f64,
    ) -> Result<(), NativeError> {
        match whole_index(index_of(index)) {
            Some(i) => self.env(code).view_store(view, i, x),
            None => Ok(()),
        }
    }

    /// Executes `object.name = value`.
    fn store_member(
        &mut self,
        code: &Arc<MachineCode>,
        object: &Value,
        name: Arc<str>,
        value: Value,
    ) -> Result<(), NativeError> {
        match object {
            Value::Record(_) => self.put_member(object, name, value),
            Value::List(_) if *name == *"length" => {
                let n = self.env(code).number(&value)?;
                if let Some(HeapObject::List(items)) = self.context.heap.object_mut(object) {
                    // The length can only be reduced: a list of holes has no use.
                    items.truncate(n.clamp(0.0, 1e9) as usize);
                }
                Ok(())
            }
            other => {
                let what = describe(other, self.context.heap.object(other));
                Err(NativeError::new(
                    rules::NO_PARTS,
                    format!("`{name}` of {what} was assigned, but it has no members"),
                ))
            }
        }
    }
}

/// A description of a value for a message.
pub(super) fn describe(value: &Value, object: &HeapObject) -> String {
    match (value, object) {
        (Value::Undefined | Value::Null, _) => value.to_string(),
        _ => value.type_of().describe().to_owned(),
    }
}
