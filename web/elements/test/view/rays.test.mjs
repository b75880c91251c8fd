// Rays, cameras and silhouettes against recordings of the MuJoCo library (golden/record.py).
import assert from "node:assert/strict";
import test from "node:test";
import { modules, NAMES, pixels, poseOf, scene, SIZE } from "./common.mjs";

const { castRay, defaultCamera, labCamera, rayGeom, placeEye, pointFacing, projectionOf, rayThrough } = await modules("ray", "camera");
const [WIDTH, HEIGHT] = SIZE;
const PLANE = 0;

test("rays meet geoms where mj_ray says", () => {
  let hits = 0;
  for (const name of NAMES) {
    const { model, frame, rays } = scene(name);
    for (const ray of rays) {
      const hit = castRay(model, frame, ray);
      const where = `${name}: from ${ray.from} along ${ray.direction}, geom ${ray.geom} at ${ray.distance}, found ${hit?.geom} at ${hit?.distance}`;
      assert.equal(hit?.geom ?? -1, ray.geom, where);
      if (!hit) continue;
      hits++;
      assert.ok(Math.abs(hit.distance - ray.distance) < 1e-6 * Math.max(1, ray.distance), where);
      ray.from.forEach((x, i) => assert.ok(Math.abs(x + hit.distance * ray.direction[i] - hit.point[i]) < 1e-9));
    }
  }
  assert.ok(hits > 500, `${hits} rays meet a geom`);
});

/** Pixels of which all neighbours have the same id: not at an edge. */
function inside(ids, x, y) {
  const id = ids[y * WIDTH + x];
  for (let v = y - 1; v <= y + 1; v++) for (let u = x - 1; u <= x + 1; u++) if (ids[v * WIDTH + u] !== id) return false;
  return true;
}

for (const name of NAMES) {
  test(`the geom in every pixel is that of MuJoCo's renderer, except at edges: ${name}`, () => {
    const { model, frame, camera, seen } = scene(name), ids = pixels(seen), count = model.geom_type.length;
    const eye = placeEye(poseOf(camera), model, frame);
    let compared = 0, edges = 0, wrong = [];
    for (let y = 1; y < HEIGHT - 1; y++) {
      for (let x = 1; x < WIDTH - 1; x++) {
        const ray = rayThrough(eye, WIDTH / HEIGHT, (2 * (x + 0.5)) / WIDTH - 1, 1 - (2 * (y + 0.5)) / HEIGHT), hit = castRay(model, frame, ray);
        const id = ids[y * WIDTH + x], found = hit?.geom ?? -1;
        // Tendons are no geoms; a floor without end is drawn to a horizon.
        const isEndless = g => g >= 0 && model.geom_type[g] === PLANE && model.geom_size[3 * g] === 0;
        if (id >= count || (id < 0 && isEndless(found))) continue;
        compared++;
        // Of two surfaces in one place, either may be seen.
        if (id === found || (id >= 0 && hit && rayGeom(model, frame, id, ray) < hit.distance + 1e-4 * model.extent)) continue;
        if (inside(ids, x, y)) wrong.push(`(${x}, ${y}): ${found}, MuJoCo ${id}`);
        else edges++;
      }
    }
    assert.deepEqual(wrong.slice(0, 5), [], `${wrong.length} pixels`);
    assert.ok(edges < 0.02 * compared, `${edges} of ${compared} pixels at edges differ`);
  });
}

test("a point is projected where its ray begins", () => {
  for (const name of ["cube_table", "ortho", "gripper_wrist", "track"]) {
    const { model, frame, camera } = scene(name), eye = placeEye(poseOf(camera), model, frame), m = projectionOf(eye, 1.5);
    for (const [u, v] of [[0, 0], [0.7, -0.3], [-1, 1]]) {
      const ray = rayThrough(eye, 1.5, u, v), point = ray.from.map((x, i) => x + 2.5 * ray.direction[i]);
      const [a, b, c, w] = [0, 1, 2, 3].map(row => m[row] * point[0] + m[4 + row] * point[1] + m[8 + row] * point[2] + m[12 + row]);
      assert.ok(Math.abs(a / w - u) < 1e-5 && Math.abs(b / w - v) < 1e-5 && Math.abs(c / w) < 1, `${name}: ${a / w} ${b / w} ${c / w}`);
      pointFacing(eye, ray, point).forEach((x, i) => assert.ok(Math.abs(x - point[i]) < 1e-9));
    }
  }
});

test("the free camera of a model without a field of view has MuJoCo's, 45 degrees", () => {
  const { model, frame } = scene("pendulum"), { fovy, ...others } = model;
  assert.equal(fovy, 45);
  assert.deepEqual(placeEye(defaultCamera(model), others, frame), placeEye(defaultCamera(model), model, frame));
});

test("the camera of a lab says where the camera is, that of a view where it looks", () => {
  const { model, frame } = scene("pendulum");
  const pose = { ...defaultCamera(model), ...labCamera({ azimuth: -90, elevation: 30, distance: 2, target: [0.1, 0, 1] }) };
  const { position } = placeEye(pose, model, frame);
  [0.1, -2 * Math.cos(Math.PI / 6), 2].forEach((x, i) => assert.ok(Math.abs(x - position[i]) < 1e-12, `${position}`));
  assert.deepEqual(labCamera({}), {});
});
