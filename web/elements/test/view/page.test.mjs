// Views of a page in Chromium: one context for all, what is drawn when, sizes, picking, PNG.
import assert from "node:assert/strict";
import { after, afterEach, before, test } from "node:test";
import { openPage, recorded } from "./common.mjs";

let chromium, page;
before(async () => {
  chromium = await openPage(1);
  ({ page } = chromium);
  await page.evaluate(() => {
    globalThis.drawn = 0;
    globalThis.contexts = 0;
    const { drawElementsInstanced } = WebGL2RenderingContext.prototype;
    WebGL2RenderingContext.prototype.drawElementsInstanced = function (...args) {
      globalThis.drawn++;
      return drawElementsInstanced.apply(this, args);
    };
    const { getContext } = OffscreenCanvas.prototype;
    OffscreenCanvas.prototype.getContext = function (...args) {
      globalThis.contexts++;
      return getContext.apply(this, args);
    };
    // Draw calls of an action, and those of the observers that it wakes.
    globalThis.drawsOf = async action => {
      const before = globalThis.drawn;
      action();
      await globalThis.settle();
      return globalThis.drawn - before;
    };
    globalThis.settle = async () => {
      for (let i = 0; i < 3; i++) await new Promise(resolve => requestAnimationFrame(() => setTimeout(resolve)));
    };
    globalThis.opaque = canvas => {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      return data.filter((v, i) => i % 4 === 3 && v > 100).length;
    };
  });
});
after(async () => {
  await chromium.stop();
  assert.deepEqual(chromium.errors, []);
});
afterEach(() => page.evaluate(() => { document.body.replaceChildren(); }));

test("40 views share one context, and the last one frees it", async () => {
  const result = await page.evaluate(async s => {
    const before = contexts, views = Array.from({ length: 40 }, () => show(s, { width: 100, height: 80 }));
    const pictures = views.map(v => opaque(v.canvas)), made = contexts - before, shared = view.sharedContext();
    views.forEach(v => { v.view.draw(); });
    for (const v of views) v.view.dispose();
    return { pictures, made, isLost: shared.gpu.gl.isContextLost() };
  }, recorded("incline"));
  assert.equal(result.made, 1);
  assert.ok(result.pictures.every(n => n === result.pictures[0] && n > 500), String(result.pictures));
  assert.equal(result.isLost, true);
});

test("nothing is drawn while nothing changes", async () => {
  const draws = await page.evaluate(async s => {
    const { view, scene, canvas } = show(s);
    await settle();
    const out = {};
    out.same = await drawsOf(() => { view.draw(); view.draw(); });
    out.frame = await drawsOf(() => { view.setFrame(scene.frame); view.draw(); });
    out.camera = await drawsOf(() => { view.camera.azimuth += 10; view.draw(); });
    out.target = await drawsOf(() => { view.camera.target[2] += 0.1; view.draw(); });
    out.overlay = await drawsOf(() => { view.overlays.frames = true; view.draw(); });
    out.restored = await drawsOf(() => { canvas.dispatchEvent(new Event("contextrestored")); });
    out.theme = await drawsOf(() => { view.setTheme({ background: "#000", highContrast: true }); view.draw(); });
    out.drag = await drawsOf(() => { view.setDrag({ from: [0, 0, 0], to: [0, 0, 1] }); view.draw(); });
    out.noDrag = await drawsOf(() => { view.setDrag(null); view.draw(); });
    out.stillNoDrag = await drawsOf(() => { view.setDrag(null); view.draw(); });
    view.dispose();
    out.disposed = await drawsOf(() => { view.setFrame(scene.frame); view.draw(); });
    return out;
  }, recorded("arm2"));
  const { same, stillNoDrag, disposed, ...others } = draws;
  assert.deepEqual({ same, stillNoDrag, disposed }, { same: 0, stillNoDrag: 0, disposed: 0 });
  for (const [what, n] of Object.entries(others)) assert.ok(n > 0, `${what} is drawn`);
});

test("a view off screen is drawn when it comes back", async () => {
  const draws = await page.evaluate(async s => {
    const { view, canvas, scene } = show(s);
    await settle();
    const spacer = document.createElement("div");
    spacer.style.height = "5000px";
    document.body.prepend(spacer);
    await settle();
    await settle();
    const hidden = await drawsOf(() => { view.setFrame(scene.frame); view.draw(); });
    const back = await drawsOf(() => { canvas.scrollIntoView(); });
    view.dispose();
    return { hidden, back };
  }, recorded("arm2"));
  assert.equal(draws.hidden, 0);
  assert.ok(draws.back > 0);
});

