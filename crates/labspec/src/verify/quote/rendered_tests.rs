//! Which texts count as rendered, and which do not.

use super::*;
use crate::lint::ModelFolder;
use crate::lint::load_lesson;
use crate::source::SourceFile;

/// A lesson whose first lab quotes `quotes`, with some Markdown around it.
fn lesson(markdown: &str, quotes: &[&str]) -> Lesson {
    let says: Vec<_> = quotes.iter().map(|q| serde_json::json!([q, "1"])).collect();
    let lab = serde_json::json!({
        "xml": "<mujoco/>", "setup": "ctx.x = '0.442 s'", "title": "Title 1.1 s", "note": "<b>2.2</b>&nbsp;s <!-- 3.3 s -->",
        "controls": [{"label": "4.4 s", "unit": "5.5 s", "param": "p", "min": 0, "max": 1, "value": 0},
                     {"type": "select", "label": "s", "param": "q", "options": [["6.6 s", 1]], "value": 1}],
        "plots": [{"ylabel": "7.7 s", "xlabel": "8.8 s", "refLines": [{"y": 1, "label": "9.9 s"}], "traces": [{"label": "1.2 s", "expr": "1.3"}]}],
        "readouts": [{"label": "1.4 s", "expr": "'1.5 s'"}],
        "verify": {"says": says},
    });
    let text = format!("{markdown}\n\n```lab simlab\n{lab}\n```\n");
    load_lesson(SourceFile::new("a.md", text), &ModelFolder::unknown())
}

/// The rendered places of a quote, as texts of the file.
fn places(markdown: &str, quote: &str) -> Vec<String> {
    let lesson = lesson(markdown, &[quote]);
    let rendered = RenderedText::of_lesson(&lesson);
    rendered.places(quote).iter().map(|r| lesson.file.slice(r.clone()).to_string()).collect()
}

#[test]
fn prose_is_rendered_as_on_a_page() {
    for markdown in [
        "It takes 0.442 s.",
        "# After 0.442 s",
        "- in a list: 0.442 s",
        "> quoted: 0.442 s",
        "| a | b |\n|---|---|\n| 0.442 s | c |\n",
        "`0.442 s`",
        "It takes\n0.442 s",
        "```\nt = 0.442 s\n```",
        "```text\nt = 0.442 s\n```",
        "> ```console\n> t = 0.442 s\n> ```",
        "<p>It takes 0.442 s</p>",
        "![0.442 s](fall.png)",
        "Note.[^1]\n\n[^1]: After 0.442 s.\n",
    ] {
        assert_eq!(places(markdown, "0.442 s"), ["0.442 s"], "{markdown}");
    }
    for (markdown, place) in [
        ("It takes **0.442** s.", "0.442** s"),
        ("It takes 0.442&nbsp;s.", "0.442&nbsp;s"),
        ("It takes 0.442\u{a0}s.", "0.442\u{a0}s"),
        ("It takes <b>0.442</b> s.", "0.442</b> s"),
        ("It takes 0.442\ns.", "0.442\ns"),
        ("It takes $0.442\\,\\mathrm{s}$.", "0.442\\,\\mathrm{s"),
        ("It takes $0.442$ s.", "0.442$ s"),
        ("<div>It takes <b>0.442</b>\n s</div>", "0.442</b>\n s"),
    ] {
        assert_eq!(places(markdown, "0.442 s"), [place], "{markdown}");
    }
    let twice = "0.442 s\n\n0.442 s";
    assert_eq!(places(twice, "0.442 s").len(), 2);
    assert_eq!(places("at $2.4 \\times 10^{-4}$ m", "2.4×10⁻⁴ m"), ["2.4 \\times 10^{-4}$ m"]);
    assert_eq!(places("at \u{2212}0.5 m", "-0.5 m"), ["\u{2212}0.5 m"]);
}

