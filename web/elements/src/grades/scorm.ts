/**
 * Grades for a learning system that started the page from a content package: the run-time calls of SCORM 2004 4th edition (IEEE
 * 1484.11.2). The page is one sharable content object; its quizzes share one session, one state and one score.
 */
import { addUp, storedOf, type Activity, type GradedQuiz } from "./activity.js";
import { countOf, durationOf, interactionOf, readStates, scoreOf, shareOf, statusOf, writeStates, type Setting } from "./cmi.js";

type Call = "Initialize" | "Terminate" | "GetValue" | "SetValue" | "Commit";
const CALLS: readonly Call[] = ["Initialize", "Terminate", "GetValue", "SetValue", "Commit"];
/** The object of the learning system. What its functions return is not known. */
type Api = Readonly<Record<Call, (...args: readonly string[]) => unknown>>;

const NAME = "API_1484_11";
/** Windows around a window that are searched; a page must not search for ever. */
const MOST_WINDOWS = 500;

/** The API of a window. Windows of other origins show none. */
function apiOf(window: Window): Api | null {
  try {
    const api = (window as unknown as Readonly<Record<string, unknown>>)[NAME] as Partial<Api> | null | undefined;
    return api !== null && api !== undefined && CALLS.every((name) => typeof api[name] === "function") ? (api as Api) : null;
  } catch {
    return null;
  }
}

/** The API in a window or one around it. */
function searchFrom(start: Window): Api | null {
  let window = start;
  for (let i = 0; i < MOST_WINDOWS; i++) {
    const api = apiOf(window);
    if (api !== null || window.parent === window) return api;
    window = window.parent;
  }
  return null;
}

/** The API of the windows around this one, then of the window that opened it, or that opened the windows around it. */
function findApi(): Api | null {
  const openers = [window.opener, window.top?.opener as unknown] as readonly (Window | null | undefined)[];
  const starts = [window.parent === window ? null : window.parent, ...openers];
  for (const start of starts) {
    const api = start === null || start === undefined ? null : searchFrom(start);
    if (api !== null) return api;
  }
  return null;
}

/** Calls the learning system. A call that fails gives an empty text: the page goes on. */
function call(api: Api, name: Call, ...args: readonly string[]): string {
  try {
    return String(api[name](...args));
  } catch {
    return "";
  }
}

const isTrue = (answer: string): boolean => answer === "true";

/** A session with the learning system, from `Initialize` to `Terminate`. */
class Session implements Activity {
  readonly #api: Api;
  readonly #quizzes = new Map<string, () => GradedQuiz>();
  readonly #states: Readonly<Record<string, unknown>>;
  readonly #passing: number | null;
  readonly #start = performance.now();
  #isCompleted: boolean;
  #interactions: number;
  #isOpen = true;

  /** `api` is initialized. */
  constructor(api: Api, passing: number | null) {
    this.#api = api;
    this.#states = readStates(call(api, "GetValue", "cmi.suspend_data"));
    this.#passing = shareOf(call(api, "GetValue", "cmi.scaled_passing_score")) ?? passing;
    this.#isCompleted = call(api, "GetValue", "cmi.completion_status") === "completed";
    this.#interactions = countOf(call(api, "GetValue", "cmi.interactions._count")) ?? 0;
    // Otherwise the next visit is a new attempt, without the answers.
    this.#set(["cmi.exit", "suspend"]);
    if (!this.#isCompleted) this.#set(["cmi.completion_status", "incomplete"]);
    addEventListener("pagehide", () => this.#leave(), { once: true });
    // A page that the browser kept comes back after its session has ended.
    addEventListener("pageshow", ({ persisted }) => {
      if (persisted) location.reload();
    });
  }

  join(name: string, quiz: () => GradedQuiz): Promise<unknown> {
    this.#quizzes.set(name, quiz);
    return Promise.resolve(storedOf(this.#states, name));
  }

  answered(detail: Parameters<Activity["answered"]>[0]): void {
    const [id, ...others] = interactionOf(detail, this.#interactions, new Date());
    // Without an id, the learning system refuses the rest.
    if (id === undefined || !this.#set(id)) return;
    others.forEach((setting) => this.#set(setting));
    this.#interactions += 1;
  }

  report(): Promise<void> {
    const totals = addUp(this.#quizzes, this.#states);
    // Answers that a reader clears do not undo what was completed.
    this.#isCompleted ||= totals.isAnswered;
    for (const setting of [...scoreOf(totals), ...statusOf(totals, this.#isCompleted, this.#passing)]) this.#set(setting);
    const state = writeStates(totals.states);
    if (state !== null) this.#set(["cmi.suspend_data", state]);
    call(this.#api, "Commit", "");
    return Promise.resolve();
  }

  #set([element, value]: Setting): boolean {
    return this.#isOpen && isTrue(call(this.#api, "SetValue", element, value));
  }

  #leave(): void {
    this.#set(["cmi.session_time", durationOf((performance.now() - this.#start) / 1000)]);
    this.#isOpen = false;
    call(this.#api, "Terminate", "");
  }
}

let session: Session | null | undefined;

/**
 * The session of this page, opened at the first call; null where no learning system answers. `passing` is the share of right answers
 * that passes, from 0 to 1, where the learning system names none.
 */
export function openScorm(passing: string | null): Activity | null {
  if (session !== undefined) return session;
  const api = findApi();
  session = api !== null && isTrue(call(api, "Initialize", "")) ? new Session(api, shareOf(passing)) : null;
  return session;
}
