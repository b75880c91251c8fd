//! Columns of tables: every cell is a quoted number or a word, and the row determines the member of a sweep that the cell
//! describes.

use super::bound::BoundVerify;
use super::claim::with_suffix;
use super::format::significant;
use super::grounded::grounded_value;
use super::layout::name_of_axis;
use super::measures_another::check_words_of_measure;
use super::quote;
use super::quote_checker::{Quote, QuoteChecker, QuotedValue, check_number, check_words};
use super::units;
use crate::finding::Finding;
use crate::language::Languages;
use crate::rules;
use crate::source::Text;
use crate::spec::{Column, ColumnCells};
use labspec_expr::Value;
use labspec_expr::dimension::Dimension;

/// The work of reading a cell.
const CELL_WORK: u64 = 1000;
/// Maximum number of different words in the cells of a column.
const MOST_WORDS: usize = 20;
/// Maximum number of values in a message.
const MOST_LISTED: usize = 6;

/// Compares a column, or one cell of it, with the measured values.
pub(super) fn check_column(
    checker: QuoteChecker<'_, '_>,
    claim: &Column,
    findings: &mut Vec<Finding>,
) -> Vec<Quote> {
    let stage = checker.bound.stage();
    stage.spend(CELL_WORK * checker.rendered.cells() as u64);
    if stage.left() == 0 {
        let spent = "the work budget ran out before this column";
        let finding = Finding::error(rules::QUOTE_UNCLEAR, claim.column.span(), spent)
            .why("nothing was compared")
            .help("make the runs shorter, or claim fewer columns in one lesson");
        return vec![refused(&claim.column, finding, findings)];
    }
    let cells = match quote::cells_of_column(claim, checker.rendered) {
        Ok(cells) => cells,
        Err([message, help]) => {
            let finding = Finding::new(rules::QUOTE_NOT_FOUND, claim.column.span(), message)
                .why("nothing was compared: the text has changed, or uses other words")
                .help(help);
            return vec![refused(&claim.column, finding, findings)];
        }
    };
    if let Some(finding) = computing_heading(checker.bound, claim) {
        return vec![refused(&claim.column, finding, findings)];
    }
    let unit = quote::unit_of_head(claim.column.as_str());
    let key_head = claim.by.as_ref().and_then(|(head, _)| quote::unit_of_head(head.as_str()));
    let implied = claim.by.is_none().then(|| implied_values(checker, &claim.is)).flatten();
    let Some(list) = claim.by.as_ref().map(|(_, list)| list).or(implied.as_ref()) else {
        return cells
            .into_iter()
            .map(|[key, text]| {
                check_row_name(checker, &key, &text, &claim.is, findings);
                check_cell(checker, &text, &claim.is, &unit, "", findings)
            })
            .collect();
    };
    let values = match values(checker, list, findings) {
        Ok(values) => values,
        Err(reason) => return vec![Quote::unclear(&claim.column, &reason)],
    };
    let swept = units::of_claim(checker.bound, &checker.outcomes.nominal, &part(list, "[0]"));
    let rows = SweepRows { list, values, swept, key_head, languages: checker.bound.stage().languages() };
    let mut all = Vec::new();
    for [key, text] in cells {
        all.push(match rows.member(&key) {
            Ok(member) => check_cell(checker, &text, &claim.is, &unit, &format!("[{member}]"), findings),
            Err(finding) => refused(&text, *finding, findings),
        });
    }
    all
}

/// The finding about a heading that computes with a measure, where the expression for its cells does not: the cells of
/// `1000 t (s)` are not `t`.
fn computing_heading(bound: &BoundVerify<'_>, claim: &Column) -> Option<Finding> {
    // For a cell that is given by its number, `column` is a text in its row.
    let number = match &claim.is {
        ColumnCells::Number(expr) if claim.cell.is_none() => Some((&claim.column, expr)),
        _ => None,
    };
    let key = claim.by.as_ref().map(|(heading, list)| (heading, list));
    let mut columns = number.into_iter().chain(key);
    columns.find_map(|(heading, expr)| {
        let operation = quote::operation_in_heading(heading.as_str()).filter(|_| !computes(bound, &expr.value))?;
        let message = format!("the heading says \"{operation}\", but the expression is `{}`", expr.value.trim());
        Some(
            Finding::error(rules::QUOTE_UNCLEAR, heading.span(), message)
                .why("the cells may state a different quantity than the expression gives")
                .help("name the quantity alone in the heading, as in `time (s)`, or compute with it in the expression, too")
                .related(expr.span(), "the expression for the cells"),
        )
    })
}

