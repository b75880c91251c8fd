//! Runs that are the same simulation: claims about both are claims about one of them.

use super::bound::BoundVerify;
use super::bound_run::{BoundRun, BoundScene};
use super::compiled_claim::{ClaimInputs, CompiledClaim, reads_ctx};
use super::layout::Slot;
use super::runner::{length_key, settings_key, started_session};
use crate::bind::World;
use labspec_core::reflect::{FieldId, Object};
use labspec_core::state;
use labspec_expr::{FieldKey, Host};

impl BoundVerify<'_> {
    /// For each run, the first run that is the same simulation; its own index where there is none. The runs of a sweep are left out: its
    /// list shows which values they have.
    pub(super) fn same_runs(&self) -> &[usize] {
        self.same_runs.get_or_init(|| {
            let all: Vec<_> = self.runs_with_scenes().collect();
            if all.len() < 2 {
                return (0..all.len()).collect();
            }
            let starts: Vec<Option<Vec<u64>>> =
                all.iter().map(|(run, scene)| self.start_bits(scene, run)).collect();
            let is_same = |i: usize, j: usize| {
                let ((a, a_scene), (b, b_scene)) = (all[i], all[j]);
                let is_comparable = a.swept.is_none() && b.swept.is_none() && length_key(a) == length_key(b);
                let starts_equal =
                    || starts[i].is_some() && starts[i] == starts[j] && plays_equal(a_scene, a, b_scene, b);
                is_comparable && (settings_key(a_scene, a) == settings_key(b_scene, b) || starts_equal())
            };
            (0..all.len()).map(|j| (0..j).find(|i| is_same(*i, j)).unwrap_or(j)).collect()
        })
    }

    /// The model and the state of a run after its setup, as bits. `None` if a program reads variables of `ctx`, which may differ as well,
    /// or if the run cannot be started.
    fn start_bits(&self, scene: &BoundScene<'_>, run: &BoundRun<'_>) -> Option<Vec<u64>> {
        let programs = &scene.scene.programs;
        let of_lab =
            programs.controller.iter().chain(programs.probes.iter().filter_map(|p| p.bound.as_ref()));
        let of_lab = of_lab.map(|bound| &bound.program);
        let of_buttons = run.spec.iter().flat_map(|spec| &spec.press);
        let buttons = of_buttons.filter_map(|(label, _)| programs.effects_of(&label.value));
        let of_run = run.stop.iter().chain(scene.measures.iter().map(|(_, m)| m)).map(|text| &text.program);
        let is_about_ctx = of_lab.chain(of_run).any(reads_ctx)
            || buttons.into_iter().any(|effects| effects.any_ctx || !effects.ctx_reads.is_empty());
        if is_about_ctx || run.swept.is_some() {
            return None;
        }
        Some(world_bits(&started_session(scene, run)?.world))
    }

    /// The positions of numbers that a claim reads of a run, each with the position of the same number of an earlier run that is the same
    /// simulation.
    pub(super) fn repeated_numbers(
        &self,
        claim: &CompiledClaim,
        inputs: &ClaimInputs,
    ) -> Vec<(usize, usize)> {
        let slots = &self.layout().slots;
        let of_run = |place: &usize| match *slots.get(*place)? {
            Slot::Measure(run, m) => Some((*place, run, Some(m))),
            Slot::Warnings(run) => Some((*place, run, None)),
            _ => None,
        };
        let read: Vec<_> = claim.reads.iter().filter_map(of_run).collect();
        // A program that draws numbers measures something else in the same simulation.
        let equal = |a: usize, b: usize| inputs.at(a).map(f64::to_bits) == inputs.at(b).map(f64::to_bits);
        let repeated = read.iter().enumerate().filter_map(|(k, (place, run, what))| {
            let earlier = read
                .get(..k)?
                .iter()
                .filter(|(other, owner, of)| owner != run && of == what && equal(*other, *place));
            let mut earlier = earlier.filter(|(_, owner, _)| {
                let same = self.same_runs();
                same.get(*owner) == same.get(*run)
            });
            earlier.next().map(|(original, ..)| (*place, *original))
        });
        repeated.collect()
    }
}

