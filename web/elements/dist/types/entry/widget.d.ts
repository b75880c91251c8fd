/** The model of a widget: its traits. */
export interface WidgetModel {
    get(name: string): unknown;
    on?(event: string, listener: () => void): void;
    off?(event: string, listener: () => void): void;
}
/** Shows a lab or a quiz in an element; returns a function that takes it away. */
export declare function render({ model, el }: {
    model: WidgetModel;
    el: HTMLElement;
}): () => void;
