//! Lays out JSON: indentation, spaces and line breaks. The texts and numbers of the author are kept as written, and so is the
//! order of keys.
//!
//! An object or a list is in one line if it fits, except where the author has a line break after its opening bracket. In others, the
//! line breaks of the author between members and items are kept, and lines that are too long are broken.

use super::MAX_DEPTH;

/// Maximum number of characters of a line, if its texts are not longer.
const WIDTH: usize = 100;
/// Spaces by which the content of an object or a list is indented.
const INDENT: usize = 2;

/// A value as written.
enum Written<'t> {
    /// A text, a number or a word.
    Scalar(&'t str),
    /// An object or a list.
    Group { brackets: [char; 2], items: Vec<Item<'t>>, is_open: bool },
}

/// A member of an object, or an item of a list.
struct Item<'t> {
    key: Option<&'t str>,
    value: Written<'t>,
    /// Whether the author has it on a line of its own.
    on_new_line: bool,
}

/// The same JSON with another layout, after `column` characters of its first line; `None` if the text is not valid JSON, or
/// nested too deeply.
pub fn lay_out(text: &str, column: usize) -> Option<String> {
    let mut reader = Reader { rest: text, depth: 0 };
    let value = reader.value()?;
    reader.space();
    if !reader.rest.is_empty() {
        return None;
    }
    let mut out = String::new();
    Layout { start: column, out: &mut out }.write(&value, 0);
    Some(out)
}

struct Reader<'t> {
    rest: &'t str,
    depth: usize,
}

impl<'t> Reader<'t> {
    /// Skips white space. Returns whether it contains a line break.
    fn space(&mut self) -> bool {
        let rest = self.rest.trim_start_matches([' ', '\t', '\r', '\n']);
        let skipped = self.rest.len() - rest.len();
        let breaks = self.rest.get(..skipped).is_some_and(|space| space.contains('\n'));
        self.rest = rest;
        breaks
    }

    fn take(&mut self, c: char) -> Option<()> {
        self.rest = self.rest.strip_prefix(c)?;
        Some(())
    }

    fn value(&mut self) -> Option<Written<'t>> {
        self.space();
        match self.rest.chars().next()? {
            '{' => self.group(['{', '}']),
            '[' => self.group(['[', ']']),
            '"' => Some(Written::Scalar(self.string()?)),
            _ => {
                let end = self.rest.find(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c)));
                let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
                serde_json::from_str::<serde_json::Value>(word).ok()?;
                self.rest = rest;
                Some(Written::Scalar(word))
            }
        }
    }

    fn group(&mut self, brackets: [char; 2]) -> Option<Written<'t>> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return None;
        }
        let [open, close] = brackets;
        self.take(open)?;
        let is_open = self.space();
        let mut items = Vec::new();
        if self.take(close).is_none() {
            let mut on_new_line = true;
            loop {
                let key = match open {
                    '{' => Some(self.string()?),
                    _ => None,
                };
                if key.is_some() {
                    self.space();
                    self.take(':')?;
                }
                items.push(Item { key, value: self.value()?, on_new_line });
                self.space();
                match self.take(',') {
                    Some(()) => on_new_line = self.space(),
                    None => break self.take(close)?,
                }
            }
        }
        self.depth -= 1;
        Some(Written::Group { brackets, items, is_open })
    }

    /// A text with its quotes, as written.
    fn string(&mut self) -> Option<&'t str> {
        let mut escaped = false;
        let end = self.rest.char_indices().skip(1).find(|(_, c)| {
            let ends = *c == '"' && !escaped;
            escaped = *c == '\\' && !escaped;
            ends
        });
        let (text, rest) = self.rest.split_at(end?.0 + 1);
        serde_json::from_str::<String>(text).ok()?;
        self.rest = rest;
        Some(text)
    }
}

/// The number of characters of a value in one line; `None` if it contains an open group, or more than fit.
fn flat_length(value: &Written<'_>, most: usize) -> Option<usize> {
    let length = match value {
        Written::Scalar(text) => text.chars().count(),
        Written::Group { items, is_open, .. } => {
            if *is_open && !items.is_empty() {
                return None;
            }
            let mut length = 2 + 2 * items.len().saturating_sub(1);
            for item in items {
                length += item.key.map_or(0, |key| key.chars().count() + 2);
                length += flat_length(&item.value, most.checked_sub(length)?)?;
            }
            length
        }
    };
    (length <= most).then_some(length)
}

/// The text being written, after `start` characters of its first line.
struct Layout<'o> {
    start: usize,
    out: &'o mut String,
}

