#!/usr/bin/env node
// What the real library makes of the labs of ../shared in every run that `labspec stability --margins` makes of them: the reference of
// tests/under_hands.rs. JavaScript evaluates the labs, as in ../shared/oracle/lab_oracle.mjs, whose text is used for that.
//
//   npm install @mujoco/mujoco@3.14.0
//   node theirs.mjs LABSPEC --mujoco NODE_MODULES [--shared ../../../shared] [--only NAME,NAME] > ../golden/stability_labs.json
//
// For each lab: every run by its settings, with the warnings that the library raised and what goes wrong by our criteria (watch.mjs); and
// for each margin the largest value that is fine, searched as ours is, with runs of the library.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { Watch } from './watch.mjs';

const args = process.argv.slice(2), labspec = path.resolve(args.shift());
const opt = { mujoco: '.', shared: path.join(path.dirname(fileURLToPath(import.meta.url)), '../../../shared'), only: '' };
while (args.length) { const key = args.shift().replace(/^--/, ''); opt[key] = args.shift(); }
const entry = pathToFileURL(path.resolve(opt.mujoco, '@mujoco/mujoco/mujoco.js')).href;
const mj = await (await import(entry)).default();
const models = path.join(opt.shared, 'corpus/models');

// The oracle up to where it begins to run: a fresh model, data, and the controls as functions.
const text = fs.readFileSync(path.join(opt.shared, 'oracle/lab_oracle.mjs'), 'utf8');
const body = text.slice(text.indexOf('function mountModels'), text.indexOf('for (const s of opt.set)'));
const load = new Function('mj', 'lab', 'opt', 'fs', 'path', `${body}\nreturn { model, data, sim, controls, controller, call, compile };`);

const BAD = [['badqpos', 3], ['badqvel', 4], ['badqacc', 5]];
const KINDS = ['inertia', 'contactfull', 'cnstrfull', 'badqpos', 'badqvel', 'badqacc', 'badctrl'];
function warnings(data, into) {
  const list = data.warning;
  KINDS.forEach((kind, i) => { const s = list.get(i); if (s.number && !into[kind]) into[kind] = s.number; s.delete(); });
}

// One run: what is done to the lab, a change of the model, so many seconds.
function run(lab, actions, change, length, touch) {
  const it = load(mj, lab, { models }, fs, path), { model, data, sim, controls, controller, call, compile } = it;
  const act = (a) => { const c = controls.get(a.control); if (a.value === null) c.press(); else c.set(a.value); };
  actions.filter((a) => a.time <= 0).forEach(act);
  const push = (speed) => { const v = data.qvel; for (let k = 0; k < model.nv; k++) v[k] += speed; sim.forward(); };
  if (change) change(model, data);
  if (change || touch) push(touch);
  const h = model.opt.timestep, steps = Math.round(length(h) / h), found = {};
  const stores = [...(lab.plots ?? []).flatMap((p) => p.traces), ...(lab.readouts ?? [])].filter((p) => /\bctx\b[^;]*[^=!<>]=[^=>]/.test(p.expr)).map((p) => compile(`return (${p.expr});`));
  const pending = actions.filter((a) => a.time > 0), watch = new Watch(mj, model, data, steps, !!controller);
  let made = 0, disturbed = false, broke = Infinity;
  const sample = () => {
    let now = made === 0;
    while (pending.length && data.time >= pending[0].time - 1e-12) { warnings(data, found); act(pending.shift()); now = true; disturbed = true; }
    stores.forEach((f) => { try { call(f); } catch { /* shown as nothing */ } });
    if (now) watch.disturb(data); else watch.look(data);
  };
  sample();
  let threw = false;
  while (made < steps) {
    const before = data.time;
    if (controller) try { call(controller); } catch { threw = true; break; }
    if (disturbed) { watch.growth?.restart(data); disturbed = false; }
    mj.mj_step(model, data);
    made += 1;
    watch.growth?.look(data);
    if (data.time < before || made % 100 === 0 || made < 3 || made === steps) {
      warnings(data, found);
      if (BAD.some(([kind]) => found[kind])) { broke = before; break; }
    }
    sample();
  }
  const wrong = watch.all(broke), ways = watch.ways(), touching = [...watch.touching.values()].map((t) => t.geoms);
  const speeds = ways.map((v, b) => [b, v]);
  watch.free(); data.delete(); model.delete();
  return { warnings: found, wrong, covered: made === steps ? length(h) : made * h, touching, speeds, threw };
}

// What creeps as fast where friction is hard is no fault of the contact.
function firm(lab, actions, length, touch, wrong) {
  if (!wrong.some((f) => f.kind === 'drift')) return wrong;
  const hard = run(lab, actions, (m) => { m.opt.impratio *= 100; m.opt.cone = 1; }, length, touch);
  const speed = new Map(hard.speeds);
  return wrong.filter((f) => f.kind !== 'drift' || !(2 * (speed.get(f.body) ?? 0) > f.value));
}