/// Whether an expression, or a measure that it reads, computes: `v2`, where `v2` is `final(data.qvel[0]) ** 2`.
fn computes(bound: &BoundVerify<'_>, expr: &str) -> bool {
    let multiplies =
        |text: &str| text.contains(['*', '/']) || text.contains("Math.") || text.contains("lib.");
    let is_read =
        |name: &str| expr.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name);
    expr.contains(['+', '-', '%'])
        || multiplies(expr)
        || bound.measure_texts().any(|(name, text)| multiplies(text) && is_read(name))
}

/// The values of the sweep whose list a cell states, where the claim names a row only: the row tells the member.
fn implied_values(checker: QuoteChecker<'_, '_>, is: &ColumnCells) -> Option<Text> {
    let expr = match is {
        ColumnCells::Number(expr) => expr,
        ColumnCells::Words(words) => &words.first()?.1,
    };
    // A list has a first number; the value of an expression that is a number has none.
    let first = checker.bound.find(&checker.outcomes.nominal, &part(expr, "[0]"), &mut Vec::new())?;
    if !matches!(first.value, Value::Number(_)) {
        return None;
    }
    let run = checker.bound.run_of_list(&part(expr, "[0]"))?;
    Some(Text::derived(format!("{run}.{}", name_of_axis(0)), expr.span()))
}

/// The members of a sweep that the rows of a table describe.
struct SweepRows<'c> {
    /// The list that distinguishes the rows, and its numbers.
    list: &'c Text,
    values: Vec<f64>,
    /// The dimension of the numbers.
    swept: Option<Dimension>,
    /// The unit in the heading of the column that distinguishes the rows.
    key_head: Option<quote::Unit>,
    languages: Languages,
}

impl SweepRows<'_> {
    /// The member that a row describes, by its key cell.
    ///
    /// # Errors
    /// No value of the sweep equals the number in the cell, or several do.
    fn member(&self, key: &Text) -> Result<usize, Box<Finding>> {
        let read = quote::read_quote_in(&key.value, self.languages).ok();
        let unit = read.as_ref().and_then(|read| read.unit().cloned()).or_else(|| self.key_head.clone());
        // Cells in millimetres are converted to the metres of the values. A cell of another dimension matches no value.
        let held =
            unit.as_ref().map_or(quote::UnitMatch::Unknown, |unit| quote::hold(unit, self.swept.as_ref()));
        let expected = unit.as_ref().and_then(|unit| unit.dimension);
        let converted =
            expected.zip(self.swept).and_then(|(expected, found)| quote::conversion(&expected, &found));
        let factor = match (held, converted) {
            (_, Some(factor)) => Some(factor),
            (quote::UnitMatch::Wrong, None) => None,
            _ => Some(1.0),
        };
        let scaled: Vec<f64> =
            self.values.iter().map(|x| factor.map_or(f64::NAN, |factor| factor * x)).collect();
        match read.as_ref().map_or(Vec::new(), |read| quote::stated_values(read, &scaled)).as_slice() {
            [member] => Ok(*member),
            [] => {
                let other = unit.filter(|_| factor.is_none()).map_or(String::new(), |unit| {
                    format!(": the column is in {}, but the values are in another unit", unit.text)
                });
                let message = format!("no run of the sweep matches the row \"{}\"{other}", key.value);
                let help = "add this value to the sweep, or correct the row";
                Err(self.refuse_row(key, message, help))
            }
            several => Err(self.refuse_row(
                key,
                self.describe_several(key, several),
                "state one value of the sweep in the row",
            )),
        }
    }

    /// States which values of the sweep a row may describe.
    fn describe_several(&self, key: &Text, members: &[usize]) -> String {
        let values = members.iter().filter_map(|i| self.values.get(*i));
        let list: Vec<String> = values.take(MOST_LISTED).map(|x| significant(*x)).collect();
        let more = if members.len() > list.len() { ", …" } else { "" };
        format!("the row \"{}\" describes several runs: {}{more}", key.value, list.join(", "))
    }

    /// The finding about a row that does not describe one run.
    fn refuse_row(&self, key: &Text, message: String, help: &str) -> Box<Finding> {
        let finding = Finding::new(rules::QUOTE_UNCLEAR, key.span(), message)
            .why("the number in this row was not compared")
            .help(help)
            .related(self.list.span(), "the values of the sweep");
        Box::new(finding)
    }
}

