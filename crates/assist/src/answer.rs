//! What an editor on a page receives, as JSON: from the checker in the page (`bindings/wasm`), and from the server of the preview.
//! Offsets count UTF-16 code units, as JavaScript does, from the start of what the editor shows.

use super::item::{Completion, Edit, Hover, TextFix};
use super::utf16::Utf16Offsets;
use labspec::finding::Finding;
use serde::Serialize;
use std::ops::Range;

/// A replacement.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct EditAnswer<'a> {
    /// The offset of its start.
    pub start: usize,
    /// The offset of its end.
    pub end: usize,
    /// What is written there.
    pub text: &'a str,
}

/// An edit that resolves a finding.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FixAnswer<'a> {
    /// What it does.
    pub title: &'a str,
    /// `safe`, `guess` or `suppression`.
    pub kind: &'static str,
    /// Its edits; there is one.
    pub edits: [EditAnswer<'a>; 1],
}

/// A finding. The owner of the text decides what its offsets count.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FindingAnswer<'a> {
    /// The code of its rule.
    pub code: &'static str,
    /// `error`, `warning` or `note`.
    pub severity: &'static str,
    /// The name of its file.
    pub file: &'a str,
    /// The offset of its start.
    pub start: usize,
    /// The offset of its end.
    pub end: usize,
    /// Its line in the file, from 1; `None` where only the text is known.
    pub line: Option<usize>,
    /// Its column in the line, from 1.
    pub column: Option<usize>,
    /// What is wrong.
    pub message: &'a str,
    /// Why it matters.
    pub why: Option<&'a str>,
    /// What to write instead.
    pub help: Option<&'a str>,
    /// Edits that resolve it.
    pub fixes: Vec<FixAnswer<'a>>,
}

/// A completion.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CompletionAnswer<'a> {
    /// What a list shows.
    pub label: &'a str,
    /// The word of its kind.
    pub kind: &'static str,
    /// The signature, or the type of a value.
    pub detail: &'a str,
    /// Its documentation, as Markdown.
    pub documentation: &'a str,
    /// The text that is compared with what is written, if it is not the label.
    pub filter: Option<&'a str>,
    /// What it replaces.
    pub edit: EditAnswer<'a>,
}

/// A hover text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct HoverAnswer<'a> {
    /// The offset of the start of what it explains.
    pub start: usize,
    /// The offset of its end.
    pub end: usize,
    /// Markdown.
    pub text: &'a str,
}

impl<'a> FindingAnswer<'a> {
    /// A finding at a range of offsets, with the fixes that the editor offers.
    pub fn new(f: &'a Finding, range: Range<usize>, fixes: Vec<FixAnswer<'a>>) -> FindingAnswer<'a> {
        FindingAnswer {
            code: f.code,
            severity: f.severity.as_str(),
            file: &f.path,
            start: range.start,
            end: range.end,
            line: f.position.map(|position| position.line),
            column: f.position.map(|position| position.column),
            message: &f.message,
            why: f.why.as_deref(),
            help: f.help.as_deref(),
            fixes,
        }
    }
}

/// The part of a text that an editor shows: the whole text, or one block of it.
#[derive(Clone, Debug)]
pub struct EditorText<'t> {
    offsets: Utf16Offsets<'t>,
    /// Its bytes in the text.
    bytes: Range<usize>,
    /// The offsets of its start and its end in the text.
    first: usize,
    last: usize,
}

impl<'t> EditorText<'t> {
    /// The whole of a text.
    pub fn whole(text: &'t str) -> EditorText<'t> {
        EditorText::block(text, 0..text.len())
    }

    /// A block of a text, by its bytes.
    pub fn block(text: &'t str, bytes: Range<usize>) -> EditorText<'t> {
        let offsets = Utf16Offsets::new(text);
        let (first, last) = (offsets.of_byte(bytes.start), offsets.of_byte(bytes.end));
        EditorText { offsets, bytes, first, last }
    }

    /// The byte of the text at an offset of the editor.
    pub fn byte(&self, offset: usize) -> usize {
        self.offsets.to_byte(self.first.saturating_add(offset).min(self.last))
    }

    /// The offsets of a range of bytes of the text. `None` if it is not inside of what the editor shows.
    pub fn range(&self, bytes: &Range<usize>) -> Option<Range<usize>> {
        let is_inside = self.bytes.start <= bytes.start && bytes.end <= self.bytes.end;
        let offset = |byte: usize| self.offsets.of_byte(byte).saturating_sub(self.first);
        is_inside.then(|| offset(bytes.start)..offset(bytes.end))
    }

    fn edit<'a>(&self, edit: &'a Edit) -> Option<EditAnswer<'a>> {
        let Range { start, end } = self.range(&edit.span)?;
        Some(EditAnswer { start, end, text: &edit.text })
    }

