//! Names: they are unique among objects of one kind, and every reference must lead to an object.

use std::collections::BTreeMap;

use super::classes::Classes;
use super::schema::AttributeType;
use crate::mjcf::keyword_map::KeywordMap;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::{Diagnostics, nearest, shorten_name};
use crate::mjcf::text::tree::{Attribute, ElementNode, ElementTree};
use crate::mjcf::text::values::Value;

/// The advice for a name that is used several times.
const IN_ALL_PLACES: &str = "write the same name in all places";

/// Named elements, by kind and name.
#[derive(Debug, Default)]
pub(crate) struct NameTable<'t> {
    nodes: KeywordMap<BTreeMap<&'t str, usize>>,
}

/// The name of the world body, and its index in the table. It is not an element.
pub(crate) const WORLD: &str = "world";
const WORLD_NODE: usize = 0;

impl<'t> NameTable<'t> {
    /// Collects all names and reports duplicates.
    pub(crate) fn read(tree: &'t ElementTree, report: &mut Diagnostics) -> NameTable<'t> {
        let mut table = NameTable::default();
        table.nodes.or_default("body").insert(WORLD, WORLD_NODE);
        for (i, node) in tree.nodes.iter().enumerate() {
            for a in &node.attributes {
                let (AttributeType::Name(kind), Value::Text(name)) = (a.attr.kind, &a.value) else {
                    continue;
                };
                if name.is_empty() {
                    continue;
                }
                let previous = table.nodes.or_default(kind).insert(name, i);
                if previous.is_some() {
                    report
                        .error(
                            rules::DUPLICATE_NAME,
                            a.span.clone(),
                            format!("a second {kind} has the name {}", shorten_name(name)),
                        )
                        .why("expressions and sensors find an object by its name, so it must be unique")
                        .help(match name.as_str() {
                            WORLD if kind == "body" => {
                                "use another name: `world` is the world body".to_string()
                            }
                            _ => format!("give one {kind} another name"),
                        });
                }
            }
        }
        table
    }

    /// The element of this kind and name.
    pub(crate) fn find(&self, kind: &str, name: &str) -> Option<usize> {
        self.nodes.get(kind)?.get(name).copied()
    }

    /// All names of a kind.
    pub(crate) fn of_kind(&self, kind: &str) -> impl Iterator<Item = &'t str> {
        self.nodes.get(kind).into_iter().flat_map(|names| names.keys().copied())
    }

    /// Reports a name that no object of the kind has.
    pub(crate) fn unknown(
        &self,
        kind: &str,
        name: &str,
        span: std::ops::Range<usize>,
        report: &mut Diagnostics,
    ) {
        if report.incomplete {
            return; // the object may have been left out
        }
        let message = format!("there is no {kind} named {}", shorten_name(name));
        // Several uses of one name are one mistake: of all uses, or of the definition.
        if let Some(first) = report.same(rules::UNKNOWN_NAME, &message) {
            // The search for a similar name is made once, however often the name is used.
            let is_second = first
                .help
                .as_ref()
                .is_some_and(|help| help.starts_with("did you mean") && !help.ends_with(IN_ALL_PLACES));
            if let Some(near) = is_second.then(|| nearest(name, self.of_kind(kind))).flatten() {
                first.help = Some(format!("did you mean `{near}`? {IN_ALL_PLACES}"));
            }
            return;
        }
        let near = nearest(name, self.of_kind(kind));
        let error = report.error(rules::UNKNOWN_NAME, span, message);
        match near {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None if self.of_kind(kind).next().is_none() => {
                error.help(format!("give it a name: no {kind} of this model has one"))
            }
            None => error,
        };
    }
}

/// Names meshes, height fields, textures and skins without a name after their files.
pub(crate) fn after_files(tree: &mut ElementTree) {
    for node in &mut tree.nodes {
        if !matches!(node.element.name, "mesh" | "hfield" | "texture" | "skin") || node.text("name").is_some()
        {
            continue;
        }
        let (Some(attr), Some(file)) = (node.element.attribute("name"), node.attribute("file")) else {
            continue;
        };
        let (span, stem) = (file.span.clone(), stem(node.text("file").unwrap_or("")).to_string());
        node.attributes.retain(|a| a.attr.name != "name");
        node.attributes.push(Attribute { attr, value: Value::Text(stem), span });
    }
}

