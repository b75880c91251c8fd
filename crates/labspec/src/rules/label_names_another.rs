use crate::bind::{Bound, ControlProgram, Programs};
use crate::source::Text;
use crate::spec::{Lab, Trace};
use labspec_bind::element_owner;
use labspec_core::reflect::{self, FieldId, Object};
use labspec_core::{Model, Obj};

use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::collections::BTreeSet;

/// A label names one object of the model, but its expression reads another.
pub const LABEL_NAMES_ANOTHER: &Rule = &Rule {
    code: "label-names-another",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a label names one object of the model, but its expression reads another",
    why: "exchanged labels or a copied index show a student the value of the wrong body. The rule reports a label that is just the name and a unit, or that differs from another label only in the name",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "⟦left (m)⟧", "expr": "data.qpos[1]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "left (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// The kinds of named objects, and the words for them in labels.
const KINDS: [(Obj, &str); 6] = [
    (Obj::Body, "body"),
    (Obj::Joint, "joint"),
    (Obj::Geom, "geom"),
    (Obj::Site, "site"),
    (Obj::Actuator, "actuator"),
    (Obj::Sensor, "sensor"),
];

/// The maximum numbers of names and labels that are compared.
const MAX_NAMES: usize = 400;

/// A name of the model.
struct LabelledObject {
    kind: Obj,
    noun: &'static str,
    index: usize,
    name: String,
    words: Vec<String>,
    body: usize,
}

/// A label, and the objects that its expression reads.
struct LabelledExpression<'l> {
    label: &'l Text,
    bound: &'l Bound,
    /// The names in the label. If one contains another, only the longer one.
    names: Vec<usize>,
    /// The words of the label without its only name.
    rest: Vec<String>,
    /// The objects that the expression reads, if all of them are known.
    reads: Vec<(Obj, usize)>,
    /// The bodies to which these objects belong.
    bodies: BTreeSet<usize>,
}

/// All names of bodies, joints, geoms, sites, actuators and sensors.
pub(super) fn names(model: &Model) -> impl Iterator<Item = &str> {
    KINDS
        .iter()
        .flat_map(|(kind, _)| model.names.of_kind(*kind))
        .map(String::as_str)
        .filter(|n| !n.is_empty())
}

pub(crate) fn check_names(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let all = elements(model);
    let traces = lab.plots.iter().flat_map(|p| &p.traces).map(|t| &t.label);
    let labels = traces.chain(lab.readouts.iter().map(|r| &r.label));
    let displays: Vec<LabelledExpression<'_>> = labels
        .zip(&programs.probes)
        .take(MAX_NAMES)
        .filter_map(|(label, probe)| displayed(label, probe.bound.as_ref()?, model, &all))
        .collect();
    for trace in lab.plots.iter().flat_map(|p| &p.traces).zip(&programs.probes).take(MAX_NAMES) {
        findings.extend(a_number(trace.0, trace.1.bound.as_ref(), &all));
    }
    let readouts =
        lab.readouts.iter().map(|r| &r.label).zip(programs.probes.iter().skip(lab.traces().count()));
    findings.extend(
        readouts.take(MAX_NAMES).filter_map(|(label, probe)| another_size(label, probe.bound.as_ref()?)),
    );
    for (control, (_, program)) in lab.controls.iter().zip(&programs.controls).take(MAX_NAMES) {
        let bound = match program {
            ControlProgram::Change(_, action) => action.run.as_ref(),
            ControlProgram::Press(run) => run.as_ref(),
        };
        findings.extend(bound.and_then(|bound| quotes_another(&control.label, bound, model)));
    }
    exchanged_controls(lab, model, programs, findings);
    for one in &displays {
        let ([name], Some(&body)) = (one.names.as_slice(), one.bodies.first()) else { continue };
        let Some(named) = all.get(*name).filter(|n| n.body != body && one.bodies.len() == 1) else {
            continue;
        };
        if !(is_only_named_object(one, named)
            || beside(one, named, body, &displays, &all)
            || is_in_name_position(one, named))
        {
            continue;
        }
        let reads = one
            .reads
            .iter()
            .filter_map(|(kind, index)| all.iter().find(|n| n.kind == *kind && n.index == *index));
        let Some(other) = reads.into_iter().next() else { continue };
        findings.push(
            Finding::new(
                LABEL_NAMES_ANOTHER,
                one.label.span(),
                format!(
                    "the label names the {} \"{}\", but the expression reads the {} \"{}\"",
                    named.noun, named.name, other.noun, other.name
                ),
            )
            .help("read the object that the label names, or correct the label; two labels may be exchanged")
            .related(one.bound.text.span(), format!("this belongs to \"{}\"", other.name)),
        );
    }
}

/// Whether a label names a quantity and then, after a comma, a joint, while the expression reads another joint: `force, shoulder
/// (N)`.
fn is_in_name_position(one: &LabelledExpression<'_>, named: &LabelledObject) -> bool {
    let last = one.label.as_str().rsplit_once(", ").map(|(_, last)| words_of(last));
    let joint = named.kind == Obj::Joint && one.reads.iter().all(|(kind, _)| *kind == Obj::Joint);
    joint && last.is_some_and(|words| words == named.words)
}

/// The sizes of a model that labels name.
const SIZES: [&str; 9] = ["nq", "nv", "nu", "na", "nbody", "njnt", "ngeom", "nsite", "nkey"];

/// Reports a label that names one size while its expression reads another.
fn another_size(label: &Text, bound: &Bound) -> Option<Finding> {
    let named = label.as_str().trim();
    let read = bound.text.value.trim().strip_prefix("model.")?;
    let both = SIZES.contains(&named) && SIZES.contains(&read) && named != read;
    both.then(|| {
        let message = format!("the label names `{named}`, but the expression reads `{read}`");
        Finding::new(LABEL_NAMES_ANOTHER, label.span(), message)
            .help("read the field that the label names; two labels may be exchanged")
            .related(bound.text.span(), format!("this is `{read}`"))
    })
}

/// Reports a label of a control that quotes an element, such as `ctrl[0]`, while the statements write another element of the same
/// field.
fn quotes_another(label: &Text, bound: &Bound, model: &Model) -> Option<Finding> {
    let text = label.as_str();
    let open = text.find('[')?;
    let name = text.get(..open)?.rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
    let inside = text.get(open + 1..)?.split(']').next()?;
    let (first, end): (usize, usize) = match inside.split_once(':') {
        Some((a, b)) => (a.trim().parse().ok()?, b.trim().parse().ok()?),
        None => inside.trim().parse().map(|n: usize| (n, n + 1)).ok()?,
    };
    let field = [Object::Data, Object::Model].into_iter().find_map(|o| reflect::field(o, name))?;
    let effects = bound.program.effects();
    if effects.writes_everything || effects.calls_values || model.nq == 0 {
        return None;
    }
    let written: Vec<_> =
        bound.program.own_writes().into_iter().filter(|w| w.field.0 as usize == field.index()).collect();
    let outside = |i: usize| !(first..end).contains(&i);
    // The elements that are written one by one: exactly those that the label names.
    let all: Option<Vec<usize>> = written.iter().map(|w| (w.count == Some(1)).then_some(w.first)).collect();
    let all = all.filter(|all| !all.is_empty())?;
    let other = all.iter().find(|i| outside(**i)).filter(|_| all.iter().all(|i| outside(*i)))?;
    let message = format!("the label names `{name}[{inside}]`, but the control writes `{name}[{other}]`");
    Some(
        Finding::new(LABEL_NAMES_ANOTHER, label.span(), message)
            .help("write the element that the label names, or correct the label")
            .related(bound.text.span(), "the control writes this"),
    )
}

/// The most controls that are compared in pairs.
const MAX_CONTROLS: usize = 60;

/// A control that sets elements of the model that belong to one body.
struct SettingControl<'l> {
    label: &'l Text,
    bound: &'l Bound,
    words: Vec<String>,
    body: usize,
}

