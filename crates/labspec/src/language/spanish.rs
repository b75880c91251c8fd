use super::Language;

pub(super) static SPANISH: Language = Language {
    code: "es",
    name: "Spanish",
    decimal_comma: true,
    approximate: &["aproximadamente", "alrededor de", "cerca de", "unos", "unas"],
    slightly_less: &["casi", "poco menos de", "un poco menos de", "justo por debajo de"],
    slightly_more: &["poco más de", "un poco más de", "algo más de", "justo por encima de"],
    largest: &["hasta"],
    lower_bounds: &["más de", "al menos", "mayor que", "superior a", "por encima de", "supera"],
    upper_bounds: &["menos de", "como máximo", "a lo sumo", "menor que", "inferior a", "por debajo de"],
};
