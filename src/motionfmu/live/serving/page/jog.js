// Motion by hand: a key that is held moves an axis; what holds it must say so again and again.
import { choice, made, mark, part, put, toggle } from "./dom.js";
import { act, ask } from "./link.js";
import { panels, value, variable, watch } from "./machine.js";
import { axesOf } from "./readout.js";
import { fixed } from "./words.js";

const AGAIN = 40; // [ms] between two signs of who holds a key
const WAYS = [0, 0.001, 0.01, 0.1, 1, 10]; // in the unit of the variable; 0: for so long as the key is down
// Keys of the keyboard: axis from 1, direction.
export const KEYS = { ArrowRight: [1, 1], ArrowLeft: [1, -1], ArrowUp: [2, 1], ArrowDown: [2, -1],
  PageUp: [3, 1], PageDown: [3, -1] };
const refused = new Set(); // "component.axis": a stick of these must come back to its middle first
const held = new Map(); // "component.axis": what is held, with its timer and button
let pads = [], keysOn = false, padded = false;

export function jogOf() {
  letGo();
  pads = panels().filter((p) => p.jog && variable(p.full(p.jog.direction))?.set).map(padOf);
  part("jog").closest("section").hidden = !pads.length;
  part("jog").replaceChildren(...pads.map((p) => p.box));
  watch("jog", pads.flatMap((p) => [p.speed, p.way, p.frame].filter(Boolean)));
}

function padOf(panel) {
  const { jog, component } = panel, full = (name) => name && variable(panel.full(name))?.set && panel.full(name);
  const direction = panel.full(jog.direction);
  const axes = axesOf(panel.readout.machine ? panel.full(panel.readout.machine) : direction)
    .filter((a) => a.row <= (variable(direction).shape[0] ?? 1));
  const pad = { component, axes, direction, speed: full(jog.speed), way: full(jog.way), frame: full(jog.frame), buttons: new Map() };
  const grid = made("div", "", { className: "jog-pad", tabIndex: 0, role: "group",
    "aria-label": "Jog: arrow keys, Page Up and Down while this is in focus" });
  axes.forEach((axis, k) => grid.append(...rowOf(pad, axis, k)));
  const bar = made("div", "", { className: "jog-bar" });
  if (pad.frame) bar.append(frameOf(pad));
  if (pad.way) bar.append(wayOf(pad));
  if (pad.speed) bar.append(speedOf(pad));
  const keys = made("button", "Keys jog", { type: "button", title: "Arrow keys and Page Up, Page Down jog wherever the focus is" });
  toggle(keys, (on) => { keysOn = on; if (!on) letGo(); });
  bar.append(keys, made("span", "", { className: "hint gamepad" }));
  grid.addEventListener("keydown", (event) => { if (event.target === grid) key(event, true); });
  grid.addEventListener("blur", letGo);
  pad.box = made("div", "", {}, grid, bar);
  return pad;
}

// X and Y as a cross, Z beside it, all others in rows.
function rowOf(pad, axis, k) {
  const cross = pad.axes.length > 1 && pad.axes[0].name === "X" && pad.axes[1].name === "Y";
  return [-1, 1].map((way) => {
    const sign = way < 0 ? "\u2212" : "+";
    const button = made("button", `${axis.name}${sign}`, { type: "button", "aria-label": `Jog ${axis.name} ${way < 0 ? "minus" : "plus"}` });
    if (cross && k < 3) button.style.gridArea = [["w", "e"], ["s", "n"], ["d", "u"]][k][(way + 1) / 2];
    else if (way < 0) button.classList.add("first");
    const hold = () => press(pad, axis.row, way);
    button.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      button.setPointerCapture(event.pointerId);
      hold();
    });
    for (const gone of ["pointerup", "pointercancel", "lostpointercapture"]) button.addEventListener(gone, () => release(pad, axis.row));
    button.addEventListener("contextmenu", (event) => event.preventDefault());
    button.addEventListener("keydown", (event) => {
      if (![" ", "Enter"].includes(event.key)) { key(event, true); return; }
      event.preventDefault();
      if (!event.repeat) hold();
    });
    button.addEventListener("keyup", (event) => { if ([" ", "Enter"].includes(event.key)) release(pad, axis.row); });
    button.addEventListener("blur", () => release(pad, axis.row));
    pad.buttons.set(`${axis.row}${way}`, button);
    return button;
  });
}

// In the frame of a base or a tool the directions are X Y Z and turns about them.
const TURNS = ["X", "Y", "Z", "A", "B", "C"];
function frameOf(pad) {
  const { words } = variable(pad.frame), select = made("select");
  choice(select, Object.entries(words), 0);
  select.addEventListener("change", () => act("set", { name: pad.frame, value: Number(select.value) }));
  pad.showFrame = () => {
    const now = value(pad.frame) ?? 0;
    if (document.activeElement !== select) select.value = now;
    for (const axis of pad.axes) {
      const name = /joint/.test(words[now]) ? axis.name : TURNS[axis.row - 1];
      for (const way of [-1, 1]) {
        const button = pad.buttons.get(`${axis.row}${way}`);
        put(button, `${name}${way < 0 ? "\u2212" : "+"}`);
        mark(button, "aria-label", `Jog ${name} ${way < 0 ? "minus" : "plus"}`);
      }
    }
  };
  return made("label", "Frame ", {}, select);
}