#[test]
fn hidden_text_is_not_a_place() {
    for markdown in [
        "It takes 0.443 s.",
        "```python\nt = 0.442 s\n```",
        "```python file=a.py\nt = 0.442 s\n```",
        "```text file=a.txt\nt = 0.442 s\n```",
        "```json\n{\"0.442 s\": 1}\n```",
        "<!-- 0.442 s -->",
        "a <!-- 0.442 s --> b",
        "<img alt=\"0.442 s\">",
        "a <span title=\"0.442 s\">b</span>",
        "[link](https://example.org/ \"0.442 s\")",
        "---\nt: 0.442 s\n---\n",
        "<script>\n0.442 s\n</script>",
        "<div hidden>\n\n*a* <b>b</b>\n\n0.442 s\n\n</div>",
        "<div\n hidden>\n0.442 s\n</div>",
        "{\"model\": \"a\", \"controls\": [{\"type\": \"button\", \"label\": \"0.442 s\", \"run\": \"0.442 s\"}]}",
        "-0.442 s",
        "10.442 s",
        "0.442 seconds",
        "| 0.442 | s |\n|---|---|\n| 1 | 2 |\n",
    ] {
        let found = places(markdown, "0.442 s");
        // A lab without a fence is a lab: its labels are expected, its code is not.
        let expected = usize::from(markdown.starts_with('{'));
        assert_eq!(found.len(), expected, "{markdown}: {found:?}");
    }
}

#[test]
fn labs_show_their_labels_and_not_their_code() {
    let lesson = |quote| places("", quote);
    for quote in ["1.1 s", "2.2 s", "4.4 s", "5.5 s", "6.6 s", "7.7 s", "8.8 s", "9.9 s", "1.2 s", "1.4 s"] {
        assert_eq!(lesson(quote).len(), 1, "{quote}");
    }
    for quote in ["0.442 s", "3.3 s", "1.3", "1.5 s"] {
        assert!(lesson(quote).is_empty(), "{quote}");
    }
    assert_eq!(lesson("2.2 s"), ["2.2</b>&nbsp;s"]);
}

#[test]
fn quotes_found_only_in_code_are_reported() {
    let lesson = lesson("```python\nt = '0.4425 s'\n```", &["0.4425 s", "0.442 s", "7.5 s"]);
    let rendered = RenderedText::of_lesson(&lesson);
    assert_eq!(lesson.file.slice(rendered.hidden("0.4425 s").unwrap()), "0.4425 s");
    assert!(rendered.hidden("7.5 s").is_none());
}

#[test]
fn prose_after_a_damaged_fence_is_rendered() {
    let markdown =
        "```lab\n{\"model\": \"a\"}\nIt takes 0.442 s.\n\n```quiz\n{\"id\": \"q\", \"questions\": []}\n```\n";
    assert_eq!(places(markdown, "0.442 s"), ["0.442 s"]);
}

/// Hundreds of quotes in a large lesson need one pass through it. The steps are counted in the tests of `places`; this test
/// checks that every place is found. (14 MB and 400 quotes take well under a second in a release build.)
#[test]
fn many_quotes_in_a_large_lesson_are_found() {
    let line =
        "After 0.442 s it is at -1.5 m, with $v = 3.0\\times10^{-3}$ m/s and 50 % of **its** energy.\n\n";
    let markdown = line.repeat((1 << 20) / line.len());
    let quotes: Vec<String> = (0..400).map(|i| format!("0.44{i} s")).collect();
    let lesson = lesson(&markdown, &quotes.iter().map(String::as_str).collect::<Vec<_>>());
    let rendered = RenderedText::of_lesson(&lesson);
    let found: Vec<usize> = quotes.iter().map(|q| rendered.places(q).len()).filter(|&n| n > 0).collect();
    assert_eq!(found, [1000]);
}

#[test]
fn hostile_texts_cause_no_panic() {
    for text in [
        "<a <a <a",
        "&#;&#;&#",
        "$$$$$",
        "²²²²₁₁₁",
        "\\\\\\",
        "0 0 0 0",
        "1,1,1,",
        "½½½",
        "<!--",
        "```",
        "~~~\n0",
    ] {
        let lesson = lesson(&text.repeat(2000), &["0.442 s", "1", "0 0", "²", "½"]);
        let rendered = RenderedText::of_lesson(&lesson);
        for quote in ["1", "0 0", "½"] {
            assert!(
                rendered.places(quote).iter().all(|r| lesson.file.text().get(r.clone()).is_some()),
                "{text}"
            );
        }
    }
}