/// Compares the first cell of a row with what the expression of another cell reads: `cork` beside `force('iron')`.
fn check_row_name(
    checker: QuoteChecker<'_, '_>,
    key: &Text,
    text: &Text,
    is: &ColumnCells,
    findings: &mut Vec<Finding>,
) {
    if let ColumnCells::Number(expr) = is {
        let nominal = &checker.outcomes.nominal;
        check_words_of_measure(checker.bound, nominal, key.as_str(), text.span(), expr, findings);
    }
}

/// Checks one cell; `member` selects its number in a list.
fn check_cell(
    checker: QuoteChecker<'_, '_>,
    text: &Text,
    is: &ColumnCells,
    unit: &Option<quote::Unit>,
    member: &str,
    findings: &mut Vec<Finding>,
) -> Quote {
    match is {
        ColumnCells::Words(words) => check_word_cell(checker, text, words, member, findings),
        ColumnCells::Number(expr) => {
            let expr = part(expr, member);
            let unit = unit.clone().or_else(|| checker.rendered.unit_in_row(&text.span()));
            let places = vec![quote::QuotePlace {
                span: text.span(),
                unit,
                arithmetic: None,
                clause: quote::Clause::default(),
            }];
            let claim = quote::QuoteClaim { quote: text, part: text.as_str(), expr: &expr };
            let part = quote::whole(text.as_str(), checker.bound.stage().languages());
            match QuotedValue::measure(checker, &expr, findings) {
                Ok(given) => check_number(checker, &claim, &part, given, places, findings),
                Err(reason) => Quote::unclear(text, &reason),
            }
        }
    }
}

/// Checks a cell with a word: its condition holds, and the conditions of all other words do not.
fn check_word_cell(
    checker: QuoteChecker<'_, '_>,
    text: &Text,
    words: &[(Text, Text)],
    member: &str,
    findings: &mut Vec<Finding>,
) -> Quote {
    let expr = match condition_of_word(text, words) {
        Ok(expr) => part(expr, member),
        Err(finding) => return refused(text, *finding, findings),
    };
    let given = match QuotedValue::measure(checker, &expr, findings) {
        Ok(given) => given,
        Err(reason) => return Quote::unclear(text, &reason),
    };
    if !given.is_condition_of(checker, &expr, findings) {
        return Quote::unclear(text, "the expression for the word is not a condition");
    }
    if given.holds() {
        for (word, other) in
            words.iter().filter(|(w, _)| !quote::is_rendered_equally(w.as_str(), text.as_str()))
        {
            let other = part(other, member);
            if QuotedValue::measure(checker, &other, findings).is_ok_and(|given| !given.holds()) {
                continue;
            }
            let message = format!("\"{}\" may also be right in this row", word.value);
            let finding = Finding::error(rules::QUOTE_UNCLEAR, other.span(), message)
                .why("one of several words can be right only if the others are wrong")
                .help("write conditions that exclude each other")
                .related(text.span(), "the row");
            return refused(text, finding, findings);
        }
    }
    let claim = quote::QuoteClaim { quote: text, part: "", expr: &expr };
    check_words(checker, &claim, &given, &[text.span()], findings)
}

