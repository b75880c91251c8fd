//! The examples of rules as files that can be checked.

use labspec_finding::Example;
use serde_json::json;

/// The model that the expressions and statements of examples are about: a free ball, an arm on a hinge with a motor.
pub const MODEL: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='2 2 .1'/>\
    <body name='ball' pos='0 0 1'><freejoint name='ball'/><geom name='ball' size='.1' mass='1'/></body>\
    <body name='arm' pos='1 0 1'><joint name='hinge' axis='0 1 0'/>\
    <geom name='arm' type='capsule' size='.02' fromto='0 0 0 0 0 -.5'/></body></worldbody>\
    <actuator><motor name='motor' joint='hinge'/></actuator>\
    <keyframe><key name='home' qpos='0 0 1 1 0 0 0 0'/></keyframe></mujoco>";

/// An example as files, by their names; the first is the one to check. A name that ends with `/` is a folder.
pub fn files(example: &Example) -> Vec<(String, Vec<u8>)> {
    let lab = match example {
        Example::Expression(_) | Example::Long(..) => {
            json!({"xml": MODEL, "readouts": [{"label": "shown", "expr": example.text()}]})
        }
        Example::Statements(text) => json!({"xml": MODEL, "stopAt": 0.1, "controller": text}),
        Example::Target(text) => {
            json!({"xml": MODEL, "controls": [{"label": "set", "min": 0, "max": 1, "value": 0, "set": text, "init": true}]})
        }
        Example::Files(files) => {
            return files.iter().map(|(name, bytes)| ((*name).to_string(), bytes.to_vec())).collect();
        }
        _ => return vec![(example.name().to_string(), example.text().into_bytes())],
    };
    vec![(example.name().to_string(), format!("```lab simlab\n{lab}\n```\n").into_bytes())]
}
