//! Checks quotes: numbers and words of the text, and cells of tables.

use super::direction::check_direction;
use super::measures_another::check_words_of_measure;
use super::named_run::{check_exchanged_runs, misnamed};
use super::quote_checker::{Quote, QuoteChecker, QuotedValue, check_number, check_words};
use super::ratio_of_change::{StatedExpr, check_ratio_of_change};
use super::{column, quote};
use crate::finding::Finding;
use crate::printable::counted;
use crate::rules;
use crate::source::Text;
use crate::spec::{Question, QuotedClaim, Verify};
use std::borrow::Cow;
use std::ops::Range;

/// Checks all quotes of a `verify` object. `question` is the question that contains it, or `None` if it belongs to a lab.
pub(super) fn check_quotes(
    checker: QuoteChecker<'_, '_>,
    verify: &Verify,
    question: Option<&Question>,
    findings: &mut Vec<Finding>,
) -> Vec<Quote> {
    let mut all = Vec::new();
    for quoted in &verify.says {
        all.extend(check_line(checker, quoted, question, findings));
    }
    let misnamed = verify.says.iter().filter_map(|quoted| {
        let places = quote::places_of_quote(&quoted.quote, question, checker.rendered);
        let [expr] = quoted.exprs.as_slice() else { return None };
        misnamed(checker.bound, &quoted.quote, expr, &places)
    });
    check_exchanged_runs(&misnamed.collect::<Vec<_>>(), findings);
    for claim in &verify.table {
        all.extend(column::check_column(checker, claim, findings));
    }
    all
}

/// Checks one line: one or several numbers, and conditions for its words.
fn check_line(
    checker: QuoteChecker<'_, '_>,
    quoted: &QuotedClaim,
    question: Option<&Question>,
    findings: &mut Vec<Finding>,
) -> Vec<Quote> {
    let places = quote::places_of_quote(&quoted.quote, question, checker.rendered);
    let exprs: Vec<Cow<'_, Text>> =
        quoted.exprs.iter().flat_map(|expr| checker.bound.numbers_of_quote(expr)).collect();
    let mut given = Vec::new();
    for expr in &exprs {
        match QuotedValue::measure(checker, expr, findings) {
            Ok(found) => given.push((expr, found)),
            Err(reason) => return vec![Quote::unclear(&quoted.quote, &reason)],
        }
    }
    if let [(text, value)] = given.as_slice()
        && let Some(reason) = check_single(checker, &quoted.quote, text, value, &places, findings)
    {
        return vec![Quote::unclear(&quoted.quote, &reason)];
    }
    let numbers = given.iter().filter(|(_, given)| !given.is_condition()).count();
    // With one expression, it belongs to the number that the quote states. With words and numbers, every number must be
    // checked.
    let languages = checker.bound.stage().languages();
    let parts = match exprs.as_slice() {
        [_] if numbers == 1 => vec![quote::whole(quoted.quote.as_str(), languages)],
        _ => quote::parts(quoted.quote.as_str(), numbers, languages),
    };
    let others = match exprs.as_slice() {
        [_] if numbers == 1 => quote::other_numbers(quoted.quote.as_str(), languages),
        _ => 0,
    };
    if parts.len() + others != numbers {
        let [printed, given] =
            [(parts.len() + others, "number"), (numbers, "expression")].map(|(n, one)| counted(n, one));
        let verb = if numbers == 1 { "gives" } else { "give" };
        let message = format!("the quote has {printed}, but {given} {verb} one");
        findings.push(
            Finding::error(rules::QUOTE_UNCLEAR, quoted.quote.span(), message.clone())
                .why("nothing was compared, because it is unclear which expression belongs to which number")
                .help(
                    "give one expression for each number, in order; conditions for words can be between them",
                ),
        );
        return vec![Quote::unclear(&quoted.quote, &message)];
    }
    let mut parts = parts.into_iter();
    let mut all = Vec::new();
    for (expr, given) in given {
        let claim = |part| quote::QuoteClaim { quote: &quoted.quote, part, expr };
        all.push(match given.is_condition() {
            true => {
                let spans: Vec<Range<usize>> = places.iter().map(|place| place.span.clone()).collect();
                check_words(checker, &claim(""), &given, &spans, findings)
            }
            false => {
                let part = parts.next().unwrap_or_else(|| quote::whole("", languages));
                check_number(checker, &claim(&part.text), &part, given, places.clone(), findings)
            }
        });
    }
    all
}

/// Compares the words of a quote with its only expression: a change in percent, and what is named beside the number. Returns the reason if
/// the expression is not the change that is stated.
fn check_single(
    checker: QuoteChecker<'_, '_>,
    quote: &Text,
    text: &Text,
    value: &QuotedValue,
    places: &[quote::QuotePlace],
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let measures = |name: &str| checker.bound.text_of_measure(name);
    let languages = checker.bound.stage().languages();
    let expr = StatedExpr { text, value: value.number(), measures: &measures, languages };
    let reason = match places {
        [] => check_ratio_of_change(quote, None, expr, findings),
        _ => places
            .iter()
            .find_map(|place| check_ratio_of_change(quote, Some(&place.clause.text), expr, findings)),
    };
    let nominal = &checker.outcomes.nominal;
    let reason = reason.or_else(|| {
        let is_held = value.is_condition() && value.holds();
        is_held.then(|| check_direction(checker.bound, nominal, "", (quote, text), findings))?
    });
    if reason.is_some() {
        return reason;
    }
    // A quote that stands at several places claims all of them.
    for place in places {
        // A quote with several quantities names its setting itself: `0.2 m/s with 9 kg`.
        let is_whole = quote::quantities_in(quote.as_str(), languages).len() > 1;
        let clause = place.clause.text.replacen(quote.as_str(), " ", 1);
        let words = match is_whole {
            true => quote.value.to_string(),
            false => format!("{} {clause}", place.clause.introduction),
        };
        check_words_of_measure(checker.bound, nominal, &words, place.span.clone(), text, findings);
    }
    None
}
