/** Colours: of the page behind the picture, and of what is drawn over the scene. */
import type { Color } from "./instances.js";
import { at } from "./matrix.js";

export interface Palette {
  /** CSS colour behind the scene; null where the page is seen. */
  readonly background: string | null;
  /** Planes without a colour, and the opacity of the lines on planes. */
  readonly floor: Color;
  /** Geoms without a colour. */
  readonly geom: Color;
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

/** A colour as `#rrggbb`. */
function hex(text: string): Color {
  const n = Number.parseInt(text.slice(1), 16);
  return [((n >> 16) & 255) / 255, ((n >> 8) & 255) / 255, (n & 255) / 255, 1];
}

const COMMON = {
  axes: [hex("#e03131"), hex("#2f9e44"), hex("#1c7ed6")], lineWidth: 2, hiddenAlpha: 0.3, sky: [0.42, 0.44, 0.48], ground: [0.2, 0.19, 0.18],
} as const;

const LIGHT = {
  ...COMMON, floor: hex("#e3e7ea"), geom: hex("#93a5b6"), grid: 0.3, contact: hex("#0ca678"), force: hex("#f76707"), joint: hex("#7048e8"),
  com: hex("#fab005"), camera: hex("#1971c2"), trail: hex("#d6336c"), drag: hex("#e8590c"),
};

const DARK = {
  ...COMMON, floor: hex("#3a4149"), geom: hex("#9db0c2"), grid: 0.3, contact: hex("#38d9a9"), force: hex("#ff922b"), joint: hex("#b197fc"),
  com: hex("#ffd43b"), camera: hex("#74c0fc"), trail: hex("#f783ac"), drag: hex("#ffc078"), sky: [0.34, 0.36, 0.4], ground: [0.15, 0.15, 0.16],
} as const;

const CONTRAST = { lineWidth: 3, hiddenAlpha: 0.6 } as const;
const CONTRAST_LIGHT = { ...CONTRAST, grid: 1, force: hex("#c92a2a"), contact: hex("#005f40"), trail: hex("#a61e4d"), camera: hex("#0b4884") };
const CONTRAST_DARK = { ...CONTRAST, grid: 1, force: hex("#ffd43b"), contact: hex("#63e6be"), trail: hex("#ffdeeb"), camera: hex("#d0ebff") };

/** Brightness of a CSS colour, from 0 to 1, as the browser reads it; null where it is no colour or transparent. */
export function brightness(color: string): number | null {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 1;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  if (!context) return null;
  context.fillStyle = color;
  const bright = (r: number, g: number, b: number, a: number): number | null => (a < 0.5 ? null : (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255);
  const text = String(context.fillStyle);
  if (text.startsWith("#")) {
    const [r, g, b] = hex(text);
    return bright(255 * r, 255 * g, 255 * b, 1);
  }
  const parts = /^rgba?\((.*)\)$/.exec(text)?.[1]?.split(",").map(Number);
  if (parts) return bright(at(parts, 0), at(parts, 1), at(parts, 2), parts[3] ?? 1);
  // A colour of another space.
  context.fillRect(0, 0, 1, 1);
  const { data } = context.getImageData(0, 0, 1, 1);
  return bright(at(data, 0), at(data, 1), at(data, 2), at(data, 3) / 255);
}

/** The colours for a page. `textColor` decides between light and dark where the page is seen behind the scene. */
export function makePalette(background: string | null, highContrast: boolean, textColor: string): Palette {
  const behind = background === null ? null : brightness(background);
  const isDark = behind === null ? (brightness(textColor) ?? 0) > 0.5 : behind < 0.4;
  return {
    ...(isDark ? DARK : LIGHT), ...(highContrast ? (isDark ? CONTRAST_DARK : CONTRAST_LIGHT) : {}), background,
  };
}
