//! The tags of a text in XML that may be invalid, as it is while an author types.

use std::ops::Range;

/// The name of an attribute, and the byte range of its value, without quotes.
pub(crate) type Attribute<'x> = (&'x str, Range<usize>);

/// A tag.
#[derive(Clone, Debug)]
pub(crate) struct Tag<'x> {
    /// The byte of its `<`.
    pub(crate) start: usize,
    pub(crate) name: &'x str,
    /// Whether it ends an element: `</name>`.
    pub(crate) is_end: bool,
    pub(crate) attributes: Vec<Attribute<'x>>,
    /// Whether its element has no content: `<name/>`.
    pub(crate) closed: bool,
    /// The byte after the tag; of a tag that is not finished, where the next one starts.
    pub(crate) end: usize,
    /// Whether it has its `>`.
    pub(crate) finished: bool,
}

impl Tag<'_> {
    /// The bytes of the name.
    pub(crate) fn name_span(&self) -> Range<usize> {
        let start = self.start + if self.is_end { 2 } else { 1 };
        start..start + self.name.len()
    }
}

/// A piece of markup.
#[derive(Clone, Debug)]
pub(crate) enum Markup<'x> {
    Tag(Tag<'x>),
    /// A comment, a declaration or literal text: its bytes, and whether it has its end.
    Other(Range<usize>, bool),
}

/// All markup of a text, in order.
pub(crate) struct Tags<'x> {
    xml: &'x str,
    offset: usize,
}

impl<'x> Tags<'x> {
    pub(crate) fn new(xml: &'x str) -> Tags<'x> {
        Tags { xml, offset: 0 }
    }

    /// Behind a text, searched from a byte on.
    fn behind(&self, from: usize, end: &str) -> Option<usize> {
        Some(from + self.xml.get(from..)?.find(end)? + end.len())
    }

    fn tag(&self, start: usize) -> Tag<'x> {
        let rest = self.xml.get(start + 1..).unwrap_or("");
        let is_end = rest.starts_with('/');
        let name = word(rest.get(usize::from(is_end)..).unwrap_or(""));
        let behind = start + 1 + usize::from(is_end) + name.len();
        let (attributes, end, closed) = attributes(self.xml, behind);
        let end = end.max(start + 1);
        let finished = self.xml.get(start + 1..end).is_some_and(|tag| tag.ends_with('>'));
        Tag { start, name, is_end, attributes, closed, end, finished }
    }
}

impl<'x> Iterator for Tags<'x> {
    type Item = Markup<'x>;

    fn next(&mut self) -> Option<Markup<'x>> {
        let start = self.offset + self.xml.get(self.offset..)?.find('<')?;
        let rest = self.xml.get(start..)?;
        let other = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", ">"), ("<!", ">")];
        if let Some((begin, end)) = other.into_iter().find(|(begin, _)| rest.starts_with(begin)) {
            let behind = self.behind(start + begin.len(), end);
            self.offset = behind.unwrap_or(self.xml.len());
            return Some(Markup::Other(start..self.offset, behind.is_some()));
        }
        let tag = self.tag(start);
        self.offset = tag.end;
        Some(Markup::Tag(tag))
    }
}

/// The elements that are open at a byte.
#[derive(Clone, Debug, Default)]
pub(crate) struct OpenElements<'x>(Vec<&'x str>);

impl<'x> OpenElements<'x> {
    /// The names, from the root on.
    pub(crate) fn names(&self) -> &[&'x str] {
        &self.0
    }

    /// Continues after a tag.
    pub(crate) fn pass(&mut self, tag: &Tag<'x>) {
        if tag.is_end {
            // An element that was not closed ends with its parent.
            if let Some(depth) = self.0.iter().rposition(|open| *open == tag.name) {
                self.0.truncate(depth);
            }
        } else if !tag.closed && !tag.name.is_empty() && self.0.len() < 1000 {
            self.0.push(tag.name);
        }
    }
}

/// The name at the beginning of a text.
pub(crate) fn word(text: &str) -> &str {
    let end = text
        .find(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '-' | ':' | '.')))
        .unwrap_or(text.len());
    text.get(..end).unwrap_or("")
}

/// The attributes of a tag from a byte on, the end of the tag, and whether the element ends with the tag.
fn attributes(xml: &str, from: usize) -> (Vec<Attribute<'_>>, usize, bool) {
    let (mut all, mut offset) = (Vec::new(), from);
    let rest = |offset: usize| xml.get(offset..).unwrap_or("");
    let blank = |offset: usize| offset + rest(offset).len() - rest(offset).trim_start().len();
    loop {
        offset = blank(offset);
        let name = word(rest(offset));
        let Some(first) = rest(offset).chars().next() else { return (all, offset, false) };
        match first {
            '>' => return (all, offset + 1, false),
            '/' if rest(offset).starts_with("/>") => return (all, offset + 2, true),
            // The next tag begins, so this one was not finished.
            '<' => return (all, offset, false),
            _ if name.is_empty() => offset += first.len_utf8(),
            _ => {
                let equals = blank(offset + name.len());
                offset += name.len();
                if !rest(equals).starts_with('=') {
                    continue;
                }
                let start = blank(equals + 1);
                let Some(quote) = rest(start).chars().next().filter(|c| matches!(c, '"' | '\'')) else {
                    offset = start;
                    continue;
                };
                let Some(length) = rest(start + 1).find(quote) else { return (all, xml.len(), false) };
                all.push((name, start + 1..start + 1 + length));
                offset = start + 1 + length + 1;
            }
        }
    }
}
