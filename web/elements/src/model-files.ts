/** Models of a folder: a model's file, and the files that it names. */

const MOST_FILES = 200;
/** Folders that a model's `compiler` names, by the elements whose files are there. */
const FOLDERS: Readonly<Record<string, string>> = { mesh: "meshdir", skin: "meshdir", hfield: "meshdir", texture: "texturedir" };

/** Fetches a file; text for MJCF, bytes for others. */
export type FetchFile = (path: string) => Promise<Response>;

/** The model `name` and all that it needs, by their paths in the folder. */
export async function fetchModel(name: string, fetchFile: FetchFile): Promise<Record<string, string | Uint8Array>> {
  const found: Record<string, string | Uint8Array> = {};
  const text = await (await fetchFile(`${name}.xml`)).text();
  found[name] = text;
  const waiting = filesOf(text);
  for (const path of waiting) {
    if (found[path] !== undefined || Object.keys(found).length >= MOST_FILES) continue;
    const response = await fetchFile(path);
    if (path.endsWith(".xml")) {
      const inside = await response.text();
      found[path] = inside;
      waiting.push(...filesOf(inside));
    } else found[path] = new Uint8Array(await response.arrayBuffer());
  }
  return found;
}

/** The paths that a model names. What is not XML names none: the engine says what is wrong with it. */
function filesOf(xml: string): string[] {
  const parsed = new DOMParser().parseFromString(xml, "text/xml");
  const compiler = parsed.querySelector("compiler");
  const folderOf = (element: Element): string => {
    const kind = FOLDERS[element.localName];
    const folder = kind === undefined ? null : (compiler?.getAttribute(kind) ?? compiler?.getAttribute("assetdir") ?? null);
    return folder === null || folder === "" ? "" : `${folder.replace(/\/$/, "")}/`;
  };
  const paths = [...parsed.querySelectorAll("[file]")].map((element) => `${folderOf(element)}${element.getAttribute("file") ?? ""}`);
  // Only what is inside the folder.
  return paths.filter((path) => /^[\w][\w ./-]*$/.test(path) && !path.split("/").includes(".."));
}
