use crate::check::observations::ObservedLab;
use crate::check::setconst::digits;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A lab never reaches its `stopAt`.
pub const STOP_UNREACHED: &Rule = &Rule {
    code: "stop-unreached",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a lab never reaches its `stopAt`",
    why: "something resets it while it runs, and time starts again at 0: a student waits for an end that does not come",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": ⟦1⟧, "controller": "if (data.time > 0.3) { mj.mj_resetData(model, data) }", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};

pub(crate) fn check_stop_reached(observed: &ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let Some(stop) = &observed.bench.ready.lab.stop_at else { return };
    let Some((_, timestep)) = observed.bench.steps(observed.length) else { return };
    // The nominal run. It was long enough if time had advanced.
    let Some(nominal) =
        observed.records.first().filter(|r| r.moved.is_none() && observed.length >= stop.value)
    else {
        return;
    };
    let times = || nominal.rows.iter().filter_map(|row| row.first()).map(|cell| cell.number());
    let last = times().fold(f64::NEG_INFINITY, f64::max);
    if last >= stop.value - 1.5 * timestep {
        return;
    }
    let back = times().zip(times().skip(1)).find(|(a, b)| b < a);
    let [stop_at, last] = [stop.value, last].map(|x| digits(x, 4));
    let why = match back.map(|(before, after)| [before, after].map(|x| digits(x, 4))) {
        Some([before, after]) => {
            format!("in the run, time goes from {before} s back to {after} s, and never exceeds {last} s")
        }
        None => format!("in the run, time never exceeds {last} s: something resets it in every step"),
    };
    findings.push(
        Finding::warning(STOP_UNREACHED, stop.span.clone(), format!("the lab never reaches {stop_at} s"))
            .why(why)
            .help("find what resets the simulation while it runs, or stop earlier"),
    );
}