function wayOf(pad) {
  const select = made("select");
  const unit = variable(pad.way).unit ?? "";
  choice(select, WAYS.map((w) => [w, w ? `${w} ${unit}` : "continuous"]), 0);
  select.addEventListener("change", () => act("set", { name: pad.way, value: Number(select.value) }));
  pad.showWay = () => { if (document.activeElement !== select && value(pad.way) !== undefined) select.value = value(pad.way); };
  return made("label", "Step ", {}, select);
}

function speedOf(pad) {
  const { low, high, unit, doc } = variable(pad.speed), most = high ?? 1;
  const range = made("input", "", { type: "range", min: Math.max(low ?? 0, most / 100), max: most, step: most / 100, title: doc, "aria-label": "Speed of jog" });
  const told = made("output");
  const say = (x) => (unit ? `${fixed(x, 1)} ${unit}` : `${fixed(100 * x / most, 0)} %`);
  range.addEventListener("input", () => { put(told, say(Number(range.value))); act("set", { name: pad.speed, value: Number(range.value) }); });
  pad.showSpeed = () => {
    const now = value(pad.speed);
    if (now === undefined || range.matches(":active")) return;
    range.value = now;
    put(told, say(now));
  };
  return made("label", "Speed ", { className: "speed" }, range, told);
}

function press(pad, axis, way) {
  const name = `${pad.component}.${axis}`, asked = { component: pad.component, axis, direction: way };
  if (held.get(name)?.way === way) return;
  release(pad, axis);
  const button = pad.buttons.get(`${axis}${Math.sign(way)}`);
  button?.classList.add("down");
  // The first one is told if it is refused, and then no more is asked.
  const one = { way, button, pad, axis, timer: setInterval(() => ask("jog", asked).catch(() => release(pad, axis)), AGAIN) };
  held.set(name, one);
  act("jog", asked).then((ok) => {
    if (ok !== undefined) return;
    refused.add(name);
    if (held.get(name) === one) release(pad, axis);
  });
}

function release(pad, axis) {
  const name = `${pad.component}.${axis}`, one = held.get(name);
  if (!one) return;
  clearInterval(one.timer);
  held.delete(name);
  one.button?.classList.remove("down");
  ask("jog", { component: pad.component, axis, direction: 0 }).catch(() => {});
}

export function letGo() {
  for (const { pad, axis } of [...held.values()]) release(pad, axis);
}

const typing = (node) => node?.closest?.("input:not([type=range],[type=checkbox]), select, textarea, canvas, .lines");

// A key of the keyboard at the first pad.
function key(event, down) {
  const [axis, way] = KEYS[event.key] ?? [], pad = pads[0];
  if (!axis || !pad || event.ctrlKey || event.metaKey || event.altKey) return;
  const own = pad.axes[axis - 1];
  if (!own) return;
  event.preventDefault();
  event.stopPropagation();
  if (down && !event.repeat) press(pad, own.row, way);
  if (!down) release(pad, own.row);
}

addEventListener("keydown", (event) => { if (keysOn && !typing(event.target)) key(event, true); });
addEventListener("keyup", (event) => { if (held.size && KEYS[event.key]) key(event, false); });
addEventListener("blur", letGo);
addEventListener("pagehide", letGo);
document.addEventListener("visibilitychange", () => { if (document.hidden) letGo(); });

// A gamepad: while its left shoulder is down, the sticks jog X, Y and Z.
const DEAD = 0.5, SHOULDER = 4, STICKS = [[0, 1, 1], [1, 2, -1], [3, 3, -1]]; // stick, axis, sign
function gamepad() {
  const pad = pads[0], found = [...(navigator.getGamepads?.() ?? [])].find((g) => g?.connected);
  for (const p of pads) put(p.box.querySelector(".gamepad"), found ? "gamepad: hold the left shoulder, move a stick" : "");
  if (!pad || !found) { if (padded) letGo(); padded = false; return; }
  const on = found.buttons[SHOULDER]?.pressed;
  for (const [stick, axis, sign] of STICKS) {
    const own = pad.axes[axis - 1], at = sign * (found.axes[stick] ?? 0);
    if (!own) continue;
    const name = `${pad.component}.${own.row}`, far = on && Math.abs(at) > DEAD;
    if (!far) refused.delete(name);
    if (far && !refused.has(name)) { press(pad, own.row, Math.sign(at)); padded = true; }
    else if (padded && held.has(name)) release(pad, own.row);
  }
  if (!on) padded = false;
}

export function showJog() {
  for (const pad of pads) { pad.showFrame?.(); pad.showWay?.(); pad.showSpeed?.(); }
  gamepad();
}
