import "./browser.js";
export * from "../mujoco.js";
export { default } from "../mujoco.js";
