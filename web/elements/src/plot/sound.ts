/** The sound of a trace: its pitch follows the newest value, from the lowest value of the plot to the highest one. */
import { extremes, type Series } from "./series.js";

/** Pitch of the lowest and of the highest value, Hz. */
const LOW = 220, HIGH = 880;
const VOLUME = 0.06;
/** The time until the pitch is reached, and until the tone fades without new samples, s. */
const GLIDE = 0.02, HOLD = 0.25;

export interface Sound {
  /** Plays the newest sample; silence for a value that is not a number. */
  play(series: Series, trace: number): void;
  stop(): void;
}

/** The pitch of a value between two others, Hz. Equal steps of the value are equal intervals. */
export function pitchOf(value: number, low: number, high: number): number {
  const share = high > low ? Math.min(1, Math.max(0, (value - low) / (high - low))) : 0.5;
  return LOW * (HIGH / LOW) ** share;
}

/** Starts a tone. A browser allows it after an action of the reader. */
export function startSound(): Sound {
  const context = new AudioContext();
  const [tone, volume] = [context.createOscillator(), context.createGain()];
  volume.gain.value = 0;
  tone.connect(volume).connect(context.destination);
  tone.start();
  return {
    play(series, trace) {
      const value = series.values[trace]?.[series.length - 1] ?? NaN;
      const found = extremes(series, trace, 0, series.length);
      const now = context.currentTime;
      volume.gain.cancelScheduledValues(now);
      if (!Number.isFinite(value) || found === null) return void volume.gain.setTargetAtTime(0, now, GLIDE);
      tone.frequency.setTargetAtTime(pitchOf(value, found.min, found.max), now, GLIDE);
      volume.gain.setTargetAtTime(VOLUME, now, GLIDE);
      volume.gain.setTargetAtTime(0, now + HOLD, GLIDE);
    },
    stop() {
      tone.stop();
      void context.close();
    },
  };
}
