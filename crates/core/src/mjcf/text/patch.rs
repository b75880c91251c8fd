//! Patches of a model's text before it is compiled: new values for attributes of elements, which are addressed by kind and name,
//! and new elements in place of others.
//!
//! Patches are applied to the plain elements, after includes are expanded. Masses, inertias and sizes are then
//! compiled as if the author had written the new values.

use super::diagnostic::nearest;
use super::xml::{XmlAttribute, XmlElement};
use crate::mjcf::gather::listed;
use crate::mjcf::schema::{self, AttributeType, INCLUDE, ROOT};
use crate::source::model_patch::{Patch, Refusal};
use labspec_finding::order;

/// Elements that occur at most once and may be absent. The first name is the parent of the second.
const SETTINGS: [(&str, &str); 5] = [
    ("mujoco", "option"),
    ("mujoco", "compiler"),
    ("mujoco", "size"),
    ("mujoco", "statistic"),
    ("option", "flag"),
];

/// An element with its entry in the schema.
#[derive(Clone, Copy)]
struct PatchElement {
    index: usize,
    parent: usize,
    schema: &'static schema::Element,
    /// Whether it is inside `default`. Only paths that begin with `default` refer to it.
    default: bool,
}

/// Replaces an element by the element at the index `new` of the list. The new element keeps the name of the old one, unless it has
/// its own.
pub(super) fn replace(
    list: &mut Vec<XmlElement>,
    root: usize,
    patch: &Patch,
    new: usize,
) -> Result<(), Refusal> {
    let path = patch.path.trim();
    let (kind, name) = path.split_once(char::is_whitespace).unwrap_or((path, ""));
    let name = Some(name.trim()).filter(|name| !name.is_empty());
    let elements = list_elements(list, root);
    let found = find_element(list, &elements, kind, name)?;
    let new_kind = list.get(new).map_or("", |e| e.name.as_str());
    // The parent in the schema: an included element belongs to the parent of the `include`.
    let parent = elements.iter().find(|s| s.index == found.parent).filter(|_| found.index != root);
    let Some(parent) = parent else {
        let message = format!("`{kind}` cannot be replaced");
        return Err(Refusal { message, help: "change its attributes, or replace an element in it".into() });
    };
    if parent.schema.child(new_kind).is_none() {
        let message =
            format!("`{new_kind}` cannot replace `{kind}`: `{}` has no such child", parent.schema.name);
        let help = suggestion(new_kind, parent.schema.child_names(), "it has no children");
        return Err(Refusal { message, help });
    }
    let old_name = list.get(found.index).and_then(|e| e.attribute("name")).map(|a| a.value.clone());
    let span = list.get(found.index).map_or(0..0, |e| e.span.clone());
    place_at(list, new, &span);
    let named = list.get(new).is_some_and(|e| e.attribute("name").is_some());
    if let Some(name) = old_name.filter(|_| !named) {
        set(list, new, "name", &name);
    }
    for element in list.iter_mut() {
        for child in &mut element.children {
            if *child == found.index {
                *child = new;
            }
        }
    }
    Ok(())
}

/// Gives an element and everything in it a span: that of the element which it replaces.
fn place_at(list: &mut [XmlElement], index: usize, span: &std::ops::Range<usize>) {
    let mut open = vec![index];
    while let Some(index) = open.pop() {
        let Some(element) = list.get_mut(index) else { continue };
        element.span = span.clone();
        for attribute in &mut element.attributes {
            (attribute.name_span, attribute.value_span) = (span.clone(), span.clone());
            attribute.exact = false;
        }
        open.extend(&element.children);
    }
}

