/** The languages that an editor shows. */
import { json } from "@codemirror/lang-json";
import { markdown } from "@codemirror/lang-markdown";
import { xml } from "@codemirror/lang-xml";
import type { LanguageSupport } from "@codemirror/language";

/** A lab or a quiz as JSON, a lesson, or a model. */
export type EditorLanguage = "json" | "markdown" | "mjcf";

export function languageOf(language: EditorLanguage): LanguageSupport {
  switch (language) {
    case "json": return json();
    case "mjcf": return xml({ autoCloseTags: true });
    // Labs and quizzes are JSON in fences.
    case "markdown": return markdown({ completeHTMLTags: false, codeLanguages: (info) => (/^(lab|quiz|json)\b/.test(info) ? json().language : null) });
  }
}
