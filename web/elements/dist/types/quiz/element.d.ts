/** `<lesson-quiz>`: questions about a lesson. */
import type { Models } from "labspec/slim";
export declare class LessonQuiz extends HTMLElement {
    #private;
    static readonly observedAttributes: string[];
    /** The quiz as an object or as JSON. */
    get quiz(): object | string | null;
    set quiz(quiz: object | string | null);
    /** The models of the labs of predictions. */
    get models(): Models | null;
    set models(models: Models | null);
    connectedCallback(): void;
    attributeChangedCallback(_name: string, before: string | null, after: string | null): void;
}
/** Defines the element, unless the page has it. */
export declare function defineLessonQuiz(): void;
