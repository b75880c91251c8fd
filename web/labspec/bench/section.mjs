// The tables of a page that a script makes stand between two marks of it.
import { readFileSync, writeFileSync } from "node:fs";

/** Writes the lines of a script between `<!-- SCRIPT -->` and the next `<!-- end -->` of a page. */
export function writeSection(page, script, lines) {
  const text = readFileSync(page, "utf8");
  const begin = `<!-- ${script} -->\n`;
  const at = text.indexOf(begin);
  const end = text.indexOf("<!-- end -->", at);
  if (at < 0 || end < 0) throw new Error(`${page} has no ${begin.trim()} … <!-- end -->`);
  writeFileSync(page, text.slice(0, at + begin.length) + lines.join("\n") + "\n" + text.slice(end));
}
