// Shapes are closed, their triangles are counter-clockwise from outside, and their normals are those of the surface.
import assert from "node:assert/strict";
import test from "node:test";
import { modules, scene } from "./common.mjs";

const { SHAPES, STRIDE, meshShape, hfieldShape, rotationToZ, wrapArc, hashNumbers, nameGeometry, detailed } = await modules("shapes", "mesh", "matrix", "tendons", "geometry", "detail");

/** Positions (a capsule's with its sides moved apart by `shift`), normals and triangles. */
function unpack({ vertices, indices }, shift = 0) {
  const points = [], normals = [];
  for (let i = 0; i < vertices.length; i += STRIDE) {
    points.push([vertices[i], vertices[i + 1], vertices[i + 2] + shift * vertices[i + 3]]);
    normals.push([vertices[i + 4], vertices[i + 5], vertices[i + 6]]);
  }
  return { points, normals, triangles: Array.from({ length: indices.length / 3 }, (_, i) => Array.from(indices.subarray(3 * i, 3 * i + 3))) };
}

const minus = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const where = p => p.map(x => (Math.abs(x) < 1e-9 ? 0 : x).toFixed(6)).join();

/** Every edge of a closed surface belongs to two triangles, which run through it in opposite directions. */
function assertClosed({ points, triangles }, name) {
  const edges = new Map();
  for (const triangle of triangles) {
    for (let i = 0; i < 3; i++) {
      const [a, b] = [where(points[triangle[i]]), where(points[triangle[(i + 1) % 3]])];
      assert.notEqual(a, b, `${name}: a triangle has no area`);
      edges.set(`${a} ${b}`, (edges.get(`${a} ${b}`) ?? 0) + 1);
    }
  }
  for (const [edge, count] of edges) {
    const [a, b] = edge.split(" ");
    assert.equal(count, edges.get(`${b} ${a}`), `${name}: edge ${edge}`);
  }
}

function volume({ points, triangles }) {
  return triangles.reduce((sum, [a, b, c]) => sum + dot(points[a], cross(points[b], points[c])) / 6, 0);
}

function assertNormals({ points, normals, triangles }, name, least) {
  for (const triangle of triangles) {
    const [a, b, c] = triangle.map(i => points[i]), n = cross(minus(b, a), minus(c, a)), size = Math.hypot(...n);
    for (const i of triangle) {
      assert.ok(Math.abs(Math.hypot(...normals[i]) - 1) < 1e-5, `${name}: a normal of length ${Math.hypot(...normals[i])}`);
      assert.ok(dot(normals[i], n) / size > least, `${name}: normal ${normals[i]} of a triangle along ${n}`);
    }
  }
}

/** The shapes with all triangles. */
const VOLUMES = { box: 8, sphere: (4 / 3) * Math.PI, cylinder: 2 * Math.PI, cone: Math.PI / 3, capsule: (4 / 3 + 2 * 0.7) * Math.PI };

for (const [name, exact] of Object.entries(VOLUMES)) {
  test(`${name}: closed, its volume, its normals`, () => {
    const shape = unpack(SHAPES[name](), name === "capsule" ? 0.7 : 0);
    assertClosed(shape, name);
    assertNormals(shape, name, 0.98);
    assert.ok(volume(shape) <= exact * (1 + 1e-6) && volume(shape) > 0.99 * exact, `${volume(shape)}, exactly ${exact}`);
  });
}

for (const name of ["sphere/24", "sphere/16", "capsule/24", "capsule/16"]) {
  test(`${name}: closed, its volume, its normals`, () => {
    const isCapsule = name.startsWith("capsule"), shape = unpack(SHAPES[name](), isCapsule ? 0.7 : 0), exact = isCapsule ? VOLUMES.capsule : VOLUMES.sphere;
    assertClosed(shape, name);
    assertNormals(shape, name, 0.95);
    assert.ok(volume(shape) <= exact * (1 + 1e-6) && volume(shape) > 0.93 * exact, `${volume(shape)}, exactly ${exact}`);
  });
}

test("small round things have fewer triangles, and an outline that is at most a quarter of a pixel inside the true one", () => {
  const eye = { position: [0, 0, 0], right: [1, 0, 0], up: [0, 1, 0], forward: [0, 0, -1], halfHeight: 0.5, isOrthographic: false, near: 0.1, far: 100 };
  const ball = (radius, depth) => ({ shape: "sphere", position: [0, 0, -depth], scale: [radius, radius, radius] });
  // Radius in pixels of a picture of 400: 400 r / d.
  assert.equal(detailed(ball(0.01, 1), eye, 400), "sphere/16");
  assert.equal(detailed(ball(0.05, 1), eye, 400), "sphere/24");
  assert.equal(detailed(ball(0.2, 1), eye, 400), "sphere");
  assert.equal(detailed(ball(0.2, 40), eye, 400), "sphere/16");
  assert.equal(detailed({ ...ball(0.01, 1), shape: "capsule", shift: 0.2 }, eye, 400), "capsule/16");
  // Around the eye, behind it, and without a perspective.
  assert.equal(detailed(ball(0.01, 0.005), eye, 400), "sphere");
  assert.equal(detailed({ ...ball(0.01, 1), shape: "capsule", shift: 2 }, eye, 400), "capsule");
  assert.equal(detailed(ball(0.01, 40), { ...eye, isOrthographic: true }, 400), "sphere/16");
  assert.equal(detailed({ ...ball(0.01, 1), shape: "box" }, eye, 400), "box");
  for (let radius = 0.001; radius < 0.5; radius *= 1.1) {
    const name = detailed(ball(radius, 1), eye, 400), pixels = (400 * radius) / (1 - radius);
    const slices = SHAPES[name]().vertices.filter((_, i) => i % STRIDE === 2).filter((z) => z === 0).length - 1;
    assert.ok((1 - Math.cos(Math.PI / slices)) * pixels <= 0.25 || name === "sphere", `${name} for ${pixels} pixels`);
  }
});

