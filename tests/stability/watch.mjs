// What goes wrong in a run of the real library, by the same criteria as ours (crates/labspec/src/stability and advice/growth), written
// once more over the library's own numbers.

const rows = (list, i, n) => Array.from(list.subarray(n * i, n * i + n));
const sub = (a, b) => a.map((x, k) => x - b[k]);
const norm = (v) => Math.hypot(...v);
const least = (list) => list.reduce((a, b) => Math.min(a, b), Infinity);
const PLANE = 0, HFIELD = 1, SPHERE = 2, CAPSULE = 3, ELLIPSOID = 4, CYLINDER = 5, BOX = 6;

// Half the extents of a geom along its own axes.
export function halves(m, g) {
  const [a, b, c] = rows(m.geom_size, g, 3);
  switch (m.geom_type[g]) {
    case SPHERE: return [a, a, a];
    case CAPSULE: return [a, a, a + b];
    case CYLINDER: return [a, a, b];
    case ELLIPSOID: case BOX: return [a, b, c];
    default: return rows(m.geom_aabb, g, 6).slice(3);
  }
}
const endless = (m, g) => m.geom_type[g] === PLANE || m.geom_type[g] === HFIELD;
const thickness = (m, g) => (endless(m, g) ? Infinity : 2 * least(halves(m, g)));

function matrix([w, x, y, z]) {
  return [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z), 1 - 2 * (x * x + z * z),
    2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)];
}

// The thinnest extent of the box around all geoms of a body that touch others.
function bodyThickness(m, body) {
  const ends = [0, 1, 2].map(() => [Infinity, -Infinity]);
  for (let g = 0; g < m.ngeom; g++) {
    const paired = Array.from(m.pair_geom1).includes(g) || Array.from(m.pair_geom2).includes(g);
    if (m.geom_bodyid[g] !== body || (!m.geom_contype[g] && !m.geom_conaffinity[g] && !paired)) continue;
    if (endless(m, g)) return Infinity;
    const axes = matrix(rows(m.geom_quat, g, 4)), centre = rows(m.geom_pos, g, 3), half = halves(m, g);
    for (let k = 0; k < 3; k++) {
      const reach = m.geom_type[g] === SPHERE ? half[0] : [0, 1, 2].reduce((s, i) => s + Math.abs(axes[3 * k + i]) * half[i], 0);
      ends[k] = [Math.min(ends[k][0], centre[k] - reach), Math.max(ends[k][1], centre[k] + reach)];
    }
  }
  return least(ends.map(([low, high]) => high - low).filter((x) => x >= 0));
}

const moves = (m, b) => m.body_treeid[b] >= 0;

function mayMeet(m, g, p) {
  const [b, c] = [m.geom_bodyid[g], m.geom_bodyid[p]], [v, w] = [m.body_weldid[b], m.body_weldid[c]];
  const above = (x) => m.body_weldid[m.body_parentid[x]];
  const bits = (m.geom_contype[g] & m.geom_conaffinity[p]) || (m.geom_contype[p] & m.geom_conaffinity[g]);
  const signature = [(b << 16) + c, (c << 16) + b];
  const excluded = Array.from(m.exclude_signature).some((s) => signature.includes(s));
  const kin = v !== 0 && w !== 0 && (above(v) === w || above(w) === v);
  const mobile = (x) => moves(m, x) || m.body_mocapid[x] >= 0;
  return v !== w && (mobile(v) || mobile(w)) && bits && !excluded && !kin;
}

function seenFrom(d, g, p) {
  const away = sub(rows(d.geom_xpos, g, 3), rows(d.geom_xpos, p, 3)), axes = rows(d.geom_xmat, p, 9);
  return [0, 1, 2].map((k) => axes[k] * away[0] + axes[3 + k] * away[1] + axes[6 + k] * away[2]);
}

