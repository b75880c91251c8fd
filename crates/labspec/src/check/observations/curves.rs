//! Curves that show nothing: one number for ever, the same as another curve, or outside of their plot.
//!
//! What physics keeps constant or equal is no mistake. It changes, or parts, when the scene is put into another state.

use super::ObservedLab;
use super::record::{Record, same};
use crate::check::setconst::digits;
use crate::finding::Finding;
use crate::rules;
use crate::run::Cell;
use crate::spec::Plot;
use labspec_core::reflect::{FieldId, Object};
use labspec_expr::Effects;

/// Fields of the model that say where things are when nothing has happened: data have the same under another name.
const PLACES: [(&str, &str); 8] = [
    ("qpos0", "data.qpos"),
    ("qpos_spring", "data.qpos"),
    ("key_qpos", "data.qpos"),
    ("key_qvel", "data.qvel"),
    ("body_pos", "data.xpos"),
    ("body_quat", "data.xquat"),
    ("geom_pos", "data.geom_xpos"),
    ("site_pos", "data.site_xpos"),
];
/// A plot whose curve is inside for less than this share of the time shows too little of it.
const INSIDE: f64 = 0.5;

/// The cells of a column in all runs.
fn column(records: &[Record], column: usize) -> impl Iterator<Item = &Cell> {
    records.iter().flat_map(|r| &r.rows).filter_map(move |row| row.get(column))
}

/// The one number that a column shows, if it is one.
fn constant<'r>(mut cells: impl Iterator<Item = &'r Cell>) -> Option<&'r Cell> {
    let first = cells.next().filter(|c| matches!(c, Cell::Number(x) if x.is_finite()))?;
    cells.all(|c| same(c, first)).then_some(first)
}

fn reads(effects: &Effects, which: impl Fn(FieldId) -> bool) -> bool {
    effects.reads.iter().filter_map(|a| FieldId::new(a.field.0 as usize)).any(which)
}

pub(super) fn check_curves(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let lab = observed.bench.ready.lab;
    let mut first = 1;
    for plot in &lab.plots {
        let columns = first..first + plot.traces.len();
        first = columns.end;
        let still: Vec<bool> =
            columns.clone().map(|c| constant(column(observed.records, c)).is_some()).collect();
        for (i, c) in columns.clone().enumerate() {
            let Some(trace) = plot.traces.get(i) else { continue };
            let finding = if still.get(i) == Some(&true) {
                let others = still.iter().any(|s| !s);
                frozen(observed, c, others).map(|f| f.at_trace(&trace.expr, rules::CONSTANT_TRACE))
            } else {
                let twin = (columns.start..c).find(|other| is_twin(observed, *other, c));
                let twin = twin.and_then(|other| plot.traces.get(other - columns.start));
                twin.map(|other| {
                    CurveReport {
                        message: format!(
                            "\"{}\" and \"{}\" are the same curve",
                            other.label.value, trace.label.value
                        ),
                        why: format!(
                            "they agree to the last bit in {}, and also from other states of the scene",
                            observed.runs()
                        ),
                        help: "change the expression to what the label says, or delete the trace".into(),
                    }
                    .at_trace(&trace.expr, rules::SAME_CURVE)
                    .related(other.expr.span(), "the curve that it covers")
                })
            };
            match finding {
                Some(finding) => findings.push(finding),
                None => findings
                    .extend(outside(observed, plot, c).map(|t| t.at_trace(&trace.expr, rules::OUTSIDE_PLOT))),
            }
        }
    }
}

/// The words of a finding.
struct CurveReport {
    message: String,
    why: String,
    help: String,
}

impl CurveReport {
    fn at_trace(self, text: &crate::source::Text, rule: &rules::Rule) -> Finding {
        Finding::warning(rule, text.span(), self.message).why(self.why).help(self.help)
    }
}