test("the picture has the pixels of its size on the page", async () => {
  const sizes = await page.evaluate(async s => {
    const { view, canvas } = show(s, { width: 200, height: 100 });
    await settle();
    const first = [canvas.width, canvas.height];
    canvas.style.width = "333px";
    await settle();
    await settle();
    const second = [canvas.width, canvas.height], seen = opaque(canvas);
    view.dispose();
    return { first, second, seen };
  }, recorded("incline"));
  assert.deepEqual(sizes.first, [200, 100]);
  assert.deepEqual(sizes.second, [333, 100]);
  assert.ok(sizes.seen > 1000);
  const dense = await openPage(2);
  const size = await dense.page.evaluate(s => {
    const { canvas } = show(s, { width: 200, height: 100 });
    return [canvas.width, canvas.height];
  }, recorded("incline"));
  await dense.stop();
  assert.deepEqual(size, [400, 200]);
});

test("a screen with other pixels gives the picture other pixels", async () => {
  const other = await openPage(), devtools = await other.page.context().newCDPSession(other.page);
  await other.page.evaluate(s => {
    // Emulation changes the pixels, and does not always send the event: the test sends it.
    const { matchMedia } = globalThis;
    globalThis.queries = [];
    globalThis.matchMedia = query => {
      const list = matchMedia.call(globalThis, query);
      queries.push(list);
      return list;
    };
    globalThis.shown = show(s, { width: 200, height: 100 });
  }, recorded("incline"));
  const widths = [];
  for (const deviceScaleFactor of [1, 2, 3]) {
    await devtools.send("Emulation.setDeviceMetricsOverride", { width: 900, height: 700, deviceScaleFactor, mobile: false });
    widths.push(await other.page.evaluate(() => {
      queries.at(-1).dispatchEvent(new Event("change"));
      return shown.canvas.width;
    }));
  }
  const [media, late] = await other.page.evaluate(() => {
    shown.view.dispose();
    const before = queries.length;
    queries.at(-1).dispatchEvent(new Event("change"));
    return [queries.map(q => q.media), queries.length - before];
  });
  await other.stop();
  assert.deepEqual(widths, [200, 400, 400]);
  // Some versions send the event themselves, too: a query more for the same pixels.
  assert.deepEqual([...new Set(media)], ["(resolution: 1dppx)", "(resolution: 2dppx)", "(resolution: 3dppx)"]);
  assert.equal(late, 0);
});

test("meshes and textures are uploaded once, and freed with the last view", async () => {
  const result = await page.evaluate(([mesh, looks]) => {
    let uploads = 0;
    const { bufferData } = WebGL2RenderingContext.prototype;
    WebGL2RenderingContext.prototype.bufferData = function (target, ...args) {
      if (target === 0x8893) uploads++;
      return bufferData.call(this, target, ...args);
    };
    const keeper = show(looks), start = view.sharedContext().uploads;
    const a = show(mesh), one = view.sharedContext().uploads, after = uploads;
    const b = show(mesh);
    b.view.setModel({ ...b.scene.model, geom_rgba: Float64Array.from(b.scene.model.geom_rgba, () => 0.7) });
    b.view.draw();
    const again = uploads - after;
    a.view.dispose();
    const shared = view.sharedContext().uploads;
    b.view.dispose();
    const end = view.sharedContext().uploads;
    keeper.view.dispose();
    WebGL2RenderingContext.prototype.bufferData = bufferData;
    return { start, one, again, shared, end, meshes: mesh.model.mesh_vertadr.length };
  }, [recorded("mesh_builtin"), recorded("looks")]);
  assert.equal(result.one.shapes, result.start.shapes + result.meshes);
  assert.equal(result.again, 0);
  assert.deepEqual(result.shared, result.one);
  assert.deepEqual(result.end, result.start);
  assert.equal(result.start.textures, recorded("looks").model.textures.length);
});

