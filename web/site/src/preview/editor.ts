/** Where the source of a block is edited in place, with findings, completions and explanations from the server of the preview. */
import { CheckerClient, mountEditor as mountCode } from "labspec-editor";

type Answers = Awaited<ReturnType<CheckerClient["ask"]>>;
type Question = Parameters<CheckerClient["ask"]>[0];

/** What the server says of a text of the block. */
export type Assist = (question: "findings" | "complete" | "hover", text: string, offset: number) => Promise<Readonly<Record<string, unknown>>>;

/** An open editor. */
export interface Editor {
  focus(): void;
  close(): void;
}

/** The name of the block for the editor. Its ending says that it is Markdown. */
const PATH = "block.md";

/** A checker that asks the server, which knows the lesson around the block, its models and the lessons beside it. */
class ServerChecker extends CheckerClient {
  readonly #assist: Assist;

  constructor(assist: Assist) {
    super(() => { throw new Error("the server of the preview checks"); });
    this.#assist = assist;
  }

  override async ask<Q extends Exclude<Question, "check">>(question: Q, _path: string, text: string, offset = 0): Promise<never> {
    // The server answers in the form of the checker; findings lack the name of the file.
    const answer = async (): Promise<unknown> => {
      if (question === "findings") {
        const { findings } = await this.#assist("findings", text, 0);
        return (findings as object[]).map((finding) => ({ ...finding, file: PATH }));
      }
      if (question === "complete") return (await this.#assist("complete", text, offset))["completions"];
      if (question === "hover") return (await this.#assist("hover", text, offset))["hover"];
      // Formatting belongs to the whole lesson.
      return question === "format" ? text : null;
    };
    return (await answer()) as Answers as never;
  }
}

/** Opens an editor in `host`. `onSave` stores the text; where it fails, the editor stays open and shows why. */
export function mountEditor(host: HTMLElement, text: string, assist: Assist, onSave: (text: string) => Promise<void>): Editor {
  const [form, place, bar, save, cancel, message] = [
    document.createElement("form"), document.createElement("div"), document.createElement("div"), document.createElement("button"),
    document.createElement("button"), document.createElement("p"),
  ];
  form.className = "source-editor";
  place.className = "source";
  [save.type, save.textContent, cancel.type, cancel.textContent] = ["submit", "Save", "button", "Cancel"];
  message.setAttribute("role", "alert");
  bar.append(save, cancel);
  form.append(place, bar, message);
  host.append(form);
  const editor = mountCode(place, {
    text, path: PATH, language: "markdown", checker: new ServerChecker(assist), label: "Source of this block", onSave: () => form.requestSubmit(),
    // The file has changed meanwhile; the text stays.
    onFailure: (why) => { message.textContent = why; },
    onFindings: () => { message.textContent = ""; },
  });
  const close = (): void => {
    editor.dispose();
    form.remove();
  };
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    save.disabled = true;
    onSave(editor.text).then(close, (e: unknown) => {
      save.disabled = false;
      message.textContent = e instanceof Error ? e.message : String(e);
    });
  });
  form.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && !event.defaultPrevented && editor.text === text) close();
  });
  cancel.addEventListener("click", close);
  return { focus: () => editor.focus(), close };
}
