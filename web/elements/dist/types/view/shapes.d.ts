/** Shapes of size 1, which every geom type, site and arrow is drawn from. */
/** Numbers of a vertex: position (3), side of the capsule (−1, 0, 1), normal (3), texture coordinates (2). */
export declare const STRIDE = 9;
/** Triangles, counter-clockwise seen from outside. */
export interface Shape {
    readonly vertices: Float32Array;
    readonly indices: Uint16Array | Uint32Array;
}
declare function box(): Shape;
declare function plane(): Shape;
/** Radius 1; a capsule's half length moves its two sides apart. A cone has its base at z = 0 and its tip at z = 1. */
export declare const SHAPES: {
    plane: typeof plane;
    box: typeof box;
    sphere: () => Shape;
    capsule: () => Shape;
    cylinder: () => Shape;
    cone: () => Shape;
};
export type ShapeName = keyof typeof SHAPES;
export {};
