use super::Language;

pub(super) static ITALIAN: Language = Language {
    code: "it",
    name: "Italian",
    decimal_comma: true,
    approximate: &["circa", "all'incirca", "all’incirca", "approssimativamente", "intorno a"],
    slightly_less: &["quasi", "poco meno di", "appena sotto"],
    slightly_more: &["poco più di", "appena sopra"],
    largest: &["fino a"],
    lower_bounds: &["più di", "almeno", "maggiore di", "superiore a", "oltre", "al di sopra di", "supera"],
    upper_bounds: &["meno di", "al massimo", "minore di", "inferiore a", "al di sotto di"],
    numerals: &[
        "tre", "quattro", "cinque", "sei", "sette", "otto", "nove", "dieci", "dodici", "trenta", "cento",
        "mille",
    ],
    factor_suffixes: &[],
    multiples: &["doppio", "triplo", "volte"],
    parts: &[
        "metà",
        "terzo",
        "quarto",
        "quinto",
        "decimo",
        "centesimo",
        "millesimo",
        "doppio",
        "triplo",
        "multiplo",
    ],
    of: &["di", "dei", "del"],
    operators: &["più", "meno", "diviso"],
};
