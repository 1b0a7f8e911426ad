// Lines that are typed: sent to the controller, with their history and what became of them.
import { made, part, put } from "./dom.js";
import { act } from "./link.js";
import { panels, value, variable, watch } from "./machine.js";
import { capital, meaning } from "./words.js";

const KEPT = 200, STORE = "mdi";
let boxes = [];

const remembered = () => { try { return JSON.parse(localStorage.getItem(STORE)) ?? []; } catch { return []; } };

// Lines typed before, the latest last; up and down go through them, what is half typed stays.
export function historyOf(lines) {
  let at = lines.length, typed = "";
  return {
    lines,
    add(line) {
      if (lines.at(-1) !== line) lines.push(line);
      lines.splice(0, lines.length - KEPT);
      at = lines.length;
    },
    go(way, text) {
      if (at === lines.length) typed = text;
      at = Math.max(0, Math.min(at + way, lines.length));
      return at === lines.length ? typed : lines[at];
    },
  };
}

export function mdiOf() {
  boxes = panels().filter((p) => p.mdi).map((panel) => {
    const names = Object.fromEntries(Object.entries(panel.mdi).map(([key, name]) => [key, panel.full(name)]));
    return { panel, names, sent: [], ...formOf(panel, names) };
  });
  part("mdi").closest("section").hidden = !boxes.length;
  part("mdi").replaceChildren(...boxes.map((b) => b.form));
  watch("mdi", boxes.flatMap((b) => [b.names.taken, b.names.done, b.names.fault, b.names.refused].filter(Boolean)));
}

function formOf(panel, names) {
  const history = historyOf(remembered());
  const field = made("input", "", { type: "text", spellcheck: false, autocomplete: "off", autocapitalize: "characters",
    "aria-label": "Line to run", placeholder: "G0 X10", maxLength: 255 });
  const list = made("ol", "", { className: "typed", "aria-label": "Lines typed" });
  const form = made("form", "", { className: "mdi-form" }, field,
    made("button", "Run", { type: "submit", className: "primary" }), list,
    made("p", "", { className: "hint", role: "status" }));
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const line = field.value.trim();
    if (!line) return;
    const number = await act("mdi", { component: panel.component, line });
    if (number === undefined) return;
    history.add(line);
    try { localStorage.setItem(STORE, JSON.stringify(history.lines)); } catch { /* no store */ }
    field.value = "";
    const item = made("li", "", {}, made("code", line), made("span", "sent"));
    list.prepend(item);
    while (list.children.length > 30) list.lastChild.remove();
    boxes.find((b) => b.form === form)?.sent.push({ number: number?.number ?? number, item });
  });
  field.addEventListener("keydown", (event) => {
    const way = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!way) return;
    event.preventDefault();
    field.value = history.go(way, field.value);
  });
  return { form, field, list };
}

export function showMdi() {
  for (const { form, names, sent } of boxes) {
    const taken = value(names.taken);
    for (const one of sent) {
      const state = one.number <= taken ? "taken" : "sent";
      put(one.item.lastChild, state);
      one.item.className = state;
    }
    const fault = names.fault && value(names.fault);
    const why = fault ? `${capital(meaning(variable(names.fault), fault))}` : "";
    const where = fault && names.refused ? ` (line ${value(names.refused)} that was read)` : "";
    put(form.querySelector("[role=status]"), why ? `Refused: ${why}${where}. Nothing moved.` : "");
    form.classList.toggle("refused", Boolean(fault));
  }
}
