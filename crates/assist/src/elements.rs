//! The names in a model file: which elements have names, and which attributes refer to them. The text may be invalid, as it is
//! while an author types. The MJCF schema determines which attributes contain names.

use super::tag::{Attribute, Markup, OpenElements, Tags};
use labspec_core::xml::{AttributeType, schema_rows};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::LazyLock;

/// A name in a model file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ElementName {
    /// The noun for the named object: `body`, `joint`.
    pub noun: &'static str,
    /// The name.
    pub name: String,
    /// The byte range of the name, without quotes.
    pub span: Range<usize>,
    /// Whether the element gets its name here.
    pub defines: bool,
}

/// All names in a model file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ElementNames {
    /// The names that elements get or refer to, in order.
    pub all: Vec<ElementName>,
    /// An element that generates names from others or takes them from other files. Then a name may have meanings that
    /// this file does not show.
    pub composed: Option<String>,
    /// Texts in attributes that the schema does not know, which may be names.
    pub texts: Vec<(String, Range<usize>)>,
}

/// Elements that generate names.
const COMPOSING: [&str; 5] = ["include", "attach", "replicate", "composite", "flexcomp"];

/// The kinds of attributes, by section, element and attribute.
static SCHEMA: LazyLock<BTreeMap<String, AttributeType>> = LazyLock::new(|| {
    let mut all = BTreeMap::new();
    for row in schema_rows() {
        let (Some(attribute), mut parts) = (row.attribute, row.path.split('/').skip(1)) else { continue };
        let section = parts.next().unwrap_or("").to_string();
        let element = row.path.rsplit('/').next().unwrap_or("").to_string();
        if matches!(attribute.kind, AttributeType::Name(_) | AttributeType::Ref(_) | AttributeType::Text) {
            all.insert(format!("{section}/{element}/{}", attribute.name), attribute.kind);
        }
    }
    all
});

/// The noun for the value of `objtype` and similar attributes.
pub(crate) fn noun_of(word: &str) -> Option<&'static str> {
    let word = if word == "xbody" { "body" } else { word };
    SCHEMA.values().find_map(|kind| match kind {
        AttributeType::Name(noun) if *noun == word => Some(*noun),
        _ => None,
    })
}

/// All names in the text of a model.
pub fn element_names(xml: &str) -> ElementNames {
    let mut found = ElementNames::default();
    let mut open = OpenElements::default();
    for markup in Tags::new(xml) {
        let Markup::Tag(tag) = markup else { continue };
        if !tag.is_end {
            // The first open element below the root is the section.
            let section = open.names().get(1).copied().unwrap_or(tag.name);
            element(xml, section, tag.name, &tag.attributes, &mut found);
        }
        open.pass(&tag);
    }
    found
}

/// Collects the names that an element defines and refers to.
fn element(xml: &str, section: &str, name: &str, attributes: &[Attribute<'_>], found: &mut ElementNames) {
    if COMPOSING.contains(&name) {
        found.composed.get_or_insert_with(|| name.to_string());
    }
    let value = |span: &Range<usize>| xml.get(span.clone()).unwrap_or("");
    for (attribute, span) in attributes {
        let (noun, defines) = match SCHEMA.get(&format!("{section}/{name}/{attribute}")) {
            Some(AttributeType::Name(noun)) => (*noun, true),
            Some(AttributeType::Ref(noun)) => (*noun, false),
            Some(AttributeType::Text) => {
                // An adjacent attribute gives the kind of object to which `objname` and `refname` refer.
                let kind_attribute =
                    attribute.strip_suffix("name").map(|beginning| format!("{beginning}type"));
                let kind = attributes.iter().find(|(a, _)| Some(*a) == kind_attribute.as_deref());
                match kind.and_then(|(_, span)| noun_of(value(span))) {
                    Some(noun) => (noun, false),
                    None => {
                        found.texts.push((value(span).to_string(), span.clone()));
                        continue;
                    }
                }
            }
            _ => continue,
        };
        let name = value(span).to_string();
        if !name.is_empty() && !name.contains('&') {
            found.all.push(ElementName { noun, name, span: span.clone(), defines });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn describe_names(xml: &str) -> Vec<String> {
        let found = element_names(xml).all.into_iter();
        found
            .map(|m| {
                assert_eq!(&xml[m.span.clone()], m.name);
                format!("{}{} {}", if m.defines { "+" } else { "" }, m.noun, m.name)
            })
            .collect()
    }

    #[test]
    fn names_and_what_names_them() {
        let xml = r#"<?xml version="1.0"?><mujoco model="m"><!-- <body name="no"/> -->
            <worldbody><body name="arm"><joint name = 'hinge' type="hinge"/><geom class="x" material="red"/>
            <body name="hand"><site name="tip"/></body></body><frame><geom name="g"/></frame></worldbody>
            <contact><exclude body1="arm" body2="hand"/></contact>
            <actuator><motor name="pull" joint="hinge"/></actuator>
            <sensor><framepos objtype="site" objname="tip"/><jointpos joint="hinge"/></sensor></mujoco>"#;
        assert_eq!(
            describe_names(xml),
            [
                "+body arm",
                "+joint hinge",
                "material red",
                "+body hand",
                "+site tip",
                "+geom g",
                "body arm",
                "body hand",
                "+actuator pull",
                "joint hinge",
                "site tip",
                "joint hinge",
            ]
        );
        assert_eq!(element_names(xml).composed, None);
        assert_eq!(
            element_names("<mujoco><worldbody><replicate count='3'>").composed.as_deref(),
            Some("replicate")
        );
    }

    #[test]
    fn broken_models_keep_their_names() {
        assert_eq!(
            describe_names("<mujoco><worldbody><body name='a' <joint name='j'/><geom name='g"),
            ["+body a", "+joint j"]
        );
        assert_eq!(
            describe_names("<mujoco><worldbody><body name='a'></wrong><geom name=\"g\"/>"),
            ["+body a", "+geom g"]
        );
    }

    proptest! {
        /// No text causes a panic, and every span contains its name.
        #[test]
        fn any_text_is_read(text in "[<>/='\"a! \\-é]{0,40}|(<mujoco>|<worldbody>|<body |name=|'a'|/>|<!--|\\]\\]>|</body>|é){0,12}") {
            for m in element_names(&text).all {
                prop_assert_eq!(&text[m.span], m.name);
            }
        }
    }
}
