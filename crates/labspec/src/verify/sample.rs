//! A sample of a simulation, real or imagined.

use crate::run::Session;
use crate::source::Text;
use labspec_expr::{Context, Program, Value};

/// The input of a measure: a real or imagined simulation at one sample.
pub(super) trait Sample {
    /// Time of the sample, s.
    fn time(&self) -> f64;

    /// The context in which programs run.
    fn context(&mut self) -> &mut Context;

    /// The value of a program; `None` where it throws.
    fn evaluate(&mut self, program: &Program, text: &Text) -> Option<Value>;
}

impl Sample for Session<'_> {
    fn time(&self) -> f64 {
        self.world.data.time()
    }

    fn context(&mut self) -> &mut Context {
        &mut self.context
    }

    fn evaluate(&mut self, program: &Program, text: &Text) -> Option<Value> {
        Session::evaluate(self, program, text)
    }
}
