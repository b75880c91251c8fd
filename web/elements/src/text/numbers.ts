/** Numbers as the lab format prints them. */

/** Fixed decimals; exponential below 1e-3 and from 1e5 on; `nan`, `inf` and `-inf`. */
export function formatNumber(x: number, digits: number): string {
  if (Number.isNaN(x)) return "nan";
  if (!Number.isFinite(x)) return x > 0 ? "inf" : "-inf";
  const magnitude = Math.abs(x);
  if (magnitude !== 0 && (magnitude < 1e-3 || magnitude >= 1e5)) return x.toExponential(2);
  return x.toFixed(Math.max(0, Math.min(20, Math.round(digits))));
}

/** The most digits after the point of a mantissa on an axis; a number that needs more is printed in full. */
const MOST_MANTISSA = 6;
/** Digits of a double that are exact. */
const EXACT = 15;

/** The power of ten of the first digit. */
const power = (x: number): number => Math.floor(Math.log10(Math.abs(x)) + 1e-9);

/** A number for a tick: as many digits as its distance to the next one needs. */
export function formatTick(x: number, spacing: number): string {
  const last = power(spacing);
  const isExtreme = Math.abs(x) >= 1e6 || spacing < 1e-5;
  if (isExtreme && x === 0) return "0";
  const mantissa = isExtreme ? Math.max(1, power(x) - last) : Infinity;
  if (mantissa <= MOST_MANTISSA) return x.toExponential(mantissa).replace(/^-/, "−");
  const text = x.toFixed(Math.max(0, Math.min(EXACT, -last)));
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** A number for sentences: three significant digits, and more where a difference of `resolution` or of 1 would be lost. */
export function formatBrief(x: number, resolution = Infinity): string {
  if (!Number.isFinite(x)) return formatNumber(x, 3);
  if (x === 0) return "0";
  const first = power(x);
  const isExtreme = Math.abs(x) < 1e-3 || Math.abs(x) >= 1e5;
  // Numbers that are printed with a power of ten lose the ones, unless the resolution needs them.
  const finest = isExtreme ? resolution : Math.min(1, resolution);
  const needed = finest > 0 ? first - power(finest) + 1 : EXACT;
  const digits = Math.max(3, Math.min(EXACT, needed));
  return isExtreme && !(first > 0 && digits > first) ? x.toExponential(digits - 1) : String(Number(x.toPrecision(digits)));
}

/** A time for sentences, s. */
export function formatTime(time: number): string {
  return time.toFixed(time >= 100 ? 1 : time >= 10 ? 2 : 3);
}

const RAISED: Readonly<Record<string, string>> = { "0": "⁰", "1": "¹", "2": "²", "3": "³", "4": "⁴", "5": "⁵", "6": "⁶", "7": "⁷", "8": "⁸", "9": "⁹", "-": "⁻" };
const LOWERED = new Map(Object.entries(RAISED).map(([digit, raised]) => [raised, digit]));

/** A text with plain minus signs and spaces, and with raised digits as powers: `m/s²` is `m/s^2`. */
function plainText(text: string): string {
  return text.replace(/[\u2212\u2013]/g, "-").replace(/\s/g, " ").replace(/[⁰¹²³⁴-⁹⁻]+/g, (raised) => `^${[...raised].map((one) => LOWERED.get(one) ?? one).join("")}`);
}

/** A unit in one spelling: products with a point, no spaces, the Greek letter for micro. */
function plainUnit(unit: string): string {
  return plainText(unit).trim().replace(/\*\*/g, "^").replace(/ *([/^]) */g, "$1").replace(/ *[·⋅∙*] *| +/g, "·").replaceAll("\u00b5", "\u03bc");
}

/** A mantissa, a power of ten (`e3`, `·10^3`, `×10**3`), and what follows. */
const TYPED = /^([+-]? ?(?:\d+[.,]?\d*|[.,]\d+))(?:e([+-]?\d+)| *[×x*·⋅∙] *10 *(?:\^|\*\*)? *([+-]?\d+))?(.*)$/i;

/** The number in what somebody typed: a comma is a decimal point, and the unit may follow. `null` for anything else. */
export function parseTyped(text: string, unit: string): number | null {
  const found = TYPED.exec(plainText(text).trim());
  if (found === null) return null;
  const [, mantissa = "", e = "", power = e, rest = ""] = found;
  if (rest.trim() !== "" && plainUnit(rest) !== plainUnit(unit)) return null;
  const value = Number(`${mantissa.replace(",", ".").replace(" ", "")}e${power === "" ? "0" : power}`);
  return Number.isFinite(value) ? value : null;
}

/** A unit for readers: `m/s^2` with its exponent raised. */
export function formatUnit(unit: string): string {
  return unit.replace(/\^(-?\d+)/g, (_, exponent: string) => [...exponent].map((digit) => RAISED[digit] ?? digit).join(""));
}
