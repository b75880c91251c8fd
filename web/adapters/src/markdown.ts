/** The fences of a Markdown text, line by line as CommonMark defines them, for tools that give texts and no trees. */

/** A fence of a text. */
export interface TextFence {
  /** The first line, and the line after the last one. */
  readonly start: number;
  readonly end: number;
  readonly info: string;
  /** The text inside, without the prefixes of quotes and lists. */
  readonly body: string;
  /** The prefix of lines in its place: the marks of quotes and the indentation of lists. */
  readonly prefix: string;
  /** What precedes the marks on the first line: as `prefix`, with the marker of a list that begins there. */
  readonly head: string;
}

/** The quotes and the list items that are open at a line. */
interface Containers {
  quotes: number;
  /** The columns at which the contents of the open list items begin, after the marks of the quotes. */
  items: number[];
}

const OPENING = /^(`{3,}(?=[^`]*$)|~{3,})(.*)$/;
const MARKER = /^([-+*]|\d{1,9}[.)])( {1,4}(?! )| +(?=\S)|$)/;

/** Finds all fences, in order. */
export function findFences(lines: readonly string[]): TextFence[] {
  const fences: TextFence[] = [];
  const open: Containers = { quotes: 0, items: [] };
  for (let i = 0; i < lines.length; ) {
    const line = (lines[i] ?? "").replace(/\r$/, "");
    const { quotes, rest } = unquote(line, Infinity);
    if (quotes !== open.quotes && rest.trim() !== "") Object.assign(open, { quotes, items: [] });
    const { column, text } = enterItems(rest, open);
    const hidden = endOfHidden(lines, i, text);
    const opening = hidden === null ? OPENING.exec(text) : null;
    if (opening === null || column - (open.items.at(-1) ?? 0) > 3) {
      i = hidden ?? i + 1;
      continue;
    }
    const fence = readBody(lines, i, { quotes, indent: open.items.at(-1) ?? 0, column, marks: opening[1] ?? "" });
    const head = line.slice(0, line.length - text.length);
    fences.push({ ...fence, start: i, info: (opening[2] ?? "").trim(), prefix: "> ".repeat(quotes) + " ".repeat(open.items.at(-1) ?? 0), head });
    i = fence.end;
  }
  return fences;
}

/** A line without the marks of at most `most` quotes. */
function unquote(line: string, most: number): { quotes: number; rest: string } {
  let [quotes, rest] = [0, expandTabs(line.replace(/\r$/, ""))];
  for (let mark = /^ {0,3}> ?/.exec(rest); mark !== null && quotes < most; mark = /^ {0,3}> ?/.exec(rest)) {
    rest = rest.slice(mark[0].length);
    quotes += 1;
  }
  return { quotes, rest };
}

/** A line with spaces for the tabs before its text: they reach to the next multiple of four columns. */
function expandTabs(line: string): string {
  const before = /^[\s>+*.)\d-]*/.exec(line)?.[0] ?? "";
  if (!before.includes("\t")) return line;
  let out = "";
  for (const c of before) out += c === "\t" ? " ".repeat(4 - (out.length % 4)) : c;
  return out + line.slice(before.length);
}

/** Leaves the list items that a line does not continue, and enters those that begin on it. */
function enterItems(rest: string, open: Containers): { column: number; text: string } {
  let text = rest.trimStart();
  let column = rest.length - text.length;
  if (text === "") return { column, text };
  open.items = open.items.filter((item) => item <= column);
  for (let marker = MARKER.exec(text); marker !== null && column - (open.items.at(-1) ?? 0) <= 3; marker = MARKER.exec(text)) {
    const width = marker[0].length;
    // A marker with five spaces begins an item with indented code, whose content begins after one space.
    const spaces = text.slice((marker[1] ?? "").length).search(/\S|$/);
    const content = column + (spaces > 4 || spaces === 0 ? (marker[1] ?? "").length + 1 : width);
    open.items.push(content);
    const after = text.slice((marker[1] ?? "").length).trimStart();
    column += text.length - after.length;
    text = after;
    if (text === "") break;
  }
  return { column, text };
}

/** The line after a comment or an element whose text is not Markdown, if one begins at a line. */
function endOfHidden(lines: readonly string[], at: number, text: string): number | null {
  const tag = /^<(script|pre|style|textarea)(?=[\s>]|$)/i.exec(text)?.[1];
  const end = text.startsWith("<!--") ? /-->/ : tag === undefined ? null : /<\/(script|pre|style|textarea)>/i;
  if (end === null) return null;
  for (let i = at; i < lines.length; i += 1) if (end.test(lines[i] ?? "")) return i + 1;
  return lines.length;
}

interface Opening {
  readonly quotes: number;
  /** Where the content of the list item around it begins. */
  readonly indent: number;
  /** Where its marks are. */
  readonly column: number;
  readonly marks: string;
}

/** The body of a fence, up to its closing line or the end of what is around it. */
function readBody(lines: readonly string[], start: number, { quotes, indent, column, marks }: Opening): { end: number; body: string } {
  const body: string[] = [];
  const closing = new RegExp(`^ {0,3}\\${marks[0] ?? "`"}{${marks.length},} *$`);
  for (let i = start + 1; i < lines.length; i += 1) {
    const line = unquote(lines[i] ?? "", quotes);
    const spaces = line.rest.search(/\S|$/);
    const isBlank = spaces === line.rest.length;
    if (line.quotes < quotes || (!isBlank && spaces < indent)) return { end: i, body: body.join("") };
    const content = line.rest.slice(Math.min(spaces, indent));
    if (closing.test(content)) return { end: i + 1, body: body.join("") };
    body.push(`${line.rest.slice(Math.min(spaces, column))}\n`);
  }
  return { end: lines.length, body: body.join("") };
}
