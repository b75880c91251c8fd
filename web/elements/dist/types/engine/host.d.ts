import type { Channel } from "./messages.js";
/** Serves labs through a channel, whose first message is the module. */
export declare function serveLabs(channel: Channel): void;