/// Applies one patch of an attribute.
pub(super) fn apply(list: &mut Vec<XmlElement>, root: usize, patch: &Patch) -> Result<(), Refusal> {
    let refuse = |message: String, help: &str| Err(Refusal { message, help: help.to_string() });
    let words: Vec<&str> = listed(patch.path.split_whitespace());
    if let ["default", class @ .., kind, attribute] = words.as_slice()
        && class.len() <= 1
    {
        return set_default(list, root, class.first().copied(), [kind, attribute], &patch.value);
    }
    let (kind, name, attribute) = match words.as_slice() {
        [kind, attribute] => (*kind, None, *attribute),
        [kind, .., attribute] => {
            let name = patch.path.trim().get(kind.len()..).and_then(|rest| rest.strip_suffix(attribute));
            (*kind, name.map(str::trim), *attribute)
        }
        _ => {
            return refuse(
                format!("`{}` is not an attribute of an element", patch.path),
                "write kind, name and attribute, as in \"geom ball friction\", or \"option timestep\"",
            );
        }
    };
    let elements = list_elements(list, root);
    let found = find_element(list, &elements, kind, name)?;
    // The mass of a body is an attribute of its inertial or its geom.
    let found = match (kind, attribute) {
        ("body", "mass") => mass_of(list, found, &elements, name.unwrap_or(""))?,
        _ => found,
    };
    match found.schema.attribute(attribute) {
        Some(attr) if matches!(attr.kind, AttributeType::Name(_)) => refuse(
            format!("the name of a {kind} cannot be changed"),
            "change one of its attributes: objects are found by their names",
        ),
        Some(_) => {
            set(list, found.index, attribute, &patch.value);
            Ok(())
        }
        None => {
            let help = suggestion(attribute, found.schema.attributes().map(|a| a.name), "it has none");
            refuse(format!("`{kind}` has no attribute `{attribute}`"), &help)
        }
    }
}

/// Sets an attribute of a kind of element in a default class: the main one if no class is given.
fn set_default(
    list: &mut Vec<XmlElement>,
    root: usize,
    class: Option<&str>,
    [kind, attribute]: [&str; 2],
    value: &str,
) -> Result<(), Refusal> {
    let elements = list_elements(list, root);
    let class_of = |s: &PatchElement| list.get(s.index)?.attribute("class").map(|a| a.value.clone());
    let classes: Vec<PatchElement> = listed(elements.iter().copied().filter(|s| s.schema.name == "default"));
    // The outermost class is the main one, with or without its name.
    let is_main = |s: &PatchElement| s.parent == root;
    let found = classes.iter().find(|s| match class {
        None | Some("main") => is_main(s) || class_of(s).as_deref() == Some("main"),
        Some(class) => class_of(s).as_deref() == Some(class),
    });
    let found = match (found, class) {
        (Some(found), _) => *found,
        (None, None | Some("main")) => {
            let root = PatchElement { index: root, parent: root, schema: &ROOT, default: false };
            let made = create_child(list, root, "default");
            made.ok_or_else(|| unknown_kind("default", std::iter::empty()))?
        }
        (None, Some(class)) => {
            let names: Vec<String> = listed(classes.iter().filter_map(class_of));
            let help = suggestion(class, names.iter().map(String::as_str), "it has no default classes");
            return Err(Refusal { message: format!("the model has no default class `{class}`"), help });
        }
    };
    let Some(schema) = found.schema.child(kind) else {
        return Err(unknown_kind(kind, found.schema.child_names()));
    };
    if schema.attribute(attribute).is_none() {
        let help = suggestion(attribute, schema.attributes().map(|a| a.name), "it has none");
        return Err(Refusal {
            message: format!("`{kind}` has no attribute `{attribute}` in `default`"),
            help,
        });
    }
    let existing = elements.iter().find(|s| s.parent == found.index && s.schema.name == kind).copied();
    if let Some(entry) = existing.or_else(|| create_child(list, found, kind)) {
        set(list, entry.index, attribute, value);
    }
    Ok(())
}

