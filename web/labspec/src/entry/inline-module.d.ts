/** The module: see `PackedModule`. */
export declare const module: string;
export declare const unpacker: string;
