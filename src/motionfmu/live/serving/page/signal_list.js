// A field that finds signals by words, and the list of what it finds: by mouse and by keyboard.
import { made, mark } from "./dom.js";
import { about, elements } from "./machine.js";

const MOST = 60;

// All signals that are numbers, each element by itself, with what is known of them.
export function everySignal() {
  return Object.entries(about.components).flatMap(([component, { variables }]) =>
    Object.entries(variables).filter(([, v]) => v.type !== "String").flatMap(([own, v]) =>
      elements(`${component}.${own}`).map((name) => ({ name, doc: v.doc, unit: v.unit ?? "", set: v.set }))));
}

// Those that have all the words in their names or descriptions; names that have them come first.
export function matching(signals, text, most = MOST) {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const named = [], told = [];
  for (const one of signals) {
    const name = one.name.toLowerCase(), all = `${name} ${one.doc.toLowerCase()}`;
    if (words.every((w) => name.includes(w))) named.push(one);
    else if (words.every((w) => all.includes(w))) told.push(one);
  }
  return [...named, ...told].slice(0, most);
}

export function signalList(field, list, chosen) {
  let found = [], at = -1;
  const show = () => {
    found = matching(everySignal(), field.value);
    at = field.value && found.length ? 0 : -1;
    list.replaceChildren(...found.map((one, k) => {
      const item = made("li", "", { role: "option", id: `${list.id}-${k}` }, made("b", one.name), made("span", one.doc));
      item.addEventListener("pointerdown", (event) => { event.preventDefault(); choose(one); });
      return item;
    }));
    open(true);
    marked();
  };
  const open = (on) => { list.hidden = !on || !found.length; mark(field, "aria-expanded", !list.hidden); };
  const marked = () => {
    [...list.children].forEach((item, k) => mark(item, "aria-selected", k === at));
    mark(field, "aria-activedescendant", at < 0 ? "" : `${list.id}-${at}`);
    list.children[at]?.scrollIntoView({ block: "nearest" });
  };
  const choose = (one) => { chosen(one.name); field.select(); };
  field.addEventListener("input", show);
  field.addEventListener("focus", show);
  field.addEventListener("blur", () => open(false));
  field.addEventListener("keydown", (event) => {
    const way = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (way && found.length) { open(true); at = (at + way + found.length) % found.length; marked(); }
    else if (event.key === "Enter" && found[at]) choose(found[at]);
    else if (event.key === "Escape" && !list.hidden) open(false);
    else return;
    event.preventDefault();
  });
}
