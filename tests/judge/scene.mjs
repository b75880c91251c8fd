// A lab on the real library, in the exact order of events of the lab format, with what its texts may use.
import { byName } from './named.mjs';

const KINDS = 7; // inertia, contactfull, cnstrfull, badqpos, badqvel, badqacc, badctrl
const BAD = ['badqpos', 'badqvel', 'badqacc'];

export function scene(mj, task) {
  const { lab } = task;
  const model = mj.MjModel.from_xml_string(task.xml);
  if (!model) throw new Error('the model does not load');
  const data = new mj.MjData(model), ctx = {};
  mj.mj_forward(model, data);

  byName(mj, model, data);
  const id = (type, name) => mj.mj_name2id(model, mj.mjtObj[type].value, name);
  const nameOf = (type, i) => mj.mj_id2name(model, mj.mjtObj[type].value, i);
  const geom = (name) => { const i = id('mjOBJ_GEOM', name); if (i < 0) throw new Error(`no geom ${name}`); return i; };
  const filled = (n, fill) => { const b = new mj.DoubleBuffer(n); try { fill(b); return Array.from(b.GetView()); } finally { b.delete(); } };
  const each = (list, f) => { for (let i = 0; i < list.size(); i++) { const c = list.get(i); try { f(c, i); } finally { c.delete(); } } };
  const eachContact = (f) => { const list = data.contact; try { each(list, f); } finally { list.delete(); } };
  const contacts = () => {
    const out = [];
    eachContact((c, i) => {
      const force = filled(6, (b) => mj.mj_contactForce(model, data, i, b));
      out.push({ geom1: c.geom1, geom2: c.geom2, dist: c.dist, pos: Array.from(c.pos), frame: Array.from(c.frame), dim: c.dim, force,
        friction: Array.from(c.friction), solref: Array.from(c.solref), solimp: Array.from(c.solimp), margin: c.includemargin, active: c.efc_address >= 0 ? 1 : 0 });
    });
    return out;
  };
  const touching = () => { const out = []; eachContact((c) => out.push([c.geom1, c.geom2])); return out; };
  const reset = () => {
    if (lab.key !== null && lab.key < model.nkey) mj.mj_resetDataKeyframe(model, data, lab.key); else mj.mj_resetData(model, data);
    mj.mj_forward(model, data);
  };
  const sim = {
    mj, model, data, paused: false, get time() { return data.time; }, get timestep() { return model.opt.timestep; },
    forward() { mj.mj_forward(model, data); }, play() {}, pause() {}, toggle() {}, reset, contacts,
    energy() {
      const bit = mj.mjtEnableBit.mjENBL_ENERGY.value;
      if (!(model.opt.enableflags & bit)) { model.opt.enableflags |= bit; mj.mj_forward(model, data); }
      return { potential: data.energy[0], kinetic: data.energy[1], total: data.energy[0] + data.energy[1] };
    },
  };
  const xyz = (a, i) => [a[3 * i], a[3 * i + 1], a[3 * i + 2]];
  const lib = {
    sitePos: (n) => xyz(data.site_xpos, id('mjOBJ_SITE', n)), bodyPos: (n) => xyz(data.xpos, id('mjOBJ_BODY', n)),
    bodyId: (n) => id('mjOBJ_BODY', n), jointId: (n) => id('mjOBJ_JOINT', n), qpos: (n) => data.qpos[model.jnt_qposadr[id('mjOBJ_JOINT', n)]],
    energy: () => sim.energy(), norm: (v) => Math.hypot(...v), deg: (r) => (r * 180) / Math.PI, rad: (d) => (d * Math.PI) / 180,
    normalForce: (n = null) => { const g = n ? id('mjOBJ_GEOM', n) : -1; return contacts().reduce((s, c) => s + (g < 0 || c.geom1 === g || c.geom2 === g ? c.force[0] : 0), 0); },
    contactPairs: () => { const label = (g) => nameOf('mjOBJ_GEOM', g) || nameOf('mjOBJ_BODY', model.geom_bodyid[g]); return contacts().map((c) => `${label(c.geom1)} / ${label(c.geom2)}`); },
    jacobian: (n, cols = null) => {
      const nv = model.nv, p = new mj.DoubleBuffer(3 * nv), r = new mj.DoubleBuffer(3 * nv);
      mj.mj_jacSite(model, data, p, r, id('mjOBJ_SITE', n));
      const [P, R] = [p, r].map((b) => { const list = Array.from(b.GetView()); b.delete(); return list; });
      return [P, R].flatMap((A) => [0, 1, 2].map((i) => A.slice(i * nv, i * nv + (cols ?? nv))));
    },
    jacobianSV: (n, { cols = null, rows = 'full' } = {}) => {
      let J = lib.jacobian(n, cols); if (rows === 'pos') J = J.slice(0, 3);
      return eigenvalues(J.map((a) => J.map((b) => a.reduce((s, v, k) => s + v * b[k], 0)))).map((e) => Math.sqrt(Math.max(e, 0))).reverse();
    },
    massMatrix: () => {
      const nv = model.nv;
      mj.mj_forward(model, data);
      const v = filled(nv * nv, (b) => mj.mj_fullM(model, data, b));
      return Array.from({ length: nv }, (_, i) => v.slice(i * nv, i * nv + nv));
    },
  };
  const own = {
    abs: Math.abs,
    contact: (a, b) => {
      const [g, h] = [geom(a), b === undefined ? null : geom(b)];
      return touching().some((pair) => pair.includes(g) && (h === null || (h !== g && pair.includes(h))));
    },
    shown: (label) => {
      const found = shown.find(([known]) => known === label);
      if (!found) throw new ReferenceError(`nothing is shown as ${label}`);
      let x;
      try { x = call(found[1]); } catch { return undefined; }
      return found[2] !== null && typeof x === 'number' && Number.isFinite(x) ? Number(printed(x, found[2])) : x;
    },
    mixed: (a, b) => {
      const pair = [geom(a), geom(b)], own = contacts().filter((c) => pair.includes(c.geom1) && pair.includes(c.geom2) && c.geom1 !== c.geom2);
      const none = (n) => Array(n).fill(NaN);
      return own.sort((c, d) => c.dist - d.dist)[0] ?? { dim: NaN, friction: none(5), solref: none(2), solimp: none(5), margin: NaN, dist: NaN, pos: none(3), frame: none(9), active: NaN, force: none(6) };
    },
    eigenvalues: (rows) => {
      const list = Array.from(rows), n = Math.round(Math.sqrt(list.length));
      return eigenvalues(typeof list[0] === 'number' ? Array.from({ length: n }, (_, i) => list.slice(i * n, i * n + n)) : list.map((r) => Array.from(r)));
    },
  };
  const names = ['model', 'data', 'sim', 'mj', 'ctx', 'lib', ...Object.keys(own)], values = [model, data, sim, mj, ctx, lib, ...Object.values(own)];
  const compile = (body, ...extra) => new Function(...names, ...extra, `"use strict"; ${body}`);
  const call = (f, value) => f(...values, value);
  const shown = lab.shown.map(([label, expr, digits]) => [label, compile(`return (${expr});`), digits]);

  // Warnings are counted over resets, which forget them.
  let banked = Array(KINDS).fill(0), before = Array(KINDS).fill(0), broke = null, threw = null;
  const count = () => { const now = []; each(data.warning, (w, i) => { if (i < KINDS) now.push(w.number); }); return now; };
  const note = (rewound) => {
    const now = count();
    if (rewound) banked = banked.map((n, i) => n + before[i]);
    before = now;
    BAD.forEach((kind, i) => { if (now[3 + i] && !broke) broke = `${kind} at t = ${Number(data.time.toPrecision(6))} s`; });
  };

  // The lab is loaded.
  if (lab.key !== null) reset();
  const controls = new Map(), again = [];
  for (const c of lab.controls) {
    if (c.run !== undefined) { const run = compile(`${c.run};`); controls.set(c.label, { press() { call(run); mj.mj_forward(model, data); } }); continue; }
    const act = c.set ? compile(`${c.set} = value;`, 'value') : c.apply ? compile(`${c.apply};`, 'value') : null, state = { value: c.value };
    const put = (v) => { state.value = v; if (c.param) ctx[c.param] = v; if (act) call(act, v); };
    put(c.value);
    if (c.init && act) again.push(() => call(act, state.value));
    controls.set(c.label, { set(v) { put(v); if (c.reset) { reset(); again.forEach((f) => f()); } mj.mj_forward(model, data); } });
  }
  if (lab.setup) { const setup = compile(`${lab.setup};`); again.unshift(() => call(setup)); }
  again.forEach((f) => f());
  mj.mj_forward(model, data);
  const controller = lab.controller ? compile(`${lab.controller};`) : null;
  // Then the run: a timestep that it writes into the model counts, its controls, its setup.
  if (task.timestep !== null) model.opt.timestep = task.timestep;
  for (const [label, value] of task.set) controls.get(label).set(value);
  if (task.setup) { call(compile(`${task.setup};`)); mj.mj_forward(model, data); }

  return {
    data, names, values, compile, call,
    // Samples at the start and after every step; it ends where `sample` says so.
    run(sample) {
      const pending = task.press.slice().sort((a, b) => a[1] - b[1]);
      const press = () => { while (pending.length && data.time >= pending[0][1] - 1e-12) controls.get(pending.shift()[0]).press(); };
      const steps = task.steps ?? Math.floor(task.until / model.opt.timestep + 0.5), end = task.stopAt ?? null;
      // A run that the lab ends goes on until its time, which a program may reset, but no longer than labspec's.
      const most = end === null ? steps : 20 * steps;
      const isOver = (made) => (broke !== null && made >= steps)
        || (end !== null && data.time >= end - 1e-9 * model.opt.timestep - made * Number.EPSILON * Math.abs(end));
      press();
      note(false);
      if (sample()) return;
      for (let i = 0; i < most; i++) {
        press();
        if (controller) try { call(controller); } catch (e) { threw = `the controller threw: ${e.message}`; return; }
        const time = data.time;
        mj.mj_step(model, data);
        if (data.time < time || i % 100 === 99) note(data.time < time);
        if (sample() || isOver(i + 1)) return;
      }
    },
    warnings: () => { note(false); return banked.reduce((s, n, i) => s + n + before[i], 0); },
    broke: () => threw ?? broke,
    free() { data.delete(); model.delete(); },
  };
}

