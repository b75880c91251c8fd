use crate::lint::CodeLine;
use crate::markdown::is_typographic;
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A Python listing has lost the underscores of `__name__`.
pub const LISTING_UNDERSCORES: &Rule = &Rule {
    code: "listing-underscores",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a Python listing has lost the underscores of `__name__`",
    why: "Markdown reads double underscores outside a fence as emphasis; the listing does not run",
    bad: Example::Lesson("```python\n⟦if name⟧ == \"main\":\n    main()\n```\n"),
    good: Example::Lesson("```python\nif __name__ == \"__main__\":\n    main()\n```\n"),
};

/// Reports a line that compares `name` with `main`.
pub(crate) fn check_line(body: &Text, line: &CodeLine<'_>) -> Option<Finding> {
    // The scan blanks strings, so the original text is compared.
    let words = line.text.trim().replace(is_typographic, "\"");
    let lost = words.starts_with("if name == \"main\"") || words.starts_with("if name == 'main'");
    lost.then(|| {
        let span = body.span_of(line.content.start..line.content.start + "if name".len());
        Finding::new(LISTING_UNDERSCORES, span, "the underscores of `__name__` are missing")
            .help("write if __name__ == \"__main__\":")
    })
}
