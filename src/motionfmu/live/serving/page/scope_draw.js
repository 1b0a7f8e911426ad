// The pictures of the oscilloscope: lanes or one field over time, amplitudes over frequency, XY.
import { columns, roundEnds, ticks } from "./scope_scale.js";
import { figures } from "./words.js";

export const LEFT = 64, FOOT = 22, TOP = 6, RIGHT = 10;
const GAP = 5; // [px] between lanes
const room = { x: new Float64Array(8192), low: new Float64Array(8192), high: new Float64Array(8192) };

// What a channel has of peaks in the window; its scale if none is given.
function scaleOf(channel, low, high) {
  const ends = roundEnds(low, high);
  return [channel.low ?? ends[0], channel.high ?? ends[1]];
}

export function overTime(pen, size, { ring, from, to, step, channels, mode, theme, mark }) {
  const [w, h] = size, width = w - LEFT - RIGHT, lanes = mode === "lanes" ? channels.length : 1;
  const height = (h - FOOT - TOP - GAP * (lanes - 1)) / lanes;
  timeGrid(pen, size, from * step, to * step, theme);
  const counted = channels.map((channel) => ({ channel, ...measured(ring, channel, from, to) }));
  const shared = mode === "unit" ? byUnit(counted) : null;
  counted.forEach((one, k) => {
    const top = TOP + (lanes > 1 ? k * (height + GAP) : 0);
    const scale = shared?.get(one.channel.unit) ?? scaleOf(one.channel, one.least, one.most);
    one.channel.scale = scale;
    if (lanes > 1 || k === 0) lane(pen, top, height, w, theme);
    if (lanes > 1 || channels.length === 1 || (shared?.size === 1 && k === 0)) {
      valueTicks(pen, scale, top, height, theme, one.channel.unit, w);
    }
    curve(pen, ring, one.channel, { from, to, width, top, height, scale });
  });
  if (mark !== undefined) line(pen, LEFT + (mark - from) / (to - from) * width, TOP, h - FOOT, theme.trigger);
}

const measured = (ring, channel, from, to) => {
  const peaks = [0, 0];
  ring.peaks(channel.index, Math.floor(from), Math.ceil(to), peaks);
  return { least: peaks[0], most: peaks[1] };
};

function byUnit(counted) {
  const ends = new Map();
  for (const { channel: { unit }, least, most } of counted) {
    const [low, high] = ends.get(unit) ?? [Infinity, -Infinity];
    ends.set(unit, [Math.min(low, least), Math.max(high, most)]);
  }
  return new Map([...ends].map(([unit, [low, high]]) => [unit, roundEnds(low, high)]));
}

function curve(pen, ring, channel, { from, to, width, top, height, scale: [low, high] }) {
  const count = columns(ring, channel.index, from, to, Math.min(width, 8000), room);
  const factor = height / (high - low), y = (v) => top + height - (v - low) * factor;
  const stretch = width / Math.min(width, 8000);
  pen.save();
  pen.beginPath();
  pen.rect(LEFT, top - 1, width, height + 2);
  pen.clip();
  if (to - from > width) bars(pen, channel.colour, count, stretch, y);
  else through(pen, channel.colour, count, stretch, y);
  pen.restore();
}

// Few samples: a line through them.
function through(pen, colour, count, stretch, y) {
  pen.beginPath();
  for (let k = 0; k < count; k++) {
    const x = LEFT + room.x[k] * stretch;
    pen.lineTo(x, y(room.low[k]));
    if (room.high[k] !== room.low[k]) pen.lineTo(x, y(room.high[k]));
  }
  pen.strokeStyle = colour;
  pen.lineWidth = 1.3;
  pen.lineJoin = "bevel";
  pen.stroke();
}

// Many samples: a bar from least to largest for each column, joined to the one before. Rectangles
// are drawn ten times as fast as a line of as many corners.
const THIN = 1.4; // [px]
function bars(pen, colour, count, stretch, y) {
  pen.fillStyle = colour;
  for (let k = 0; k < count; k++) {
    const x = Math.round(LEFT + room.x[k] * stretch), next = k + 1 < count ? Math.round(LEFT + room.x[k + 1] * stretch) : x + 1;
    const low = k ? Math.min(room.low[k], room.high[k - 1]) : room.low[k];
    const high = k ? Math.max(room.high[k], room.low[k - 1]) : room.high[k];
    const top = y(high), tall = y(low) - top, more = Math.max(0, THIN - tall);
    pen.fillRect(x, top - more / 2, Math.max(1, next - x), tall + more);
  }
}

function lane(pen, top, height, w, theme) {
  pen.strokeStyle = theme.line;
  pen.lineWidth = 1;
  pen.strokeRect(LEFT - 0.5, Math.round(top) - 0.5, w - LEFT - RIGHT, Math.round(height));
}

function valueTicks(pen, [low, high], top, height, theme, unit, w) {
  pen.fillStyle = theme.muted;
  pen.font = "11px Inter, 'Segoe UI', Arial, sans-serif";
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  for (const v of ticks(low, high, Math.max(1, height / 34))) {
    const y = top + height - (v - low) / (high - low) * height;
    if (height > 60) line(pen, LEFT, y, y, theme.grid, w - RIGHT);
    if (y > top + 4 && y < top + height - 3) pen.fillText(figures(v, 5), LEFT - 6, y);
  }
  if (unit && height > 46) {
    pen.textAlign = "left";
    pen.fillText(unit, LEFT + 5, top + 9);
  }
}

function line(pen, x, y, end, color, x2 = x) {
  pen.strokeStyle = color;
  pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(Math.round(x) + 0.5, Math.round(y) + 0.5);
  pen.lineTo(Math.round(x2) + 0.5, Math.round(end) + 0.5);
  pen.stroke();
}

