//! HTML as tokens with their spans: text, entities and tags, read by the tokenizer of the `html5gum` crate (WHATWG HTML,
//! section 13.2.5) in linear time. Comments and declarations are left out.

use html5gum::emitters::{Emitter, ForwardingEmitter};
use html5gum::{DefaultEmitter, Error, HtmlString, Span, Spanned, State, Token, Tokenizer};
use std::collections::VecDeque;
use std::ops::Range;

/// A token of HTML.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum HtmlToken {
    /// Verbatim text with this range.
    Text(Range<usize>),
    /// Decoded text, and the range of its source: `<` for `&lt;`.
    Decoded(String, Range<usize>),
    /// A tag.
    Tag(HtmlTag),
}

/// A start tag or an end tag.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct HtmlTag {
    /// Its range.
    pub(crate) span: Range<usize>,
    /// Its name in lower case.
    pub(crate) name: String,
    /// Whether it is an end tag.
    pub(crate) closing: bool,
    /// Its attributes with decoded entities; for equal names, the first.
    pub(crate) attributes: Vec<(String, String)>,
}

/// The tokens of a text, in order. A tag that is truncated by the end of the text is a tag without attributes.
pub(crate) fn tokens(html: &str) -> Vec<HtmlToken> {
    let mut inner = DefaultEmitter::new_with_span();
    // The content of a script or a style contains no tags.
    inner.naively_switch_states(true);
    let emitter = TextSpans { inner, position: 0, text_start: 0, tag_start: 0, ready: VecDeque::new() };
    let mut all: Vec<HtmlToken> = Vec::new();
    for token in Tokenizer::new_with_emitter(html, emitter).flatten() {
        let next = match token {
            Token::String(text) if text.is_empty() => continue,
            Token::String(text) => text_token(html, &text),
            Token::StartTag(tag) => {
                let attributes = tag.attributes.iter().map(|(name, value)| (string(name), string(value)));
                tag_token(tag.span, &tag.name, false, attributes.collect())
            }
            Token::EndTag(tag) => tag_token(tag.span, &tag.name, true, Vec::new()),
            Token::Error(error) if error.value == Error::EofInTag => cut_tag(html, error.span),
            Token::Error(_) | Token::Comment(_) | Token::Doctype(_) => continue,
        };
        match (all.last_mut(), next) {
            (Some(HtmlToken::Text(last)), HtmlToken::Text(next)) if last.end == next.start => {
                last.end = next.end;
            }
            (_, next) => all.push(next),
        }
    }
    all
}

/// The tags of a text, in order.
pub(crate) fn tags(html: &str) -> impl Iterator<Item = HtmlTag> {
    tokens(html).into_iter().filter_map(|token| match token {
        HtmlToken::Tag(tag) => Some(tag),
        HtmlToken::Text(_) | HtmlToken::Decoded(..) => None,
    })
}

fn string(text: &HtmlString) -> String {
    String::from_utf8_lossy(text).into_owned()
}

fn text_token(html: &str, text: &Spanned<HtmlString>) -> HtmlToken {
    let range = text.span.start..text.span.end;
    let before =
        html.as_bytes().get(range.clone()).and_then(|bytes| bytes.strip_suffix(text.value.as_slice()));
    match before {
        // In a line end `\r\n`, the second character belongs to the following text.
        Some(before) if before.is_empty() || before == b"\n" => {
            HtmlToken::Text(range.start + before.len()..range.end)
        }
        _ => HtmlToken::Decoded(string(&text.value), range),
    }
}

fn tag_token(span: Span, name: &HtmlString, closing: bool, attributes: Vec<(String, String)>) -> HtmlToken {
    HtmlToken::Tag(HtmlTag { span: span.start..span.end, name: string(name), closing, attributes })
}

/// The tag that is truncated by the end of the text.
fn cut_tag(html: &str, span: Span) -> HtmlToken {
    let inside = html.get(span.start + 1..).unwrap_or("");
    let name = inside.strip_prefix('/').unwrap_or(inside).split([' ', '\t', '\n', '\r', '/']).next();
    let name = name.unwrap_or("").to_ascii_lowercase().into_bytes().into();
    tag_token(span, &name, inside.starts_with('/'), Vec::new())
}

