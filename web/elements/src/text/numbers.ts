/** Numbers as the lab format prints them. */

/** Fixed decimals; exponential below 1e-3 and from 1e5 on; `nan`, `inf` and `-inf`. */
export function formatNumber(x: number, digits: number): string {
  if (Number.isNaN(x)) return "nan";
  if (!Number.isFinite(x)) return x > 0 ? "inf" : "-inf";
  const magnitude = Math.abs(x);
  if (magnitude !== 0 && (magnitude < 1e-3 || magnitude >= 1e5)) return x.toExponential(2);
  return x.toFixed(Math.max(0, Math.min(20, Math.round(digits))));
}

/** A number for a tick or a table: as many decimals as its distance to the next one needs. */
export function formatTick(x: number, spacing: number): string {
  if (Math.abs(x) >= 1e6 || (x !== 0 && spacing < 1e-5)) return x.toExponential(1);
  const digits = Math.max(0, Math.min(8, -Math.floor(Math.log10(spacing) + 1e-9)));
  const text = x.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** Three significant digits, for sentences. */
export function formatBrief(x: number): string {
  if (!Number.isFinite(x)) return formatNumber(x, 3);
  if (x !== 0 && (Math.abs(x) < 1e-3 || Math.abs(x) >= 1e5)) return x.toExponential(2);
  return String(Number(x.toPrecision(3)));
}

/** A time for sentences, s. */
export function formatTime(time: number): string {
  return time.toFixed(time >= 100 ? 1 : time >= 10 ? 2 : 3);
}

/** The number in what somebody typed: a comma is a decimal point, and the unit may follow. `null` for anything else. */
export function parseTyped(text: string, unit: string): number | null {
  let rest = text.trim().replace(/[\u2212\u2013]/g, "-").replace(/\u00a0/g, " ");
  if (unit !== "" && rest.endsWith(unit)) rest = rest.slice(0, -unit.length).trim();
  if (/^[^.,]*,[^.,]*$/.test(rest)) rest = rest.replace(",", ".");
  rest = rest.replace(/\s*[×x*]\s*10\s*\^?\s*/i, "e");
  if (!/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(rest)) return null;
  const value = Number(rest);
  return Number.isFinite(value) ? value : null;
}

const RAISED: Readonly<Record<string, string>> = { "0": "⁰", "1": "¹", "2": "²", "3": "³", "4": "⁴", "5": "⁵", "6": "⁶", "7": "⁷", "8": "⁸", "9": "⁹", "-": "⁻" };

/** A unit for readers: `m/s^2` with its exponent raised. */
export function formatUnit(unit: string): string {
  return unit.replace(/\^(-?\d+)/g, (_, exponent: string) => [...exponent].map((digit) => RAISED[digit] ?? digit).join(""));
}
