use crate::check::observations::{ObservedLab, column, constant};
use crate::spec::Readout;
use labspec_bind::element_owner;
use labspec_core::reflect::{FieldId, data, model, option};
use labspec_core::{Model, Obj, enable};
use labspec_expr::{Access, Effects};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A readout shows a number that cannot change.
pub const CONSTANT_READOUT: &Rule = &Rule {
    code: "constant-readout",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a readout shows a number that cannot change, whatever the state of the scene",
    why: "a student takes the number for a measurement. `data.energy` is 0 without the flag `energy`, and index 0 is the world body, which never moves and has no mass. A readout that is constant only in the present scene is not reported, and neither is one whose label names the world or the field",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "height (m)", "expr": "⟦data.xpos[2]⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "height (m)", "expr": "data.xpos[5]"}]}"#,
    ),
};

/// Fields whose elements of the world body never change.
const FIXED_FIELDS: [FieldId; 8] = [
    data::xpos,
    data::xquat,
    data::xmat,
    data::xipos,
    data::ximat,
    data::cvel,
    model::body_mass,
    model::body_inertia,
];

/// Words of labels that name what is constant.
const NAMES_OF_WORLD: [&str; 4] = ["world", "ground", "floor", "origin"];

/// Reports a readout that shows the same number in every run, and reads only what never changes. `c`: its column.
pub(crate) fn check_still_readout(
    observed: &ObservedLab<'_>,
    readout: &Readout,
    c: usize,
) -> Option<Finding> {
    let ready = observed.bench.ready;
    let bound = ready.programs.probes.get(c.checked_sub(1)?)?.bound.as_ref()?;
    let effects = bound.program.effects();
    if !reads_only_fields(effects) {
        return None;
    }
    let value = constant(column(observed.records, c))?.rounded(readout.digits());
    let (what, help) = if effects.reads.iter().all(|a| is(a, data::energy)) {
        let enabled = ready.model.opt.enableflags & enable::ENERGY != 0;
        let sets_flags =
            |e: &Effects| e.writes_everything || e.writes.iter().any(|a| is(a, option::enableflags));
        if enabled || ready.programs.bound().any(|b| sets_flags(b.program.effects())) {
            return None;
        }
        let help = "write `<option><flag energy=\"enable\"/></option>` in the model, or read `lib.energy()`";
        ("`data.energy` is 0 while the flag `energy` is off", help)
    } else {
        if !reads_fixed_elements(effects, &ready.model) || names_it(readout.label.as_str(), effects) {
            return None;
        }
        let help = "read the body that the label names, as `data.body('name').xpos[2]`";
        ("it belongs to the world body, which never moves and has no mass", help)
    };
    let message = format!("this readout is always {value}");
    Some(Finding::warning(CONSTANT_READOUT, readout.expr.span(), message).why(what).help(help))
}

/// Whether a program reads elements of the world body that never change, and nothing else.
pub(super) fn reads_fixed_elements(effects: &Effects, model: &Model) -> bool {
    let is_fixed = |a: &Access| {
        let of_world = |n| element_owner(model, a.field, a.first, n) == Some((Obj::Body, 0));
        FIXED_FIELDS.iter().any(|f| is(a, *f)) && a.count.is_some_and(of_world)
    };
    reads_only_fields(effects) && effects.reads.iter().all(is_fixed)
}

fn is(access: &Access, field: FieldId) -> bool {
    access.field.0 as usize == field.index()
}

/// Whether the value follows from elements of fields alone, and from at least one of them.
fn reads_only_fields(effects: &Effects) -> bool {
    let more = effects.reads_everything || effects.any_ctx || effects.calls_values || effects.aggregates;
    !more
        && effects.ctx_reads.is_empty()
        && effects.calls.is_empty()
        && effects.pure()
        && !effects.reads.is_empty()
}

/// Whether a label names the world or a field, so that the number is what it says.
fn names_it(label: &str, effects: &Effects) -> bool {
    let label = label.to_lowercase();
    let mut fields = effects.reads.iter().filter_map(|a| FieldId::new(a.field.0 as usize));
    NAMES_OF_WORLD.iter().any(|word| label.contains(word)) || fields.any(|f| label.contains(f.info().name))
}
