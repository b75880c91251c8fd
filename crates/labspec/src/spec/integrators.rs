//! A lab that compares integrators, read as an ordinary lab: with a select that sets the integrator after `setup`, a first
//! plot of the drift of the total energy, and a run of `verify` for each integrator. `web/elements/src/lab/integrators.ts`
//! adds the same control and the same plot to the lab of a page.

use super::control::{Action, Choice, Control, ControlKind};
use super::fields::Fields;
use super::format::{INTEGRATOR_NAMES, texts};
use super::lab::{Comparison, Lab, Run, Verify};
use super::plot::{Plot, Trace};
use super::read;
use crate::json::{Json, Number, Scalar};
use crate::source::Text;
use std::fmt::Write;
use std::ops::Range;

/// The label of the select, by which runs address it.
pub const INTEGRATOR: &str = "integrator";
/// The label of the trace, and of the vertical axis of its plot.
pub const ENERGY_DRIFT: &str = "energy drift";

/// The drift of the energy, as the trace shows it. After a step, fields belong to the state before it, or to a stage of RK4:
/// `mj_forward` computes the energy of the state that is shown.
const DRIFT: &str = "(() => { mj.mj_forward(model, data); return (lib.energy().total - ctx.energyStart) / ctx.energyUnit; })()";

/// Stores the energy at the start, and the unit of the drift: the energy itself, or 1 J where it is zero.
const BASELINE: &str = "mj.mj_forward(model, data); ctx.energyStart = lib.energy().total; ctx.energyUnit = Math.abs(ctx.energyStart) > 1e-9 ? Math.abs(ctx.energyStart) : 1";

/// Reads the keys of the comparison.
pub(super) fn read_comparison(f: &mut Fields<'_, '_>) -> Comparison {
    let brace = f.span().start..f.span().end.min(f.span().start + 1);
    let span = f.node("integrators").map_or(brace, |node| node.span.clone());
    let is_list = f.node("integrators").is_some_and(|node| matches!(node.json, Json::Array(_)));
    let nodes = f.items("integrators").unwrap_or_default();
    let texts_of_list: Vec<Text> =
        nodes.iter().filter_map(|n| read::text(n, "an integrator", f.problems)).collect();
    // A value that is not a list, and a list without any text, have their own findings.
    let has_names = nodes.is_empty() || !texts_of_list.is_empty();
    let listed = (is_list && has_names).then_some(texts_of_list);
    let is_listed = |name: &&str| listed.iter().flatten().any(|text| text.value == *name);
    let order = |name: &&str| listed.iter().flatten().position(|text| text.value == *name);
    let mut integrators: Vec<&'static str> = texts(&INTEGRATOR_NAMES).filter(is_listed).collect();
    integrators.sort_by_key(order);
    if integrators.is_empty() {
        integrators = texts(&INTEGRATOR_NAMES).collect();
    }
    Comparison { span, listed, timestep: f.number("timestep"), integrators, control: 0 }
}

/// Adds to a lab what compares its integrators: the select, the plot of the energy, and the runs of its claims.
pub(super) fn add_comparison(lab: Lab, mut comparison: Comparison) -> Lab {
    let span = comparison.span.clone();
    comparison.control = lab.controls.len();
    let controls = lab.controls.into_iter().chain([integrator_select(&comparison)]).collect();
    let energy = energy_plot(&span, lab.stop_at.clone());
    let plots = [energy].into_iter().chain(lab.plots).collect();
    let verify = lab.verify.map(|verify| with_runs(verify, &comparison));
    Lab { controls, plots, verify, comparison: Some(comparison), ..lab }
}

/// A text that the lesson does not contain, at a place of the lesson.
fn added(value: &str, span: &Range<usize>) -> Text {
    Text::derived(value.to_string(), span.clone())
}

/// The select that sets the integrator, and the timestep, after `setup` and the other controls. Its values are names, so
/// that messages and runs name them.
fn integrator_select(comparison: &Comparison) -> Control {
    let span = &comparison.span;
    let name = |name: &&'static str| added(name, span);
    let first = comparison.integrators.first().map_or_else(|| added("", span), name);
    let choice = |text: Text| Choice { value: Scalar::Text(text.clone()), text };
    Control {
        span: span.clone(),
        label: added(INTEGRATOR, span),
        kind: ControlKind::Select {
            options: comparison.integrators.iter().map(name).map(choice).collect(),
            value: Scalar::Text(first),
            action: Action {
                set: None,
                apply: Some(added(&statements(comparison.timestep.as_ref()), span)),
                param: None,
                init: true,
                reset: true,
            },
        },
    }
}

