//! Expressions and statements for models without a lab.

use crate::data::RawData;
use crate::error::{call_error, thrown};
use crate::model::RawModel;
use crate::value;
use labspec::Error;
use labspec::bind::{ModelNames, Scope};
use labspec::finding::Finding;
use labspec_expr::{Compiler, Context, Globals, Program, Value};
use std::sync::Arc;
use wasm_bindgen::prelude::*;

/// The work limit of one run, in units of about a nanosecond.
const WORK: u64 = 1_000_000_000;

/// Compiled source texts, with the variables that they share.
#[wasm_bindgen]
pub struct RawExpression {
    programs: Vec<Program>,
    context: Context,
}

#[wasm_bindgen]
impl RawExpression {
    /// Compiles expressions, or statements, for a model.
    #[wasm_bindgen(constructor)]
    pub fn new(model: &RawModel, texts: Vec<String>, statements: bool) -> Result<RawExpression, JsValue> {
        let names = ModelNames::new(&model.model, Scope::Lab);
        let mut globals = Globals::new();
        let (mut programs, mut mistakes) = (Vec::new(), Vec::new());
        for (index, text) in texts.iter().enumerate() {
            let mut compiler = Compiler::new(&names, &mut globals);
            let compiled = if statements { compiler.statements(text) } else { compiler.expression(text) };
            match compiled.program {
                Some(program) => programs.push(program),
                None => {
                    let path = path_of(index);
                    let errors = compiled.diagnostics.into_iter().filter(Finding::is_error);
                    mistakes.extend(errors.map(|f| Finding { path: Arc::clone(&path), ..f }));
                }
            }
        }
        if !mistakes.is_empty() {
            return Err(thrown(&Error::Findings(mistakes)));
        }
        Ok(RawExpression { programs, context: Context::for_globals(&globals) })
    }

    /// The value of an expression as a number; NaN if it is not a number.
    pub fn number(&mut self, model: &mut RawModel, data: &mut RawData, index: usize) -> Result<f64, JsValue> {
        model.sync();
        Ok(self.run(model, data, index)?.to_number())
    }

    /// The value of an expression.
    pub fn value(
        &mut self,
        model: &mut RawModel,
        data: &mut RawData,
        index: usize,
    ) -> Result<JsValue, JsValue> {
        model.sync();
        match self.run(model, data, index)? {
            // JSON cannot represent all numbers.
            Value::Number(x) => Ok(JsValue::from_f64(x)),
            other => crate::object(&value(&other)),
        }
    }

    /// The values now and after each of `steps` steps, in column order.
    pub fn record(
        &mut self,
        model: &mut RawModel,
        data: &mut RawData,
        steps: usize,
    ) -> Result<Vec<f64>, JsValue> {
        let rows = steps.saturating_add(1);
        let size = rows.checked_mul(self.programs.len()).filter(|size| *size <= crate::MAX_RECORDED);
        let size = size.ok_or_else(|| {
            call_error("too-long", "these steps are too many to record; record them in parts")
        })?;
        let mut out = vec![f64::NAN; size];
        model.sync();
        for row in 0..rows {
            if row > 0 {
                data.step_once(model)?;
            }
            for index in 0..self.programs.len() {
                out[index * rows + row] = self.run(model, data, index)?.to_number();
            }
        }
        Ok(out)
    }

    fn run(&mut self, model: &mut RawModel, data: &mut RawData, index: usize) -> Result<Value, JsValue> {
        let context = &mut self.context;
        let program = self
            .programs
            .get(index)
            .ok_or_else(|| call_error("unknown-id", "there is no such expression"))?;
        let result = data.with_world(model, |world| {
            labspec_core::limit(&mut world.data, WORK);
            context.allow(WORK);
            let result = program.run(world, context, None);
            labspec_core::limit(&mut world.data, u64::MAX);
            result
        });
        let failed = |rule, span: labspec_expr::Span, message: String| {
            let finding = Finding::error(rule, span.start..span.end, message);
            thrown(&Error::Findings(vec![Finding { path: path_of(index), ..finding }]))
        };
        let found = result.map_err(|e| failed(e.rule, e.span, e.message))?;
        match context.events().iter().find_map(|e| Some((e.rule()?, *e))) {
            Some((rule, event)) => Err(failed(rule, event.span, event.to_string())),
            None => Ok(found),
        }
    }
}

/// The name of a source text in findings.
fn path_of(index: usize) -> Arc<str> {
    Arc::from(if index == 0 { "expression".to_string() } else { format!("expression {}", index + 1) })
}
