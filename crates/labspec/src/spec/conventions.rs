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
        while let Some((start, end)) = self.next_macro(text, read) {
            hidden.push_str(text.get(read..start)?);
            hidden.extend(text.get(start..end)?.bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }));
            read = end;
        }
        (read > 0).then(|| hidden + text.get(read..).unwrap_or(""))
    }

    /// The bytes of the first macro from an offset on.
    fn next_macro(&self, text: &str, from: usize) -> Option<(usize, usize)> {
        let rest = text.get(from..)?;
        let found = self.macros.iter().filter_map(|[open, close]| {
            let start = rest.find(open.as_str())?;
            let inside = start + open.len();
            let end = inside + rest.get(inside..)?.find(close.as_str())? + close.len();
            Some((from + start, from + end))
        });
        found.min()
    }
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
        for text in ["ä {% ö %} ü", "{%%}", "<<{%>>%}"] {
            assert_eq!(hidden(text).map(|hidden| hidden.len()), Some(text.len()), "{text}");
        }
    }
}
