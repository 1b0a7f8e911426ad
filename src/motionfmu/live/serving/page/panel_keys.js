// Keys, switches, dials and lamps of the panels.
import { made, mark, part, put } from "./dom.js";
import { act } from "./link.js";
import { panels, value, variable, watch } from "./machine.js";
import { figures } from "./words.js";

const KINDS = [[/start|go |resume/i, "start"], [/hold|pause|single/i, "hold"], [/abort|stop/i, "halt"],
  [/home|origin/i, "home"]];
let keys = [], commands = [], dials = [], lamps = [];

export function keysOf() {
  const all = panels();
  const free = (name) => variable(name)?.set; // nothing else of the machine sets it
  keys = all.flatMap((p) => Object.entries(p.key).filter(([name]) => free(p.full(name)))
    .map(([name, key]) => keyOf(p.full(name), key)));
  commands = all.filter((p) => p.command && free(p.full(p.command.number))).flatMap(commandsOf);
  const groups = all.filter((p) => [...keys, ...commands].some((k) => k.name.startsWith(`${p.component}.`)));
  part("keys").replaceChildren(...groups.map((p) => groupOf(p, groups.length > 1)));
  dials = all.flatMap((p) => Object.entries(p.dial).filter(([name]) => free(p.full(name)))
    .map(([name, dial]) => dialOf(p.full(name), dial)));
  part("dials").replaceChildren(...dials.map((d) => d.box));
  lamps = all.flatMap((p) => Object.entries(p.lamp).flatMap(([name, lamp]) => lampsOf(p.full(name), lamp)));
  part("lamps").replaceChildren(...lamps.map((l) => l.item));
  for (const [id, list] of [["keys", groups], ["dials", dials], ["lamps", lamps]]) {
    part(id).closest("section").hidden = !list.length;
  }
  watch("keys", [...keys, ...commands, ...dials, ...lamps].map((x) => x.name));
}

function groupOf(panel, titled) {
  const own = [...commands, ...keys].filter((k) => k.name.startsWith(`${panel.component}.`)).map((k) => k.button);
  const box = made("div", "", { className: "pads", role: "group", "aria-label": panel.title }, ...own);
  return titled ? made("div", "", {}, made("h3", panel.title), box) : box;
}

function keyOf(name, { label, kind }) {
  const own = variable(name), number = own.type !== "Boolean";
  const [, colour] = KINDS.find(([words]) => words.test(label)) ?? [, "plain"];
  // A switch only says that something is on: it starts and stops nothing by itself.
  const look = kind === "switch" && colour !== "hold" ? "plain" : colour;
  const button = made("button", label, { type: "button", className: `pad ${look}`, title: own.doc });
  if (kind === "switch") mark(button, "aria-pressed", false);
  button.addEventListener("click", () => {
    if (kind === "press") act("press", number ? { name, value: 1, rest: 0 } : { name });
    else act("set", { name, value: number ? Number(!value(name)) : !value(name) });
  });
  return { name, button, kind };
}

// Commands that a panel has by name.
function commandsOf({ component, command, full }) {
  const number = full(command.number);
  return Object.keys(command.codes).map((label) => {
    const [, colour] = KINDS.find(([words]) => words.test(label)) ?? [, "plain"];
    const button = made("button", label, { type: "button", className: `pad ${colour}` });
    button.addEventListener("click", () => act("command", { component, name: label }));
    return { name: number, button };
  });
}

const share = ({ unit, type }, high) => type === "Float64" && !unit && high > 0 && high <= 4;

function dialOf(name, { label, low, high }) {
  const own = variable(name), [least, most] = [low ?? own.low, high ?? own.high];
  if (least === null || most === null || least === undefined || most === undefined) return numberOf(name, label);
  const percent = share(own, most), id = `dial-${name.replace(/\W/g, "-")}`;
  const step = own.type === "Int32" ? 1 : percent ? 0.01 : (most - least) / 200;
  const range = made("input", "", { type: "range", id, min: least, max: most, step, title: own.doc });
  const told = made("output", "", { htmlFor: id });
  const say = (x) => (percent ? `${Math.round(100 * x)} %` : `${figures(x)} ${own.unit ?? ""}`);
  range.addEventListener("input", () => {
    put(told, say(Number(range.value)));
    mark(range, "aria-valuetext", told.textContent);
    act("set", { name, value: Number(range.value) });
  });
  const usual = made("button", percent ? "100 %" : "Reset", { type: "button", "aria-label": `${label} back to where it began` });
  usual.addEventListener("click", () => act("set", { name, value: percent ? 1 : began }));
  let began;
  const show = (x) => {
    began ??= x;
    if (document.activeElement === range && range.matches(":active")) return;
    if (Number(range.value) !== x) range.value = x;
    put(told, say(x));
    mark(range, "aria-valuetext", say(x));
  };
  return { name, show, box: made("div", "", { className: "dial" }, made("label", label, { htmlFor: id }), told, range, usual) };
}

// A dial without ends is a field.
function numberOf(name, label) {
  const { doc, unit, type } = variable(name), id = `dial-${name.replace(/\W/g, "-")}`;
  const field = made("input", "", { type: "number", id, step: type === "Int32" ? "1" : "any", title: doc });
  field.addEventListener("change", () => { if (field.value !== "") act("set", { name, value: Number(field.value) }); });
  const show = (x) => { if (document.activeElement !== field && field.value !== String(x)) field.value = x; };
  return { name, show, box: made("div", "", { className: "dial" }, made("label", unit ? `${label} [${unit}]` : label, { htmlFor: id }), field) };
}

function lampsOf(name, { label }) {
  const count = variable(name).shape[0] ?? 0;
  return Array.from({ length: count || 1 }, (_, k) => {
    const light = made("i", "", { role: "img" });
    const item = made("li", "", { title: variable(name).doc }, light, made("span", count ? `${label} ${k + 1}` : label));
    return { name, item, light, element: k };
  });
}

export function showKeys() {
  for (const { name, button, kind } of keys) if (kind === "switch") mark(button, "aria-pressed", Boolean(value(name)));
  for (const dial of dials) if (value(dial.name) !== undefined) dial.show(value(dial.name));
  for (const { name, light, element } of lamps) {
    const on = value(name, element), lit = Boolean(on);
    mark(light, "class", lit ? "on" : "");
    mark(light, "aria-label", lit ? "on" : "off");
  }
}
