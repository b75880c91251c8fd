//! The files that make a site complete: the service worker with the list of files, the map for search engines.

use crate::text::{address, escape};
use crate::verified::short_hash;
use std::fmt::Write;

/// The service worker: a version that is a hash of all files, their list, and the program from the page's files.
pub(crate) fn service_worker(files: &[(String, String)], program: &str) -> String {
    let all: String = files.iter().map(|(name, hash)| format!("{name} {hash}\n")).collect();
    let version = short_hash(&[all.as_bytes(), program.as_bytes()]);
    let names: Vec<String> = files.iter().map(|(name, _)| address(name)).collect();
    let list = serde_json::to_string(&names).unwrap_or_else(|_| "[]".into());
    format!("const VERSION = \"{version}\";\nconst FILES = {list};\n{program}")
}

/// The map of the site for search engines. Pages have no dates: the same course gives the same site.
pub(crate) fn sitemap(base: &str, names: &[String]) -> String {
    let mut out = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<urlset xmlns=\"http://www.sitemaps.org/schemas/sitemap/0.9\">\n",
    );
    for name in names {
        let _ = writeln!(out, "<url><loc>{}{}</loc></url>", escape(base), address(name));
    }
    out.push_str("</urlset>\n");
    out
}
