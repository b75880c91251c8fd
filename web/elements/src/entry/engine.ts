/** The program of the engine. `channel` is a parameter of the function into which build.mjs puts it. */
import { serveLabs } from "../engine/host.js";
import type { Channel } from "../engine/messages.js";

declare const channel: Channel;

serveLabs(channel);
