//! The findings about a quoted number.

use super::number::{NumberForm, Quoted, ten};
use super::quote_claim::{QuoteClaim, QuoteOutcome};
use super::unit::Shift;
use super::unit_text::{Link, Unit};
use crate::finding::{Finding, Severity};
use crate::rules;
use crate::verify::format::significant;
use std::ops::Range;

/// Maximum number of related places of a finding.
const MAX_RELATED: usize = 12;

/// A value, printed in the form of the quote.
pub(super) fn printed(read: &Quoted, x: f64) -> String {
    if x.is_nan() {
        "no value".into()
    } else if x.is_infinite() {
        "infinity".into()
    } else {
        let printed = read.print(x);
        // A quote in another unit may have too few digits for any of the number.
        if x != 0.0 && printed.parse() == Ok(0.0) { significant(x) } else { printed }
    }
}

/// A value that is not that of the quote, with enough digits to differ from a bound.
pub(super) fn measured(read: &Quoted, x: f64) -> String {
    match read.form {
        NumberForm::Interval(..) => significant(x),
        _ => printed(read, x),
    }
}

/// The quote, shortened for a message.
pub(super) fn shorten_quote(claim: &QuoteClaim<'_>) -> String {
    crate::json::read::shorten(if claim.part.is_empty() { claim.quote.as_str() } else { claim.part.trim() })
}

pub(super) fn no_number(claim: &QuoteClaim<'_>) -> Finding {
    Finding::error(rules::QUOTE_WITHOUT_NUMBER, claim.quote.span(), "this quote contains no number")
        .why("nothing was compared: digits of names, indexes and exponents, as in t2, x_1 or L^2, are not numbers")
        .help("quote the number as the text prints it, such as \"0.442 s\"")
}

pub(super) fn unread(claim: &QuoteClaim<'_>, form: &str) -> Finding {
    Finding::error(rules::QUOTE_UNCLEAR, claim.quote.span(), format!("\"{}\" is {form}, which the checker cannot read", shorten_quote(claim)))
        .why("nothing was compared, because the checker does not guess which number is meant")
        .help(match form {
            "a bound, not a number" => "quote only the number, or state the bound as a condition under `options`",
            _ => "quote only the number that the expression gives, as in \"0.442 s\", \"1.5×10^3\", \"0.44 ± 0.01 s\" or \"0.4 to 0.5 s\"",
        })
}

pub(super) fn not_found(claim: &QuoteClaim<'_>, hidden: Option<Range<usize>>) -> Finding {
    let found = Finding::plain(
        rules::QUOTE_NOT_FOUND,
        claim.quote.span(),
        format!(
            "the text \"{}\" does not appear in the rendered lesson as a separate number",
            shorten_quote(claim)
        ),
    )
    .why("nothing was compared: the text has changed, or uses other words")
    .help("quote what the text now says, with its sign and its whole unit, or delete this line");
    match hidden {
        Some(place) => {
            found.related(
                place,
                "it is here, in text that is not rendered, as part of a longer number, or behind words that change it (\"at least\", \"not the\")",
            )
        }
        None => found,
    }
}

pub(super) fn no_value(claim: &QuoteClaim<'_>, computed: f64) -> Finding {
    let (message, why) = if computed.is_nan() {
        (
            "this expression has no value in this run, so the quoted number was not checked",
            "it divides zero by zero, or its value is not a number",
        )
    } else {
        (
            "this expression is infinite in this run, so the quoted number was not checked",
            "it divides by zero, or a value grows without end",
        )
    };
    Finding::error(rules::QUOTE_WITHOUT_VALUE, claim.expr.span(), message)
        .why(why)
        .help("correct the expression")
        .related(claim.quote.span(), "the quoted number")
}

/// A finding at the places where the quote appears: at the first one, with the others as related places.
fn at_places(
    rule: &'static rules::Rule,
    severity: Severity,
    claim: &QuoteClaim<'_>,
    outcome: &QuoteOutcome,
    message: String,
) -> Finding {
    let mut places = outcome.places.iter();
    let first = places.next().cloned().unwrap_or(claim.quote.span());
    let mut found = Finding::error(rule, first, message).severity(severity);
    for place in places.by_ref().take(MAX_RELATED) {
        found = found.related(place.clone(), "the text also says it here");
    }
    let more = places.count();
    let value = significant(outcome.computed);
    let label = match more {
        0 => format!("this is {value}"),
        n => format!("this is {value}; the text says it in {n} more places"),
    };
    found.related(claim.expr.span(), label)
}

