//! A setting of another run that a text names in place of that of the run that a claim reads.

use super::super::given::settings_of;
use super::super::layout::Slot;
use super::super::quote::quantities_in;
use super::{Other, ReadMeasure};
use crate::json::read::named;
use crate::language::words::{ends_with, split_words};

/// Words before a setting with which a result is compared: `0.2 s longer than from 0.1 rad`. They are at most this number of words before it.
const COMPARED: [&str; 9] =
    ["than", "instead", "against", "compared", "als", "statt", "anstatt", "gegenüber", "que"];
const COMPARED_WORDS: usize = 3;

/// The setting of another run that a text states, if it does not state that of the run that is read.
pub(super) fn other(read: &ReadMeasure<'_, '_>, text: &str) -> Option<Other> {
    let bound = read.bound;
    let quantities = quantities_in(text, read.languages);
    if quantities.is_empty() {
        return None;
    }
    let runs: Vec<_> = bound.runs_with_scenes().collect();
    let (run, scene) = runs.get(read.run)?;
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
    let before = text.get(..text.find(&words.to_lowercase())?)?;
    let near = split_words(before).rev().take(COMPARED_WORDS);
    if near.into_iter().any(|word| COMPARED.contains(&word)) || ends_with(before.trim_end(), "→") {
        return None;
    }
    let place = bound.layout().slots.iter().position(|slot| *slot == Slot::Measure(index, read.measure))?;
    let x = read.claim.inputs(bound, read.outcome, Vec::new()).at(place)?;
    let (other, _) = runs.get(index)?;
    Some(Other {
        words,
        read: format!("the run {}, which has another value of \"{label}\"", named(run.name)),
        with: format!("the run {}", named(other.name)),
        value: read.with_number(x)?,
    })
}
