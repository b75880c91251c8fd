use super::Language;
use super::comparison::UNREAD;
use super::ratios::Ratios;

// Words for bounds, such as `大于`, make a number unreadable.
pub(super) static CHINESE: Language = Language {
    code: "zh",
    name: "Chinese",
    decimal_comma: false,
    approximate: &["约", "約", "大约", "大約"],
    slightly_less: &[],
    slightly_more: &[],
    largest: &[],
    lower_bounds: &[],
    upper_bounds: &[],
    numerals: &[],
    factor_suffixes: &[],
    multiples: &[],
    parts: &[],
    of: &[],
    operators: &[],
    never: &["从不", "从未", "始终"],
    between: &[("介于", "和"), ("介于", "与")],
    from: &[],
    comparison: UNREAD,
    ratios: Ratios { factors: &[], quantities: &[], settings: &[] },
};
