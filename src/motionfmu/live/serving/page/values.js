// Faults and parameters: everything that can be set, by component, with what was changed and its undo.
import { made, mark, part, put } from "./dom.js";
import { act, ask } from "./link.js";
import { about, axisOf, elements, frame, split, variable } from "./machine.js";
import { figures } from "./words.js";

const AGAIN = 400; // [ms] between two looks at the values
const OPEN_MOST = 12; // elements of an array that have a field each
const ROWS = 6; // elements of an array that has one for each axis
let groups = [], items = [], changed = {}, shownAt = 0, sets = 0; // `sets`: how often a value was set here

export function valuesOf() {
  changed = {};
  const faults = new Map(Object.entries(about.components).flatMap(([component, { panel }]) =>
    Object.entries(panel?.fault ?? {}).map(([own, { label }]) => [`${component}.${own}`, label])));
  const settable = Object.entries(about.components).flatMap(([component, { variables }]) =>
    Object.entries(variables).filter(([, v]) => v.set && v.type !== "String").map(([own]) => `${component}.${own}`));
  items = settable.map((name) => itemOf(name, faults.get(name)));
  const first = items.filter((i) => faults.has(i.name));
  groups = [["Faults", first], ...Object.entries(about.components).map(([component, { fmu, panel }]) =>
    [`${component}: ${panel?.title ?? fmu}`, items.filter((i) => split(i.name)[0] === component && !faults.has(i.name))])]
    .filter(([, own]) => own.length)
    .map(([title, own]) => ({ own, box: made("section", "", { className: "block", "aria-label": title }, made("h2", title), ...own.map((i) => i.box)) }));
  part("values").replaceChildren(...groups.map((g) => g.box));
  filter();
}

function itemOf(name, label) {
  const own = variable(name), id = `value-${name.replace(/\W/g, "-")}`;
  const names = elements(name), single = names.length === 1;
  const fields = names.length > OPEN_MOST ? [] : names.map((one, k) => fieldOf(one, own, single ? id : `${id}-${k}`, single ? label ?? name : one));
  const undo = made("button", "Undo", { type: "button", hidden: true, "aria-label": `Undo ${label ?? name}` });
  undo.addEventListener("click", () => act("undo", { name }));
  const all = names.length > OPEN_MOST ? allOf(name, own, names.length) : null;
  const title = made(single ? "label" : "span", label ?? split(name)[1], single ? { htmlFor: id, className: "title" } : { className: "title" });
  const box = made("div", "", { className: "value", role: "group", "aria-label": label ?? name }, made("div", "", { className: "words" }, title,
    ...(label ? [made("code", name)] : []), made("p", own.doc, { className: "hint" }), made("span", "", { className: "was" })),
  made("div", "", { className: "fields" }, ...fields.map((f) => f.box), ...(all ? [all] : []), made("span", [own.unit, rangeOf(own)].filter(Boolean).join("  "), { className: "hint" }), undo));
  return { name, label: label ?? "", box, fields, undo, was: box.querySelector(".was"), text: `${name} ${label ?? ""} ${own.doc}`.toLowerCase() };
}

// One value for all elements of a long array.
function allOf(name, own, count) {
  const field = made("input", "", { type: "number", step: "any", placeholder: `all ${count}`, "aria-label": `${name}, all elements` });
  field.addEventListener("change", () => { if (field.value !== "") { sets++; act("set", { name, value: given(own, field.value) }); } });
  return field;
}

// An element by its axis where an array has one for each row of the axes, else by its number.
function indexOf(name, own) {
  const index = /\[([\d,]+)\]$/.exec(name)?.[1];
  const axis = own.shape.length === 1 && own.shape[0] === ROWS && axisOf(Number(index));
  return axis ? axis.name : index;
}

function rangeOf({ low, high, type }) {
  if (type === "Boolean" || (low === null && high === null)) return "";
  if (low === null) return `\u2264 ${figures(high)}`;
  return high === null ? `\u2265 ${figures(low)}` : `${figures(low)} \u2026 ${figures(high)}`;
}

const given = (own, text) => (own.type === "Boolean" ? text === "true" || text === true : Number(text));

function fieldOf(name, own, id, label) {
  const index = own.shape.length ? indexOf(name, own) : "";
  const set = (value) => { sets++; return act("set", { name, value }); };
  if (own.type === "Boolean") {
    const box = made("input", "", { type: "checkbox", id, role: "switch", "aria-label": label });
    box.addEventListener("change", () => set(box.checked));
    return { box: index ? made("label", index, { className: "element" }, box) : box, show: (v) => { box.checked = v; } };
  }
  if (Object.keys(own.words).length) {
    const box = made("select", "", { id, "aria-label": label }, ...Object.entries(own.words).map(([v, words]) => made("option", words, { value: v })));
    box.addEventListener("change", () => set(Number(box.value)));
    return { box, show: (v) => { if (document.activeElement !== box) box.value = v; } };
  }
  const box = made("input", "", { type: "number", step: own.type === "Int32" ? "1" : "any", id, "aria-label": label });
  if (own.low !== null) box.min = own.low;
  if (own.high !== null) box.max = own.high;
  box.addEventListener("change", () => { if (box.value !== "") set(Number(box.value)); });
  const show = (v) => { if (document.activeElement !== box && box.value !== String(v)) box.value = v; };
  return { box: index ? made("label", index, { className: "element" }, box) : box, show };
}

function filter() {
  const words = part("values-search").value.toLowerCase().split(/\s+/).filter(Boolean), only = part("values-changed").checked;
  let count = 0;
  for (const { own, box } of groups) {
    let some = false;
    for (const item of own) {
      const fits = words.every((w) => item.text.includes(w)) && (!only || item.name in changed);
      item.box.hidden = !fits;
      some ||= fits;
      count += fits;
    }
    box.hidden = !some;
  }
  put(part("values-count"), `${count} of ${items.length}, ${Object.keys(changed).length} changed`);
}
part("values-search").addEventListener("input", filter);
part("values-changed").addEventListener("change", filter);

export async function showValues(now) {
  if (now - shownAt < AGAIN || !items.length) return;
  shownAt = now;
  const names = items.filter((i) => !i.box.hidden && i.fields.length).map((i) => i.name), before = sets;
  try {
    const [values, differ] = await Promise.all([ask("values", { names }), ask("changed")]);
    if (sets !== before) return; // what was set in the meantime is in the next answer
    changed = differ;
    for (const item of items) {
      const differs = item.name in changed, own = values[item.name];
      item.undo.hidden = !differs;
      item.undo.disabled = !frame.hand;
      item.box.classList.toggle("changed", differs);
      put(item.was, differs ? `began as ${shortly(changed[item.name][0])}` : "");
      if (own) item.fields.forEach((field, k) => { if (own[k] !== null) field.show(own[k]); });
    }
    filter();
    mark(part("tab-values"), "data-count", Object.keys(changed).length || "");
  } catch { /* the line is cut: what was there stays */ }
}

// Equal elements of an array are told once.
const shortly = (values) => (new Set(values).size === 1 ? figures(values[0]) : values.map((v) => figures(v)).join(", "));
