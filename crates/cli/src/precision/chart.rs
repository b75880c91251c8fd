//! The chart of a comparison: cost against error.

use super::table::named;
use labspec::run::INTEGRATORS;
use labspec::verify::significant;
use labspec_numerics::precision::{Errors, PrecisionResults, PrecisionRow, RunStatus, milliseconds};
use labspec_plot::{Method, MethodPoint, WorkPrecision, work_precision};

/// A log-log chart of the first trace: error on the horizontal axis, cost on the vertical axis, one curve per integrator.
pub(in super::super) fn chart(report: &PrecisionResults, title: &str) -> String {
    // The first number whose truth is known.
    let first = report.targets.iter().position(|t| t.is_compared());
    let target = first.and_then(|i| report.targets.get(i));
    // An error below the uncertainty of the reference is drawn at that uncertainty.
    let uncertainty = target.map_or(0.0, |t| t.uncertain);
    let first_error = |errors: &[Errors]| first.and_then(|i| errors.get(i)).copied();
    let point = |errors: &[Errors], cost: f64| {
        let e = first_error(errors).filter(|e| e.largest.is_finite())?;
        let error = if e.below { e.largest.max(uncertainty) } else { e.largest };
        Some(MethodPoint { cost, error, at_most: e.below, ..MethodPoint::default() })
    };
    // A run that is not compared is not drawn; a run that failed is.
    let point_of = |row: &PrecisionRow| {
        let note = format!("{} ms", milliseconds(row.setting.timestep));
        let spread = Some([row.cost.low, row.cost.high]);
        let failed = MethodPoint { cost: row.cost.median, failed: true, ..MethodPoint::default() };
        let point = if row.status == RunStatus::Good { point(&row.errors, row.cost.median)? } else { failed };
        Some(MethodPoint { note, spread, ..point })
    };
    let used = INTEGRATORS.iter().filter(|i| report.rows.iter().any(|r| r.setting.integrator == **i));
    let methods = used.map(|integrator| Method {
        label: integrator.name.to_string(),
        points: report
            .rows
            .iter()
            .filter(|row| row.setting.integrator == *integrator && row.setting.solver.is_none())
            .filter_map(point_of)
            .collect(),
        echo: None,
    });
    let mut methods: Vec<Method> = methods.collect();
    if let Some(beside) = &report.beside {
        let engine = beside.engine.split(' ').next().unwrap_or_default();
        for i in 0..methods.len() {
            let rows = beside.rows.iter().filter(|row| row.integrator == methods[i].label);
            let points: Vec<MethodPoint> = rows.filter_map(|row| point(&row.errors, row.cost)).collect();
            if !points.is_empty() {
                methods.push(Method {
                    label: format!("{}, {engine}", methods[i].label),
                    points,
                    echo: Some(i),
                });
            }
        }
    }
    let until =
        target.and_then(|t| t.until).map_or(String::new(), |t| format!(" until {} s", significant(t)));
    work_precision(&WorkPrecision {
        title: title.to_string(),
        xlabel: target.map_or(String::new(), |t| format!("largest error of {}{until}", named(t))),
        ylabel: "run time, µs per simulated second".into(),
        methods,
        width: 640.0,
        height: 420.0,
    })
}
