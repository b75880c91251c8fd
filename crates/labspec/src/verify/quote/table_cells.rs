//! The cells that a claim about a column of a table refers to.

use super::rendered::RenderedText;
use super::table;
use crate::json::nearest;
use crate::source::{SourceMap, Text};
use crate::spec::Column;

/// The cells of a column, or the one claimed cell, each with the cell that identifies its row. A cell that is given by its number
/// is in the only table with such a row.
///
/// # Errors
/// Why there are no cells, and the help.
pub(in crate::verify) fn cells_of_column(
    claim: &Column,
    rendered: &RenderedText,
) -> Result<Vec<[Text; 2]>, [String; 2]> {
    if let Some((cell, row)) = claim.cell.zip(claim.row.as_ref()) {
        return numbered_cell(cell, row, rendered).map(|cells| vec![cells]);
    }
    let key = claim.by.as_ref().map(|(heading, _)| heading.as_str());
    let headings: Vec<&str> = [Some(claim.column.as_str()), key].into_iter().flatten().collect();
    let mut found = rendered.tables(&headings);
    let (Some(table), None) = (found.next(), found.next()) else {
        let several = rendered.tables(&headings).count() > 1;
        let mut headings_there: Vec<&str> = rendered.headings().take(24).collect();
        headings_there.dedup();
        return Err(if several {
            [
                format!("several tables have the columns {}", headings.join(", ")),
                "give the tables different headings".into(),
            ]
        } else {
            let near = headings
                .iter()
                .find(|h| !headings_there.contains(h))
                .and_then(|h| nearest(h, headings_there.iter().copied()));
            let help = near.map_or_else(
                || format!("use the columns of a table: {}", headings_there.join(", ")),
                |right| format!("did you mean \"{right}\"?"),
            );
            [format!("no table has the columns {}", headings.join(", ")), help]
        });
    };
    let column_of = |heading: &str| table.column(heading).unwrap_or(0);
    let (column, by) = (column_of(claim.column.as_str()), key.map_or(0, column_of));
    let row_text = claim.row.as_ref().map(|row| table::rendered(row.as_str()));
    let rows = table.rows.iter().filter_map(|row| Some([text(row.get(by)?), text(row.get(column)?)]));
    let cells: Vec<[Text; 2]> =
        rows.filter(|[key, _]| row_text.as_ref().is_none_or(|w| *w == key.value)).collect();
    match (cells.is_empty(), &claim.row) {
        (false, _) => Ok(cells),
        (true, Some(row)) => Err([
            format!("no row of this table begins with \"{}\"", row.value),
            "write the text in the first cell of the row".into(),
        ]),
        (true, None) => Err(["this table has no rows".into(), "add rows to the table".into()]),
    }
}

fn text(cell: &table::TableCell) -> Text {
    Text { value: cell.text.clone(), map: SourceMap::whole(cell.text.len(), cell.span.clone()) }
}

/// A cell of the only row that begins with a text, after the first cell of the row.
///
/// # Errors
/// Why there is no such cell, and the help.
fn numbered_cell(cell: usize, row: &Text, rendered: &RenderedText) -> Result<[Text; 2], [String; 2]> {
    let first = table::rendered(row.as_str());
    let mut rows = rendered
        .tables(&[])
        .flat_map(|table| &table.rows)
        .filter(|row| row.first().is_some_and(|cell| cell.text == first));
    match (rows.next(), rows.next()) {
        (Some(cells), None) => match cells.first().zip(cells.get(cell)) {
            Some((key, found)) => Ok([text(key), text(found)]),
            None => Err([
                format!("the row \"{}\" has {} cells, so it has no cell {cell} after the first", row.value, cells.len()),
                "write one expression for each cell after the first, and `null` for a cell that is not claimed".into(),
            ]),
        },
        (None, _) => Err([
            format!("no row of a table begins with \"{}\"", row.value),
            "write the text in the first cell of the row".into(),
        ]),
        (Some(_), Some(_)) => Err([
            format!("several rows begin with \"{}\"", row.value),
            "name the column with `column`, or write the claim in a comment before the table".into(),
        ]),
    }
}

/// Whether two texts are rendered equally.
pub(in crate::verify) fn is_rendered_equally(a: &str, b: &str) -> bool {
    table::rendered(a) == table::rendered(b)
}
