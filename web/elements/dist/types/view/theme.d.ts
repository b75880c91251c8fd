/** Colours: of the page behind the picture, and of what is drawn over the scene. */
import type { Color } from "./instances.js";
export interface Palette {
    /** CSS colour behind the scene; null where the page is seen. */
    readonly background: string | null;
    /** Planes without a colour, and the opacity of the lines on planes. */
    readonly floor: Color;
    readonly grid: number;
    readonly axes: readonly [Color, Color, Color];
    readonly contact: Color;
    readonly force: Color;
    readonly joint: Color;
    readonly com: Color;
    readonly camera: Color;
    readonly trail: Color;
    readonly drag: Color;
    /** Width of lines, CSS pixels. */
    readonly lineWidth: number;
    /** Opacity of an overlay behind a surface. */
    readonly hiddenAlpha: number;
    /** Light from above and from below. */
    readonly sky: readonly [number, number, number];
    readonly ground: readonly [number, number, number];
}
/** Brightness of a CSS colour, from 0 to 1, as the browser reads it; null where it is no colour or transparent. */
export declare function brightness(color: string): number | null;
/** The colours for a page. `textColor` decides between light and dark where the page is seen behind the scene. */
export declare function makePalette(background: string | null, highContrast: boolean, textColor: string): Palette;