/// The element of a kind with a name, or the only element of that kind. A missing settings element is created where it is
/// allowed.
fn find_element(
    list: &mut Vec<XmlElement>,
    elements: &[PatchElement],
    kind: &str,
    name: Option<&str>,
) -> Result<PatchElement, Refusal> {
    let refuse = |message: String, help: &str| Err(Refusal { message, help: help.to_string() });
    let named =
        |s: &PatchElement| list.get(s.index).and_then(|e| e.attribute("name")).map(|a| a.value.as_str());
    let of_kind: Vec<PatchElement> =
        listed(elements.iter().copied().filter(|s| !s.default && s.schema.name == kind));
    let names = of_kind.iter().filter_map(named);
    let found = match name {
        Some(name) => of_kind.iter().find(|s| named(s) == Some(name)).copied(),
        None => of_kind.first().copied().filter(|_| of_kind.len() == 1),
    };
    match (found, name) {
        (Some(found), _) => Ok(found),
        (None, None) if of_kind.is_empty() => match create_settings_element(list, kind, elements) {
            Some(made) => Ok(made),
            None => {
                let kinds =
                    elements.iter().map(|s| s.schema.name).filter(|k| !["mujoco", "default"].contains(k));
                Err(unknown_kind(kind, kinds))
            }
        },
        (None, Some(_)) if of_kind.is_empty() => {
            Err(unknown_kind(kind, elements.iter().filter(|s| named(s).is_some()).map(|s| s.schema.name)))
        }
        (None, Some(name)) => {
            let help = suggestion(name, names, "it has no named ones");
            refuse(format!("the model has no {kind} `{name}`"), &help)
        }
        (None, None) => {
            let help = format!("name one of them: {}", suggestion("", names, "give it a name"));
            refuse(format!("the model has {} elements `{kind}`", of_kind.len()), &help)
        }
    }
}

/// All elements below the root that the schema contains. Included elements belong to the parent of the `include`.
fn list_elements(list: &[XmlElement], root: usize) -> Vec<PatchElement> {
    let (mut all, mut open) =
        (Vec::new(), vec![PatchElement { index: root, parent: root, schema: &ROOT, default: false }]);
    while let Some(elements) = open.pop() {
        let Some(element) = list.get(elements.index) else { continue };
        if element.name != INCLUDE.name {
            all.push(elements);
        }
        for &child in element.children.iter().rev() {
            let Some(name) = list.get(child).map(|c| c.name.as_str()) else { continue };
            if name == INCLUDE.name {
                open.push(PatchElement { index: child, ..elements });
            } else if let Some(schema) = elements.schema.child(name) {
                let default = elements.default || name == "default";
                open.push(PatchElement { index: child, parent: elements.index, schema, default });
            }
        }
    }
    all
}

/// Creates a settings element that the text does not contain.
fn create_settings_element(
    list: &mut Vec<XmlElement>,
    kind: &str,
    elements: &[PatchElement],
) -> Option<PatchElement> {
    let (parent, name) = SETTINGS.iter().find(|(_, name)| *name == kind)?;
    let holder = elements.iter().find(|s| s.schema.name == *parent).copied();
    let holder = holder.or_else(|| create_settings_element(list, parent, elements))?;
    create_child(list, holder, name)
}

/// Adds an empty child to an element.
fn create_child(list: &mut Vec<XmlElement>, holder: PatchElement, name: &str) -> Option<PatchElement> {
    let (index, span) = (list.len(), list.get(holder.index)?.span.clone());
    list.push(XmlElement {
        name: name.to_string(),
        span,
        namespace: false,
        attributes: Vec::new(),
        children: Vec::new(),
    });
    list.get_mut(holder.index)?.children.push(index);
    Some(PatchElement {
        index,
        parent: holder.index,
        schema: holder.schema.child(name)?,
        default: holder.default,
    })
}

