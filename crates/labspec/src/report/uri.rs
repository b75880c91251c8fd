//! Paths in the notation of other programs: with `/` between folders, and as references of RFC 3986.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use std::borrow::Cow;

/// The characters that RFC 3986 requires to be encoded in a relative path: all except the unreserved ones and those allowed
/// between slashes. A colon is encoded too, because it would end a scheme.
pub const RELATIVE_PATH: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'/')
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~')
    .remove(b'!')
    .remove(b'$')
    .remove(b'&')
    .remove(b'\'')
    .remove(b'(')
    .remove(b')')
    .remove(b'*')
    .remove(b'+')
    .remove(b',')
    .remove(b';')
    .remove(b'=')
    .remove(b'@');

/// A path with `/` between its folders, and without a leading `./`.
pub(super) fn slashed(path: &str) -> Cow<'_, str> {
    let path = if cfg!(windows) { Cow::Owned(path.replace('\\', "/")) } else { Cow::Borrowed(path) };
    match path.strip_prefix("./").filter(|rest| !rest.is_empty() && !rest.starts_with('/')) {
        Some(rest) => Cow::Owned(rest.to_string()),
        None => path,
    }
}

/// The reference of a path: relative if the path is, else a file URI. Characters that RFC 3986 does not allow are
/// percent-encoded as UTF-8.
pub(super) fn uri(path: &str) -> String {
    let path = slashed(path);
    let drive = cfg!(windows) && path.get(1..2) == Some(":");
    let scheme = match (path.starts_with('/'), drive) {
        (true, _) => "file://",
        (_, true) => "file:///",
        _ => "",
    };
    format!("{scheme}{}", utf8_percent_encode(&path, RELATIVE_PATH))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn references_are_escaped() {
        for (path, expected) in [
            ("lessons/a.md", "lessons/a.md"),
            ("./a.md", "a.md"),
            ("../a b.md", "../a%20b.md"),
            ("100%/#1?.md", "100%25/%231%3F.md"),
            ("a:b/[1]{2}|^`\"<>.md", "a%3Ab/%5B1%5D%7B2%7D%7C%5E%60%22%3C%3E.md"),
            ("ä/𝄞.md", "%C3%A4/%F0%9D%84%9E.md"),
            ("/tmp/a.md", "file:///tmp/a.md"),
            ("it's (1)+@~.md", "it's%20(1)+@~.md"),
        ] {
            assert_eq!(uri(path), expected);
        }
    }

    proptest! {
        /// Contains only characters that RFC 3986 allows in a path, and decodes to the same path.
        #[test]
        fn every_path_comes_back(path in "[^./\\\\][^\\\\]{0,30}") {
            let uri = uri(&path);
            let allowed = |b: u8| b.is_ascii_alphanumeric() || b"/-._~!$&'()*+,;=@%".contains(&b);
            prop_assert!(uri.bytes().all(allowed), "{uri}");
            let decoded = percent_encoding::percent_decode_str(&uri).decode_utf8().unwrap();
            prop_assert_eq!(decoded, path);
        }
    }
}
