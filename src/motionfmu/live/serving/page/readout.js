// Where the machine is: machine and work coordinates, distance to go, feed, spindle, modes.
import { made, part, put, rows } from "./dom.js";
import { act } from "./link.js";
import { about, panels, value, values, variable, watch } from "./machine.js";
import { figures, fixed } from "./words.js";

const TO_SHOWN = { m: [1000, "mm"], rad: [180 / Math.PI, "°"], deg: [1, "°"] };
const TO_FEED = { "mm/s": 60, "m/s": 60000 };
let shown = [];

export const shownUnit = (unit) => TO_SHOWN[unit] ?? [1, unit ?? ""];

// The axes that an array has: those of the machine, or X Y Z of a tool.
export function axesOf(name) {
  const own = variable(name), count = own?.shape[0] ?? 1;
  const length = ["m", "mm"].includes(own?.unit);
  const fits = about.axes.filter((a) => a.row <= count && !(length && count === 3 && a.kind === "rotary"));
  if (!fits.length) return ["X", "Y", "Z", "A", "B", "C"].slice(0, count).map((axis, k) => ({ name: axis, row: k + 1, kind: "linear" }));
  return fits;
}

const ENDS = ["low", "high", "limited"]; // parameters, which no frame has

// A length [mm] as a line of a program says it now: in inch behind G20. Angles stay.
const INCH = 25.4, G20 = 200;
export function programmed(panel, millimetres, axis) {
  const inch = panel.readout.modes && values(panel.full(panel.readout.modes)).includes(G20);
  return inch && axis?.kind !== "rotary" ? Number((millimetres / INCH).toPrecision(12)) : millimetres;
}

// Where an axis can go no further, in the shown unit: at most so far from an end of its travel.
const NEAR = 0.02;
function endOf({ names, limits }, axis, now) {
  if (!limits || limits.on?.[axis.row - 1] === false) return "";
  const unit = unitOf(names.machine, axis);
  for (const end of [limits.low, limits.high]) {
    const there = end?.[axis.row - 1];
    if (Math.abs(now - there) <= (unit === "counts" ? 0 : NEAR)) return `${axis.name} is at the end of its travel, ${figures(there, 6)} ${unit}`;
  }
  return "";
}

// Ends of the travel by axis; parameters have them in the unit that the position is shown in: mm, degrees, counts.
function limitsOf({ component, readout }) {
  if (!readout.low || !readout.high) return null;
  const own = about.components[component].parameters;
  return { low: own[readout.low], high: own[readout.high], on: readout.limited && own[readout.limited] };
}

export function readoutOf() {
  shown = panels().filter((p) => p.readout.machine).map((panel) => {
    const { readout, mdi } = panel, full = (key) => readout[key] && panel.full(readout[key]);
    const names = Object.fromEntries(Object.keys(readout).map((key) => [key, full(key)]).filter(([key]) => !ENDS.includes(key)));
    return { panel, names, axes: axesOf(names.machine), set: Boolean(mdi && names.offset), limits: limitsOf(panel) };
  });
  part("readout").closest("section").hidden = !shown.length;
  part("readout").replaceChildren(...shown.map(tableOf));
  watch("readout", shown.flatMap((s) => Object.values(s.names)));
}

// Length of a count [mm], where the machine tells it; 0 of what is no count.
const lengthOf = (names) => (variable(names.machine).type === "Int32" ? 1000 * (about.signals.count ?? 0) : 0);

// A row of a rotary axis counts 1 mm for 1°.
export function unitOf(name, axis) {
  const { unit, type } = variable(name), shown = shownUnit(unit)[1];
  return shown === "mm" && axis.kind === "rotary" ? "°" : shown || (type === "Int32" ? "counts" : "");
}

