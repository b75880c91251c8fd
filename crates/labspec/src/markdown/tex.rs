//! The tokens of TeX: commands, and groups in braces.

use nom::branch::alt;
use nom::bytes::complete::{tag, take};
use nom::character::complete::{alpha1, char};
use nom::combinator::{fail, recognize};
use nom::sequence::preceded;
use nom::{IResult, Parser};

/// The name of the command at the beginning of a text: letters, or one other character; empty where the text ends after its
/// backslash.
pub(crate) fn command(text: &str) -> IResult<&str, &str> {
    preceded(char('\\'), alt((alpha1, recognize(take(1_usize)), tag("")))).parse(text)
}

/// The text between braces, with at most `longest` bytes.
pub(crate) fn group(text: &str, longest: usize) -> IResult<&str, &str> {
    let (inside, _) = char('{').parse(text)?;
    let mut depth = 1_usize;
    for (offset, byte) in inside.bytes().enumerate().take(longest + 1) {
        match byte {
            b'{' => depth += 1,
            b'}' => depth -= 1,
            _ => {}
        }
        if depth == 0
            && let (Some(group), Some(rest)) = (inside.get(..offset), inside.get(offset + 1..))
        {
            return Ok((rest, group));
        }
    }
    fail().parse(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_and_groups_are_read() {
        for (text, name, rest) in [
            ("\\frac{1}", "frac", "{1}"),
            ("\\, x", ",", " x"),
            ("\\é", "é", ""),
            ("\\", "", ""),
            ("\\\\a", "\\", "a"),
        ] {
            assert_eq!(command(text), Ok((rest, name)), "{text}");
        }
        assert_eq!(group("{a{b}}c", 80), Ok(("c", "a{b}")));
        for text in ["", "a", "{a", "{a{}", "{aaaaaaaaa}"] {
            assert!(group(text, 5).is_err(), "{text}");
        }
    }
}
