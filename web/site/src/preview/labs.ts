/** The states of labs over a change of their text. */
import type { SimLab } from "labspec-elements";

/** Whether an element is a lab that the page has defined. */
const isLab = (element: Element | null): element is SimLab => element !== null && "saveState" in element && "openState" in element;

/** The controls that a lab declares, as text; `null` where it cannot be read. */
function controlsOf(lab: Element): string | null {
  try {
    const json: unknown = JSON.parse(lab.querySelector("script[type='application/json']")?.textContent ?? "");
    return JSON.stringify((json as { controls?: unknown } | null)?.controls ?? []);
  } catch {
    return null;
  }
}

/**
 * The state of a lab for the one that will replace it, where both have the same controls; `null` where there is nothing to carry.
 * It is taken while the lab is still part of the page.
 */
export async function stateFor(before: Element | null, after: Element | null): Promise<Uint8Array | null> {
  if (!isLab(before) || after === null || before.time === 0) return null;
  const controls = controlsOf(before);
  return controls !== null && controls === controlsOf(after) ? before.saveState() : null;
}

/** Opens a state in a lab that is part of the page. The engine refuses one that does not fit; the lab then begins at its start. */
export async function openState(lab: Element | null, state: Uint8Array): Promise<void> {
  if (isLab(lab)) await lab.openState(state);
}
