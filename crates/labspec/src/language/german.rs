use super::Language;

pub(super) static GERMAN: Language = Language {
    code: "de",
    name: "German",
    decimal_comma: true,
    approximate: &["etwa", "ungefähr", "rund", "circa", "zirka", "ca.", "annähernd"],
    slightly_less: &["knapp", "fast", "beinahe", "nahezu", "etwas weniger als", "etwas unter"],
    slightly_more: &["etwas mehr als", "etwas über", "gut"],
    largest: &["bis zu"],
    lower_bounds: &[
        "mehr als",
        "größer als",
        "länger als",
        "höher als",
        "schneller als",
        "mindestens",
        "wenigstens",
        "über",
        "oberhalb von",
    ],
    upper_bounds: &[
        "weniger als",
        "kleiner als",
        "kürzer als",
        "niedriger als",
        "langsamer als",
        "höchstens",
        "unter",
        "unterhalb von",
    ],
};
