use super::label_energy::{Energy, named_energy};
use super::label_names_another::{names, words_of};
use crate::bind::of_label;
use crate::check::observations::ObservedLab;
use crate::run::{self, Play, Session, Start};
use crate::source::Text;
use labspec_bind::units::parse;
use labspec_core::{AccessSet, Model, Plan, mechanical_energy};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::ControlFlow;

/// What is labelled as an energy is a multiple of it.
pub const ENERGY_VALUE: &Rule = &Rule {
    code: "energy-value",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a value labelled as kinetic or potential energy differs from that energy by the same factor in every sample of a run",
    why: "a factor is missing, such as ½, or a sign, or the mass or the gravity is that of another scene. The rule compares the displayed values with the energies of the engine, in scenes with one moving object",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05' mass='2'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "⟦kinetic energy (J)⟧", "expr": "model.body_mass[1] * data.qvel[2] ** 2"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05' mass='2'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "kinetic energy (J)", "expr": "0.5 * model.body_mass[1] * data.qvel[2] ** 2"}]}"#,
    ),
};

/// Number of samples of a run.
const SAMPLES: usize = 40;
/// Fewest samples that are compared.
const FEWEST: usize = 8;
/// A factor is another one if it differs by more than this part from 1, and if it is the same in all samples up to this part of the range.
const OTHER: f64 = 0.02;
const SAME: f64 = 1e-4;
/// Words of a label beside those for the energy and the names of the model.
const PLAIN_WORDS: [&str; 14] =
    ["of", "the", "a", "an", "total", "der", "die", "das", "des", "gesamte", "de", "la", "du", "del"];

/// The values of a label, and of the energy that it names.
struct Labelled<'l> {
    label: &'l Text,
    energy: Energy,
    /// The index of its program among the displayed ones.
    probe: usize,
    /// The unit of the label, in J.
    unit: f64,
    samples: Vec<(f64, f64)>,
}

/// Reports labels of energies whose values are a multiple of the energy of the engine.
pub(crate) fn check_energies(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let mut labels = labelled(ready.lab, &ready.model);
    if !moves_as_one(&ready.model) {
        return;
    }
    // The energy of a named part is that of the scene only if the scene has one part.
    if bodies_with_mass(&ready.model) > 1 || geoms_of_moving_bodies(&ready.model) > 1 {
        labels.retain(|label| !names_part(label.label.as_str()));
    }
    if labels.is_empty() {
        return;
    }
    let Some((steps, _)) = observed.bench.steps(observed.length) else { return };
    let plan = Some(Plan::new(&ready.model, &AccessSet::ANY));
    let start = Start { plan, budget: observed.bench.budget(), ..Start::of_lab(ready.lab) };
    let mut session = Session::start(&ready.programs, &ready.model, start);
    let every = (steps / SAMPLES).max(1);
    run::play(&mut session, &Play::steps(steps), |session, step| {
        if step % every == 0 {
            sample(session, &mut labels);
        }
        ControlFlow::Continue(())
    });
    observed.bench.left = observed.bench.left.saturating_sub(session.spent());
    findings.extend(labels.iter().filter_map(compared));
}

/// The labels that name the kinetic or the potential energy, and nothing else.
fn labelled<'l>(lab: &'l crate::spec::Lab, model: &Model) -> Vec<Labelled<'l>> {
    let traces = lab.plots.iter().flat_map(|plot| &plot.traces).map(|trace| &trace.label);
    let labels = traces.chain(lab.readouts.iter().map(|readout| &readout.label));
    let joule = parse("J");
    let one = |(probe, label): (usize, &'l Text)| {
        let energy = named_energy(label)?;
        let unit = match of_label(label.as_str()) {
            Some((_, unit)) => {
                joule.filter(|joule| joule.agrees(&unit)).map(|joule| joule.factor / unit.factor)?
            }
            None => 1.0,
        };
        let is_plain = words_of(label.as_str()).iter().all(|word| {
            Energy::is_word(word) || PLAIN_WORDS.contains(&word.as_str()) || is_name(model, word)
        });
        is_plain.then_some(Labelled { label, energy, probe, unit, samples: Vec::new() })
    };
    labels.enumerate().filter_map(one).collect()
}

/// Whether a word is the name of an object of the model.
fn is_name(model: &Model, word: &str) -> bool {
    names(model).any(|name| name.to_lowercase() == word)
}

/// Whether all joints belong to one body of the world, with what hangs on it.
fn moves_as_one(model: &Model) -> bool {
    let moved = (0..model.nbody).filter(|body| model.body_dofnum[*body] > 0);
    let mut roots: Vec<_> = moved.map(|body| model.body_rootid[body]).collect();
    roots.dedup();
    roots.len() == 1
}

fn bodies_with_mass(model: &Model) -> usize {
    model.body_mass.iter().skip(1).filter(|mass| **mass > 0.0).count()
}

fn geoms_of_moving_bodies(model: &Model) -> usize {
    model.geom_bodyid.iter().filter(|body| **body > 0).count()
}

/// Whether a label has more than the name of the energy.
fn names_part(label: &str) -> bool {
    !words_of(label).iter().all(|word| Energy::is_word(word) || word == "total")
}

