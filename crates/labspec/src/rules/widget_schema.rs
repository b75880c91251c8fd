use labspec_finding::{Example, Layer, Rule, Severity};

/// A block of another widget does not fit the schema that the settings declare for it.
///
/// Decided by `check_block` in `../../cli/src/widgets.rs`.
pub const WIDGET_SCHEMA: &Rule = &Rule {
    code: "widget-schema",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a block of a widget does not match the JSON Schema that `labspec.toml` declares for it",
    why: "the page shows another thing than the author means, or nothing",
    bad: Example::Files(&[
        ("example.md", b"# A map\n\n```lab map\n{\"place\": \"Rome\", \"zoom\": \xe2\x9f\xa6\"near\"\xe2\x9f\xa7}\n```\n"),
        ("labspec.toml", b"[widgets]\nmap = \"map.json\"\n"),
        ("map.json", br#"{"type": "object", "required": ["place"], "properties": {"place": {"type": "string"}, "zoom": {"type": "number"}}}"#),
    ]),
    good: Example::Files(&[
        ("example.md", b"# A map\n\n```lab map\n{\"place\": \"Rome\", \"zoom\": 3}\n```\n"),
        ("labspec.toml", b"[widgets]\nmap = \"map.json\"\n"),
        ("map.json", br#"{"type": "object", "required": ["place"], "properties": {"place": {"type": "string"}, "zoom": {"type": "number"}}}"#),
    ]),
};
