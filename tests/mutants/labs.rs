//! Kinds of mistakes in labs.

use super::Kind;
use super::edit::{
    code, controls, displayed_code, each, move_index, setup, statements, swap, text, with, without,
};
use serde_json::{Value, json};

/// The paths of the expressions of traces and readouts.
const TRACE: [&str; 5] = ["plots", "*", "traces", "*", "expr"];
const READOUT: [&str; 3] = ["readouts", "*", "expr"];

/// A kind of mistake.
const fn kind(name: &'static str, words: &'static str, plant: fn(&Value) -> Vec<Value>) -> Kind {
    Kind { name, words, plant, right: None }
}

/// A kind of mistake that omits a call. Its `right` is the lab with the call.
const fn without_forward(name: &'static str, words: &'static str, plant: fn(&Value) -> Vec<Value>) -> Kind {
    Kind { name, words, plant, right: Some(forwarded) }
}

/// The lab with `mj_forward` after the writes of its setup.
fn forwarded(l: &Value) -> Value {
    let mut l = l.clone();
    let text = l["setup"].as_str().unwrap_or("");
    let forward = "+= 0.3; mj.mj_forward(model, data);";
    l["setup"] = json!(text.replace("+= 0.3;", forward));
    l
}

/// Mistakes in texts.
pub(super) const TEXTS: [Kind; 18] = [
    kind("misspelt-field", "a field is misspelt", |l| {
        code(l, |t| swap(t, "qpos", "qops").or_else(|| swap(t, "qvel", "qvle")))
    }),
    kind("misspelt-function", "a function is misspelt", |l| {
        code(l, |t| swap(t, "lib.", "lib.the").or_else(|| swap(t, "Math.", "Math.x")))
    }),
    kind("misspelt-element", "the name of a body, joint, geom or site is misspelt", |l| {
        code(l, |t| swap(t, "('", "('x"))
    }),
    kind("misspelt-variable", "a text reads a variable of `ctx` that nothing stores", |l| {
        displayed_code(l, |t| swap(t, "ctx.", "ctx.the_"))
    }),
    kind("next-index", "an index is one too high", |l| displayed_code(l, |t| move_index(t, 1))),
    kind("far-index", "an index is beyond the end", |l| code(l, |t| move_index(t, 500))),
    kind("written-index", "statements write the element after the intended one", |l| {
        statements(l, |t| move_index(t, 1))
    }),
    kind("wrong-sign", "the displayed value has the wrong sign", |l| {
        displayed_code(l, |t| Some(format!("-({t})")))
    }),
    kind("wrong-unit", "a factor of a thousand is missing", |l| {
        displayed_code(l, |t| swap(t, "1000 * ", ""))
    }),
    kind("degrees", "degrees are used where radians are required", |l| {
        code(l, |t| swap(t, " * Math.PI / 180", ""))
    }),
    kind("xor", "`^` stands for a power", |l| code(l, |t| swap(t, " ** 2", " ^ 2"))),
    kind("compared", "`==` stands for `=`", |l| statements(l, |t| swap(t, "] = ", "] == "))),
    kind("nan-trace", "a trace is the root of a negative number", |l| {
        text(l, &TRACE, |t| Some(format!("Math.sqrt(-1 - ({t}) ** 2)")))
    }),
    kind("only-nan", "a trace has no values", |l| text(l, &TRACE, |_| Some("NaN".into()))),
    kind("nan-later", "a trace is the root of a value that becomes negative", |l| {
        text(l, &TRACE, |t| Some(format!("({t}) * Math.sqrt(0.2 - data.time)")))
    }),
    kind("nan-at-start", "the displayed value is divided by time, which is 0 at the start", |l| {
        displayed_code(l, |t| Some(format!("({t}) * data.time / data.time")))
    }),
    kind("infinite", "the displayed value is divided by 0", |l| {
        text(l, &READOUT, |t| Some(format!("1 / (({t}) - ({t}))")))
    }),
    kind("text-in-plot", "a trace is a text", |l| {
        text(l, &TRACE, |t| Some(format!("({t}).toFixed(2) + ' m'")))
    }),
];

