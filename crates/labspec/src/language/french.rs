use super::Language;

pub(super) static FRENCH: Language = Language {
    code: "fr",
    name: "French",
    decimal_comma: true,
    approximate: &["environ", "à peu près", "approximativement", "autour de", "aux alentours de"],
    slightly_less: &["presque", "un peu moins de", "juste en dessous de"],
    slightly_more: &["un peu plus de", "juste au-dessus de"],
    largest: &["jusqu'à", "jusqu’à"],
    lower_bounds: &[
        "plus de",
        "au moins",
        "supérieur à",
        "supérieure à",
        "au-dessus de",
        "au-delà de",
        "dépasse",
    ],
    upper_bounds: &["moins de", "au plus", "inférieur à", "inférieure à", "au-dessous de", "en dessous de"],
};
