// The machine as the page knows it: what it is, its latest frame, values that somebody looks at.
import { ask, on } from "./link.js";

export let about = null;
export let frame = null;
const wanted = new Map(); // names that a view looks at, by view
let asked = "";

export const variable = (name) => {
  const [component, own] = split(name);
  return about?.components[component]?.variables[own];
};

// component.variable of a whole signal or an element of one.
export function split(name) {
  const at = name.indexOf(".");
  return [name.slice(0, at), name.slice(at + 1).replace(/\[[\d,]+\]$/, "")];
}

export const value = (name, element = 0) => frame?.values[name]?.[element];
export const values = (name) => frame?.values[name] ?? [];
export const known = (name) => variable(name) !== undefined;

// What a view looks at from now on; the machine is told of the names of all views.
export function watch(view, names) {
  wanted.set(view, names.filter(known));
  const all = [...new Set([...wanted.values()].flat())].sort();
  if (!about || asked === all.join()) return;
  asked = all.join();
  ask("watch", { names: all }).catch(() => { asked = ""; });
}

on("about", (got) => {
  about = got;
  asked = "";
});
on("frame", (got) => { frame = got; });

// Panels of the machine: of each component that has one, its names with the component before.
export function panels() {
  return Object.entries(about.components).filter(([, c]) => c.panel)
    .map(([component, c]) => ({ component, ...c.panel, full: (name) => `${component}.${name}` }));
}

// Elements of a signal as channels, with their axes' names.
export function elements(name) {
  const shape = variable(name)?.shape ?? [];
  if (!shape.length) return [name];
  const index = shape.reduce((all, size) => all.flatMap((i) =>
    Array.from({ length: size }, (_, k) => [...i, k + 1])), [[]]);
  return index.map((i) => `${name}[${i.join(",")}]`);
}

export const axisOf = (row) => about.axes.find((axis) => axis.row === row);