/// Mistakes in plots and readouts, and in the displayed time.
pub(super) const VIEWS: [Kind; 13] = [
    kind("constant-trace", "a trace shows the initial value of its coordinate", |l| {
        text(l, &TRACE, |t| swap(t, "data.qpos", "model.qpos0"))
    }),
    kind("constant-readout", "a readout shows the initial value of its coordinate", |l| {
        text(l, &READOUT, |t| swap(t, "data.qpos", "model.qpos0"))
    }),
    kind("frozen-trace", "a trace is a constant", |l| text(l, &TRACE, |_| Some("0.25".into()))),
    kind("above-plot", "the curves lie outside of the plot", |l| {
        each(l, &["plots", "*"], |p| limits(p, 1e4, 2e4))
    }),
    kind("narrow-plot", "the plot shows a tenth of the range of its curves", |l| {
        each(l, &["plots", "*"], |p| {
            let [low, high] = [p["ymin"].as_f64()?, p["ymax"].as_f64()?];
            limits(p, high, high + 0.1 * (high - low))
        })
    }),
    kind("upside-down-plot", "the ends of a plot are exchanged", |l| {
        each(l, &["plots", "*"], |p| limits(p, p["ymax"].as_f64()?, p["ymin"].as_f64()?))
    }),
    kind("copied-trace", "two traces have the same expression", |l| {
        each(l, &["plots", "*", "traces"], |list| {
            let mut list = list.clone();
            let first = list.get(0)?["expr"].clone();
            *list.get_mut(1)?.get_mut("expr")? = first;
            Some(list)
        })
    }),
    kind("copied-readout", "two readouts have the same expression", |l| {
        each(l, &["readouts"], |list| {
            let mut list = list.clone();
            let first = list.get(0)?["expr"].clone();
            *list.get_mut(1)?.get_mut("expr")? = first;
            Some(list)
        })
    }),
    kind("empty-plot", "a plot has no traces", |l| each(l, &["plots", "*", "traces"], |_| Some(json!([])))),
    kind("early-stop", "the lab stops before anything happens", |l| with(l, "stopAt", json!(0.001))),
    kind("no-run", "the lab stops at once", |l| with(l, "stopAt", json!(0))),
    kind("short-window", "a plot shows a hundredth of a second", |l| {
        each(l, &["plots", "*"], |p| {
            let mut p = p.clone();
            p["window"] = json!(0.01);
            Some(p)
        })
    }),
    kind("no-digits", "a readout shows no decimals, and therefore never changes", |l| {
        each(l, &["readouts", "*"], |r| {
            let mut r = r.clone();
            (r["digits"].as_f64().unwrap_or(3.0) > 2.0).then(|| r["digits"] = json!(0))?;
            Some(r)
        })
    }),
];

/// Mistakes in labels. They come last, so that the positions of the other kinds do not change.
pub(super) const LABELS: [Kind; 2] = [
    kind("labels-exchanged", "two traces or readouts have each other's label", |l| {
        let mut all = each(l, &["plots", "*", "traces"], exchanged);
        all.extend(each(l, &["readouts"], exchanged));
        all
    }),
    kind("label-in-degrees", "a label says degrees, and the number is in radians", |l| {
        labels(l, |t| swap(t, "(rad", "(deg"))
    }),
];

/// Changes the labels of readouts and plots.
fn labels(l: &Value, change: fn(&str) -> Option<String>) -> Vec<Value> {
    let mut all = text(l, &["readouts", "*", "label"], change);
    all.extend(text(l, &["plots", "*", "ylabel"], change));
    all
}

/// A list whose first two elements have exchanged labels.
fn exchanged(list: &Value) -> Option<Value> {
    let mut list = list.clone();
    let [first, second] = [0, 1].map(|i| list.get(i).map(|one| one["label"].clone()));
    list[0]["label"] = second?;
    list[1]["label"] = first?;
    Some(list)
}

/// A plot with other limits.
fn limits(plot: &Value, low: f64, high: f64) -> Option<Value> {
    let mut plot = plot.clone();
    plot["ymin"] = json!(low);
    plot["ymax"] = json!(high);
    Some(plot)
}

/// Sets a number of every slider to a value computed from the slider.
fn slider(l: &Value, key: &str, value: fn(&Value) -> Option<f64>) -> Vec<Value> {
    controls(l, |c| {
        c["min"].as_f64()?;
        let new = value(c)?;
        c[key] = json!(new);
        Some(())
    })
}

fn number(c: &Value, key: &str) -> Option<f64> {
    c[key].as_f64()
}

/// Removes a key from every control that has it.
fn unset(l: &Value, key: &str) -> Vec<Value> {
    controls(l, |c| c.as_object_mut()?.shift_remove(key).map(drop))
}

