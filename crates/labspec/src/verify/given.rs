//! The numbers that a lesson gives: the settings of its runs, and the numbers of a question.

use super::bound::BoundVerify;
use super::bound_run::{BoundRun, BoundScene};
use super::quote::{OptionNumber, quantities_in};
use crate::bind::given_by;
use crate::json::Scalar;
use crate::source::Text;
use crate::spec::Question;
use labspec_bind::units::parse;
use labspec_expr::dimension::{Dimension, Measure};

/// A number that a text may repeat, with its dimension if that is known.
pub(super) struct GivenNumber {
    pub(super) value: f64,
    pub(super) dimension: Option<Dimension>,
}

impl GivenNumber {
    /// Whether a text states this number, in any unit.
    pub(super) fn is(&self, stated: &OptionNumber) -> bool {
        let number = stated.number();
        let factor = match self.dimension.zip(stated.unit.dimension) {
            Some((of_setting, expected)) if of_setting.agrees(&expected) => {
                expected.factor / of_setting.factor
            }
            Some(_) => return false,
            None => 1.0,
        };
        ((self.value * factor).abs() - number.abs()).abs() <= 1e-6 * number.abs()
    }
}

/// The numbers that a run sets, with the labels of their controls.
pub(super) fn settings_of<'r>(run: &BoundRun<'r>, scene: &BoundScene<'_>) -> Vec<(&'r str, GivenNumber)> {
    let Some(spec) = run.spec else { return Vec::new() };
    let set = spec.set.iter().filter_map(|(label, value)| {
        let Scalar::Number(x) = value else { return None };
        let control = scene.scene.lab.control(label.as_str());
        let dimension = control.and_then(|control| match given_by(control) {
            Measure::Dimension(d) => Some(d),
            _ => None,
        });
        Some((label.as_str(), GivenNumber { value: x.value, dimension }))
    });
    set.collect()
}

/// The numbers of the question and the settings of its runs.
pub(super) fn given_numbers(bound: &BoundVerify<'_>, question: &Question, text: &Text) -> Vec<GivenNumber> {
    let mut all = Vec::new();
    if question.q.span() != text.span() {
        let asked = quantities_in(&question.q.value, bound.stage().languages());
        let middle = |q: OptionNumber| (0.5 * (q.low + q.high), q.unit.dimension);
        let asked = asked.into_iter().map(middle).filter(|(x, _)| x.is_finite());
        all.extend(asked.map(|(value, dimension)| GivenNumber { value, dimension }));
    }
    let time = parse("s");
    for (run, scene) in bound.runs_with_scenes() {
        let Some(spec) = run.spec else { continue };
        all.extend(settings_of(run, scene).into_iter().map(|(_, given)| given));
        let times = spec.until.iter().chain(spec.press.iter().map(|(_, time)| time));
        let times = times.chain(&scene.scene.lab.stop_at);
        all.extend(times.map(|x| GivenNumber { value: x.value, dimension: time }));
    }
    all
}
