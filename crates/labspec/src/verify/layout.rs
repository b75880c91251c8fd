//! The positions of the numbers that claims read: the measures of every run, its warnings, the values of sweeps, and the
//! results of searches. The layout is known before the runs, so a claim is compiled once and evaluated with the numbers of
//! each step variant.

use super::list_measure::measure_of_element;
use super::measure_units::RunUnits;
use super::outcome::{MeasuredRuns, SweepMember};
use labspec_expr::dimension::Measure;

/// The number at a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    /// A measure of a run: the indexes of the run and of the measure.
    Measure(usize, usize),
    /// The number of warnings of a run.
    Warnings(usize),
    /// The value of a sweep in a run: the indexes of the run and of the axis.
    Swept(usize, usize),
    /// The result of a search.
    Found(usize),
    /// No number: a member of a sweep lacks the measure.
    Missing,
    /// No number: a list of a sweep over several quantities has no single list of values that belongs to it.
    SeveralAxes,
}

/// A run as claims name it.
#[derive(Clone, Debug)]
pub(super) struct LayoutRun {
    pub(super) name: String,
    /// The number of values of the sweep that begins with this run.
    pub(super) members: Option<usize>,
    /// What can be read of it.
    pub(super) results: Vec<LayoutResult>,
}

/// A number of a run, or a list of numbers, as claims name it.
#[derive(Clone, Debug)]
pub(super) struct LayoutResult {
    pub(super) name: String,
    /// The position of its first number.
    pub(super) first: usize,
    /// The length of a list.
    pub(super) list: Option<usize>,
    /// The number of elements of the measure, if the measure itself is a list.
    pub(super) elements: Option<usize>,
}

impl LayoutRun {
    /// The names that can be read of it.
    pub(super) fn names(&self) -> impl Iterator<Item = String> + '_ {
        self.results.iter().map(|result| result.name.clone())
    }
}

/// The input of a layout for one run: its name, its index and value in a sweep, and the names of its measures.
pub(super) type RunShape = (String, Option<SweepMember>, Vec<String>);

/// The positions of all numbers.
#[derive(Debug, Default)]
pub(super) struct NumberLayout {
    pub(super) runs: Vec<LayoutRun>,
    pub(super) found: Vec<(String, usize)>,
    pub(super) slots: Vec<Slot>,
}

/// The name of the warnings of a run.
const WARNINGS: &str = "warnings";

/// The name of the values of an axis of a sweep: `value`, `value2`, `value3`, …
pub(super) fn name_of_axis(axis: usize) -> String {
    match axis {
        0 => "value".to_string(),
        _ => format!("value{}", axis + 1),
    }
}

/// A measure with its elements.
struct MeasureGroup {
    name: String,
    /// The index of its first element among the measures of the run.
    first: usize,
    /// Their number, if it is a list.
    elements: Option<usize>,
}

/// The measures of a run, with the elements of each list together.
fn groups(measures: &[String]) -> Vec<MeasureGroup> {
    let mut all: Vec<MeasureGroup> = Vec::new();
    for (i, measure) in measures.iter().enumerate() {
        match (measure_of_element(measure), all.last_mut()) {
            (Some((name, 1..)), Some(group)) if group.name == name => {
                group.elements = group.elements.map(|n| n + 1);
            }
            (Some((name, _)), _) => {
                all.push(MeasureGroup { name: name.to_string(), first: i, elements: Some(1) });
            }
            (None, _) => all.push(MeasureGroup { name: measure.clone(), first: i, elements: None }),
        }
    }
    all
}

