/** Movements of the camera. */
import { clamp } from "../spec.js";
import type { CameraPose, View } from "../view/types.js";

export type Point = [number, number, number];
interface Pixel {
  readonly x: number;
  readonly y: number;
}

export function copyPose(pose: CameraPose): CameraPose {
  return { ...pose, target: [...pose.target] };
}

/** Turns around the target, degrees: `raise` lifts the camera. */
export function turnCamera(camera: CameraPose, azimuth: number, raise: number): void {
  delete camera.fixed;
  camera.azimuth += azimuth;
  camera.elevation = clamp(camera.elevation - raise, -89, 89);
}

export function zoomCamera(camera: CameraPose, factor: number): void {
  delete camera.fixed;
  camera.distance = clamp(camera.distance * factor, 1e-4, 1e5);
}

/** Moves the target in the plane that faces the camera. */
export function panCamera(view: View, dx: number, dy: number): void {
  const { camera } = view;
  delete camera.fixed;
  const [from, to] = [view.unproject(0, 0, camera.target), view.unproject(dx, dy, camera.target)];
  camera.target = [0, 1, 2].map((i) => (camera.target[i] ?? 0) - ((to[i] ?? 0) - (from[i] ?? 0))) as Point;
}

/** Two fingers: their distance zooms, their middle moves. */
export function pinchCamera(view: View, [a, b]: readonly Pixel[], before: Pixel, at: Pixel): void {
  const other = a === at ? b : a;
  if (other === undefined) return;
  const length = (p: Pixel): number => Math.hypot(p.x - other.x, p.y - other.y);
  zoomCamera(view.camera, length(before) / Math.max(1, length(at)));
  panCamera(view, (at.x - before.x) / 2, (at.y - before.y) / 2);
}

/** Moves the camera by a key. Returns whether the key has a meaning. */
export function moveCameraByKey(view: View, event: KeyboardEvent, home: CameraPose | null): boolean {
  const { camera } = view;
  const steps: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const step = steps[event.key];
  if (step !== undefined && event.shiftKey) panCamera(view, -24 * step[0], 24 * step[1]);
  else if (step !== undefined) turnCamera(camera, 6 * step[0], 6 * step[1]);
  else if (event.key === "+" || event.key === "=") zoomCamera(camera, 1 / 1.15);
  else if (event.key === "-" || event.key === "_") zoomCamera(camera, 1.15);
  else if (event.key === "Home" && home !== null) {
    delete camera.fixed;
    Object.assign(camera, copyPose(home));
  } else return false;
  return true;
}

export function scaled(v: Point, s: number): Point {
  return [v[0] * s, v[1] * s, v[2] * s];
}

/** To the right of the picture and upwards in it, for MuJoCo's free camera. */
export function cameraAxes({ azimuth, elevation }: CameraPose): [Point, Point] {
  const [a, e] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
  const forward: Point = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
  const right: Point = [Math.sin(a), -Math.cos(a), 0];
  const up: Point = [
    right[1] * forward[2] - right[2] * forward[1], right[2] * forward[0] - right[0] * forward[2], right[0] * forward[1] - right[1] * forward[0],
  ];
  return [right, up];
}