function tableOf(one) {
  const { names, axes, set, panel } = one;
  const counts = lengthOf(names) > 0;
  const columns = [["machine", counts ? "Counts" : "Machine"], ["offset", "Work"], ["to_go", "To go"]].filter(([key]) => names[key]);
  if (counts) columns.push(["length", "mm"]);
  if (names.offset) columns.sort(([a], [b]) => (b === "offset") - (a === "offset"));
  const head = made("tr", "", {}, made("td"),
    ...columns.map(([, words]) => made("th", words, { scope: "col" })), made("td"), ...(set ? [made("td")] : []));
  const field = made("input", "", { type: "number", step: "any", value: "0", "aria-label": "Value of a touch-off" });
  one.cells = axes.map((axis) => {
    const row = made("tr", "", {}, made("th", axis.name, { scope: "row" }));
    const cells = columns.map(([key]) => [key, row.appendChild(made("td"))]);
    row.append(made("td", counts ? "" : unitOf(names.machine, axis), { className: "unit" }));
    if (set) {
      const button = made("button", "Set", { type: "button", title: `This place is the value below in ${axis.name}`, "aria-label": `Touch off ${axis.name}` });
      button.addEventListener("click", () => act("mdi", { component: panel.component, line: `G10 L20 P0 ${axis.name}${programmed(panel, Number(field.value) || 0, axis)}` }));
      row.append(made("td", "", {}, button));
    }
    return { row, cells };
  });
  const table = made("table", "", { className: `position${names.offset ? " work" : ""}` }, made("thead", "", {}, head), made("tbody", "", {}, ...one.cells.map((c) => c.row)));
  one.facts = made("dl", "", { className: "facts" });
  one.ends = made("p", "", { className: "ends-told", role: "status" });
  const box = made("div", "", {}, table);
  if (set) box.append(made("label", "Set to ", { className: "touch" }, field));
  box.append(one.ends, one.facts);
  return box;
}

export function showReadout() {
  for (const one of shown) {
    const { names, axes, cells } = one, ends = [];
    const [machine, offset, to_go] = ["machine", "offset", "to_go"].map((key) => names[key] && values(names[key]));
    axes.forEach((axis, k) => {
      const at = axis.row - 1, factor = shownUnit(variable(names.machine).unit)[0];
      const numbers = { machine: machine[at] * factor, offset: offset && (machine[at] - offset[at]) * factor, to_go: to_go && to_go[at] * factor, length: machine[at] * lengthOf(names) };
      const whole = variable(names.machine).type === "Int32";
      for (const [key, cell] of cells[k].cells) put(cell, fixed(numbers[key], whole && key !== "length" ? 0 : 3));
      ends.push(endOf(one, axis, numbers.machine));
    });
    put(one.ends, ends.filter(Boolean).join("; "));
    showFacts(one);
  }
}

// A tool's number, or where its tip is.
function toolOf(name) {
  const { shape, unit } = variable(name);
  if (!shape.length) return `T${value(name) ?? 0}`;
  const [factor, shown] = shownUnit(unit);
  return `${values(name).map((x, k) => `${"XYZABC"[k]} ${fixed(factor * x, 2)}`).join("  ")} ${shown}`;
}

function showFacts({ names, facts }) {
  const told = {};
  if (names.feed) {
    const { unit } = variable(names.feed), factor = TO_FEED[unit];
    told.Feed = factor ? `${fixed(value(names.feed) * factor, 0)} mm/min` : `${figures(value(names.feed))} ${unit ?? ""}`;
  }
  if (names.spindle) told.Spindle = `${fixed(value(names.spindle), 0)} rpm`;
  if (names.tool) told.Tool = toolOf(names.tool);
  if (names.modes) told.Modes = values(names.modes).filter((g) => g >= 0).map((g) => `G${g % 10 ? g / 10 : g / 10 | 0}`).join(" ") || "\u2013";
  rows(facts, Object.keys(told), (name) => made("div", "", {}, made("dt", name), made("dd")))
    .forEach((row) => put(row.lastChild, told[row.dataset.key]));
}
