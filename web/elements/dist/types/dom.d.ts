/** Elements of the page, made from plain data. */
export type Child = Node | string | null | undefined | false;
type Attributes = Readonly<Record<string, string | number | boolean | null | undefined>>;
/** An element with attributes and children. `true` gives an empty attribute; `false`, `null` and `undefined` give none. */
export declare function h<Tag extends keyof HTMLElementTagNameMap>(tag: Tag, attributes?: Attributes, ...children: Child[]): HTMLElementTagNameMap[Tag];
/** Sets text only where it differs, so that nothing is drawn again. */
export declare function setText(element: Element, text: string): void;
/** Offers a file to the reader. */
export declare function saveFile(name: string, content: Blob): void;
/** A name for a file from a title. */
export declare function fileName(title: string): string;
/** An id that no other element of the page has. */
export declare function uniqueId(): string;
/** A property that a page set before the element was defined reaches its setter. */
export declare function takeOwnProperty<Name extends string>(element: {
    [Key in Name]: unknown;
}, name: Name): void;
declare const ICONS: {
    readonly play: "M8 5.5v13l11-6.5z";
    readonly pause: "M7 5h3.5v14H7zM13.5 5H17v14h-3.5z";
    readonly step: "M6 5.5v13l9-6.5zM16 5.5h2.5v13H16z";
    readonly reset: "M12 5a7 7 0 1 1-6.7 5h2.1A5 5 0 1 0 12 7v3L7.5 6 12 2z";
    readonly more: "M5 10.2a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6zm7 0a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6zm7 0a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6z";
    readonly check: "M9.5 18 3.8 12.3l1.5-1.5 4.2 4.2L18.7 5.8l1.5 1.5z";
    readonly cross: "M6.3 4.9 12 10.6l5.7-5.7 1.4 1.4L13.4 12l5.7 5.7-1.4 1.4L12 13.4l-5.7 5.7-1.4-1.4L10.6 12 4.9 6.3z";
    readonly warning: "M12 3 1.8 20.5h20.4zm-1 6.5h2V15h-2zm0 7h2v2h-2z";
};
export type IconName = keyof typeof ICONS;
/** A small picture beside a text that says the same. */
export declare function icon(name: IconName): SVGSVGElement;
export {};
