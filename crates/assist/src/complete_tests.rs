//! Whatever a completion offers, a check accepts: every completion at many places is inserted, continued in the simplest way,
//! and checked.

use crate::{Completion, CompletionKind, Context, Document, completions};
use labspec::bind::scene::Models;
use labspec::finding::Finding;
use labspec::lint::ModelFolder;
use labspec::source::Sources;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn context() -> Context {
    let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs").canonicalize().unwrap();
    let folder = ModelFolder::open(&specs.join("models")).unwrap();
    Context::new(Arc::new(Models::new(folder)), Sources::Disk)
}

/// The lesson around a part of a lab or of its claim; `|` marks the position.
fn lesson(inside: &str) -> String {
    format!(
        "# A\n\nIt takes 0.1 s.\n\n```lab simlab\n{{\"model\": \"servo\", \"title\": \"A\",\n \"plots\": [{{\"traces\": [{{\"label\": \"angle\", \"expr\": \"data.qpos[0]\"}}]}}],\n {inside}}}\n```\n"
    )
}

/// A claim with several runs, or with one.
fn claim(runs: &str, inside: &str) -> String {
    lesson(&format!(
        "\"verify\": {{\"runs\": {{{runs}}}, \"measure\": {{\"touch\": \"max(data.qpos[0])\", \"speed\": \"min(data.qvel[0])\"}}, {inside}}}"
    ))
}

/// A question with a claim of one run.
fn question(option: &str) -> String {
    format!(
        "# A\n\n```quiz\n{{\"id\": \"q\", \"questions\": [{{\"kind\": \"predict\", \"q\": \"Which?\", \"options\": [\"a\", \"b\"], \"answer\": 0, \"sim\": {{\"model\": \"servo\", \"readouts\": [{{\"label\": \"angle\", \"expr\": \"data.qpos[0]\"}}]}},\n \"verify\": {{\"runs\": {{{ONE}}}, \"measure\": {{\"touch\": \"max(data.qpos[0])\"}}, \"options\": [\"{option}\", \"touch < 0\"]}}}}]}}\n```\n"
    )
}

const ONE: &str = "\"go\": {\"until\": 0.1}";
const TWO: &str = "\"fine\": {\"until\": 0.1}, \"coarse\": {\"until\": 0.1, \"set\": {}}";

/// The errors of a text, by code and message.
fn errors(context: &Context, text: &str) -> BTreeSet<(String, String)> {
    let mut document = Document::new(PathBuf::from("a.md"), text);
    document.check(context);
    let errors = document.findings.iter().filter(|f| f.is_error());
    errors.map(|f: &Finding| (f.code.to_string(), f.message.clone())).collect()
}

fn offered(context: &Context, text: &str, byte: usize) -> Vec<Completion> {
    completions(&mut Document::new(PathBuf::from("a.md"), text), context, byte)
}

/// A text with a completion, and what may follow it.
fn continued(text: &str, c: &Completion, more: &str) -> (String, usize) {
    let mut new = text.to_string();
    new.replace_range(c.edit.span.clone(), &format!("{}{more}", c.edit.text));
    (new, c.edit.span.start + c.edit.text.len() + more.len())
}

/// The simplest arguments of a signature: `lib.bodyPos("name of a body")`.
fn arguments(title: &str) -> Vec<String> {
    let inside = title.split_once('(').and_then(|(_, rest)| rest.rsplit_once(')')).map_or("", |(a, _)| a);
    let argument = |part: &str| match part {
        "x" => "data.qpos[0]".to_string(),
        "list" => "[1, 2]".to_string(),
        "value" => "{}".to_string(),
        "model" | "data" => part.to_string(),
        "\"name of a body\"" => "'carriage'".to_string(),
        "\"name of a joint\"" => "'lift'".to_string(),
        "\"name of a geom\"" => "'carriage'".to_string(),
        "\"name of a site\"" => "'tip'".to_string(),
        "\"name of a readout or trace\"" => "'angle'".to_string(),
        part => part.to_string(),
    };
    let parts: Vec<String> = inside.split(", ").filter(|p| !p.is_empty()).map(argument).collect();
    (0..=parts.len()).rev().map(|n| format!("({})", parts[..n].join(", "))).collect()
}

