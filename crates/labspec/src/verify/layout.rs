//! The positions of the numbers that claims read: the measures of every run, its warnings, the values of sweeps, and the
//! results of searches. The layout is known before the runs, so a claim is compiled once and evaluated with the numbers of
//! each step variant.

use super::measure_units::RunUnits;
use super::outcome::MeasuredRuns;
use labspec_expr::dimension::Measure;

/// The number at a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    /// A measure of a run: the indexes of the run and of the measure.
    Measure(usize, usize),
    /// The number of warnings of a run.
    Warnings(usize),
    /// The value of a sweep in a run.
    Swept(usize),
    /// The result of a search.
    Found(usize),
    /// No number: a member of a sweep lacks the measure.
    Missing,
}

/// A run as claims name it.
#[derive(Clone, Debug)]
pub(super) struct LayoutRun {
    pub(super) name: String,
    /// The number of values of the sweep that begins with this run.
    pub(super) list: Option<usize>,
    /// The names that can be read of it, and the position of each.
    pub(super) at: Vec<(String, usize)>,
}

impl LayoutRun {
    /// The names that can be read of it.
    pub(super) fn names(&self) -> impl Iterator<Item = String> + '_ {
        self.at.iter().map(|(name, _)| name.clone())
    }
}

/// The input of a layout for one run: its name, its index and value in a sweep, and the names of its measures.
pub(super) type RunShape = (String, Option<(usize, f64)>, Vec<String>);

/// The positions of all numbers.
#[derive(Debug, Default)]
pub(super) struct NumberLayout {
    pub(super) runs: Vec<LayoutRun>,
    pub(super) found: Vec<(String, usize)>,
    pub(super) slots: Vec<Slot>,
}

/// The names of the value of a sweep and of the warnings of a run.
const VALUE: &str = "value";
const WARNINGS: &str = "warnings";

impl NumberLayout {
    /// The layout for the runs in their order, and the names of the searches.
    pub(super) fn from_runs(runs: &[RunShape], found: impl Iterator<Item = String>) -> NumberLayout {
        let mut layout = NumberLayout::default();
        for (place, (name, swept, measures)) in runs.iter().enumerate() {
            let mut run = LayoutRun { name: name.clone(), list: None, at: Vec::new() };
            match swept {
                None => {
                    for (i, measure) in measures.iter().enumerate() {
                        run.at.push((measure.clone(), layout.slots.len()));
                        layout.slots.push(Slot::Measure(place, i));
                    }
                    run.at.push((WARNINGS.to_string(), layout.slots.len()));
                    layout.slots.push(Slot::Warnings(place));
                }
                // The first member has the lists. The values of the sweep precede the numbers of each list.
                Some((0, _)) => {
                    let rest = runs.iter().enumerate().skip(place + 1);
                    let others =
                        rest.take_while(|(_, (.., swept, _))| matches!(swept, Some((n, _)) if *n > 0));
                    let members: Vec<usize> = [place].into_iter().chain(others.map(|(i, _)| i)).collect();
                    run.list = Some(members.len());
                    let names = measures.iter().map(String::as_str).chain([VALUE, WARNINGS]);
                    for name in names {
                        layout.slots.extend(members.iter().map(|i| Slot::Swept(*i)));
                        run.at.push((name.to_string(), layout.slots.len()));
                        let slot = |i: &usize| match name {
                            VALUE => Slot::Swept(*i),
                            WARNINGS => Slot::Warnings(*i),
                            _ => {
                                let measures_of_run = runs.get(*i).map_or(&[][..], |(.., measures)| measures);
                                measures_of_run
                                    .iter()
                                    .position(|m| m == name)
                                    .map_or(Slot::Missing, |m| Slot::Measure(*i, m))
                            }
                        };
                        layout.slots.extend(members.iter().map(slot));
                    }
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

    /// Whether a run is a sweep, whose measures are lists.
    pub(super) fn has_lists(&self) -> bool {
        self.runs.iter().any(|run| run.list.is_some())
    }

    /// The numbers of an outcome.
    pub(super) fn numbers(&self, outcome: &MeasuredRuns) -> Vec<f64> {
        let run = |i: usize| outcome.runs.get(i);
        let number = |slot: &Slot| match *slot {
            Slot::Measure(i, m) => run(i).and_then(|run| run.measures.get(m)).map(|(_, x)| *x),
            Slot::Warnings(i) => run(i).map(|run| run.warnings as f64),
            Slot::Swept(i) => run(i).and_then(|run| run.swept).map(|(_, x)| x),
            Slot::Found(i) => outcome.found.get(i).map(|(_, x)| *x),
            Slot::Missing => None,
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
            Some(Slot::Swept(run)) => {
                let of_run =
                    units.get(*run).and_then(|measures| measures.iter().find(|(name, _)| name == VALUE));
                of_run.map_or(Measure::Unknown, |(_, measure)| *measure)
            }
            _ => Measure::Unknown,
        }
    }
}
