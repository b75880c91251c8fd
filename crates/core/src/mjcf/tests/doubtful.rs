//! Findings about models that load, compared with the behaviour of the engine.

use crate::mjcf::{NoFiles, Severity, check_xml};
use crate::step::workspace::Workspace;

fn codes(xml: &str) -> Vec<(&'static str, Severity)> {
    check_xml(xml, &NoFiles, None).findings.iter().map(|f| (f.code, f.severity)).collect()
}

/// Whether the speed of a joint grows to a thousand times its initial value.
fn speed_grows(xml: &str) -> bool {
    let model = check_xml(xml, &NoFiles, None).model.unwrap();
    let Workspace { fields: mut data, scratch: mut s } = Workspace::new(&model);
    data.qvel[0] = 1e-3;
    for _ in 0..4000 {
        crate::step::step(&model, &mut data, &mut s);
        if data.warning.iter().any(|w| w.number > 0) || data.qvel[0].abs() > 1.0 {
            return true;
        }
    }
    false
}

/// A spring, a damper or a servo is reported if and only if it is unstable under the integrator.
#[test]
fn reported_time_constants_diverge_and_others_do_not() {
    let h: f64 = 0.002;
    let slide = |option: &str, joint: &str, actuator: &str| {
        format!(
            "<mujoco><option timestep='{h}' gravity='0 0 0' {option}/><worldbody><body><joint name='j' type='slide' {joint}/>\
             <geom size='.1' mass='2'/></body></worldbody><actuator>{actuator}</actuator></mujoco>"
        )
    };
    let mut seen = [0, 0];
    for integrator in ["Euler", "RK4", "implicitfast", "implicit"] {
        let option = format!("integrator='{integrator}'");
        for share in [0.9, 0.98, 1.02, 1.1] {
            let most = if integrator == "RK4" { 2.83_f64.powi(2) } else { 4.0 };
            let k = share * most * 2.0 / (h * h);
            let c = share * 2.0 / h * if integrator == "RK4" { 2.785 } else { 2.0 };
            // With an implicit damper, the stable stiffness is higher.
            let d = 300.0;
            let damped = share * (4.0 * 2.0 + 2.0 * h * d) / (h * h);
            let kp = |kp: f64, kv: f64| format!("<position joint='j' kp='{kp}' kv='{kv}' ctrlrange='-1 1'/>");
            let mut all =
                vec![slide(&option, &format!("stiffness='{k}'"), ""), slide(&option, "", &kp(k, 0.0))];
            if integrator == "Euler" {
                all.push(slide(&option, &format!("stiffness='{damped}' damping='{d}'"), ""));
            }
            if matches!(integrator, "Euler" | "RK4") {
                all.push(slide(&option, "", &kp(1.0, c)));
            }
            for xml in all {
                let reported = codes(&xml).iter().any(|(code, _)| *code == "mjcf-too-fast");
                let grows = speed_grows(&xml);
                seen[usize::from(reported)] += 1;
                // The bound of RK4 is slightly below the true stability limit.
                assert!(
                    reported == grows || (integrator == "RK4" && reported && share < 1.0),
                    "{reported} {grows} {share}: {xml}"
                );
            }
        }
    }
    assert!(seen[0] > 10 && seen[1] > 10, "{seen:?}");
}

/// A contact whose `solref` is too short gives the same bits as one with the value that the finding states.
#[test]
fn softened_constraints_get_the_stated_time_constant() {
    let run = |solref: &str| {
        let xml = format!(
            "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 .1'><freejoint/><geom size='.1' solref='{solref} 1'/>\
             </body></worldbody></mujoco>"
        );
        let reported = codes(&xml).iter().any(|(code, _)| *code == "mjcf-softened");
        let model = check_xml(&xml, &NoFiles, None).model.unwrap();
        let Workspace { fields: mut data, scratch: mut s } = Workspace::new(&model);
        (0..200).for_each(|_| crate::step::step(&model, &mut data, &mut s));
        (reported, data.qpos.clone())
    };
    // The floor has the default. The two `solref` are averaged, so that both limits apply to the mean.
    let (short, least, soft) = (run("0.001"), run("0.004"), run("0.008"));
    assert!(short.0 && !least.0 && !soft.0);
    assert!(least.1 != soft.1);
}