/// The condition of the word in a cell.
///
/// # Errors
/// The word has no condition, the column has too many words, or the cell contains a number that no condition checks.
fn condition_of_word<'w>(text: &Text, words: &'w [(Text, Text)]) -> Result<&'w Text, Box<Finding>> {
    let is_word = |(word, _): &&(Text, Text)| quote::is_rendered_equally(word.as_str(), text.as_str());
    let Some((_, expr)) = words.iter().find(is_word) else {
        let message = format!("no condition belongs to \"{}\"", text.value);
        let claimed: Vec<&str> = words.iter().map(|(word, _)| word.as_str()).collect();
        return Err(Box::new(
            Finding::new(rules::QUOTE_UNCLEAR, text.span(), message)
                .why("this cell was not compared")
                .help(format!("write one of {}, or add a condition for this word", claimed.join(", "))),
        ));
    };
    if words.len() > MOST_WORDS {
        let message =
            format!("a column has {} different words, but at most {MOST_WORDS} are allowed", words.len());
        return Err(Box::new(
            Finding::error(rules::QUOTE_UNCLEAR, text.span(), message)
                .why("nothing was compared")
                .help("claim its cells one by one, with `row`"),
        ));
    }
    if !quote::parts(text.as_str(), 0, Languages::ALL).is_empty() {
        let message = format!("\"{}\" contains a number that no condition checks", text.value);
        return Err(Box::new(
            Finding::error(rules::QUOTE_UNCLEAR, text.span(), message)
                .why("the cell would count as right with any number in it")
                .help("quote it under `says`: an expression for its number, and a condition for its words"),
        ));
    }
    Ok(expr)
}

/// A quote that could not be compared, with a finding that reports why.
fn refused(text: &Text, finding: Finding, findings: &mut Vec<Finding>) -> Quote {
    let quote = Quote::unclear(text, &finding.message);
    findings.push(finding);
    quote
}

/// The numbers of a list.
fn values(
    checker: QuoteChecker<'_, '_>,
    list: &Text,
    findings: &mut Vec<Finding>,
) -> Result<Vec<f64>, String> {
    let mut number = |text: &Text| {
        grounded_value(checker.bound, &checker.outcomes.nominal, text, findings).map(|f| f.value.to_number())
    };
    let count = number(&part(list, ".length"))?;
    (0..count.clamp(0.0, 1000.0) as usize).map(|i| number(&part(list, &format!("[{i}]")))).collect()
}

/// An expression with a suffix; its span is that of the whole.
pub(super) fn part(list: &Text, behind: &str) -> Text {
    if behind.is_empty() {
        return list.clone();
    }
    with_suffix(list, behind)
}

#[cfg(test)]
mod tests {
    /// The codes of the findings about a table with a cell under a heading.
    fn codes(heading: &str, is: &str, cell: &str) -> Vec<&'static str> {
        let xml = "<mujoco><option timestep='0.001'/><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>";
        let lab = serde_json::json!({"stopAt": 1, "xml": xml, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}],
            "verify": {"measure": {"t": "crossing(data.qpos[2])", "t2": "crossing(data.qpos[2]) ** 2"}, "table": [{"column": heading, "row": "Earth", "is": is}]}});
        let text =
            format!("```lab simlab\n{lab}\n```\n\n| planet | {heading} |\n|---|---|\n| Earth | {cell} |\n");
        let report = crate::Checker::new(|_: &str| None::<String>).check("fall.md", &text);
        report.findings.iter().map(|finding| finding.code).collect()
    }

    #[test]
    fn a_heading_that_computes_needs_an_expression_that_computes() {
        for heading in [
            "1000 t (s)",
            "time ×10³ (s)",
            "10³·time (s)",
            "2·time (s)",
            "√time (s)",
            "−time (s)",
            "log time",
            "time² (s)",
        ] {
            assert_eq!(codes(heading, "t", "0.451"), ["quote-unclear"], "{heading}");
        }
        assert_eq!(codes("1/time", "t", "0.451"), ["quote-unclear"]);
        assert_eq!(codes("time (s)", "t", "0.451"), [""; 0]);
        assert_eq!(codes("1000 t", "1000 * t", "451"), [""; 0]);
        // The measure itself is the square.
        assert_eq!(codes("t² (s²)", "t2", "0.2"), [""; 0]);
    }
}
