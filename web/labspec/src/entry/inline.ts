import { start } from "../glue.js";
import { isReady } from "../state.js";
import { inlined } from "./inlined.js";

if (!isReady()) start(await inlined());

export * from "../api.js";