/// Mistakes in controls.
pub(super) const CONTROLS: [Kind; 24] = [
    kind("off-grid", "a slider begins between two of its steps", |l| {
        slider(l, "value", |c| {
            let step = number(c, "step")?;
            let value = number(c, "value")? + 0.37 * step;
            (value <= number(c, "max")?).then_some(value)
        })
    }),
    kind("coarse-step", "the steps of a slider do not include its start value", |l| {
        slider(l, "step", |c| {
            let [min, max, value] = ["min", "max", "value"].map(|k| c[k].as_f64().unwrap_or(0.0));
            (value > min).then_some(0.4 * (value - min)).filter(|s| *s < max - min)
        })
    }),
    kind("value-outside", "a slider begins outside of its range", |l| {
        slider(l, "value", |c| Some(2.0 * number(c, "max")? - number(c, "min")?))
    }),
    kind("swapped-ends", "the ends of a slider are exchanged", |l| {
        controls(l, |c| {
            let [min, max] = [number(c, "min")?, number(c, "max")?];
            (c["min"], c["max"]) = (json!(max), json!(min));
            Some(())
        })
    }),
    kind("large-step", "a step is larger than the range", |l| {
        slider(l, "step", |c| Some(2.0 * (number(c, "max")? - number(c, "min")?)))
    }),
    kind("few-digits", "a slider shows fewer digits than its step has", |l| {
        slider(l, "digits", |c| (number(c, "step")?.fract() != 0.0).then_some(0.0))
    }),
    kind("value-forgotten", "statements of a control do not use `value`", |l| {
        controls(l, |c| {
            let value = number(c, "value")?;
            let text = c["apply"].as_str()?;
            c["apply"] = json!(text.replace("value", &value.to_string()));
            Some(())
        })
    }),
    kind("one-value-forgotten", "one of two statements does not use `value`", |l| {
        controls(l, |c| {
            let value = number(c, "value")?;
            let text = c["apply"].as_str()?;
            let last = text.rfind("value").filter(|at| text.find("value") != Some(*at))?;
            c["apply"] = json!(format!("{}{value}{}", &text[..last], &text[last + 5..]));
            Some(())
        })
    }),
    kind("dropped-statement", "one of two statements of a control is missing", |l| {
        controls(l, |c| {
            let text = c["apply"].as_str()?;
            let (first, _) = text.rsplit_once("; ").filter(|(_, last)| last.contains("value"))?;
            c["apply"] = json!(first);
            Some(())
        })
    }),
    kind("writes-elsewhere", "a control stores its value where nothing reads it", |l| {
        controls(l, |c| {
            number(c, "value")?;
            let key = ["set", "apply"].into_iter().find(|k| c[*k].is_string())?;
            let object = c.as_object_mut()?;
            object.shift_remove(key);
            object.insert("apply".into(), json!("ctx.chosen = value"));
            Some(())
        })
    }),
    kind("param-unread", "the name of a `param` is misspelt", |l| {
        text(l, &["controls", "*", "param"], |p| Some(format!("{p}_x")))
    }),
    kind("unused-element", "a control sets a parameter that has no effect", |l| {
        controls(l, |c| {
            number(c, "value")?;
            let object = c.as_object_mut()?;
            ["set", "apply", "param"].iter().for_each(|k| drop(object.shift_remove(*k)));
            object.insert("set".into(), json!("model.geom_friction[2]"));
            Some(())
        })
    }),
    kind("overwritten", "the controller overwrites what a control sets", |l| {
        let targets: Vec<String> = l["controls"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|c| c["set"].as_str().map(|t| format!("{t} = {}", c["value"])))
            .collect();
        let old = l["controller"].as_str().map_or(String::new(), |t| format!("{t}; "));
        targets.iter().flat_map(|t| with(l, "controller", json!(format!("{old}{t}")))).collect()
    }),
    kind("clamped", "half of a slider's range is cut off by its statements", |l| {
        controls(l, |c| {
            let middle = 0.5 * (number(c, "min")? + number(c, "max")?);
            let text = c["apply"]
                .as_str()
                .map(str::to_string)
                .or_else(|| Some(format!("{} = value", c["set"].as_str()?)))?;
            let object = c.as_object_mut()?;
            object.shift_remove("set");
            object
                .insert("apply".into(), json!(text.replace("value", &format!("Math.min(value, {middle})"))));
            Some(())
        })
    }),
    kind("does-nothing", "a control has no `set`, `apply` or `param`", |l| {
        controls(l, |c| {
            number(c, "value")?;
            let object = c.as_object_mut()?;
            ["set", "apply", "param"].iter().for_each(|k| drop(object.shift_remove(*k)));
            Some(())
        })
    }),
    kind("init-forgotten", "`init` is forgotten", |l| unset(l, "init")),
    kind("reset-forgotten", "`reset` is forgotten", |l| unset(l, "reset")),
    kind("no-setconst", "`mj_setConst` is forgotten", |l| {
        statements(l, |t| swap(t, "; mj.mj_setConst(model, data)", ""))
    }),
    kind("same-label", "two controls have the same label", |l| {
        each(l, &["controls"], |list| {
            let mut list = list.clone();
            let label = list.get(0)?["label"].clone();
            *list.get_mut(1)?.get_mut("label")? = label;
            Some(list)
        })
    }),
    kind("no-such-option", "a select starts with a value that it does not offer", |l| {
        controls(l, |c| {
            c["options"].as_array()?;
            c["value"] = json!(77);
            Some(())
        })
    }),
    kind("one-option-twice", "two options of a select have the same value", |l| {
        controls(l, |c| {
            let first = c["options"].get(0)?[1].clone();
            c["options"][1][1] = first;
            Some(())
        })
    }),
    kind("button-throws", "a button throws", |l| {
        text(l, &["controls", "*", "run"], |t| Some(format!("ctx.nothing.x = 1; {t}")))
    }),
    kind("button-idle", "a button changes nothing", |l| {
        text(l, &["controls", "*", "run"], |_| Some("ctx.pressed = 1".into()))
    }),
    kind("button-overwritten", "a button resets its own changes", |l| {
        text(l, &["controls", "*", "run"], |t| Some(format!("{t}; mj.mj_resetData(model, data)")))
    }),
];