/// The statements of the select: they read the name of an integrator as `value`.
fn statements(timestep: Option<&Number>) -> String {
    let mut code = String::new();
    if let Some(h) = timestep.map(|h| h.value).filter(|h| h.is_finite() && *h > 0.0) {
        let _ = write!(code, "model.opt.timestep = {h:e}; ");
    }
    code.push_str("model.opt.integrator = ");
    // The numbers are those of `mjtIntegrator`, which has the order of the names.
    let count = INTEGRATOR_NAMES.len();
    for (id, name) in texts(&INTEGRATOR_NAMES).enumerate().take(count - 1) {
        let _ = write!(code, "value === '{name}' ? {id} : ");
    }
    let _ = write!(code, "{}; {BASELINE}", count - 1);
    code
}

fn energy_plot(span: &Range<usize>, window: Option<Number>) -> Plot {
    Plot {
        span: span.clone(),
        ylabel: Some(added(ENERGY_DRIFT, span)),
        xlabel: None,
        window,
        ymin: None,
        ymax: None,
        height: None,
        ref_lines: Vec::new(),
        traces: vec![Trace {
            span: span.clone(),
            label: added(ENERGY_DRIFT, span),
            expr: added(DRIFT, span),
            dash: false,
        }],
    }
}

/// Without runs, the claims have a run for each integrator. A run that is named after an integrator uses it, or cannot be
/// made if it is not compared. Claims about another lab are unchanged.
fn with_runs(verify: Verify, comparison: &Comparison) -> Verify {
    if verify.lab.is_some() {
        return verify;
    }
    let setting =
        |name: &str, span: &Range<usize>| (added(INTEGRATOR, span), Scalar::Text(added(name, span)));
    if verify.runs.is_empty() && verify.uses.is_none() {
        let span = &comparison.span;
        let run = |name: &&'static str| Run {
            name: added(name, span),
            set: vec![setting(name, span)],
            ..Run::named(name)
        };
        return Verify { runs: comparison.integrators.iter().map(run).collect(), ..verify };
    }
    let with_integrator = |mut run: Run| {
        let is_integrator = texts(&INTEGRATOR_NAMES).any(|name| name == run.name.value);
        let sets = run.set.iter().any(|(label, _)| label.value == INTEGRATOR);
        if is_integrator && !sets && run.lab.is_none() {
            run.set.push(setting(&run.name.value, &run.name.span()));
        }
        run
    };
    Verify { runs: verify.runs.into_iter().map(with_integrator).collect(), ..verify }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lint::{ModelFolder, load_lesson};
    use crate::source::SourceFile;
    use crate::spec::{Lesson, format};
    use proptest::prelude::*;
    use serde_json::Value;

    fn read(json: &str) -> Lesson {
        let text = format!("```lab integrators\n{json}\n```\n");
        load_lesson(SourceFile::new("t.md", text), &ModelFolder::with_names(["spring"]))
    }

    fn lab_of(json: &str) -> Lab {
        read(json).labs[0].lab.clone().unwrap()
    }

    fn codes(json: &str) -> Vec<&'static str> {
        read(json).findings.iter().map(|f| f.code).collect()
    }

    /// A page builds its labs in TypeScript. Its tests read the same file.
    #[test]
    fn a_page_and_a_check_add_the_same_control_and_the_same_plot() {
        let shared: Value =
            serde_json::from_str(include_str!("../../../../web/elements/test/integrators.json")).unwrap();
        let lab = lab_of(&shared["lab"].to_string());
        let Some(Comparison { control: 1, integrators, .. }) = &lab.comparison else { panic!("{lab:?}") };
        assert_eq!(*integrators, ["RK4", "Euler"]);
        let action = lab.controls[1].action().unwrap();
        assert_eq!(action.apply.as_ref().unwrap().value, shared["apply"]);
        assert_eq!((lab.controls[1].label.as_str(), action.init, action.reset), (INTEGRATOR, true, true));
        let [drift, stretch] = lab.plots.as_slice() else { panic!("{:?}", lab.plots) };
        assert_eq!((drift.window(), drift.traces[0].label.as_str()), (10.0, ENERGY_DRIFT));
        assert_eq!(drift.traces[0].expr.value, shared["drift"]);
        assert_eq!(stretch.traces[0].label.as_str(), "stretch (m)");
    }

    #[test]
    fn the_numbers_of_the_names_are_those_of_the_engine() {
        use labspec_core::integrator::{EULER, IMPLICIT, IMPLICITFAST, RK4};
        let numbers =
            [("Euler", EULER), ("RK4", RK4), ("implicit", IMPLICIT), ("implicitfast", IMPLICITFAST)];
        let names: Vec<_> = texts(&INTEGRATOR_NAMES).enumerate().map(|(i, name)| (name, i as i32)).collect();
        assert_eq!(names, numbers);
    }

    #[test]
    fn without_a_list_all_integrators_are_compared() {
        let lab = lab_of(r#"{"model": "spring"}"#);
        let comparison = lab.comparison.unwrap();
        assert_eq!(comparison.integrators, ["Euler", "RK4", "implicit", "implicitfast"]);
        assert_eq!(comparison.span, 19..20);
        assert_eq!(codes(r#"{"model": "spring"}"#), [""; 0]);
    }

    #[test]
    fn wrong_lists_and_timesteps_are_reported_and_the_rest_is_read() {
        let with = |keys: &str| format!("{{\"model\": \"spring\", {keys}}}");
        for (keys, code) in [
            (r#""integrators": []"#, "integrators-list"),
            (r#""integrators": ["rk4"]"#, "integrators-list"),
            (r#""integrators": ["RK4", "RK4"]"#, "integrators-list"),
            (r#""integrators": ["leapfrog", "RK4"]"#, "integrators-list"),
            (r#""integrators": "RK4""#, "wrong-type"),
            (r#""integrators": [0, 1]"#, "wrong-type"),
            (r#""integrators": {"RK4": true}"#, "wrong-type"),
            (r#""timestep": 0"#, "not-positive"),
            (r#""timestep": -0.1"#, "not-positive"),
            (r#""timestep": "0.1""#, "wrong-type"),
            (r#""integratos": ["RK4"]"#, "unknown-key"),
            (r#""quantity": "energy""#, "unknown-key"),
        ] {
            let json = with(keys);
            assert!(codes(&json).contains(&code), "{json}: {:?}", codes(&json));
            let lab = lab_of(&json);
            assert_eq!(lab.controls.len(), 1);
            assert!(!lab.comparison.unwrap().integrators.is_empty());
        }
        for keys in [r#""integrators": "RK4""#, r#""integrators": [0, 1]"#] {
            assert!(!codes(&with(keys)).contains(&"integrators-list"), "{keys}");
        }
        let unknown = read(&with(r#""quantity": "energy""#)).findings.remove(0);
        let help = unknown.help.unwrap();
        assert!(help.contains("integrators") && help.contains("timestep"), "{help}");
        // The keys of the comparison belong to this kind of lab only.
        let lab =
            "```lab simlab\n{\"model\": \"spring\", \"timestep\": 0.1, \"integrators\": [\"RK4\"]}\n```\n";
        let lesson = load_lesson(SourceFile::new("t.md", lab), &ModelFolder::with_names(["spring"]));
        assert_eq!(lesson.findings.iter().filter(|f| f.code == "unknown-key").count(), 2);
        assert_eq!(lesson.labs[0].lab.as_ref().unwrap().comparison, None);
    }

    #[test]
    fn a_json_file_holds_the_same_kind_of_lab() {
        let file = |json: &str| {
            let folder = ModelFolder::with_names(["spring"]);
            load_lesson(SourceFile::new("t.json", json), &folder).labs.remove(0).lab.unwrap()
        };
        let lab = file(r#"{"model": "spring", "integrators": ["RK4"]}"#);
        assert_eq!(lab.comparison.unwrap().integrators, ["RK4"]);
        assert_eq!(file(r#"{"model": "spring"}"#).comparison, None);
    }

    #[test]
    fn claims_have_a_run_for_each_integrator() {
        let runs = |verify: &str| -> Vec<(String, Option<String>)> {
            let json =
                format!(r#"{{"model": "spring", "integrators": ["RK4", "Euler"], "verify": {verify}}}"#);
            let verify = lab_of(&json).verify.unwrap();
            let set = |run: &Run| {
                let integrator = run.set.iter().find(|(label, _)| label.value == INTEGRATOR)?;
                match &integrator.1 {
                    Scalar::Text(text) => Some(text.value.clone()),
                    other => Some(format!("{other:?}")),
                }
            };
            verify.runs.iter().map(|run| (run.name.value.clone(), set(run))).collect()
        };
        let one = |name: &str, integrator: Option<&str>| (name.to_string(), integrator.map(str::to_string));
        let each = [one("RK4", Some("RK4")), one("Euler", Some("Euler"))];
        assert_eq!(runs(r#"{"says": []}"#), each);
        assert_eq!(
            runs(r#"{"runs": {"Euler": {"until": 1}, "implicit": {}, "long": {"until": 2}}}"#),
            [one("Euler", Some("Euler")), one("implicit", Some("implicit")), one("long", None)]
        );
        assert_eq!(
            runs(r#"{"runs": {"Euler": {"set": {"integrator": "RK4"}}}}"#),
            [one("Euler", Some("RK4"))]
        );
        assert_eq!(runs(r##"{"lab": "#1", "says": []}"##), []);
        assert_eq!(runs(r##"{"lab": "#1", "runs": {"Euler": {}}}"##), [one("Euler", None)]);
    }

    #[test]
    fn what_the_author_did_not_write_is_not_his_code() {
        let json = r#"{"model": "spring", "setup": "data.qpos[0] = 1", "plots": [{"traces": [{"label": "x", "expr": "data.qpos[0]"}]}]}"#;
        let lab = lab_of(json);
        let code: Vec<&str> = lab.code().into_iter().map(|(_, text)| text.as_str()).collect();
        assert_eq!(code, ["data.qpos[0] = 1", "data.qpos[0]"]);
        assert_eq!(
            lab_of(r#"{"model": "spring", "readouts": [{"label": "x", "expr": "1"}]}"#).code().len(),
            1
        );
    }

    #[test]
    fn the_editor_offers_the_keys_and_the_names_of_the_kind() {
        let offered = |json: &str| -> Vec<String> {
            let text = format!("```lab integrators\n{json}\n```\n");
            let offset = text.find('|').unwrap();
            let file = SourceFile::new("t.md", text.replace('|', ""));
            let all = format::completions_in(&file, offset, &|_| Vec::new());
            all.into_iter().map(|c| c.text.into_owned()).collect()
        };
        assert_eq!(offered(r#"{"model": "spring", "integ|"}"#), ["integrators"]);
        assert_eq!(offered(r#"{"model": "spring", "integrators": ["R|"]}"#), ["RK4"]);
        assert_eq!(
            offered(r#"{"model": "spring", "integrators": ["|"]}"#),
            ["Euler", "RK4", "implicit", "implicitfast"]
        );
        let all = offered(r#"{"model": "spring", |}"#);
        assert!(all.contains(&"timestep".to_string()) && all.contains(&"stopAt".to_string()), "{all:?}");
    }

    proptest! {
        /// No list causes a panic, and what is compared is never empty and never repeated.
        #[test]
        fn hostile_lists_are_survived(
            names in prop::collection::vec(
                prop::sample::select(vec!["\"RK4\"", "\"Euler\"", "\"é\"", "\"\"", "null", "[]", "{}", "1e999", "“", "\"\\u0000\""]),
                0..12,
            ),
            timestep in prop::sample::select(vec!["1e999", "-0", "1e-320", "0.01", "null", "\"x\""]),
        ) {
            let json = format!("{{\"model\": \"spring\", \"integrators\": [{}], \"timestep\": {timestep}}}", names.join(", "));
            let lesson = read(&json);
            if let Some(lab) = lesson.labs.first().and_then(|entry| entry.lab.as_ref()) {
                let integrators = &lab.comparison.as_ref().unwrap().integrators;
                let mut each = integrators.clone();
                each.sort_unstable();
                each.dedup();
                prop_assert!(!integrators.is_empty() && each.len() == integrators.len());
            }
        }
    }
}
