// src/element.ts
var ESCAPES = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };
function escapeHtml(text) {
  return text.replace(/[&<>"']/g, (c) => ESCAPES[c] ?? c);
}
function jsonInScript(json) {
  return json.replace(/[<>\u2028\u2029]/g, (c) => `\\u${c.charCodeAt(0).toString(16).padStart(4, "0")}`);
}
function modelInScript(xml) {
  const parts = xml.replace(/^\ufeff/, "").split("<!--");
  const kept = parts.map((part, i) => i === 0 ? part : part.includes("-->") ? part.slice(part.indexOf("-->") + 3) : null);
  if (kept.includes(null)) return null;
  const text = kept.join("").trim().replace(/\s*[\r\n]\s*/g, " ");
  return /<!--|<\/?script|<!doctype|<!\[cdata\[/i.test(text) ? null : text;
}
function elementHtml({ tag, attributes, scripts }) {
  const inside = scripts.map(({ type, name, text }) => `<script type="${type}"${name === void 0 ? "" : ` data-name="${escapeHtml(name)}"`}>${text}</script>`);
  return `<${tag}${attributesHtml(attributes)}>${inside.join("")}</${tag}>`;
}
function attributesHtml(attributes) {
  return Object.entries(attributes).map(([name, value]) => ` ${name}="${escapeHtml(value)}"`).join("");
}

// src/fence.ts
var FenceError = class extends Error {
};
function isObject(x) {
  return typeof x === "object" && x !== null && !Array.isArray(x);
}
function fenceKind(info) {
  const [first, second = "simlab"] = info.trim().split(/\s+/);
  if (first === "quiz") return "quiz";
  return first === "lab" && (second === "simlab" || second.startsWith("{")) ? "lab" : null;
}
function readFence(text) {
  let value;
  try {
    value = JSON.parse(text);
  } catch (e) {
    throw new FenceError(`invalid JSON (${messageOf(e)})`);
  }
  if (!isObject(value)) throw new FenceError("its JSON is not an object");
  return withoutClaims(value);
}
function withoutClaims(content) {
  const kept = Object.entries(content).filter(([key]) => key !== "verify" && key !== "lint");
  return Object.fromEntries(kept.map(([key, value]) => [key, key === "questions" && Array.isArray(value) ? value.map(questionWithoutClaims) : value]));
}
function questionWithoutClaims(question) {
  if (!isObject(question)) return question;
  const kept = Object.entries(withoutClaims(question));
  return Object.fromEntries(kept.map(([key, value]) => [key, key === "sim" && isObject(value) ? withoutClaims(value) : value]));
}
function mapLabs(kind, content, change) {
  if (kind === "lab") return change(content);
  const questions = content["questions"];
  if (!Array.isArray(questions)) return content;
  const changed = questions.map((question) => {
    if (!isObject(question)) return question;
    const sim = question["sim"];
    return isObject(sim) ? { ...question, sim: change(sim) } : question;
  });
  return { ...content, questions: changed };
}
function toJson(content) {
  const finite = (_, value) => {
    if (typeof value === "number" && !Number.isFinite(value)) throw new FenceError("a number is out of range");
    return value;
  };
  try {
    return JSON.stringify(content, finite);
  } catch (e) {
    throw e instanceof FenceError ? e : new FenceError(`the JSON cannot be written (${messageOf(e)})`);
  }
}
function messageOf(e) {
  return (e instanceof Error ? e.message : String(e)).replace(/\s+/g, " ");
}

// src/markdown.ts
var OPENING = /^(`{3,}(?=[^`]*$)|~{3,})(.*)$/;
var MARKER = /^([-+*]|\d{1,9}[.)])( {1,4}(?! )| +(?=\S)|$)/;
function findFences(lines) {
  const fences = [];
  const open = { quotes: 0, items: [] };
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
function unquote(line, most) {
  let [quotes, rest] = [0, expandTabs(line.replace(/\r$/, ""))];
  for (let mark = /^ {0,3}> ?/.exec(rest); mark !== null && quotes < most; mark = /^ {0,3}> ?/.exec(rest)) {
    rest = rest.slice(mark[0].length);
    quotes += 1;
  }
  return { quotes, rest };
}
function expandTabs(line) {
  const before = /^[\s>+*.)\d-]*/.exec(line)?.[0] ?? "";
  if (!before.includes("	")) return line;
  let out = "";
  for (const c of before) out += c === "	" ? " ".repeat(4 - out.length % 4) : c;
  return out + line.slice(before.length);
}
function enterItems(rest, open) {
  let text = rest.trimStart();
  let column = rest.length - text.length;
  if (text === "") return { column, text };
  open.items = open.items.filter((item) => item <= column);
  for (let marker = MARKER.exec(text); marker !== null && column - (open.items.at(-1) ?? 0) <= 3; marker = MARKER.exec(text)) {
    const width = marker[0].length;
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
function endOfHidden(lines, at, text) {
  const tag = /^<(script|pre|style|textarea)(?=[\s>]|$)/i.exec(text)?.[1];
  const end = text.startsWith("<!--") ? /-->/ : tag === void 0 ? null : /<\/(script|pre|style|textarea)>/i;
  if (end === null) return null;
  for (let i = at; i < lines.length; i += 1) if (end.test(lines[i] ?? "")) return i + 1;
  return lines.length;
}
function readBody(lines, start, { quotes, indent, column, marks }) {
  const body = [];
  const closing = new RegExp(`^ {0,3}\\${marks[0] ?? "`"}{${marks.length},} *$`);
  for (let i = start + 1; i < lines.length; i += 1) {
    const line = unquote(lines[i] ?? "", quotes);
    const spaces = line.rest.search(/\S|$/);
    const isBlank = spaces === line.rest.length;
    if (line.quotes < quotes || !isBlank && spaces < indent) return { end: i, body: body.join("") };
    const content = line.rest.slice(Math.min(spaces, indent));
    if (closing.test(content)) return { end: i + 1, body: body.join("") };
    body.push(`${line.rest.slice(Math.min(spaces, column))}
`);
  }
  return { end: lines.length, body: body.join("") };
}

// src/models.ts
import { existsSync, readFileSync, readdirSync, realpathSync, statSync } from "node:fs";
import { dirname, join, relative, resolve, sep } from "node:path";
var MAX_TEXT = 16 << 20;
var FILES = /\sfile(right|left|up|down|front|back)?\s*=/;
function readModel(name, options, lesson) {
  if (typeof options.models === "object") {
    const text = Object.hasOwn(options.models, name) ? options.models[name] : void 0;
    if (text === void 0) throw new FenceError(`the model \`${name}\` is not among the given models`);
    return inlineable(name, text, options);
  }
  const root = resolve(options.root ?? ".");
  const folder = modelFolder(options, root, lesson);
  if (!readdirSync(folder).includes(`${name}.xml`)) {
    throw new FenceError(`the model \`${name}\` does not exist in the folder \`${relative(root, folder).split(sep).join("/") || "."}\``);
  }
  const file = realpathSync(join(folder, `${name}.xml`));
  const isInside = [root, folder].some((outer) => file.startsWith(`${realpathSync(outer).replace(/[/\\]$/, "")}${sep}`));
  if (!isInside || !statSync(file).isFile()) throw new FenceError(`the model \`${name}\` is outside of the root, or not a file`);
  if (statSync(file).size > MAX_TEXT) throw new FenceError(`the model \`${name}\` is larger than ${MAX_TEXT >> 20} MB`);
  return inlineable(name, readFileSync(file, "utf8"), options);
}
function inlineable(name, text, { modelsUrl }) {
  if (modelsUrl === void 0 && FILES.test(text.replace(/<!--[^]*?-->/g, ""))) {
    throw new FenceError(`the model \`${name}\` reads other files, so pages must fetch it: set the address of the folder of models`);
  }
  return text;
}
function modelFolder({ models }, root, lesson) {
  if (typeof models === "string") {
    const folder = resolve(root, models);
    if (isFolder(folder)) return folder;
    throw new FenceError(`the folder of models \`${models}\` does not exist`);
  }
  for (let at = lesson === null ? root : dirname(resolve(root, lesson)); ; at = dirname(at)) {
    const folder = join(at, "models");
    if (isFolder(folder)) return folder;
    if (at === root || at === dirname(at)) throw new FenceError("no folder `models` is beside the lesson or above it");
  }
}
function isFolder(path) {
  return existsSync(path) && statSync(path).isDirectory();
}

// src/page.ts
function createPage(options = {}, lesson = null) {
  return { options, lesson, ids: /* @__PURE__ */ new Set(), labs: 0 };
}
function convertFence(info, text, page) {
  const kind = fenceKind(info);
  if (kind === null) return null;
  if (kind === "lab") page.labs += 1;
  try {
    const read = readFence(text);
    const models = modelsOf(kind, read, page);
    const { content, inScripts } = placeModels(kind, read, models, page.options);
    const json = toJson(content);
    const id = uniqueId(kind === "lab" ? `lab-${page.labs}` : `quiz-${slug(content["id"])}`, page);
    return { kind, element: elementOf(kind, id, json, inScripts, page.options), content, models };
  } catch (e) {
    if (!(e instanceof FenceError)) throw e;
    return { kind, element: null, message: `This ${kind} cannot be displayed: ${e.message}` };
  }
}
function modelsOf(kind, content, { options, lesson }) {
  const models = [];
  mapLabs(kind, content, (lab) => {
    const name = lab["model"];
    const hasFolder = options.modelsUrl === void 0 || options.models !== void 0;
    if (typeof name === "string" && options.models !== false && hasFolder) models.push([name, readModel(name, options, lesson)]);
    return lab;
  });
  return options.modelsUrl === void 0 ? Object.fromEntries(models) : {};
}
function placeModels(kind, content, models, { form }) {
  const inScripts = [];
  for (const [name, xml] of Object.entries(models)) {
    const text = form === "attribute" ? null : modelInScript(xml);
    if (text !== null) inScripts.push({ type: "model/mjcf", name, text });
  }
  const placed = mapLabs(kind, content, (lab) => {
    const name = lab["model"];
    const text = typeof name === "string" && Object.hasOwn(models, name) ? models[name] : void 0;
    if (text === void 0 || inScripts.some((script) => script.name === name)) return lab;
    return Object.fromEntries(Object.entries(lab).map(([key, value]) => key === "model" ? ["xml", text] : [key, value]));
  });
  return { content: placed, inScripts };
}
function elementOf(kind, id, json, models, { form, modelsUrl }) {
  const attributes = { id };
  if (modelsUrl !== void 0) attributes["models"] = modelsUrl;
  const tag = kind === "lab" ? "sim-lab" : "lesson-quiz";
  if (form === "attribute") {
    attributes["src"] = `data:application/json;base64,${Buffer.from(json, "utf8").toString("base64")}`;
    return { tag, attributes, scripts: [] };
  }
  return { tag, attributes, scripts: [{ type: "application/json", text: jsonInScript(json) }, ...models] };
}
function uniqueId(wanted, { ids }) {
  let id = wanted;
  for (let n = 2; ids.has(id); n += 1) id = `${wanted}-${n}`;
  ids.add(id);
  return id;
}
function slug(text) {
  return typeof text === "string" ? text.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").slice(0, 80) : "";
}

// src/entry/core.ts
function messageHtml(message) {
  const text = escapeHtml(message).replace(/[{}]/g, (c) => `&#${c.charCodeAt(0)};`);
  return `<p class="labspec-message" role="note"><strong>${text}.</strong></p>`;
}

// src/entry/mdbook.ts
import { join as join2 } from "node:path";
function supports(renderer) {
  return renderer === "html";
}
function preprocess(input) {
  const [context, book] = Array.isArray(input) ? input : [];
  if (!isObject(context) || !isObject(book)) throw new Error("the input is not a context and a book");
  const settings = readSettings(context);
  const messages = [];
  const waiting = [book["items"], book["sections"]].flatMap((list) => Array.isArray(list) ? list : []);
  for (const item of waiting) {
    const chapter = isObject(item) ? item["Chapter"] : null;
    if (!isObject(chapter)) continue;
    if (Array.isArray(chapter["sub_items"])) waiting.push(...chapter["sub_items"]);
    convertChapter(chapter, settings, messages);
  }
  return { book, messages };
}
function readSettings(context) {
  const tableOf = (from, key) => {
    const value = isObject(from) ? from[key] : null;
    return isObject(value) ? value : {};
  };
  const table = tableOf(tableOf(context["config"], "preprocessor"), "labspec");
  const textOf = (value) => typeof value === "string" ? value : void 0;
  const root = textOf(context["root"]) ?? ".";
  return {
    options: { root, models: textOf(table["models"]), modelsUrl: textOf(table["models-url"]) },
    source: join2(root, textOf(tableOf(context["config"], "book")["src"]) ?? "src"),
    script: table["script"] === false ? null : textOf(table["script"]) ?? "labspec-elements.js"
  };
}
function convertChapter(chapter, { options, source, script }, messages) {
  const [text, path, file] = [chapter["content"], chapter["path"], chapter["source_path"]];
  if (typeof text !== "string") return;
  const page = createPage(options, typeof file === "string" ? join2(source, file) : null);
  const converted = convertText(text, page, (message) => messages.push(`${String(file ?? chapter["name"])}: ${message}`));
  const needsScript = script !== null && page.ids.size > 0;
  chapter["content"] = needsScript ? `${converted}

<script type="module" src="${addressFrom(String(path ?? ""), script)}"></script>
` : converted;
}
function convertText(text, page, report) {
  const lines = text.split("\n");
  const out = [];
  let at = 0;
  for (const { start, end, info, body, prefix, head } of findFences(lines)) {
    const converted = convertFence(info, body, page);
    if (converted === null) continue;
    out.push(...lines.slice(at, start));
    at = end;
    if (converted.element !== null) out.push(`${head}<div class="labspec">${elementHtml(converted.element)}</div>`, prefix.trimEnd());
    else {
      report(converted.message);
      const [first = "", ...rest] = lines.slice(start, end);
      out.push(`${head}${messageHtml(converted.message)}`, prefix.trimEnd(), `${prefix}${first.slice(head.length)}`, ...rest);
    }
  }
  return [...out, ...lines.slice(at)].join("\n");
}
function addressFrom(chapter, address) {
  const escaped = address.replaceAll("&", "&amp;").replaceAll('"', "&quot;").replaceAll("<", "&lt;");
  return /^([a-z][a-z0-9+.-]*:|\/)/i.test(address) ? escaped : "../".repeat(chapter.split(/[/\\]/).length - 1) + escaped;
}
export {
  convertText,
  preprocess,
  supports
};
