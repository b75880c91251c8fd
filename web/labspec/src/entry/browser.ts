import { inlined } from "./inlined.js";
import { fetched } from "./load-browser.js";

// The module is on its way before the script that uses it: this file imports nothing at once.
const control = new AbortController();
const module = fetched(control.signal).then((found) => found ?? (control.signal.aborted ? undefined : inlined()));
module.catch(() => undefined);
// The second one is imported by the first: it need not wait for it.
const [core] = await Promise.all([import("../core.js"), import("../error.js")]);
// Another entry has made it ready.
if (core.isReady()) control.abort();
else {
  const found = await module;
  if (found !== undefined) core.start(found);
}

export const { Data, Expression, Lab, LabState, LabspecError, Model, isReady } = core;
