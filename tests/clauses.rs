//! The reports that authors expect, one clause each: a lab or a quiz with the fault, and a similar one without it. The first
//! gives a finding of the rule, the second does not. (Each rule also has two examples, in `tests/rules.rs`.)

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{check_text, codes};

/// A clause: its description, its rule, examples with the fault, and similar examples without it.
struct Clause {
    says: &'static str,
    code: &'static str,
    wrong: &'static [&'static str],
    right: &'static [&'static str],
}

const ROD: &str = "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><sensor><jointpos joint='hinge'/></sensor><keyframe><key qpos='.3'/><key qpos='0'/></keyframe></mujoco>";
const DROP: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>";
const MOTOR: &str = "<mujoco><option gravity='0 0 0'/><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' damping='1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><actuator><motor joint='hinge' ctrlrange='-1 1' ctrllimited='true'/></actuator></mujoco>";
const PLATE: &str = "<mujoco><worldbody><geom name='plate' type='box' size='1 1 THICK'/><body name='ball' pos='0 0 .3'><freejoint/><geom name='ball' size='.01' mass='.1'/></body></worldbody></mujoco>";

const CART: &str = "<mujoco><option gravity='0 0 0'/><worldbody><body name='cart'><joint name='rail' type='slide' stiffness='10'/><geom size='.1' mass='10'/></body></worldbody></mujoco>";