// A number as the page prints it: fixed decimals, exponential when small or large.
function printed(x, digits) {
  const size = Math.abs(x);
  return size !== 0 && (size < 1e-3 || size >= 1e5) ? x.toExponential(2) : x.toFixed(digits);
}

// Of a symmetric matrix, the smallest first: plane rotations until nothing is left beside the diagonal (Jacobi 1846).
function eigenvalues(A) {
  const n = A.length, M = A.map((row) => row.slice());
  for (let sweep = 0; sweep < 100; sweep++) {
    let off = 0;
    for (let p = 0; p < n; p++) for (let q = p + 1; q < n; q++) off += M[p][q] ** 2;
    if (off < 1e-30) break;
    for (let p = 0; p < n; p++) for (let q = p + 1; q < n; q++) {
      if (Math.abs(M[p][q]) < 1e-300) continue;
      const theta = (M[q][q] - M[p][p]) / (2 * M[p][q]), t = (Math.sign(theta) || 1) / (Math.abs(theta) + Math.sqrt(theta * theta + 1));
      const c = 1 / Math.sqrt(t * t + 1), s = t * c;
      for (let k = 0; k < n; k++) { const [a, b] = [M[k][p], M[k][q]]; M[k][p] = c * a - s * b; M[k][q] = s * a + c * b; }
      for (let k = 0; k < n; k++) { const [a, b] = [M[p][k], M[q][k]]; M[p][k] = c * a - s * b; M[q][k] = s * a + c * b; }
    }
  }
  return M.map((row, i) => row[i]).sort((a, b) => a - b);
}
