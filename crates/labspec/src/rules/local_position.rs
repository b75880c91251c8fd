use crate::bind::{Bound, Programs};
use labspec_core::reflect::FieldId;
use labspec_core::reflect::{data, model};
use labspec_core::{Model, Obj};
use labspec_expr::Access;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A display shows a position that the model stores, which never changes.
pub const LOCAL_POSITION: &Rule = &Rule {
    code: "local-position",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a display shows a position that never changes",
    why: "the model stores positions in the frame of a body, as they were written; where an object is during a run is in `data`. An object of the world does not move at all",
    bad: Example::Expression("⟦model.body('ball').pos[2]⟧"),
    good: Example::Expression("data.body('ball').xpos[2]"),
};

/// Positions in the model, and where they are in the world frame during a run.
const POSITIONS: [(FieldId, FieldId); 4] = [
    (model::site_pos, data::site_xpos),
    (model::geom_pos, data::geom_xpos),
    (model::body_pos, data::xpos),
    (model::cam_pos, data::cam_xpos),
];

pub(crate) fn check_displays(m: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    for bound in programs.probes.iter().filter_map(|probe| probe.bound.as_ref()) {
        let effects = bound.program.effects();
        let is_more = effects.reads_everything || effects.any_ctx || effects.calls_values;
        let [access] = effects.reads.as_slice() else { continue };
        if is_more || !effects.ctx_reads.is_empty() || is_written(programs, access) {
            continue;
        }
        findings.extend(check_display(m, bound, access));
    }
}

/// Whether a program of the lab writes the field.
fn is_written(programs: &Programs, access: &Access) -> bool {
    programs.bound().any(|bound| bound.program.own_writes().iter().any(|write| write.field == access.field))
}

fn check_display(m: &Model, bound: &Bound, access: &Access) -> Option<Finding> {
    let field = FieldId::new(access.field.0 as usize).filter(|_| access.count == Some(1))?;
    let text = bound.text.as_str();
    let (kind, object) = labspec_bind::element_owner(m, access.field, access.first, 1)?;
    let name = m.names.of_kind(kind).get(object).filter(|name| !name.is_empty());
    let found = |message: String| Finding::new(LOCAL_POSITION, bound.text.span(), message);
    if let Some((_, moving)) = POSITIONS.into_iter().find(|(stored, _)| *stored == field) {
        let named = text.replace("model.", "data.").replace(").pos[", ").xpos[");
        let meant = match named.contains(").xpos[") {
            true => named,
            false => {
                text.replace(&format!("model.{}", field.info().name), &format!("data.{}", moving.info().name))
            }
        };
        return Some(
            found("this position is in the frame of a body, and never changes".to_owned())
                .help(format!("write `{meant}`")),
        );
    }
    let body_of = match (kind, field) {
        (Obj::Geom, data::geom_xpos) => &m.geom_bodyid,
        (Obj::Site, data::site_xpos) => &m.site_bodyid,
        _ => return None,
    };
    // An author who writes the name knows the object.
    let is_fixed = body_of.get(object) == Some(&0) && !name.is_some_and(|name| text.contains(name.as_str()));
    let next = body_of.iter().position(|body| *body != 0)?;
    let index = access.first % 3 + 3 * next;
    is_fixed.then(|| {
        let whose = name.map_or(String::new(), |name| format!(" \"{name}\""));
        let noun = if kind == Obj::Geom { "geom" } else { "site" };
        let of_next = m.names.of_kind(kind).get(next).filter(|n| !n.is_empty());
        let of_next = of_next.map_or(format!("{noun} {next}"), |n| format!("{noun} \"{n}\""));
        found(format!(
            "this is the position of the {noun}{whose}, which belongs to the world and never moves"
        ))
        .help(format!("write `data.{}[{index}]` for the {of_next}", field.info().name))
    })
}
