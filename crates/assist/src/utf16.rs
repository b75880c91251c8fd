//! Offsets of a text as JavaScript counts them: UTF-16 code units from the start.

/// Converts between byte offsets and UTF-16 offsets of one text.
#[derive(Clone, Debug)]
pub struct Utf16Offsets<'t> {
    text: &'t str,
    /// The byte and the UTF-16 offset at which each line starts. Empty for a text in which both are equal.
    lines: Vec<(usize, usize)>,
}

impl<'t> Utf16Offsets<'t> {
    /// The offsets of a text.
    pub fn new(text: &'t str) -> Utf16Offsets<'t> {
        let mut lines = Vec::new();
        if !text.is_ascii() {
            let mut offsets = (0, 0);
            for line in text.split_inclusive('\n') {
                lines.push(offsets);
                offsets = (offsets.0 + line.len(), offsets.1 + line.encode_utf16().count());
            }
        }
        Utf16Offsets { text, lines }
    }

    /// The UTF-16 offset of a byte; inside a character, that of its start; beyond the end, the length.
    pub fn of_byte(&self, byte: usize) -> usize {
        let byte = byte.min(self.text.len());
        let (start, mut units) = self.line(|(b, _)| *b <= byte, byte);
        for (index, c) in self.rest(start) {
            if start + index + c.len_utf8() > byte {
                break;
            }
            units += c.len_utf16();
        }
        units
    }

    /// The byte of a UTF-16 offset; inside a surrogate pair, that of its character; beyond the end, the length.
    pub fn to_byte(&self, offset: usize) -> usize {
        let (start, mut units) = self.line(|(_, u)| *u <= offset, offset);
        for (index, c) in self.rest(start) {
            units += c.len_utf16();
            if units > offset {
                return start + index;
            }
        }
        self.text.len()
    }

    /// The start of the last line for which a condition holds. In an ASCII text, the offset itself.
    fn line(&self, holds: impl Fn(&(usize, usize)) -> bool, offset: usize) -> (usize, usize) {
        if self.lines.is_empty() {
            let offset = offset.min(self.text.len());
            return (offset, offset);
        }
        let after = self.lines.partition_point(holds);
        after.checked_sub(1).and_then(|index| self.lines.get(index)).copied().unwrap_or_default()
    }

    fn rest(&self, start: usize) -> impl Iterator<Item = (usize, char)> + use<'t> {
        self.text.get(start..).unwrap_or("").char_indices()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Every offset agrees with a count from the start, and converts back.
        #[test]
        fn offsets_agree_with_a_plain_count(text in "[ä𝄞\ta \r\n]{0,24}|[a \n]{0,12}") {
            let offsets = Utf16Offsets::new(&text);
            for (byte, c) in text.char_indices() {
                let units = text[..byte].encode_utf16().count();
                prop_assert_eq!(offsets.of_byte(byte), units);
                prop_assert_eq!(offsets.to_byte(units), byte);
                // Inside a character, both give its start.
                prop_assert_eq!(offsets.of_byte(byte + c.len_utf8() - 1), units);
                prop_assert_eq!(offsets.to_byte(units + c.len_utf16() - 1), byte);
            }
            let length = text.encode_utf16().count();
            prop_assert_eq!((offsets.of_byte(text.len()), offsets.of_byte(text.len() + 9)), (length, length));
            prop_assert_eq!((offsets.to_byte(length), offsets.to_byte(length + 9)), (text.len(), text.len()));
        }
    }
}
