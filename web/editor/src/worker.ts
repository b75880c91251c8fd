/** The checker in a worker: one question after the other, with the models as they are then. */
import { Checker } from "labspec/checker";
import type { Answers, FileChanges, Question, Reply, Request } from "./protocol.js";

const port = globalThis as unknown as { postMessage(message: Reply): void; onmessage: ((event: MessageEvent<Request>) => void) | null };
const files = new Map<string, string | Uint8Array>();
let checker = new Checker();

function change(changes: FileChanges): void {
  const names = Object.entries(changes);
  if (names.length === 0) return;
  for (const [name, content] of names) {
    if (content === null) files.delete(name);
    else files.set(name, content);
  }
  checker.free();
  checker = new Checker(Object.fromEntries(files));
}

function answer({ question, path, text, offset }: Request): Answers[Question] {
  switch (question) {
    case "findings": return checker.findings(path, text);
    case "complete": return checker.complete(path, text, offset);
    case "hover": return checker.hover(path, text, offset);
    case "fixAll": return checker.fixAll(path, text);
    case "labs": return checker.labs(path, text);
    case "format": return checker.format(path, text);
    case "check": return checker.check(path, text);
  }
}

port.onmessage = ({ data }) => {
  try {
    change(data.models);
    port.postMessage({ id: data.id, answer: answer(data) });
  } catch (e) {
    port.postMessage({ id: data.id, error: e instanceof Error ? e.message : String(e) });
  }
};
port.postMessage({ ready: true });
