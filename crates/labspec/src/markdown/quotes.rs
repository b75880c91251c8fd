//! JSON whose quotes a word processor has made typographic: repaired, with a map back.

use super::extent::{is_quote, is_typographic, string_end};
use crate::finding::Finding;
use crate::lint::rules::quotes::TYPOGRAPHIC;
use crate::source::SourceMap;

/// Repaired JSON.
pub struct Repaired {
    /// JSON with straight quotes around its strings. Quotes inside of texts stay as they are.
    pub text: String,
    /// From the repaired text to the file.
    pub map: SourceMap,
    /// What is to be said about it.
    pub finding: Finding,
}

/// Replaces typographic quotes around strings; `None` when there are none. `below` maps `text` to the file.
pub fn repair_quotes(text: &str, below: &SourceMap) -> Option<Repaired> {
    let (mut fixed, mut map) = (String::with_capacity(text.len()), SourceMap::default());
    let mut replaced = Vec::new();
    let mut at = 0;
    let copy = |fixed: &mut String, map: &mut SourceMap, range: std::ops::Range<usize>| {
        fixed.push_str(text.get(range.clone()).unwrap_or(""));
        map.push_verbatim(range);
    };
    while let Some(c) = text.get(at..).and_then(|t| t.chars().next()) {
        let next = at + c.len_utf8();
        if !is_quote(c) {
            copy(&mut fixed, &mut map, at..next);
            at = next;
            continue;
        }
        let close = string_end(text, at);
        if c == '"' {
            copy(&mut fixed, &mut map, at..close.end);
        } else {
            replaced.push(at..next);
            fixed.push('"');
            map.push_whole(1, at..next);
            // A straight quote inside would now end the text: it gets its backslash.
            let mut escaped = false;
            for (i, inner) in text.get(next..close.start).unwrap_or("").char_indices() {
                let range = next + i..next + i + inner.len_utf8();
                if inner == '"' && !escaped {
                    fixed.push_str("\\\"");
                    map.push_whole(2, range);
                } else {
                    copy(&mut fixed, &mut map, range);
                }
                escaped = inner == '\\' && !escaped;
            }
            if !close.is_empty() {
                if text.get(close.clone()).is_some_and(|q| q.chars().all(is_typographic)) {
                    replaced.push(close.clone());
                }
                fixed.push('"');
                map.push_whole(1, close.clone());
            }
        }
        at = close.end.max(next);
    }
    let first = below.span(replaced.first()?.clone());
    let count = replaced.len();
    let mut finding = Finding::new(
        &TYPOGRAPHIC,
        first,
        format!("{count} typographic quote{} where JSON needs \"", if count == 1 { "" } else { "s" }),
    )
    .help("write straight quotes: \"model\": \"…\"; here they were read as straight ones, so the rest is checked");
    if let Some(last) = replaced.last().filter(|_| count > 1) {
        finding = finding.related(below.span(last.clone()), "the last one");
    }
    // One replacement repairs it all, if the text stands in one piece in the file.
    if let [piece] = below.pieces()
        && piece.verbatim
    {
        let kept = fixed.trim_end();
        finding = finding.fix(below.span(0..text.trim_end().len()), kept);
    }
    let map = map.then(below);
    Some(Repaired { text: fixed, map, finding })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_quotes_around_strings_are_replaced() {
        let text = "{“say”: “a “b” \"c\" ball’s”, \"x\": \"“kept”\", ‘one’: 1}";
        let repaired = repair_quotes(text, &SourceMap::verbatim(0..text.len())).unwrap();
        assert_eq!(repaired.text, "{\"say\": \"a “b” \\\"c\\\" ball’s\", \"x\": \"“kept”\", \"one\": 1}");
        let at = repaired.text.find("ball").unwrap();
        assert_eq!(&text[repaired.map.span(at..at + 4)], "ball");
        assert!(repaired.finding.message.starts_with("6 typographic quotes"));
        assert!(repair_quotes("{\"x\": \"“kept”\"}", &SourceMap::verbatim(0..20)).is_none());
    }
}