    /// A fix. `None` if it changes what the editor does not show.
    pub fn fix<'a>(&self, fix: &'a TextFix) -> Option<FixAnswer<'a>> {
        Some(FixAnswer { title: &fix.title, kind: fix.kind.as_str(), edits: [self.edit(&fix.edit)?] })
    }

    /// A completion. `None` if it changes what the editor does not show.
    pub fn completion<'a>(&self, c: &'a Completion) -> Option<CompletionAnswer<'a>> {
        Some(CompletionAnswer {
            label: &c.label,
            kind: c.kind.as_str(),
            detail: &c.detail,
            documentation: &c.documentation,
            filter: c.filter.as_deref(),
            edit: self.edit(&c.edit)?,
        })
    }

    /// A hover text. `None` if it explains what the editor does not show.
    pub fn hover<'a>(&self, hover: &'a Hover) -> Option<HoverAnswer<'a>> {
        let Range { start, end } = self.range(&hover.span)?;
        Some(HoverAnswer { start, end, text: &hover.text })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::item::{CompletionKind, FixKind};
    use labspec::finding::InFile;
    use labspec::source::SourceFile;

    /// The form that `web/labspec` and `web/editor` declare in TypeScript.
    #[test]
    fn answers_have_the_form_of_the_page() {
        // Two units of UTF-16 and four bytes before the block; the block begins at byte 5.
        let text = "😀\nab\nc";
        let editor = EditorText::block(text, 5..7);
        let edit = |span| Edit { span, text: "x".into() };
        let fix = TextFix { title: "write x".into(), kind: FixKind::Guess, edit: edit(5..6) };
        let json = |value: serde_json::Value| value.to_string();
        assert_eq!(
            json(labspec::report::to_value(&editor.fix(&fix).unwrap())),
            r#"{"title":"write x","kind":"guess","edits":[{"start":0,"end":1,"text":"x"}]}"#
        );
        let file = SourceFile::new("a.md", text);
        let rule = labspec::rules::all().next().unwrap();
        let f = Finding::error(rule, 6..7, "wrong").help("write x").at(&file);
        let answer = FindingAnswer::new(&f, editor.range(&f.span).unwrap(), vec![editor.fix(&fix).unwrap()]);
        let found = labspec::report::to_value(&answer);
        assert_eq!((&found["file"], &found["start"], &found["end"]), (&"a.md".into(), &1.into(), &2.into()));
        assert!(
            // Lines are counted where the finding leaves its check.
            found["line"].is_null()
                && found["why"].is_null()
                && found["help"] == "write x"
                && found["fixes"][0]["kind"] == "guess",
            "{found}"
        );
        let completion = Completion {
            label: "qpos".into(),
            kind: CompletionKind::Field,
            detail: "d".into(),
            documentation: "D".into(),
            filter: None,
            edit: edit(6..7),
        };
        assert_eq!(
            json(labspec::report::to_value(&editor.completion(&completion).unwrap())),
            r#"{"label":"qpos","kind":"field","detail":"d","documentation":"D","filter":null,"edit":{"start":1,"end":2,"text":"x"}}"#
        );
        let hover = Hover { span: 5..7, text: "**h**".into() };
        assert_eq!(
            json(labspec::report::to_value(&editor.hover(&hover).unwrap())),
            r#"{"start":0,"end":2,"text":"**h**"}"#
        );
        // What reaches beyond the block has no answer; in the whole text, offsets count from its start.
        assert!(editor.hover(&Hover { span: 4..7, ..hover.clone() }).is_none());
        let whole = EditorText::whole(text);
        assert_eq!(whole.range(&(4..7)), Some(2..5));
        assert_eq!((editor.byte(1), editor.byte(9), whole.byte(3)), (6, 7, 5));
    }
}