/// The element that contains the mass of a body: its `inertial`, or its only geom.
fn mass_of(
    list: &[XmlElement],
    body: PatchElement,
    elements: &[PatchElement],
    name: &str,
) -> Result<PatchElement, Refusal> {
    let parts = |kind: &str| -> Vec<PatchElement> {
        listed(elements.iter().copied().filter(|s| s.parent == body.index && s.schema.name == kind))
    };
    let (inertial, geoms) = (parts("inertial"), parts("geom"));
    match (inertial.as_slice(), geoms.as_slice()) {
        ([inertial], _) => Ok(*inertial),
        ([], [geom]) => Ok(*geom),
        _ => {
            let names =
                geoms.iter().filter_map(|s| list.get(s.index)?.attribute("name").map(|a| a.value.as_str()));
            let names: Vec<&str> = listed(names);
            Err(Refusal {
                message: format!("the mass of the body `{name}` is the sum of its {} geoms", geoms.len()),
                help: format!("change the mass of one of them: {}", names.join(", ")),
            })
        }
    }
}

fn set(list: &mut [XmlElement], index: usize, attribute: &str, value: &str) {
    let Some(element) = list.get_mut(index) else { return };
    let span = element.span.clone();
    element.attributes.retain(|a| a.name != attribute || a.namespace);
    element.attributes.push(XmlAttribute {
        name: attribute.to_string(),
        value: value.to_string(),
        name_span: span.clone(),
        value_span: span,
        exact: false,
        namespace: false,
    });
}

fn unknown_kind<'k>(kind: &str, kinds: impl Iterator<Item = &'k str>) -> Refusal {
    let mut kinds: Vec<&str> = listed(kinds);
    order::sort_by(&mut kinds, Ord::cmp);
    kinds.dedup();
    Refusal {
        message: format!("the model has no element `{kind}`"),
        help: suggestion(kind, kinds.into_iter(), "it has none that can be changed"),
    }
}

/// A suggestion with the most similar name, or the list of existing names.
fn suggestion<'n>(word: &str, names: impl Iterator<Item = &'n str>, none: &str) -> String {
    let names: Vec<&str> = listed(names.take(200));
    match nearest(word, names.iter().copied()) {
        Some(right) if !word.is_empty() => format!("did you mean `{right}`?"),
        _ if names.is_empty() => none.to_string(),
        _ => listed(names.iter().take(12).copied()).join(", "),
    }
}

#[cfg(test)]
mod tests {
    use crate::mjcf::{NoFiles, check_patched};
    use crate::model::Model;
    use crate::source::model_patch::Patch;

    const TEXT: &str = "<mujoco><default><geom friction='0.3'/></default><worldbody><geom name='floor' type='plane' size='1 1 1'/>\
        <body name='heavy ball' pos='0 0 1'><freejoint/><geom name='iron' size='.1' mass='1'/></body>\
        <body name='rod'><joint name='hinge'/><geom name='one' size='.1'/><geom name='two' size='.1'/></body></worldbody></mujoco>";

    fn patched(path: &str, value: &str) -> Result<Model, String> {
        let patch = Patch { path: path.into(), value: value.into() };
        let (checked, refusals) = check_patched(TEXT, &NoFiles, None, &[patch]);
        match (refusals.into_iter().next().flatten(), checked.model) {
            (Some(refusal), _) => Err(format!("{}; {}", refusal.message, refusal.help)),
            (None, model) => model.ok_or_else(|| checked.findings[0].message.clone()),
        }
    }

