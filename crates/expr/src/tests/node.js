// Runs programs in JavaScript: one JSON string a line in, one line of results out. `model`, `data` and `ctx` are made anew for
// each, as crates/expr/src/mock.rs makes them.
const lines = require('fs').readFileSync(0, 'utf8').split('\n').filter((l) => l);
const view = new DataView(new ArrayBuffer(8));
const bits = (x) => { view.setFloat64(0, x); return view.getBigUint64(0).toString(16); };
const show = (v, depth = 0) => {
  if (depth > 6) return '…';
  if (v === undefined) return 'u';
  if (v === null) return '0';
  if (typeof v === 'number') return Number.isNaN(v) ? 'nNaN' : 'n' + bits(v);
  if (typeof v === 'string') return 's' + JSON.stringify(v);
  if (typeof v === 'boolean') return 'b' + v;
  if (typeof v === 'function') return 'f';
  if (Array.isArray(v) || ArrayBuffer.isView(v)) return '[' + Array.from(v, (x) => show(x, depth + 1)).join(' ') + ']';
  return '{' + Object.entries(v).map(([k, x]) => k + ':' + show(x, depth + 1)).join(' ') + '}';
};
const field = (k, n, type = Float64Array) => type.from({ length: n }, (_, i) => 100 * k + i);
const out = lines.map((line) => {
  const data = { time: 0, qpos: field(1, 14), qvel: field(2, 12), ncon: 400, efc_force: field(6, 2), eq_active: field(13, 4, Uint8Array) };
  const iterations = field(15, 1, Int32Array);
  const opt = { get iterations() { return iterations[0]; }, set iterations(x) { iterations[0] = x; } };
  const model = { geom_contype: field(14, 4, Int32Array), opt };
  const ctx = {};
  let result;
  try {
    new Function('model', 'data', 'ctx', '"use strict";' + JSON.parse(line))(model, data, ctx);
    result = show(ctx.out);
  } catch (e) {
    result = e instanceof SyntaxError ? 'SyntaxError ' + e.message : 'E';
  }
  return result + ' | ' + [data.qpos, data.qvel, data.eq_active, model.geom_contype, iterations].map((v) => show(v)).join('');
});
process.stdout.write(out.join('\n') + '\n');
