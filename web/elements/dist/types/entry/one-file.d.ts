import { render } from "./define.js";
export * from "./define.js";
declare const _default: {
    render: typeof render;
};
export default _default;