/// Whether two runs go on equally from equal starts: they are of the same lab, and press the same buttons.
fn plays_equal(
    a_scene: &BoundScene<'_>,
    a: &BoundRun<'_>,
    b_scene: &BoundScene<'_>,
    b: &BoundRun<'_>,
) -> bool {
    let [lab, other] = [a_scene, b_scene].map(|scene| &*scene.scene.lab);
    let presses = |run: &BoundRun<'_>| -> Vec<(String, u64)> {
        let all = run.spec.iter().flat_map(|spec| &spec.press);
        all.map(|(label, t)| (label.value.clone(), t.value.to_bits())).collect()
    };
    lab.span == other.span && presses(a) == presses(b)
}

/// The model and the state, as bits.
fn world_bits(world: &World) -> Vec<u64> {
    let mut bits = Vec::new();
    let fields = (0..).map_while(|i| Some((i, FieldId::new(i as usize)?)));
    for (i, _) in fields.filter(|(_, field)| field.info().object != Object::Data) {
        let key = FieldKey(i);
        bits.push(world.len(key) as u64);
        bits.extend((0..world.len(key)).filter_map(|k| world.get(key, k)).map(f64::to_bits));
    }
    let mut numbers = vec![0.0; state::size(&world.model, state::INTEGRATION).unwrap_or(0)];
    let _ = state::get(&world.model, &world.data, &mut numbers, state::INTEGRATION);
    bits.extend(numbers.into_iter().map(f64::to_bits));
    bits
}

#[cfg(test)]
mod tests {
    use crate::verify::Verdict;

    /// The codes of what is found about a fall in two runs, and the verdict on its answer.
    fn checked(second: serde_json::Value, condition: &str) -> (Vec<String>, Verdict) {
        let xml = "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>";
        let control = serde_json::json!({"label": "gravity (m/s²)", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "reset": true});
        let quiz = serde_json::json!({"id": "q", "questions": [{
            "kind": "truefalse", "q": "It takes as long in both.", "answer": true,
            "verify": {
                "lab": {"stopAt": 2, "xml": xml, "controls": [control]},
                "runs": {"first": {}, "second": second},
                "measure": {"t": "crossing(data.qpos[2])", "v": "min(data.qvel[2])"},
                "options": [condition],
            },
        }]});
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz.to_string());
        let codes = report.findings.iter().map(|finding| finding.code.to_string()).collect();
        let answers = report.checked.claims.iter().filter_map(|claim| claim.judgement.answer.as_ref());
        (codes, answers.map(|answer| answer.verdict).next().unwrap_or(Verdict::Unverified))
    }

    #[test]
    fn a_simulation_is_not_compared_with_itself() {
        let same = "abs(second.t - first.t) < 0.001";
        for second in [
            serde_json::json!({}),
            serde_json::json!({"set": {"gravity (m/s²)": -9.81}}),
            serde_json::json!({"setup": "model.opt.gravity[2] = -9.81"}),
            serde_json::json!({"setup": "data.qvel[0] = 0"}),
            serde_json::json!({"setup": "ctx.factor = 2"}),
        ] {
            let (codes, verdict) = checked(second.clone(), same);
            assert_eq!((codes, verdict), (vec!["identical-runs".to_string()], Verdict::Failed), "{second}");
        }
        let (codes, verdict) = checked(serde_json::json!({"setup": "ctx.factor = 2"}), "second.t > 0.4");
        assert_eq!((codes, verdict), (vec!["unread-run".to_string()], Verdict::Verified));
    }

    #[test]
    fn what_has_no_effect_is_compared() {
        let same = "abs(second.t - first.t) < 0.001";
        for second in [
            serde_json::json!({"setup": "model.geom_friction[0] = 0.5"}),
            serde_json::json!({"setup": "data.qvel[0] = 1"}),
        ] {
            assert_eq!(checked(second.clone(), same), (Vec::new(), Verdict::Verified), "{second}");
        }
        let slower = serde_json::json!({"set": {"gravity (m/s²)": -1.62}});
        assert_eq!(checked(slower.clone(), "second.t > 2 * first.t"), (Vec::new(), Verdict::Verified));
        assert!(checked(slower, same).0.contains(&"answer-refuted".to_string()));
    }
}
