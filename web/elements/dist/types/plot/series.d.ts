/** The samples of a plot: times, and for each trace its values. Bounded: older samples than anybody looks at are dropped. */
export interface Series {
    readonly traces: number;
    /** Samples that are held. */
    length: number;
    times: Float64Array;
    values: Float64Array[];
}
export declare function createSeries(traces: number): Series;
/** Forgets all samples. */
export declare function clearSeries(series: Series): void;
/** Adds rows of `width` numbers: time first, then `columns` of each trace. Time that goes backwards clears the plot. */
export declare function addRows(series: Series, rows: Float64Array, width: number, columns: readonly number[]): void;
/** The first sample at or after a time. */
export declare function indexAt(series: Series, time: number): number;
/** The sample nearest to a time; -1 where there is none. */
export declare function nearestIndex(series: Series, time: number): number;
/** The least and the greatest value of a trace from one sample to another, and when; `null` where it has no number. */
export interface Extremes {
    readonly min: number;
    readonly minTime: number;
    readonly max: number;
    readonly maxTime: number;
}
export declare function extremes(series: Series, trace: number, from: number, to: number): Extremes | null;
/** All samples as comma-separated values: numbers in full. */
export declare function toCsv(series: Series, labels: readonly string[], timeLabel: string): string;
