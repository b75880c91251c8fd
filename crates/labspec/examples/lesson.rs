//! Checks a lesson in memory, without opening a file.

use labspec::Checker;
use std::convert::Infallible;

const LESSON: &str = r#"
The bob falls for 0.43 s.
```lab
{"model": "drop", "readouts": [{"label": "height (m)", "expr": "data.body('bop').xpos[2]"}],
 "verify": {"runs": {"fall": {"until": 1}}, "measure": {"touch": "first(data.ncon > 0)"},
            "says": [["0.43 s", "touch"]]}}
```
"#;
const DROP: &str = "<mujoco><worldbody><geom type='plane' size='1 1 1'/>
  <body name='bob' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>";

pub(crate) fn main() -> Result<(), Infallible> {
    print!("{}", lesson());
    Ok(())
}

/// The findings, and the state of every claim.
pub(crate) fn lesson() -> String {
    let report =
        Checker::new(|name: &str| (name == "drop").then(|| DROP.to_string())).check("fall.md", LESSON);
    let findings = report.findings.iter().map(|f| format!("{f}\n"));
    let claims =
        report.entries().iter().map(|e| format!("{}: {}, {}\n", e.owner, e.subject.as_str(), e.word));
    findings.chain(claims).collect()
}
