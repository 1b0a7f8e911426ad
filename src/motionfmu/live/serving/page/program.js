// The program with the line in force; of 200,000 lines only those in view are elements.
import { made, part, put, rows } from "./dom.js";
import { about, panels, value, watch } from "./machine.js";

const HEIGHT = 22, MARGIN = 8; // [px] of a line; lines beyond what is in view
// A browser cuts off an element that is higher than this [px]: longer programs are scrolled in proportion.
const TALLEST = 8e6;
let lines = [], current = "", latest = -1;

export function programOf() {
  lines = about.program?.lines ?? [];
  part("program").closest("section").hidden = !lines.length;
  const panel = panels().find((p) => p.line);
  current = panel ? panel.full(panel.line) : "";
  watch("program", [current]);
  put(part("h-program"), about.program ? `Program ${about.program.file}` : "Program");
  part("program-all").style.height = `${Math.min(HEIGHT * lines.length, TALLEST)}px`;
  latest = -1;
  draw();
}

// First line in view at a place of the scroll bar, and the way back.
export function firstLine(scroll, count, height, tallest = TALLEST) {
  const whole = HEIGHT * count, room = Math.max(Math.min(whole, tallest) - height, 1);
  return Math.max(0, Math.min(scroll / room, 1)) * Math.max(whole - height, 0) / HEIGHT;
}

export function scrollOf(line, count, height, tallest = TALLEST) {
  const whole = HEIGHT * count, room = Math.max(Math.min(whole, tallest) - height, 0);
  return Math.max(0, Math.min(HEIGHT * line / Math.max(whole - height, 1), 1)) * room;
}

function draw() {
  const box = part("program"), height = box.clientHeight;
  if (!height) return;
  const first = firstLine(box.scrollTop, lines.length, height);
  const from = Math.max(0, Math.floor(first) - MARGIN);
  const to = Math.min(lines.length, Math.ceil(first + height / HEIGHT) + MARGIN);
  const list = part("program-lines"), now = value(current) ?? 0;
  list.style.transform = `translateY(${box.scrollTop - (first - from) * HEIGHT}px)`;
  list.start = from + 1;
  rows(list, Array.from({ length: to - from }, (_, k) => from + k + 1), () => made("li", "", {},
    made("span"), made("code"))).forEach((item) => {
    const number = Number(item.dataset.key);
    put(item.firstChild, number);
    put(item.lastChild, lines[number - 1] || " ");
    if (number === now) item.setAttribute("aria-current", "step"); else item.removeAttribute("aria-current");
  });
}

export function showProgram() {
  if (!lines.length) return;
  const now = value(current) ?? 0;
  const box = part("program"), height = box.clientHeight;
  if (now !== latest && part("follow").checked && now > 0) {
    box.scrollTop = scrollOf(now - 1 - height / HEIGHT / 2, lines.length, height);
  }
  if (now !== latest) {
    latest = now;
    put(part("program-line"), now > 0 ? `line ${now} of ${lines.length}` : `${lines.length} lines`);
    draw();
  }
}

part("program").addEventListener("scroll", draw);
new ResizeObserver(draw).observe(part("program"));
for (const kind of ["wheel", "pointerdown"]) {
  part("program").addEventListener(kind, () => { part("follow").checked = false; }, { passive: true });
}