test("a capsule without length is a ball", () => {
  const shape = SHAPES.capsule(), { points } = unpack(shape);
  for (const p of points) assert.ok(Math.abs(Math.hypot(...p) - 1) < 1e-6);
});

test("a height field is closed, and as thick as its elevations", () => {
  const { model } = scene("hfield"), shape = unpack(hfieldShape(model, 0));
  const [x, y, top, base] = model.hfield_size, [rows, columns] = [model.hfield_nrow[0], model.hfield_ncol[0]];
  assertNormals(shape, "hfield", 0.5);
  const edge = shape.points.filter(p => Math.abs(Math.abs(p[0]) - x) < 1e-6 || Math.abs(Math.abs(p[1]) - y) < 1e-6);
  assert.ok(edge.some(p => Math.abs(p[2] + base) < 1e-6) && Math.max(...shape.points.map(p => p[2])) <= top + 1e-6);
  // The volume below two triangles of each cell, and the base.
  const z = (r, c) => top * model.hfield_data[r * columns + c], cell = ((2 * x) / (columns - 1)) * ((2 * y) / (rows - 1));
  let exact = 4 * x * y * base;
  for (let r = 0; r + 1 < rows; r++) {
    for (let c = 0; c + 1 < columns; c++) exact += (cell / 6) * (2 * z(r, c) + z(r, c + 1) + z(r + 1, c) + 2 * z(r + 1, c + 1));
  }
  assert.ok(Math.abs(volume(shape) - exact) < 1e-6, `${volume(shape)}, exactly ${exact}`);
});

test("meshes: closed, with the volume of their triangles", () => {
  const { model } = scene("mesh_builtin");
  for (let id = 0; id < model.mesh_vertadr.length; id++) {
    const shape = unpack(meshShape(model, id));
    assert.equal(shape.triangles.length, model.mesh_facenum[id]);
    for (const n of shape.normals) assert.ok(Math.abs(Math.hypot(...n) - 1) < 1e-4);
    if (model.geom_dataid.includes(id)) assertClosed(shape, `mesh ${id}`);
  }
});

test("a rotation to an axis is a rotation", () => {
  for (const z of [[0, 0, 1], [0, 0, -1], [1, 0, 0], [0.3, -0.5, 0.2], [0, 0, 0]]) {
    const m = rotationToZ(z), [x, y, w] = [0, 1, 2].map(i => [m[i], m[3 + i], m[6 + i]]), n = Math.hypot(...z) || 1;
    cross(x, y).forEach((v, i) => assert.ok(Math.abs(v - w[i]) < 1e-12));
    if (Math.hypot(...z) > 0) z.forEach((v, i) => assert.ok(Math.abs(v / n - w[i]) < 1e-12));
  }
});

test("a tendon follows the surface that it wraps", () => {
  const { model, frame } = scene("wrap_cylinder");
  let arcs = 0;
  const pairs = Array.from(frame.ten_wrapadr, (first, t) => Array.from({ length: frame.ten_wrapnum[t] - 1 }, (_, i) => first + i)).flat();
  for (const i of pairs) {
    const id = frame.wrap_obj[i];
    if (id < 0 || id !== frame.wrap_obj[i + 1]) continue;
    arcs++;
    const [a, b] = [i, i + 1].map(k => Array.from(frame.wrap_xpos.subarray(3 * k, 3 * k + 3)));
    const points = wrapArc(model, frame, id, a, b), m = frame.geom_xmat.subarray(9 * id, 9 * id + 9);
    for (const [end, p] of [[a, points[0]], [b, points.at(-1)]]) end.forEach((x, k) => assert.ok(Math.abs(x - p[k]) < 1e-9));
    for (const p of points) {
      const d = minus(p, frame.geom_xpos.subarray(3 * id, 3 * id + 3)), along = dot(d, [m[2], m[5], m[8]]);
      assert.ok(Math.abs(Math.sqrt(dot(d, d) - along * along) - model.geom_size[3 * id]) < 1e-6);
    }
  }
  assert.ok(arcs >= 2, `${arcs} arcs`);
});

test("geometry has one name while its numbers are the same", () => {
  const [{ model }, { model: other }] = [scene("mesh_builtin"), scene("mesh_builtin")];
  assert.deepEqual(nameGeometry(model), nameGeometry(other));
  assert.equal(new Set(nameGeometry(model).mesh).size, model.mesh_vertadr.length);
  const first = { model, geometry: nameGeometry(model) };
  assert.equal(nameGeometry(other, first).mesh, first.geometry.mesh);
  for (const field of ["mesh_vert", "mesh_normal"]) {
    const { model: changed } = scene("mesh_builtin");
    changed[field][0] += 1e-3;
    const { mesh } = nameGeometry(changed, first);
    assert.notEqual(mesh[0], first.geometry.mesh[0], field);
    assert.deepEqual(mesh.slice(1), first.geometry.mesh.slice(1));
  }
  assert.notEqual(hashNumbers(Float64Array.of(1, 2)), hashNumbers(Float64Array.of(2, 1)));
});
