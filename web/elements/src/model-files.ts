/** Models of a folder: the file of a model, and the files that it names. */

const MOST_FILES = 200;
/** Attributes that name a file; a texture has one for each face of a cube. */
const FILES = ["file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback"];
/** The attributes of `compiler` with the folders of files, by the element that names a file. */
const FOLDERS: Readonly<Record<string, string>> = { mesh: "meshdir", skin: "meshdir", hfield: "meshdir", texture: "texturedir" };

/** Fetches a file of the folder. */
export type FetchFile = (path: string) => Promise<Response>;

/** The model `name` and all files that it needs, by their paths in the folder. A picture that is missing is left out. */
export async function fetchModel(name: string, fetchFile: FetchFile): Promise<Record<string, string | Uint8Array>> {
  const found: Record<string, string | Uint8Array> = {};
  const text = await (await fetchFile(`${name}.xml`)).text();
  found[name] = text;
  const waiting = filesOf(text);
  for (const path of waiting) {
    if (found[path] !== undefined || Object.keys(found).length >= MOST_FILES) continue;
    const response = await fetchFile(path).catch((e: unknown) => {
      // A model runs without its pictures; a mesh that is missing is an error of the engine.
      if (path.toLowerCase().endsWith(".png")) return null;
      throw e;
    });
    if (response === null) continue;
    if (path.endsWith(".xml")) {
      const inside = await response.text();
      found[path] = inside;
      waiting.push(...filesOf(inside));
    } else found[path] = new Uint8Array(await response.arrayBuffer());
  }
  return found;
}

/** The paths that a model names. A text that is not XML names none: the engine reports the mistake. */
function filesOf(xml: string): string[] {
  const parsed = new DOMParser().parseFromString(xml, "text/xml");
  const compiler = parsed.querySelector("compiler");
  const folderOf = (element: Element): string => {
    const kind = FOLDERS[element.localName];
    const folder = kind === undefined ? null : (compiler?.getAttribute(kind) ?? compiler?.getAttribute("assetdir") ?? null);
    return folder === null || folder === "" ? "" : `${folder.replace(/\/$/, "")}/`;
  };
  const named = [...parsed.querySelectorAll(FILES.map((name) => `[${name}]`).join())];
  const paths = named.flatMap((element) => FILES.flatMap((name) => {
    const path = element.getAttribute(name);
    return path === null ? [] : [`${folderOf(element)}${path}`];
  }));
  // A path outside the folder is not fetched.
  return paths.filter((path) => /^[\w][\w ./-]*$/.test(path) && !path.split("/").includes(".."));
}
