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
const changed = body.replace('const data = new mj.MjData(model);', 'opt.change?.(model); const data = new mj.MjData(model); if (opt.change) mj.mj_setConst(model, data);');
if (changed === body) throw new Error('the oracle is not what it was');
const load = new Function('mj', 'lab', 'opt', 'fs', 'path', `${changed}\nreturn { model, data, sim, controls, controller, call, compile };`);

const BAD = [['badqpos', 3], ['badqvel', 4], ['badqacc', 5]];
const KINDS = ['inertia', 'contactfull', 'cnstrfull', 'badqpos', 'badqvel', 'badqacc', 'badctrl'];
function warnings(data, into) {
  const list = data.warning;
  KINDS.forEach((kind, i) => { const s = list.get(i); if (s.number && !into[kind]) into[kind] = s.number; s.delete(); });
}

// One run: what is done to the lab, a change of the model before it is loaded and one after it, so many seconds.
function run(lab, actions, { before, after, done } = {}, length, touch) {
  const it = load(mj, lab, { models, change: before }, fs, path), { model, data, sim, controls, controller, call, compile } = it;
  const act = (a) => { const c = controls.get(a.control); if (a.value === null) c.press(); else c.set(a.value); };
  actions.filter((a) => a.time <= 0).forEach(act);
  const push = (speed) => { const v = data.qvel; for (let k = 0; k < model.nv; k++) v[k] += speed; sim.forward(); };
  if (touch) push(touch);
  if (after) { after(model); sim.forward(); }
  const h = model.opt.timestep, steps = Math.round(length / h), found = {};
  const stores = [...(lab.plots ?? []).flatMap((p) => p.traces), ...(lab.readouts ?? [])].filter((p) => /\bctx\b[^;]*[^=!<>]=[^=>]/.test(p.expr)).map((p) => compile(`return (${p.expr});`));
  const pending = actions.filter((a) => a.time > 0), watch = new Watch(mj, model, data, !!controller);
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
    if (disturbed) { watch.growth?.restart(data); watch.limits.restart(data); disturbed = false; }
    mj.mj_step(model, data);
    made += 1;
    watch.growth?.look(data);
    watch.limits.look(data);
    if (data.time < before || made % 100 === 0 || made < 3 || made === steps) {
      warnings(data, found);
      if (BAD.some(([kind]) => found[kind])) { broke = before; break; }
    }
    sample();
  }
  const wrong = watch.all(broke), ways = watch.ways(), touching = [...watch.touching.values()].map((t) => t.geoms);
  const speeds = ways.map((v, b) => [b, v]), turns = new Map(watch.turns());
  const same = done ? done(model) : true;
  watch.free(); data.delete(); model.delete();
  return { warnings: found, wrong, touching, speeds, turns, threw, same };
}

// What creeps as fast where friction is hard is no fault of the contact.
function firm(lab, actions, length, touch, wrong) {
  if (!wrong.some((f) => f.kind === 'drift')) return wrong;
  const hard = run(lab, actions, { after: (m) => { m.opt.impratio *= 100; m.opt.cone = 1; for (let k = 0; k < m.nv; k++) m.dof_solimp[5 * k] = m.dof_solimp[5 * k + 1] = 1 - 0.01 * (1 - m.dof_solimp[5 * k + 1]); } }, length, touch);
  const speed = new Map(hard.speeds);
  const fast = (f) => (f.body === undefined ? hard.turns.get(f.joint) : speed.get(f.body)) ?? 0;
  return wrong.filter((f) => f.kind !== 'drift' || !(2 * fast(f) > f.value));
}

// What a margin changes, and what it is there.
function raised(margin) {
  const name = (i) => margin.who.match(/"[^"]*"|body \d+/g)?.[i] ?? '';
  const id = (m, type, i) => (name(i).startsWith('"') ? mj.mj_name2id(m, mj.mjtObj[type].value, name(i).replaceAll('"', '')) : Number(name(i).replace('body ', '')));
  const scale = (list, from, n, x) => { for (let k = from; k < from + n; k++) list[k] *= x; };
  const servo = (m) => { const a = id(m, 'mjOBJ_ACTUATOR', 0); return [a, 10 * a + (m.actuator_biasprm[10 * a + 1] ? 1 : 2)]; };
  if (margin.knob === 'timestep') return { apply: (m, x) => { m.opt.timestep *= x; }, read: (m) => m.opt.timestep };
  if (margin.knob === 'gain') return { apply: (m, x) => { const [a, k] = servo(m); m.actuator_gainprm[10 * a] *= x; m.actuator_biasprm[k] *= x; }, read: (m) => -m.actuator_biasprm[servo(m)[1]] };
  if (margin.knob === 'massRatio') {
    return { apply: (m, x) => { const b = id(m, 'mjOBJ_BODY', 0); m.body_mass[b] *= x; scale(m.body_inertia, 3 * b, 3, x); },
      read: (m) => m.body_mass[id(m, 'mjOBJ_BODY', 0)] / m.body_mass[id(m, 'mjOBJ_BODY', 1)], fixed: true };
  }
  if (margin.who === 'all contacts') {
    const apply = (m, x) => {
      m.opt.disableflags |= mj.mjtDisableBit.mjDSBL_REFSAFE.value;
      for (const list of [m.geom_solref, m.pair_solref]) for (let k = 0; k < list.length; k += 2) {
        if (list[k] > 0) list[k] /= Math.sqrt(x); else { list[k] *= x; list[k + 1] *= Math.sqrt(x); }
      }
    };
    const read = (m) => 1 / Math.min(...margin.geoms.map((g) => m.geom_solref[2 * g]).filter((t) => t > 0)) ** 2;
    return { apply, read };
  }
  if (margin.who.startsWith('joint')) return { apply: (m, x) => { m.jnt_stiffness[id(m, 'mjOBJ_JOINT', 0)] *= x; }, read: (m) => m.jnt_stiffness[id(m, 'mjOBJ_JOINT', 0)] };
  return { apply: (m, x) => { m.tendon_stiffness[id(m, 'mjOBJ_TENDON', 0)] *= x; }, read: (m) => m.tendon_stiffness[id(m, 'mjOBJ_TENDON', 0)] };
}