/// The perturbed values: "0.443 at half the timestep, 0.441 with the solver run to convergence".
fn list(outcome: &QuoteOutcome) -> String {
    outcome.moved.iter().map(|(how, text)| format!("{text} {how}")).collect::<Vec<_>>().join(", ")
}

/// How the quote was read, when that is not obvious from the quote.
fn as_read(claim: &QuoteClaim<'_>, read: &Quoted) -> String {
    let text = read.to_string();
    let plain = claim.part.replace('\u{2212}', "-");
    if plain.contains(&text) { String::new() } else { format!(" (read as {text})") }
}

pub(super) fn wrong_unit(claim: &QuoteClaim<'_>, outcome: &QuoteOutcome, text: &str, gives: &str) -> Finding {
    let message = format!("the text says {text}, but the expression gives {gives}");
    at_places(rules::QUOTE_WRONG, Severity::Error, claim, outcome, message)
        .why("the digits are right, but the unit differs")
        .help("correct the unit in the text, or convert the number in the expression")
}

pub(super) fn wrong_arithmetic(claim: &QuoteClaim<'_>, outcome: &QuoteOutcome) -> Finding {
    let message = format!("the text says {}, but {}", shorten_quote(claim), outcome.reason);
    at_places(rules::QUOTE_WRONG, Severity::Error, claim, outcome, message)
        .why("the number is right, but the formula before it gives another number")
        .help("correct the numbers in the formula")
}

pub(super) fn uncertain_unit(
    claim: &QuoteClaim<'_>,
    outcome: &QuoteOutcome,
    unit: &Unit,
    gives: &str,
) -> Finding {
    let text = &unit.text;
    let message = match unit.link {
        Link::Clause => {
            format!(
                "the number has no unit, the text names {text} beside it, but the expression gives {gives}"
            )
        }
        _ => format!("{text} may be a unit or a symbol here, but the expression gives {gives}"),
    };
    at_places(rules::QUOTE_UNCLEAR, Severity::Error, claim, outcome, message)
        .why("a quote with two readings cannot be called right")
        .help("write the unit after the number, or quote the number where its unit is clear")
}

pub(super) fn wrong(claim: &QuoteClaim<'_>, outcome: &QuoteOutcome, read: &Quoted) -> Finding {
    let right = measured(read, outcome.computed);
    let within = match read.form {
        NumberForm::PlusMinus(..) | NumberForm::Range(..) => ", which is outside it",
        _ => "",
    };
    let message = format!(
        "the text says {}{}, but the simulation gives {right}{within}",
        shorten_quote(claim),
        as_read(claim, read)
    );
    let found = at_places(rules::QUOTE_WRONG, Severity::Error, claim, outcome, message)
        .why("a reader who measures it finds another number");
    // The text agrees with one of these timesteps, so the author may have used it.
    let text = read.to_string();
    if outcome.moved.iter().any(|(_, moved)| *moved == text) {
        return found.help(format!(
            "state the timestep beside the number, and `set` it in the run: the digits depend on it, {right} as the lesson stands, {}",
            list(outcome)
        ));
    }
    found.help(match read.form {
        NumberForm::Interval(..) => format!("write words that fit {right}, or correct the expression"),
        NumberForm::PlusMinus(..) | NumberForm::Range(..) => {
            format!("write a range that contains {right}, or correct the expression")
        }
        _ if outcome.computed != 0.0 && read.print(outcome.computed).parse() == Ok(0.0) => {
            format!("write {right} in the unit of the expression, or convert the expression to the unit of the text")
        }
        _ if outcome.moved.is_empty() => {
            format!("write {right} in the text and in the quote, or correct the expression")
        }
        _ => format!(
            "write {right} in the text and in the quote, and state the timestep beside it: the digits depend on it, {}",
            list(outcome)
        ),
    })
}

pub(super) fn of_timestep(claim: &QuoteClaim<'_>, outcome: &QuoteOutcome, read: &Quoted) -> Finding {
    let message = format!(
        "the digits of {} depend on the timestep: {} as the lesson stands, {}",
        shorten_quote(claim),
        printed(read, outcome.computed),
        list(outcome)
    );
    at_places(rules::QUOTE_OF_TIMESTEP, Severity::Note, claim, outcome, message)
        .why(
            "the number is right for this timestep only; a reader with another timestep finds another number",
        )
        .help("state it with its timestep, and `set` the timestep in the run; the number itself is right")
}

