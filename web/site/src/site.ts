/** What every page of a site does: labs, formulas, the search, the copy for reading offline. */
import { besideScript, siteFile } from "./files.js";
import { drawFormulas } from "./math.js";
import { startSearch } from "./search.js";

/** Loads the elements, where a page has labs or quizzes. */
async function startElements(): Promise<void> {
  if (document.querySelector("sim-lab, lesson-quiz") !== null) await import(besideScript("elements.js"));
}

/** Keeps a copy of the site in the browser, where the page offers it and the browser allows it. */
async function keepOffline(): Promise<void> {
  if (document.body.dataset["offline"] === undefined || !("serviceWorker" in navigator) || !isSecureContext) return;
  await navigator.serviceWorker.register(siteFile("sw.js"));
}

startSearch();
for (const part of [startElements(), drawFormulas(document)]) {
  // Without this part, the page shows what it shows without scripts.
  part.catch((e: unknown) => console.error(e));
}
// A browser may forbid storage; the page works without it.
addEventListener("load", () => void keepOffline().catch(() => undefined));
