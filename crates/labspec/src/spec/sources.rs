//! What a claim takes from elsewhere: the values of a sweep from a file, `{"file": "masses.csv"}`, and the model of a lab from a
//! listing of the lesson, `{"listing": "pendulum.xml"}`. Both are replaced in the JSON of a `verify` object by what they refer
//! to, so that only this module knows of them.

use super::claim::MOST_SWEPT;
use super::fields::Fields;
use super::format::{FILE_VALUES, LISTING};
use super::lesson::{DataFile, Lesson};
use super::problem::{Mistake, Problem};
use crate::json::{self, Json, Node};
use crate::markdown::{BlockKind, Scan};
use crate::source::{SourceMap, Sources, Text};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Maximum number of bytes of a file with values.
const MAX_DATA: u64 = 1 << 20;
/// Maximum number of bytes of listings that are inserted into one block. A listing counts each time.
const MAX_LISTINGS: usize = 8 << 20;
/// Maximum number of files with values that a lesson refers to.
const MAX_FILES: usize = 100;

/// Parses the JSON of a block, or of a comment that is a `verify` object itself. If it is malformed, the valid parts are read.
/// References in claims are replaced by what they refer to.
pub(super) fn read_json(
    text: &str,
    map: &SourceMap,
    span: Range<usize>,
    (scan, is_verify): (&Scan, bool),
    lesson: &mut Lesson,
) -> Option<Node> {
    let parsed = json::parse(text, map);
    if parsed.broken {
        lesson.broken.push(span);
    }
    lesson.problems.extend(parsed.problems.into_iter().map(Problem::Json));
    let mut node = parsed.node?;
    let mut found = Found {
        scan,
        place: lesson.place.as_ref(),
        data: &mut lesson.data,
        problems: &mut lesson.problems,
        left: MAX_LISTINGS,
    };
    found.walk(&mut node, is_verify);
    Some(node)
}

/// What references refer to.
struct Found<'l> {
    scan: &'l Scan,
    place: Option<&'l (PathBuf, Sources)>,
    data: &'l mut Vec<DataFile>,
    problems: &'l mut Vec<Problem>,
    /// The number of bytes of listings that may still be inserted.
    left: usize,
}

impl Found<'_> {
    fn walk(&mut self, node: &mut Node, in_verify: bool) {
        match &mut node.json {
            Json::Array(items) => items.iter_mut().for_each(|item| self.walk(item, in_verify)),
            Json::Object(members) => {
                for member in members {
                    match member.key.as_str() {
                        "sweep" if in_verify => self.sweep(&mut member.value),
                        "xml" if in_verify => self.model(&mut member.value),
                        key => self.walk(&mut member.value, in_verify || key == "verify"),
                    }
                }
            }
            _ => {}
        }
    }

    fn sweep(&mut self, node: &mut Node) {
        let Json::Object(members) = &mut node.json else { return };
        for member in members.iter_mut().filter(|m| m.value.get("file").is_some()) {
            let span = member.value.span.clone();
            member.value.json = match self.values(&member.value) {
                None => Json::Broken,
                Some(Err((name, why))) => {
                    self.problems.push(Mistake::NoSource(name, why).at(span));
                    Json::Broken
                }
                Some(Ok(values)) => {
                    Json::Array(values.into_iter().map(|json| Node { json, span: span.clone() }).collect())
                }
            };
        }
    }

    /// The values of `{"file": …, "column": …}`; `None` if this is reported.
    fn values(&mut self, node: &Node) -> Option<Result<Vec<Json>, (String, String)>> {
        let mut fields = Fields::open(node, &FILE_VALUES, self.problems)?;
        let (file, column) = (fields.text("file"), fields.text("column"));
        fields.finish();
        let file = file?;
        let name = file.value.clone();
        let text = match self.text(&name) {
            Ok(text) => text,
            Err(why) => return Some(Err((name, why))),
        };
        let values = column_of(&text, column.as_ref().map(Text::as_str));
        Some(values.map_err(|why| (name, why)))
    }

    /// The text of a file, which is read once.
    fn text(&mut self, name: &str) -> Result<Arc<str>, String> {
        let Some((lesson, sources)) = self.place else { return Err("only this lesson was given".into()) };
        // Absolute paths are refused, because an untrusted lesson could name any file of this machine.
        if !Path::new(name).is_relative() {
            return Err("a file must be named by its path from the lesson".into());
        }
        let place = sources.followed(lesson);
        let path = place.parent().unwrap_or(Path::new("")).join(name);
        if let Some(file) = self.data.iter().find(|file| file.path == path) {
            return file.text.clone();
        }
        if self.data.len() >= MAX_FILES {
            return Err(format!("this lesson refers to more than {MAX_FILES} files"));
        }
        let text = sources.text(&path, MAX_DATA, "a file with values").map(Arc::from);
        self.data.push(DataFile { path, text: text.clone() });
        text
    }

    fn model(&mut self, node: &mut Node) {
        if node.get("listing").is_none() {
            return;
        }
        let span = node.span.clone();
        let Some(mut fields) = Fields::open(node, &LISTING, self.problems) else { return };
        let name = fields.text("listing");
        fields.finish();
        let listings = || {
            self.scan.blocks.iter().filter_map(|block| match &block.kind {
                BlockKind::Code { file: Some(file), .. } => Some((file.as_str(), &block.body)),
                _ => None,
            })
        };
        let found = name.and_then(|name| {
            let mut same = listings().filter(|(file, _)| *file == name.value).map(|(_, body)| body);
            match (same.next(), same.next()) {
                (Some(body), None) if body.value.len() <= self.left => {
                    self.left -= body.value.len();
                    Some(Json::Text(body.clone()))
                }
                (first, second) => {
                    let why = match first {
                        Some(_) if second.is_none() => {
                            "the claims refer to too many long listings".to_string()
                        }
                        Some(_) => "the lesson shows two listings with this `file`".to_string(),
                        None => match listings().map(|(file, _)| file).take(12).collect::<Vec<_>>() {
                            all if all.is_empty() => {
                                "no listing of the lesson has a `file`: write ```xml file=NAME".to_string()
                            }
                            all => format!("the lesson shows the listings {}", all.join(", ")),
                        },
                    };
                    self.problems.push(Mistake::NoSource(name.value, why).at(span));
                    None
                }
            }
        });
        node.json = found.unwrap_or(Json::Broken);
    }
}

