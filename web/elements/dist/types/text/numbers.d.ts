/** Numbers as the lab format prints them. */
/** Fixed decimals; exponential below 1e-3 and from 1e5 on; `nan`, `inf` and `-inf`. */
export declare function formatNumber(x: number, digits: number): string;
/** A number for a tick or a table: as many decimals as its distance to the next one needs. */
export declare function formatTick(x: number, spacing: number): string;
/** Three significant digits, for sentences. */
export declare function formatBrief(x: number): string;
/** A time for sentences, s. */
export declare function formatTime(time: number): string;
/** The number in what somebody typed: a comma is a decimal point, and the unit may follow. `null` for anything else. */
export declare function parseTyped(text: string, unit: string): number | null;
/** A unit for readers: `m/s^2` with its exponent raised. */
export declare function formatUnit(unit: string): string;
