// The page of a live machine: its views, and when they are drawn.
import { mark, part } from "./dom.js";
import { headOf, showHead, told } from "./header.js";
import { jogOf, letGo, showJog } from "./jog.js";
import { journalOf, showJournal } from "./journal.js";
import { connect, on } from "./link.js";
import { frame } from "./machine.js";
import { mdiOf, showMdi } from "./mdi.js";
import { keysOf, showKeys } from "./panel_keys.js";
import { pathOf, showPath } from "./path.js";
import { programOf, showProgram } from "./program.js";
import { readoutOf, showReadout } from "./readout.js";
import { scopeOf, showScope, stream } from "./scope.js";
import { showRecord } from "./record.js";
import { showTools, toolsOf } from "./tools.js";
import "./trigger.js";
import { showValues, valuesOf } from "./values.js";

const VIEWS = ["operate", "scope", "values", "journal"];
let view = "operate", fresh = false;

on("about", () => {
  for (const make of [headOf, readoutOf, keysOf, jogOf, mdiOf, toolsOf, programOf, pathOf, valuesOf, journalOf, scopeOf]) make();
  part("bare").hidden = [...document.querySelectorAll("#view-operate section")].some((s) => !s.hidden);
});
on("frame", () => { fresh = true; });
on("link", (words, good) => { if (!good) letGo(); });
addEventListener("told", ({ detail }) => told(detail));

// One picture: what is in view, if there is something new; the oscilloscope always.
function draw(now) {
  requestAnimationFrame(draw);
  if (!frame) return;
  const operate = view === "operate";
  if (fresh) {
    showHead();
    if (operate) for (const show of [showReadout, showKeys, showMdi, showTools, showProgram]) show();
    if (view === "journal") showJournal();
    if (view === "scope") showRecord();
    fresh = false;
  }
  showJog();
  if (operate) showPath();
  if (view === "values") showValues(now);
  if (view === "scope") showScope(now);
  stream(view === "scope");
}

function go(to, focus = false) {
  view = to;
  letGo();
  for (const name of VIEWS) {
    part(`view-${name}`).hidden = name !== to;
    mark(part(`tab-${name}`), "aria-selected", name === to);
    part(`tab-${name}`).tabIndex = name === to ? 0 : -1;
  }
  if (focus) part(`tab-${to}`).focus();
  fresh = true;
}
VIEWS.forEach((name, k) => {
  part(`tab-${name}`).addEventListener("click", () => go(name));
  part(`tab-${name}`).addEventListener("keydown", (event) => {
    const way = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    event.stopPropagation();
    go(VIEWS[(k + way + VIEWS.length) % VIEWS.length], true);
  });
});

const root = document.documentElement, system = matchMedia("(prefers-color-scheme: dark)");
const saved = localStorage.getItem("theme");
if (saved) root.dataset.theme = saved;
part("theme").addEventListener("click", () => {
  const dark = root.dataset.theme ? root.dataset.theme === "dark" : system.matches;
  root.dataset.theme = dark ? "light" : "dark";
  localStorage.setItem("theme", root.dataset.theme);
  dispatchEvent(new Event("theme"));
});
system.addEventListener("change", () => dispatchEvent(new Event("theme")));

connect();
requestAnimationFrame(draw);
