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

/** A state as the engine saves it: which lab it is of, and everything that was done to that lab. */
interface State {
  labspec?: { actions?: unknown };
}

const readState = (bytes: Uint8Array): State => JSON.parse(new TextDecoder().decode(bytes)) as State;

/** What was done to a lab since its start. */
export type Actions = readonly unknown[];

/**
 * What was done to a lab that another one will replace, where both have the same controls; `null` where there is nothing to carry. It
 * is read while the lab is still part of the page.
 */
export async function actionsFor(before: Element | null, after: Element | null): Promise<Actions | null> {
  if (!isLab(before) || after === null || before.time === 0) return null;
  const controls = controlsOf(before);
  if (controls === null || controls !== controlsOf(after)) return null;
  const actions = readState(await before.saveState()).labspec?.actions;
  return Array.isArray(actions) ? (actions as unknown[]) : null;
}

/** Does the same again in a lab of the page. Its state is its own: a state of another text would be refused. */
export async function repeatActions(lab: Element | null, actions: Actions): Promise<void> {
  if (!isLab(lab)) return;
  const own = readState(await lab.saveState());
  const state: State = { ...own, labspec: { ...own.labspec, actions } };
  await lab.openState(new TextEncoder().encode(JSON.stringify(state)));
}