function timeGrid(pen, [w, h], from, to, theme) {
  const width = w - LEFT - RIGHT, span = to - from;
  pen.font = "11px Inter, 'Segoe UI', Arial, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "alphabetic";
  for (const t of ticks(from, to, Math.max(2, width / 110))) {
    const x = LEFT + (t - from) / span * width;
    line(pen, x, TOP, h - FOOT, theme.grid);
    pen.fillStyle = theme.muted;
    const words = span < 0.02 ? `${(1e3 * t).toFixed(span < 2e-3 ? 2 : 1)} ms` : `${t.toFixed(span < 0.5 ? 3 : span < 5 ? 2 : 1)} s`;
    if (x > LEFT + 20 && x < w - 28) pen.fillText(words, x, h - 7);
  }
}

// Amplitudes over frequency, both logarithmic.
export function overFrequency(pen, size, { spectra, theme }) {
  const [w, h] = size, width = w - LEFT - RIGHT, height = h - FOOT - TOP;
  lane(pen, TOP, height, w, theme);
  const first = spectra.find((s) => s.frequency.length > 2);
  if (!first) return;
  const [low, high] = [Math.log10(first.frequency[1]), Math.log10(first.frequency.at(-1))];
  let most = -Infinity;
  for (const { amplitude } of spectra) for (let k = 1; k < amplitude.length; k++) most = Math.max(most, amplitude[k]);
  const top = Math.ceil(Math.log10(most > 0 ? most : 1)), foot = top - 6;
  pen.font = "11px Inter, 'Segoe UI', Arial, sans-serif";
  pen.textBaseline = "middle";
  for (let e = foot; e <= top; e++) {
    const y = TOP + height - (e - foot) / 6 * height;
    line(pen, LEFT, y, y, theme.grid, w - RIGHT);
    pen.fillStyle = theme.muted;
    pen.textAlign = "right";
    if (y > TOP + 3) pen.fillText(figures(10 ** e, 2), LEFT - 6, y);
  }
  pen.textAlign = "center";
  pen.textBaseline = "alphabetic";
  for (let e = Math.ceil(low); e <= high; e++) {
    const x = LEFT + (e - low) / (high - low) * width;
    line(pen, x, TOP, h - FOOT, theme.grid);
    pen.fillStyle = theme.muted;
    if (x < w - 30) pen.fillText(e >= 3 ? `${10 ** (e - 3)} kHz` : `${Number((10 ** e).toPrecision(2))} Hz`, x, h - 7);
  }
  for (const { frequency, amplitude, colour } of spectra) {
    pen.beginPath();
    let column = -1, peak = 0;
    for (let k = 1; k < frequency.length; k++) { // the peak of each pixel
      const x = Math.round(LEFT + (Math.log10(frequency[k]) - low) / (high - low) * width);
      if (x !== column && column >= 0) { pen.lineTo(column, level(peak)); peak = 0; }
      column = x;
      peak = Math.max(peak, amplitude[k]);
    }
    pen.lineTo(column, level(peak));
    pen.strokeStyle = colour;
    pen.lineWidth = 1.3;
    pen.stroke();
  }

  function level(a) {
    return TOP + height - Math.max(0, (Math.log10(Math.max(a, 1e-300)) - foot) / 6) * height;
  }
}

const DOTS = 6000; // of a curve
export function againstX(pen, size, { ring, from, to, x, channels, theme }) {
  const [w, h] = size, width = w - LEFT - RIGHT, height = h - FOOT - TOP;
  lane(pen, TOP, height, w, theme);
  const [a, b] = [Math.max(Math.floor(from), ring.begin), Math.min(Math.ceil(to), ring.end)];
  if (b - a < 2) return;
  const own = measured(ring, x, a, b), across = [x.low, x.high].every((v) => v !== undefined) ? [x.low, x.high] : roundEnds(own.least, own.most);
  const all = channels.map((c) => measured(ring, c, a, b));
  const up = roundEnds(Math.min(...all.map((m) => m.least)), Math.max(...all.map((m) => m.most)));
  valueTicks(pen, up, TOP, height, theme, channels[0]?.unit, w);
  pen.textAlign = "center";
  pen.textBaseline = "alphabetic";
  for (const v of ticks(...across, width / 90)) {
    const at = LEFT + (v - across[0]) / (across[1] - across[0]) * width;
    line(pen, at, TOP, h - FOOT, theme.grid);
    pen.fillStyle = theme.muted;
    if (at > LEFT + 20 && at < w - 28) pen.fillText(figures(v, 5), at, h - 7);
  }
  const stride = Math.max(1, Math.floor((b - a) / DOTS));
  for (const channel of channels) {
    pen.beginPath();
    for (let k = a; k < b; k += stride) {
      pen.lineTo(LEFT + (ring.at(x.index, k) - across[0]) / (across[1] - across[0]) * width,
        TOP + height - (ring.at(channel.index, k) - up[0]) / (up[1] - up[0]) * height);
    }
    pen.strokeStyle = channel.colour;
    pen.lineWidth = 1.6;
    pen.stroke();
  }
}

export function cursorLines(pen, [w, h], places, theme) {
  const width = w - LEFT - RIGHT;
  places.forEach((share, k) => {
    if (share < 0 || share > 1) return;
    const x = LEFT + share * width;
    pen.setLineDash([5, 3]);
    line(pen, x, TOP, h - FOOT, theme.ink);
    pen.setLineDash([]);
    pen.fillStyle = theme.ink;
    pen.fillRect(x - 7, TOP, 14, 15);
    pen.fillStyle = theme.field;
    pen.font = "600 11px sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText("AB"[k], x, TOP + 8);
  });
}
