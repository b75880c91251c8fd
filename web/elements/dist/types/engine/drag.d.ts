/** The spring that drags a body: critically damped, as strong as the body and what hangs on it is heavy. */
import type { Lab } from "labspec/slim";
import type { Drag } from "./messages.js";
/** The force and the torque at the centre of mass of the dragged body, in world axes. */
export declare function springForce(lab: Lab, drag: Drag): number[];
