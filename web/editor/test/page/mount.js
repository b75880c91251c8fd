// The page of the tests: one editor of a lesson, and what it told.
import { mountEditor } from "labspec-editor";

const drop = "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body name='bob' pos='0 0 1'><freejoint/><geom name='ball' size='.1'/></body></worldbody></mujoco>";
globalThis.told = { texts: [], saved: [], failures: [] };
globalThis.mount = (text, options = {}) => {
  globalThis.editor = mountEditor(document.querySelector("#host"), {
    text, language: "markdown", path: "lesson.md", label: "The lesson", models: { drop },
    checker: () => new Worker(options.worker ?? "/checker/worker.js", { type: "module" }),
    onChange: (now) => globalThis.told.texts.push(now), onSave: (now) => globalThis.told.saved.push(now),
    onFailure: (why) => globalThis.told.failures.push(why),
  });
};
globalThis.isReady = true;
