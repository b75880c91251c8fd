//! Detects negation: the text "it does not tip over" does not state "tip over", and "it does not take 0.44 s" states that
//! the time differs.

/// Words that negate a verb, and the number of following words that they affect.
const VERB_NEGATIONS: ([&str; 7], usize) =
    (["not", "never", "cannot", "hardly", "nicht", "nie", "jamais"], 3);

/// Words that negate a noun: `without spin it takes 0.44 s` does not negate the time.
const NOUN_NEGATIONS: ([&str; 7], usize) = (["no", "nor", "neither", "without", "kein", "keine", "pas"], 2);

/// Words that end the effect of a negation: `not until 0.44 s`, `not only 0.44 s`, `whether or not it tips over`.
const ENDS: [&str; 13] =
    ["until", "only", "just", "even", "before", "because", "that", "if", "when", "and", "or", "but", "with"];

/// Phrases that negate a whole clause.
const CLAUSES: [&str; 11] = [
    "wrong that",
    "false that",
    "untrue that",
    "incorrect that",
    "not true that",
    "not the case that",
    "wrong to say",
    "wrong to think",
    "mistake to think",
    "myth that",
    "nobody says that",
];

/// Maximum length of a clause that is read, in characters.
const MAX_CLAUSE: usize = 1000;

/// Whether the words at the end of a line negate the following text.
pub(super) fn is_denied(line: &str) -> bool {
    let start = line.char_indices().rev().take(MAX_CLAUSE).last().map_or(0, |(offset, _)| offset);
    let line = line.get(start..).unwrap_or("");
    let clause =
        line.rsplit(['\n', '.', ',', ';', ':', '(', '—', '?', '!']).next().unwrap_or("").to_lowercase();
    if CLAUSES.iter().any(|phrase| clause.contains(phrase)) {
        return true;
    }
    let near: Vec<&str> = clause.split_whitespace().rev().take(VERB_NEGATIONS.1 + 1).collect();
    let of_verb =
        |word: &&str| VERB_NEGATIONS.0.contains(word) || word.ends_with("n't") || word.ends_with("n’t");
    let of_noun = |word: &&str| NOUN_NEGATIONS.0.contains(word);
    let first = near.iter().take(VERB_NEGATIONS.1).position(of_verb);
    let first = first.or_else(|| near.iter().take(NOUN_NEGATIONS.1).position(of_noun));
    first.is_some_and(|index| {
        // `whether or not it tips over`
        let either = near.get(index + 1) == Some(&"or");
        !either && !near.iter().take(index).any(|word| ENDS.contains(word))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_denial_reaches_a_few_words_of_its_clause() {
        for line in [
            "it does not ",
            "it doesn't take ",
            "it will never take ",
            "It is wrong that it takes ",
            "it moves without ",
            "it tips, but does not fall after ",
        ] {
            assert!(is_denied(line), "{line}");
        }
        for line in [
            "it is not there. It takes ",
            "not only ",
            "not until ",
            "whether or not ",
            "it does not fall, and takes ",
            "it takes ",
            "a ball without spin takes ",
        ] {
            assert!(!is_denied(line), "{line}");
        }
    }
}
