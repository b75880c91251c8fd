/** Where the source of a block is edited in place. An editor with completion replaces this one function. */

/** An open editor. */
export interface Editor {
  focus(): void;
  close(): void;
}

/** Opens an editor in `host`. `onSave` stores the text; where it fails, the editor stays open and shows why. */
export function mountEditor(host: HTMLElement, text: string, onSave: (text: string) => Promise<void>): Editor {
  const [form, area, bar, save, cancel, said] = [
    document.createElement("form"), document.createElement("textarea"), document.createElement("div"), document.createElement("button"),
    document.createElement("button"), document.createElement("p"),
  ];
  form.className = "source-editor";
  area.value = text;
  area.rows = Math.min(30, text.split("\n").length + 1);
  area.spellcheck = false;
  area.setAttribute("aria-label", "Source of this block");
  [save.type, save.textContent, cancel.type, cancel.textContent] = ["submit", "Save", "button", "Cancel"];
  said.setAttribute("role", "alert");
  bar.append(save, cancel);
  form.append(area, bar, said);
  const close = (): void => form.remove();
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    save.disabled = true;
    onSave(area.value).then(close, (e: unknown) => {
      save.disabled = false;
      said.textContent = e instanceof Error ? e.message : String(e);
    });
  });
  form.addEventListener("keydown", (event) => {
    if (event.key === "s" && (event.ctrlKey || event.metaKey)) {
      event.preventDefault();
      form.requestSubmit();
    } else if (event.key === "Escape" && area.value === text) close();
  });
  cancel.addEventListener("click", close);
  host.append(form);
  return { focus: () => area.focus(), close };
}