test("a changed height field is uploaded again", async () => {
  const changed = await page.evaluate(s => {
    const { view, canvas, scene } = show(s), before = read(canvas);
    view.setModel({ ...scene.model, hfield_data: Float64Array.from(scene.model.hfield_data, () => 0) });
    view.draw();
    const after = read(canvas);
    view.dispose();
    return before !== after;
  }, recorded("hfield"));
  assert.ok(changed);
});

test("picks the geom under a point, and a point under the pointer", async () => {
  const result = await page.evaluate(s => {
    const { view, scene } = show(s, { width: 320, height: 240 });
    const middle = view.pick(160, 120), sky = view.pick(2, 2);
    const same = middle && view.unproject(160, 120, middle.point), moved = middle && view.unproject(200, 90, middle.point);
    view.dispose();
    return { middle, sky, same, moved, bodies: Array.from(scene.model.geom_bodyid) };
  }, { ...recorded("tumbling_box"), camera: { azimuth: 90, elevation: 0, distance: 1, target: recorded("tumbling_box").frame.geom_xpos.slice(0, 3) } });
  assert.equal(result.sky, null);
  assert.equal(result.middle.body, result.bodies[result.middle.geom]);
  assert.ok(result.middle.distance > 0.5 && result.middle.distance < 1);
  result.same.forEach((x, i) => assert.ok(Math.abs(x - result.middle.point[i]) < 1e-9));
  // The camera looks along +y: to the right is +x, up is +z.
  assert.ok(result.moved[0] > result.middle.point[0] && result.moved[2] > result.middle.point[2]);
  assert.ok(Math.abs(result.moved[1] - result.middle.point[1]) < 1e-9);
});

test("the trail follows a site until time goes back", async () => {
  const counts = await page.evaluate(s => {
    const { view, canvas, scene } = show(s, { trail: 0, edit: { geom_rgba: s.model.geom_rgba.map(() => 0) } });
    const go = t => {
      view.setFrame({ ...scene.frame, time: t, site_xpos: Float64Array.of(0.5 * Math.sin(t), 0, 0.75 + 0.5 * Math.cos(t)) });
      view.draw();
    };
    const out = [opaque(canvas)];
    for (let t = 1; t < 5; t += 0.02) go(t);
    out.push(opaque(canvas));
    go(0);
    out.push(opaque(canvas));
    view.clearTrail();
    view.dispose();
    return out;
  }, recorded("double_pendulum"));
  assert.equal(counts[0], 0);
  assert.ok(counts[1] > 200, String(counts));
  assert.equal(counts[2], 0);
});

test("a PNG has the size asked for, and the scene", async () => {
  const result = await page.evaluate(async s => {
    const { view, canvas } = show(s, { theme: { background: "#ffffff", highContrast: false } });
    const blob = await view.toPng(1200, 900), image = await createImageBitmap(blob);
    const copy = new OffscreenCanvas(image.width, image.height).getContext("2d");
    copy.drawImage(image, 0, 0);
    const { data } = copy.getImageData(0, 0, image.width, image.height);
    const colored = data.filter((v, i) => i % 4 === 0 && v < 200).length;
    view.camera.azimuth += 1;
    view.draw();
    const shared = globalThis.view.sharedContext().canvas;
    view.dispose();
    return { type: blob.type, size: [image.width, image.height], colored, shared: [shared.width, shared.height], own: [canvas.width, canvas.height] };
  }, recorded("arm2"));
  assert.equal(result.type, "image/png");
  assert.deepEqual(result.size, [1200, 900]);
  assert.ok(result.colored > 10000);
  assert.deepEqual(result.shared, result.own);
});

test("a model without geoms, and numbers that are not finite, draw nothing and do not fail", async () => {
  const count = await page.evaluate(s => {
    const scene = decode(s), none = { geom_type: new Int32Array(), geom_xpos: new Float64Array() };
    const canvas = document.createElement("canvas");
    canvas.style.cssText = "";
    document.body.append(canvas);
    const v = view.createView(canvas, { ...scene.model, ...none });
    v.setFrame({ ...scene.frame, ...none });
    v.draw();
    const nothing = opaque(canvas);
    v.setModel(scene.model);
    v.setFrame({ ...scene.frame, geom_xpos: scene.frame.geom_xpos.map(() => NaN) });
    v.draw();
    v.dispose();
    return nothing;
  }, recorded("joint_zoo"));
  assert.equal(count, 0);
});
