//! The engine as the language's host: fields are read and written by id and flat index, functions called by number.

use super::embedded;
use super::functions;
use super::world::World;
use labspec_core as core;
use labspec_core::reflect::{self, Elem, FieldId, Object, model, option};
use labspec_expr::{FieldKey, FunctionId, Heap, Host, Value};

impl Host for World {
    #[inline]
    fn get(&self, FieldKey(f): FieldKey, index: usize) -> Option<f64> {
        match FieldId::new(f as usize) {
            Some(field) => core::element(&self.model, &self.data, field, index),
            None => self.numbers.get(index).copied(),
        }
    }

    fn set(&mut self, FieldKey(f): FieldKey, index: usize, value: f64) -> Result<(), String> {
        let field = FieldId::new(f as usize).ok_or("the field does not exist")?;
        check_write(field, value)?;
        // Writing the same value is not a change of the model, which would require a new plan.
        let same = |held: f64| held.to_bits() == value.to_bits();
        if field.info().object != Object::Data
            && reflect::is_writable(field)
            && core::element(&self.model, &self.data, field, index).is_some_and(same)
        {
            return Ok(());
        }
        match core::view_mut(&mut self.model, &mut self.data, field)?.set(index, value) {
            true => Ok(()),
            false => Err(format!("`{}` has no element {index} to set", field.info().name)),
        }
    }

    fn len(&self, FieldKey(f): FieldKey) -> usize {
        FieldId::new(f as usize).map_or(self.numbers.len(), |f| core::length(&self.model, &self.data, f))
    }

    fn call(&mut self, heap: &mut Heap, FunctionId(f): FunctionId, args: &[Value]) -> Result<Value, String> {
        match functions::TABLE.get(f as usize) {
            Some(function) => {
                let before = core::cost(&self.data);
                let result = functions::access::call(function.run, self, heap, args);
                // Passes of the engine have already added their cost.
                let price = if core::cost(&self.data) == before { call_cost(function, self) } else { 0 };
                core::charge(&mut self.data, price);
                result
            }
            None => {
                core::charge(&mut self.data, embedded::PRICE);
                let called = (f as usize)
                    .checked_sub(functions::TABLE.len())
                    .and_then(|index| self.functions.call(index, args));
                called.unwrap_or_else(|| Err("the function does not exist".into()))
            }
        }
    }

    fn identity(&self) -> u64 {
        self.model.identity()
    }

    fn work(&self) -> u64 {
        core::cost(&self.data)
    }
}

/// The cost of a call that does not run a pass of the engine, in the unit of [`labspec_core::cost`].
fn call_cost(f: &functions::Function, w: &World) -> u64 {
    let (nv, ncon) = (w.model.nv as u64, w.data.fields().contact.len() as u64);
    let reads = match f.reads {
        functions::AccessedPart::Contacts => 50 * ncon,
        functions::AccessedPart::Derived => labspec_core::cost_of_pass(&w.data),
        functions::AccessedPart::Mass => 4 * nv * nv,
        functions::AccessedPart::Motion => 100 * nv,
        _ => 0,
    };
    let writes = if f.writes.is_empty() { 0 } else { labspec_core::cost_of_pass(&w.data) };
    50 + reads + writes
}

/// Refuses values that have no meaning for the engine.
fn check_write(field: FieldId, value: f64) -> Result<(), String> {
    let refused = |reason: &str| Err(format!("`{}` cannot be {value}: {reason}", field.info().name));
    let is = |allowed: &[i32]| allowed.iter().any(|&a| f64::from(a) == value);
    // As in JavaScript, a flag stores a byte; here the byte must be 0 or 1.
    let byte = if value.is_finite() { value.trunc().rem_euclid(256.0) } else { 0.0 };
    match field {
        _ if field.info().elem == Elem::Bool && byte > 1.0 => refused("0 is off, 1 is on"),
        option::timestep if !(value > 0.0 && value.is_finite()) => {
            Err(format!("the timestep must be greater than 0, not {value}"))
        }
        option::integrator if !is(&[0, 1, 2, 3, 4]) => {
            refused("0 is Euler, 1 RK4, 2 implicit, 3 implicitfast, 4 discrete")
        }
        option::cone if !is(&[0, 1]) => refused("0 is pyramidal, 1 elliptic"),
        option::solver if !is(&[0, 1, 2]) => refused("0 is PGS, 1 CG, 2 Newton"),
        model::geom_condim if !is(&[1, 3, 4, 6]) => {
            refused("1 is frictionless, 3 slides, 4 also twists, 6 also rolls")
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use crate::Engine;

    /// A double, an integer and a flag convert values as JavaScript's typed arrays do, except that flags
    /// accept only the bytes 0 and 1.
    #[test]
    fn fields_store_the_values_that_typed_arrays_store() {
        let mjcf = "<mujoco><worldbody><body name='a'><freejoint/><geom size='1'/></body></worldbody>
            <equality><weld body1='a'/></equality></mujoco>";
        let after = |field: &str, value: &str| {
            let mut engine = Engine::compile(mjcf).unwrap();
            let stored = engine.statements(&format!("ctx.v = {value}; {field} = ctx.v")).unwrap();
            stored.run(&mut engine).map_err(|e| e.to_string())?;
            let read = engine.expression(field).unwrap().number(&mut engine).unwrap();
            Ok::<f64, String>(read)
        };
        let table: [(&str, f64, f64, Option<f64>); 14] = [
            ("true", 1.0, 1.0, Some(1.0)),
            ("null", 0.0, 0.0, Some(0.0)),
            ("undefined", f64::NAN, 0.0, Some(0.0)),
            ("'5'", 5.0, 5.0, None),
            ("'x'", f64::NAN, 0.0, Some(0.0)),
            ("[2]", 2.0, 2.0, None),
            ("{a: 1}", f64::NAN, 0.0, Some(0.0)),
            ("() => 1", f64::NAN, 0.0, Some(0.0)),
            ("2.7", 2.7, 2.0, None),
            ("-2.7", -2.7, -2.0, None),
            ("2 ** 31", 2147483648.0, -2147483648.0, Some(0.0)),
            ("257", 257.0, 257.0, Some(1.0)),
            ("-1", -1.0, -1.0, None),
            ("1e400", f64::INFINITY, 0.0, Some(0.0)),
        ];
        for (value, double, int, flag) in table {
            let same = |a: Result<f64, String>, b: f64| a.is_ok_and(|a| a == b || a.is_nan() && b.is_nan());
            assert!(same(after("data.qpos[0]", value), double), "{value}");
            assert!(same(after("model.geom_contype[0]", value), int), "{value}");
            assert!(same(after("model.opt.iterations", value), int), "{value}");
            match flag {
                Some(flag) => assert!(same(after("data.eq_active[0]", value), flag), "{value}"),
                None => {
                    let error = after("data.eq_active[0]", value).unwrap_err();
                    assert!(error.contains("`eq_active` cannot be") && error.contains("0 is off"), "{error}");
                }
            }
        }
    }
}