/// The values of a column of a text, by its heading, or of the only column.
///
/// # Errors
/// The reason that there are none.
fn column_of(text: &str, column: Option<&str>) -> Result<Vec<Json>, String> {
    let text = text.trim_start_matches('\u{feff}');
    let lines = || text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let first = lines().next().ok_or("it contains no values")?;
    let separator = ['\t', ';', ','].into_iter().find(|c| cells(first, *c).len() > 1).unwrap_or('\n');
    let heads = cells(first, separator);
    let is_head = heads.iter().any(|head| head.parse::<f64>().is_err());
    let place = match column {
        Some(column) => heads.iter().position(|head| head == column).ok_or_else(|| {
            let listed: Vec<String> = heads.iter().take(12).map(|head| format!("`{head}`")).collect();
            format!("it has no column `{column}`; its columns are {}", listed.join(", "))
        })?,
        None if heads.len() > 1 => {
            return Err(format!("it has {} columns: add `column` with the heading of one", heads.len()));
        }
        None => 0,
    };
    let skipped = usize::from(is_head || column.is_some());
    let value = |(i, line): (usize, &str)| {
        let cell = cells(line, separator).into_iter().nth(place);
        let number = cell.as_deref().and_then(|cell| cell.parse::<f64>().ok()).filter(|x| x.is_finite());
        number.map(Json::Number).ok_or_else(|| {
            let found = cell
                .filter(|cell| !cell.is_empty())
                .map_or("no value".into(), |cell| format!("`{cell}`, which is not a number"));
            format!("row {} of this column has {found}", i + 1)
        })
    };
    // One more than a sweep can have: it is then refused.
    lines().skip(skipped).enumerate().take(MOST_SWEPT + 1).map(value).collect()
}

/// The cells of a line, without the quotes around them. A separator within quotes belongs to its cell.
fn cells(line: &str, separator: char) -> Vec<String> {
    let mut all = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            c if c == separator && !quoted => all.push(String::new()),
            c => all.last_mut().into_iter().for_each(|cell| cell.push(c)),
        }
    }
    all.iter().map(|cell| cell.trim().to_string()).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    fn numbers(text: &str, column: Option<&str>) -> Result<Vec<f64>, String> {
        let all = column_of(text, column)?.into_iter().map(|json| match json {
            Json::Number(x) => x,
            other => panic!("{other:?}"),
        });
        Ok(all.collect())
    }

    #[test]
    fn columns_are_read_with_every_separator() {
        for separator in [",", ";", "\t"] {
            let text = ["mass (kg),\"period, s\",note", "1,0.5,a", "", "# a remark", "2.5,1e-1,b"]
                .map(|line| line.replace("period, s", "period").replace(',', separator))
                .join("\r\n");
            assert_eq!(numbers(&text, Some("mass (kg)")).unwrap(), [1.0, 2.5], "{separator:?}");
            assert_eq!(numbers(&text, Some("period")).unwrap(), [0.5, 0.1]);
        }
        assert_eq!(numbers("a,\"b, c\"\n1,2\n", Some("b, c")).unwrap(), [2.0]);
        assert_eq!(numbers("\u{feff}1\n2\n3\n", None).unwrap(), [1.0, 2.0, 3.0]);
        assert_eq!(numbers("mass\n1\n2", None).unwrap(), [1.0, 2.0]);
    }

    #[test]
    fn files_without_values_are_explained() {
        let why = |text, column| numbers(text, column).unwrap_err();
        assert_eq!(why("", None), "it contains no values");
        assert!(why("a,b\n1,2", None).contains("2 columns"));
        assert!(why("a,b\n1,2", Some("c")).contains("its columns are `a`, `b`"));
        assert_eq!(why("a,b\n1,2\n3", Some("b")), "row 2 of this column has no value");
        assert!(why("a\n1\nx", None).contains("row 2 of this column has `x`"));
    }
}