/// The codes of the findings about angles and gravity in a model with this option, body and actuator.
fn angles(compiler: &str, option: &str, body: &str, rest: &str) -> Vec<&'static str> {
    let xml = format!(
        "<mujoco><compiler {compiler}/><option {option}/><worldbody><geom type='plane' size='1 1 1'/>\
         <body pos='0 0 1'>{body}<geom size='.1' mass='1'/></body></worldbody>{rest}</mujoco>"
    );
    let report = check_xml(&xml, &NoFiles, None);
    assert!(report.model.is_some(), "{xml}: {:?}", report.findings);
    let all = report.findings.iter().map(|f| f.code);
    all.filter(|code| ["mjcf-angle-unit", "mjcf-gravity"].contains(code)).collect()
}

/// Numbers that are a usual angle in the other unit are reported; small angles, many turns and slides are not.
#[test]
fn angles_in_the_other_unit_are_reported() {
    let servo = |range: &str| {
        format!("<actuator><position joint='j' kp='1' ctrlrange='{range}' forcerange='-1 1'/></actuator>")
    };
    let key = |qpos: &str| format!("<keyframe><key qpos='{qpos}'/></keyframe>");
    for (compiler, joint, rest) in [
        ("", "range='-1.57 1.57'", String::new()),
        ("", "range='0 3.1416'", String::new()),
        ("", "range='-0.785 0.785'", String::new()),
        ("", "ref='1.5708'", String::new()),
        ("angle='radian'", "range='-45 45'", String::new()),
        ("angle='radian'", "range='0 180'", String::new()),
        ("", "range='-90 90'", servo("-90 90")),
        ("angle='radian'", "range='-1.5708 1.5708'", servo("-90 90")),
        ("", "", key("45")),
    ] {
        let body = format!("<joint name='j' axis='0 1 0' {joint}/>");
        assert_eq!(angles(compiler, "", &body, &rest), ["mjcf-angle-unit"], "{compiler} {joint} {rest}");
    }
    for (compiler, joint, rest) in [
        ("", "range='-90 90'", servo("-1.57 1.57")),
        ("", "range='-1.5 1.5'", String::new()),
        ("", "range='-0.52 0.52'", String::new()),
        ("", "range='-1 1' type='slide'", String::new()),
        ("", "range='-1.57 1.57' type='slide'", String::new()),
        ("angle='radian'", "range='-1.57 1.57'", String::new()),
        ("angle='radian'", "range='0 100'", String::new()),
        ("angle='radian'", "range='0 1000'", String::new()),
        ("", "", key("0.785")),
        ("", "type='slide'", key("45")),
    ] {
        let body = format!("<joint name='j' axis='0 1 0' {joint}/>");
        assert_eq!(angles(compiler, "", &body, &rest), [""; 0], "{compiler} {joint} {rest}");
    }
    let turned = "<freejoint/><site euler='0 1.5708 0'/><site euler='0 90 0'/><site euler='0.5 0 0'/>";
    assert_eq!(angles("", "", turned, ""), ["mjcf-angle-unit"]);
}

/// Gravity that pulls up or along the floor is reported; that of a slope, of the moon and of a scene without one is not.
#[test]
fn gravity_in_the_wrong_direction_is_reported() {
    let gravity = |g: &str, body: &str| angles("", &format!("gravity='{g}'"), body, "");
    for g in ["0 0 9.81", "0 0 9.8", "0 -9.81 0", "9.81 0 0"] {
        assert_eq!(gravity(g, "<freejoint/>"), ["mjcf-gravity"], "{g}");
    }
    for g in ["0 0 -9.81", "0 0 -1.62", "0 0 0", "0 -4.9 -8.5", "0 0 0.1"] {
        assert_eq!(gravity(g, "<freejoint/>"), [""; 0], "{g}");
    }
    // Nothing falls.
    assert_eq!(gravity("0 -9.81 0", "<joint name='j' axis='1 0 0'/>"), [""; 0]);
}
