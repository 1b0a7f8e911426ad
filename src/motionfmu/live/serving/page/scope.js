// The oscilloscope: channels, window, run and stop, cursors, files.
import { choice, download, made, mark, part, put, rows, toggle } from "./dom.js";
import { act, ask, on } from "./link.js";
import { about, frame, variable } from "./machine.js";
import { LEFT, RIGHT, againstX, cursorLines, overFrequency, overTime } from "./scope_draw.js";
import { signalList } from "./signal_list.js";
import { spectrum } from "./spectrum.js";
import { csv, npz } from "./trace_files.js";
import { TraceRing, ringOf, statistics } from "./trace_ring.js";
import { figures } from "./words.js";

const ROWS = 1 << 18; // steps that the page keeps of each channel
const SPANS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20];
const SHOWS = { lanes: "lanes", field: "one field", fft: "frequencies", xy: "XY" };
const SCALES = { auto: "each by itself", unit: "one for each unit" };
const COLOURS = ["#2f7fd6", "#e08a1e", "#1fa36b", "#d2456b", "#8a63d2", "#0f9fb0", "#a08a12", "#c05fb4",
  "#6f8f2f", "#d0603a", "#4f6fd0", "#3f9f9f", "#b0506f", "#8f7f5f", "#5f9f4f", "#9f6fcf"];
const SPECTRUM_MOST = 1 << 15, SPECTRUM_AGAIN = 200; // samples; [ms]
const TABLE_AGAIN = 100; // [ms] between two readings of the values
const canvas = part("scope"), pen = canvas.getContext("2d");

let channels = []; // { name, index, unit, colour, shown, low, high, scale }
let ring = new TraceRing([], ROWS), still = null; // what comes; what is looked at while it stands
let running = true, span = 2, seen = [0, 1], cursors = null, mark_at, asking = false, streaming = false;
let spectra = [], spectraAt = 0, tableAt = 0, pictures = [], held = null;

const shownRing = () => still ?? ring;
const step = () => about.step;

export function scopeOf() {
  const names = remembered().filter((name) => variable(name)?.type);
  choose(names.length ? names : firstOnes());
}

const key = () => `scope:${about.name}`;
function remembered() {
  try { return JSON.parse(localStorage.getItem(key())) ?? []; } catch { return []; }
}

// Without a choice yet: where the tool is commanded and where it is, an axis each.
function firstOnes() {
  const { scene } = about;
  return scene ? [scene.command, scene.tool].filter(Boolean).flatMap(([name]) => [`${name}[1]`, `${name}[2]`])
    .filter((name) => variable(name)) : [];
}

async function choose(names) {
  if (names.length > about.channels) return;
  try { localStorage.setItem(key(), JSON.stringify(names)); } catch { /* no store */ }
  asking = true;
  const done = frame ? frame.hand ? await act("channels", { names }) : undefined
    : await ask("channels", { names }).then(() => true, () => undefined); // nobody has asked for them yet
  asking = false;
  if (done !== undefined) adopt(names);
}

// The channels that the machine's ring has: those of whoever has chosen last.
function adopt(names) {
  if (names.join() === channels.map((c) => c.name).join()) return;
  const had = new Map(channels.map((c) => [c.name, c])), used = new Set(names.map((n) => had.get(n)?.colour));
  const free = COLOURS.filter((c) => !used.has(c));
  channels = names.map((name, index) => ({ shown: true, colour: had.get(name) ? undefined : free.shift(), unit: variable(name)?.unit ?? "", name,
    ...had.get(name), index }));
  ring = new TraceRing(names, ROWS);
  if (!running) run(true);
  part("scope-empty").hidden = names.length > 0;
  showChannels();
  choice(part("scope-x"), channels.map((c) => [c.name, c.name]), part("scope-x").value || channels[0]?.name);
  dispatchEvent(new CustomEvent("channels", { detail: names }));
}

on("samples", (got, data) => {
  if (asking) return;
  adopt(got.channels);
  if (got.rows && got.channels.length) ring.add(got.begin, got.rows, data);
});

// A record by a trigger is whole, however slow the page is.
on("triggered", (got, data) => {
  adopt(got.channels);
  still = ringOf(got.channels, got.begin, got.rows, data);
  mark_at = got.at;
  seen = [got.begin, got.begin + got.rows];
  run(false, false);
  dispatchEvent(new CustomEvent("triggered", { detail: got.at * step() }));
});

// Samples come only while somebody looks.
export function stream(looked) {
  if (looked === streaming || !frame) return;
  streaming = looked;
  ask("samples", { since: looked ? frame.steps : null }).catch(() => { streaming = false; });
}
on("link", () => { streaming = false; });

function run(now, kept = true) {
  running = now;
  setRun(now);
  put(part("scope-run"), now ? "Stop" : "Run");
  if (now) [still, mark_at] = [null, undefined];
  else if (kept) {
    still = ring.copy();
    seen = [Math.max(ring.begin, ring.end - span / step()), ring.end];
  }
  spectraAt = tableAt = 0;
}

