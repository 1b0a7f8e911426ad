"use strict";
// Curves over time: all samples are in the page or beside it, what is in view is drawn.

const GAP = -(2 ** 31);

// Numbers that `bits` has packed.
async function unwoven({ kind, count, bdata, step }) {
  const packed = Uint8Array.from(atob(bdata), (c) => c.charCodeAt(0));
  const plain = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(plain).arrayBuffer());
  const size = kind === "f8" ? 8 : 4, raw = new Uint8Array(size * count);
  for (let k = 0; k < size; k++) {
    for (let i = 0; i < count; i++) raw[i * size + k] = bytes[k * count + i];
  }
  if (size === 8) {
    const words = new BigUint64Array(raw.buffer);
    for (let i = 1; i < count; i++) words[i] += words[i - 1];
    return new Float64Array(raw.buffer);
  }
  const whole = new Int32Array(raw.buffer);
  for (let i = 0, last = 0; i < count; i++) {
    last = (last + ((whole[i] >>> 1) ^ -(whole[i] & 1))) | 0;
    whole[i] = last;
  }
  return step ? Float64Array.from(whole, (k) => (k === GAP ? NaN : k * step)) : whole;
}

async function timesOf(clock) {
  if (clock.bdata) return unwoven(clock);
  const { start, step, count } = clock;
  if (clock.steps) return Float64Array.from(await unwoven(clock.steps), (k) => start + k * step);
  return Float64Array.from({ length: count }, (_, k) => start + k * step);
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

// The samples of a curve that tell most of what is between two times.
function inView(curve, from, to) {
  const { all, time } = curve;
  if (!all) return curve;
  const [first, last] = [Math.max(from, time[0]), Math.min(to, time[time.length - 1])];
  return first >= all.time[0] && last <= all.time[all.time.length - 1] ? all : curve;
}

const near = (t) => 1e-9 * Math.max(1, Math.abs(t));

// A curve's value at a time: its sample there, else the one that holds, or between two.
function valueAt(curve, t) {
  const { time, values, steps, dots } = inView(curve, t, t);
  const k = upTo(time, t + near(t)) - 1;
  if (k < 0 || t > time[time.length - 1] + near(t)) return NaN;
  if (steps || dots || time[k] >= t - near(t)) return values[k];
  return values[k] + (values[k + 1] - values[k]) * (t - time[k]) / (time[k + 1] - time[k]);
}

// Least, largest, mean and RMS of the samples between two times.
function between(curve, from, to) {
  const { time, values } = inView(curve, from, to);
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

// Samples from one index to another in so many bins: peaks of each, mean, how far they reach.
function binned({ time, values }, first, last, count) {
  const found = { kept: [], at: [], low: [], high: [], mean: [], spread: 0, drift: 0 };
  const { kept, at, low, high, mean } = found;
  for (let c = 0; c < count; c++) {
    const [a, b] = [c, c + 1].map((k) => first + Math.round(k / count * (last - first)));
    let least = -1, largest = -1, sum = 0, known = 0;
    for (let k = a; k < b; k++) {
      const v = values[k];
      if (Number.isNaN(v) !== Number.isNaN(values[k - 1])) kept.push(k); // an end of a gap
      if (Number.isNaN(v)) continue;
      if (least < 0 || v < values[least]) least = k;
      if (largest < 0 || v > values[largest]) largest = k;
      sum += v;
      known++;
    }
    at.push((time[a] + time[b - 1]) / 2);
    low.push(values[least] ?? NaN);
    high.push(values[largest] ?? NaN);
    mean.push(sum / known);
    if (!known) { kept.push(a); continue; }
    kept.push(Math.min(least, largest), Math.max(least, largest));
    found.spread += values[largest] - values[least];
    if (c && !Number.isNaN(mean[c - 1])) found.drift += Math.abs(mean[c] - mean[c - 1]);
  }
  return found;
}

// Pieces of long curves are files beside the page, which are scripts, for a page from a disk may
// read no others. So many of them are read for a view at most, and so many are kept.
const VIEW_MOST = 8, PIECES_KEPT = 200;
const pieces = new Map(), told = new Map();

function piece(name, found) { told.get(name)?.(found); }

function pieceOf(folder, name) {
  const kept = pieces.get(name);
  if (kept) { pieces.delete(name); pieces.set(name, kept); return kept; }
  const read = new Promise((done, failed) => {
    const script = document.createElement("script");
    told.set(name, done);
    script.onload = () => script.remove();
    script.onerror = () => failed(new Error(`${folder}/${name}.js is not there`));
    script.src = `${folder}/${name}.js`;
    document.head.append(script);
  }).then(async ({ time, values, lines }) => ({ time: await timesOf(time),
    values: await unwoven(values), lines: lines && await unwoven(lines) }));
  pieces.set(name, read);
  if (pieces.size > PIECES_KEPT) pieces.delete(pieces.keys().next().value);
  return read;
}

const joined = (parts) => {
  const found = new Float64Array(parts.reduce((sum, part) => sum + part.length, 0));
  parts.reduce((at, part) => (found.set(part, at), at + part.length), 0);
  return found;
};

// All samples of a long curve between two times; the curve as it is, where there are too many or
// their files are not beside the page.
async function allOf(curve, from, to) {
  const { more } = curve;
  if (!more) return curve;
  const first = Math.max(0, upTo(more.begins, from) - 1), last = Math.max(1, upTo(more.begins, to));
  if (last - first > VIEW_MOST) return curve;
  try {
    const names = Array.from({ length: last - first }, (_, k) => `${more.curve}.${first + k}`);
    const parts = await Promise.all(names.map((name) => pieceOf(more.folder, name)));
    const [time, values] = ["time", "values"].map((key) => joined(parts.map((part) => part[key])));
    const lines = parts[0].lines && joined(parts.map((part) => part.lines));
    return { ...curve, all: null, time, values, lines };
  } catch {
    curve.more = null; // a page that was sent alone
    return curve;
  }
}

// What is drawn of a curve from one time to another, in so many columns of the screen: every
// sample, or the peaks of each column; where it swings within `BROAD` columns, which would be a
// solid block, a band from least to largest and its mean. A curve swings if the bins are far
// higher than their means differ.
const BROAD = 6, SWING = 4, HIGH = 0.03;
function drawn(curve, from, to, columns, height) {
  const { time, values, lines } = curve;
  const first = Math.max(0, upTo(time, from) - 1);
  const last = Math.min(time.length, upTo(time, to) + 1);
  if (last - first <= 2 * columns) {
    const custom = lines ? Array.from(lines.subarray(first, last)) : null;
    return { x: time.slice(first, last), y: values.slice(first, last), custom, band: null };
  }
  const count = Math.round(columns / BROAD), broad = binned(curve, first, last, count);
  const { at, low, high, mean, spread, drift } = broad;
  if (!lines && spread > SWING * drift && spread / count > HIGH * height) {
    [at[0], at[count - 1]] = [time[first], time[last - 1]];
    const custom = at.map((_, c) => [low[c], high[c]]);
    const band = { x: [...at, ...at.toReversed()], y: [...high, ...low.toReversed()] };
    return { x: at, y: mean, custom, band };
  }
  const { kept } = binned(curve, first, last, columns);
  const chosen = [...new Set([first, ...kept, last - 1])].sort((a, b) => a - b);
  return { x: chosen.map((k) => time[k]), y: chosen.map((k) => values[k]), band: null,
    custom: lines ? chosen.map((k) => lines[k]) : null };
}
