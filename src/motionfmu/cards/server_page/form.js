// The form of the configuration: made of the server's description, checked by it as it is typed.
import { download, made, part, post } from "./link.js";

const AXES = "XYZU", PINS = 16, CHECK = 250; // [ms] of rest before a check
let sections = null, file = "", values = null, timer = 0, asked = 0, card = null, right = false;

export async function showForm() {
  if (sections) return;
  try {
    const said = await post("/config/form");
    [sections, file] = [said.form, said.file];
    take(said.values || empty());
  } catch (error) {
    verdict(error.message, false);
  }
}

// The card that the form is sent to.
export function formCard(id) {
  card = id;
  part("config-send").textContent = id === null ? "Send to card" : `Send to card ${id}`;
  part("config-send").disabled = id === null || !right;
}

const fieldsOf = (place) => sections.find((s) => s.place === place).fields;
const fresh = (place) => Object.fromEntries(fieldsOf(place).map((f) => [f.name, f.default]));

// A configuration of two axes to begin with.
function empty() {
  const axis = { ...fresh("axes"), pulses_per_mm: 1000, minimum: 0, maximum: 300, speed_max: 100,
    acceleration_max: 1000 };
  const all = Object.fromEntries(sections.filter((s) => !/axes|inputs|\./.test(s.place))
    .map((s) => [s.place, fresh(s.place)]));
  all.motion.pen = fresh("motion.pen");
  return { ...all, axes: [{ name: "X", ...axis }, { name: "Y", ...axis }],
    inputs: Array.from({ length: PINS }, () => fresh("inputs")), outputs: Array(PINS).fill("") };
}

// Value at a place such as axes.0.speed_max, and how it is set.
function at(place) {
  const keys = place.split("."), last = keys.pop();
  return [keys.reduce((tree, key) => tree?.[key], values), last];
}

function take(found) {
  values = found;
  part("config-file").textContent = file ? `Kept in ${file}.` : "Used until the server ends.";
  const make = { axes: axes, inputs: pins };
  part("form").replaceChildren(...sections.flatMap((s) => (make[s.place] || one)(s)));
  check();
}

function one(section) {
  const set = made("fieldset");
  set.append(made("legend", section.title), made("p", section.about, { className: "hint" }));
  set.append(...section.fields.map((f) => labelled(f, `${section.place}.${f.name}`)));
  return [set];
}

function axes(section) {
  const sets = values.axes.map((axis, k) => {
    const set = made("fieldset");
    set.append(made("legend", `Axis ${axis.name}`));
    set.append(...section.fields.map((f) => labelled(f, `axes.${k}.${f.name}`, axis.name)));
    return set;
  });
  const buttons = made("div", "", { className: "row" });
  const add = made("button", "Add an axis", { type: "button", disabled: sets.length > 3 });
  const less = made("button", "Remove the last axis", { type: "button", disabled: sets.length < 2 });
  add.addEventListener("click", () => {
    values.axes.push({ ...values.axes.at(-1), name: AXES[values.axes.length] });
    take(values);
  });
  less.addEventListener("click", () => { values.axes.pop(); take(values); });
  buttons.append(add, less);
  sets.at(-1).append(buttons);
  return sets;
}

// A table of all inputs and outputs.
function pins(section) {
  const set = made("fieldset", "", { className: "wide" }), table = made("table");
  const head = made("tr");
  head.append(made("th", "Pin"), ...section.fields.map((f) => made("th", heading(f))),
    made("th", "Output"));
  table.append(head);
  for (let k = 0; k < PINS; k++) {
    const row = made("tr");
    row.append(made("th", k));
    for (const f of section.fields) row.append(cell(f, `inputs.${k}.${f.name}`, `input ${k}`));
    const name = { name: "name", kind: "text", words: "Name" };
    row.append(cell(name, `outputs.${k}`, `output ${k}`));
    table.append(row);
  }
  const scroll = made("div", "", { className: "scroll" });
  scroll.append(table);
  set.append(made("legend", "Inputs and outputs"), scroll);
  return [set];
}

const heading = (f) => (f.unit ? `${f.words} [${f.unit}]` : f.words);