/// Labs are written without their model: the first word selects it.
const CLAUSES: &[Clause] = &[
    Clause {
        says: "a button that throws",
        code: "store-past-end",
        wrong: &[
            r#"ROD "controls": [{"type": "button", "label": "kick", "run": "const list = [1]; for (let i = 0; i < 3; i += 1) { data.qvel[i + ctx.n] = 1 }"}], "setup": "ctx.n = 5", "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"ROD "controls": [{"type": "button", "label": "kick", "run": "for (let i = 0; i < 1; i += 1) { data.qvel[i + ctx.n] += 1 }"}], "setup": "ctx.n = 0", "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "a button that does nothing, pressed once or twice",
        code: "idle-control",
        wrong: &[
            r#"DROP "stopAt": 0.4, "controls": [{"type": "button", "label": "grip", "run": "model.geom_friction[2] = 0.5"}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]"#,
        ],
        right: &[
            r#"DROP "stopAt": 0.4, "controls": [{"type": "button", "label": "kick", "run": "data.qvel[2] = 2"}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]"#,
            // The second press has an effect.
            r#"DROP "stopAt": 0.4, "setup": "ctx.n = 0", "controls": [{"type": "button", "label": "kick", "run": "ctx.n += 1; if (ctx.n % 2 === 0) { data.qvel[2] = 2 }"}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]"#,
        ],
    },
    Clause {
        says: "init is missing: the next reset makes the shown value false",
        code: "lost-at-reset",
        wrong: &[
            r#"ROD "stopAt": 0.5, "controls": [{"label": "angle", "set": "data.qpos[0]", "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"ROD "stopAt": 0.5, "controls": [{"label": "angle", "set": "data.qpos[0]", "min": 0, "max": 1, "value": 0.5, "init": true}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
            // Changes of the model persist.
            r#"ROD "stopAt": 0.5, "controls": [{"label": "damping", "set": "model.dof_damping[0]", "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "reset is missing: the running state does not follow the value",
        code: "needs-reset",
        wrong: &[
            r#"ROD "setup": "data.qpos[0] = ctx.start", "stopAt": 0.5, "controls": [{"label": "start", "param": "start", "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"ROD "setup": "data.qpos[0] = ctx.start", "stopAt": 0.5, "controls": [{"label": "start", "param": "start", "reset": true, "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
            // The controller reads it as well.
            r#"ROD "setup": "data.qpos[0] = ctx.start", "controller": "data.qfrc_applied[0] = -ctx.start", "stopAt": 0.5, "controls": [{"label": "start", "param": "start", "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "the time of a contact is read one step late",
        code: "contact-time-late",
        wrong: &[
            r#"DROP "controller": "if (ctx.touch === 0 && data.ncon > 0) { ctx.touch = data.time }", "stopAt": 0.6, "setup": "ctx.touch = 0", "readouts": [{"label": "touches at", "expr": "ctx.touch"}, {"label": "height (m)", "expr": "data.qpos[2]"}]"#,
            r#"DROP "controller": "if (data.ncon >= 1) { ctx.touch = ctx.touch || data.time }", "stopAt": 0.6, "setup": "ctx.touch = 0", "readouts": [{"label": "touches at", "expr": "ctx.touch"}, {"label": "height (m)", "expr": "data.qpos[2]"}]"#,
        ],
        right: &[
            r#"DROP "controller": "if (ctx.touch === 0 && data.ncon > 0) { ctx.touch = data.time - model.opt.timestep }", "stopAt": 0.6, "setup": "ctx.touch = 0", "readouts": [{"label": "touches at", "expr": "ctx.touch"}, {"label": "height (m)", "expr": "data.qpos[2]"}]"#,
            // The time of every step, with or without a contact; and contacts that are recomputed.
            r#"DROP "controller": "ctx.now = data.time; ctx.n = data.ncon", "stopAt": 0.6, "readouts": [{"label": "now", "expr": "ctx.now"}, {"label": "contacts", "expr": "ctx.n"}, {"label": "height (m)", "expr": "data.qpos[2]"}]"#,
            r#"DROP "controller": "mj.mj_forward(model, data); if (ctx.touch === 0 && data.ncon > 0) { ctx.touch = data.time }", "stopAt": 0.6, "setup": "ctx.touch = 0", "readouts": [{"label": "touches at", "expr": "ctx.touch"}, {"label": "height (m)", "expr": "data.qpos[2]"}]"#,
        ],
    },
    Clause {
        says: "a sensor is read before it is computed",
        code: "stale-read",
        wrong: &[
            r#"ROD "setup": "data.qpos[0] = 0.5; ctx.start = data.sensordata[0]", "stopAt": 0.2, "readouts": [{"label": "start", "expr": "ctx.start"}, {"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"ROD "setup": "data.qpos[0] = 0.5; mj.mj_forward(model, data); ctx.start = data.sensordata[0]", "stopAt": 0.2, "readouts": [{"label": "start", "expr": "ctx.start"}, {"label": "angle", "expr": "data.qpos[0]"}]"#,
            r#"ROD "setup": "ctx.start = data.sensordata[0]; data.qpos[0] = 0.5", "stopAt": 0.2, "readouts": [{"label": "start", "expr": "ctx.start"}, {"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "a keyframe is no equilibrium where the text says at rest",
        code: "not-at-rest",
        wrong: &[
            r#"ROD "key": 0, "note": "The rod starts at rest in equilibrium.", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"ROD "key": 1, "note": "The rod starts at rest in equilibrium.", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
            r#"ROD "key": 0, "note": "The rod is let go, away from its equilibrium.", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "an actuator is saturated all the time",
        code: "always-saturated",
        wrong: &[
            r#"MOTOR "controller": "data.ctrl[0] = 5 + data.qpos[0]", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
        // The motor is at its limit at first, and within its range later.
        right: &[
            r#"MOTOR "controller": "data.ctrl[0] = 20 * (0.05 - data.qpos[0])", "setup": "data.qpos[0] = -0.2", "stopAt": 2, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "a body passes through another one",
        code: "passes-through",
        wrong: &[
            r#"THIN "setup": "data.qvel[2] = -6", "stopAt": 0.5, "readouts": [{"label": "height", "expr": "data.qpos[2]"}]"#,
        ],
        // The same speed with a thick plate, or next to the plate.
        right: &[
            r#"PLATE "setup": "data.qvel[2] = -1", "stopAt": 0.5, "readouts": [{"label": "height", "expr": "data.qpos[2]"}]"#,
            r#"THIN "setup": "data.qpos[0] = 3; data.qvel[2] = -6", "stopAt": 0.5, "readouts": [{"label": "height", "expr": "data.qpos[2]"}]"#,
        ],
    },
    Clause {
        says: "the unit of a label contradicts the dimension",
        code: "label-unit",
        wrong: &[
            r#"DROP "stopAt": 0.4, "readouts": [{"label": "speed (m/s)", "expr": "data.qpos[2]"}]"#,
            r#"DROP "stopAt": 0.4, "readouts": [{"label": "speed (m/s)", "expr": "Math.sqrt(data.qpos[0] * data.qpos[0] + data.qpos[2] * data.qpos[2])"}]"#,
            r#"ROD "key": 0, "stopAt": 0.5, "readouts": [{"label": "angle (deg)", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"DROP "stopAt": 0.4, "readouts": [{"label": "speed (m/s)", "expr": "Math.sqrt(2 * 9.81 * (1 - data.qpos[2]))"}]"#,
            r#"DROP "stopAt": 0.4, "readouts": [{"label": "speed (m/s)", "expr": "Math.hypot(data.qvel[0], data.qvel[2])"}]"#,
            r#"ROD "key": 0, "stopAt": 0.5, "readouts": [{"label": "angle (deg)", "expr": "data.qpos[0] * 180 / Math.PI"}]"#,
        ],
    },
    Clause {
        says: "degrees where radians are meant",
        code: "degrees-for-radians",
        wrong: &[
            r#"ROD "setup": "data.qpos[0] = 0.2 * Math.sin(30)", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"ROD "setup": "data.qpos[0] = 0.2 * Math.sin(30 * Math.PI / 180)", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "a tolerance that takes the commonest slip",
        code: "slip-accepted",
        wrong: &[
            r#"{"id": "q", "questions": [{"kind": "numeric", "q": "How far does it fall in 2 s, in m?", "answer": 20, "tol": 10}]}"#,
        ],
        right: &[
            r#"{"id": "q", "questions": [{"kind": "numeric", "q": "How far does it fall in 2 s, in m?", "answer": 20, "tol": 0.5}]}"#,
        ],
    },
    Clause {
        says: "a numeric answer that its own explanation contradicts",
        code: "answer-against-explanation",
        wrong: &[
            r#"{"id": "q", "questions": [{"kind": "numeric", "q": "How fast, in m/s?", "answer": 12.65, "tol": 0.05, "unit": "m/s", "explain": "$v = \\sqrt{2 g h}$ = 12.64 m/s."}]}"#,
        ],
        right: &[
            r#"{"id": "q", "questions": [{"kind": "numeric", "q": "How fast, in m/s?", "answer": 12.65, "tol": 0.05, "unit": "m/s", "explain": "$v = \\sqrt{2 g h}$ = 12.65 m/s, and 12.64 m/s with g = 9.8 m/s²."}]}"#,
        ],
    },
    Clause {
        says: "the explanation names another option than the key",
        code: "explains-another-option",
        wrong: &[
            r#"{"id": "q", "questions": [{"q": "Which lands first?", "options": ["the heavy ball", "the light ball", "both together"], "answer": 0, "explain": "Option C is right: mass does not matter."}]}"#,
        ],
        right: &[
            r#"{"id": "q", "questions": [{"q": "Which lands first?", "options": ["the heavy ball", "the light ball", "both together"], "answer": 2, "explain": "Option C is right; option A would need more gravity."}]}"#,
        ],
    },
    Clause {
        says: "options that differ only in wording",
        code: "same-option",
        wrong: &[
            r#"{"id": "q", "questions": [{"q": "Which lands first?", "options": ["The heavy ball", "the heavy ball.", "both together"], "answer": 2}]}"#,
        ],
        right: &[
            r#"{"id": "q", "questions": [{"q": "Which lands first?", "options": ["The heavy ball", "the heavier ball", "both together"], "answer": 2}]}"#,
        ],
    },
    Clause {
        says: "a formula that does not balance",
        code: "formula-unbalanced",
        wrong: &[
            "# A\n\nThe speed is $\\sqrt{2 g h$ at the end.\n",
            "# A\n\nThe speed is $v = \\frac{1}{2 here.\n",
        ],
        right: &[
            "# A\n\nThe speed is $\\sqrt{2 g h}$; it costs $5, or $10.\n",
            "# A\n\nIn code: `$\\sqrt{`.\n",
        ],
    },
    Clause {
        says: "a lab that breaks only where two sliders meet",
        code: "energy-grows",
        wrong: &[
            // sqrt(k / m) h is 0.28 with one slider at its end, and 4 with both.
            r#"CART "stopAt": 1, "setup": "data.qpos[0] = 0.1", "controls": [{"label": "stiffness", "set": "model.jnt_stiffness[0]", "min": 10, "max": 200000, "value": 10}, {"label": "mass", "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "min": 0.05, "max": 10, "value": 10, "reset": true}], "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"CART "stopAt": 1, "setup": "data.qpos[0] = 0.1", "controls": [{"label": "stiffness", "set": "model.jnt_stiffness[0]", "min": 10, "max": 12000, "value": 10}, {"label": "mass", "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "min": 0.05, "max": 10, "value": 10, "reset": true}], "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "buttons that break it only one after the other",
        code: "simulation-diverges",
        wrong: &[
            r#"CART "stopAt": 2, "setup": "ctx.armed = 0", "controls": [{"type": "button", "label": "Arm", "run": "ctx.armed = 1e12; data.qvel[0] = 0.1"}, {"type": "button", "label": "Fire", "run": "data.qvel[0] = ctx.armed"}], "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"CART "stopAt": 2, "setup": "ctx.armed = 0", "controls": [{"type": "button", "label": "Arm", "run": "ctx.armed = 2; data.qvel[0] = 0.1"}, {"type": "button", "label": "Fire", "run": "data.qvel[0] = ctx.armed"}], "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "a timestep whose double breaks the lab",
        code: "near-its-limit",
        wrong: &[
            r#"CART "stopAt": 2, "setup": "data.qpos[0] = 0.1; model.jnt_stiffness[0] = 5e6", "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]"#,
        ],
        right: &[
            r#"CART "stopAt": 2, "setup": "data.qpos[0] = 0.1; model.jnt_stiffness[0] = 1e6", "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]"#,
        ],
    },
    Clause {
        says: "a link or an image inside the course that does not exist",
        code: "dead-link",
        wrong: &["# A\n\nSee [below](#c).\n\n## B\n", "# A\n\n![a picture](#nowhere)\n"],
        right: &[
            "# A\n\nSee [below](#b), or [elsewhere](https://example.org/nothing).\n\n## B\n",
            "# A\n\nIn code: `[below](#c)`.\n",
        ],
    },
    Clause {
        says: "an element that HTML does not have",
        code: "html-element",
        wrong: &[
            r#"{"id": "q", "questions": [{"q": "<bold>Which</bold> lands first?", "options": ["one", "two"], "answer": 0}]}"#,
        ],
        right: &[
            r#"{"id": "q", "questions": [{"q": "<b>Which</b> lands first, if m &lt; 2?", "options": ["one", "two"], "answer": 0}]}"#,
        ],
    },
];

/// The text of a case, and the name of its file.
fn file(case: &str) -> (&'static str, String) {
    let thin = PLATE.replace("THICK", ".0005");
    let thick = PLATE.replace("THICK", ".05");
    for (word, xml) in
        [("ROD", ROD), ("DROP", DROP), ("MOTOR", MOTOR), ("CART", CART), ("THIN", &thin), ("PLATE", &thick)]
    {
        if let Some(rest) = case.strip_prefix(word) {
            return ("lab.json", format!("{{\"xml\": \"{xml}\", {rest}}}"));
        }
    }
    (if case.starts_with('{') { "quiz.json" } else { "lesson.md" }, case.to_string())
}

#[test]
fn every_clause_is_reported_and_similar_text_is_not() {
    let mut faults = Vec::new();
    for clause in CLAUSES {
        let Clause { says, code, wrong, right } = clause;
        assert!(labspec::rules::find(code).is_some(), "{code} is no rule");
        for case in *wrong {
            let (name, text) = file(case);
            let found = codes(&check_text(name, &text));
            if !found.contains(code) {
                faults.push(format!("{says}: not told, but {found:?}: {case}"));
            }
        }
        for case in *right {
            let (name, text) = file(case);
            let found = codes(&check_text(name, &text));
            if found.contains(code) {
                faults.push(format!("{says}: told of what is right: {case}"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
