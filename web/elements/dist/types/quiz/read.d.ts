/** What a quiz asks: its JSON, checked, with what is wrong in words. */
import { type Json } from "../spec.js";
import type { Say } from "../text/messages.js";
/** The right answer: an index, indexes, or the hash of it. */
export type Key = {
    readonly choice: readonly number[];
} | {
    readonly salt: string;
    readonly sha256: string;
};
interface Common {
    /** HTML. */
    readonly q: string;
    readonly explain: string | null;
    readonly label: string | null;
}
export interface ChoiceQuestion extends Common {
    readonly kind: "mcq" | "debug" | "predict" | "multiple" | "truefalse";
    readonly options: readonly string[];
    readonly key: Key;
    /** Tries; the options of the lab format have one. */
    readonly attempts: number;
    /** The lab of a prediction. */
    readonly sim: Json | null;
}
export interface NumericQuestion extends Common {
    readonly kind: "numeric";
    readonly answer: number;
    readonly tol: number;
    readonly unit: string;
    /** Tries; `Infinity` where the question does not limit them. */
    readonly attempts: number;
}
export interface OpenQuestion extends Common {
    readonly kind: "open" | "code";
    readonly reference: string | null;
}
export type Question = ChoiceQuestion | NumericQuestion | OpenQuestion;
export interface QuizSpec {
    readonly id: string;
    readonly title: string | null;
    readonly questions: readonly (Question | {
        readonly kind: "broken";
        readonly why: string;
    })[];
}
export declare function readQuiz(json: Json, say: Say): QuizSpec | null;
export {};
