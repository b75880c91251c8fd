// Trials in site builders: the first lesson in a site of each, built as its authors build it.
import { copyFileSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { repository, root, run } from "../test/tools.mjs";
import { serve } from "../test/page/site.mjs";

const lesson = readFileSync(join(repository, "specs/lessons/01-what-a-step-computes.md"), "utf8");
/** The fences alone: MDX reads braces of formulas as expressions. */
const fences = lesson.match(/^```(?:lab simlab|lab integrators|quiz)\n[^]*?\n```$/gm).join("\n\n");
const options = { root: repository, models: "specs/models" };
const plugin = (name) => JSON.stringify(join(root, "dist", `${name}.js`));

/** Writes the files of a project, whose packages are those installed, and builds it. */
function make(t, files, program, args) {
  for (const [name, text] of Object.entries(files)) {
    mkdirSync(dirname(join(t.folder, name)), { recursive: true });
    writeFileSync(join(t.folder, name), text);
  }
  symlinkSync(join(t.installed, "node_modules"), join(t.folder, "node_modules"));
  const env = { ...process.env, ASTRO_TELEMETRY_DISABLED: "1", DO_NOT_TRACK: "1", NODE_ENV: "production" };
  run(join(t.installed, "node_modules/.bin", program), args, { cwd: t.folder, env });
}

async function visit(t, built, path, names) {
  copyFileSync(join(t.folder, "labspec-elements.js"), join(t.folder, built, "labspec-elements.js"));
  const url = await serve(t, join(t.folder, built));
  const versions = names.map((name) => `${name} ${JSON.parse(readFileSync(join(t.installed, "node_modules", name, "package.json"), "utf8")).version}`).join(", ");
  return { ...(await t.open(url + path)), versions };
}

export const vitepress = {
  node: ["vitepress@1.6.4"],
  async try(t) {
    make(t, {
      "package.json": '{"type": "module"}',
      "lesson.md": lesson,
      ".vitepress/config.mjs": `import labspec from ${plugin("markdown-it")};
export default {
  title: "Course",
  head: [["script", { type: "module", src: "/labspec-elements.js" }], ["link", { rel: "icon", href: "data:," }]],
  markdown: { config: (md) => md.use(labspec, ${JSON.stringify({ ...options, form: "attribute" })}) },
  vue: { template: { compilerOptions: { isCustomElement: (tag) => tag === "sim-lab" || tag === "lesson-quiz" } } },
};
`,
    }, "vitepress", ["build"]);
    return visit(t, ".vitepress/dist", "lesson.html", ["vitepress", "vue"]);
  },
};

export const starlight = {
  node: ["astro@5.18.2", "@astrojs/starlight@0.36.3"],
  async try(t) {
    make(t, {
      "package.json": '{"type": "module"}',
      "src/content/docs/lesson.md": `---\ntitle: Lesson\n---\n${lesson}`,
      "src/content.config.mjs": `import { defineCollection } from "astro:content";
import { docsLoader } from "@astrojs/starlight/loaders";
import { docsSchema } from "@astrojs/starlight/schema";
export const collections = { docs: defineCollection({ loader: docsLoader(), schema: docsSchema() }) };
`,
      "astro.config.mjs": `import { defineConfig } from "astro/config";
import starlight from "@astrojs/starlight";
import labspec from ${plugin("remark")};
export default defineConfig({
  integrations: [starlight({ title: "Course", head: [{ tag: "script", attrs: { type: "module", src: "/labspec-elements.js" } }, { tag: "link", attrs: { rel: "icon", href: "data:," } }] })],
  markdown: { remarkPlugins: [[labspec, ${JSON.stringify(options)}]] },
});
`,
    }, "astro", ["build"]);
    return visit(t, "dist", "lesson/", ["astro", "@astrojs/starlight"]);
  },
};

export const docusaurus = {
  node: ["@docusaurus/core@3.10.2", "@docusaurus/preset-classic@3.10.2", "react@19.3.1", "react-dom@19.3.1"],
  async try(t) {
    make(t, {
      "package.json": "{}",
      "docs/index.mdx": `# Lesson\n\n${fences}\n`,
      "docusaurus.config.mjs": `import labspec from ${plugin("remark")};
export default {
  title: "Course", url: "http://localhost", baseUrl: "/", favicon: "data:,",
  scripts: [{ src: "/labspec-elements.js", type: "module" }],
  presets: [["classic", { blog: false, docs: { routeBasePath: "/", remarkPlugins: [[labspec, ${JSON.stringify({ ...options, form: "attribute" })}]] } }]],
};
`,
    }, "docusaurus", ["build"]);
    return visit(t, "build", "", ["@docusaurus/core", "react"]);
  },
};
