/** A mistake or a doubt, with its position. */
export interface Finding {
  /** The rule, e.g. `unknown-field`. */
  readonly code: string;
  readonly severity: "error" | "warning" | "note";
  /** The text in which it is: `lab.json`, the name of a model, `expression`. */
  readonly file: string;
  /** Place in the text as JavaScript counts (UTF-16); `null` where the text is not known. */
  readonly start: number | null;
  readonly end: number | null;
  /** Place in the UTF-8 bytes of the text. */
  readonly startByte: number;
  readonly endByte: number;
  /** From 1; columns in UTF-16. `null` where the text is not known. */
  readonly line: number | null;
  readonly column: number | null;
  readonly message: string;
  readonly why: string | null;
  readonly help: string | null;
}

/** The error of every call. */
export class LabspecError extends Error {
  /** Short and stable: `wrong-type`, `not-ready`, `freed`, `unknown-name`, or the rule of the first finding. */
  readonly code: string;
  /** The mistakes in the given texts. */
  readonly findings: readonly Finding[];

  constructor(code: string, message: string, findings: readonly Finding[] = []) {
    super(message);
    this.name = "LabspecError";
    this.code = code;
    this.findings = findings;
  }
}

/** Texts by the names that findings give them. */
export type Texts = ReadonlyMap<string, string>;

interface RawFinding {
  code: string;
  severity: Finding["severity"];
  file: string;
  start: number;
  end: number;
  line: number | null;
  column: number | null;
  message: string;
  why: string | null;
  help: string | null;
}

/** UTF-16 offsets for ascending or descending byte offsets of a text. */
function utf16(text: string, byte: number): number {
  let bytes = 0;
  for (let i = 0; i < text.length; i++) {
    if (bytes >= byte) return i;
    const unit = text.charCodeAt(i);
    if (unit < 0x80) bytes += 1;
    else if (unit < 0x800) bytes += 2;
    else if (unit >= 0xd800 && unit < 0xdc00 && i + 1 < text.length && (text.charCodeAt(i + 1) & 0xfc00) === 0xdc00) {
      bytes += 4;
      i += 1;
    } else bytes += 3;
  }
  return text.length;
}

function textOf(texts: Texts, file: string): string | undefined {
  return texts.get(file) ?? texts.get(file.replace(/\.xml$/, "")) ?? texts.get(`${file}.xml`);
}

/** Findings of the module with places as JavaScript counts them. */
export function locate(raw: readonly unknown[], texts: Texts): Finding[] {
  return (raw as readonly RawFinding[]).map((f) => {
    const text = textOf(texts, f.file);
    const place = { startByte: f.start, endByte: f.end };
    const rest = { code: f.code, severity: f.severity, file: f.file, message: f.message, why: f.why, help: f.help };
    if (text === undefined) return { ...rest, ...place, start: null, end: null, line: f.line, column: f.column };
    const start = utf16(text, f.start);
    const before = text.slice(0, start);
    const line = before.split("\n").length;
    const column = start - (before.lastIndexOf("\n") + 1) + 1;
    return { ...rest, ...place, start, end: utf16(text, f.end), line, column };
  });
}

const NO_TEXTS: Texts = new Map();

/** Converts a thrown value to an error of this package. */
export function asLabspecError(e: unknown, texts: Texts = NO_TEXTS): LabspecError {
  if (e instanceof LabspecError) return e;
  if (e instanceof WebAssembly.RuntimeError || e instanceof RangeError) {
    return new LabspecError("internal", `the module failed (${e.message}); out of memory, or a defect: please report it`);
  }
  if (e instanceof Error) {
    const { code, findings } = e as { code?: unknown; findings?: unknown };
    const list = Array.isArray(findings) ? locate(findings, texts) : [];
    return new LabspecError(typeof code === "string" ? code : "call", e.message, list);
  }
  return new LabspecError("call", String(e));
}

/** Calls the module, and converts its errors to errors of this package. */
export function call<T>(f: () => T, texts?: Texts): T {
  try {
    return f();
  } catch (e) {
    throw asLabspecError(e, texts);
  }
}
