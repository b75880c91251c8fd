//! A sample of a simulation, real or imagined.

use crate::run::Session;
use crate::source::Text;
use labspec_expr::{Context, Program, Value};

/// What a measure looks at: a simulation, sample after sample.
pub(super) trait Sample {
    /// Time of the sample, s.
    fn time(&self) -> f64;

    /// What programs run in.
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
