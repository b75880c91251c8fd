// A lesson checked from memory: no file is opened.
import { Checker } from "labspec/checker";

const lesson = `
The bob falls for 0.43 s.
\`\`\`lab
{"model": "drop", "readouts": [{"label": "height (m)", "expr": "data.body('bop').xpos[2]"}],
 "verify": {"runs": {"fall": {"until": 1}}, "measure": {"touch": "first(data.ncon > 0)"},
            "says": [["0.43 s", "touch"]]}}
\`\`\`
`;
const drop = `<mujoco><worldbody><geom type='plane' size='1 1 1'/>
  <body name='bob' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>`;

const report = new Checker({ drop }).check("fall.md", lesson);
for (const { file, line, column, severity, code, message } of report.findings) {
  console.log(`${file}:${line}:${column}: ${severity}[${code}]: ${message}`);
}
for (const { owner, subject, word } of report.entries) console.log(`${owner}: ${subject}, ${word}`);
