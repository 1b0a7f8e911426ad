"use strict";
// Curves over time: all samples are in the page, what is in view is drawn.

const KINDS = { i4: Int32Array, f4: Float32Array, f8: Float64Array };

// Numbers that `bits` has packed.
async function unwoven({ kind, count, bdata }) {
  const packed = Uint8Array.from(atob(bdata), (c) => c.charCodeAt(0));
  const plain = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(plain).arrayBuffer());
  const size = KINDS[kind].BYTES_PER_ELEMENT, raw = new Uint8Array(size * count);
  for (let k = 0; k < size; k++) {
    for (let i = 0; i < count; i++) raw[i * size + k] = bytes[k * count + i];
  }
  const words = size === 8 ? new BigUint64Array(raw.buffer) : new Uint32Array(raw.buffer);
  for (let i = 1; i < count; i++) words[i] += words[i - 1];
  return new KINDS[kind](raw.buffer);
}

function timesOf(clock) {
  if (clock.bdata) return unwoven(clock);
  return Float64Array.from({ length: clock.count }, (_, k) => clock.start + k * clock.step);
}

// How many of the times are at or before t.
function upTo(time, t) {
  let [low, high] = [0, time.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (time[middle] <= t) low = middle + 1; else high = middle;
  }
  return low;
}

const near = (t) => 1e-9 * Math.max(1, Math.abs(t));

// A curve's value at a time: its sample there, else the one that holds, or between two.
function valueAt({ time, values, steps, dots }, t) {
  const k = upTo(time, t + near(t)) - 1;
  if (k < 0 || t > time[time.length - 1] + near(t)) return NaN;
  if (steps || dots || time[k] >= t - near(t)) return values[k];
  return values[k] + (values[k + 1] - values[k]) * (t - time[k]) / (time[k + 1] - time[k]);
}

// Least, largest, mean and RMS of the samples between two times.
function between({ time, values }, from, to) {
  const found = { least: Infinity, largest: -Infinity, mean: NaN, rms: NaN };
  let count = 0, sum = 0, squares = 0;
  const last = upTo(time, to + near(to));
  for (let k = upTo(time, from - near(from)); k < last; k++) {
    const v = values[k];
    if (Number.isNaN(v)) continue;
    if (v < found.least) found.least = v;
    if (v > found.largest) found.largest = v;
    count++;
    sum += v;
    squares += v * v;
  }
  if (!count) return { least: NaN, largest: NaN, mean: NaN, rms: NaN };
  return { ...found, mean: sum / count, rms: Math.sqrt(squares / count) };
}

// What is drawn of a curve from one time to another, in at most so many columns: every sample,
// or the peaks of each column; where it swings within them, a band from least to largest and its
// mean. A curve swings if its columns are far higher than their means differ.
const SWING = 4, HIGH = 0.03;
function drawn(curve, from, to, columns, height) {
  const { time, values, lines } = curve;
  const first = Math.max(0, upTo(time, from) - 1);
  const last = Math.min(time.length, upTo(time, to) + 1);
  if (last - first <= 2 * columns) {
    const custom = lines ? Array.from(lines.subarray(first, last)) : null;
    return { x: time.slice(first, last), y: values.slice(first, last), custom, band: null,
      single: true };
  }
  const kept = [], at = [], low = [], high = [], mean = [];
  let spread = 0, drift = 0;
  for (let c = 0; c < columns; c++) {
    const [a, b] = [0, 1].map((k) => first + Math.round((c + k) / columns * (last - first)));
    let least = -1, largest = -1, sum = 0, count = 0;
    for (let k = a; k < b; k++) {
      const v = values[k];
      if (Number.isNaN(v)) continue;
      if (least < 0 || v < values[least]) least = k;
      if (largest < 0 || v > values[largest]) largest = k;
      sum += v;
      count++;
    }
    at.push((time[a] + time[b - 1]) / 2);
    if (!count) {
      kept.push(a);
      for (const part of [low, high, mean]) part.push(NaN);
      continue;
    }
    // A gap keeps its ends.
    if (count < b - a) kept.push(...Array.from({ length: b - a }, (_, k) => a + k)
      .filter((k) => Number.isNaN(values[k]) !== Number.isNaN(values[k - 1])));
    kept.push(Math.min(least, largest), Math.max(least, largest));
    low.push(values[least]);
    high.push(values[largest]);
    mean.push(sum / count);
    spread += values[largest] - values[least];
    if (c && !Number.isNaN(mean[c - 1])) drift += Math.abs(mean[c] - mean[c - 1]);
  }
  if (!lines && spread > SWING * drift && spread / columns > HIGH * height) {
    [at[0], at[columns - 1]] = [time[first], time[last - 1]];
    const custom = at.map((_, c) => [low[c], high[c]]);
    const band = { x: [...at, ...at.toReversed()], y: [...high, ...low.toReversed()] };
    return { x: at, y: mean, custom, band, single: false };
  }
  const chosen = [first, ...kept, last - 1].sort((a, b) => a - b)
    .filter((k, i, all) => !i || k !== all[i - 1]);
  return { x: chosen.map((k) => time[k]), y: chosen.map((k) => values[k]), band: null,
    custom: lines ? chosen.map((k) => lines[k]) : null, single: false };
}
