#!/usr/bin/env node
// The real library as a second judge: makes the runs that labspec asks for, takes their measures, and records them. JavaScript itself
// evaluates every text of a lab; what the measures mean is written in docs/verify.md, and here a second time.
//
//   npm install @mujoco/mujoco@3.14.0
//   labspec check LESSONS --judge-request request.json
//   node record.mjs request.json --mujoco NODE_MODULES [--models DIR] > judge.json
//   labspec check LESSONS --judge judge.json
//
// With `--python PYTHON` in the place of --mujoco it is the library of that interpreter (pip install mujoco), whatever its version.
// What cannot be taken (a function that is not known here, a model that does not load) is recorded with its reason, and counted on
// standard error. --models is the folder of the files that models name: meshes, height fields, attached models.
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { measure } from './measures.mjs';
import { pythonLibrary } from './python.mjs';
import { scene } from './scene.mjs';

const args = process.argv.slice(2), file = args.shift(), opt = { mujoco: '.', python: null, models: null };
while (args.length) { const key = args.shift().replace(/^--/, ''); opt[key] = args.shift(); }
if (!file) { process.stderr.write('node record.mjs REQUEST (--mujoco NODE_MODULES | --python PYTHON) [--models DIR]\n'); process.exit(2); }
const request = JSON.parse(fs.readFileSync(file, 'utf8'));
if (request.request !== 'judge' || request.version !== 1) { process.stderr.write(`${file} is no request of --judge-request\n`); process.exit(2); }
const javascript = async () => (await import(pathToFileURL(path.resolve(opt.mujoco, '@mujoco/mujoco/mujoco.js')).href)).default({ print: () => {}, printErr: () => {} });
let mj;
try { mj = opt.python ? pythonLibrary(opt.python, opt.models) : await javascript(); } catch (e) { process.stderr.write(`${e.message}\n`); process.exit(2); }

// Files that models name lie where the library looks for them.
if (!opt.python) (function mount(from, to) {
  if (!from) return;
  for (const e of fs.readdirSync(from, { withFileTypes: true })) {
    const [a, b] = [path.join(from, e.name), `${to}/${e.name}`];
    if (e.isDirectory()) { try { mj.FS.mkdir(b); } catch { /* it is there */ } mount(a, b); } else if (e.isFile()) mj.FS.writeFile(b, fs.readFileSync(a));
  }
})(opt.models, '');

// One run: values of its measures, warnings, and what broke.
function make(task) {
  const s = scene(mj, task);
  try {
    const measures = task.measures.map(([name, text]) => [name, attempt(() => measure(text, s.names))]);
    const expressions = task.expressions.map((text) => [text, attempt(() => measure(text, [...s.names, ...task.measures.map(([name]) => name)]))]);
    const all = [...measures, ...expressions], stop = task.stop ? s.compile(`return (${task.stop});`) : null;
    const sample = () => {
      for (const [, m] of all) if (!m.refused) attempt(() => m.sample(s.values, s.data.time), m);
      try { return stop && s.call(stop); } catch { return false; }
    };
    s.run(sample);
    const values = {}, refused = {}, nan = {};
    const keep = (name, m, extra) => {
      const x = m.refused ? null : attempt(() => ({ x: m.finish([...s.values, ...extra]) }), m);
      if (m.refused) refused[name] = m.refused; else values[name] = Number.isFinite(x.x) ? x.x : String(x.x);
      if (values[name] === 'NaN') nan[name] = m.absent();
    };
    measures.forEach(([name, m]) => keep(name, m, []));
    const known = task.measures.map(([name]) => (name in values ? Number(values[name]) : NaN));
    expressions.forEach(([text, m]) => keep(text, m, known));
    return { values, refused, nan, warnings: s.warnings(), broke: s.broke() };
  } finally { s.free(); }
}

// What is not known here is no value; what throws while it runs is none either, as in JavaScript.
function attempt(f, m) {
  try { return f(); } catch (e) { if (m) { m.refused = e.message; return { x: NaN }; } return { refused: e.message }; }
}

const engine = `MuJoCo ${mj.mj_versionString()}`, done = new Map(), runs = [];
let taken = 0, not = 0;
for (const { file, claim, run, hash, task, refused } of request.runs) {
  if (!task) { process.stderr.write(`${file}, ${claim}, ${run}: ${refused}\n`); not += 1; continue; }
  if (!done.has(hash)) {
    let made;
    try { made = make(task); } catch (e) {
      const why = `the run cannot be made: ${typeof e === 'number' ? 'the library gave up' : e.message}`.slice(0, 300);
      made = { values: {}, refused: Object.fromEntries([...task.measures.map(([n]) => n), ...task.expressions].map((n) => [n, why])), warnings: 0, broke: null };
    }
    done.set(hash, made);
  }
  const made = done.get(hash);
  taken += Object.keys(made.values).length; not += Object.keys(made.refused).length;
  for (const [name, why] of Object.entries(made.refused)) process.stderr.write(`${file}, ${claim}, ${run}, ${name}: ${why}\n`);
  const one = { file, claim, run, hash, values: made.values };
  if (Object.keys(made.refused).length) one.refused = made.refused;
  if (made.nan && Object.keys(made.nan).length) one.nan = made.nan;
  if (made.warnings) one.warnings = made.warnings;
  if (made.broke) one.broke = made.broke;
  runs.push(one);
}
process.stderr.write(`${engine}: ${runs.length} runs, ${taken} measures taken, ${not} not\n`);
process.stdout.write(`{"recording": "judge", "version": 1, "engine": ${JSON.stringify(engine)}, "runs": [\n${runs.map((r) => ` ${JSON.stringify(r)}`).join(',\n')}\n]}\n`);