const setRun = toggle(part("scope-run"), (on_) => run(on_), true);
put(part("scope-run"), "Stop");
choice(part("scope-span"), SPANS.map((s) => [s, s < 1 ? `${1e3 * s} ms` : `${s} s`]), span);
choice(part("scope-show"), Object.entries(SHOWS), "lanes");
choice(part("scope-scale"), Object.entries(SCALES), "auto");
part("scope-span").addEventListener("change", ({ target }) => {
  span = Number(target.value);
  if (!running) seen = [seen[1] - span / step(), seen[1]];
});
part("scope-show").addEventListener("change", ({ target }) => {
  part("scope-x-label").hidden = target.value !== "xy";
  spectraAt = 0;
});
toggle(part("scope-cursors"), (on_) => { cursors = on_ ? [0.33, 0.67] : null; tableAt = 0; showChannels(); });
signalList(part("scope-search"), part("scope-found"), (name) => {
  const names = channels.map((c) => c.name);
  if (names.includes(name)) return;
  if (names.length === about.channels) { dispatchEvent(new CustomEvent("told", { detail: `${about.channels} channels are the most: remove one first` })); return; }
  choose([...names, name]);
});

function showChannels() {
  rows(part("scope-channels"), channels.map((c) => c.name), channelOf).forEach((row, k) => {
    row.firstChild.style.setProperty("--c", channels[k].colour);
    put(row.children[1].children[1], channels[k].unit);
    mark(row.firstChild, "aria-pressed", channels[k].shown);
  });
}

function channelOf(name) {
  const of = () => channels.find((c) => c.name === name);
  const show = made("button", "", { type: "button", className: "swatch", "aria-label": `Show ${name}`, "aria-pressed": "true" });
  show.addEventListener("click", () => { of().shown = !of().shown; mark(show, "aria-pressed", of().shown); });
  const ends = ["low", "high"].map((end) => {
    const field = made("input", "", { type: "number", step: "any", placeholder: "auto", "aria-label": `${name}: ${end} end of its scale` });
    field.addEventListener("change", () => { of()[end] = field.value === "" ? undefined : Number(field.value); });
    return field;
  });
  const gone = made("button", "\u00d7", { type: "button", className: "quiet", "aria-label": `Remove ${name}` });
  gone.addEventListener("click", () => choose(channels.filter((c) => c.name !== name).map((c) => c.name)));
  return made("li", "", {}, show, made("div", "", {}, made("b", name), made("small")), gone,
    made("dl", "", {}, ...[0, 1, 2].map(() => made("div", "", {}, made("dt"), made("dd")))),
    made("span", "", { className: "ends" }, "scale", ends[0], "to", ends[1]));
}

const window_ = () => (running ? [ring.end - span / step(), ring.end] : seen);

function showValues(from, to) {
  const own = shownRing(), at = cursors?.map((share) => Math.round(from + share * (to - from)));
  const words = at ? ["A", "B", "B \u2212 A"] : ["now", "least", "most"];
  [...part("scope-channels").children].forEach((row, k) => {
    const peaks = [NaN, NaN];
    if (!at) own.peaks(k, Math.floor(from), Math.ceil(to), peaks);
    const [a, b] = at ? at.map((s) => own.at(k, s)) : [0, 0];
    const told = at ? [a, b, b - a] : [own.at(k, own.end - 1), ...peaks];
    told.forEach((v, n) => {
      const { firstChild, lastChild } = row.children[3].children[n];
      put(firstChild, words[n]);
      put(lastChild, figures(v, 4));
    });
  });
  put(part("scope-time"), at ? betweenCursors(own, at) : "");
}

function betweenCursors(own, [a, b]) {
  const seconds = (b - a) * step(), lines = [`B \u2212 A ${figures(seconds, 5)} s${seconds ? `, ${figures(1 / Math.abs(seconds), 5)} Hz` : ""}`];
  const [first, last] = [Math.min(a, b), Math.max(a, b) + 1];
  for (const { name, index } of channels.filter((c) => c.shown)) {
    const { low, high, mean, rms } = statistics(own.slice(index, first, last));
    lines.push(`${name}: least ${figures(low, 5)}, most ${figures(high, 5)}, mean ${figures(mean, 5)}, RMS ${figures(rms, 5)}`);
  }
  return lines.join("\n");
}

