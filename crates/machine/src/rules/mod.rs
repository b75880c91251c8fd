//! Lint rules of the language. Each rule has its own file: what is wrong, why it matters, a wrong and a right example. The parser,
//! the binder and the virtual machine report violations.

pub use labspec_finding::Rule;

// The build script lists the files of this folder.
include!(concat!(env!("OUT_DIR"), "/rules.rs"));

#[cfg(test)]
mod tests {
    use super::ALL;

    #[test]
    fn codes_are_unique_and_in_words() {
        for (i, rule) in ALL.iter().enumerate() {
            assert!(rule.code.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{}", rule.code);
            assert!(!rule.summary.ends_with('.') && !rule.why.ends_with('.'), "{}", rule.code);
            assert!(ALL[..i].iter().all(|other| other.code != rule.code), "{} twice", rule.code);
        }
    }
}
