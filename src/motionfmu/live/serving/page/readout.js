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

export function readoutOf() {
  shown = panels().filter((p) => p.readout.machine).map((panel) => {
    const { readout, mdi } = panel, full = (key) => readout[key] && panel.full(readout[key]);
    const names = Object.fromEntries(Object.keys(readout).map((key) => [key, full(key)]));
    return { panel, names, axes: axesOf(names.machine), set: Boolean(mdi && names.offset) };
  });
  part("readout").closest("section").hidden = !shown.length;
  part("readout").replaceChildren(...shown.map(tableOf));
  watch("readout", shown.flatMap((s) => Object.values(s.names)));
}

// A row of a rotary axis counts 1 mm for 1°.
function unitOf(name, axis) {
  const { unit, type } = variable(name), shown = shownUnit(unit)[1];
  return shown === "mm" && axis.kind === "rotary" ? "°" : shown || (type === "Int32" ? "counts" : "");
}

function tableOf(one) {
  const { names, axes, set, panel } = one;
  const columns = [["machine", "Machine"], ["offset", "Work"], ["to_go", "To go"]].filter(([key]) => names[key]);
  if (names.offset) columns.sort(([a], [b]) => (b === "offset") - (a === "offset"));
  const head = made("tr", "", {}, made("td"),
    ...columns.map(([, words]) => made("th", words, { scope: "col" })), made("td"), ...(set ? [made("td")] : []));
  const field = made("input", "", { type: "number", step: "any", value: "0", "aria-label": "Value of a touch-off" });
  one.cells = axes.map((axis) => {
    const row = made("tr", "", {}, made("th", axis.name, { scope: "row" }));
    const cells = columns.map(([key]) => [key, row.appendChild(made("td"))]);
    row.append(made("td", unitOf(names.machine, axis), { className: "unit" }));
    if (set) {
      const button = made("button", "Set", { type: "button", title: `This place is the value below in ${axis.name}`, "aria-label": `Touch off ${axis.name}` });
      button.addEventListener("click", () => act("mdi", { component: panel.component, line: `G10 L20 P0 ${axis.name}${Number(field.value) || 0}` }));
      row.append(made("td", "", {}, button));
    }
    return { row, cells };
  });
  const table = made("table", "", { className: `position${names.offset ? " work" : ""}` }, made("thead", "", {}, head), made("tbody", "", {}, ...one.cells.map((c) => c.row)));
  one.facts = made("dl", "", { className: "facts" });
  const box = made("div", "", {}, table);
  if (set) box.append(made("label", "Set to ", { className: "touch" }, field));
  box.append(one.facts);
  return box;
}

export function showReadout() {
  for (const one of shown) {
    const { names, axes, cells } = one;
    const [machine, offset, to_go] = ["machine", "offset", "to_go"].map((key) => names[key] && values(names[key]));
    axes.forEach((axis, k) => {
      const at = axis.row - 1, factor = shownUnit(variable(names.machine).unit)[0];
      const numbers = { machine: machine[at] * factor, offset: offset && (machine[at] - offset[at]) * factor, to_go: to_go && to_go[at] * factor };
      const whole = variable(names.machine).type === "Int32";
      for (const [key, cell] of cells[k].cells) put(cell, fixed(numbers[key], whole ? 0 : 3));
    });
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
