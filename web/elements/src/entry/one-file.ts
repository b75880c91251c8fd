/** Everything in one file: the elements, their styles, the engine and its module. */
import { serve } from "#engine";
import { compile } from "#module";
import { setEngineSource } from "../engine/client.js";
import { defineElements } from "./define.js";
import { render } from "./widget.js";

export * from "./define.js";
export default { render };

setEngineSource({
  serve,
  workerUrl: null,
  module: compile,
});
defineElements();