/// Reports two controls whose labels differ in one name, each of which sets the model's elements of the body that the other one names.
fn exchanged_controls(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let bodies = model.names.of_kind(Obj::Body);
    let controls: Vec<SettingControl<'_>> = lab
        .controls
        .iter()
        .zip(&programs.controls)
        .take(MAX_CONTROLS)
        .filter_map(|(control, (_, program))| {
            let ControlProgram::Change(_, action) = program else { return None };
            let bound = action.run.as_ref()?;
            let body = body_set_by(bound, model)?;
            Some(SettingControl {
                label: &control.label,
                bound,
                words: words_of(control.label.as_str()),
                body,
            })
        })
        .collect();
    let named = |word: &str| bodies.iter().position(|name| split_words(name) == [word]);
    for (i, one) in controls.iter().enumerate() {
        for other in controls.iter().skip(i + 1).filter(|other| other.words.len() == one.words.len()) {
            let mut different = one.words.iter().zip(&other.words).filter(|(a, b)| a != b);
            let (Some((a, b)), None) = (different.next(), different.next()) else { continue };
            if named(a) != Some(other.body) || named(b) != Some(one.body) {
                continue;
            }
            let name = |body: usize| bodies.get(body).map_or("", String::as_str);
            let message = format!(
                "the label names the body \"{}\", but the control sets the body \"{}\"",
                name(other.body),
                name(one.body)
            );
            findings.push(
                Finding::new(LABEL_NAMES_ANOTHER, one.label.span(), message)
                    .help("set the body that the label names; this control and the other one are exchanged")
                    .related(one.bound.text.span(), format!("this belongs to \"{}\"", name(one.body)))
                    .related(other.label.span(), "the other control"),
            );
        }
    }
}

