//! The numbers that a lesson states: every rendered number, with its unit and context.

use super::context::BOUND;
use super::markdown_cell::{MAX_ROW_LENGTH, MarkdownCell, unit_of_head};
use super::number::Quoted;
use super::numeral::Chars;
use super::pieces::rendered_pieces;
use super::quantity::separate_quantities;
use super::read::quoted;
use super::rendered::RenderedText;
use super::table_cells::cells_of_column;
use super::unit_text::Unit;
use super::{fold, html};
use crate::source::Text;
use crate::spec::{Lesson, QuestionKind, Quiz};
use labspec_bind::units::parse;
use labspec_expr::dimension::Dimension;
use std::ops::Range;
use std::sync::Arc;

/// A number of the text.
#[derive(Clone, Debug)]
pub struct Stated {
    /// Number and unit in the form of a quote: `0.442 s`.
    pub quote: String,
    /// Its span in the file.
    pub span: Range<usize>,
    /// The number.
    pub read: Quoted,
    /// Its unit as written, possibly from the heading of its column.
    pub unit: String,
    /// The dimension of the unit.
    pub dimension: Dimension,
    /// The sentence, or the row of a table, that contains it.
    pub context: String,
    /// The heading of its column; empty outside of tables.
    pub column: String,
    /// The paragraph as written, without tags.
    pub paragraph: Arc<str>,
    /// The index of the number in the paragraph.
    pub offset: usize,
    /// Whether it is a bound: "above 5 mm".
    pub bound: bool,
    /// Whether it is the answer of a numeric question, which is not rendered.
    pub answer: bool,
}

/// Maximum number of numbers of one lesson.
const MAX_NUMBERS: usize = 1000;

/// Every number with a unit in the rendered text of a lesson, and the answers of its numeric questions.
pub fn stated(lesson: &Lesson) -> Vec<Stated> {
    let mut all = Vec::new();
    for text in rendered_pieces(lesson) {
        if text.value.contains(|c: char| c.is_ascii_digit()) {
            add_numbers(lesson, &text, &mut all);
        }
        if all.len() > MAX_NUMBERS {
            break;
        }
    }
    all.extend(lesson.quizzes.iter().flat_map(Quiz::numbered).filter_map(|(_, question)| {
        let QuestionKind::Numeric { answer: Some(answer), unit, .. } = &question.kind else { return None };
        let unit = unit.as_ref().map_or("", |u| u.as_str());
        let dimension = if unit.is_empty() { Dimension::NUMBER } else { parse(unit)? };
        let text = lesson.file.text().get(answer.span.clone())?;
        let (asked, _) = html::strip(&question.q.value);
        Some(Stated {
            quote: text.to_string(),
            span: answer.span.clone(),
            read: quoted(text).ok()?,
            unit: unit.to_string(),
            dimension,
            context: asked.clone(),
            column: String::new(),
            paragraph: Arc::from(asked),
            offset: 0,
            bound: false,
            answer: true,
        })
    }));
    all.truncate(MAX_NUMBERS);
    all.sort_by_key(|s| (s.span.start, s.span.end));
    all
}

/// The places of the texts that the lesson quotes.
pub fn claimed(lesson: &Lesson) -> Vec<Range<usize>> {
    let rendered = RenderedText::of_lesson(lesson);
    let mut all = Vec::new();
    for (verify, block) in lesson.scoped() {
        let narrow = block.map(|block| rendered.within(block, verify));
        let rendered = narrow.as_ref().unwrap_or(&rendered);
        for quoted in &verify.says {
            // A quote that is one number claims the number at its beginning, and not the other end of a range.
            let number = quoted.exprs.len() == 1
                && quoted.quote.as_str().trim_start().starts_with(|c: char| c.is_ascii_digit());
            let place = |span: Range<usize>| if number { span.start..span.start + 1 } else { span };
            all.extend(rendered.places(quoted.quote.as_str()).into_iter().map(place));
        }
        let cells = verify.table.iter().filter_map(|claim| cells_of_column(claim, rendered).ok());
        all.extend(cells.flatten().flatten().map(|cell| cell.span()));
    }
    all
}

/// The numbers of a lesson, divided into claimed and unclaimed ones.
#[derive(Clone, Debug, Default)]
pub struct Counted {
    /// Those with a claim.
    pub claimed: Vec<Stated>,
    /// The others, in the order of the text.
    pub left: Vec<Stated>,
    /// Numbers that are not counted: bounds, which cannot be quoted, the answers of numeric questions, and the options of
    /// questions, of which only one is right.
    pub others: Vec<Stated>,
}

impl Counted {
    /// The number of numbers with and without a claim.
    pub fn count(&self) -> usize {
        self.claimed.len() + self.left.len()
    }
}

