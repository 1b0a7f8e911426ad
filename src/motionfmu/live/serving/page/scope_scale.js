// Scales of an oscilloscope: round ends, round ticks; a signal's peaks by columns.
import { BLOCK } from "./trace_ring.js";

// 1, 2 or 5 times a power of ten, not below a value.
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((m) => m * power).find((x) => x >= value * (1 - 1e-9));
}

// Round ends about what is seen, so that a scale stands still while peaks change little.
export function roundEnds(low, high) {
  if (!(high >= low)) return [-1, 1];
  let span = high - low;
  if (span <= 1e-12 * Math.max(Math.abs(low), Math.abs(high), 1e-12)) span = Math.abs(low) * 0.2 || 2;
  const step = roundUp(span / 8), middle = (low + high) / 2;
  const ends = [Math.floor((low - 0.03 * span) / step) * step, Math.ceil((high + 0.03 * span) / step) * step];
  return ends[1] > ends[0] ? ends : [middle - step, middle + step];
}

// Round values between two ends, about so many.
export function ticks(low, high, count) {
  const step = roundUp((high - low) / Math.max(count, 1));
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.max(0, Math.floor(high / step + 1e-9) - first + 1) },
    (_, k) => Number(((first + k) * step).toPrecision(12)));
}

// Peaks of a channel by columns of the screen; columns begin at whole multiples of their width, so
// that a picture that rolls does not flicker. xs, lows, highs are filled; the number of columns.
export function columns(ring, channel, from, to, width, out) {
  const exact = Math.max(1, Math.round((to - from) / width)), peaks = [0, 0];
  // Wide columns are of whole blocks, whose peaks are known.
  const wide = exact > 2 * BLOCK ? Math.round(exact / BLOCK) * BLOCK : exact;
  let count = 0;
  for (let a = Math.floor(Math.max(from, ring.begin) / wide) * wide; a < Math.min(to, ring.end); a += wide) {
    ring.peaks(channel, a, a + wide, peaks);
    if (!(peaks[1] >= peaks[0])) continue;
    out.x[count] = (a + wide / 2 - 0.5 - from) / (to - from) * width;
    [out.low[count], out.high[count]] = peaks;
    count++;
  }
  return count;
}
