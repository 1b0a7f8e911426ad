// What was done: its list, the states to go back to, and saving it as a scenario with checks.
import { made, part, put, rows } from "./dom.js";
import { act, ask } from "./link.js";
import { about, frame, panels, values, variable, watch } from "./machine.js";
import { everySignal, matching } from "./signal_list.js";
import { clock, figures, meaning } from "./words.js";
import { told } from "./header.js";

const LATEST = 200, FOUND = 12;
let known = -1, checks = new Map(); // names of signals -> whether their value at the end is a check
const rooms = new Map(); // by name, what somebody typed
let moved = false;

export function journalOf() {
  known = -1;
  moved = false;
  checks = new Map(firstChecks().map((name) => [name, true]));
  part("checks-search").value = "";
  watchChecks();
}

// What an operator would ask: no alarm, the program ended, homed.
function firstChecks() {
  return panels().flatMap((p) => [p.alarm, ...Object.keys(p.lamp)].filter(Boolean).map(p.full))
    .filter((name) => variable(name)?.shape.length === 0);
}

function watchChecks() {
  const words = part("checks-search").value;
  const found = words ? matching(everySignal().filter((s) => !s.set), words, FOUND).map((s) => s.name) : [];
  const shown = [...new Set([...checks.keys(), ...found])];
  watch("checks", shown.map((n) => n.replace(/\[[\d,]+\]$/, "")));
  rows(part("checks"), shown, (name) => {
    const box = made("input", "", { type: "checkbox", checked: checks.get(name) ?? false });
    box.addEventListener("change", () => checks.set(name, box.checked));
    const row = made("div", "", { className: "check" }, made("label", "", {}, box, made("code", name)), made("span"));
    if (variable(name.replace(/\[[\d,]+\]$/, ""))?.type === "Float64") row.append(roomOf(name));
    return row;
  });
}
function roomOf(name) {
  const field = made("input", "", { type: "number", step: "any", min: 0, "aria-label": `${name}: by how much it may differ` });
  field.addEventListener("change", () => { if (field.value === "") rooms.delete(name); else rooms.set(name, Number(field.value)); });
  return made("label", "\u00b1 ", { className: "hint" }, field);
}

part("checks-search").addEventListener("input", watchChecks);

// Present value of a signal or of an element of one.
function present(name) {
  const [, whole, index] = /^(.*?)(?:\[([\d,]+)\])?$/.exec(name), all = values(whole);
  if (!index) return all[0];
  const { shape } = variable(whole);
  return all[index.split(",").reduce((at, i, k) => at * shape[k] + Number(i) - 1, 0)];
}

// A scenario of what was done may begin so long before [s], once there is more.
const MINUTE = 60;

// By how much a number may differ at the end, until somebody says it: a share of it, or a little.
const SHARE = 1e-3, LEAST = 1e-6;
export const usualRoom = (now) => Number(Math.max(LEAST, SHARE * Math.abs(Number(now) || 0)).toPrecision(1));

part("save").addEventListener("submit", async (event) => {
  event.preventDefault();
  const ticked = [...checks].filter(([, on]) => on).map(([name]) => name);
  const ends = Object.fromEntries(ticked.map((name) => [name, rooms.get(name) ?? usualRoom(present(name))]));
  const last = Number(part("save-begin").value), begin = last ? frame.time - last : null;
  const place = await act("save", { folder: part("folder").value.trim(), begin, ends });
  if (place) told(`Saved: ${place}`, "good");
});

part("back-to").addEventListener("input", () => { moved = true; });
part("back").addEventListener("click", async () => {
  const there = await act("back", { time: Number(part("back-to").value) });
  moved = false;
  if (there !== undefined) told(`The machine is as it was at ${figures(there, 6)} s`, "good");
});

export function showJournal() {
  const range = part("back-to"), kept = frame.kept;
  const long = kept && frame.time - kept[0] > MINUTE;
  part("save-begins").hidden = !long;
  if (!long) part("save-begin").value = "";
  range.disabled = part("back").disabled = !kept || !frame.hand;
  if (kept) {
    [range.min, range.max] = kept;
    if (!moved) range.value = kept[1];
    put(part("kept"), `${kept[2]} states from ${clock(kept[0])} to ${clock(kept[1])}`);
    put(part("back-time"), clock(Number(range.value)));
  }
  for (const row of part("checks").children) {
    const name = row.dataset.key, now = present(name), own = variable(name);
    put(row.children[1], now === undefined ? "" : own?.words?.[now] ?? figures(now, 7));
    const field = row.querySelector("[type=number]");
    if (field && now !== undefined) field.placeholder = usualRoom(now);
  }
  if (frame.actions !== known) list();
}

async function list() {
  known = frame.actions;
  try {
    const latest = (await ask("journal", { last: LATEST })).reverse();
    part("journal").replaceChildren(...latest.map(([time, name, given]) => {
      const words = new Set(given).size === 1 ? meaning(variable(name), given[0]) : given.map((v) => figures(v)).join(", ");
      return made("li", "", {}, made("time", clock(time)), made("code", name), made("span", words));
    }));
    if (!latest.length) part("journal").replaceChildren(made("li", "Nothing yet: what is set, pressed, jogged or typed stands here.", { className: "hint" }));
  } catch { known = -1; }
}
