//! The settings about the texts of lessons: `languages`, `macros`, `front-matter`.

use labspec::language::{LANGUAGES, Languages};
use labspec::report::printable;
use labspec::spec::Conventions;
use labspec_finding::nearest;

/// The conventions that settings state. `list` returns the texts of a setting.
///
/// # Errors
/// A language is unknown, or a macro is not a pair of delimiters.
pub(super) fn read(list: impl Fn(&str) -> Result<Vec<String>, String>) -> Result<Conventions, String> {
    let codes = list("languages")?;
    let languages = match codes.as_slice() {
        [] => Languages::ALL,
        codes => Languages::with_codes(codes.iter().map(String::as_str)).map_err(unknown_language)?,
    };
    let macros = list("macros")?.iter().map(|pair| delimiters(pair)).collect::<Result<_, String>>()?;
    Ok(Conventions { languages, macros, front_matter: list("front-matter")? })
}

fn unknown_language(code: &str) -> String {
    let codes = || LANGUAGES.iter().map(|language| language.code);
    let help = match nearest(code, codes()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("use one of {}", codes().collect::<Vec<_>>().join(", ")),
    };
    format!("languages: labspec has no words of the language `{}`; {help}", printable(code))
}

/// The delimiters of a macro: `{% %}`.
fn delimiters(pair: &str) -> Result<[String; 2], String> {
    let parts: Vec<&str> = pair.split_whitespace().collect();
    match parts.as_slice() {
        [open, close] => Ok([open, close].map(|part| (*part).to_string())),
        _ => Err(format!(
            "macros: `{}` must be an opening and a closing delimiter with a space between them, such as \"{{% %}}\"",
            printable(pair)
        )),
    }
}

/// The settings in words: the name of each, and its value.
pub(super) fn lines(conventions: &Conventions) -> Vec<(&'static str, String)> {
    let Conventions { languages, macros, front_matter } = conventions;
    let mut all = Vec::new();
    if *languages != Languages::ALL {
        all.extend(languages.iter().map(|l| ("languages", format!("{} ({})", l.code, l.name))));
    }
    all.extend(macros.iter().map(|[open, close]| ("macros", format!("{open} {close}"))));
    all.extend(front_matter.iter().map(|key| ("front-matter", key.clone())));
    all
}
