/** The page of the preview: it follows the files, and has the tools of an author. */
import { patchPage } from "./patch.js";
import { startTools } from "./tools.js";

const metaIn = (page: ParentNode, name: string): string => page.querySelector<HTMLMetaElement>(`meta[name='labspec-${name}']`)?.content ?? "";

/** The version that the page shows. */
let displayed = metaIn(document, "version");
let running: Promise<void> = Promise.resolve();

/** Fetches the page again, and brings what has changed into this one. */
async function update(version: string): Promise<void> {
  if (version === displayed) return;
  const response = await fetch(location.pathname, { cache: "no-store" });
  if (!response.ok) {
    // The lesson of this page was removed or renamed.
    if (response.status === 404) location.assign("/");
    return;
  }
  const fresh = new DOMParser().parseFromString(await response.text(), "text/html");
  const main = document.querySelector("main");
  // An index, or the page of a preview that has ended: another one has another token.
  if (main?.dataset["page"] === undefined || metaIn(fresh, "token") !== metaIn(document, "token")) return location.reload();
  await patchPage(fresh);
  displayed = metaIn(fresh, "version");
}

const main = document.querySelector("main");
if (main !== null) startTools(main);
const events = new EventSource("/_labspec/events");
events.addEventListener("message", ({ data }: MessageEvent<unknown>) => {
  running = running.then(() => update(String(data))).catch((e: unknown) => console.error(e));
});
events.addEventListener("error", () => {
  // The versions of another preview begin again.
  displayed = "";
  document.body.classList.add("disconnected");
});
events.addEventListener("open", () => document.body.classList.remove("disconnected"));