// Whether a middle passed the ellipsoid inside a geom, or the middle of a plate.
function through(m, p, from, to) {
  const half = halves(m, p);
  if (half.some((h) => h <= 0)) return false;
  const [a, b] = [from, to].map((x) => x.map((v, k) => v / half[k])), along = sub(b, a);
  const dot = (u, v) => u.reduce((s, x, k) => s + x * v[k], 0);
  const square = dot(along, along), inward = -dot(a, along);
  if (square > 0 && dot(a, a) > 1 && dot(b, b) > 1 && inward >= 0 && inward <= square && dot(a, a) - inward * inward / square < 0.8) return true;
  const thin = half.indexOf(least(half)), others = [0, 1, 2].filter((k) => k !== thin);
  if (!others.every((k) => half[k] >= 2 * half[thin]) || a[thin] * b[thin] >= 0) return false;
  const s = a[thin] / (a[thin] - b[thin]), cross = (k) => Math.abs(a[k] + s * along[k]);
  return m.geom_type[p] === BOX ? others.every((k) => cross(k) < 0.98) : others.reduce((t, k) => t + cross(k) ** 2, 0) < 0.5;
}

// Energy that nothing gave.
class Growth {
  constructor(mj, m, d) {
    this.mj = mj; this.m = m; this.own = new mj.MjData(m); this.found = null; this.roots = new Float64Array(m.nv);
    this.restart(d);
  }
  free() { this.own.delete(); }
  energy(d) {
    const { mj, m, own } = this;
    for (const key of ['qpos', 'qvel', 'act', 'ctrl', 'mocap_pos', 'mocap_quat']) own[key].set(d[key]);
    mj.mj_forward(m, own); mj.mj_energyPos(m, own); mj.mj_energyVel(m, own);
    const g = Array.from(m.opt.gravity), still = m.opt.disableflags & mj.mjtDisableBit.mjDSBL_GRAVITY.value;
    let gravity = 0, servos = 0;
    for (let b = 1; b < m.nbody && !still; b++) gravity -= m.body_mass[b] * rows(own.xipos, b, 3).reduce((s, x, k) => s + g[k] * x, 0);
    for (let i = 0; i < m.nu; i++) {
      const k = -m.actuator_biasprm[10 * i + 1], x = own.actuator_length[i], range = (list) => { const r = rows(list, i, 2); return r[0] < r[1] ? r : [-Infinity, Infinity]; };
      // Views of booleans cannot be read there: what has a range has a limit.
      const [low, high] = range(m.actuator_forcerange), [from, to] = range(m.actuator_ctrlrange), ctrl = Math.min(Math.max(own.ctrl[i], from), to);
      const a = m.actuator_gainprm[10 * i] * ctrl + m.actuator_biasprm[10 * i], f = Math.min(Math.max(a - k * x, low), high);
      // The potential of the force clip(a - k x).
      servos += k === 0 ? -f * x : a - k * x === f ? 0.5 * f * f / k : 0.5 * f * f / k + f * ((a - f) / k - x);
    }
    const M = own.M, first = m.M_rowadr, many = m.M_rownnz;
    for (let k = 0; k < m.nv; k++) this.roots[k] = Math.max(this.roots[k], Math.sqrt(Math.max(M[first[k] + many[k] - 1], 0)));
    return { kinetic: own.energy[1], gravity, elastic: own.energy[0] - gravity + servos };
  }
  restart(d) {
    const { m, own } = this;
    this.lasted = 0; this.leaps = 0; this.start = null; this.rest = 0; this.speed = 0; this.roots.fill(0);
    // What an actuator with states gives is not known from where it is.
    if (m.na > 0 || Array.from(d.qfrc_applied).some((f) => f) || Array.from(d.xfrc_applied).some((f) => f)) return;
    const e = this.energy(d);
    let stored = 0;
    for (let i = 0; i < own.nefc; i++) stored += 0.5 * own.efc_KBIP[4 * i] * (own.efc_pos[i] - own.efc_margin[i]) ** 2 / Math.max(own.efc_diagA[i], 1e-15);
    let mass = 0; for (let b = 0; b < m.nbody; b++) mass += m.body_mass[b];
    const along = (k) => { let lo = 0, hi = 0; for (let b = 0; b < m.nbody; b++) { const x = own.xipos[3 * b + k]; lo = Math.min(lo, x); hi = Math.max(hi, x); } return hi - lo; };
    let radius = 0; for (let g = 0; g < m.ngeom; g++) if (m.geom_bodyid[g] > 0) radius = Math.max(radius, m.geom_rbound[g]);
    const size = norm([0, 1, 2].map(along)) + radius;
    const held = e.kinetic + Math.abs(e.elastic) + stored + 0.5 * mass * (0.01 * size) ** 2;
    this.start = { e, held, lift: mass * norm(Array.from(m.opt.gravity)) * size };
    this.pushes = Array.from(m.dof_damping).some((b) => b < 0);
    this.sudden = this.pushes ? 1 : Math.min(Math.max(1.5 * this.swing(), 3), 10);
  }
  // How many times as large the energy of the stiffest spring or servo becomes in each swing of its steps.
  swing() {
    const { m } = this, method = m.opt.integrator, h = m.opt.timestep;
    let most = 0;
    for (let j = 0; j < m.njnt && method !== 1 && method !== 4; j++) {
      if (m.jnt_type[j] < 2) continue;
      const k = m.jnt_dofadr[j], w = m.dof_invweight0[k], late = method >= 2;
      let stiff = m.jnt_stiffness[j], early = 0, implicit = m.dof_damping[k];
      for (let a = 0; a < m.nu; a++) {
        if (m.actuator_trntype[a] > 1 || m.actuator_trnid[2 * a] !== j) continue;
        const gear = m.actuator_gear[6 * a] ** 2, kv = Math.max(-m.actuator_biasprm[10 * a + 2] * gear, 0);
        stiff += Math.max(-m.actuator_biasprm[10 * a + 1] * gear, 0);
        if (late) implicit += kv; else early += kv;
      }
      most = Math.max(most, (h * h * stiff * w + 2 * h * early * w) / (4 + 2 * h * implicit * w));
    }
    const s = Math.sqrt(most);
    return s < 1 ? (1 + s) / (1 - s) : Infinity;
  }
  look(d) {
    if (this.found !== null || !this.start) return;
    const { e, held, lift } = this.start, v = d.qvel;
    let speed = 0;
    for (let k = 0; k < v.length; k++) speed += this.roots[k] * Math.abs(v[k]);
    if (this.lasted === 0 && 0.5 * speed * speed < 0.5 * (held + 0.25 * lift)) return;
    if (this.rest > 0 && speed <= 1.5 * this.speed) { this.rest -= 1; return; }
    this.speed = speed;
    const now = this.energy(d), given = e.gravity + e.elastic - now.gravity - now.elastic, gain = now.kinetic - e.kinetic - given;
    const there = held + Math.max(given, Math.abs(now.elastic)), above = (times) => gain > times * there + 0.25 * lift;
    const sure = gain > 1e3 * (held + Math.max(given, 0) + lift), seen = sure || above(1), leapt = sure || above(this.sudden);
    this.rest = gain < 0.25 * there ? 3 : 0;
    if (!seen) { this.lasted = 0; return; }
    const turn = e.elastic === 0 && now.elastic === 0 ? this.turn(d) : 0;
    if (this.lasted === 0 && this.leaps === 0) this.since = d.time;
    this.lasted += 1; this.leaps += turn > Math.PI ? 1 : 0;
    if (leapt || this.lasted >= 32 || this.leaps >= 4) this.found = this.since;
  }
  turn(d) {
    const m = this.m; let most = 0;
    for (let j = 0; j < m.njnt; j++) {
      const a = m.jnt_dofadr[j], list = [[a + 3, a + 6], [a, a + 3], [a, a], [a, a + 1]][m.jnt_type[j]];
      most = Math.max(most, norm(Array.from(d.qvel.subarray(list[0], list[1]))));
    }
    return m.opt.timestep * most;
  }
}

