// What becomes of an expression over all samples of a run: the table of docs/verify.md, "Measures".

// Each takes the samples of its arguments one after the other, with their times, and gives one number at the end. `a(i)` is argument i now.
const HOW = {
  first: () => { let r = NaN, done = false; return [(a, t) => { if (!done && a(0)) { r = t; done = true; } }, () => r]; },
  at: () => { let r = NaN, done = false; return [(a) => { if (!done && a(0)) { r = +a(1); done = true; } }, () => r]; },
  before: () => { let r = NaN, was = NaN, done = false; return [(a) => { if (done) return; if (a(0)) { r = was; done = true; } else was = +a(1); }, () => r]; },
  initial: () => { let r = NaN, done = false; return [(a) => { if (!done) { r = +a(0); done = true; } }, () => r]; },
  final: () => { let r = NaN; return [(a) => { r = +a(0); }, () => r]; },
  min: () => { let r = NaN; return [(a) => { const x = +a(0); if (!(x >= r) && !Number.isNaN(x)) r = x; }, () => r]; },
  max: () => { let r = NaN; return [(a) => { const x = +a(0); if (!(x <= r) && !Number.isNaN(x)) r = x; }, () => r]; },
  previous: () => { let now = NaN, was = NaN; return [(a) => { was = now; now = +a(0); }, () => was]; },
  last: () => { let r = NaN; return [(a, t) => { if (a(0)) r = t; }, () => r]; },
  holds: () => { let r = 1; return [(a) => { if (!a(0)) r = 0; }, () => r]; },
  count: () => { let r = 0, was = false; return [(a) => { const now = !!a(0); if (now && !was) r += 1; was = now; }, () => r]; },
  peak: () => { let r = NaN, top = NaN; return [(a, t) => { const x = +a(0); if (x > top || (Number.isNaN(top) && !Number.isNaN(x))) { r = t; top = x; } }, () => r]; },
  settles: () => { let r = NaN; return [(a, t) => { if (!(Math.abs(a(0) - a(1)) <= a(2))) r = NaN; else if (Number.isNaN(r)) r = t; }, () => r]; },
  mean: () => area((x) => x, (s) => s.mean()),
  rms: () => area((x) => x * x, (s) => Math.sqrt(s.mean())),
  integral: () => area((x) => x, (s) => s.area),
  rate: () => {
    const t = [], x = [];
    return [(a, time) => { t.push(time); x.push(+a(0)); }, () => {
      const n = t.length, [tm, xm] = [t, x].map((l) => l.reduce((s, v) => s + v, 0) / n);
      let [tt, tx] = [0, 0];
      for (let i = 0; i < n; i++) { tt += (t[i] - tm) ** 2; tx += (t[i] - tm) * (x[i] - xm); }
      return tt > 0 ? tx / tt : NaN;
    }];
  },
  crossing: (n) => {
    let r = NaN, done = false, was = null;
    return [(a, t) => {
      if (done) return;
      const x = above(a, n);
      if (x === 0) { r = t; done = true; } else if (was && was.t < t && was.x * x < 0) { r = zero(was, t, x); done = true; }
      was = { t, x };
    }, () => r];
  },
  crossings: (n) => {
    let r = 0, side = 0, before = -Infinity;
    return [(a, t) => {
      const x = above(a, n);
      if (Number.isNaN(x) || before > t) side = 0; else if (x !== 0) { if (side * x < 0) r += 1; side = Math.sign(x); }
      before = t;
    }, () => r];
  },
  period: (n) => {
    // Times of the upward passages: through zero between two samples, or at the first sample at zero after one below it.
    let was = null, below = false, reached = null;
    const ups = [];
    return [(a, t) => {
      const x = above(a, n);
      if (!was || !(was.t < t) || Number.isNaN(x)) { below = false; reached = null; }
      if (x < 0) { below = true; reached = null; }
      if (x === 0 && below) reached = reached ?? t;
      if (x > 0) {
        if (below && (reached !== null || was.x < 0)) ups.push(reached ?? zero(was, t, x));
        below = false; reached = null;
      }
      was = { t, x };
    }, () => (ups.length < 2 ? NaN : (ups[ups.length - 1] - ups[0]) / (ups.length - 1))];
  },
};
// Why a measure has no value, if it is not a sample without a number.
const ABSENT = {
  first: 'the condition never holds',
  at: 'the condition never holds',
  last: 'the condition never holds',
  before: 'the condition never holds, or it holds at the first sample',
  crossing: 'the value never passes the level',
  period: 'there are fewer than two upward passages',
  settles: 'the value is outside of the band at the end',
};
const above = (a, n) => a(0) - (n > 1 ? a(1) : 0);
const zero = (was, t, x) => was.t + (t - was.t) * (was.x / (was.x - x));
function area(of, end) {
  const s = { area: 0, covered: 0, t: NaN, x: NaN, mean() { return this.covered > 0 ? this.area / this.covered : this.x; } };
  return [(a, t) => { const x = of(+a(0)); if (s.t < t) { s.area += 0.5 * (s.x + x) * (t - s.t); s.covered += t - s.t; } s.t = t; s.x = x; }, () => end(s)];
}

