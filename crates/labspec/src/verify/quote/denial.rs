//! Detects negation: the text "it does not tip over" does not state "tip over", and "it does not take 0.44 s" states that
//! the time differs.

/// Words that negate a verb, and the number of following words that they affect.
const VERB_NEGATIONS: ([&str; 24], usize) = (
    [
        "not",
        "never",
        "cannot",
        "hardly",
        "nowhere",
        "nicht",
        "nie",
        "niemals",
        "nimmer",
        "nirgends",
        "keinesfalls",
        "keineswegs",
        "mitnichten",
        "kaum",
        "jamais",
        "nullement",
        "aucunement",
        "nunca",
        "jamás",
        "tampoco",
        "mai",
        "non",
        "neppure",
        "nemmeno",
    ],
    3,
);

/// Negations that affect more words: `it never quite gets up to 0.44 s`.
const FAR_NEGATIONS: [&str; 11] = [
    "never",
    "nie",
    "niemals",
    "nimmer",
    "keinesfalls",
    "keineswegs",
    "jamais",
    "nunca",
    "jamás",
    "nobody",
    "niemand",
];

/// Number of words that they affect.
const MAX_REACH: usize = 8;

/// Words that do not count.
const FILLERS: [&str; 20] = [
    "a", "an", "the", "of", "at", "to", "die", "der", "den", "das", "les", "la", "le", "los", "las", "el",
    "i", "de", "di", "quite",
];

/// Words that negate a noun: `without spin it takes 0.44 s` does not negate the time.
const NOUN_NEGATIONS: ([&str; 21], usize) = (
    [
        "no", "nor", "neither", "without", "kein", "keine", "keinen", "keinem", "keiner", "weder", "ohne",
        "pas", "ni", "sans", "aucun", "aucune", "sin", "ningún", "ninguna", "senza", "nessun",
    ],
    2,
);

/// Words that end the effect of a negation: `not until 0.44 s`, `not only 0.44 s`, `whether or not it tips over`.
const ENDS: [&str; 26] = [
    "until",
    "only",
    "just",
    "even",
    "before",
    "because",
    "that",
    "if",
    "when",
    "and",
    "or",
    "but",
    "with",
    "nur",
    "erst",
    "und",
    "oder",
    "aber",
    "seulement",
    "et",
    "mais",
    "sólo",
    "solo",
    "y",
    "pero",
    "sondern",
];