/// Mistakes in the scene and its programs.
pub(super) const SCENES: [Kind; 18] = [
    kind("no-controller", "the controller is missing", |l| without(l, "controller")),
    kind("no-setup", "the setup is missing", |l| without(l, "setup")),
    kind("no-key", "the keyframe is missing", |l| without(l, "key")),
    kind("far-key", "the keyframe does not exist", |l| with(l, "key", json!(9))),
    kind("unknown-model", "the model is misspelt", |l| text(l, &["model"], |m| Some(format!("{m}s")))),
    kind("broken-xml", "the model in the lab is broken", |l| text(l, &["xml"], |x| swap(x, "</body>", ""))),
    kind("unknown-trail", "the site of the trail is misspelt", |l| {
        text(l, &["trail"], |s| Some(format!("{s}_")))
    }),
    kind("unknown-overlay", "an overlay is misspelt", |l| {
        text(l, &["toggles", "*"], |s| Some(s[1..].into()))
    }),
    kind("misspelt-key", "a key is misspelt", |l| {
        controls(l, |c| {
            let object = c.as_object_mut()?;
            let old = ["reset", "init", "step", "unit"].into_iter().find(|k| object.contains_key(*k))?;
            let value = object.shift_remove(old)?;
            object.insert(old.replace('t', "tt"), value);
            Some(())
        })
    }),
    kind("controller-throws", "the controller throws after a while", |l| {
        let old = l["controller"].as_str().map_or(String::new(), |t| format!("{t}; "));
        with(l, "controller", json!(format!("{old}if (data.time > 0.3) ctx.nothing.x = 1")))
    }),
    kind("long-step", "the timestep is fifty times too long", |l| setup(l, "model.opt.timestep = 0.1")),
    kind("negative-damping", "a damping is negative", |l| setup(l, "model.dof_damping.fill(-3)")),
    kind("no-gravity", "gravity is forgotten", |l| setup(l, "model.opt.gravity.fill(0)")),
    kind("solver-stops", "the solver may not iterate", |l| setup(l, "model.opt.iterations = 0")),
    kind("into-the-floor", "a body starts inside the floor", |l| {
        let free = ["ball_drop", "drop", "bounce", "cube_table", "incline"];
        let it = l["model"].as_str().is_some_and(|m| free.contains(&m)) || l["xml"].is_string();
        if it {
            setup(l, "data.qpos[2] -= 0.02 + 2 * (data.qpos[2] - data.geom_xpos[2]) / 2")
        } else {
            Vec::new()
        }
    }),
    without_forward(
        "stale-read",
        "statements read derived values of the state that they have just written",
        |l| {
            let mut all = setup(l, "data.qpos[0] += 0.3; ctx.begins = data.xpos[3] + data.xpos[5]");
            all.iter_mut().for_each(|l| {
                let readout = json!({"label": "begins at", "expr": "ctx.begins", "digits": 4});
                match l["readouts"].as_array_mut() {
                    Some(list) => list.push(readout),
                    None => l["readouts"] = json!([readout]),
                }
            });
            all
        },
    ),
    without_forward("stale-sensor", "statements read a sensor before it is computed", |l| {
        let model = l["model"].as_str().unwrap_or("");
        if !["arm2", "ball_drop", "cube_table", "gantry_gripper"].contains(&model) {
            return Vec::new();
        }
        let mut all = setup(l, "data.qpos[0] += 0.3; ctx.measured = data.sensordata[0]");
        all.iter_mut().for_each(|l| {
            let readout = json!({"label": "measured", "expr": "ctx.measured", "digits": 4});
            match l["readouts"].as_array_mut() {
                Some(list) => list.push(readout),
                None => l["readouts"] = json!([readout]),
            }
        });
        all
    }),
    kind("unheld-setpoint", "an input is far beyond its range all the time", |l| {
        if ["arm2", "gantry_gripper", "pendulum"].contains(&l["model"].as_str().unwrap_or("")) {
            let old = l["controller"].as_str().map_or(String::new(), |t| format!("{t}; "));
            return with(l, "controller", json!(format!("{old}data.ctrl[0] = 1000")));
        }
        Vec::new()
    }),
];
