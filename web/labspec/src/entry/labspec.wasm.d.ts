/** The compiled module, as hosts give it that compile it themselves. */
declare const module: WebAssembly.Module;
export default module;
