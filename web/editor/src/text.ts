/** Texts of the checker as elements: paragraphs, code and emphasis of Markdown. Nothing in them becomes HTML. */

/** Creates an element with a class and children. */
export function element(name: string, className: string, ...children: (string | Node)[]): HTMLElement {
  const made = document.createElement(name);
  if (className !== "") made.className = className;
  made.append(...children);
  return made;
}

/** The Markdown of a hover text or a completion. */
export function renderMarkdown(text: string): HTMLElement {
  const body = element("div", "lab-doc");
  for (const [i, part] of text.split(/^```\w*$/m).entries()) {
    if (i % 2 === 1) {
      body.append(element("pre", "", element("code", "", part.trim())));
      continue;
    }
    for (const paragraph of part.split(/\n{2,}/)) if (paragraph.trim() !== "") body.append(element("p", "", ...inline(paragraph.trim())));
  }
  return body;
}

/** The text without marks, to be spoken. */
export function plainText(text: string): string {
  return text.replaceAll(/^```\w*$/gm, "").replaceAll(/\*\*|`/g, "").replaceAll(/\[([^\]]*)\]\([^)]*\)/g, "$1").replaceAll(/\s+/g, " ").trim();
}

function inline(text: string): (string | Node)[] {
  return text.split(/(`[^`]+`|\*\*[^*]+\*\*|\[[^\]]*\]\([^)]*\))/).filter((part) => part !== "").map((part) => {
    if (part.startsWith("`") && part.length > 2) return element("code", "", part.slice(1, -1));
    if (part.startsWith("**") && part.length > 4) return element("strong", "", ...inline(part.slice(2, -2)));
    const link = /^\[([^\]]*)\]\([^)]*\)$/.exec(part);
    return link === null ? part : (link[1] ?? "");
  });
}