/// Whether some continuation of a completion has no new error.
fn is_accepted(
    context: &Context,
    text: &str,
    before: &BTreeSet<(String, String)>,
    c: &Completion,
    depth: usize,
) -> bool {
    let mut tails: Vec<String> = ["", "[0]", ".length", ".value"].map(String::from).into();
    if c.kind == CompletionKind::Function {
        let mut calls = arguments(&c.detail);
        calls.extend(
            [
                "(1)",
                "((x) => x)",
                "([1])",
                "(0, 1)",
                "('a')",
                "((a, b) => a, 0)",
                "([[1, 0], [0, 1]])",
                "(model, 1, 'a')",
                "(model, 1, 0)",
                "(model, data, 0, [])",
            ]
            .map(String::from),
        );
        let results = ["", "[0]", "[0][0]", ".length", ".total", ".dim"];
        tails.extend(calls.iter().flat_map(|call| results.iter().map(move |r| format!("{call}{r}"))));
    }
    let fine = |tail: &String| {
        let (new, _) = continued(text, c, tail);
        errors(context, &new).is_subset(before)
    };
    if tails.iter().any(fine) {
        return true;
    }
    // An object, or a collection: a member of it.
    let names = ["('carriage').", "('lift').", "('hold').", "."];
    depth > 0
        && matches!(c.kind, CompletionKind::Object | CompletionKind::Variable)
        && names.iter().any(|tail| {
            let (new, byte) = continued(text, c, tail);
            offered(context, &new, byte)
                .iter()
                .any(|next| is_accepted(context, &new, before, next, depth - 1))
        })
}

/// The refused completions at the mark, and the number of all.
fn refused(context: &Context, marked: &str) -> (Vec<String>, usize) {
    let byte = marked.find('|').unwrap();
    let text = marked.replacen('|', "", 1);
    // What is wrong without the completion may stay wrong.
    let before: BTreeSet<_> = errors(context, &marked.replacen('|', "1", 1));
    let all = offered(context, &text, byte);
    let is_refused = |c: &&Completion| !is_accepted(context, &text, &before, c, 3);
    let describe = |c: &Completion| {
        let found = errors(context, &continued(&text, c, "").0);
        format!("{} ({:?}): {found:?}", c.label, c.kind)
    };
    (all.iter().filter(is_refused).map(describe).collect(), all.len())
}

/// The places of a program: whole texts, and members.
const PLACES: [&str; 16] = [
    "|",
    "1 + |",
    "data.|",
    "model.|",
    "model.opt.|",
    "model.stat.|",
    "mj.|",
    "lib.|",
    "sim.|",
    "ctx.|",
    "Math.|",
    "data.joint('lift').|",
    "model.geom('carriage').|",
    "data.joint('|').qpos[0]",
    "data.qpos.|",
    "lib.bodyPos('carriage').|",
];

/// Templates of a lab: a name, and the part in which `@` is the code.
const IN_LAB: [(&str, &str); 8] = [
    ("readout", "\"setup\": \"ctx.b = 1\", \"readouts\": [{\"label\": \"a\", \"expr\": \"@\"}]"),
    ("setup", "\"setup\": \"ctx.b = 1; ctx.a = @\""),
    ("statement", "\"setup\": \"ctx.b = 1; @\""),
    ("target", "\"controls\": [{\"label\": \"c\", \"min\": 0, \"max\": 1, \"value\": 0, \"set\": \"@\"}]"),
    (
        "apply",
        "\"controls\": [{\"label\": \"c\", \"min\": 0, \"max\": 1, \"value\": 0, \"apply\": \"ctx.a = value; ctx.b = @\"}]",
    ),
    ("measure", "\"verify\": {\"measure\": {\"m\": \"@\"}, \"says\": [[\"0.1 s\", \"m\"]]}"),
    ("in a measure", "\"verify\": {\"measure\": {\"m\": \"max(@)\"}, \"says\": [[\"0.1 s\", \"m\"]]}"),
    (
        "form",
        "\"controller\": \"ctx.w = 1\", \"setup\": \"ctx.b = 1\", \"verify\": {\"exact\": {\"angle\": \"@\"}}",
    ),
];

