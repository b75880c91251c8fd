import { inlined } from "./inlined.js";
import { load } from "./load-browser.js";

await load(inlined);

export * from "../api.js";
