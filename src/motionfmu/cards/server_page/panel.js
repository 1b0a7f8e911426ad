// The list of cards, and the panel of the one that is shown.
import { made, part } from "./link.js";
import { scaleOf } from "./job.js";

const AXES = "XYZU", TASKS = ["parser", "storage", "home", "stop", "pause", "run", "interrupts"];
const SWITCHES = ["limit +", "limit −", "origin", "alarm", "homed"]; // four bits each, X first
const STOP_BIT = 20; // emergency stop
export const bit = (word, k) => (word >>> k) & 1;

export function nameOf(card) {
  return !card.connected ? "OFFLINE" : card.state || "UNKNOWN";
}

// Nodes by their keys: a node that is there is changed, not made anew, so that it keeps the focus.
function rows(parent, keys, make) {
  const known = new Map([...parent.children].map((node) => [node.dataset.key, node]));
  const wanted = keys.map((key) => known.get(String(key)) || make(key));
  keys.forEach((key, k) => { wanted[k].dataset.key = key; });
  if (wanted.length !== parent.children.length
    || wanted.some((node, k) => node !== parent.children[k])) parent.replaceChildren(...wanted);
  return wanted;
}

function set(node, words) {
  if (node.textContent !== String(words)) node.textContent = words;
}

export function showList(cards, shown, select) {
  const nodes = rows(part("cards"), cards.map((c) => c.id), (id) => {
    const item = made("li"), button = made("button", "", { type: "button" });
    button.append(made("i"), made("b"), made("span"), made("progress"));
    button.addEventListener("click", () => select(id));
    item.append(button);
    return item;
  });
  cards.forEach((card, k) => {
    const button = nodes[k].firstChild, [lamp, name, state, bar] = button.children;
    button.setAttribute("aria-current", card.id === shown);
    lamp.dataset.state = nameOf(card);
    set(name, `Card ${card.id}`);
    set(state, card.upload ? "receives a job" : nameOf(card).toLowerCase());
    bar.hidden = !card.upload;
    if (card.upload) [bar.max, bar.value] = [card.upload.pages, card.upload.taken];
  });
}

export function showCard(card) {
  const s = card.status, state = nameOf(card);
  part("panel").dataset.state = state;
  set(part("who"), `Card ${card.id}`);
  set(part("where"), card.address || "not connected");
  set(part("state"), state);
  part("reset").hidden = state !== "FAULT";
  const scale = scaleOf(card); // an axis that a job does not know is not there
  const axes = [...AXES].slice(0, card.axes || 4).filter((_, k) => !scale || scale[k]);
  rows(part("position"), axes, (axis) => {
    const item = made("li");
    item.append(made("span", axis), made("b"), made("small"));
    return item;
  }).forEach((item, k) => {
    const per = scale?.[k];
    set(item.children[1], !s ? "–" : per ? (s.position[k] / per).toFixed(3) : s.position[k]);
    set(item.children[2], per ? "mm" : "pulses");
  });
  showRun(card, s);
  if (!s) return;
  showSwitches(s.switches, axes);
  showPins(s);
  const tasks = rows(part("load"), TASKS, (name) => {
    const row = made("div"), bar = made("dd");
    bar.append(made("meter", "", { max: 1000, ariaLabel: name }));
    row.append(made("dt", name), bar, made("dd"));
    return row;
  });
  tasks.forEach((row, k) => {
    row.children[1].firstChild.value = s.load[k];
    set(row.children[2], `${(s.load[k] / 10).toFixed(1)} %`);
  });
}

function showRun(card, s) {
  const facts = s ? {
    "frame": s.frame.toLocaleString("en"), "buffer": `${s.stock} frames`,
    "rate": `${(s.rate / 10).toFixed(1)} %`, "underflows": s.underflows, "error": s.error,
    "flash wear": `${s.wear} erase${s.wear === 1 ? "" : "s"}`, "firmware": card.firmware,
  } : { "status": "none heard yet" };
  rows(part("run"), Object.keys(facts), (name) => {
    const row = made("div");
    row.append(made("dt", name), made("dd"));
    return row;
  }).forEach((row, k) => {
    set(row.children[1], Object.values(facts)[k]);
    row.classList.toggle("bad", ["underflows", "error"].includes(row.dataset.key)
      && s && s[row.dataset.key] > 0);
  });
}

function showSwitches(word, axes) {
  const nodes = rows(part("switches"), ["", ...SWITCHES, "E-stop"], (name) => {
    const row = made("tr");
    row.append(name ? made("th", name, { scope: "row" }) : made("td"));
    for (const axis of name === "E-stop" ? [""] : axes) {
      row.append(name ? made("td") : made("th", axis, { scope: "col" }));
      if (name) row.lastChild.append(made("i", "", { role: "img" }));
    }
    return row;
  });
  const lamp = (cell, on, name) => {
    cell.firstChild.className = on ? (/limit|alarm|E-stop/.test(name) ? "on bad" : "on") : "";
    cell.firstChild.ariaLabel = on ? "on" : "off";
  };
  SWITCHES.forEach((name, k) => axes.forEach(
    (_, a) => lamp(nodes[k + 1].children[a + 1], bit(word, 4 * k + a), name)));
  lamp(nodes.at(-1).children[1], bit(word, STOP_BIT), "E-stop");
}

function showPins(s) {
  const groups = rows(part("pins"), ["inputs", "outputs"], (name) => {
    const row = made("div", "", { ariaLabel: name, role: "group" });
    row.append(made("span", name === "inputs" ? "in" : "out"));
    for (let k = 0; k < 16; k++) row.append(made("i", k, { role: "img" }));
    return row;
  });
  groups.forEach((row) => {
    for (let k = 0; k < 16; k++) {
      const on = bit(s[row.dataset.key], k);
      row.children[k + 1].className = on ? "on" : "";
      row.children[k + 1].ariaLabel = `${k} ${on ? "on" : "off"}`;
    }
  });
}