// Raised by a factor until it breaks, then bisection, as in crates/labspec/src/stability/search.rs.
function largest(most, factor, fine) {
  const MOST = 2 ** 20;
  let good = null, bad = null, at = 1;
  if (fine(1)) {
    good = 1;
    while (bad === null && at < Math.min(most, MOST)) { at = Math.min(factor * at, most, MOST); if (fine(at)) good = at; else bad = at; }
  } else {
    bad = 1;
    while (good === null && at > 1 / MOST) { at /= factor; if (fine(at)) good = at; else bad = at; }
  }
  while (good !== null && bad !== null && bad > good * 1.01) { const middle = Math.sqrt(good * bad); if (fine(middle)) good = middle; else bad = middle; }
  return { good, bad };
}

function search(lab, m, window, touch) {
  const { apply, read, fixed } = raised(m);
  let how = null;
  const fine = (x) => {
    const wanted = x * m.now, same = (model) => Math.abs(read(model) - wanted) <= 1e-9 * Math.abs(wanted);
    const before = (model) => apply(model, wanted / read(model)), after = fixed ? undefined : (model) => { if (!same(model)) apply(model, wanted / read(model)); };
    for (const speed of [0, touch]) {
      const seen = run(lab, [], { before, after, done: same }, window, speed);
      if (!seen.same) throw new Error(`${m.who} is not what it was set to`);
      const worst = seen.wrong.filter((f) => f.kind !== 'drift')[0];
      if (worst) { how = worst.kind; return false; }
    }
    return true;
  };
  const timestep = m.knob === 'timestep';
  const { good, bad } = largest(timestep ? Math.max(Math.min(1, window / 10) / m.now, 1) : Infinity, timestep ? 1.2 : 2, fine);
  return { knob: m.knob, who: m.who, now: m.now, largest: good && good * m.now, breaks: bad && bad * m.now, how: bad && how };
}

// A margin; where a touch that differs by a part of a billionth finds another one, the smallest and the largest that some touches find.
function margin(lab, m, window) {
  const found = search(lab, m, window, 1e-6), again = (k) => search(lab, m, window, 1e-6 + 1e-12 * k).largest;
  const list = [found.largest, again(1)];
  if (Math.abs(list[1] / list[0] - 1) > 0.03) {
    for (let k = 2; k <= 9; k++) list.push(again(k));
    found.spread = [Math.min(...list), Math.max(...list)];
  }
  return found;
}

// The labs: our own, files of the corpus, and blocks of the first lesson.
const here = path.dirname(fileURLToPath(import.meta.url)), corpus = path.join(opt.shared, 'corpus/labs');
const blocks = (file, name) => [...fs.readFileSync(file, 'utf8').matchAll(/```lab[^\n]*\n([\s\S]*?)```/g)].map((block, i) => ({ name: `${name}#${i + 1}`, target: `${file}#${i + 1}`, text: block[1] }));
const labs = [...blocks(path.join(here, 'labs.md'), 'labs.md'), ...blocks(path.join(here, '../twenty/labs.md'), 'twenty.md')];
for (const f of fs.readdirSync(corpus).filter((f) => f.endsWith('.json')).sort()) {
  labs.push({ name: f.replace('.json', ''), target: path.join(corpus, f), text: fs.readFileSync(path.join(corpus, f), 'utf8') });
}
labs.push(...blocks(path.join(opt.shared, 'lesson-0.1/lesson-0.1.md'), 'lesson-0.1.md'));

// Labs that say nothing of it are seen for ten seconds, and for five here.
const length = (target) => (target.startsWith(corpus) ? ['--until', '5'] : []);
const out = { version: mj.mj_versionString(), labs: [] };
for (const { name, target, text } of labs.filter((l) => !opt.only || opt.only.split(',').includes(l.name))) {
  const lab = JSON.parse(text), clock = Date.now();
  let ours;
  try { ours = execFileSync(labspec, ['stability', target, '--models', models, '--margins', ...length(target), '--format', 'json'], { maxBuffer: 1 << 28 }); }
  catch (e) { ours = e.stdout; }
  const report = JSON.parse(ours);
  const runs = report.runs.map((r) => {
    const touch = r.kind === 'withATouch' ? 1e-6 : 0, seen = run(lab, r.setting, {}, report.length, touch);
    const wrong = firm(lab, r.setting, report.length, touch, seen.wrong);
    return { kind: r.kind, setting: r.setting, warnings: seen.warnings, wrong: [...new Set(wrong.map((f) => f.kind))].sort(), threw: seen.threw };
  });
  const margins = report.margins.map((m) => margin(lab, m, report.window));
  out.labs.push({ lab: name, runs, margins });
  process.stderr.write(`${name}: ${runs.length} runs, ${margins.length} margins, ${((Date.now() - clock) / 1000).toFixed(0)} s\n`);
}
const line = (x) => JSON.stringify(x);
const list = (all) => all.map((x) => `   ${line(x)}`).join(',\n');
process.stdout.write(`{"version": ${line(out.version)}, "labs": [\n${out.labs.map((l) => ` {"lab": ${line(l.lab)},\n  "runs": [\n${list(l.runs)}],\n  "margins": [\n${list(l.margins)}]}`).join(',\n')}\n]}\n`);
