use crate::bind::{Bound, Programs};
use crate::source::Text;
use crate::spec::Lab;
use labspec_core::reflect::{FieldId, Object, data};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A label names the kinetic or the potential energy, but its expression gives the other one.
pub const LABEL_ENERGY: &Rule = &Rule {
    code: "label-energy",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a label names one kind of energy, but its expression gives the other one",
    why: "a student sees the kinetic energy grow where the potential energy does. The rule reports expressions that read the other energy by its name, and formulas of positions or of velocities alone",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "⟦kinetic energy (J)⟧", "expr": "lib.energy().potential"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "kinetic energy (J)", "expr": "lib.energy().kinetic"}]}"#,
    ),
};

/// Words in the languages in which lessons are written.
const KINETIC: [&str; 7] =
    ["kinetic", "kinetische", "kinetischen", "cinétique", "cinética", "cinetica", "bewegungsenergie"];
const POTENTIAL: [&str; 8] = [
    "potential",
    "potentielle",
    "potentiellen",
    "potenzielle",
    "potentiel",
    "potencial",
    "potenziale",
    "lageenergie",
];
const ENERGY: [&str; 7] =
    ["energy", "energie", "énergie", "energía", "energia", "bewegungsenergie", "lageenergie"];
/// The most labels that are checked.
const MAX_LABELS: usize = 400;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Energy {
    Kinetic,
    Potential,
}

impl Energy {
    /// Whether a word of a label belongs to the name of an energy.
    pub(super) fn is_word(word: &str) -> bool {
        [&KINETIC[..], &POTENTIAL[..], &ENERGY[..]].iter().any(|list| list.contains(&word))
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Energy::Kinetic => "kinetic",
            Energy::Potential => "potential",
        }
    }
}

pub(crate) fn check_energies(lab: &Lab, programs: &Programs, findings: &mut Vec<Finding>) {
    let traces = lab.plots.iter().flat_map(|p| &p.traces).map(|t| &t.label);
    let labels = traces.chain(lab.readouts.iter().map(|r| &r.label));
    let all = labels.zip(&programs.probes).take(MAX_LABELS);
    findings.extend(all.filter_map(|(label, probe)| check_energy(label, probe.bound.as_ref()?)));
}

fn check_energy(label: &Text, bound: &Bound) -> Option<Finding> {
    let named = named_energy(label)?;
    let (given, what) = given_energy(bound)?;
    (named != given).then(|| {
        Finding::new(
            LABEL_ENERGY,
            label.span(),
            format!("the label names the {} energy, but the expression {what}", named.name()),
        )
        .help(format!(
            "read the {} energy, `lib.energy().{}`, or correct the label",
            named.name(),
            named.name()
        ))
        .related(bound.text.span(), format!("this is the {} energy", given.name()))
    })
}

/// The energy that a label names. `None`: none, or both.
pub(super) fn named_energy(label: &Text) -> Option<Energy> {
    let words = super::label_names_another::words_of(label.as_str());
    let has = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
    match (has(&KINETIC), has(&POTENTIAL)) {
        _ if !has(&ENERGY) => None,
        (true, false) => Some(Energy::Kinetic),
        (false, true) => Some(Energy::Potential),
        _ => None,
    }
}

/// The energy that an expression gives, and how. `None` if that is not certain.
fn given_energy(bound: &Bound) -> Option<(Energy, &'static str)> {
    let text = bound.text.as_str();
    let reads = |name: &str| {
        text.match_indices(name).any(|(at, _)| {
            !text[at + name.len()..].starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$')
        })
    };
    // One energy is the total less the other one.
    let is_sum = reads(".total") || text.contains(['+', '-']);
    match (reads(".kinetic"), reads(".potential")) {
        (true, _) | (_, true) if is_sum => return None,
        (true, false) => return Some((Energy::Kinetic, "reads the kinetic one")),
        (false, true) => return Some((Energy::Potential, "reads the potential one")),
        (true, true) => return None,
        (false, false) => {}
    }
    let effects = bound.program.effects();
    let is_open = effects.reads_everything || effects.any_ctx || effects.calls_values || effects.aggregates;
    if is_open || !effects.ctx_reads.is_empty() || !effects.calls.is_empty() {
        return None;
    }
    let fields: Vec<(FieldId, usize, Option<usize>)> = effects
        .reads
        .iter()
        .filter_map(|read| Some((FieldId::new(read.field.0 as usize)?, read.first, read.count)))
        .filter(|(field, ..)| field.info().object == Object::Data)
        .collect();
    if let [(data::energy, first, Some(1))] = fields[..] {
        return match first {
            0 => Some((Energy::Potential, "reads the potential one, `data.energy[0]`")),
            1 => Some((Energy::Kinetic, "reads the kinetic one, `data.energy[1]`")),
            _ => None,
        };
    }
    let all = |list: &[FieldId]| !fields.is_empty() && fields.iter().all(|(field, ..)| list.contains(field));
    match () {
        () if all(&[data::qvel, data::cvel]) => Some((Energy::Kinetic, "reads velocities and no position")),
        () if all(&POSITIONS) => Some((Energy::Potential, "reads positions and no velocity")),
        () => None,
    }
}

const POSITIONS: [FieldId; 6] =
    [data::qpos, data::xpos, data::xipos, data::geom_xpos, data::site_xpos, data::subtree_com];

#[cfg(test)]
mod tests {
    #[test]
    fn the_other_energy_is_reported() {
        let reported = |label: &str, expr: &str| {
            let xml = "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05' mass='1'/></body></worldbody></mujoco>";
            let lab =
                serde_json::json!({"xml": xml, "stopAt": 0.1, "readouts": [{"label": label, "expr": expr}]})
                    .to_string();
            let report = crate::Checker::new(|_: &str| None::<String>).check("lab.json", &lab);
            report.findings.iter().any(|f| f.code == "label-energy")
        };
        for (label, expr) in [
            ("kinetic energy (J)", "lib.energy().potential"),
            ("potentielle Energie (J)", "lib.energy().kinetic"),
            ("kinetic energy of the ball (J)", "data.energy[0]"),
            ("potential energy (J)", "0.5 * model.body_mass[1] * data.qvel[2] ** 2"),
            ("kinetic energy (J)", "model.body_mass[1] * 9.81 * data.qpos[2]"),
        ] {
            assert!(reported(label, expr), "{label}: {expr}");
        }
        for (label, expr) in [
            ("kinetic energy (J)", "lib.energy().kinetic"),
            ("potential energy (J)", "lib.energy().total - lib.energy().kinetic"),
            ("potential energy (J)", "4.2 - lib.energy().kinetic"),
            ("kinetic and potential energy (J)", "lib.energy().potential"),
            ("energy (J)", "lib.energy().potential"),
            ("kinetic friction (N)", "data.qpos[2]"),
            ("potential energy (J)", "model.body_mass[1] * 9.81 * data.qpos[2]"),
            ("kinetic energy (J)", "0.5 * model.body_mass[1] * data.qvel[2] ** 2"),
        ] {
            assert!(!reported(label, expr), "{label}: {expr}");
        }
    }
}
