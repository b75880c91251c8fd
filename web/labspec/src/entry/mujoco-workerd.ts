import "./workerd.js";
export * from "../mujoco.js";
export { default } from "../mujoco.js";
