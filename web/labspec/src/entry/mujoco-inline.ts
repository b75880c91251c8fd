import "./inline.js";
export * from "../mujoco.js";
export { default } from "../mujoco.js";
