//! The numbers that a lesson gives: the settings of its runs, and the numbers of a question.

use super::bound::BoundVerify;
use super::bound_run::{BoundRun, BoundScene};
use super::quote::{OptionNumber, quantities_in};
use crate::bind::{given_by, scalar};
use crate::json::Scalar;
use crate::language::Languages;
use crate::source::Text;
use crate::spec::{Choice, ControlKind, Question};
use labspec_bind::units::parse;
use labspec_expr::dimension::{Dimension, Measure};
use std::collections::BTreeSet;

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

/// The quantities that a run has where a run of the same `verify` object sets a control, with the labels of the controls: what the run sets,
/// or the start value of the control.
pub(super) fn settings_of<'v>(
    bound: &'v BoundVerify<'_>,
    run: &BoundRun<'_>,
    scene: &'v BoundScene<'_>,
) -> Vec<(&'v str, GivenNumber)> {
    let all = bound.runs.iter().filter_map(|run| run.spec).flat_map(|spec| &spec.set);
    let labels: BTreeSet<&str> = all.map(|(label, _)| label.as_str()).collect();
    let languages = bound.stage().languages();
    let given = labels.into_iter().filter_map(|label| {
        let control = scene.scene.lab.control(label)?;
        let set = run.spec.and_then(|spec| spec.set.iter().find(|(name, _)| name.as_str() == label));
        let number = |value: f64| {
            let dimension = match given_by(control) {
                Measure::Dimension(d) => Some(d),
                _ => None,
            };
            Some((label, GivenNumber { value, dimension }))
        };
        match (set.map(|(_, value)| value), &control.kind) {
            (set, ControlKind::Select { options, value, .. }) => {
                let value = scalar(set.unwrap_or(value)).to_string();
                let is_chosen = |choice: &&Choice| {
                    scalar(&choice.value).to_string() == value || *choice.text.value == *value
                };
                let text = &options.iter().find(is_chosen)?.text.value;
                Some((label, quantity_of(text, languages)?))
            }
            (Some(Scalar::Number(x)), _) => number(x.value),
            (None, ControlKind::Slider { value, .. }) => number(value.value),
            _ => None,
        }
    });
    given.collect()
}

/// The quantity that is the whole text of an option: `0.1 rad`.
fn quantity_of(text: &str, languages: Languages) -> Option<GivenNumber> {
    let [quantity] = &quantities_in(text, languages)[..] else { return None };
    Some(GivenNumber { value: quantity.number(), dimension: Some(quantity.unit.dimension?) })
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
        all.extend(settings_of(bound, run, scene).into_iter().map(|(_, given)| given));
        let times = spec.until.iter().chain(spec.press.iter().map(|(_, time)| time));
        let times = times.chain(&scene.scene.lab.stop_at);
        all.extend(times.map(|x| GivenNumber { value: x.value, dimension: time }));
    }
    all
}