function cell(field, place, of) {
  const td = made("td");
  const input = control(field, place);
  input.ariaLabel = `${heading(field)}, ${of}`;
  td.append(input, made("em", "", { "data-fault": place }));
  return td;
}

function labelled(field, place, of = "") {
  const label = made("label");
  const words = made("span", field.words);
  if (field.unit) words.append(made("small", ` [${field.unit}]`));
  const input = control(field, place);
  if (of) input.ariaLabel = `${heading(field)}, axis ${of}`;
  label.append(words, input, made("em", "", { "data-fault": place }));
  return label;
}

function control(field, place) {
  const [table, key] = at(place);
  let input;
  if (field.kind === "choice") {
    input = made("select");
    input.append(...field.choices.map((c) => made("option", c)));
    input.value = table[key];
  } else if (field.kind === "yes") {
    input = made("input", "", { type: "checkbox", checked: table[key] });
  } else {
    const number = field.kind !== "text";
    input = made("input", "", { type: "text", value: table[key] ?? "", spellcheck: false,
      autocomplete: "off", inputMode: number ? "decimal" : "text" });
    if (number && field.low !== null) input.title = `${field.low} … ${field.high}`;
  }
  input.dataset.place = place;
  input.addEventListener("input", () => {
    const [now, k] = at(place), typed = input.value.trim();
    const isNumber = ["number", "whole"].includes(field.kind) && typed && !isNaN(typed);
    now[k] = field.kind === "yes" ? input.checked : isNumber ? Number(typed) : typed;
    clearTimeout(timer);
    timer = setTimeout(check, CHECK);
  });
  return input;
}

async function check() {
  const turn = ++asked;
  try {
    const { faults } = await post("/config/check", values);
    if (turn !== asked) return; // a later one is on its way
    const why = new Map(faults.map((f) => [f.place, f.why]));
    for (const node of document.querySelectorAll("[data-fault]")) {
      node.textContent = why.get(node.dataset.fault) || "";
      node.previousSibling.ariaInvalid = String(why.has(node.dataset.fault));
      why.delete(node.dataset.fault);
    }
    const rest = [...why].map(([place, words]) => `${place}: ${words}`).join("; ");
    const count = faults.length === 1 ? "1 value is wrong" : `${faults.length} values are wrong`;
    verdict(faults.length ? rest || count : "All values are good", !faults.length);
    usable(!faults.length);
  } catch (error) {
    verdict(error.message, false);
  }
}

function usable(good) {
  right = good;
  for (const id of ["config-save", "config-headers", "config-toml"]) part(id).disabled = !good;
  formCard(card);
}

function verdict(words, good) {
  part("verdict").textContent = words;
  part("verdict").className = `verdict ${good ? "good" : "bad"}`;
}

async function act(done) {
  try {
    await done();
  } catch (error) {
    verdict(error.message, false);
  }
}

part("form").addEventListener("submit", (event) => event.preventDefault());
part("config-save").addEventListener("click", () => act(async () => {
  let said = await post("/config/save", values);
  if (said.loses) {
    if (!confirm(`The comments of ${said.file} will be lost.`)) return verdict("Not saved", false);
    said = await post("/config/save?lose", values);
  }
  verdict(said.file ? `Saved in ${said.file}` : "In use from now on", true);
}));
part("config-send").addEventListener("click", () => act(async () => {
  const id = card;
  verdict(`Card ${id} …`, true);
  const said = await post(`/config/send/${id}`, values);
  const none = said.ok && !said.lines.length ? ", it has these values" : "";
  verdict([`Card ${id}: ${said.text}${none}`, ...said.lines].join("\n"), said.ok);
}));
part("config-toml").addEventListener("click", () => act(async () => {
  const { text } = await post("/config/text", values);
  download("card.toml", new Blob([text], { type: "text/plain" }));
}));
part("config-headers").addEventListener("click", () => act(async () => {
  download("headers.zip", await post("/config/headers", values, true));
}));
part("config-open").addEventListener("change", (event) => act(async () => {
  const [chosen] = event.target.files;
  event.target.value = "";
  if (chosen) take((await post("/config/read", { name: chosen.name, text: await chosen.text() })).values);
}));
