/** The data that a page draws. The page owns the arrays. */
export interface Frame {
  readonly time: number;
  readonly numbers: Float64Array;
  readonly poses: Float32Array;
}

/** Memory for the frames of a lab, with the lengths of their arrays. */
export interface FrameMemory {
  readonly buffer: SharedArrayBuffer;
  readonly numbers: number;
  readonly poses: number;
}

/** Whether memory can be shared here: in node always, in a page when it is isolated from other origins. */
export function canShare(): boolean {
  const { crossOriginIsolated } = globalThis as { crossOriginIsolated?: boolean };
  return typeof SharedArrayBuffer === "function" && crossOriginIsolated !== false;
}

/** The count of frames, then two places for a frame: time, numbers, poses. */
const HEADER = 8;

interface Place {
  readonly reals: Float64Array;
  readonly poses: Float32Array;
}

/**
 * The frames of a lab in memory that a worker and its page share. The worker writes frame n into place n % 2, then the count n; the page
 * copies the last frame, and repeats the copy if the worker has finished another frame meanwhile.
 */
export class SharedFrames {
  readonly memory: FrameMemory;
  readonly #count: Int32Array;
  readonly #places: readonly [Place, Place];

  constructor(memory: FrameMemory) {
    const { buffer, numbers, poses } = memory;
    this.memory = memory;
    this.#count = new Int32Array(buffer, 0, 1);
    const size = SharedFrames.#size(numbers, poses);
    const place = (at: number): Place => ({
      reals: new Float64Array(buffer, at, 1 + numbers),
      poses: new Float32Array(buffer, at + 8 * (1 + numbers), poses),
    });
    this.#places = [place(HEADER), place(HEADER + size)];
  }

  #place(count: number): Place {
    return this.#places[count % 2 === 0 ? 0 : 1];
  }

  /** Bytes of a frame: its time, its numbers and its poses, up to a multiple of 8. */
  static #size(numbers: number, poses: number): number {
    return 8 * (1 + numbers + Math.ceil(poses / 2));
  }

  /** Memory for the frames of a lab that gives frames like this one. */
  static like(frame: Frame): SharedFrames {
    const [numbers, poses] = [frame.numbers.length, frame.poses.length];
    return new SharedFrames({ buffer: new SharedArrayBuffer(HEADER + 2 * SharedFrames.#size(numbers, poses)), numbers, poses });
  }

  write(frame: Frame): void {
    const next = Atomics.load(this.#count, 0) + 1;
    const place = this.#place(next);
    place.reals[0] = frame.time;
    place.reals.set(frame.numbers, 1);
    place.poses.set(frame.poses);
    Atomics.store(this.#count, 0, next);
  }

  /** The last frame, as copies. */
  read(): Frame {
    for (;;) {
      const count = Atomics.load(this.#count, 0);
      const { reals, poses } = this.#place(count);
      const [copy, copied] = [new Float64Array(reals), new Float32Array(poses)];
      if (Atomics.load(this.#count, 0) === count) return { time: copy[0] ?? NaN, numbers: copy.slice(1), poses: copied };
    }
  }
}
