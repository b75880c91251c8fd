/** Files of the site from a script of it. */

/** The address of a file beside this script. */
export const besideScript = (name: string): string => new URL(`./${name}`, import.meta.url).href;

/** The address of a file by its path from the root of the site. */
export function siteFile(path: string): URL {
  return new URL((document.body.dataset["root"] ?? "") + path, document.baseURI);
}
