/** A check with runs: of the lab alone, or inside of the lesson that quotes its numbers. */
import type { CheckedFinding, CheckerClient, Report } from "labspec-editor";
import { LAB_PATH, type Project } from "./project.js";

export interface Claims {
  readonly entries: Report["entries"];
  /** What only a run finds, with places in the text of the lab. */
  readonly findings: readonly CheckedFinding[];
}

/** Runs the lab of a project. `known` are the findings that need no run. */
export async function checkClaims(checker: CheckerClient, { lab, lesson }: Project, known: readonly CheckedFinding[]): Promise<Claims> {
  const [path, before, after] = lesson === null ? [LAB_PATH, "", ""] : [lesson.path, lesson.before, lesson.after];
  const report = await checker.check(path, `${before}${lab}${after}`);
  const owner = lesson !== null && /^#\d+$/.test(lesson.address) ? `lab ${lesson.address}` : null;
  const isKnown = (finding: CheckedFinding): boolean => known.some(({ code, start }) => code === finding.code && start === finding.start);
  const inside = report.findings.flatMap((finding) => (finding.file === path ? placed(finding, before.length, lab) : []));
  return { entries: report.entries.filter((entry) => owner === null || entry.owner === owner), findings: inside.filter((finding) => !isKnown(finding)) };
}

/** A finding of a lesson with its place in the lab, if it is there. */
function placed(finding: CheckedFinding, offset: number, lab: string): CheckedFinding[] {
  const [start, end] = [(finding.start ?? -1) - offset, (finding.end ?? -1) - offset];
  if (start < 0 || end > lab.length) return [];
  const above = lab.slice(0, start);
  const fixes = finding.fixes.map((fix) => ({ ...fix, edits: fix.edits.map((edit) => ({ ...edit, start: edit.start - offset, end: edit.end - offset })) }));
  const inside = fixes.filter((fix) => fix.edits.every((edit) => edit.start >= 0 && edit.end <= lab.length));
  return [{ ...finding, file: LAB_PATH, start, end, line: above.split("\n").length, column: start - above.lastIndexOf("\n"), fixes: inside }];
}
