//! Conversion of editor positions (lines from 0, UTF-16 code units) and of file URIs.

use labspec::report::uri::RELATIVE_PATH;
use labspec::source::SourceFile;
use lsp_types::{Position, Uri};
use percent_encoding::{AsciiSet, CONTROLS, percent_decode_str, utf8_percent_encode};
use serde_json::Value;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The characters that are encoded in an absolute path of a URI. The colon is not encoded, because it cannot end a scheme there
/// and editors leave it unencoded.
const ABSOLUTE_PATH: &AsciiSet = &RELATIVE_PATH.remove(b':');

/// The range of a span.
pub(super) fn range(file: &SourceFile, span: &Range<usize>) -> lsp_types::Range {
    let span = file.snap(span);
    lsp_types::Range { start: position(file, span.start), end: position(file, span.end) }
}

/// The position of a byte.
pub(super) fn position(file: &SourceFile, byte: usize) -> Position {
    let position = file.editor_position(byte);
    let number = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    Position { line: number(position.line), character: number(position.character) }
}

/// The byte of a position. A position past the end of a line is the end of the line, and one past the last
/// line is the end of the text.
pub(super) fn byte_offset(text: &str, position: Position) -> usize {
    let mut start = 0;
    let bytes = text.as_bytes();
    for _ in 0..position.line {
        let Some(length) =
            bytes.get(start..).and_then(|rest| rest.iter().position(|b| matches!(b, b'\n' | b'\r')))
        else {
            return text.len();
        };
        let end = start + length;
        let pair = bytes.get(end) == Some(&b'\r') && bytes.get(end + 1) == Some(&b'\n');
        start = end + if pair { 2 } else { 1 };
    }
    // Editors do not display a byte-order mark.
    if start == 0 && text.starts_with('\u{feff}') {
        start = '\u{feff}'.len_utf8();
    }
    let (character, mut units) = (position.character as usize, 0);
    for (offset, c) in text.get(start..).unwrap_or("").char_indices() {
        if units >= character || matches!(c, '\n' | '\r') {
            return start + offset;
        }
        units += c.len_utf16();
        if units > character {
            // A position inside a surrogate pair is the beginning of the character.
            return start + offset;
        }
    }
    text.len()
}

/// The byte range of an editor range. Reversed ends are swapped.
pub(super) fn byte_span(text: &str, range: lsp_types::Range) -> Range<usize> {
    let (a, b) = (byte_offset(text, range.start), byte_offset(text, range.end));
    a.min(b)..a.max(b)
}

/// The path of a URI, or `None` for a URI with another scheme or of another machine.
pub(super) fn path_of_uri(uri: &Uri) -> Option<PathBuf> {
    if !uri.scheme()?.eq_lowercase("file") || !matches!(uri.authority()?.as_str(), "" | "localhost") {
        return None;
    }
    let path = percent_decode_str(uri.path().as_str()).decode_utf8().ok()?;
    if !path.starts_with('/') || path.contains('\0') {
        return None;
    }
    // `file:///c:/x` is a Windows path.
    let drive = path.get(2..3) == Some(":") && cfg!(windows);
    Some(PathBuf::from(if drive { path.get(1..)? } else { &path }))
}

/// The characters that a URI must not contain unencoded. `%` is excluded, because it begins an encoded character.
const NOT_IN_URIS: &AsciiSet = &CONTROLS
    .add(b' ')
    .add(b'"')
    .add(b'<')
    .add(b'>')
    .add(b'[')
    .add(b'\\')
    .add(b']')
    .add(b'^')
    .add(b'`')
    .add(b'{')
    .add(b'|')
    .add(b'}');

/// Encodes unencoded characters in the URIs of a message (`file:///a b/ä.md`), because some editors send paths unencoded.
pub(super) fn encode_uris(message: &mut Value) {
    match message {
        Value::Array(items) => items.iter_mut().for_each(encode_uris),
        Value::Object(fields) => {
            for (key, value) in fields {
                match value {
                    Value::String(uri) if matches!(key.as_str(), "uri" | "rootUri" | "href") => {
                        *uri = utf8_percent_encode(uri, NOT_IN_URIS).to_string();
                    }
                    value => encode_uris(value),
                }
            }
        }
        _ => {}
    }
}

/// The path with all links resolved; the file may not exist yet.
pub(super) fn resolve_links(path: &Path) -> PathBuf {
    let beside = || Some(path.parent()?.canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(beside).unwrap_or_else(|| path.to_path_buf())
}

/// The URI of a file. `None` is returned if the URI parser refuses the text, which the encoding prevents.
pub(super) fn uri_of_path(path: &Path) -> Option<Uri> {
    let text = path.display().to_string().replace('\\', "/");
    let root = if text.starts_with('/') { "file://" } else { "file:///" };
    format!("{root}{}", utf8_percent_encode(&text, ABSOLUTE_PATH)).parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn files_have_uris_and_back() {
        for path in ["/a/b c.md", "/ä/%/#?.md", "/tmp/x(1).xml", "//x/y", "/a:b/[1]{2}|^`\"<>.md"] {
            let uri = uri_of_path(Path::new(path)).unwrap();
            assert_eq!(path_of_uri(&uri).as_deref(), Some(Path::new(path)), "{uri:?}");
        }
        assert_eq!(uri_of_path(Path::new("/ä b:c")).unwrap().as_str(), "file:///%C3%A4%20b:c");
        let local: Uri = "file://localhost/a%20b".parse().unwrap();
        assert_eq!(path_of_uri(&local), Some(PathBuf::from("/a b")));
        for none in [
            "untitled:1",
            "file://elsewhere/x",
            "file://me@localhost/x",
            "file:///%",
            "file:///%zz",
            "file:///%ff",
            "file:///a%00",
            "file:/a",
            "a.md",
            "",
        ] {
            let path = none.parse().ok().and_then(|uri: Uri| path_of_uri(&uri));
            assert_eq!(path, None, "{none}");
        }
    }

    proptest! {
        /// Converting a byte at the start of a character to a position and back gives the same byte.
        #[test]
        fn positions_come_back(text in "[ä𝄞\ta \r\n]{0,24}") {
            let file = SourceFile::new("a.md", text.as_str());
            for (offset, _) in text.char_indices() {
                let position = position(&file, offset);
                let back = byte_offset(&text, position);
                // Between the two halves of a line break, the position is the end of the line.
                prop_assert!(back == offset || text[..offset].ends_with('\r') && back + 1 == offset, "{offset} {back} {position:?}");
            }
        }

        /// Converting a path to a URI and back gives the same path.
        #[test]
        fn paths_come_back(path in "/[^\0\\\\]{0,30}") {
            let uri = uri_of_path(Path::new(&path)).unwrap();
            prop_assert_eq!(path_of_uri(&uri), Some(PathBuf::from(path)));
        }
    }
}
