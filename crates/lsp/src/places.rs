//! Places as editors name them: lines from 0, units of UTF-16, URIs for files.

use labspec::source::SourceFile;
use serde_json::{Value, json};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The range of a span.
pub(super) fn range(file: &SourceFile, span: &Range<usize>) -> Value {
    let span = file.snap(span);
    json!({"start": position(file, span.start), "end": position(file, span.end)})
}

fn position(file: &SourceFile, byte: usize) -> Value {
    let at = file.editor_position(byte);
    json!({"line": at.line, "character": at.character})
}

/// The byte of a place; the end of its line when the line is shorter, the end of the text when it has fewer lines. `None` when it is
/// no place.
pub(super) fn byte(text: &str, place: &Value) -> Option<usize> {
    let line = usize::try_from(place.get("line")?.as_u64()?).ok()?;
    let character = usize::try_from(place.get("character")?.as_u64()?).ok()?;
    let mut start = 0;
    let bytes = text.as_bytes();
    for _ in 0..line {
        let Some(length) =
            bytes.get(start..).and_then(|rest| rest.iter().position(|b| matches!(b, b'\n' | b'\r')))
        else {
            return Some(text.len());
        };
        let end = start + length;
        let pair = bytes.get(end) == Some(&b'\r') && bytes.get(end + 1) == Some(&b'\n');
        start = end + if pair { 2 } else { 1 };
    }
    // A byte-order mark is not shown.
    if start == 0 && text.starts_with('\u{feff}') {
        start = '\u{feff}'.len_utf8();
    }
    let mut units = 0;
    for (at, c) in text.get(start..)?.char_indices() {
        if units >= character || matches!(c, '\n' | '\r') {
            return Some(start + at);
        }
        units += c.len_utf16();
        if units > character {
            // Inside of a pair: its beginning.
            return Some(start + at);
        }
    }
    Some(text.len())
}

/// The bytes of a range; `None` when it is none. Ends that are swapped are put in order.
pub(super) fn span(text: &str, range: &Value) -> Option<Range<usize>> {
    let (a, b) = (byte(text, range.get("start")?)?, byte(text, range.get("end")?)?);
    Some(a.min(b)..a.max(b))
}

/// The file of a URI; `None` for what is no file.
pub(super) fn path_of(uri: &str) -> Option<PathBuf> {
    let rest = uri.strip_prefix("file://")?;
    // Of a host, only this machine is ours.
    let path = rest.strip_prefix("localhost").unwrap_or(rest);
    let mut bytes = Vec::with_capacity(path.len());
    let mut left = path.bytes();
    while let Some(b) = left.next() {
        if b == b'%' {
            let digits = [left.next()?, left.next()?];
            bytes.push(u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?);
        } else {
            bytes.push(b);
        }
    }
    let path = String::from_utf8(bytes).ok()?;
    if !path.starts_with('/') || path.contains('\0') {
        return None;
    }
    // `file:///c:/x` is a path of Windows.
    let drive = path.get(2..3) == Some(":") && cfg!(windows);
    Some(PathBuf::from(if drive { path.get(1..)?.to_string() } else { path }))
}

/// The file itself, whatever links lead to it; it may not be there yet.
pub(super) fn real(path: &Path) -> PathBuf {
    let beside = || Some(path.parent()?.canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(beside).unwrap_or_else(|| path.to_path_buf())
}

/// The URI of a file.
pub(super) fn uri_of(path: &Path) -> String {
    let text = path.display().to_string().replace('\\', "/");
    let mut uri = String::from(if text.starts_with('/') { "file://" } else { "file:///" });
    for b in text.bytes() {
        if b.is_ascii_alphanumeric() || b"/-._~:@!$&'()*+,;=".contains(&b) {
            uri.push(char::from(b));
        } else {
            uri.push_str(&format!("%{b:02X}"));
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn files_have_uris_and_back() {
        for path in ["/a/b c.md", "/ä/%/#?.md", "/tmp/x(1).xml"] {
            let uri = uri_of(Path::new(path));
            assert_eq!(path_of(&uri).as_deref(), Some(Path::new(path)), "{uri}");
        }
        assert_eq!(uri_of(Path::new("/ä b")), "file:///%C3%A4%20b");
        for none in [
            "untitled:1",
            "file://elsewhere/x",
            "file:///%",
            "file:///%zz",
            "file:///%ff",
            "file:///a%00",
            "",
        ] {
            assert_eq!(path_of(none), None, "{none}");
        }
    }

    proptest! {
        /// Every byte that begins a character comes back from its place.
        #[test]
        fn places_come_back(text in "[ä𝄞\ta \r\n]{0,24}") {
            let file = SourceFile::new("a.md", text.as_str());
            for (at, _) in text.char_indices() {
                let place = position(&file, at);
                let back = byte(&text, &place).unwrap();
                // Between the two halves of a line break the place is the end of the line.
                prop_assert!(back == at || text[..at].ends_with('\r') && back + 1 == at, "{at} {back} {place}");
            }
        }
    }
}
