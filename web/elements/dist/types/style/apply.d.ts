/** Gives a shadow root the styles of the elements. A constructed sheet needs no permission of a content policy. */
export declare function applyStyles(root: ShadowRoot): void;
/** Calls `restyle` when the colours of the page may have changed; returns a function that ends this. */
export declare function watchTheme(restyle: () => void): () => void;
