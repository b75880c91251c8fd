import { inlined } from "./inlined.js";
import { fetched } from "./load-browser.js";

// The request for the module starts before the script that uses it: this file has no static imports.
const control = new AbortController();
const module = fetched(control.signal).then((found) => found ?? (control.signal.aborted ? undefined : inlined()));
module.catch(() => undefined);
// The first script imports the second one: both are requested at once.
const [core] = await Promise.all([import("../core.js"), import("../error.js")]);
// Another entry has made it ready.
if (core.isReady()) control.abort();
else {
  const found = await module;
  if (found !== undefined) core.start(found);
}

export const { Data, Expression, Lab, LabState, LabspecError, Model, isReady } = core;
