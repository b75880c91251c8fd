// A page with 40 labs, used for ten minutes: contexts, times of answers, memory.
//
//   node bench/many.mjs [--minutes 10] [--out ../../docs/measured/many-labs.md]
import { parseArgs } from "node:util";
import { writeSection } from "../../labspec/bench/section.mjs";
import { LABS, quantile, useManyLabs } from "../test/many/use.mjs";

const { values } = parseArgs({ options: { minutes: { type: "string", default: "10" }, out: { type: "string" } } });
const minutes = Number(values.minutes), PARTS = 10;
const mb = (bytes) => (bytes / 2 ** 20).toFixed(1);
const ms = (list) => [0.5, 0.95, 0.99, 1].map((share) => quantile(list, share).toFixed(1));
const ends = [0];
const { answers, memory, contexts, open, realTime, errors } = await useManyLabs(60 * minutes, PARTS, (part, all, size) => {
  ends.push(all.length);
  console.error(`part ${part} of ${PARTS}: ${all.length} answers, process ${mb(size.process)} MB, objects ${mb(size.objects)} MB`);
});
const rows = memory.map(({ process, objects }, i) => [((i + 1) * minutes) / PARTS, ends[i + 1] - ends[i], ...ms(answers.slice(ends[i], ends[i + 1])), mb(process), mb(objects)]);
const lines = [
  "| minute | answers | median, ms | 95 % | 99 % | longest | process, MB | objects, MB |", "|---:|---:|---:|---:|---:|---:|---:|---:|",
  ...[...rows, ["all", answers.length, ...ms(answers), "", ""]].map((row) => `| ${row.join(" | ")} |`), "",
  `${open} of ${LABS} labs played; WebGL contexts: ${contexts.made} made, ${contexts.lost} lost; the slow model reached ${realTime.toFixed(3)} of real time; ${errors.length} errors.`,
  `${((100 * answers.filter((t) => t < 50).length) / answers.length).toFixed(1)} % of the answers took less than 50 ms.`,
];
console.log(lines.join("\n"));
if (values.out !== undefined) writeSection(values.out, "many.mjs", lines);