/// The finding about a number that no run comes near, where the digits of the runs cannot be reproduced either.
pub(super) fn far_from_all_runs(
    claim: &QuoteClaim<'_>,
    outcome: &QuoteOutcome,
    read: &Quoted,
    values: &[f64],
) -> Finding {
    let message = format!(
        "the text says {}{}, but no run comes near: {} as the lesson stands, {}",
        shorten_quote(claim),
        as_read(claim, read),
        printed(read, outcome.computed),
        list(outcome)
    );
    at_places(rules::QUOTE_WRONG, Severity::Error, claim, outcome, message)
        .why("a reader who measures it finds another number, and every reader a different one")
        .help(fewer_digits_help(read, values))
}

/// The help where digits cannot be reproduced.
fn fewer_digits_help(read: &Quoted, values: &[f64]) -> String {
    match longest_agreed_form(read, values) {
        Some(text) => {
            format!("print fewer digits, {text}, which all of these runs give, or quote a shorter run")
        }
        None => {
            "quote a shorter run, before such starts diverge, or say in words what all of these runs share"
                .into()
        }
    }
}

pub(super) fn chaotic(
    claim: &QuoteClaim<'_>,
    outcome: &QuoteOutcome,
    read: &Quoted,
    values: &[f64],
) -> Finding {
    let message = format!(
        "no reader can reproduce the digits of {}: {} as the lesson stands, {}",
        shorten_quote(claim),
        printed(read, outcome.computed),
        list(outcome)
    );
    at_places(rules::QUOTE_CHAOTIC, Severity::Warning, claim, outcome, message)
        .why("such a start is within rounding of that of the lesson: another computer, or another version of the simulator, prints other digits")
        .help(fewer_digits_help(read, values))
}

/// The longest printed form on which all values agree, with fewer decimals than the quote; `None` when there is none.
fn longest_agreed_form(read: &Quoted, values: &[f64]) -> Option<String> {
    let NumberForm::Plain(_) = read.form else { return None };
    let fewer = (0..read.decimals).rev().map(|decimals| Quoted { decimals, ..*read });
    let mut prints = fewer.map(|q| values.iter().map(|&x| printed(&q, x)).collect::<Vec<_>>());
    let same = prints.find(|all| all.iter().all(|text| Some(text) == all.first()))?;
    // A print without nonzero digits is not helpful.
    let text = same.into_iter().next()?;
    let mantissa = text.split(['e', '×']).next().unwrap_or("");
    mantissa.contains(|c: char| matches!(c, '1'..='9')).then_some(text)
}

pub(super) fn ambiguous_unit(
    claim: &QuoteClaim<'_>,
    outcome: &QuoteOutcome,
    read: &Quoted,
    why: &str,
    other: Option<&Quoted>,
) -> Finding {
    let value = significant(outcome.computed);
    let message = match other {
        Some(other) => format!(
            "\"{}\" was read as {read}, but {why}: the expression gives {value}, which matches {other}",
            shorten_quote(claim)
        ),
        None => format!(
            "\"{}\" was read as {read}, but {why}: the expression gives {value}",
            shorten_quote(claim)
        ),
    };
    Finding::error(rules::QUOTE_UNCLEAR, claim.quote.span(), message)
        .why("a quote with two readings cannot be called right or wrong")
        .help("quote only the number that the expression gives, with a point before its decimals")
        .related(claim.expr.span(), format!("this is {value}"))
}

pub(super) fn other_unit(
    claim: &QuoteClaim<'_>,
    outcome: &QuoteOutcome,
    read: &Quoted,
    shift: &Shift,
) -> Finding {
    let value = significant(outcome.computed);
    let factor = ten(shift.power.abs());
    let what = match &shift.units {
        Some((text, other)) => format!(": the text is in {text}, the expression in {other}"),
        None => String::new(),
    };
    let (action, converted) = match shift.power > 0 {
        true => ("multiply", format!("{factor} * ({})", claim.expr.as_str())),
        false => ("divide", format!("({}) / {factor}", claim.expr.as_str())),
    };
    let message = format!(
        "the text says {}{}, but the expression gives {value}; the numbers differ by exactly a power of ten",
        shorten_quote(claim),
        as_read(claim, read)
    );
    Finding::error(rules::QUOTE_UNIT, claim.expr.span(), format!("{message}{what}"))
        .why("only numbers in the same unit can be compared")
        .help(format!("{action} the expression by {factor}: write `{converted}`"))
        .related(outcome.places.first().cloned().unwrap_or(claim.quote.span()), "the text says it here")
}