/// The only body whose elements of the model a program sets; `None` if it sets anything else.
fn body_set_by(bound: &Bound, model: &Model) -> Option<usize> {
    let effects = bound.program.effects();
    if effects.writes_everything || effects.any_ctx || effects.calls_values || !effects.ctx_writes.is_empty()
    {
        return None;
    }
    let mut all = bound.program.own_writes().into_iter().map(|write| {
        FieldId::new(write.field.0 as usize).filter(|f| f.info().object == Object::Model)?;
        let (kind, index) = element_owner(model, write.field, write.first, write.count?)?;
        body_of(model, kind, index)
    });
    let first = all.next()??;
    all.all(|body| body == Some(first)).then_some(first)
}

/// Reports a trace that has the name of an object of the model, but is a constant.
fn a_number(trace: &Trace, bound: Option<&Bound>, all: &[LabelledObject]) -> Option<Finding> {
    let bound = bound.filter(|b| b.program.effects().constant())?;
    let words = words_of(trace.label.as_str());
    let named = all.iter().find(|n| n.words == words)?;
    let message =
        format!("the label names the {} \"{}\", but the expression reads nothing", named.noun, named.name);
    Some(
        Finding::new(LABEL_NAMES_ANOTHER, trace.label.span(), message)
            .help("read the object that the label names; use `refLines` for an intended constant line")
            .related(bound.text.span(), "this is a constant"),
    )
}

/// The words of a label without its unit.
pub(super) fn words_of(label: &str) -> Vec<String> {
    let end = crate::bind::of_label(label).and_then(|(unit, _)| label.rfind(unit));
    split_words(end.and_then(|boundary| label.get(..boundary)).unwrap_or(label))
}

/// Whether the label consists only of the name of an object that has the quantity that the expression reads.
fn is_only_named_object(one: &LabelledExpression<'_>, named: &LabelledObject) -> bool {
    let same_kind = |kind: Obj| kind == named.kind || named.kind == Obj::Body && kind == Obj::Joint;
    one.rest.is_empty() && one.reads.iter().all(|(kind, _)| same_kind(*kind))
}

