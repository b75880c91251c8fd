//! Labs at their start, to display values before the first step.

use labspec::bind::dimension_of;
use labspec::bind::scene::Models;
use labspec::bind::{ModelNames, Programs, Scope};
use labspec::finding::Finding;
use labspec::run::{Budget, Session, Start};
use labspec::source::{SourceMap, Text};
use labspec::spec::Lab;
use labspec_bind::units::written;
use labspec_core::{AccessSet, Model, Plan};
use labspec_expr::{Compiler, Type};
use std::sync::Arc;

/// The work limit to start a lab, in units of about a nanosecond, so that a user does not have to wait.
const WORK: Budget = Budget { left: 20_000_000 };
/// The maximum number of cached labs.
const MOST: usize = 8;
/// The maximum number of displayed elements of an array.
const MOST_ELEMENTS: usize = 9;

/// A lab at its start.
#[derive(Debug)]
pub(crate) struct StartedLab {
    /// The text of the lab.
    key: String,
    pub(crate) model: Arc<Model>,
    session: Session<'static>,
}

/// The labs into which a user pointed last.
#[derive(Debug, Default)]
pub(crate) struct StartedLabs(Vec<StartedLab>);

impl StartedLabs {
    /// Returns a lab, started if necessary, or `None` if its model does not exist or has errors.
    pub(crate) fn start(&mut self, models: &Models, lab: &Lab, key: &str) -> Option<&StartedLab> {
        if let Some(index) = self.0.iter().position(|s| s.key == key) {
            return self.0.get(index);
        }
        let model = models.model_of_lab(lab, &mut Vec::<Finding>::new())?;
        let programs = Arc::new(Programs::compile(lab, &model, &mut Vec::new()));
        let plan = Some(Plan::new(&model, &AccessSet::ANY));
        let start = Start { key: lab.keyframe(), plan, budget: WORK };
        let session = Session::start(programs, &model, start);
        if self.0.len() >= MOST {
            self.0.remove(0);
        }
        self.0.push(StartedLab { key: key.to_string(), model, session });
        self.0.last()
    }
}

/// The value of an expression at the start of the lab as text, or `None` if it is invalid or exceeds its work limit.
pub(crate) fn value(started: &StartedLab, code: &str) -> Option<String> {
    let mut session = started.session.clone();
    if session.ended().is_some() {
        return None;
    }
    match evaluate(&mut session, &started.model, code) {
        Some((Type::View | Type::List, _)) | None => elements(&mut session, &started.model, code),
        Some((Type::Record | Type::Function | Type::Undefined, _)) => None,
        Some((_, text)) => Some(text),
    }
}

/// The unit of an expression, or `None` if it is uncertain or the expression is dimensionless.
pub(crate) fn unit(started: &StartedLab, lab: &Lab, code: &str) -> Option<String> {
    let dimension = dimension_of(lab, &started.model, started.session.programs(), code)?;
    // A literal number may have any dimension.
    (!dimension.is_number() && !dimension.factor.is_nan()).then(|| written(&dimension))
}

/// The first elements of an array, because an array alone is not a valid expression.
fn elements(session: &mut Session<'static>, model: &Model, code: &str) -> Option<String> {
    let mut text = |code: String| evaluate(session, model, &code).map(|(_, text)| text);
    let count: usize = text(format!("({code}).length"))?.parse().ok()?;
    let first = text(format!("({code}).slice(0, {MOST_ELEMENTS}).join(', ')"))?;
    Some(if count > MOST_ELEMENTS { format!("[{first}, … {count} in all]") } else { format!("[{first}]") })
}

fn evaluate(session: &mut Session<'static>, model: &Model, code: &str) -> Option<(Type, String)> {
    let names = ModelNames::new(model, Scope::Lab);
    let mut globals = session.programs().globals.clone();
    let program = Compiler::new(&names, &mut globals).expression(code).program?;
    let text = Text { value: code.to_string(), map: SourceMap::point(0) };
    let value = session.evaluate(&program, &text)?;
    Some((value.type_of(), value.to_string()))
}