/// Phrases that negate a whole clause.
const CLAUSES: [&str; 24] = [
    "be wrong to",
    "is wrong to",
    "by no means",
    "in no way",
    "on no account",
    "under no circumstances",
    "auf keinen fall",
    "in keinem fall",
    "falsch, dass",
    "falsch dass",
    "en aucun cas",
    "en ningún caso",
    "in nessun caso",
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
    let words = || clause.split_whitespace().rev();
    let mut far = words().take(MAX_REACH).take_while(|word| !ENDS.contains(word));
    if far.any(|word| FAR_NEGATIONS.contains(&word)) {
        return true;
    }
    let near: Vec<&str> = words().filter(|word| !FILLERS.contains(word)).take(VERB_NEGATIONS.1 + 1).collect();
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

/// Verbs with which a clause about the number before them begins.
const VERBS: [&str; 53] = [
    "is", "are", "was", "were", "be", "can", "could", "cannot", "would", "will", "do", "does", "did", "has",
    "have", "must", "should", "seems", "ist", "sind", "war", "waren", "wäre", "wären", "wird", "werden",
    "kann", "können", "est", "sont", "était", "serait", "peut", "n'est", "ne", "es", "son", "era", "sería",
    "puede", "no", "è", "sono", "sarebbe", "non", "nicht", "c'est", "may", "might", "stimmt", "stimmen",
    "trifft", "gilt",
];

/// Words that make such a clause state something else than the number.
const WRONG: [&str; 47] = [
    "wrong",
    "false",
    "incorrect",
    "untrue",
    "impossible",
    "nonsense",
    "mistaken",
    "erroneous",
    "inaccurate",
    "unattainable",
    "unreachable",
    "exceeded",
    "surpassed",
    "missed",
    "unrealistic",
    "falsch",
    "unmöglich",
    "unrichtig",
    "unwahr",
    "inkorrekt",
    "unerreichbar",
    "überschritten",
    "unterschritten",
    "übertroffen",
    "verfehlt",
    "faux",
    "fausse",
    "inexact",
    "inexacte",
    "erroné",
    "erronée",
    "dépassé",
    "dépassée",
    "dépassés",
    "falso",
    "falsa",
    "incorrecto",
    "incorrecta",
    "erróneo",
    "imposible",
    "superado",
    "superada",
    "sbagliato",
    "sbagliata",
    "errato",
    "errata",
    "impossibile",
];

/// Words after `not` with which the clause does not deny the number: `0.44 s is not enough`.
const HARMLESS: [&str; 18] = [
    "only",
    "just",
    "merely",
    "much",
    "many",
    "enough",
    "far",
    "a",
    "surprising",
    "long",
    "nur",
    "viel",
    "genug",
    "seulement",
    "beaucoup",
    "mucho",
    "molto",
    "because",
];

/// Verbs whose negation denies another thing than the number, unless the clause is about what is right: `the bar of 0.5 kg does not
/// fall`, but `0.5 kg cannot be right`.
const AUXILIARIES: [&str; 18] = [
    "do", "does", "did", "has", "have", "will", "would", "can", "could", "cannot", "may", "might", "must",
    "should", "kann", "können", "peut", "puede",
];
const RIGHT: [&str; 14] = [
    "be", "right", "correct", "true", "hold", "possible", "sein", "stimmen", "richtig", "wahr", "être",
    "juste", "ser", "correcto",
];

/// Number of words of such a clause that are read.
const MAX_WORDS: usize = 5;

/// Whether the words after a number, in lower case, deny it: `0.44 s is wrong`, `0.44 s cannot be right`.
pub(super) fn is_denied_after(line: &str) -> bool {
    let marked = line.trim_start_matches([' ', ',', '–', '—', '-', ':', '(', '?', '!', '"', '”', '»']);
    let clause = marked.split(['.', ',', ';', ':', '(', ')', '—', '–', '?', '!', '\n']).next().unwrap_or("");
    let mut words: Vec<&str> = clause.split_whitespace().take(MAX_WORDS + 1).collect();
    let is_relative = words.first().is_some_and(|word| matches!(*word, "which" | "that"));
    if is_relative {
        words.remove(0);
    }
    let Some(first) = words.first() else { return false };
    if WRONG.contains(first) {
        return true;
    }
    let is_negation = |word: &str| {
        VERB_NEGATIONS.0.contains(&word)
            || matches!(word, "no" | "pas" | "kein" | "keine")
            || word.ends_with("n't")
            || word.ends_with("n’t")
    };
    // `0.44 s, no more` does not deny the number.
    let marks = line.get(..line.len() - marked.len()).unwrap_or("");
    let goes_on = is_relative || !marks.contains([',', '–', '—', '-', ':', '(', '?', '!']);
    if !goes_on || !VERBS.contains(first) && !is_negation(first) {
        return false;
    }
    let about_it = !AUXILIARIES.contains(first) || words.iter().any(|word| RIGHT.contains(word));
    words.iter().take(MAX_WORDS).enumerate().any(|(i, word)| {
        let next = words.get(i + 1).copied().unwrap_or("");
        WRONG.contains(word)
            || about_it && is_negation(word) && !HARMLESS.contains(&next)
            || *word == "too"
                && matches!(
                    next,
                    "high" | "low" | "large" | "small" | "much" | "little" | "long" | "fast" | "slow"
                )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_after_a_number_deny_it() {
        for line in [
            " is wrong",
            " cannot be right",
            " isn't right",
            " would be impossible",
            " is never reached",
            ", which is wrong",
            " – wrong",
            " is too high",
            " ist falsch",
            " stimmt nicht",
            "\" is wrong",
            " is not the speed",
            " wird nie erreicht",
            " n'est pas atteint",
            " es falso",
            " è sbagliato",
        ] {
            assert!(is_denied_after(line), "{line}");
        }
        for line in [
            " is right",
            " is not much",
            " is not a coincidence",
            " is the speed",
            ". It is not fast",
            ", and it does not stop",
            ", no more",
            ", not 0.45 s",
            " on the moon",
            " wird erreicht",
            "",
        ] {
            assert!(!is_denied_after(line), "{line}");
        }
    }

    #[test]
    fn a_denial_reaches_a_few_words_of_its_clause() {
        for line in [
            "it does not ",
            "it doesn't take ",
            "it will never take ",
            "It is wrong that it takes ",
            "it moves without ",
            "it tips, but does not fall after ",
            "der Ball ist niemals ",
            "It never quite gets up to ",
            "It does not land at a speed of ",
            "der Ball ist nie so schnell wie ",
            "er erreicht keinesfalls ",
            "la bille n'atteint jamais ",
            "la bola nunca alcanza ",
            "non raggiunge mai ",
            "sie ist auf keinen Fall ",
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
