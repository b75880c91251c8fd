/** The exports of both builds. */
import { defineSimLab } from "../lab/element.js";
import { defineLessonQuiz } from "../quiz/element.js";

export { EngineError } from "../engine/client.js";
export { fetchModel, type FetchFile } from "../model-files.js";
export { SimLab } from "../lab/element.js";
export { toXapi, type QuizAnswer, type StatementOptions } from "../grades/xapi.js";
export { contentHash, type Verified } from "../proof/verified.js";
export { LessonQuiz } from "../quiz/element.js";
export { hashAnswer } from "../quiz/hash.js";
export { addLanguage } from "../text/messages.js";

/** Defines both elements. */
export function defineElements(): void {
  defineSimLab();
  defineLessonQuiz();
}
