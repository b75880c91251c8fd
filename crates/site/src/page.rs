//! The frame of every page: its head with the policy, the navigation, the main part, the foot.

use crate::names::root_from;
use crate::overview::LIST_TITLE;
use crate::text::escape;
use std::fmt::Write;

/// No script but those of the site, no style but those of the site, nothing from elsewhere.
pub(crate) const POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' data:; \
font-src 'self'; connect-src 'self'; worker-src 'self' blob:; manifest-src 'self'; base-uri 'none'; form-action 'none'";

/// A page around its main part.
#[derive(Debug, Default)]
pub(crate) struct Page<'p> {
    /// Its name in the site.
    pub(crate) name: &'p str,
    pub(crate) title: &'p str,
    /// The title of the course.
    pub(crate) course: &'p str,
    pub(crate) lang: &'p str,
    /// The text for search engines.
    pub(crate) description: &'p str,
    /// The address of the page where the site will be.
    pub(crate) canonical: Option<String>,
    pub(crate) has_math: bool,
    /// Attributes of the main part, written.
    pub(crate) attributes: String,
    /// The main part, written.
    pub(crate) main: String,
    /// The page with the list of the lessons, where it is not the first page.
    pub(crate) list: Option<&'p str>,
    /// Links to the pages before and after, written.
    pub(crate) neighbours: String,
    /// What the preview adds to the head, written.
    pub(crate) head: String,
    /// Whether the pages are offered offline.
    pub(crate) is_offline: bool,
    /// Whether the page stands alone: without the course around it, there is nothing to navigate.
    pub(crate) is_alone: bool,
}

impl Page<'_> {
    /// The page as HTML.
    pub(crate) fn write(&self) -> String {
        let root = escape(&root_from(self.name));
        let title = match self.title == self.course {
            true => escape(self.title),
            false => format!("{} · {}", escape(self.title), escape(self.course)),
        };
        let mut out = format!(
            "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n<meta name=\"generator\" content=\"labspec {}\">\n\
             <title>{title}</title>\n",
            escape(self.lang),
            escape(POLICY),
            env!("CARGO_PKG_VERSION")
        );
        if !self.description.is_empty() {
            let _ = writeln!(out, "<meta name=\"description\" content=\"{}\">", escape(self.description));
        }
        if let Some(address) = &self.canonical {
            let _ = writeln!(out, "<link rel=\"canonical\" href=\"{}\">", escape(address));
        }
        let _ = writeln!(
            out,
            "<link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"{root}page/site.css\">"
        );
        if self.has_math {
            let _ = writeln!(out, "<link rel=\"stylesheet\" href=\"{root}page/katex.css\">");
        }
        let _ = writeln!(out, "<script type=\"module\" src=\"{root}page/site.js\"></script>");
        out.push_str(&self.head);
        let offline = if self.is_offline { " data-offline" } else { "" };
        let _ = write!(
            out,
            "</head>\n<body data-root=\"{root}\"{offline}>\n{}<main id=\"main\" tabindex=\"-1\"{}>\n{}</main>\n",
            if self.is_alone { String::new() } else { self.header(&root) },
            self.attributes,
            self.main
        );
        if !self.neighbours.is_empty() {
            let _ = writeln!(out, "<nav class=\"pager\" aria-label=\"Lessons\">{}</nav>", self.neighbours);
        }
        let _ = write!(
            out,
            "<footer><p>Made and checked by labspec {}.</p></footer>\n</body>\n</html>\n",
            env!("CARGO_PKG_VERSION")
        );
        out
    }

    /// What is above the main part.
    fn header(&self, root: &str) -> String {
        let list =
            self.list.map_or(String::new(), |name| format!("<a href=\"{root}{name}\">{LIST_TITLE}</a> "));
        format!(
            "<a class=\"skip\" href=\"#main\">Skip to the text</a>\n\
             <header class=\"top\">\n<nav aria-label=\"Course\"><a class=\"home\" href=\"{root}index.html\">{}</a> {list}\
             <a href=\"{root}labs.html\">Labs</a></nav>\n\
             <form class=\"search\" role=\"search\" hidden><label><span class=\"hidden\">Search</span>\
             <input type=\"search\" placeholder=\"Search\" autocomplete=\"off\" spellcheck=\"false\"></label>\
             <div class=\"results\" role=\"region\" aria-label=\"Results\" aria-live=\"polite\" hidden></div></form>\n</header>\n",
            escape(self.course)
        )
    }
}