// The calls of these functions in a text: where each begins and ends, and the texts of its arguments.
export function calls(text) {
  const found = [];
  let quote = null, word = '';
  for (let i = 0; i < text.length; i++) {
    const c = text[i];
    if (quote) { if (c === '\\') i += 1; else if (c === quote) quote = null; continue; }
    if (c === '"' || c === "'" || c === '`') { quote = c; word = ''; continue; }
    if (/[\w$]/.test(c)) { word += c; continue; }
    const start = i - word.length, member = /\.\s*$/.test(text.slice(0, start));
    if (c === '(' && Object.hasOwn(HOW, word) && !member) {
      const { args, end } = split(text, i + 1);
      found.push({ name: word, start, end, args });
      i = end - 1;
    }
    word = '';
  }
  return found;
}

// The arguments of a call, from behind its parenthesis to the one that closes it.
function split(text, from) {
  const args = [];
  let depth = 0, quote = null, start = from;
  for (let i = from; i < text.length; i++) {
    const c = text[i];
    if (quote) { if (c === '\\') i += 1; else if (c === quote) quote = null; continue; }
    if (c === '"' || c === "'" || c === '`') quote = c;
    else if ('([{'.includes(c)) depth += 1;
    else if (depth === 0 && (c === ')' || c === ',')) {
      if (text.slice(start, i).trim()) args.push(text.slice(start, i));
      if (c === ')') return { args, end: i + 1 };
      start = i + 1;
    } else if (')]}'.includes(c)) depth -= 1;
  }
  throw new Error('a parenthesis is not closed');
}

// A measure: `sample` at every sample, `finish` at the end. The names are those that its text may use. What stands within
// another one is what it is up to the sample that the other looks at.
export function measure(text, names) {
  const compile = (code, more = []) => new Function(...names, ...more, `"use strict"; return (${code});`);
  const all = calls(text).map((call) => {
    const [take, result] = HOW[call.name](call.args.length);
    return { ...call, take, result, args: call.args.map((arg) => measure(arg, names)) };
  });
  let rest = '', from = 0;
  all.forEach((call, i) => { rest += `${text.slice(from, call.start)}(__${i})`; from = call.end; });
  const end = compile(rest + text.slice(from), all.map((_, i) => `__${i}`));
  return {
    sample(values, time) {
      for (const call of all) {
        // A name that nobody knows is told; whatever else throws is nothing, as on a page.
        for (const arg of call.args) arg.sample(values, time);
        call.take((i) => { try { return call.args[i].now(values); } catch (e) { if (e instanceof ReferenceError) throw e; return undefined; } }, time);
      }
    },
    now(values) { return end(...values, ...all.map((call) => call.result())); },
    finish(values) { return +this.now(values); },
    // Why it is NaN: the first of its parts that has no value.
    absent() {
      const call = all.find((one) => Number.isNaN(+one.result()));
      if (!call) return 'its value is not a number';
      const inside = call.args.map((arg) => arg.absentInside()).find((why) => why);
      return inside ?? `in \`${text.slice(call.start, call.end)}\`, ${ABSENT[call.name] ?? 'a sample has no number'}`;
    },
    absentInside() { return all.some((one) => Number.isNaN(+one.result())) ? this.absent() : null; },
  };
}
