//! The conventions of the texts of a course, which its settings state.

use crate::language::Languages;

/// How the texts of a lesson are read.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Conventions {
    /// The languages in which it may be written.
    pub languages: Languages,
    /// The delimiters of macros of the site, such as `{%` and `%}`. Readers do not see the text between them.
    pub macros: Vec<[String; 2]>,
    /// The keys of the front matter whose values readers see, such as `title`.
    pub front_matter: Vec<String>,
}

impl Conventions {
    /// A text in which spaces replace macros, byte by byte. `None` if there are none. A macro without an end is text.
    pub(crate) fn without_macros(&self, text: &str) -> Option<String> {
        let mut hidden = String::new();
        let mut read = 0;
        // The next macro of each kind. One is searched again only behind the one that was hidden, so each search reads on.
        let mut next: Vec<_> = self.macros.iter().map(|pair| find_macro(pair, text, 0)).collect();
        while let Some((start, end)) = next.iter().flatten().min().copied() {
            hidden.push_str(text.get(read..start)?);
            hidden.extend(text.get(start..end)?.bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }));
            read = end;
            for (found, pair) in next.iter_mut().zip(&self.macros) {
                if found.is_some_and(|(start, _)| start < read) {
                    *found = find_macro(pair, text, read);
                }
            }
        }
        (read > 0).then(|| hidden + text.get(read..).unwrap_or(""))
    }
}

/// The bytes of the first macro with these delimiters from an offset on.
fn find_macro([open, close]: &[String; 2], text: &str, from: usize) -> Option<(usize, usize)> {
    let start = from + text.get(from..)?.find(open.as_str())?;
    let inside = start + open.len();
    let end = inside + text.get(inside..)?.find(close.as_str())? + close.len();
    Some((start, end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn macros_are_replaced_by_as_many_bytes() {
        let macros = vec![["{%".into(), "%}".into()], ["<<".into(), ">>".into()]];
        let conventions = Conventions { macros, ..Conventions::default() };
        let hidden = |text: &str| conventions.without_macros(text);
        assert_eq!(
            hidden("a {% x=3 ä\n%} b << 5 >>."),
            Some(format!("a {}\n   b {}.", " ".repeat(9), " ".repeat(7)))
        );
        assert_eq!(hidden("a {% x"), None);
        assert_eq!(Conventions::default().without_macros("{% a %}"), None);
        // The other delimiters are searched once, not once for each macro.
        let many = "{%%}".repeat(200_000);
        assert_eq!(hidden(&many).map(|hidden| hidden.trim().len()), Some(0));
        for text in ["ä {% ö %} ü", "{%%}", "<<{%>>%}"] {
            assert_eq!(hidden(text).map(|hidden| hidden.len()), Some(text.len()), "{text}");
        }
    }
}