impl NumberLayout {
    /// The layout for the runs in their order, and the names of the searches.
    pub(super) fn from_runs(runs: &[RunShape], found: impl Iterator<Item = String>) -> NumberLayout {
        let mut layout = NumberLayout::default();
        for (place, (name, swept, measures)) in runs.iter().enumerate() {
            let mut run = LayoutRun { name: name.clone(), members: None, results: Vec::new() };
            match swept {
                None => {
                    for group in groups(measures) {
                        let MeasureGroup { name, elements, .. } = group;
                        let first = layout.slots.len();
                        run.results.push(LayoutResult { name, first, list: elements, elements });
                        let indexes = group.first..group.first + elements.unwrap_or(1);
                        layout.slots.extend(indexes.map(|m| Slot::Measure(place, m)));
                    }
                    let (name, first) = (WARNINGS.to_string(), layout.slots.len());
                    run.results.push(LayoutResult { name, first, list: None, elements: None });
                    layout.slots.push(Slot::Warnings(place));
                }
                // The first member has the lists. The values of the sweep precede the numbers of each list.
                Some(SweepMember { index: 0, values }) => {
                    let rest = runs.iter().enumerate().skip(place + 1);
                    let others =
                        rest.take_while(|(_, (.., swept, _))| swept.as_ref().is_some_and(|m| m.index > 0));
                    let members: Vec<usize> = [place].into_iter().chain(others.map(|(i, _)| i)).collect();
                    run.members = Some(members.len());
                    let mut list = |name: String,
                                    elements: Option<usize>,
                                    slot: &dyn Fn(usize, usize) -> Slot| {
                        let numbers = members.len() * elements.unwrap_or(1);
                        let is_line = values.len() == 1 && elements.is_none();
                        let given = |i: &usize| if is_line { Slot::Swept(*i, 0) } else { Slot::SeveralAxes };
                        layout.slots.extend(members.iter().cycle().take(numbers).map(given));
                        let first = layout.slots.len();
                        run.results.push(LayoutResult { name, first, list: Some(numbers), elements });
                        for i in &members {
                            layout.slots.extend((0..elements.unwrap_or(1)).map(|element| slot(*i, element)));
                        }
                    };
                    for group in groups(measures) {
                        list(group.name.clone(), group.elements, &|i, element| {
                            let measures_of_run = runs.get(i).map_or(&[][..], |(.., measures)| measures);
                            let name = measures.get(group.first + element);
                            let place = measures_of_run.iter().position(|m| Some(m) == name);
                            place.map_or(Slot::Missing, |m| Slot::Measure(i, m))
                        });
                    }
                    for axis in 0..values.len() {
                        list(name_of_axis(axis), None, &|i, _| Slot::Swept(i, axis));
                    }
                    list(WARNINGS.to_string(), None, &|i, _| Slot::Warnings(i));
                }
                Some(_) => {}
            }
            layout.runs.push(run);
        }
        for (i, name) in found.enumerate() {
            layout.found.push((name, layout.slots.len()));
            layout.slots.push(Slot::Found(i));
        }
        layout
    }

    /// Whether claims can read lists: a run is a sweep, or a measure is a list.
    pub(super) fn has_lists(&self) -> bool {
        self.runs.iter().any(|run| run.results.iter().any(|result| result.list.is_some()))
    }

    /// The numbers of an outcome.
    pub(super) fn numbers(&self, outcome: &MeasuredRuns) -> Vec<f64> {
        let run = |i: usize| outcome.runs.get(i);
        let number = |slot: &Slot| match *slot {
            Slot::Measure(i, m) => run(i).and_then(|run| run.measures.get(m)).map(|(_, x)| *x),
            Slot::Warnings(i) => run(i).map(|run| run.warnings as f64),
            Slot::Swept(i, axis) => {
                run(i).and_then(|run| run.swept.as_ref()).and_then(|member| member.values.get(axis).copied())
            }
            Slot::Found(i) => outcome.found.get(i).map(|(_, x)| *x),
            Slot::Missing | Slot::SeveralAxes => None,
        };
        self.slots.iter().map(|slot| number(slot).unwrap_or(f64::NAN)).collect()
    }

    /// The dimension of the number at a position.
    pub(super) fn unit_of(&self, place: usize, units: &RunUnits) -> Measure {
        match self.slots.get(place) {
            Some(Slot::Measure(run, m)) => units
                .get(*run)
                .and_then(|measures| measures.get(*m))
                .map_or(Measure::Unknown, |(_, measure)| *measure),
            Some(Slot::Swept(run, axis)) => {
                let name_of_value = name_of_axis(*axis);
                let of_run = units
                    .get(*run)
                    .and_then(|measures| measures.iter().find(|(name, _)| *name == name_of_value));
                of_run.map_or(Measure::Unknown, |(_, measure)| *measure)
            }
            _ => Measure::Unknown,
        }
    }
}
