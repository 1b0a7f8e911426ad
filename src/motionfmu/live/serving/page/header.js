// The head of the page: state, alarm, time, pace, who has the machine in hand, emergency stop.
import { choice, made, mark, part, put } from "./dom.js";
import { act, on } from "./link.js";
import { about, axisOf, frame, panels, value, values, variable, watch } from "./machine.js";
import { advice, capital, clock, figures, meaning } from "./words.js";

const PACES = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
const FASTEST = "max";
let shown = { panels: [], states: [], alarms: [], stops: [] };

export function headOf() {
  const all = panels(), named = (key) => all.filter((p) => p[key]).map((p) => p.full(p[key]));
  shown = { panels: all.filter((p) => p.state || p.alarm), states: named("state"), alarms: named("alarm"),
    stops: named("stop").filter((name) => variable(name)?.set) };
  put(part("name"), about.name);
  document.title = `${about.name}: live machine`;
  part("name").title = about.about;
  watch("head", [...shown.states, ...shown.alarms, ...shown.stops]);
}

choice(part("pace"), [...PACES.map((p) => [p, `${p} \u00d7`]), [FASTEST, "as fast as it goes"]], 1);
part("pace").addEventListener("change", ({ target }) =>
  act("pace", { factor: target.value === FASTEST ? null : Number(target.value) }));
part("run").addEventListener("click", () => act(frame?.running ? "pause" : "go"));
part("step").addEventListener("click", () => act("step", { count: 1 }));
part("take").addEventListener("click", () => act(frame?.hand ? "drop" : "take"));
part("stop").addEventListener("click", () => {
  const acting = shown.stops.filter((name) => value(name));
  if (acting.length) acting.forEach((name) => act("set", { name, value: false }));
  else act("stop");
});
addEventListener("keydown", (event) => {
  if (event.altKey && event.code === "KeyP") { event.preventDefault(); part("run").click(); }
});

const stopped = () => shown.stops.some((name) => value(name));

export function showHead() {
  put(part("time"), clock(frame.time));
  put(part("run"), frame.running ? "Pause" : "Run");
  part("step").disabled = frame.running || !frame.hand;
  for (const id of ["run", "pace"]) part(id).disabled = !frame.hand;
  showPace();
  showHand();
  showState();
  put(part("stop"), stopped() ? "Release the stop" : "Emergency stop");
  mark(part("stop"), "aria-pressed", stopped());
  const [woken, worst, p99, given_up] = frame.late;
  put(part("late"), `late ${(1e3 * p99).toFixed(1)} ms`);
  part("late").title = `99 % of ${woken} steps on the wall's clock were later by less than `
    + `${(1e3 * p99).toFixed(2)} ms, the worst by ${(1e3 * worst).toFixed(1)} ms; `
    + `${figures(given_up, 3)} s were given up`;
}

function showPace() {
  const select = part("pace"), now = frame.pace === null ? FASTEST : String(frame.pace);
  if (document.activeElement === select || select.value === now) return;
  if (![...select.options].some((o) => o.value === now)) {
    select.append(made("option", `${frame.pace} \u00d7`, { value: now }));
  }
  select.value = now;
}

function showHand() {
  const others = frame.watchers - 1;
  const watching = others > 0 ? `, ${others} more ${others === 1 ? "page watches" : "pages watch"}` : "";
  const who = frame.holder ? `${frame.holder} has it in hand` : "somebody else has it in hand";
  const nobody = frame.holder === null ? "nobody has it in hand" : who;
  put(part("hand"), frame.hand ? `in your hand${watching}` : nobody);
  const take = part("take");
  take.hidden = frame.hand && others < 1;
  put(take, frame.hand ? "Give it away" : "Take it");
  document.body.classList.toggle("watching", !frame.hand);
}

function showState() {
  const words = shown.states.map((name) => meaning(variable(name), value(name)));
  const alarms = shown.panels.flatMap(alarmsOf);
  if (frame.error) alarms.unshift(["The machine has stopped", `${frame.error}. Go back to an earlier state.`]);
  if (stopped() && !alarms.length) alarms.push(["Emergency stop", "Release it, then reset."]);
  const state = alarms.length ? "alarm" : frame.running ? "runs" : "stands";
  mark(part("state"), "data-kind", state);
  const text = words.filter(Boolean).join(", ");
  put(part("state"), capital(`${frame.running ? "" : "paused: "}${text || (frame.running ? "running" : "standing")}`));
  showAlarm(alarms);
}

// "axis 2" by the name that the machine's second axis has.
const byName = (words) => words.replace(/\baxis (\d+)/g, (whole, row) => axisOf(Number(row))?.name ?? whole);

// The alarms of a panel: by its codes, one for each axis of an array; else by its state.
function alarmsOf(panel) {
  const name = panel.alarm && panel.full(panel.alarm), own = variable(name ?? "");
  const codes = own ? values(name).map((code, k) => [code, own.shape.length ? k + 1 : 0]).filter(([code]) => code) : [];
  const told = codes.map(([code, row]) => alarmWords(panel, own, code, row)).filter(Boolean);
  const state = panel.state && value(panel.full(panel.state));
  if (told.length || !panel.monitor?.fault?.includes(state)) return told;
  const tells = variable(panel.full(panel.state));
  return [[capital(meaning(tells, state)), advice(tells, state)]];
}

function alarmWords(panel, own, code, row) {
  const word = own.type === "Boolean" ? own.doc : own.words?.[code];
  if (word === "none") return null;
  const where = row ? `${panel.title}, ${axisOf(row)?.name ?? `axis ${row}`}: ` : "";
  const text = where + byName(word ?? `error ${code}`);
  return [capital(text), advice(own, code)];
}

// The same words are not told twice by a screen reader.
function showAlarm(alarms) {
  const box = part("alarm"), text = alarms.flat().join(" ");
  if (box.dataset.text === text) return;
  box.dataset.text = text;
  box.hidden = !alarms.length;
  box.replaceChildren(...alarms.map(([what, todo]) =>
    made("p", "", {}, made("b", `${what}.`), " ", made("span", todo))));
}

on("link", (words, good) => {
  put(part("link"), words);
  mark(part("link"), "data-good", good);
  document.body.classList.toggle("away", !good);
});
on("about", () => {
  put(part("link"), "connected");
  mark(part("link"), "data-good", true);
  document.body.classList.remove("away");
});
let forget = 0;
export function told(words, kind = "bad") {
  const place = part("told");
  put(place, words);
  place.className = `told ${kind}`;
  clearTimeout(forget);
  forget = setTimeout(() => put(place, ""), 8000);
}
on("refused", (why) => told(why));