impl Layout<'_> {
    /// The number of characters of the current line.
    fn column(&self) -> usize {
        match self.out.rsplit_once('\n') {
            Some((_, line)) => line.chars().count(),
            None => self.start + self.out.chars().count(),
        }
    }

    fn new_line(&mut self, indent: usize) {
        self.out.push('\n');
        self.out.extend(std::iter::repeat_n(' ', indent));
    }

    /// Writes a value in a group with this indentation.
    fn write(&mut self, value: &Written<'_>, indent: usize) {
        let ([open, close], items) = match value {
            Written::Scalar(text) => return self.out.push_str(text),
            Written::Group { brackets, items, .. } => (brackets, items),
        };
        self.out.push(*open);
        // A comma may follow.
        let fits = WIDTH.checked_sub(self.column()).and_then(|most| flat_length(value, most)).is_some();
        if fits || items.is_empty() {
            for (i, item) in items.iter().enumerate() {
                self.out.push_str(if i > 0 { ", " } else { "" });
                self.write_item(item, indent);
            }
        } else {
            let inside = indent + INDENT;
            let mut ends_line = true;
            for (i, item) in items.iter().enumerate() {
                if i > 0 {
                    self.out.push(',');
                }
                if ends_line || !self.stays(item) {
                    self.new_line(inside);
                } else {
                    self.out.push(' ');
                }
                let start = self.out.len();
                self.write_item(item, inside);
                ends_line = self.out.get(start..).is_some_and(|written| written.contains('\n'));
            }
            self.new_line(indent);
        }
        self.out.push(*close);
    }

    /// Whether an item follows the previous one on its line.
    fn stays(&self, item: &Item<'_>) -> bool {
        // A group with line breaks needs room for its bracket.
        let length = flat_length(&item.value, usize::MAX >> 1).unwrap_or(1);
        let key = item.key.map_or(0, |key| key.chars().count() + 2);
        !item.on_new_line && self.column() + 1 + key + length < WIDTH
    }

    fn write_item(&mut self, item: &Item<'_>, indent: usize) {
        if let Some(key) = item.key {
            self.out.push_str(key);
            self.out.push_str(": ");
        }
        self.write(&item.value, indent);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde_json::{Value, json};

    #[test]
    fn groups_are_in_one_line_if_they_fit() {
        assert_eq!(lay_out("{ \"a\" :1,\n\"b\":[ 1,2 , 3 ] }", 0).unwrap(), r#"{"a": 1, "b": [1, 2, 3]}"#);
        assert_eq!(lay_out("{}", 0).unwrap(), "{}");
        assert_eq!(lay_out("{\n}", 0).unwrap(), "{}");
        let long = format!("{{\"a\": \"{}\", \"b\": {{\"c\": 1.50, \"d\": []}}}}", "x".repeat(90));
        let laid_out =
            format!("{{\n  \"a\": \"{}\",\n  \"b\": {{\"c\": 1.50, \"d\": []}}\n}}", "x".repeat(90));
        assert_eq!(lay_out(&long, 0).unwrap(), laid_out);
    }

    #[test]
    fn line_breaks_of_the_author_are_kept_in_open_groups() {
        let text = "{\n\"a\":1, \"b\": 2,\n  \"c\": [\n    1,0,\n    0,1\n  ]\n}";
        let laid_out = "{\n  \"a\": 1, \"b\": 2,\n  \"c\": [\n    1, 0,\n    0, 1\n  ]\n}";
        assert_eq!(lay_out(text, 0).unwrap(), laid_out);
        assert_eq!(lay_out(laid_out, 0).unwrap(), laid_out);
        assert_eq!(lay_out("{\"a\": 1,\n\"b\": 2}", 0).unwrap(), r#"{"a": 1, "b": 2}"#);
    }

    #[test]
    fn long_lists_of_numbers_fill_their_lines() {
        let list: Vec<u32> = (1000..1050).collect();
        let text = lay_out(&json!({"values": list}).to_string(), 0).unwrap();
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
        assert_eq!(text.lines().count(), 8, "{text}");
    }

    #[test]
    fn what_is_not_json_is_refused() {
        for text in [
            "",
            "{",
            "{\"a\": 1,}",
            "{'a': 1}",
            "[1 2]",
            "{\"a\": 01}",
            "1 2",
            "{\"a\": .5}",
            "\"\\q\"",
            "{\"a\"}",
        ] {
            assert_eq!(lay_out(text, 0), None, "{text}");
        }
        assert_eq!(lay_out(&"[".repeat(100_000), 0), None);
    }

    fn value() -> impl Strategy<Value = Value> {
        let leaf = prop_oneof![
            Just(Value::Null),
            any::<bool>().prop_map(Value::from),
            any::<i32>().prop_map(Value::from),
            "[a-z \"\\\\é\n]{0,60}".prop_map(Value::from),
        ];
        leaf.prop_recursive(5, 40, 6, |inner| {
            prop_oneof![
                prop::collection::vec(inner.clone(), 0..6).prop_map(Value::from),
                prop::collection::btree_map("[a-z]{1,9}", inner, 0..6)
                    .prop_map(|map| Value::from(serde_json::Map::from_iter(map))),
            ]
        })
    }

    proptest! {
        /// The value is unchanged, and a second layout changes nothing.
        #[test]
        fn the_value_is_unchanged(value in value(), pretty in any::<bool>()) {
            let text = if pretty { serde_json::to_string_pretty(&value) } else { serde_json::to_string(&value) }.unwrap();
            let once = lay_out(&text, 0).unwrap();
            prop_assert_eq!(serde_json::from_str::<Value>(&once).unwrap(), value);
            let twice = lay_out(&once, 0).unwrap();
            prop_assert_eq!(twice, once);
        }
    }
}
