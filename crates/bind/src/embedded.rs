//! Functions of the embedding program, from numbers to a number.

use crate::Error;
use crate::functions::{self, is_taken};
use labspec_expr::{
    AccessedFields, CollectionId, Compiler, Entry, FunctionId, FunctionInfo, Globals, ObjectId, Param,
    ResultDimension, Schema, Type, Value,
};
use std::fmt;
use std::sync::Arc;

/// The cost of a call, in units of about a nanosecond. The actual cost of such a function is unknown.
pub(crate) const PRICE: u64 = 200;

/// Functions by name, called as `name(x, y)`. They depend only on their arguments, not on the simulation, so that no plan
/// depends on them. For the same arguments they should return the same number.
#[derive(Clone, Default)]
pub struct Functions(Arc<Vec<EmbeddedFunction>>);

#[derive(Clone)]
struct EmbeddedFunction {
    name: String,
    params: usize,
    doc: String,
    call: Call,
}

type Call = Arc<dyn Fn(&[f64]) -> Result<f64, String> + Send + Sync>;

impl Functions {
    /// Returns an empty set of functions.
    pub fn new() -> Functions {
        Functions::default()
    }

    /// Adds a function: its name, the number of its arguments, a line of documentation, and its implementation. An error of the
    /// implementation is a sentence for the author of the program text.
    ///
    /// # Errors
    /// The name cannot be called in a program text, or it already has a meaning.
    pub fn with(
        mut self,
        name: &str,
        params: usize,
        doc: &str,
        call: impl Fn(&[f64]) -> Result<f64, String> + Send + Sync + 'static,
    ) -> Result<Functions, Error> {
        if self.find(name).is_some() || is_taken(name) {
            return Err(Error::Call(format!("`{name}` already has a meaning")));
        }
        let index = self.0.len() as u32;
        let function =
            EmbeddedFunction { name: name.to_string(), params, doc: doc.to_string(), call: Arc::new(call) };
        Arc::make_mut(&mut self.0).push(function);
        // The compiler of the language decides whether a text can call it.
        let text = format!("{name}({})", vec!["0"; params].join(", "));
        let (names, mut globals) = (FunctionSchema(&self), Globals::new());
        // `value` is a name of the language if there is a control.
        let mut compiler = Compiler::new(&names, &mut globals).with_value(Some(Type::Number));
        let program = compiler.expression(&text).program;
        match program.is_some_and(|p| p.effects().calls.contains(&FunctionId(index))) {
            true => Ok(self),
            false => Err(Error::Call(format!("`{name}` is not a valid name for a function"))),
        }
    }

    /// Returns the index of the function with this name.
    pub(crate) fn find(&self, name: &str) -> Option<usize> {
        self.0.iter().position(|f| f.name == name)
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|f| f.name.as_str())
    }

    /// Returns the signature and the effects of a function.
    pub(crate) fn info(&self, index: usize) -> Option<FunctionInfo> {
        let function = self.0.get(index)?;
        Some(FunctionInfo {
            name: function.name.clone(),
            params: vec![Param::Number; function.params],
            optional: 0,
            implied: false,
            returns: Type::Number,
            members: Vec::new(),
            length: None,
            aggregate: false,
            reads: AccessedFields::Nothing,
            writes: AccessedFields::Nothing,
            gives: ResultDimension::Unknown,
            doc: function.doc.clone(),
        })
    }

    /// Calls a free function.
    pub(crate) fn call(&self, index: usize, args: &[Value]) -> Option<Result<Value, String>> {
        let function = self.0.get(index)?;
        let numbers: Vec<f64> = args.iter().map(Value::to_number).collect();
        Some((function.call)(&numbers).map(Value::Number))
    }
}

/// A schema that contains only these functions.
struct FunctionSchema<'f>(&'f Functions);

impl Schema for FunctionSchema<'_> {
    fn root(&self, name: &str) -> Option<Entry> {
        Some(Entry::Function(FunctionId(self.0.find(name)? as u32)))
    }

    fn root_names(&self) -> Vec<String> {
        Vec::new()
    }

    fn member(&self, _: ObjectId, _: &str) -> Option<Entry> {
        None
    }

    fn member_names(&self, _: ObjectId) -> Vec<String> {
        Vec::new()
    }

    fn describe(&self, _: ObjectId) -> String {
        String::new()
    }

    fn lookup(&self, _: CollectionId, _: &str) -> Option<ObjectId> {
        None
    }

    fn names(&self, _: CollectionId) -> Vec<String> {
        Vec::new()
    }

    fn noun(&self, _: CollectionId) -> &str {
        ""
    }

    fn function(&self, FunctionId(f): FunctionId) -> FunctionInfo {
        self.0.info(f as usize).unwrap_or_else(functions::none)
    }
}

impl fmt::Debug for Functions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half() -> Functions {
        Functions::new().with("half", 1, "the half", |x| Ok(0.5 * x.iter().sum::<f64>())).unwrap()
    }

    #[test]
    fn reserved_and_invalid_names_are_refused() {
        for name in [
            "half",
            "model",
            "data",
            "mj",
            "contact",
            "mj_setConst",
            "Math",
            "NaN",
            "value",
            "ctx",
            "isNaN",
            "if",
            "function",
            "new",
            "",
            "a b",
            "a.b",
            "1a",
            "f(1) + f",
            "x => x; f",
            "é ",
        ] {
            let error = half().with(name, 1, "", |_| Ok(0.0)).unwrap_err();
            assert!(error.to_string().contains(&format!("`{name}`")), "{name}: {error}");
        }
    }

    #[test]
    fn texts_call_them_with_as_many_numbers_as_they_take() {
        let functions = half().with("sum", 3, "", |x| Ok(x.iter().sum())).unwrap();
        let functions = functions.with("fails", 0, "", |_| Err("the sensor is unplugged".into())).unwrap();
        let mut engine = crate::Engine::compile("<mujoco/>").unwrap().with_functions(functions);
        let sum = engine.expression("sum(half(3), data.time, '2')");
        assert!(sum.is_err(), "a text is no number");
        let sum = engine.expression("sum(half(3), data.time, true)").unwrap();
        assert_eq!(sum.number(&mut engine), Ok(2.5));
        for (text, what) in [("half()", "half"), ("half(1, 2)", "half"), ("hlaf(1)", "did you mean `half`?")]
        {
            let error = engine.expression(text).unwrap_err().to_string();
            assert!(error.contains(what), "{text}: {error}");
        }
        let fails = engine.statements("fails()").unwrap();
        assert!(fails.run(&mut engine).unwrap_err().to_string().contains("unplugged"));
    }
}