/// The name of a file without its folders and its extension.
fn stem(path: &str) -> &str {
    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// Checks that references and classes exist.
pub(crate) fn check_references(
    tree: &ElementTree,
    names: &NameTable,
    classes: &Classes,
    report: &mut Diagnostics,
) {
    let mut defined: BTreeMap<&str, usize> = BTreeMap::new();
    let mut dangling = Vec::new();
    for node in &tree.nodes {
        let is_default = node.element.name == "default";
        let entry = is_entry(tree, node);
        if is_default {
            check_class(tree, node, &mut defined, report);
        }
        if report.is_full() {
            return;
        }
        for a in &node.attributes {
            let Value::Text(name) = &a.value else { continue };
            match a.attr.kind {
                AttributeType::Ref(kind) if !name.is_empty() && names.find(kind, name).is_none() => {
                    if entry {
                        dangling.push(DanglingReference {
                            entry: node.element.name,
                            attribute: a,
                            kind,
                            name,
                        });
                    } else {
                        names.unknown(kind, name, a.span.clone(), report);
                    }
                }
                AttributeType::Class if !is_default && classes.find(name).is_none() => {
                    let error = report.error(
                        rules::UNKNOWN_CLASS,
                        a.span.clone(),
                        format!("there is no default class named {}", shorten_name(name)),
                    );
                    match nearest(name, classes.names()) {
                        Some(near) => error.help(format!("did you mean `{near}`?")),
                        None => error.help(format!("define it: `<default><default class=\"{name}\"> … `")),
                    };
                }
                _ => {}
            }
        }
    }
    check_dangling(tree, names, classes, dangling, report);
}

/// Whether an element is inside a default class.
fn is_entry(tree: &ElementTree, node: &ElementNode) -> bool {
    node.parent.and_then(|p| tree.nodes.get(p)).is_some_and(|p| p.element.name == "default")
}

/// A default that refers to an object that does not exist.
struct DanglingReference<'t> {
    /// The kind of element to which the default applies.
    entry: &'static str,
    attribute: &'t Attribute,
    kind: &'static str,
    name: &'t str,
}

/// Reports a default that refers to a missing object, at each element to which it applies. If there is no such element, it is not
/// an error. This is the behaviour of MuJoCo, which resolves the name for each element.
fn check_dangling(
    tree: &ElementTree,
    names: &NameTable,
    classes: &Classes,
    mut dangling: Vec<DanglingReference>,
    report: &mut Diagnostics,
) {
    let mut childclass: Vec<Option<usize>> = Vec::with_capacity(tree.nodes.len());
    for node in &tree.nodes {
        let above = node.parent.and_then(|p| childclass.get(p).copied().flatten());
        let child_class = node.text("childclass").and_then(|name| classes.find(name));
        childclass.push(child_class.or(above));
        let entry = match node.element.name {
            "spatial" | "fixed" => "tendon",
            name => name,
        };
        let may_use = |d: &DanglingReference| {
            d.entry == entry && node.element.attribute(d.attribute.attr.name).is_some()
        };
        if dangling.is_empty() {
            return;
        }
        if !dangling.iter().any(may_use) || is_entry(tree, node) {
            continue;
        }
        let p = classes.props_of(entry, node, above);
        dangling.retain(|d| {
            let used = may_use(d) && p.span(d.attribute.attr.name).as_ref() == Some(&d.attribute.span);
            if used {
                names.unknown(d.kind, d.name, d.attribute.span.clone(), report);
            }
            !used
        });
    }
    for d in dangling {
        let message =
            format!("this default names the {} {}, which does not exist", d.kind, shorten_name(d.name));
        report
            .warning(rules::UNKNOWN_NAME, d.attribute.span.clone(), message)
            .why("no element uses this default yet; if one does, the model will not load")
            .help(format!("remove the attribute, or name a {} that exists", d.kind));
    }
}

/// Checks that a nested class has a unique name. The outermost class is named `main`.
fn check_class<'t>(
    tree: &'t ElementTree,
    node: &'t ElementNode,
    defined: &mut BTreeMap<&'t str, usize>,
    report: &mut Diagnostics,
) {
    let nested = node.parent.and_then(|p| tree.nodes.get(p)).is_some_and(|p| p.element.name == "default");
    let span = node.attribute("class").map_or(node.span.clone(), |a| a.span.clone());
    match (nested, node.text("class")) {
        (true, None) => {
            report
                .error(rules::MISSING_ATTRIBUTE, span, "a nested default has no class name")
                .why("elements choose a class by its name")
                .help("write `<default class=\"…\">`");
        }
        (true, Some(name)) if name == "main" || defined.insert(name, 0).is_some() => {
            report
                .error(
                    rules::DUPLICATE_NAME,
                    span,
                    format!("the default class {} is defined twice", shorten_name(name)),
                )
                .help("give one of them another name");
        }
        (false, Some(name)) if name != "main" && node.model == 0 => {
            report
                .error(
                    rules::UNKNOWN_CLASS,
                    span,
                    format!("the outer default class is called {}, not `main`", shorten_name(name)),
                )
                .help(format!("nest it: `<default><default class=\"{name}\"> … </default></default>`"));
        }
        _ => {}
    }
}
