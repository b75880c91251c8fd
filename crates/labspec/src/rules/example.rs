//! Converts the examples of rules to files that can be checked.

/// The model that the expressions and statements of examples use: a free ball, an arm on a hinge with a motor.
pub const MODEL: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='2 2 .1'/>\
    <body name='ball' pos='0 0 1'><freejoint name='ball'/><geom name='ball' size='.1' mass='1'/></body>\
    <body name='arm' pos='1 0 1'><joint name='hinge' axis='0 1 0'/>\
    <geom name='arm' type='capsule' size='.02' fromto='0 0 0 0 0 -.5'/></body></worldbody>\
    <actuator><motor name='motor' joint='hinge'/></actuator>\
    <keyframe><key name='home' qpos='0 0 1 1 0 0 0 0'/></keyframe></mujoco>";

/// A lab with a falling ball, and a snapshot of its displays.
pub(super) const FALL: &[u8] = br#"{"xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>", "stopAt": 0.2, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}]}"#;
pub(super) const STORED: &[u8] = br##"labspec snapshot 1

lab "#1" "A fall"
run as it stands
  0.2 s, timestep 0.002 s, Euler, Newton, pyramidal
  time                   0  0.02  0.04  0.06  0.08   0.1  0.12  0.14  0.16  0.18   0.2
  "readout/height (m)"   1     1     1  0.98  0.97  0.95  0.93   0.9   0.9   0.8   0.8

end of 1 labs
"##;

#[cfg(feature = "docs")]
pub use files::{files, marked};

#[cfg(feature = "docs")]
mod files {
    use super::MODEL;
    use labspec_finding::Example;
    use serde_json::{Value, json};
    use std::ops::Range;

    /// The files of an example, by name. The first one is checked. A name that ends with `/` is a folder.
    pub fn files(example: &Example) -> Vec<(String, Vec<u8>)> {
        let lab = match example {
            Example::Expression(_) | Example::Long(..) => {
                json!({"xml": MODEL, "readouts": [{"label": "shown", "expr": example.text()}]})
            }
            Example::Statements(_) => json!({"xml": MODEL, "stopAt": 0.1, "controller": example.text()}),
            Example::Files(files) => {
                let others = files.iter().skip(1).map(|(name, bytes)| ((*name).to_string(), bytes.to_vec()));
                return std::iter::once((example.name().to_string(), example.bytes()))
                    .chain(others)
                    .collect();
            }
            _ => return vec![(example.name().to_string(), example.bytes())],
        };
        vec![(example.name().to_string(), format!("```lab simlab\n{lab}\n```\n").into_bytes())]
    }

    /// The byte range in the first file of an example at which its rule reports. `None` if the example does not mark one.
    pub fn marked(example: &Example) -> Option<Range<usize>> {
        let mark = example.marked()?;
        match example {
            Example::Expression(_) | Example::Statements(_) | Example::Long(..) => {
                // The code is in a JSON string, which escapes some characters.
                let code = example.text();
                let (_, file) = files(example).into_iter().next()?;
                let file = String::from_utf8(file).ok()?;
                let json = |text: &str| Value::from(text).to_string();
                let start = file.find(&json(&code))?;
                let place = |offset: usize| Some(start + json(code.get(..offset)?).len() - 1);
                Some(place(mark.start)?..place(mark.end)?)
            }
            _ => Some(mark),
        }
    }
}