/// Whether another label differs only in its name, and names what this one reads. If that other label reads a third object, the
/// names may have another meaning.
fn beside(
    one: &LabelledExpression<'_>,
    named: &LabelledObject,
    body: usize,
    displayed: &[LabelledExpression<'_>],
    all: &[LabelledObject],
) -> bool {
    displayed.iter().any(|other| {
        let [name] = other.names.as_slice() else { return false };
        let Some(its) = all.get(*name) else { return false };
        let reads = other.bodies.len() == 1 && other.bodies.iter().all(|b| *b == body || *b == named.body);
        let alike = other.rest == one.rest && its.kind == named.kind;
        its.body == body && reads && alike
    })
}

/// A label with the objects that it names and reads. `None` if the owner of a read field is not known.
fn displayed<'l>(
    label: &'l Text,
    bound: &'l Bound,
    model: &Model,
    all: &[LabelledObject],
) -> Option<LabelledExpression<'l>> {
    let effects = bound.program.effects();
    if effects.reads_everything || effects.any_ctx || effects.calls_values || !effects.ctx_reads.is_empty() {
        return None;
    }
    let words = words_of(label.as_str());
    let mut reads = Vec::new();
    for access in &effects.reads {
        let owner = element_owner(model, access.field, access.first, access.count?);
        match owner {
            Some((kind, index)) => reads.push((kind, index)),
            // Time and options have no owner.
            None if access.count == Some(1) => {}
            None => return None,
        }
    }
    let bodies = reads.iter().map(|(kind, index)| body_of(model, *kind, *index)).collect::<Option<_>>()?;
    // If several objects have the same name, the first one of the kind that is read is used.
    let mut names: Vec<(usize, usize, usize)> = Vec::new();
    for (i, named) in all.iter().enumerate() {
        let Some(start) = words.windows(named.words.len()).position(|w| w == named.words) else { continue };
        let to = start + named.words.len();
        let within = |n: &(usize, usize, usize)| n.1 <= start && to <= n.2;
        let same_body = |n: &(usize, usize, usize)| all.get(n.0).is_some_and(|o| o.body == named.body);
        let covered = names.iter().any(|n| within(n) && (n.1, n.2) != (start, to));
        match names.iter_mut().find(|n| n.1 == start && n.2 == to && same_body(n)) {
            Some(counted) if reads.iter().any(|(kind, _)| *kind == named.kind) => counted.0 = i,
            Some(_) => {}
            None if covered => {}
            None => {
                names.retain(|n| !(start <= n.1 && n.2 <= to) || (n.1, n.2) == (start, to));
                names.push((i, start, to));
            }
        }
    }
    let mut rest = words.clone();
    if let [(_, from, to)] = names.as_slice() {
        rest.drain(*from..*to);
    }
    Some(LabelledExpression {
        label,
        bound,
        names: names.into_iter().map(|n| n.0).collect(),
        rest,
        reads,
        bodies,
    })
}

/// The words of a label or a name, in lower case.
pub(super) fn split_words(text: &str) -> Vec<String> {
    let parts = text.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty());
    parts.map(str::to_lowercase).collect()
}

/// All named elements that belong to a body other than the world. Names of one letter are excluded, because they do not occur in
/// labels.
fn elements(model: &Model) -> Vec<LabelledObject> {
    let mut all = Vec::new();
    for (kind, noun) in KINDS {
        for (index, name) in model
            .names
            .of_kind(kind)
            .iter()
            .enumerate()
            .filter(|(_, n)| n.chars().count() > 1)
            .take(MAX_NAMES)
        {
            let body = body_of(model, kind, index).filter(|b| *b != 0);
            // A namespace precedes the slash.
            let short_name = name.rsplit('/').next().unwrap_or(name);
            if let (Some(body), false) = (body, split_words(short_name).is_empty()) {
                all.push(LabelledObject {
                    kind,
                    noun,
                    index,
                    name: name.clone(),
                    words: split_words(short_name),
                    body,
                });
            }
        }
    }
    all
}

/// The body to which an object belongs.
fn body_of(model: &Model, kind: Obj, index: usize) -> Option<usize> {
    let id_at = |list: &[i32], i: usize| list.get(i).and_then(|b| usize::try_from(*b).ok());
    match kind {
        Obj::Body => Some(index),
        Obj::Joint => id_at(&model.jnt_bodyid, index),
        Obj::Geom => id_at(&model.geom_bodyid, index),
        Obj::Site => id_at(&model.site_bodyid, index),
        Obj::Actuator => match *model.actuator_trntype.get(index)? {
            labspec_core::trntype::JOINT | labspec_core::trntype::JOINTINPARENT => {
                id_at(&model.jnt_bodyid, id_at(&model.actuator_trnid, 2 * index)?)
            }
            _ => None,
        },
        Obj::Sensor => {
            let kinds = [Obj::Body, Obj::XBody, Obj::Joint, Obj::Geom, Obj::Site, Obj::Actuator];
            let kind = kinds.into_iter().find(|k| model.sensor_objtype.get(index) == Some(&(*k as i32)))?;
            let kind = if kind == Obj::XBody { Obj::Body } else { kind };
            body_of(model, kind, id_at(&model.sensor_objid, index)?)
        }
        _ => None,
    }
}
