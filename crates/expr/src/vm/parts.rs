//! Operations on lists, records and functions.

use std::sync::Arc;

use super::machine::{Frame, Machine, Stop, index_of, taken, what, whole_index};
use crate::code::{Code, CodeUnit};
use crate::heap::Object;
use crate::ir::{MethodId, Picks};
use crate::natives::{self, Trouble};
use crate::rules;
use crate::ssa::{Args, Op, Slot, Val};
use crate::value::{Value, View};

impl Machine<'_> {
    pub(super) fn part(&mut self, op: Op, code: &Arc<Code>, unit: &CodeUnit, f: Frame) -> Result<(), Stop> {
        self.tidy();
        match op {
            Op::MathOver(dst, function, list) => {
                let list = self.val(f, list).clone();
                let mut env = self.env(code);
                let items = env.spread(&list)?;
                let mut numbers = Vec::with_capacity(items.len());
                for item in &items {
                    numbers.push(env.number(item)?);
                }
                self.put(f, dst, function.apply(&numbers));
            }
            Op::List(dst, items) => {
                let items = self.all(items, unit, f);
                let list = self.context.heap.list(items)?;
                self.put_value(f, dst, list);
            }
            Op::Append(list, item, spread) => {
                let (list, item) = (self.val(f, list).clone(), self.val(f, item).clone());
                let mut env = self.env(code);
                let items = if spread { env.spread(&item)? } else { vec![item] };
                for item in &items {
                    env.heap.grow(item)?;
                }
                if let Some(Object::List(all)) = env.heap.object_mut(&list) {
                    all.extend(items);
                }
            }
            Op::NewRecord(dst) => {
                let record = self.context.heap.record(Vec::new())?;
                self.put_value(f, dst, record);
            }
            Op::Put(record, key, value) => {
                let (record, value) = (self.val(f, record).clone(), self.val(f, value).clone());
                let key = self.key(code, f, key)?;
                self.put_member(&record, key, value)?;
            }
            Op::PutAll(record, from) => {
                let (record, from) = (self.val(f, record).clone(), self.val(f, from).clone());
                let entries = match self.context.heap.object(&from) {
                    Object::Record(entries) => entries.clone(),
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
            }
            Op::Element(dst, object, index) => {
                let value = self.item(code, f, object, index)?;
                self.put_value(f, dst, value);
            }
            Op::ElementAt(dst, object, index) => {
                let x = self.num(f, index);
                let object = self.val(f, object);
                let value = match object {
                    Value::List(_) => match self.context.heap.object(object) {
                        Object::List(items) => {
                            whole_index(x).and_then(|i| items.get(i).cloned()).unwrap_or_default()
                        }
                        Object::Numbers(items, _) => whole_index(x)
                            .and_then(|i| items.get(i))
                            .map_or(Value::Undefined, |x| Value::Number(*x)),
                        _ => Value::Undefined,
                    },
                    _ => {
                        let object = object.clone();
                        self.item_of(code, &object, &Value::Number(x))?
                    }
                };
                self.put_value(f, dst, value);
            }
            Op::Member(dst, object, name) => {
                let name = code.form.texts.get(name as usize).cloned().unwrap_or_else(|| "".into());
                let object = self.val(f, object).clone();
                let value = self.member(code, &object, &name)?;
                self.put_value(f, dst, value);
            }
            Op::StoreItem(object, index, value, _) => {
                let (object, index) = (self.val(f, object).clone(), self.val(f, index).clone());
                let value = self.val(f, value).clone();
                self.store_item(code, &object, &index, value)?;
            }
            Op::StoreMember(object, name, value, _) => {
                let name = code.form.texts.get(name as usize).cloned().unwrap_or_else(|| "".into());
                let (object, value) = (self.val(f, object).clone(), self.val(f, value).clone());
                self.store_member(code, &object, name, value)?;
            }
            Op::Method(dst, name, args) => {
                let args = self.all(args, unit, f);
                let Some((receiver, args)) = args.split_first() else { return Ok(()) };
                let value = self.method(code, unit, f, name, receiver, args)?;
                self.put_value(f, dst, value);
            }
            Op::MethodList(dst, name, receiver, list) => {
                let (receiver, list) = (self.val(f, receiver).clone(), self.val(f, list).clone());
                let args = self.env(code).items(&list)?;
                let value = self.method(code, unit, f, name, &receiver, &args)?;
                self.put_value(f, dst, value);
            }
            Op::Native(dst, function, args) => {
                let args = self.all(args, unit, f);
                let value = natives::call_free(&mut self.env(code), function, &args)?;
                self.put_value(f, dst, value);
            }
            Op::NativeList(dst, function, list) => {
                let list = self.val(f, list).clone();
                let mut env = self.env(code);
                let args = env.items(&list)?;
                let value = natives::call_free(&mut env, function, &args)?;
                self.put_value(f, dst, value);
            }
            Op::Closure(dst, callee, captures) => {
                let captures = self.all(captures, unit, f);
                let value = self.context.heap.closure(code.clone(), callee, captures)?;
                self.put_value(f, dst, value);
            }
            Op::Invoke(dst, callee, args) => {
                let (callee, args) = (self.val(f, callee).clone(), self.all(args, unit, f));
                let value = self.invoke_with(unit, f, &callee, &args)?;
                self.put_value(f, dst, value);
            }
            Op::InvokeList(dst, callee, list) => {
                let (callee, list) = (self.val(f, callee).clone(), self.val(f, list).clone());
                let args = self.env(code).items(&list)?;
                let value = self.invoke_with(unit, f, &callee, &args)?;
                self.put_value(f, dst, value);
            }
            Op::NewCell(dst, src) => {
                let value = self.val(f, src).clone();
                let cell = self.context.heap.cell(Some(value))?;
                self.put_value(f, dst, cell);
            }
            Op::EmptyCell(dst) => {
                let cell = self.context.heap.cell(None)?;
                self.put_value(f, dst, cell);
            }
            Op::CellGet(dst, cell) => {
                let value = match self.context.heap.object(self.val(f, cell)) {
                    Object::Cell(Some(value)) => value.clone(),
                    _ => return Err(too_early().into()),
                };
                self.put_value(f, dst, value);
            }
            Op::CellSet(cell, src, declares) => {
                let (cell, value) = (self.val(f, cell).clone(), self.val(f, src).clone());
                match self.context.heap.object_mut(&cell) {
                    Some(Object::Cell(place)) if declares || place.is_some() => *place = Some(value),
                    _ => return Err(too_early().into()),
                }
            }
            Op::Pick(dst, table, name) => {
                let value = self.pick(code, f, table, name)?;
                self.put_value(f, dst, value);
            }
            Op::PickNumber(dst, table, name) => {
                let x = match self.pick(code, f, table, name)? {
                    Value::View(view) => self.host.get(view.field, view.first as usize).unwrap_or(f64::NAN),
                    other => other.to_number(),
                };
                self.put(f, dst, x);
            }
            _ => {} // see `execute` and `step`
        }
        Ok(())
    }

    /// The values of a list of operands.
    fn all(&self, args: Args, unit: &CodeUnit, f: Frame) -> Vec<Value> {
        args.of(&unit.args).iter().map(|a| self.val(f, Val(*a)).clone()).collect()
    }

    /// What belongs to the object of a computed name.
    fn pick(&mut self, code: &Arc<Code>, f: Frame, table: u32, name: Val) -> Result<Value, Trouble> {
        let name = self.val(f, name).clone();
        let name = self.env(code).text(&name)?;
        let Some(picks) = code.form.picks.get(table as usize) else { return Ok(Value::Undefined) };
        let Picks { noun, of, .. } = &**picks;
        match of.binary_search_by(|(n, _)| (**n).cmp(&name)) {
            Ok(at) => Ok(of.get(at).map(|(_, v)| v.clone()).unwrap_or_default()),
            Err(_) => {
                let near = labspec_finding::nearest(&name, of.iter().map(|(n, _)| &**n));
                let meant = near.map(|n| format!("; did you mean \"{n}\"?")).unwrap_or_default();
                Err(Trouble::new(
                    rules::UNKNOWN_OBJECT,
                    format!("there is no {noun} named \"{name}\"{meant}"),
                ))
            }
        }
    }

    fn key(&mut self, code: &Arc<Code>, f: Frame, key: Val) -> Result<Arc<str>, Trouble> {
        match self.val(f, key) {
            Value::String(text) => Ok(text.clone()),
            other => {
                let other = other.clone();
                Ok(self.env(code).text(&other)?.into())
            }
        }
    }

    fn put_member(&mut self, record: &Value, key: Arc<str>, value: Value) -> Result<(), Trouble> {
        self.context.heap.grow(&value)?;
        if let Some(Object::Record(entries)) = self.context.heap.object_mut(record) {
            match entries.iter_mut().find(|(k, _)| *k == key) {
                Some((_, place)) => *place = value,
                None => entries.push((key, value)),
            }
        }
        Ok(())
    }

    fn item(&mut self, code: &Arc<Code>, f: Frame, object: Val, index: Val) -> Result<Value, Trouble> {
        let (object, index) = (self.val(f, object).clone(), self.val(f, index).clone());
        self.item_of(code, &object, &index)
    }

    /// `object[index]`
    fn item_of(&mut self, code: &Arc<Code>, object: &Value, index: &Value) -> Result<Value, Trouble> {
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

    /// `object.name`
    fn member(&mut self, code: &Arc<Code>, object: &Value, name: &str) -> Result<Value, Trouble> {
        match object {
            Value::Undefined | Value::Null => Err(Trouble::new(
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

    /// `object[index] = value`
    fn store_item(
        &mut self,
        code: &Arc<Code>,
        object: &Value,
        index: &Value,
        value: Value,
    ) -> Result<(), Trouble> {
        match object {
            Value::View(view) => {
                let x = self.env(code).number(&value)?;
                self.store_in_view(code, *view, index, x)
            }
            Value::List(_) => {
                let Some(i) = whole_index(index_of(index)) else { return Ok(()) };
                let typed = matches!(self.context.heap.object(object), Object::Numbers(..));
                let x = if typed { self.env(code).number(&value)? } else { 0.0 };
                let n = self.context.heap.len(object).unwrap_or(0);
                if !typed && i >= n {
                    // JavaScript lets a list grow by an assignment; holes become `undefined`.
                    if i - n > 1_000_000 {
                        return Err(Trouble::new(
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
                    Some(Object::List(items)) => {
                        if i >= items.len() {
                            items.resize(i + 1, Value::Undefined);
                        }
                        if let Some(place) = items.get_mut(i) {
                            *place = value;
                        }
                    }
                    Some(Object::Numbers(items, elem)) => {
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

    fn store_in_view(&mut self, code: &Arc<Code>, view: View, index: &Value, x: f64) -> Result<(), Trouble> {
        match whole_index(index_of(index)) {
            Some(i) => self.env(code).view_store(view, i, x),
            None => Ok(()),
        }
    }

    /// `object.name = value`
    fn store_member(
        &mut self,
        code: &Arc<Code>,
        object: &Value,
        name: Arc<str>,
        value: Value,
    ) -> Result<(), Trouble> {
        match object {
            Value::Record(_) => self.put_member(object, name, value),
            Value::List(_) if *name == *"length" => {
                let n = self.env(code).number(&value)?;
                if let Some(Object::List(items)) = self.context.heap.object_mut(object) {
                    // Only shorter: a list of holes is of no use.
                    items.truncate(n.clamp(0.0, 1e9) as usize);
                }
                Ok(())
            }
            other => {
                let what = what(other, self.context.heap.object(other));
                Err(Trouble::new(
                    rules::NO_PARTS,
                    format!("`{name}` of {what} was assigned, but it has no members"),
                ))
            }
        }
    }

    /// `receiver.name(args)`: a method, or a function that a record holds.
    fn method(
        &mut self,
        code: &Arc<Code>,
        unit: &CodeUnit,
        f: Frame,
        name: MethodId,
        receiver: &Value,
        args: &[Value],
    ) -> Result<Value, Stop> {
        if let Value::Record(_) = receiver
            && let Some(function @ Value::Function(_)) = self.context.heap.get(receiver, name.text())
        {
            return self.invoke_with(unit, f, &function, args);
        }
        Ok(natives::call(&mut self.env(code), name, receiver, args)?)
    }

    /// Calls whatever function a value is.
    fn invoke_with(
        &mut self,
        unit: &CodeUnit,
        f: Frame,
        callee: &Value,
        args: &[Value],
    ) -> Result<Value, Stop> {
        let (code, at, captures) = match self.context.heap.object(callee) {
            Object::Closure { code, unit, captures } => (code.clone(), *unit, captures.clone()),
            object => {
                let message = format!("{} is called but is not a function", what(callee, object));
                return Err(Trouble::new(rules::NOT_CALLABLE, message).into());
            }
        };
        let Some(function) = code.units.get(at as usize) else { return Ok(Value::Undefined) };
        self.enter(function)?;
        let frame = Frame { n: f.n + unit.number_count as usize, v: f.v + unit.value_count as usize };
        self.make_room(function, frame);
        let (mut n, mut v) = (frame.n + 1, frame.v + 1);
        let params =
            function.params.iter().enumerate().map(|(i, s)| (s, args.get(i).cloned().unwrap_or_default()));
        let captured = function.captures.iter().zip(captures);
        for (slot, value) in params.chain(captured) {
            match slot {
                Slot::Value => {
                    self.context.values[v] = value;
                    v += 1;
                }
                Slot::Number | Slot::Boolean => {
                    self.context.numbers[n] = value.to_number();
                    n += 1;
                }
            }
        }
        let result = self.execute(&code, function, frame);
        self.depth -= 1;
        result.map_err(Stop::Inside)?;
        Ok(taken(function.result, self.context.numbers.get(frame.n), self.context.values.get(frame.v)))
    }
}

fn too_early() -> Trouble {
    Trouble::new(rules::USED_TOO_EARLY, "a name is used before its declaration runs")
}
