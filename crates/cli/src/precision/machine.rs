//! A comparison for programs: CSV and JSON.

use labspec::report::{key, set_number, set_numbers};
use labspec_numerics::precision::{BesideRow, Compared, Errors, Fate, Report, Row, RunCost};
use serde_json::{Value, json};
use std::io;

/// A line for each setting and number.
pub(super) fn csv(report: &Report, out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(
        out,
        "integrator,solver,timestep (s),own,label,unit,largest,at (s),rms,end,below,order,fate,microsecondsPerSecond,lowMicrosecondsPerSecond,highMicrosecondsPerSecond,work"
    )?;
    for row in &report.rows {
        let solver = row.setting.solver.map_or(String::new(), |s| s.name());
        let start =
            format!("{},{solver},{},{}", row.setting.integrator.name, row.setting.timestep, row.is_own);
        let RunCost { median, low, high, work } = row.cost;
        let end = format!("{},{median},{low},{high},{work}", key(row.fate.word()));
        if row.errors.is_empty() {
            writeln!(out, "{start},,,,,,,,,{end}")?;
        }
        for (target, e) in report.targets.iter().zip(&row.errors) {
            let quoted = |text: &str| text.replace('"', "\"\"");
            let (label, unit) = (quoted(&target.label), quoted(target.unit.as_deref().unwrap_or_default()));
            let order = e.order.map_or(String::new(), |o| o.to_string());
            writeln!(
                out,
                "{start},\"{label}\",\"{unit}\",{},{},{},{},{},{order},{end}",
                e.largest, e.at, e.rms, e.end, e.below
            )?;
        }
    }
    Ok(())
}

pub(super) fn value(report: &Report) -> Value {
    let labels: Vec<&str> = report.targets.iter().map(|t| t.label.as_str()).collect();
    let words = |t: &Compared| key(if t.closed { "closed form" } else { "tiny steps" });
    let truth: Vec<String> = report.targets.iter().map(words).collect();
    let rows: Vec<Value> = report.rows.iter().map(|row| row_value(row, report)).collect();
    let left_out: Vec<Value> =
        report.left_out.iter().map(|o| json!({"label": o.label, "reason": o.reason})).collect();
    let advice: Vec<Value> = report.advice.iter().map(|a| json!({"row": a.row, "text": a.text})).collect();
    let mut value = json!({
        "traces": labels, "truth": truth, "reference": report.reference, "length": report.length, "rows": rows,
        "events": report.events.iter().map(event_value).collect::<Vec<_>>(),
        "leftOut": left_out, "front": report.front, "advice": advice,
    });
    value["units"] = json!(report.targets.iter().map(|t| t.unit.as_deref()).collect::<Vec<_>>());
    let of = |f: fn(&Compared) -> Option<f64>| report.targets.iter().map(f).collect::<Vec<_>>();
    // A closed form is not off: there is no number for it, not one that was lost.
    set_numbers(&mut value, "uncertainty", &of(|t| (!t.closed).then_some(t.uncertain)));
    set_numbers(&mut value, "unseen", &of(|t| Some(t.unseen)));
    set_numbers(&mut value, "until", &of(|t| t.until));
    set_numbers(&mut value, "kept", &[report.energy, report.momentum[0], report.momentum[1]]);
    set_number(&mut value, "penetration", report.penetration);
    set_number(&mut value, "penetrationUncertainty", report.penetration_doubt);
    value["samples"] = json!(report.samples);
    value["beside"] = report.beside.as_ref().map_or(
        Value::Null,
        |b| json!({"engine": b.engine, "rows": b.rows.iter().map(beside_value).collect::<Vec<_>>()}),
    );
    value["nearby"] = match &report.nearby {
        Some(n) => json!({"apart": n.apart, "until": n.until}),
        None => Value::Null,
    };
    labspec::report::report("precision", value)
}

fn beside_value(row: &BesideRow) -> Value {
    let mut value = json!({"integrator": row.integrator, "timestep": row.timestep});
    set_numbers(&mut value, "errors", &row.errors.iter().map(|e| Some(e.largest)).collect::<Vec<_>>());
    set_number(&mut value, "microsecondsPerSecond", row.cost);
    value
}

fn event_value(event: &labspec_numerics::precision::Event) -> Value {
    let mut value = json!({"name": event.name});
    set_number(&mut value, "time", event.time);
    set_number(&mut value, "uncertainty", event.uncertain);
    value
}

fn row_value(row: &Row, report: &Report) -> Value {
    let at_most = row.events.iter().zip(&report.events).map(|(off, event)| *off <= event.uncertain);
    let mut value = json!({
        "integrator": row.setting.integrator.name,
        "timestep": row.setting.timestep,
        "solver": row.setting.solver.map(|s| s.name()),
        "own": row.is_own,
        "fate": key(row.fate.word()),
        "diverged": row.fate == Fate::Diverged,
        "told": row.reported,
        "wrong": row.errors.iter().map(|e| e.wrong).collect::<Vec<_>>(),
        "compared": row.errors.iter().map(|e| e.samples).collect::<Vec<_>>(),
        "eventsBelow": at_most.collect::<Vec<_>>(),
        "below": row.errors.iter().map(|e| e.below).collect::<Vec<_>>(),
    });
    let of = |f: fn(&Errors) -> Option<f64>| row.errors.iter().map(f).collect::<Vec<_>>();
    set_numbers(&mut value, "errors", &of(|e| Some(e.largest)));
    set_numbers(&mut value, "at", &of(|e| Some(e.at)));
    set_numbers(&mut value, "rms", &of(|e| Some(e.rms)));
    set_numbers(&mut value, "end", &of(|e| Some(e.end)));
    set_numbers(&mut value, "orders", &of(|e| e.order));
    set_numbers(&mut value, "events", &row.events.iter().copied().map(Some).collect::<Vec<_>>());
    set_numbers(&mut value, "kept", &[row.energy, row.momentum[0], row.momentum[1]]);
    set_number(&mut value, "penetration", row.penetration);
    set_number(&mut value, "score", row.score);
    set_number(&mut value, "microsecondsPerSecond", row.cost.median);
    set_numbers(&mut value, "repeats", &[Some(row.cost.low), Some(row.cost.high)]);
    set_number(&mut value, "work", row.cost.work);
    value
}
