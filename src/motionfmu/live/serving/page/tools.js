// The tool table: a window of it that the controller shows, edited by lines of a program.
import { made, mark, part, put, rows } from "./dom.js";
import { act } from "./link.js";
import { panels, value, values, variable, watch } from "./machine.js";
import { axesOf, programmed, unitOf } from "./readout.js";
import { fixed } from "./words.js";

let tables = [];

export function toolsOf() {
  tables = panels().filter((p) => p.tools && p.mdi).map(tableOf);
  part("tools").closest("section").hidden = !tables.length;
  part("tools").replaceChildren(...tables.map((t) => t.box));
  watch("tools", tables.flatMap((t) => [...Object.values(t.names), t.loaded]));
}

function tableOf(panel) {
  const names = Object.fromEntries(Object.entries(panel.tools).map(([key, name]) => [key, panel.full(name)]));
  const axes = axesOf(panel.full(panel.readout.machine));
  const one = { panel, names, axes, loaded: panel.full(panel.readout.tool), body: made("tbody") };
  const head = made("tr", "", {}, made("th", "Tool", { scope: "col" }),
    ...axes.map((a) => made("th", `${a.name} [${unitOf(names.offset, a)}]`, { scope: "col" })),
    made("th", "Diameter [mm]", { scope: "col" }));
  one.table = made("table", "", { className: "tools" }, made("thead", "", {}, head), one.body);
  one.none = made("p", "No tool is listed: each exists, with offsets and diameter 0.", { className: "hint" });
  const count = values(names.number).length || variable(names.number).shape[0];
  one.back = made("button", "\u2039", { type: "button", "aria-label": "Tools before" });
  one.on = made("button", "\u203a", { type: "button", "aria-label": "Tools behind" });
  one.place = made("span", "", { className: "hint" });
  const go = (way) => act("set", { name: names.first, value: Math.max(1, (value(names.first) ?? 1) + way * count) });
  one.back.addEventListener("click", () => go(-1));
  one.on.addEventListener("click", () => go(1));
  one.pages = made("div", "", { className: "row" }, one.back, one.place, one.on);
  one.box = made("div", "", {}, made("div", "", { className: "tools-wide" }, one.table), one.none, one.pages, addOf(one),
    made("p", "A value given here is a line G10 L1: it counts from the next G43 or tool change on, and the file stays as it is.", { className: "hint" }));
  return one;
}

// A value of a tool as a line: R is half the diameter.
export function lineOf(number, word, value) {
  return `G10 L1 P${number} ${word === "R" ? `R${value / 2}` : `${word}${value}`}`;
}

function give({ panel }, number, axis, given) {
  const length = programmed(panel, given, axis);
  return act("mdi", { component: panel.component, line: lineOf(number, axis?.name ?? "R", length) });
}

// A tool that is not listed yet.
function addOf(one) {
  const number = made("input", "", { type: "number", min: 1, step: 1, required: true, "aria-label": "Number of a tool" });
  const axis = one.axes.find((a) => a.name === "Z") ?? one.axes[0];
  const length = made("input", "", { type: "number", step: "any", value: 0, required: true, "aria-label": `Its offset in ${axis.name}` });
  const form = made("form", "", { className: "bar tools-add" }, made("label", "Tool ", {}, number), made("label", `${axis.name} `, {}, length),
    made("button", "Set tool", { type: "submit" }));
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    if (await give(one, Number(number.value), axis, Number(length.value)) !== undefined) number.value = "";
  });
  return form;
}

function rowOf(one, number) {
  const field = (axis, label) => {
    const input = made("input", "", { type: "number", step: "any", "aria-label": `${label} of tool ${number}` });
    input.addEventListener("change", () => { if (input.value !== "") give(one, number, axis, Number(input.value)); });
    return made("td", "", {}, input);
  };
  return made("tr", "", {}, made("th", "", { scope: "row" }, `T${number}`, made("small")), ...one.axes.map((a) => field(a, a.name)), field(null, "Diameter"));
}

export function showTools() {
  for (const one of tables) {
    const { names, axes } = one, numbers = values(names.number), shown = numbers.filter((n) => n >= 0);
    const width = variable(names.offset).shape[1], offset = values(names.offset), diameter = values(names.diameter);
    rows(one.body, shown, (number) => rowOf(one, number)).forEach((row, k) => {
      const told = [...axes.map((a) => offset[k * width + a.row - 1]), diameter[k]];
      told.forEach((x, n) => {
        const input = row.children[n + 1].firstChild, text = fixed(x, 3).replace("\u2212", "-");
        if (document.activeElement !== input && input.value !== text) input.value = text;
      });
      const loaded = value(one.loaded) === shown[k];
      if (loaded) mark(row, "aria-current", "true"); else row.removeAttribute("aria-current");
      put(row.firstChild.lastChild, loaded ? "in the spindle" : "");
    });
    const count = value(names.rows) ?? 0, first = value(names.first) ?? 1;
    one.none.hidden = count > 0;
    one.table.hidden = !count;
    one.pages.hidden = count <= numbers.length && first === 1;
    one.back.disabled = first <= 1;
    one.on.disabled = first + numbers.length > count;
    put(one.place, `${first} to ${Math.min(count, first + numbers.length - 1)} of ${count}`);
  }
}
