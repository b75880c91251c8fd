/** The first picture of a lab as a file, shown until the lab has drawn its own. */
import { h } from "../dom.js";
import { brightness } from "../view/theme.js";

/**
 * The picture in an element of the class `view`. It is as high as the view, and what is beyond its sides is cut off: as in the view itself, the
 * height decides what is seen. Site builders draw it for a light page, so that a dark one does not show it.
 */
export function createPoster(address: string): HTMLElement {
  const picture = h("img", { class: "poster", src: address, alt: "", hidden: true });
  picture.addEventListener("load", () => {
    const behind = picture.parentElement === null ? null : brightness(getComputedStyle(picture.parentElement).backgroundColor);
    picture.hidden = behind !== null && behind < 0.5;
  });
  return picture;
}
