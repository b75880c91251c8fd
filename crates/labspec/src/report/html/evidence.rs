//! The evidence of a claim: its runs, its measures, its quoted numbers, its closed forms.

use super::context::LessonContext;
use super::plots::plots;
use super::settings;
use super::text::{code, plain, text};
use super::verdict::verdict;
use crate::check::Claim;
use crate::ledger::{State, Subject};
use crate::printable::counted;
use crate::spec::Verify;
use crate::verify::{Measured, Quote, QuoteState, significant};
use std::fmt::Write;

/// Maximum number of listed places of a quoted number.
const MAX_PLACES: usize = 8;

/// The plots of a claim and its tables, which are collapsed where nothing is doubtful.
pub(super) fn evidence(claim: &Claim, spec: Option<&Verify>, context: &LessonContext<'_>) -> String {
    let mut out = String::new();
    let spec = spec.map(|verify| context.lesson.whole(verify));
    if let Some(drawn) = spec.and_then(|verify| context.curves.iter().find(|d| d.span == verify.span)) {
        out.push_str(&plots(drawn));
    }
    let judgement = &claim.judgement;
    let counts = [
        (judgement.runs.len(), "run"),
        (judgement.measures.len(), "measure"),
        (judgement.quotes.len(), "quoted number"),
        (judgement.exact.len(), "closed form"),
    ];
    let nonzero: Vec<String> =
        counts.iter().filter(|(n, _)| *n > 0).map(|(n, one)| counted(*n, one)).collect();
    if nonzero.is_empty() {
        return out;
    }
    let open = if claim.is_doubtful() { " open=\"open\"" } else { "" };
    let _ = writeln!(out, "<details{open}><summary>{}</summary>", nonzero.join(", "));
    for table in
        [quotes(claim, context), forms(claim, spec, context), measures(claim), runs(claim, spec, context)]
    {
        out.push_str(&table);
    }
    out.push_str("</details>\n");
    out
}

/// A table in a scrollable box; empty without rows. Empty columns are left out.
fn table(title: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let used = |i: &usize| rows.iter().any(|row| row.get(*i).is_some_and(|cell| !cell.is_empty()));
    let columns: Vec<usize> = (0..heads.len()).filter(used).collect();
    let line = |cells: &dyn Fn(usize) -> String| columns.iter().map(|i| cells(*i)).collect::<String>();
    let head = |i: usize| format!("<th scope=\"col\">{}</th>", heads.get(i).unwrap_or(&""));
    let mut out = format!(
        "<div class=\"box\"><table><caption>{title}</caption>\n<thead><tr>{}</tr></thead>\n<tbody>\n",
        line(&head)
    );
    for row in rows {
        let cell = |i: usize| format!("<td>{}</td>", row.get(i).map_or("", String::as_str));
        let _ = writeln!(out, "<tr>{}</tr>", line(&cell));
    }
    out.push_str("</tbody></table></div>\n");
    out
}

fn number(x: f64) -> String {
    format!("<span class=\"number\">{}</span>", plain(&significant(x)))
}

fn quotes(claim: &Claim, context: &LessonContext<'_>) -> String {
    let row = |q: &Quote| {
        let state_of_quote = match q.state {
            QuoteState::Right => State::True(q.evidence),
            QuoteState::Wrong => State::False,
            QuoteState::Unclear => State::Unchecked,
        };
        let (state, word) =
            context.state(Subject::Quote, &q.span, &q.text).unwrap_or((state_of_quote, q.verdict()));
        let mut lines: Vec<usize> =
            context.rendered.places(&q.text).iter().map(|span| context.line(span.start)).collect();
        // A cell of a table is listed at the line of its claim.
        lines.extend(lines.is_empty().then(|| context.line(q.span.start)));
        lines.dedup();
        let more = if lines.len() > MAX_PLACES { ", …" } else { "" };
        let lines: Vec<String> = lines.iter().take(MAX_PLACES).map(usize::to_string).collect();
        let computed = if q.computed.is_nan() { "–".to_string() } else { number(q.computed) };
        vec![
            text(&q.text),
            computed,
            verdict(state, word),
            format!("{}{more}", lines.join(", ")),
            text(&context.names.shorten(&q.reason)),
        ]
    };
    let rows: Vec<Vec<String>> = claim.judgement.quotes.iter().map(row).collect();
    table("Quoted numbers", &["text", "computed", "verdict", "line", "why"], &rows)
}

fn forms(claim: &Claim, spec: Option<&Verify>, context: &LessonContext<'_>) -> String {
    let row = |form: &crate::verify::ClosedForm| {
        let word = match form.state {
            State::True(_) => "verified",
            State::False => "refuted",
            _ => "failed",
        };
        let (state, word) =
            context.state(Subject::ClosedForm, &form.span, &form.trace).unwrap_or((form.state, word));
        let written = spec.and_then(|v| v.exact.iter().find(|e| e.trace.span() == form.span));
        let written = written.map_or(String::new(), |e| code(&e.form.value));
        vec![text(&form.trace), written, verdict(state, word), text(&form.remark)]
    };
    let rows: Vec<Vec<String>> = claim.judgement.exact.iter().map(row).collect();
    table("Closed forms", &["trace", "formula", "verdict", "how well"], &rows)
}

fn measures(claim: &Claim) -> String {
    let row = |m: &Measured| {
        let same = |x: &f64| x.is_nan() && m.value.is_nan();
        let halved = m.halved.filter(|x| !same(x)).map_or("–".to_string(), number);
        vec![code(&m.name), number(m.value), halved]
    };
    let rows: Vec<Vec<String>> = claim.judgement.measures.iter().map(row).collect();
    table("Measures", &["measure", "value", "at half the timestep, where it differs"], &rows)
}

fn runs(claim: &Claim, spec: Option<&Verify>, context: &LessonContext<'_>) -> String {
    let judgement = &claim.judgement;
    let started =
        context.runs(&claim.name).filter(|started| started.len() == judgement.runs.len()).unwrap_or(&[]);
    let numerics: Vec<String> =
        started.iter().map(|(_, s)| s.as_ref().map_or(String::new(), settings::numerics)).collect();
    // Settings that all runs share are printed once.
    let same = numerics.first().filter(|first| numerics.iter().all(|other| other == *first));
    let row = |(i, r): (usize, &crate::verify::RunReport)| {
        let outcome = match &judgement.unmade {
            Some(_) => (State::Unchecked, "not made"),
            None => r.outcome(),
        };
        let (state, word) = context.state(Subject::Run, &r.span, &r.name).unwrap_or(outcome);
        let how = judgement.unmade.as_deref().or(r.broke.as_deref()).unwrap_or("");
        let made = spec.and_then(|v| v.runs.iter().find(|run| run.name.span() == r.span));
        let settings_of_run = numerics.get(i).filter(|_| same.is_none()).cloned().unwrap_or_default();
        vec![
            code(&r.name),
            verdict(state, word),
            settings::done(made, &r.name),
            settings_of_run,
            text(&context.names.shorten(how)),
        ]
    };
    let rows: Vec<Vec<String>> = judgement.runs.iter().enumerate().map(row).collect();
    let title = match same.filter(|all| !all.is_empty()) {
        Some(all) if rows.len() == 1 => format!("Runs <span class=\"soft settings\">with {all}</span>"),
        Some(all) => format!("Runs <span class=\"soft settings\">all with {all}</span>"),
        None => "Runs".to_string(),
    };
    table(&title, &["run", "", "what it does", "settings", "what broke"], &rows)
}
