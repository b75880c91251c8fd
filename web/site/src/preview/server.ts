/** What the page asks of the preview's server. */

/** An answer that says why something was not done. */
export class Refused extends Error {}

const metaOf = (name: string): string => document.querySelector<HTMLMetaElement>(`meta[name="${name}"]`)?.content ?? "";

/** The lesson of this page, and a hash of the text that it shows. */
export function lessonOf(main: HTMLElement): { page: string; hash: string } {
  return { page: main.dataset["page"] ?? "", hash: main.dataset["hash"] ?? "" };
}

/** Asks the server to do something, with the token of this page. */
export async function ask(what: "source" | "edit" | "fix" | "propose" | "accept" | "findings" | "complete" | "hover", body: object): Promise<Readonly<Record<string, unknown>>> {
  let response: Response;
  try {
    response = await fetch(new URL(`/_labspec/${what}`, location.href), {
      method: "POST",
      headers: { "content-type": "application/json", "x-labspec-token": metaOf("labspec-token") },
      body: JSON.stringify(body),
    });
  } catch {
    throw new Refused("the preview does not answer: is `labspec preview` still running?");
  }
  const answer: unknown = await response.json().catch(() => null);
  const fields = typeof answer === "object" && answer !== null ? (answer as Record<string, unknown>) : {};
  if (!response.ok) throw new Refused(typeof fields["error"] === "string" ? fields["error"] : `the preview answers ${response.status}`);
  return fields;
}