/// Templates of a claim: its runs, and what follows the measures.
const IN_CLAIM: [(&str, &str, &str); 5] = [
    ("claim of one run", ONE, "\"says\": [[\"0.1 s\", \"@\"]]"),
    ("in a claim of one run", ONE, "\"says\": [[\"0.1 s\", \"max(@)\"]]"),
    ("claim of two runs", TWO, "\"says\": [[\"0.1 s\", \"@\"]]"),
    ("stop", "\"go\": {\"until\": 0.1, \"stop\": \"@\"}", "\"says\": [[\"0.1 s\", \"touch\"]]"),
    (
        "search",
        ONE,
        "\"find\": {\"f\": {\"largest\": \"timestep\", \"from\": 0.001, \"to\": 0.01, \"tol\": 0.001, \"while\": \"@\"}}, \"says\": [[\"0.1 s\", \"f\"]]",
    ),
];

#[test]
fn every_completion_is_accepted() {
    let context = context();
    let in_lab = IN_LAB.map(|(name, inside)| (name, lesson(inside)));
    let in_claim = IN_CLAIM.map(|(name, runs, inside)| (name, claim(runs, inside)));
    let in_question = [("option", question("@ > 0"))];
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (name, template) in in_lab.into_iter().chain(in_claim).chain(in_question) {
        for place in PLACES {
            // What is around the position is refused itself.
            let outside = ["claim of one run", "option", "search", "form"].contains(&name)
                && place.starts_with("data.joint");
            if outside || name == "target" && place.starts_with("1 +") {
                continue;
            }
            let (refused, all) = refused(&context, &template.replace('@', place));
            assert!(place != "|" || all > 1, "{name}: nothing is offered");
            count += all;
            wrong.extend(refused.into_iter().map(|line| format!("{name}, {place}: {line}")));
        }
    }
    // After the name of a run.
    let (refused, all) = refused(&context, &claim(TWO, "\"says\": [[\"0.1 s\", \"fine.|\"]]"));
    assert!(refused.is_empty() && all == 3, "{refused:?}");
    assert!(wrong.is_empty(), "{} of {count}\n{}", wrong.len(), wrong.join("\n"));
    assert!(count > 5_000, "{count}");
}

/// Keys and values of the format: no completion is unknown, or a key that is there already. Where the kind of a control is not
/// written yet, the keys of all kinds are offered.
#[test]
fn every_key_and_value_is_known() {
    let context = context();
    let mut count = 0;
    for marked in [
        lesson("\"dock\": true, |"),
        lesson("\"dock\": |"),
        lesson("\"toggles\": [|]"),
        lesson("\"overlays\": {|}"),
        lesson("\"camera\": {|}"),
        lesson("\"trail\": \"|\""),
        lesson("\"controls\": [{\"type\": \"select\", |}]"),
        lesson("\"controls\": [{\"type\": \"slider\", |}]"),
        lesson("\"controls\": [{\"type\": \"|\"}]"),
        lesson("\"readouts\": [{\"label\": \"a\", |}]"),
        lesson("\"verify\": {|}"),
        lesson("\"verify\": {\"runs\": {\"a\": {|}}}"),
        lesson("\"lint\": {|}"),
        "```lab\n{\"model\": \"|\"}\n```\n".to_string(),
        "```quiz\n{|}\n```\n".to_string(),
        "```quiz\n{\"id\": \"q\", \"questions\": [{\"kind\": \"|\"}]}\n```\n".to_string(),
        "```quiz\n{\"id\": \"q\", \"questions\": [{\"kind\": \"numeric\", |}]}\n```\n".to_string(),
    ] {
        let byte = marked.find('|').unwrap();
        let text = marked.replacen('|', "", 1);
        for c in offered(&context, &text, byte) {
            let (new, _) = continued(&text, &c, "");
            let found = errors(&context, &new);
            let is_refused =
                |(code, _): &(String, String)| code.starts_with("unknown") || code == "duplicate-key";
            assert!(!found.iter().any(is_refused), "{} at {marked}: {found:?}", c.label);
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}
