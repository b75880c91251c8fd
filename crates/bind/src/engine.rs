//! A model with the accessor language: the shortest way to evaluate an expression in a simulation.

use crate::error::located;
use crate::{Error, Functions, ModelNames, Scope, World};
use labspec_core::{self as core, AccessSet, Data, Model, Plan};
use labspec_expr::{Compiled, Compiler, Context, Globals, Program, Value};
use labspec_finding::Finding;
use std::sync::Arc;

/// The work limit of one run of a program, in units of about a nanosecond.
const WORK: u64 = 1_000_000_000;

/// A model, its data, and the variables of the programs that are compiled for it. A clone continues
/// independently with the same results.
#[derive(Clone, Debug)]
pub struct Engine {
    world: World,
    context: Context,
    globals: Globals,
}

impl Engine {
    /// Compiles a model from MJCF, and sets it to its default configuration.
    ///
    /// # Errors
    /// Returns all errors of the model.
    #[cfg(feature = "mjcf")]
    pub fn compile(xml: &str) -> Result<Engine, Error> {
        let model = core::xml::compile(xml).map_err(|list| findings(list, "model.xml", xml))?;
        Engine::with_model(model)
    }

    /// Creates the engine for a compiled model.
    ///
    /// # Errors
    /// The first forward pass of the model fails.
    pub fn with_model(model: Model) -> Result<Engine, Error> {
        let mut data = Data::planned(&model, Plan::new(&model, &AccessSet::ANY));
        core::forward(&model, &mut data).map_err(refused)?;
        let world = World {
            model,
            data,
            key: None,
            functions: Functions::new(),
            displayed: Vec::new(),
            numbers: Vec::new(),
            playback: None,
        };
        Ok(Engine { world, context: Context::new(), globals: Globals::new() })
    }

    /// Adds functions of the embedding program, which programs that are compiled from now on can call.
    pub fn with_functions(mut self, functions: Functions) -> Engine {
        self.world.functions = functions;
        self
    }

    /// Compiles an expression, and checks names, indexes and types against the model. All programs of an engine
    /// share their `ctx` variables.
    ///
    /// # Errors
    /// Returns all errors of the text.
    pub fn expression(&mut self, text: &str) -> Result<Expression, Error> {
        self.bind(text, "expression", |compiler| compiler.expression(text)).map(Expression)
    }

    /// Compiles statements.
    ///
    /// # Errors
    /// Returns all errors of the text.
    pub fn statements(&mut self, text: &str) -> Result<Statements, Error> {
        self.bind(text, "statements", |compiler| compiler.statements(text)).map(Statements)
    }

    /// Advances the simulation by one timestep.
    ///
    /// # Errors
    /// The engine refuses the step.
    pub fn step(&mut self) -> Result<(), Error> {
        core::step(&self.world.model, &mut self.world.data).map_err(refused)
    }

    /// Computes all fields that depend on the state.
    ///
    /// # Errors
    /// The engine refuses the pass.
    pub fn forward(&mut self) -> Result<(), Error> {
        core::forward(&self.world.model, &mut self.world.data).map_err(refused)
    }

    /// The simulated time in s.
    pub fn time(&self) -> f64 {
        self.world.data.time()
    }

    /// The current model.
    pub fn model(&self) -> &Model {
        &self.world.model
    }

    fn bind(
        &mut self,
        text: &str,
        what: &'static str,
        compile: impl FnOnce(&mut Compiler<'_>) -> Compiled,
    ) -> Result<Accessor, Error> {
        let names = ModelNames::new(&self.world.model, Scope::Lab).with(&self.world.functions);
        // A text with errors must not add variables.
        let mut globals = self.globals.clone();
        let compiled = compile(&mut Compiler::new(&names, &mut globals));
        let Some(program) = compiled.program else { return Err(findings(compiled.diagnostics, what, text)) };
        self.globals = globals;
        Ok(Accessor { program, text: text.into(), what, model: self.world.model.identity() })
    }
}

/// A compiled text, and the identity of its model.
#[derive(Clone, Debug)]
struct Accessor {
    program: Program,
    text: String,
    what: &'static str,
    model: u64,
}

impl Accessor {
    fn run(&self, engine: &mut Engine) -> Result<Value, Error> {
        if self.model != engine.world.model.identity() {
            return Err(Error::Call(format!(
                "`{}` was compiled for another model, so its names and indexes do not apply; compile it with this engine",
                self.text
            )));
        }
        core::limit(&mut engine.world.data, WORK);
        engine.context.allow(WORK);
        let result = self.program.run(&mut engine.world, &mut engine.context, None);
        core::limit(&mut engine.world.data, u64::MAX);
        let failed = |rule, span: labspec_expr::Span, message: String| {
            let finding = Finding::error(rule, span.start..span.end, message);
            findings(vec![finding], self.what, &self.text)
        };
        let value = result.map_err(|e| failed(e.rule, e.span, e.message))?;
        // JavaScript ignores a store past the end, but it is never intended.
        match engine.context.events().iter().find_map(|e| Some((e.rule()?, *e))) {
            Some((rule, event)) => Err(failed(rule, event.span, event.to_string())),
            None => Ok(value),
        }
    }
}

/// A compiled expression.
#[derive(Clone, Debug)]
pub struct Expression(Accessor);

impl Expression {
    /// Returns its current value: a number, a string, a boolean, `null` or `undefined`.
    ///
    /// # Errors
    /// The engine has another model, or the expression fails.
    pub fn value(&self, engine: &mut Engine) -> Result<Value, Error> {
        self.0.run(engine)
    }

    /// Returns its value converted to a number as in JavaScript.
    ///
    /// # Errors
    /// As for [`Expression::value`].
    pub fn number(&self, engine: &mut Engine) -> Result<f64, Error> {
        self.value(engine).map(|value| value.to_number())
    }
}

/// Compiled statements.
#[derive(Clone, Debug)]
pub struct Statements(Accessor);

impl Statements {
    /// Executes the statements once.
    ///
    /// # Errors
    /// The engine has another model, or a statement fails; the statements before it have been executed.
    pub fn run(&self, engine: &mut Engine) -> Result<(), Error> {
        self.0.run(engine).map(drop)
    }
}

fn findings(list: Vec<Finding>, path: &str, text: &str) -> Error {
    let path = Arc::from(path);
    Error::Findings(list.into_iter().filter(Finding::is_error).map(|f| located(f, &path, text)).collect())
}

fn refused(e: core::Error) -> Error {
    Error::Call(e.to_string())
}