/// A trace that shows one number, whatever happens; `others` says that its plot has curves that move.
fn frozen(observed: &mut ObservedLab<'_>, c: usize, others: bool) -> Option<CurveReport> {
    let ready = observed.bench.ready;
    let probe = ready.programs.probes.get(c.checked_sub(1)?)?;
    let effects = probe.bound.as_ref()?.program.effects();
    let data = effects.reads_everything || reads(effects, |f| f.info().object == Object::Data);
    let place = PLACES
        .iter()
        .find(|(name, _)| reads(effects, |f| f.info().object == Object::Model && f.info().name == *name));
    // Beside curves that move, a number of the model or of the lab may be meant as a line.
    if others && !data && place.is_none() {
        return None;
    }
    let value = constant(column(observed.records, c))?.clone();
    if !observed.perturbed_rows().iter().filter_map(|row| row.get(c)).all(|cell| same(cell, &value)) {
        return None;
    }
    let help = match place.filter(|_| !data) {
        Some((name, live)) => {
            format!("read `{live}` for the current value: `model.{name}` holds the initial one")
        }
        None => {
            "check the name and the index that it reads; use `refLines` for an intended constant line".into()
        }
    };
    Some(CurveReport {
        message: format!("this trace is always {}", digits(value.number(), 6)),
        why: format!(
            "it is the same to the last bit in {}, and also from other states of the scene",
            observed.runs()
        ),
        help,
    })
}

/// Whether two traces read the same things and are the same in all runs and states.
fn is_twin(observed: &mut ObservedLab<'_>, a: usize, b: usize) -> bool {
    let ready = observed.bench.ready;
    let of = |c: usize| Some(ready.programs.probes.get(c.checked_sub(1)?)?.bound.as_ref()?.program.effects());
    let (Some(one), Some(two)) = (of(a), of(b)) else { return false };
    let mut sets = [one, two].map(|e| (e.reads.clone(), e.calls.clone(), e.ctx_reads.clone()));
    sets.iter_mut().for_each(|(reads, calls, slots)| {
        reads.sort();
        calls.sort();
        slots.sort_unstable();
    });
    let equal = |row: &Vec<Cell>| matches!((row.get(a), row.get(b)), (Some(x), Some(y)) if same(x, y));
    let [one, two] = sets;
    one == two
        && column(observed.records, a).any(|c| c.number().is_finite())
        && observed.records.iter().flat_map(|r| &r.rows).all(equal)
        && observed.perturbed_rows().iter().all(equal)
}

/// A curve that lies outside of its plot for most of the time, in every run.
fn outside(observed: &ObservedLab<'_>, plot: &Plot, c: usize) -> Option<CurveReport> {
    // One end alone may be there to cut off what is beyond it.
    let (low, high) = (plot.ymin.as_ref()?.value, plot.ymax.as_ref()?.value);
    if low >= high {
        return None;
    }
    let share = |record: &Record| {
        let all: Vec<f64> =
            record.rows.iter().filter_map(|r| r.get(c)).map(Cell::number).filter(|x| x.is_finite()).collect();
        let inside = all.iter().filter(|x| (low..=high).contains(*x)).count();
        (!all.is_empty()).then(|| inside as f64 / all.len() as f64)
    };
    let first = observed.records.first()?;
    let most = observed.records.iter().filter_map(share).fold(0.0, f64::max);
    let nominal_share = share(first)?;
    if nominal_share >= INSIDE || most >= INSIDE {
        return None;
    }
    let cells = first.rows.iter().filter_map(|r| r.get(c)).map(Cell::number).filter(|x| x.is_finite());
    let (least, largest) = cells.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let [least, largest] = [least, largest].map(|x| digits(x, 4));
    let ends = format!("from {low} to {high}");
    Some(CurveReport {
        message: format!("this curve is outside its plot, which goes {ends}"),
        why: format!(
            "as the lab stands it goes from {least} to {largest}, and is inside for {:.0} % of the time; in {} it is inside for at most {:.0} %",
            100.0 * nominal_share,
            observed.runs(),
            100.0 * most
        ),
        help: "widen `ymin` and `ymax` to include the curve, or delete them: the plot then follows it".into(),
    })
}