    #[test]
    fn changes_are_made_before_the_model_is_compiled() {
        let heavy = patched("body heavy ball mass", "5").unwrap();
        assert_eq!(heavy.body_mass[1], 5.0);
        assert!((heavy.body_inertia[3] - 0.4 * 5.0 * 0.01).abs() < 1e-15);
        assert_eq!(patched("option timestep", "0.01").unwrap().opt.timestep, 0.01);
        assert_eq!(
            patched("geom iron friction", "1 0.005 0.0001").unwrap().geom_friction[3..6],
            [1.0, 0.005, 0.0001]
        );
        assert_eq!(patched("flag gravity", "disable").unwrap().opt.disableflags.count_ones(), 1);
        // An angle in a patch has the unit of the text, like all angles of the text.
        let degrees = patched("joint hinge range", "-90 90").unwrap();
        assert!((degrees.jnt_range[3] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn elements_are_replaced() {
        let ball = patched("geom iron", "<geom type='box' size='.1 .2 .3' mass='2'/>").unwrap();
        assert_eq!((ball.ngeom, ball.body_mass[1]), (4, 2.0));
        assert_eq!(ball.geom_size[3..6], [0.1, 0.2, 0.3]);
        let slide = patched("joint hinge", "<joint type='slide' axis='1 0 0' damping='3'/>").unwrap();
        assert_eq!((slide.jnt_type[1], slide.dof_damping[6]), (2, 3.0));
        // A new element keeps the name of the old one, so that everything that names it still finds it.
        let text = "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody>\
            <actuator><motor name='drive' joint='hinge'/></actuator><sensor><actuatorfrc actuator='drive'/></sensor></mujoco>";
        let patch = Patch { path: "motor drive".into(), value: "<position joint='hinge' kp='40'/>".into() };
        let (checked, refusals) = check_patched(text, &NoFiles, None, &[patch]);
        assert_eq!(refusals, [None]);
        assert_eq!(checked.model.unwrap().actuator_gainprm[0], 40.0);
    }

    #[test]
    fn default_classes_are_changed() {
        let text = "<mujoco><default><default class='steel'><geom density='7800'/></default></default><worldbody>\
            <body><geom class='steel' size='.1'/></body><body><geom size='.1'/></body></worldbody></mujoco>";
        let mass = |path: &str| {
            let patch = Patch { path: path.into(), value: "500".into() };
            let (checked, refusals) = check_patched(text, &NoFiles, None, &[patch]);
            assert_eq!(refusals, [None], "{path}");
            let model = checked.model.unwrap();
            [model.body_mass[1], model.body_mass[2]]
        };
        let [steel, plain] = mass("option timestep");
        assert_eq!(mass("default steel geom density"), [steel * 500.0 / 7800.0, plain]);
        assert_eq!(mass("default geom density"), [steel, plain / 2.0]);
        assert_eq!(mass("default main geom density"), [steel, plain / 2.0]);
    }

    #[test]
    fn a_refused_change_is_reported_with_similar_names() {
        for (path, value, words) in [
            ("geom irn mass", "1", "no geom `irn`; did you mean `iron`?"),
            ("geom iron mas", "1", "no attribute `mas`; did you mean `mass`?"),
            ("goem iron mass", "1", "no element `goem`; did you mean `geom`?"),
            ("geom mass", "1", "4 elements `geom`; name one of them: floor"),
            ("body rod mass", "1", "its 2 geoms; change the mass of one of them: one, two"),
            ("geom iron name", "gold", "cannot be changed"),
            ("mass", "1", "not an attribute of an element"),
            ("geom iron mass", "heavy", "`mass` of geom"),
            ("geom irn", "<geom size='1'/>", "no geom `irn`; did you mean `iron`?"),
            ("geom iron", "<motor joint='hinge'/>", "`motor` cannot replace `geom`"),
            ("geom iron", "<geom", "is not XML"),
            ("body rod", "<body><include file='rod.xml'/></body>", "includes a file"),
            ("worldbody", "<geom size='1'/>", "cannot replace `worldbody`"),
            ("mujoco", "<geom size='1'/>", "`mujoco` cannot be replaced"),
            ("default steel geom friction", "1", "no default class `steel`; it has no default classes"),
            ("default geom fricton", "1", "no attribute `fricton` in `default`; did you mean `friction`?"),
            ("default gem friction", "1", "did you mean `geom`?"),
        ] {
            match patched(path, value) {
                Err(message) => assert!(message.contains(words), "{path}: {message}"),
                Ok(_) => panic!("{path} was changed"),
            }
        }
    }
}
