//! Hostile lessons, made at random: whatever they write, each group of a page is HTML that is closed in itself, and runs nothing.

use crate::html::Addresses;
use crate::marks::TextMark;
use crate::masked::Masked;
use crate::prose::{RenderContext, outline, render, requested_id};
use labspec::markdown::scan;
use labspec::source::SourceFile;

/// Pieces of lessons: Markdown, HTML, fences, and what ends them.
const PIECES: &[&str] = &[
    "\n",
    "\n\n",
    "\r\n",
    " ",
    "    ",
    "> ",
    "- ",
    "1. ",
    "# ",
    "## a {#b .c onclick=x}\n",
    "text ",
    "*",
    "**",
    "_",
    "~~",
    "`",
    "```\n",
    "````\n",
    "```lab simlab\n{\"xml\": \"<mujoco/>\"}\n```\n",
    "```quiz\n{\n",
    "~~~py\n",
    "| a | b |\n|--|:-:|\n| 1 | 2 |\n",
    "[a](b)",
    "![a](",
    "[x]: javascript:alert(1)\n",
    "[x]",
    "<https://a.b>",
    "<a@b.c>",
    "[^1]",
    "[^1]: note\n",
    "$x<y$",
    "$$",
    "\\",
    "&lt;",
    "&",
    "<div>",
    "</div>",
    "<details><summary>",
    "</summary>",
    "</details>\n\n",
    "<p>",
    "<b>",
    "</b>",
    "<script>",
    "</script>",
    "<style>",
    "<img src=x onerror=y>",
    "<a href='javascript:x' onclick=y>",
    "</a>",
    "<svg/onload=x>",
    "<table><tr><td>",
    "<!--",
    "-->",
    "<!--labspec-->",
    "<![CDATA[",
    "<?",
    "</main>",
    "<textarea>",
    "\u{0}",
    "---\ntitle: a\n---\n",
];

/// Refuses every address but those of the web, and takes every id.
struct Web;

impl Addresses for Web {
    fn link(&mut self, target: &str) -> Option<String> {
        Some(target.to_string()).filter(|target| target.starts_with("https:"))
    }

    fn image(&mut self, _: &str) -> Option<String> {
        None
    }

    fn id(&mut self, id: &str) -> Option<String> {
        Some(id.to_string())
    }
}

/// A generator of numbers: xorshift, from a fixed seed.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n as u64) as usize
    }
}

/// The groups of a text, each as HTML; a fence is an element of its own.
fn groups(text: &str) -> Vec<String> {
    let scan = scan(&SourceFile::new("a.md", text));
    let masked = Masked::new(text, &scan);
    let ids: Vec<String> = outline(&masked).0.iter().map(requested_id).collect();
    let marks: Vec<TextMark> = (0..text.len())
        .step_by(7)
        .map(|start| TextMark { span: start..start + 3, class: "claim-true", label: "<b>\"".into() })
        .collect();
    let mut fence = |index: usize, _: &mut dyn Addresses| format!("<sim-lab>{index}</sim-lab>");
    let mut around =
        RenderContext { masked: &masked, ids: &ids, marks: &marks, addresses: &mut Web, fence: &mut fence };
    let all = render(&mut around);
    let alone = all.iter().filter_map(|group| group.fence).map(|index| format!("<sim-lab>{index}</sim-lab>"));
    let alone: Vec<String> = alone.collect();
    all.into_iter().filter(|group| group.fence.is_none()).map(|group| group.html).chain(alone).collect()
}

/// Why some HTML is not closed in itself, or runs something.
fn fault(html: &str) -> Option<String> {
    let mut open: Vec<&str> = Vec::new();
    for part in html.split('<').skip(1) {
        let Some((tag, _)) = part.split_once('>') else { return Some(format!("<{part} has no end")) };
        let name = tag.trim_start_matches('/').split([' ', '\n', '/']).next().unwrap_or("");
        if tag.contains(" on")
            || tag.contains("javascript:")
            || ["script", "style", "svg", "main", "textarea"].contains(&name)
        {
            return Some(format!("<{tag}>"));
        }
        match tag.strip_prefix('/') {
            _ if ["br", "hr", "img"].contains(&name) => {}
            Some(_) if open.pop() != Some(name) => return Some(format!("</{name}> after {open:?}")),
            Some(_) => {}
            None => open.push(name),
        }
    }
    (!open.is_empty()).then(|| format!("{open:?} stay open"))
}

#[test]
fn random_lessons_are_closed_in_themselves_and_run_nothing() {
    let mut random = Random(0x5eed_1ab5);
    let mut labs = 0;
    for _ in 0..4000 {
        let count = 1 + random.below(24);
        let text: String = (0..count).map(|_| PIECES[random.below(PIECES.len())]).collect();
        let whole = groups(&text);
        for html in &whole {
            let found = fault(html);
            assert!(found.is_none(), "{found:?}\n{text:?}\n{html}");
        }
        // Every fence that a check sees is on the page, once.
        let expected = scan(&SourceFile::new("a.md", text.as_str())).blocks.len();
        let written = whole.iter().map(|html| html.matches("<sim-lab>").count()).sum::<usize>();
        assert_eq!(written, expected, "{text:?}\n{whole:?}");
        labs += written;
    }
    assert!(labs > 500, "{labs}");
}
