// Evaluates expressions over a state: one JSON object in, {values, state}; one line of results out.
const { state, exprs } = JSON.parse(require('fs').readFileSync(0, 'utf8'));
const revive = (o) => Object.fromEntries(Object.entries(o).map(([k, v]) => [k, Array.isArray(v) ? Float64Array.from(v, (x) => (x === null ? NaN : x)) : v === null ? NaN : typeof v === 'object' ? revive(v) : v]));
const model = revive(state.model);
const data = revive(state.data);
const ctx = state.ctx;
const bits = (x) => { const v = new DataView(new ArrayBuffer(8)); v.setFloat64(0, x); return v.getBigUint64(0).toString(16); };
const show = (v) => (typeof v === 'number' ? (Number.isNaN(v) ? 'NaN' : bits(v)) : v == null ? 'nothing' : JSON.stringify(v));
for (const e of exprs) {
  let text;
  try { text = show(new Function('model', 'data', 'ctx', `"use strict"; return (${e});`)(model, data, ctx)); } catch (error) { text = 'nothing'; }
  console.log(text);
}