// Joints past their limits.
class Limits {
  constructor(mj, m, d) { this.mj = mj; this.m = m; this.found = null; this.restart(d); }
  restart(d) {
    const { mj, m } = this, bit = mj.mjtDisableBit, off = m.opt.disableflags & (bit.mjDSBL_LIMIT.value | bit.mjDSBL_CONSTRAINT.value);
    this.joints = [];
    for (let j = 0; j < m.njnt && !off; j++) {
      // Views of booleans cannot be read there: what has a range has a limit.
      const turns = m.jnt_type[j] === 3, [low, high] = rows(m.jnt_range, j, 2), extent = m.stat.extent, q = m.jnt_qposadr[j];
      if (m.jnt_type[j] < 2 || !(low < high)) continue;
      const size = Math.max(Math.min(high - low, turns ? 2 * Math.PI : 10 * extent), (turns ? 0.1 : 0.02 * extent) / 0.2);
      const beyond = (x) => Math.max(low - x, x - high), before = d.qpos[q];
      this.joints.push({ q, high, size, beyond, before, outside: beyond(before) > 0.2 * size, lasted: 0, since: 0 });
    }
  }
  look(d) {
    if (this.found !== null) return;
    for (const j of this.joints) {
      const x = d.qpos[j.q], before = j.before;
      j.before = x;
      if (!(j.beyond(x) > 0.2 * j.size)) { j.lasted = 0; j.outside = false; continue; }
      if (j.lasted === 0) j.since = d.time;
      j.lasted += 1;
      const outward = x > j.high ? x - before : before - x;
      const jumped = outward > 0.2 * j.size && j.beyond(before) < 0.2 * j.size, stays = j.lasted >= 32 && d.time - j.since >= 0.25;
      if (jumped || stays || (!j.outside && j.beyond(x) > 0.5 * j.size)) { this.found = j.since; return; }
    }
  }
}

