use crate::bind::{Bound, Programs};
use crate::source::Text;
use crate::spec::Lab;
use labspec_bind::{describe_element, element_axis};
use labspec_core::Model;
use labspec_core::reflect::FieldId;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A label names a direction, but its expression reads a coordinate of another direction.
pub const LABEL_AXIS: &Rule = &Rule {
    code: "label-axis",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a label names a direction, but its expression reads a coordinate of another direction",
    why: "the coordinates of a body are x, y, z in this order, z up: with a wrong index, a student watches another motion than the label says. The rule reports expressions that read one coordinate",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[1] = 1", "readouts": [{"label": "⟦height (m)⟧", "expr": "data.qpos[1]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[1] = 1", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};

/// Words for the direction of gravity. The vocabulary is that of the languages in which lessons are written.
const VERTICAL: [&str; 11] = [
    "height",
    "altitude",
    "elevation",
    "vertical",
    "höhe",
    "vertikal",
    "vertikale",
    "hauteur",
    "verticale",
    "altura",
    "altezza",
];
const HORIZONTAL: [&str; 6] =
    ["horizontal", "horizontale", "waagrecht", "waagrechte", "orizzontale", "sideways"];
/// Words that may stand beside the letter of an axis.
const COORDINATE: [&str; 10] = [
    "above",
    "position",
    "coordinate",
    "velocity",
    "speed",
    "component",
    "of",
    "the",
    "koordinate",
    "geschwindigkeit",
];
/// The most words of a label that only names a direction and an object.
const MAX_WORDS: usize = 4;
/// The most labels that are checked.
const MAX_LABELS: usize = 400;
/// A direction is along an axis if its component is closer to 1.
const ALIGNED: f64 = 1e-6;

/// The indices of the axes.
const Y: usize = 1;
const Z: usize = 2;

/// The direction that a label names.
enum NamedDirection {
    Vertical(String),
    Horizontal(String),
    /// The index of the axis.
    Axis(usize),
}

pub(crate) fn check_axes(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let labels = || {
        let traces = lab.plots.iter().flat_map(|p| &p.traces).map(|t| &t.label);
        traces.chain(lab.readouts.iter().map(|r| &r.label)).take(MAX_LABELS)
    };
    let is_z =
        |label: &Text| matches!(named_direction(label, model), Some(NamedDirection::Axis(axis)) if axis == Z);
    let is_in_plane = !labels().any(is_z) && !uses_y(model, programs);
    let all = labels().zip(&programs.probes);
    findings.extend(
        all.filter_map(|(label, probe)| check_axis(label, probe.bound.as_ref()?, model, is_in_plane)),
    );
}

/// Whether a program of a lab may read or write a coordinate along y of a free body.
fn uses_y(model: &Model, programs: &Programs) -> bool {
    programs.bound().any(|bound| {
        let effects = bound.program.effects();
        effects.reads.iter().chain(&effects.writes).any(|access| {
            let Some(field) = FieldId::new(access.field.0 as usize) else { return false };
            let is_y = |i: usize| element_axis(model, field, i).is_some_and(|a| a.of_three && a.index == Y);
            // A free joint has its three coordinates among six elements in a row.
            let count = access.count.map_or(6, |count| count.min(6));
            (access.first..access.first.saturating_add(count)).any(is_y)
        })
    })
}

/// `is_in_plane`: the lab shows a motion in the plane of x and z, in which textbooks call the height y.
fn check_axis(label: &Text, bound: &Bound, model: &Model, is_in_plane: bool) -> Option<Finding> {
    let effects = bound.program.effects();
    if effects.reads_everything || effects.any_ctx || effects.calls_values || !effects.ctx_reads.is_empty() {
        return None;
    }
    let [read] = effects.reads.as_slice() else { return None };
    if read.count != Some(1) {
        return None;
    }
    let field = FieldId::new(read.field.0 as usize)?;
    let axis = element_axis(model, field, read.first)?;
    let up = vertical(model)?;
    let (named, meant) = match named_direction(label, model)? {
        NamedDirection::Vertical(word) if axis.index != up => (word, Some(up)),
        NamedDirection::Horizontal(word) if axis.index == up => (word, None),
        NamedDirection::Axis(Y) if is_in_plane && axis.index == up => return None,
        // Along a slide, `x` is often any displacement.
        NamedDirection::Axis(named_axis) if axis.of_three && axis.index != named_axis => {
            (letter(named_axis).to_owned(), Some(named_axis))
        }
        _ => return None,
    };
    let what = describe_element(model, field, read.first)?;
    let message =
        format!("the label names {named}, but the expression reads the {} coordinate", letter(axis.index));
    let help = match meant.filter(|_| axis.of_three) {
        Some(meant) => format!(
            "read the {} coordinate, `{}.{}[{}]`, or correct the label",
            letter(meant),
            if field.info().object == labspec_core::reflect::Object::Model { "model" } else { "data" },
            field.info().name,
            read.first + meant - axis.index
        ),
        None => "read a coordinate of that direction, or correct the label".to_owned(),
    };
    Some(
        Finding::new(LABEL_AXIS, label.span(), message)
            .help(help)
            .related(bound.text.span(), format!("this reads {what}")),
    )
}

fn letter(axis: usize) -> &'static str {
    ["x", "y", "z"].get(axis).copied().unwrap_or("z")
}