let theme = {};
function readTheme() {
  const style = getComputedStyle(canvas);
  theme = Object.fromEntries(["ink", "muted", "line", "grid", "field", "trigger"].map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}
addEventListener("theme", () => { theme = {}; });

export function showScope(now) {
  const [w, h] = [canvas.clientWidth, canvas.clientHeight], ratio = devicePixelRatio || 1;
  if (!w || !h) return;
  if (!theme.ink) readTheme();
  if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
    [canvas.width, canvas.height] = [Math.round(w * ratio), Math.round(h * ratio)];
  }
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, w, h);
  const [from, to] = window_(), shown = channels.filter((c) => c.shown), show = part("scope-show").value;
  if (shown.length) picture(show, shown, [w, h], from, to, now);
  if (cursors && (show === "lanes" || show === "field")) cursorLines(pen, [w, h], cursors, theme);
  if (now - tableAt > TABLE_AGAIN) {
    tableAt = now;
    showValues(from, to);
  }
  rate(now);
}

function picture(show, shown, size, from, to, now) {
  const own = shownRing();
  if (show === "fft") {
    if (now - spectraAt > (running ? SPECTRUM_AGAIN : Infinity) || !spectraAt) {
      spectraAt = now;
      const first = Math.max(from, to - SPECTRUM_MOST);
      spectra = shown.map((c) => ({ colour: c.colour, ...spectrum(own.slice(c.index, Math.floor(first), Math.ceil(to)), step()) }));
    }
    overFrequency(pen, size, { spectra, theme });
  } else if (show === "xy") {
    const x = channels.find((c) => c.name === part("scope-x").value) ?? shown[0];
    againstX(pen, size, { ring: own, from, to, x, channels: shown.filter((c) => c !== x), theme });
  } else {
    const mode = show === "lanes" ? "lanes" : part("scope-scale").value === "unit" ? "unit" : "field";
    overTime(pen, size, { ring: own, from, to, step: step(), channels: shown, mode, theme, mark: mark_at });
  }
}

// Pictures of the latest second.
function rate(now) {
  pictures.push(now);
  while (pictures[0] < now - 1000) pictures.shift();
  if (pictures.length % 10 === 0) put(part("scope-rate"), `${pictures.length} pictures/s`);
}

// By mouse and fingers: cursors are drawn along; a picture that stands is moved, the wheel zooms it.
const shareAt = (event) => (event.clientX - canvas.getBoundingClientRect().left - LEFT) / (canvas.clientWidth - LEFT - RIGHT);
canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  const share = shareAt(event);
  const nearest = cursors && (Math.abs(cursors[0] - share) < Math.abs(cursors[1] - share) ? 0 : 1);
  held = cursors && Math.abs(cursors[nearest] - share) < 0.05 ? { cursor: nearest } : { share, seen: [...seen] };
});
canvas.addEventListener("pointermove", (event) => {
  if (!held) return;
  const share = shareAt(event);
  if (held.cursor !== undefined) { cursors[held.cursor] = Math.max(0, Math.min(1, share)); tableAt = 0; }
  else if (!running) {
    const way = (share - held.share) * (held.seen[1] - held.seen[0]);
    seen = held.seen.map((s) => s - way);
    tableAt = 0;
  }
});
for (const gone of ["pointerup", "pointercancel"]) canvas.addEventListener(gone, () => { held = null; });
canvas.addEventListener("wheel", (event) => {
  if (running || document.activeElement !== canvas) return;
  event.preventDefault();
  zoom(Math.exp(0.0015 * event.deltaY), shareAt(event));
}, { passive: false });

function zoom(factor, share) {
  const at = seen[0] + share * (seen[1] - seen[0]), least = 8 / (seen[1] - seen[0]);
  seen = seen.map((s) => at + (s - at) * Math.max(factor, least));
  spectraAt = tableAt = 0;
}

// Keys: with cursors the arrows move B, with shift A; else the picture that stands.
canvas.addEventListener("keydown", (event) => {
  const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  if (way && cursors) {
    const k = event.shiftKey ? 0 : 1;
    cursors[k] = Math.max(0, Math.min(1, cursors[k] + way * 0.01));
  } else if (way && !running) seen = seen.map((s) => s + way * 0.1 * (seen[1] - seen[0]));
  else if (["+", "-"].includes(event.key) && !running) zoom(event.key === "+" ? 0.8 : 1.25, 0.5);
  else if (event.key === " ") run(!running);
  else return;
  tableAt = 0;
  event.preventDefault();
});

// What is shown, as columns: simulated time and the channels.
function columnsShown() {
  const [from, to] = window_().map(Math.round), own = shownRing();
  const first = Math.max(from, own.begin), last = Math.max(first, Math.min(to, own.end));
  const time = Float64Array.from({ length: last - first }, (_, k) => (first + k) * step());
  return [{ name: "time", data: time }, ...channels.filter((c) => c.shown).map((c) => ({ name: c.name, data: own.slice(c.index, first, last) }))];
}
part("scope-csv").addEventListener("click", () => download(`${about.name}.csv`, csv(columnsShown()), "text/csv"));
part("scope-npz").addEventListener("click", () => download(`${about.name}.npz`, npz(columnsShown())));
run(true);
