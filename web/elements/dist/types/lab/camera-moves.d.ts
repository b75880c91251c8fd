import type { CameraPose, View } from "../view/types.js";
export type Point = [number, number, number];
interface Pixel {
    readonly x: number;
    readonly y: number;
}
export declare function copyPose(pose: CameraPose): CameraPose;
/** Turns around the target, degrees: `raise` lifts the camera. */
export declare function turnCamera(camera: CameraPose, azimuth: number, raise: number): void;
export declare function zoomCamera(camera: CameraPose, factor: number): void;
/** Moves the target in the plane that faces the camera. */
export declare function panCamera(view: View, dx: number, dy: number): void;
/** Two fingers: their distance zooms, their middle moves. */
export declare function pinchCamera(view: View, [a, b]: readonly Pixel[], before: Pixel, at: Pixel): void;
/** Moves the camera by a key; whether it is one that does. */
export declare function moveCameraByKey(view: View, event: KeyboardEvent, home: CameraPose | null): boolean;
export declare function scaled(v: Point, s: number): Point;
/** To the right of the picture and upwards in it, for MuJoCo's free camera. */
export declare function cameraAxes({ azimuth, elevation }: CameraPose): [Point, Point];
export {};