/// The axis along which gravity pulls; z if there is none. `None` if it pulls along no axis: a slope by tilted gravity.
fn vertical(model: &Model) -> Option<usize> {
    let g = model.opt.gravity;
    let length = g.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        return Some(2);
    }
    g.iter().position(|x| x.abs() > (1.0 - ALIGNED) * length)
}

/// The direction that a label names. `None` if it names none, or may say more than a direction and an object.
fn named_direction(label: &Text, model: &Model) -> Option<NamedDirection> {
    let words = super::label_names_another::words_of(label.as_str());
    if words.len() > MAX_WORDS {
        return None;
    }
    let of_model: Vec<Vec<String>> =
        super::label_names_another::names(model).map(super::label_names_another::split_words).collect();
    let belongs = |word: &String| {
        COORDINATE.contains(&word.as_str()) || of_model.iter().any(|name| name.contains(word))
    };
    let direction = |word: &String| {
        let letters = word.strip_prefix('v').filter(|rest| !rest.is_empty()).unwrap_or(word);
        match word.as_str() {
            w if VERTICAL.contains(&w) => Some(NamedDirection::Vertical(w.to_owned())),
            w if HORIZONTAL.contains(&w) => Some(NamedDirection::Horizontal(w.to_owned())),
            _ => ["x", "y", "z"].iter().position(|l| *l == letters).map(NamedDirection::Axis),
        }
    };
    let mut found = words.iter().enumerate().filter_map(|(i, w)| Some((i, direction(w)?)));
    let (Some((place, named)), None) = (found.next(), found.next()) else { return None };
    let others_belong = words.iter().enumerate().all(|(i, w)| i == place || belongs(w) || w == "v");
    others_belong.then_some(named)
}

#[cfg(test)]
mod tests {
    /// Whether a readout of a ball and of a cart on rails along x is reported.
    fn is_reported(option: &str, label: &str, expr: &str) -> bool {
        are_reported(option, &[(label, expr)])
    }

    fn are_reported(option: &str, readouts: &[(&str, &str)]) -> bool {
        let xml = format!(
            "<mujoco><option {option}/><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05'/></body>\
             <body name='cart' pos='1 0 1'><joint type='slide' axis='1 0 0'/><geom size='.05'/></body></worldbody></mujoco>"
        );
        let readouts: Vec<_> =
            readouts.iter().map(|(label, expr)| serde_json::json!({"label": label, "expr": expr})).collect();
        let lab = serde_json::json!({"xml": xml, "stopAt": 0.1, "readouts": readouts}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("lab.json", &lab);
        report.findings.iter().any(|f| f.code == "label-axis")
    }

    #[test]
    fn a_direction_is_that_of_the_coordinate() {
        for (label, expr) in [
            ("height (m)", "data.qpos[1]"),
            ("Höhe (m)", "data.qpos[0]"),
            ("height of the ball (m)", "data.body('ball').xpos[0]"),
            ("z (m)", "data.qpos[1]"),
            ("vx (m/s)", "data.qvel[2]"),
            ("horizontal position (m)", "data.qpos[2]"),
            ("height (m)", "data.qpos[7]"),
        ] {
            assert!(is_reported("", label, expr), "{label}: {expr}");
        }
        for (label, expr) in [
            ("height (m)", "data.qpos[2]"),
            ("height (m)", "data.qpos[2] - 0.05"),
            ("height above the floor when it lands (m)", "data.qpos[1]"),
            ("z of the ball (m)", "data.qpos[2]"),
            ("x (m)", "data.qpos[7]"),
            ("y (m)", "data.qpos[7]"),
            ("height (m)", "Math.hypot(data.qpos[0], data.qpos[1])"),
            ("vertical speed (m/s)", "data.qvel[2]"),
            ("height (rad)", "data.qvel[3]"),
        ] {
            assert!(!is_reported("", label, expr), "{label}: {expr}");
        }
        // In a vertical plane, y may be the height, but not where the lab uses the coordinate y or names another one z.
        assert!(!is_reported("", "y (m)", "data.qpos[2]"));
        for other in
            [("z (m)", "data.qpos[9]"), ("drift (m)", "data.qpos[1]"), ("drift (m/s)", "data.qvel[1]")]
        {
            assert!(are_reported("", &[("y (m)", "data.qpos[2]"), other]), "{other:?}");
        }
        // Up is against gravity; on a slope by tilted gravity, no axis is.
        assert!(!is_reported("gravity='0 -9.81 0'", "height (m)", "data.qpos[1]"));
        assert!(!is_reported("gravity='0 -4.9 -8.5'", "height (m)", "data.qpos[1]"));
    }
}
