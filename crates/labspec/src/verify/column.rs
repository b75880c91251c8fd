//! Columns of tables: every cell is a number that is quoted, and its row says which member of a sweep it is about.

use super::quote::{self, whole};
use super::{Asked, BoundVerify, Outcomes, Quote, ShownText, grounded};
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use crate::spec::{Column, Said};
use labspec_expr::dimension::Dimension;

/// Holds a column, or one cell of it, to what was measured.
pub(super) fn check(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    claim: &Column,
    shown: &ShownText,
    findings: &mut Vec<Finding>,
) -> Vec<Quote> {
    let cells = match quote::cells(claim, shown) {
        Ok(cells) => cells,
        Err([message, help]) => {
            findings.push(
                Finding::new(rules::QUOTE_NOT_FOUND, claim.column.span(), message.clone())
                    .why("nothing was compared: the text was changed, or says it in other words")
                    .help(help),
            );
            return vec![Quote::unclear(&claim.column, &message)];
        }
    };
    let unit = quote::unit_of_head(claim.column.as_str());
    let Some((_, list)) = &claim.by else {
        return cells
            .into_iter()
            .map(|[_, cell]| number(bound, outcomes, cell, claim.is.clone(), &unit, shown, findings))
            .collect();
    };
    let values = match values(bound, outcomes, list, findings) {
        Ok(values) => values,
        Err(reason) => return vec![Quote::unclear(&claim.column, &reason)],
    };
    let mut all = Vec::new();
    for [key, cell] in cells {
        let read = quote::quoted(&key.value).ok();
        let member = read.and_then(|read| values.iter().position(|x| read.is(*x)));
        let Some(member) = member else {
            let message = format!("nothing was run for the row \"{}\"", key.value);
            findings.push(
                Finding::new(rules::QUOTE_UNCLEAR, key.span(), message.clone())
                    .why("the number in this row was compared with nothing")
                    .help("run the sweep with this value, too, or correct the row")
                    .related(list.span(), "these are the values"),
            );
            all.push(Quote::unclear(&cell, &message));
            continue;
        };
        all.push(number(bound, outcomes, cell, part(&claim.is, &format!("[{member}]")), &unit, shown, findings));
    }
    all
}

/// One cell.
fn number(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    cell: Text,
    expr: Text,
    unit: &Option<(String, Dimension)>,
    shown: &ShownText,
    findings: &mut Vec<Finding>,
) -> Quote {
    super::quote(bound, outcomes, &Said { quote: cell, expr }, Asked::There(unit.clone()), shown, findings)
}

/// The numbers of a list.
fn values(
    bound: &BoundVerify<'_>,
    outcomes: &Outcomes,
    list: &Text,
    findings: &mut Vec<Finding>,
) -> Result<Vec<f64>, String> {
    let mut number =
        |text: &Text| grounded(bound, &outcomes.nominal, text, findings).map(|f| f.value.to_number());
    let count = number(&part(list, ".length"))?;
    (0..count.clamp(0.0, 1000.0) as usize).map(|i| number(&part(list, &format!("[{i}]")))).collect()
}

/// An expression with something behind it; its place is that of the whole.
fn part(list: &Text, behind: &str) -> Text {
    let value = format!("({}){behind}", list.value);
    let map = whole(value.len(), list.span());
    Text { value, map }
}