/// Divides the numbers of a lesson into claimed and unclaimed ones.
pub fn counted(lesson: &Lesson) -> Counted {
    let places = claimed(lesson);
    let meets = |s: &Stated| places.iter().any(|span| span.start < s.span.end && s.span.start < span.end);
    let options = options(lesson);
    let is_option =
        |s: &Stated| options.iter().any(|span| span.start <= s.span.start && s.span.end <= span.end);
    let is_other = |s: &Stated| s.answer || !meets(s) && (s.bound || is_option(s));
    let (others, counted): (Vec<Stated>, Vec<Stated>) = stated(lesson).into_iter().partition(is_other);
    let (claimed, left) = counted.into_iter().partition(meets);
    Counted { claimed, left, others }
}

/// The places of the options of all questions.
fn options(lesson: &Lesson) -> Vec<Range<usize>> {
    let questions = lesson.quizzes.iter().flat_map(Quiz::numbered).map(|(_, question)| question);
    let options = questions.filter_map(|question| match &question.kind {
        QuestionKind::Choice { options, .. } => Some(options),
        _ => None,
    });
    options.flatten().map(Text::span).collect()
}

/// The places of the answers of numeric questions that a `value` computes.
pub fn answered(lesson: &Lesson) -> impl Iterator<Item = Range<usize>> {
    let questions = lesson.quizzes.iter().flat_map(Quiz::numbered).map(|(_, question)| question);
    let claimed = questions.filter(|q| q.verify.as_ref().is_some_and(|verify| verify.value.is_some()));
    claimed.filter_map(|q| match &q.kind {
        QuestionKind::Numeric { answer, .. } => answer.as_ref().map(|answer| answer.span.clone()),
        _ => None,
    })
}

fn add_numbers(lesson: &Lesson, text: &Text, all: &mut Vec<Stated>) {
    let paragraph: Arc<str> = Arc::from(text.value.as_str());
    let (folded, map) = fold::fold(&text.value, false);
    let chars: Vec<char> = folded.chars().collect();
    let bytes: Vec<usize> = folded.char_indices().map(|(offset, _)| offset).chain([folded.len()]).collect();
    let found = separate_quantities(Chars(&chars));
    for q in found.into_iter().rev() {
        let byte = |i: usize| bytes.get(i).copied();
        let (Some(start), Some(end)) = (byte(q.whole.start), byte(q.whole.end)) else { continue };
        let Some(number_end) = byte(q.number_end) else { continue };
        if all.len() > MAX_NUMBERS {
            return;
        }
        let q = q.with_comma(lesson.conventions.languages);
        let bound = q.refused == Some(BOUND);
        if q.refused.is_some() && !bound || !q.quoted.value.is_finite() {
            continue;
        }
        let origin = map.span(start..number_end);
        let span = text.map.span(origin.clone());
        let cell = MarkdownCell::at(lesson.file.text(), span.start);
        let of_head = || cell.as_ref().and_then(|cell| unit_of_head(&cell.head));
        let Some(unit) = q.unit.filter(Unit::is_own).or_else(of_head) else { continue };
        let Some(dimension) = unit.dimension else { continue };
        all.push(Stated {
            quote: folded.get(start..end).unwrap_or("").to_string(),
            span: span.start..text.map.span(map.span(start..end)).end,
            read: q.quoted,
            unit: unit.text,
            dimension,
            context: cell.as_ref().map_or_else(|| sentence(&folded, start).to_string(), |c| c.row.clone()),
            column: cell.map_or(String::new(), |c| c.head),
            paragraph: paragraph.clone(),
            offset: origin.start,
            bound,
            answer: false,
        });
    }
}

/// The sentence around an index: from the last full stop to the next one.
fn sentence(text: &str, mut offset: usize) -> &str {
    let ends = |tail: &str| tail.starts_with(". ") || tail.starts_with("; ") || tail.starts_with(".\n");
    let text = around(text, &mut offset);
    let before = text.get(..offset).unwrap_or("");
    let start = before.char_indices().rev().find(|(i, _)| ends(before.get(*i..).unwrap_or("")));
    let start = start.map_or(0, |(i, _)| i + 2);
    let after = text.get(offset..).unwrap_or("");
    let end = after.char_indices().find(|(i, _)| ends(after.get(*i..).unwrap_or("")));
    text.get(start..end.map_or(text.len(), |(i, _)| offset + i)).unwrap_or("")
}

/// The text near an index, which is changed to the index in the returned text.
fn around<'t>(text: &'t str, offset: &mut usize) -> &'t str {
    let edge = |mut i: usize| {
        while !text.is_char_boundary(i) {
            i -= 1;
        }
        i
    };
    let (from, to) =
        (edge(offset.saturating_sub(MAX_ROW_LENGTH)), edge((*offset + MAX_ROW_LENGTH).min(text.len())));
    *offset -= from;
    text.get(from..to).unwrap_or("")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_shared() {
        let lesson = crate::spec::read_lesson(crate::source::SourceFile::new(
            "a.md",
            "It rises from 2.31 to 3.73 N m, in 3 steps.\n",
        ));
        let found: Vec<(String, String)> = stated(&lesson).into_iter().map(|s| (s.quote, s.unit)).collect();
        let pair = |a: &str, b: &str| (a.to_string(), b.to_string());
        assert_eq!(found, [pair("2.31", "N m"), pair("3.73 N m", "N m")]);
    }
}
