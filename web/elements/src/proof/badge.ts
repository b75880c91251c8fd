/** The mark of a lab or a quiz whose claims were checked. */
import type { Models } from "labspec/slim";
import { h, icon } from "../dom.js";
import type { Json } from "../spec.js";
import type { Say } from "../text/messages.js";
import { checkAgain, contentHash, readVerified } from "./verified.js";

/** The badge of an element; null where its builder says nothing. It says when the content is no longer what was checked. */
export function createBadge(element: Element, content: Json, models: Models, say: Say): HTMLElement | null {
  const verified = readVerified(element.getAttribute("verified"));
  if (verified === null) return null;
  const { claims, version, hash } = verified;
  const isSame = contentHash(content, models) === hash;
  const result = h("p", { role: "status", class: "proof-result" });
  const details = h("details", { class: isSame ? "proof good" : "proof bad", part: "verified" },
    h("summary", {}, icon(isSame ? "check" : "warning"), h("span", {}, say(isSame ? "proved" : "provedOther", { claims }))),
    h("p", {}, say(isSame ? "provedText" : "provedOtherText", { version })), h("p", { class: "hash" }, h("code", {}, hash.slice(0, 16))), result);
  const address = element.getAttribute("checker");
  if (address !== null) result.before(againButton(address, content, models, claims, result, say));
  return details;
}

function againButton(address: string, content: Json, models: Models, claims: number, result: HTMLElement, say: Say): HTMLElement {
  const button = h("button", { type: "button", class: "quiet" }, say("proveAgain"));
  button.addEventListener("click", () => {
    button.disabled = true;
    result.textContent = say("proving");
    // The check blocks the page: the text is drawn before.
    requestAnimationFrame(() => setTimeout(() => {
      checkAgain(address, content, models).then(({ right, wrong }) => {
        const isSame = wrong.length === 0 && right === claims;
        result.textContent = isSame ? say("provedAgain", { claims: right }) : say("provedNot", { right, claims, why: wrong.slice(0, 3).join("; ") });
      }, (e: unknown) => {
        result.textContent = say("proofFailed", { why: e instanceof Error ? e.message : String(e) });
      }).finally(() => {
        button.disabled = false;
      });
    }, 0));
  });
  return button;
}