// The first entry and those after each so many looks; every second one is forgotten when there are too many.
class Memory {
  constructor(every, most) { this.every = every; this.most = most; this.looks = 0; this.past = []; }
  look(now) {
    if (this.looks++ % this.every) return;
    this.past.push(now());
    if (this.past.length >= this.most) { this.past = this.past.filter((_, i) => i % 2 === 0); this.every *= 2; }
  }
}

const bodyName = (mj, m, b) => (b === 0 ? 'the world' : (mj.mj_id2name(m, mj.mjtObj.mjOBJ_BODY.value, b) || `body ${b}`));

export class Watch {
  constructor(mj, m, d, controlled) {
    Object.assign(this, { mj, m, controlled, faults: [], touching: new Map(), steps: 0, last: -Infinity });
    this.pairs = [];
    for (let g = 0; g < m.ngeom; g++) for (let p = 0; p < m.ngeom; p++) {
      if (g !== p && !endless(m, g) && !endless(m, p) && mayMeet(m, g, p)) this.pairs.push({ g, p, before: null, done: false });
    }
    this.extent = Math.max(m.stat.extent, 1e-3);
    this.slides = Array.from({ length: m.nv }, (_, k) => { const j = m.dof_jntid[k], t = m.jnt_type[j]; return t === 2 || (t === 0 && k < m.jnt_dofadr[j] + 3); });
    this.growth = controlled ? null : new Growth(mj, m, d);
    this.limits = new Limits(mj, m, d);
    this.restart(d);
  }
  free() { this.growth?.free(); }
  restart(d) {
    this.sure ??= this.ranAway();
    this.wild = { start: d.time, memory: new Memory(8, 256), largest: [0, 0], first: null };
    this.rest = new Memory(4, 128);
    this.steps = 0;
  }
  disturb(d) {
    for (const p of this.pairs) p.before = seenFrom(d, p.g, p.p);
    for (const t of this.touching.values()) Object.assign(t, { switches: 0, blocks: 0, from: null, since: null });
    this.restart(d);
  }
  look(d) {
    if (d.time < this.last) this.disturb(d);
    this.last = d.time;
    this.pass(d); this.touch(d); this.speeds(d); this.places(d);
  }
  add(kind, who, time, value) { this.faults.push({ kind, who, time, value }); }
  pass(d) {
    for (const pair of this.pairs) {
      if (pair.done) continue;
      const now = seenFrom(d, pair.g, pair.p), before = pair.before;
      pair.before = now;
      if (before && through(this.m, pair.p, before, now)) {
        for (const o of this.pairs) if ([o.g, o.p].sort().join() === [pair.g, pair.p].sort().join()) o.done = true;
        this.add('tunnelling', [pair.g, pair.p], d.time, 0);
      }
    }
  }
  touch(d) {
    const { m } = this;
    if (d.ncon > 0) {
      const list = d.contact;
      for (let i = 0; i < d.ncon; i++) {
        const c = list.get(i), key = `${c.geom1},${c.geom2}`;
        if (!this.touching.has(key)) {
          const size = Math.min(...[c.geom1, c.geom2].map((g) => bodyThickness(m, m.geom_bodyid[g])));
          this.touching.set(key, { geoms: [c.geom1, c.geom2], size, on: false, now: false, switches: 0, blocks: 0, depth: 0, since: null, deepest: 0, lasted: 0, at: 0, from: null, moved: 0, chatters: false });
        }
        const t = this.touching.get(key);
        t.now ||= c.efc_address >= 0; t.depth = Math.max(t.depth, -c.dist);
        if (c.efc_address >= 0 && c.dim >= 3) (this.rubs ??= new Set()).add(m.geom_bodyid[c.geom1]).add(m.geom_bodyid[c.geom2]);
        c.delete();
      }
      list.delete();
    }
    this.steps += 1;
    const ends = this.steps % 100 === 0;
    for (const t of this.touching.values()) {
      t.switches += t.now !== t.on ? 1 : 0; t.on = t.now; t.now = false;
      const share = t.depth / t.size; t.depth = 0;
      if (share > t.deepest) { t.deepest = share; t.at = d.time; }
      if (share > 0.3) { t.since ??= d.time; t.lasted = Math.max(t.lasted, d.time - t.since); } else t.since = null;
      const place = seenFrom(d, ...t.geoms);
      if (t.from) t.moved = Math.max(t.moved, norm(sub(place, t.from)));
      if (ends) {
        const rests = t.from && t.moved < 0.02 * t.size;
        t.blocks = t.switches >= 45 && rests ? t.blocks + 1 : 0;
        if (t.blocks >= 2 && !t.chatters) { t.chatters = true; this.add('chatter', t.geoms, d.time - 200 * m.opt.timestep, t.switches); }
        t.switches = 0; t.from = place; t.moved = 0;
      }
    }
  }
  speeds(d) {
    const w = this.wild, now = [0, 0];
    d.qvel.forEach((v, k) => { const i = this.slides[k] ? 0 : 1; now[i] = Math.max(now[i], Math.abs(v)); });
    w.first ??= now.slice();
    for (const k of [0, 1]) w.largest[k] = Math.max(w.largest[k], now[k]);
    w.memory.look(() => [d.time, w.largest.slice()]);
    if (w.found) { w.found.value = Math.max(w.found.value, now[w.found.k]); return; }
    const g = Math.max(norm(Array.from(this.m.opt.gravity)), 1), x = this.extent, sensible = [Math.sqrt(2 * g * x), Math.sqrt(2 * g / x) + 10];
    for (const k of [0, 1]) if (now[k] > 100 * (w.first[k] + sensible[k])) {
      const half = w.start + 0.5 * (d.time - w.start), early = w.memory.past.filter(([t]) => t <= half).pop()?.[1] ?? w.first;
      if (now[k] > 10 * early[k]) { w.found = { time: d.time, value: now[k], k, bound: 100 * (w.first[k] + sensible[k]) }; return; }
    }
  }
  // What never stopped growing: every eighth of the time since it was sensible is faster than all before.
  ranAway() {
    const w = this.wild, f = w?.found;
    if (!f) return null;
    const list = [...w.memory.past.map(([, v]) => v[f.k]), w.largest[f.k]].filter((v) => 100 * v > f.bound), last = list.length - 1;
    const at = (part) => list[Math.floor((part * last) / 8)];
    const grows = last < 8 || [0, 1, 2, 3, 4, 5, 6, 7].every((part) => at(part + 1) > 1.02 * at(part));
    return grows ? { time: f.time, value: f.value } : null;
  }
  places(d) {
    const rubs = this.rubs ?? new Set(); this.rubs = null;
    this.rest.look(() => ({ joints: this.held(d), time: d.time, places: Array.from({ length: this.m.nbody }, (_, b) => rows(d.xpos, b, 3)), rubs }));
  }
  // Joints of one degree of freedom with friction loss: where they are, and whether it is less than it may be.
  held(d) {
    const { m } = this, list = [];
    for (let j = 0; j < m.njnt; j++) {
      const k = m.jnt_dofadr[j];
      if (m.jnt_type[j] < 2 || !(m.dof_frictionloss[k] > 0)) continue;
      let i = 0;
      while (i < d.nefc && !(d.efc_type[i] === 1 && d.efc_id[i] === k)) i++;
      list.push({ j, q: d.qpos[m.jnt_qposadr[j]], held: i < d.nefc && Math.abs(d.efc_force[i]) < 0.99 * d.efc_frictionloss[i] });
    }
    return list;
  }
  // How fast each of them moved on.
  turns() {
    const past = this.rest.past, half = past.slice(Math.floor(past.length / 2)), first = half[0], last = half[half.length - 1];
    return half.length ? last.joints.map((x, i) => [x.j, Math.abs(x.q - first.joints[i].q) / (last.time - first.time)]) : [];
  }
  creeps(half, time) {
    const { m } = this, first = half[0].joints, last = half[half.length - 1].joints;
    return first.map((at, i) => {
      const way = Math.abs(last[i].q - at.q), size = (b) => Math.max(0, ...Array.from({ length: m.ngeom }, (_, g) => g).filter((g) => m.geom_bodyid[g] === b).map((g) => 2 * Math.max(...halves(m, g)))) || m.stat.extent;
      let path = 0;
      for (let k = 1; k < half.length; k++) path += Math.abs(half[k].joints[i].q - half[k - 1].joints[i].q);
      const least = m.jnt_type[at.j] === 2 ? 0.02 * size(m.jnt_bodyid[at.j]) : 0.01;
      return half.every((x) => x.joints[i].held) && way > least && way >= 0.9 * path ? { kind: 'drift', joint: at.j, time: half[0].time, value: way / time } : null;
    }).filter((x) => x);
  }
  // How fast each body moved on in the second half of what is remembered.
  ways() {
    const past = this.rest.past, half = past.slice(Math.floor(past.length / 2)), first = half[0], last = half[half.length - 1];
    return half.length ? last.places.map((x, b) => norm(sub(x, first.places[b])) / (last.time - first.time)) : [];
  }
  drifts() {
    const { m } = this, past = this.rest.past, half = past.slice(Math.floor(past.length / 2)), end = half.length - 1;
    if (half.length < 9 || half[end].time - half[0].time < 0.5) return [];
    const time = half[end].time - half[0].time, way = (b, i, j) => norm(sub(half[j].places[b], half[i].places[b]));
    const own = (b) => Array.from({ length: m.ngeom }, (_, g) => g).filter((g) => m.geom_bodyid[g] === b);
    const size = (b) => { const s = Math.max(0, ...own(b).map((g) => 2 * Math.max(...halves(m, g)))); return s > 0 ? s : m.stat.extent; };
    const path = (b) => { let s = 0; for (let i = 0; i < end; i++) s += way(b, i, i + 1); return s; };
    const bodies = Array.from({ length: m.nbody }, (_, b) => b).filter((b) => b > 0 && moves(m, b));
    const joints = this.creeps(half, time);
    if (bodies.some((b) => path(b) > 0.1 * size(b) * time)) return joints;
    return joints.concat(bodies.filter((b) => {
      const middle = Math.floor(end / 2), one = way(b, 0, middle) / middle, two = way(b, middle, end) / (end - middle), all = way(b, 0, end);
      return half.every((x) => x.rubs.has(b)) && all > 0.02 * size(b) && all >= 0.9 * path(b) && Math.abs(one - two) <= 0.2 * Math.max(one, two);
    }).map((b) => ({ kind: 'drift', body: b, time: half[0].time, value: way(b, 0, end) / time })));
  }
  // Everything, once the run is over. `broke` is when the library warned of a bad number.
  all(broke) {
    const list = [], grew = this.growth?.found ?? null;
    if (grew !== null && grew < broke) list.push({ kind: 'energyGrows', time: grew });
    else if (broke < Infinity) list.push({ kind: 'diverges', time: broke });
    const when = list.length ? list[0].time : Infinity, geoms = (t) => t.geoms.slice().sort().join();
    const passed = this.faults.filter((f) => f.kind === 'tunnelling').map((f) => f.who.slice().sort().join());
    const seen = this.faults.slice();
    for (const t of this.touching.values()) if (t.deepest > 0.3 && t.lasted >= 0.2 && !passed.includes(geoms(t))) {
      seen.push({ kind: 'penetration', who: t.geoms, time: t.at, value: t.deepest });
    }
    if (this.limits.found !== null) seen.push({ kind: 'pastALimit', time: this.limits.found });
    const silent = this.sure ?? this.ranAway();
    if (silent && when === Infinity) seen.push({ kind: 'silentDivergence', ...silent });
    if (!this.controlled) seen.push(...this.drifts());
    list.push(...seen.filter((f) => f.time < when).map(({ kind, time, value, body, joint }) => ({ kind, time, value, body, joint })));
    return list;
  }
}
