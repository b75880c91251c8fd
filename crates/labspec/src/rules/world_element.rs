use super::constant_readout::reads_fixed_elements;
use crate::bind::{Bound, Programs};
use crate::printable::counted;
use labspec_core::reflect::FieldId;
use labspec_core::reflect::{Object, data, model};
use labspec_core::{Model, Obj};
use labspec_expr::Access;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A program uses an element of the world, which never moves.
pub const WORLD_ELEMENT: &Rule = &Rule {
    code: "world-element",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a program uses an element of the world, which never moves",
    why: "body 0 is the world: its mass is 0, and a force on it moves nothing. The first body of a model has the index 1, and its elements start at the width of a row: 6 for `xfrc_applied`, 3 for positions",
    bad: Example::Statements("⟦data.xfrc_applied[2] = 20⟧"),
    good: Example::Statements("data.xfrc_applied[8] = 20"),
};

/// Fields with a row for each body, in which the row of the world has no use.
fn is_of_bodies(field: FieldId) -> bool {
    let fields = [
        model::body_mass,
        model::body_inertia,
        model::body_pos,
        model::body_quat,
        model::body_ipos,
        data::xfrc_applied,
        data::xpos,
        data::xipos,
        data::xquat,
        data::cvel,
    ];
    fields.contains(&field)
}

pub(crate) fn check_elements(model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    if model.nbody < 2 {
        return;
    }
    for bound in programs.bound() {
        let effects = bound.program.effects();
        // A display that reads nothing else is constant, and reported as that.
        if reads_fixed_elements(effects, model) {
            continue;
        }
        let writes = bound.program.own_writes();
        let used = effects.reads.iter().chain(&writes).find_map(|access| world_element(access, model));
        if let Some((field, index)) = used
            && !named_on_purpose(bound)
        {
            findings.push(report(bound, model, field, index));
        }
    }
}

/// A single element of the world.
fn world_element(access: &Access, m: &Model) -> Option<(FieldId, usize)> {
    let field = FieldId::new(access.field.0 as usize).filter(|f| is_of_bodies(*f))?;
    let is_single = access.count == Some(1);
    let (kind, body) = labspec_bind::element_owner(m, access.field, access.first, 1)?;
    (is_single && kind == Obj::Body && body == 0).then_some((field, access.first))
}

/// Whether the text names the world.
fn named_on_purpose(bound: &Bound) -> bool {
    ["'world'", "\"world\"", "`world`"].iter().any(|name| bound.text.as_str().contains(name))
}

fn report(bound: &Bound, m: &Model, field: FieldId, index: usize) -> Finding {
    let name = field.info().name;
    let holder = if field.info().object == Object::Model { "model" } else { "data" };
    let width = match labspec_core::reflect::shape(m, field).get(1) {
        Some(Some(width)) => *width,
        _ => 1,
    };
    // The part of the text that reads or writes it.
    let text = bound.text.as_str();
    let path = format!("{holder}.{name}[{index}]");
    let stored = crate::check::assignments::assignments(&bound.text).into_iter().find(|a| a.target == path);
    let span = match (stored, text.find(&path)) {
        (Some(stored), _) => bound.text.span_of(stored.span.into()),
        (None, Some(at)) => bound.text.span_of(at..at + path.len()),
        (None, None) => bound.text.span(),
    };
    let first = m.names.of_kind(Obj::Body).get(1).filter(|n| !n.is_empty());
    let whose = first.map_or("body 1".to_owned(), |n| format!("body \"{n}\""));
    Finding::new(WORLD_ELEMENT, span, format!("`{path}` belongs to the world, which is body 0")).help(
        format!(
            "write `{holder}.{name}[{}]` for {whose}; each body has {}",
            index + width,
            counted(width, "element")
        ),
    )
}