/// An emitter like that of the crate, but with separate pieces of text and their spans.
struct TextSpans {
    inner: DefaultEmitter<usize>,
    position: usize,
    /// The start of the next piece of text, and of the last tag.
    text_start: usize,
    tag_start: usize,
    ready: VecDeque<Token<usize>>,
}

impl ForwardingEmitter for TextSpans {
    type Token = Token<usize>;

    fn inner(&mut self) -> &mut impl Emitter<Token = Token<usize>> {
        &mut self.inner
    }

    fn move_position(&mut self, offset: isize) {
        self.position = self.position.saturating_add_signed(offset);
        self.inner().move_position(offset);
    }

    fn init_string(&mut self) {
        self.text_start = self.position;
    }

    fn emit_string(&mut self, text: &[u8]) {
        let span = Span { start: self.text_start, end: self.position };
        self.ready.push_back(Token::String(Spanned { value: text.to_vec().into(), span }));
        self.text_start = self.position;
    }

    fn start_open_tag(&mut self) {
        self.tag_start = self.position.saturating_sub(1);
        self.inner().start_open_tag();
    }

    fn emit_error(&mut self, value: Error) {
        let span = Span { start: self.tag_start, end: self.position };
        self.ready.push_back(Token::Error(Spanned { value, span }));
    }

    fn emit_current_tag(&mut self) -> Option<State> {
        self.text_start = self.position;
        self.inner().emit_current_tag()
    }

    fn pop_token(&mut self) -> Option<Token<usize>> {
        self.ready.pop_front().or_else(|| self.inner().pop_token())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tokens of a text with their source, decoded text with its value, and tags in brackets.
    fn read(html: &str) -> Vec<String> {
        let slice = |range: &Range<usize>| html[range.clone()].to_string();
        let one = |token: &HtmlToken| match token {
            HtmlToken::Text(range) => slice(range),
            HtmlToken::Decoded(text, range) => format!("{}={text}", slice(range)),
            HtmlToken::Tag(tag) => format!("[{} {}]", tag.name, slice(&tag.span)),
        };
        tokens(html).iter().map(one).collect()
    }

    #[test]
    fn every_token_has_its_place() {
        assert_eq!(
            read("a < b<I>é</i>&lt;5&nbsp;m"),
            ["a < b", "[i <I>]", "é", "[i </i>]", "&lt;=<", "5", "&nbsp;=\u{a0}", "m"]
        );
        assert_eq!(read("x<!-- <b> -->y<p a='>'>&x; & z"), ["x", "y", "[p <p a='>'>]", "&x; & z"]);
        assert_eq!(
            read("<script>'<b>'</script>1"),
            ["[script <script>]", "'<b>'", "[script </script>]", "1"]
        );
        assert_eq!(
            read("é<é>&#233;<br/>\u{1}1 <geom a"),
            ["é<é>", "&#233;=é", "[br <br/>]", "\u{1}1 ", "[geom <geom a]"]
        );
        assert_eq!(read("a\r\n<b>c\r\nd</b>"), ["a", "\r=\n", "[b <b>]", "c", "\r=\n", "d", "[b </b>]"]);
        let tag = tags("<p ID=A hidden title='1 &lt; 2' id=b>").next().unwrap();
        let attribute = |name: &str, value: &str| (name.to_string(), value.to_string());
        assert_eq!(
            tag.attributes,
            [attribute("hidden", ""), attribute("id", "A"), attribute("title", "1 < 2")]
        );
    }

    #[test]
    fn hostile_html_takes_linear_time() {
        for piece in [
            "<",
            "</",
            "<a",
            "<a b='",
            "<!--",
            "&",
            "&#",
            "&a",
            "<script>",
            "</script",
            "<a b=c ",
            "<![CDATA[",
            "é<",
        ] {
            let html = piece.repeat(100_000 / piece.len());
            let end = tokens(&html).iter().fold(0, |end, token| match token {
                HtmlToken::Text(span)
                | HtmlToken::Decoded(_, span)
                | HtmlToken::Tag(HtmlTag { span, .. }) => {
                    assert!(end <= span.start && span.start <= span.end, "{piece} {span:?}");
                    span.end
                }
            });
            assert!(end <= html.len());
        }
    }
}
