import type { Say } from "../text/messages.js";
import type { Stored } from "./store.js";
/** A question on the page. */
export interface Card {
    readonly element: HTMLElement;
    /** `null` where it is not graded or not answered. */
    readonly isRight: boolean | null;
    readonly isGraded: boolean;
}
export interface CardContext {
    readonly number: number;
    readonly count: number;
    readonly say: Say;
    readonly stored: Stored | null;
    /** An answer was given: kept, and told to the page. */
    answered(answer: Stored): void;
}
export interface CardParts {
    readonly element: HTMLElement;
    readonly form: HTMLFormElement;
    /** Where verdicts stand; they are read aloud. */
    readonly verdict: HTMLElement;
    readonly promptId: string;
}
export declare function createCard(context: CardContext, label: string | null, prompt: string): CardParts;
/** The verdict on an answer, with what explains it. */
export declare function showVerdict(area: HTMLElement, isRight: boolean | null, text: string, explain: string | null, more?: readonly (Node | null)[]): void;
/** A remark below the form: what is missing, or which try it is. */
export declare function showRemark(area: HTMLElement, text: string): void;
