// What the tests share: the example course, its fences, and texts that want to get out of their element.
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { repository } from "./tools.mjs";

export const lessons = join(repository, "specs/lessons");
export const lessonFiles = readdirSync(lessons).filter((name) => name.endsWith(".md")).sort();

/** The fences of the example lessons: their info strings and texts. */
export const fences = lessonFiles.flatMap((name) => {
  const text = readFileSync(join(lessons, name), "utf8");
  return [...text.matchAll(/^```(lab simlab|lab integrators|quiz)\n([^]*?)\n```$/gm)].map(([, info, body], i) => ({ name: `${name}#${i + 1}`, info, body }));
});

/** Texts that would end a script, an attribute, a comment or a template if they were written as they are. */
export const HOSTILE = [
  "</script><img src=x onerror=globalThis.hacked=1>", "<!--<script>", "--></SCRIPT >", "\"><script>globalThis.hacked=1</script>", "'\"`${globalThis.hacked=1}`",
  "{{ globalThis.hacked = 1 }}", "]]>", "&quot;&lt;/script&gt;", "\u2028\u2029\u0000", "\\u003c/script>", "$$x$$ \\( y \\) **b** _i_ [l](javascript:1)", "```\n\n```", "🌍 é",
];

/** A lab with such a text wherever a text can be. */
export const hostileLab = (text) => JSON.stringify({
  title: text, xml: `<mujoco model="${text.replace(/[<>&"\u0000]/g, "")}"><worldbody/></mujoco>`, note: text, [text]: text,
  readouts: [{ label: text, expr: "data.time" }],
});

/** What an element must contain of a fence: the JSON without `verify` and `lint`. */
export function withoutClaims(value) {
  if (Array.isArray(value)) return value.map(withoutClaims);
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.entries(value).filter(([key]) => key !== "verify" && key !== "lint").map(([key, inside]) => [key, withoutClaims(inside)]));
}

/** The elements of a page: `[tag, id, content, names of models]`, read as a browser reads scripts. */
export function elementsOf(html) {
  return [...html.matchAll(/<(sim-lab|lesson-quiz) id="([^"]*)"[^>]*>([^]*?)<\/\1>/g)].map(([, tag, id, inside]) => {
    const scripts = [...inside.matchAll(/<script type="([^"]*)"(?: data-name="([^"]*)")?>([^]*?)<\/script>/g)];
    const json = scripts.find(([, type]) => type === "application/json")?.[3] ?? "null";
    return { tag, id, content: JSON.parse(json), models: scripts.filter(([, type]) => type === "model/mjcf").map(([, , name]) => name) };
  });
}