// The change of a margin.
function raised(margin) {
  const name = (i) => margin.who.match(/"[^"]*"|body \d+/g)?.[i]?.replaceAll('"', '') ?? '';
  const id = (m, type, i) => mj.mj_name2id(m, mj.mjtObj[type].value, name(i));
  const scale = (list, from, n, x) => { for (let k = from; k < from + n; k++) list[k] *= x; };
  return (m, d, x) => {
    if (margin.knob === 'timestep') m.opt.timestep *= x;
    else if (margin.knob === 'gain') { const a = id(m, 'mjOBJ_ACTUATOR', 0); m.actuator_gainprm[10 * a] *= x; m.actuator_biasprm[10 * a + (m.actuator_biasprm[10 * a + 1] ? 1 : 2)] *= x; }
    else if (margin.knob === 'massRatio') { const b = id(m, 'mjOBJ_BODY', 0); m.body_mass[b] *= x; scale(m.body_inertia, 3 * b, 3, x); }
    else if (margin.who === 'all contacts') {
      m.opt.disableflags |= mj.mjtDisableBit.mjDSBL_REFSAFE.value;
      for (const list of [m.geom_solref, m.pair_solref]) for (let k = 0; k < list.length; k += 2) {
        if (list[k] > 0) list[k] /= Math.sqrt(x); else { list[k] *= x; list[k + 1] *= Math.sqrt(x); }
      }
    } else if (margin.who.startsWith('joint')) m.jnt_stiffness[id(m, 'mjOBJ_JOINT', 0)] *= x;
    else m.tendon_stiffness[id(m, 'mjOBJ_TENDON', 0)] *= x;
    mj.mj_setConst(m, d);
  };
}

// Doubled until it breaks, then bisection, as in crates/labspec/src/stability/search.rs.
function largest(most, fine) {
  let good = null, bad = null, at = 1;
  if (fine(1)) {
    good = 1;
    for (let k = 0; k < 20 && Math.min(2 * at, most) > at; k++) { at = Math.min(2 * at, most); if (!fine(at)) { bad = at; break; } good = at; }
  } else {
    bad = 1;
    for (let k = 0; k < 20; k++) { at *= 0.5; if (fine(at)) { good = at; break; } bad = at; }
  }
  while (good !== null && bad !== null && bad > good * 1.01) { const middle = Math.sqrt(good * bad); if (fine(middle)) good = middle; else bad = middle; }
  return { good, bad };
}

function search(lab, m, window, touch) {
  const apply = raised(m);
  let how = null;
  const fine = (x) => {
    const change = (model, data) => apply(model, data, x);
    const seen = run(lab, [], change, (h) => Math.max(window, m.knob === 'timestep' ? 300 * h : 0), touch);
    const worst = seen.wrong.filter((f) => f.kind !== 'drift')[0];
    if (worst) how = worst.kind;
    return !worst;
  };
  const { good, bad } = largest(m.knob === 'timestep' ? Math.max(1 / m.now, 1) : Infinity, fine);
  return { knob: m.knob, who: m.who, now: m.now, largest: good && good * m.now, breaks: bad && bad * m.now, how: bad && how };
}

// A margin; where a touch that differs by a billionth of a unit finds another one, the smallest and the largest that 25 touches find.
function margin(lab, m, window) {
  const found = search(lab, m, window, 1e-3), again = (k) => search(lab, m, window, 1e-3 + 1e-9 * k).largest;
  const list = [found.largest, again(1)];
  if (Math.abs(list[1] / list[0] - 1) > 0.03) {
    for (let k = 2; k <= 24; k++) list.push(again(k));
    found.spread = [Math.min(...list), Math.max(...list)];
  }
  return found;
}

// The labs: our own, files of the corpus, and blocks of the first lesson.
const here = path.dirname(fileURLToPath(import.meta.url)), corpus = path.join(opt.shared, 'corpus/labs');
const blocks = (file, name) => [...fs.readFileSync(file, 'utf8').matchAll(/```lab[^\n]*\n([\s\S]*?)```/g)].map((block, i) => ({ name: `${name}#${i + 1}`, target: `${file}#${i + 1}`, text: block[1] }));
const labs = blocks(path.join(here, 'labs.md'), 'labs.md');
for (const f of fs.readdirSync(corpus).filter((f) => f.endsWith('.json')).sort()) {
  labs.push({ name: f.replace('.json', ''), target: path.join(corpus, f), text: fs.readFileSync(path.join(corpus, f), 'utf8') });
}
labs.push(...blocks(path.join(opt.shared, 'lesson-0.1/lesson-0.1.md'), 'lesson-0.1.md'));

const out = { version: mj.mj_versionString(), labs: [] };
for (const { name, target, text } of labs.filter((l) => !opt.only || opt.only.split(',').includes(l.name))) {
  const lab = JSON.parse(text), clock = Date.now();
  let ours;
  try { ours = execFileSync(labspec, ['stability', target, '--models', models, '--margins', '--format', 'json'], { maxBuffer: 1 << 28 }); }
  catch (e) { ours = e.stdout; }
  const report = JSON.parse(ours);
  const runs = report.runs.map((r) => {
    const touch = r.kind === 'withATouch' ? 1e-6 : 0, seen = run(lab, r.setting, null, () => report.length, touch);
    const wrong = firm(lab, r.setting, () => report.length, touch, seen.wrong);
    return { kind: r.kind, setting: r.setting, warnings: seen.warnings, wrong: [...new Set(wrong.map((f) => f.kind))].sort(), threw: seen.threw };
  });
  const margins = report.margins.map((m) => margin(lab, m, report.sensitivity.length));
  out.labs.push({ lab: name, runs, margins });
  process.stderr.write(`${name}: ${runs.length} runs, ${margins.length} margins, ${((Date.now() - clock) / 1000).toFixed(0)} s\n`);
}
const line = (x) => JSON.stringify(x);
const list = (all) => all.map((x) => `   ${line(x)}`).join(',\n');
process.stdout.write(`{"version": ${line(out.version)}, "labs": [\n${out.labs.map((l) => ` {"lab": ${line(l.lab)},\n  "runs": [\n${list(l.runs)}],\n  "margins": [\n${list(l.margins)}]}`).join(',\n')}\n]}\n`);
