//! A setting that a text names in place of that of the run that a claim reads: the one of another run, or one that no run has.

use super::super::bound_run::BoundRun;
use super::super::condition::numbers_in;
use super::super::given::settings_of;
use super::{Other, ReadMeasure, before_quantity};
use crate::bind::{given_by, scalar};
use crate::json::read::named;
use crate::language::words::{ends_with, find, split_words};
use crate::spec::ControlKind;
use labspec_expr::Value;
use labspec_expr::dimension::Measure;

/// Words before a setting with which a result is compared: `0.2 s longer than from 0.1 rad`. They are at most this number of words before it.
const COMPARED: [&str; 9] =
    ["than", "instead", "against", "compared", "als", "statt", "anstatt", "gegenüber", "que"];
const COMPARED_WORDS: usize = 3;

/// The other run that is named by a text, which has no other words: the first cell of a row.
pub(super) fn named_run(read: &ReadMeasure<'_, '_>, text: &str) -> Option<Other> {
    let runs = &read.bound.runs;
    let is_named = |name: &str| name.chars().count() > 1 && name.to_lowercase() == text.trim();
    let index = runs.iter().position(|run| is_named(run.name) && run.swept.is_none())?;
    if index == read.run {
        return None;
    }
    let [other, run] = [runs.get(index)?, runs.get(read.run)?];
    Some(Other {
        words: other.name.to_string(),
        read: format!("the run {}", named(run.name)),
        with: format!("the run {}", named(other.name)),
        value: read.with_number(read.number_of_run(index)?)?,
    })
}

/// The setting of another run that a text states, if it does not state that of the run that is read.
pub(super) fn other(read: &ReadMeasure<'_, '_>, text: &str) -> Option<Other> {
    let bound = read.bound;
    let quantities = read.quantities();
    if quantities.is_empty() || read.is_of_model() {
        return None;
    }
    let runs: Vec<_> = bound.runs_with_scenes().collect();
    let (run, scene) = runs.get(read.run)?;
    if changes_more_than_controls(run) {
        return None;
    }
    let settings = settings_of(bound, run, scene);
    if quantities.iter().any(|q| settings.iter().any(|(_, given)| given.is(q))) {
        return None;
    }
    let mut others =
        runs.iter().enumerate().filter(|(i, (other, _))| *i != read.run && other.swept.is_none());
    let (index, label, words) = others.find_map(|(i, (other, scene))| {
        let of_other = settings_of(bound, other, scene);
        let (label, stated) = of_other.iter().find_map(|(label, given)| {
            let is_set_here = settings.iter().any(|(set, _)| set == label);
            let stated =
                quantities.iter().find(|q| is_set_here && given.dimension.is_some() && given.is(q))?;
            Some((label.to_string(), stated.text.clone()))
        })?;
        Some((i, label, stated))
    })?;
    let before = before_quantity(text, &words)?;
    let near = split_words(before).rev().take(COMPARED_WORDS);
    if near.into_iter().any(|word| COMPARED.contains(&word)) || ends_with(before.trim_end(), "→") {
        return None;
    }
    let x = read.number_of_run(index)?;
    let (other, _) = runs.get(index)?;
    Some(Other {
        words,
        read: format!("the run {}, which has another value of \"{label}\"", named(run.name)),
        with: format!("the run {}", named(other.name)),
        value: read.with_number(x)?,
    })
}

/// Whether a run has a model or a program of its own, which may give it the setting that a control has elsewhere.
fn changes_more_than_controls(run: &BoundRun<'_>) -> bool {
    run.spec.is_some_and(|spec| {
        spec.setup.is_some() || spec.controller.is_some() || spec.key.is_some() || !spec.model.is_empty()
    })
}

/// A setting that a student can choose and that the run does not have, if the text states it and not that of the run.
pub(super) fn untested(read: &ReadMeasure<'_, '_>, text: &str) -> Option<Other> {
    let (run, scene) = read.bound.runs_with_scenes().nth(read.run)?;
    if changes_more_than_controls(run) || read.is_of_model() {
        return None;
    }
    let quantities = read.quantities();
    let settings = settings_of(read.bound, run, scene);
    if quantities.iter().any(|q| settings.iter().any(|(_, given)| given.is(q))) {
        return None;
    }
    // A threshold of the measure is no setting.
    let stop = run.stop.as_ref().map_or("", |stop| stop.text.as_str());
    let thresholds = [numbers_in(&read.text.value), numbers_in(stop)].concat();
    let set = &run.spec?.set;
    let mut found = set.iter().filter_map(|(label, _)| {
        let control = scene.scene.lab.control(label.as_str())?;
        let (words, value) = match &control.kind {
            ControlKind::Select { options, .. } => {
                let mut stated =
                    options.iter().filter(|choice| find(text, &choice.text.value.to_lowercase()).is_some());
                let choice = stated.next().filter(|_| stated.next().is_none())?;
                (choice.text.value.to_string(), scalar(&choice.value))
            }
            ControlKind::Slider { .. } => {
                let Measure::Dimension(unit) = given_by(control) else { return None };
                let mut stated =
                    quantities.iter().filter(|q| q.unit.dimension.is_some_and(|d| d.agrees(&unit)));
                let q = stated.next().filter(|_| stated.next().is_none())?;
                let value = q.number() * q.unit.dimension?.factor / unit.factor;
                let is_threshold = |x: &f64| {
                    [q.number(), q.number() * unit.factor, value]
                        .iter()
                        .any(|y| (x - y).abs() <= 1e-3 * y.abs())
                };
                if thresholds.iter().any(is_threshold) {
                    return None;
                }
                (q.text.clone(), Value::Number(value))
            }
            ControlKind::Button { .. } => return None,
        };
        is_stated_as_setting(read, text, &words).then_some((label, words, value))
    });
    let (label, words, value) = found.next()?;
    Some(Other {
        read: format!("the run {}, which has another value of \"{}\"", named(run.name), label.as_str()),
        with: format!("the same run with {words}"),
        words,
        value: read.with_setting(label, value)?,
    })
}

/// Whether the word before a text is one before a setting: `from 0.1 rad`.
fn is_stated_as_setting(read: &ReadMeasure<'_, '_>, text: &str, words: &str) -> bool {
    let start = find(text, &words.to_lowercase());
    let exact = start.and_then(|start| text.get(..start));
    let before = exact.or_else(|| before_quantity(text, words)).unwrap_or("").trim_end();
    read.languages.ratios(|r| r.settings).any(|setting| ends_with(before, setting))
        && !split_words(before).rev().take(COMPARED_WORDS).any(|word| COMPARED.contains(&word))
}
