// The WebGL context of a page in Chromium: lost, refused, absent.
import assert from "node:assert/strict";
import { test } from "node:test";
import { openPage, recorded } from "./common.mjs";

test("a lost context is replaced, and every view is drawn again", async () => {
  const other = await openPage();
  const result = await other.page.evaluate(async s => {
    const opaque = canvas => canvas.getContext("2d").getImageData(0, 0, 320, 240).data.filter((v, i) => i % 4 === 3 && v > 100).length;
    const views = [show(s), show(s)], before = views.map(v => opaque(v.canvas));
    const lost = view.sharedContext();
    lost.gpu.gl.getExtension("WEBGL_lose_context").loseContext();
    for (const v of views) v.canvas.getContext("2d").clearRect(0, 0, 1000, 1000);
    await new Promise(resolve => setTimeout(resolve, 500));
    const after = views.map(v => opaque(v.canvas)), isNew = view.sharedContext() !== lost;
    for (const v of views) v.view.dispose();
    return { before, after, isNew };
  }, recorded("mesh_builtin"));
  await other.stop();
  assert.deepEqual(result.after, result.before);
  assert.ok(result.before[0] > 1000 && result.isNew);
});

test("a running lab draws in the new context before all views do, and its meshes are freed there", async () => {
  const other = await openPage();
  const result = await other.page.evaluate(async ([plain, mesh]) => {
    const keeper = show(plain), running = show(mesh), lost = view.sharedContext();
    lost.gpu.gl.getExtension("WEBGL_lose_context").loseContext();
    running.view.setFrame(running.scene.frame);
    running.view.draw();
    await new Promise(resolve => setTimeout(resolve, 500));
    const before = view.sharedContext().uploads.shapes;
    running.view.dispose();
    const after = view.sharedContext().uploads.shapes;
    keeper.view.dispose();
    return { isNew: view.sharedContext() !== lost, freed: before - after, meshes: mesh.model.mesh_vertadr.length };
  }, [recorded("incline"), recorded("mesh_builtin")]);
  await other.stop();
  assert.ok(result.isNew);
  assert.equal(result.freed, result.meshes);
});

test("without WebGL there is no view; one may come later, on a canvas of the document", async () => {
  const other = await openPage();
  const result = await other.page.evaluate(async s => {
    const canvas = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...args) { return kind === "webgl2" ? null : canvas.call(this, kind, ...args); };
    OffscreenCanvas.prototype.getContext = () => null;
    let message = "";
    try {
      show(s);
    } catch (error) {
      ({ message } = error);
    }
    HTMLCanvasElement.prototype.getContext = canvas;
    await new Promise(resolve => setTimeout(resolve, 200));
    // Some browsers have WebGL 2 for canvases of the document only.
    const shown = show(s), kind = view.sharedContext().canvas.constructor.name;
    const drawn = shown.canvas.getContext("2d").getImageData(0, 0, 320, 240).data.filter((v, i) => i % 4 === 3 && v > 100).length;
    shown.view.dispose();
    return { message, kind, drawn };
  }, recorded("incline"));
  await other.stop();
  assert.equal(result.message, "the 3D view needs WebGL 2");
  assert.equal(result.kind, "HTMLCanvasElement");
  assert.ok(result.drawn > 5000);
});

test("while the browser refuses a context, a view waits for one", async () => {
  const other = await openPage();
  const drawn = await other.page.evaluate(async s => {
    const { getContext } = OffscreenCanvas.prototype, count = canvas => canvas.getContext("2d").getImageData(0, 0, 320, 240).data.filter((v, i) => i % 4 === 3 && v > 100).length;
    const shown = show(s), before = count(shown.canvas), onPage = HTMLCanvasElement.prototype.getContext;
    OffscreenCanvas.prototype.getContext = () => null;
    HTMLCanvasElement.prototype.getContext = function (kind, ...args) { return kind === "webgl2" ? null : onPage.call(this, kind, ...args); };
    view.sharedContext().gpu.gl.getExtension("WEBGL_lose_context").loseContext();
    shown.canvas.getContext("2d").clearRect(0, 0, 320, 240);
    await new Promise(resolve => setTimeout(resolve, 400));
    shown.view.draw();
    const without = count(shown.canvas);
    OffscreenCanvas.prototype.getContext = getContext;
    await new Promise(resolve => setTimeout(resolve, 1500));
    return { before, without, after: count(shown.canvas) };
  }, recorded("incline"));
  await other.stop();
  assert.equal(drawn.without, 0);
  assert.ok(drawn.before > 5000 && drawn.after === drawn.before, JSON.stringify(drawn));
});