/// Appends the values of the labels at the current state.
fn sample(session: &mut Session<'_>, labels: &mut [Labelled<'_>]) {
    session.refresh();
    let cells = session.sample();
    let world = &mut session.world;
    let Ok(Some(energy)) = mechanical_energy(&world.model, &mut world.data) else { return };
    for label in labels {
        let Some(cell) = cells.get(1 + label.probe) else { continue };
        let of_engine = match label.energy {
            Energy::Kinetic => energy.kinetic,
            Energy::Potential => energy.gravity + energy.elastic,
        };
        label.samples.push((label.unit * cell.number(), of_engine));
    }
}

/// The finding about a label whose values are another multiple of the energy. A potential energy may have any zero.
fn compared(one: &Labelled<'_>) -> Option<Finding> {
    let samples = &one.samples;
    if samples.len() < FEWEST || samples.iter().any(|(y, e)| !(y.is_finite() && e.is_finite())) {
        return None;
    }
    let n = samples.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| samples.iter().map(of).sum::<f64>() / n;
    let (y0, e0) = match one.energy {
        Energy::Kinetic => (0.0, 0.0),
        Energy::Potential => (mean(|s| s.0), mean(|s| s.1)),
    };
    let sum = |of: &dyn Fn(f64, f64) -> f64| samples.iter().map(|(y, e)| of(y - y0, e - e0)).sum::<f64>();
    let factor = sum(&|y, e| y * e) / sum(&|_, e| e * e);
    let range = samples.iter().map(|(y, _)| (y - y0).abs()).fold(0.0, f64::max);
    let largest = samples.iter().map(|(_, e)| (e - e0).abs()).fold(0.0, f64::max);
    let is_multiple = samples.iter().all(|(y, e)| (y - y0 - factor * (e - e0)).abs() <= SAME * range);
    // Another rule reports a metric prefix that the label has and the expression not.
    let power = factor.abs().log10();
    let is_prefix = (power - power.round()).abs() < 1e-6 && power.round() != 0.0;
    let is_other =
        (factor - 1.0).abs() > OTHER && !is_prefix && factor.is_finite() && range > 1e-9 && largest > 1e-9;
    if !is_multiple || !is_other {
        return None;
    }
    // From the start: a potential energy may have any zero.
    let (y1, e1) = match one.energy {
        Energy::Kinetic => (0.0, 0.0),
        Energy::Potential => samples.first().copied()?,
    };
    let changes = samples.iter().map(|(y, e)| (y - y1, e - e1));
    let (y, e) = changes.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let name = one.energy.name();
    let factor = crate::verify::significant(factor);
    let [y, e] = [y, e].map(crate::verify::significant);
    Some(
        Finding::new(
            ENERGY_VALUE,
            one.label.span(),
            format!("the values under this label are {factor} times the {name} energy of the scene"),
        )
        .why(match one.energy {
            Energy::Kinetic => format!("in a run of the lab, it is {y} J where the engine has {e} J, and the factor is the same in {} samples", samples.len()),
            Energy::Potential => format!("in a run of the lab, it changes by {y} J where that of the engine changes by {e} J, and the factor is the same in {} samples", samples.len()),
        })
        .help(format!("correct the expression, or read `lib.energy().{name}`")),
    )
}

#[cfg(test)]
mod tests {
    /// The findings about a label, in a fall with gravity g.
    fn found(label: &str, expr: &str) -> Vec<String> {
        let xml = "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05' mass='2'/></body></worldbody></mujoco>";
        let lab =
            serde_json::json!({"xml": xml, "stopAt": 0.4, "readouts": [{"label": label, "expr": expr}]})
                .to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("lab.json", &lab);
        report.findings.iter().filter(|f| f.code == "energy-value").map(|f| f.message.clone()).collect()
    }

    #[test]
    fn a_multiple_of_an_energy_is_not_the_energy() {
        for (label, expr, factor) in [
            ("kinetic energy (J)", "model.body_mass[1] * data.qvel[2] ** 2", "2"),
            ("kinetic energy of the ball", "0.5 * data.qvel[2] ** 2", "0.5"),
            ("kinetische Energie (mJ)", "1000 * model.body_mass[1] * data.qvel[2] ** 2", "2"),
            ("potential energy (J)", "-model.body_mass[1] * 9.81 * data.qpos[2]", "-1"),
            ("potential energy (J)", "model.body_mass[1] * 1.62 * data.qpos[2]", "0.165138"),
        ] {
            let all = found(label, expr);
            assert!(
                all.len() == 1 && all[0].contains(&format!(" {factor} times")),
                "{label}: {expr}: {all:?}"
            );
        }
        for (label, expr) in [
            ("kinetic energy (J)", "0.5 * model.body_mass[1] * data.qvel[2] ** 2"),
            ("kinetic energy (mJ)", "500 * model.body_mass[1] * data.qvel[2] ** 2"),
            ("potential energy (J)", "model.body_mass[1] * 9.81 * (data.qpos[2] - 1)"),
            ("potential energy (J)", "model.body_mass[1] * 9.8 * data.qpos[2]"),
            ("kinetic energy per kg (J/kg)", "0.5 * data.qvel[2] ** 2"),
            ("part of the kinetic energy (J)", "0.25 * model.body_mass[1] * data.qvel[2] ** 2"),
            ("kinetic energy (J)", "data.qvel[2]"),
        ] {
            assert_eq!(found(label, expr), [""; 0], "{label}: {expr}");
        }
    }
}
