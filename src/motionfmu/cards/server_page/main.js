// The page: cards by id, the one that is shown, commands, views.
import { live, made, part, post } from "./link.js";
import { formCard, showForm } from "./form.js";
import { showJob } from "./job.js";
import { showCard, showList } from "./panel.js";

const cards = new Map();
const EVENTS = 300;
let events = [], shown = Number(sessionStorage.getItem("card")) || null;

live((message) => {
  for (const card of message.cards) cards.set(card.id, card);
  for (const id of message.gone) cards.delete(id);
  if (!cards.has(shown)) shown = cards.size ? Math.min(...cards.keys()) : null;
  show();
  if (message.events.length) {
    events = [...events, ...message.events].slice(-EVENTS);
    showEvents();
  }
}, (words, good) => {
  part("link").textContent = words;
  part("link").dataset.good = good;
  document.body.classList.toggle("away", !good);
  if (good) events = []; // they all come again
});

function show() {
  const list = [...cards.values()].sort((a, b) => a.id - b.id);
  showList(list, shown, select);
  const card = cards.get(shown);
  formCard(card ? shown : null);
  part("none").hidden = list.length > 0;
  part("panel").hidden = !card;
  if (!card) return;
  showCard(card);
  showJob(card);
}

function select(id) {
  if (id === shown) return;
  shown = id;
  sessionStorage.setItem("card", id);
  tell("", "");
  show();
  showEvents();
}

function showEvents() {
  const only = part("only").checked;
  const rows = events.filter((e) => !only || e.card === shown).slice(-100).reverse();
  part("events").replaceChildren(...rows.map((e) => {
    const row = made("li", "", { className: e.kind });
    row.append(made("time", new Date(1000 * e.time).toLocaleTimeString("en-GB")),
      made("b", e.card), made("span", e.text));
    return row;
  }));
}

function tell(words, kind) {
  part("told").textContent = words;
  part("told").className = `told ${kind}`;
}

// A command to the card that is shown; what it answers is told.
async function command(name) {
  const id = shown;
  if (id === null) return;
  const words = `${name[0].toUpperCase()}${name.slice(1)}`;
  tell(`${words} …`, "");
  try {
    const result = await post(`/cards/${id}/command`, { name });
    const state = result.state ? ` (${result.state})` : "";
    const end = result.ok ? ": done" : ` refused: ${result.text}`;
    const advice = result.advice ? `. ${result.advice}` : "";
    if (id === shown) tell(`${words}${end}${state}${advice}`, result.ok ? "good" : "bad");
  } catch (error) {
    if (id === shown) tell(`${words}: ${error.message}`, "bad");
  }
}

for (const name of ["start", "pause", "stop", "home", "reset"]) {
  part(name).addEventListener("click", () => command(name));
}

// Space pauses wherever the focus is but in the form; a button is pressed by Enter.
const typed = (target) => target.closest?.("#form");
for (const kind of ["keydown", "keyup"]) {
  addEventListener(kind, (event) => {
    if (event.code !== "Space" || typed(event.target)) return;
    event.preventDefault();
    if (kind === "keydown" && !event.repeat) command("pause");
  }, true);
}

addEventListener("job", show);
part("only").addEventListener("change", showEvents);

const views = ["cards", "config"];
for (const view of views) {
  part(`tab-${view}`).addEventListener("click", () => {
    for (const v of views) {
      part(`view-${v}`).hidden = v !== view;
      part(`tab-${v}`).setAttribute("aria-selected", v === view);
    }
    if (view === "config") showForm();
    else show();
  });
}

const root = document.documentElement;
const saved = localStorage.getItem("theme");
if (saved) root.dataset.theme = saved;
part("theme").addEventListener("click", () => {
  const dark = root.dataset.theme ? root.dataset.theme === "dark"
    : matchMedia("(prefers-color-scheme: dark)").matches;
  root.dataset.theme = dark ? "light" : "dark";
  localStorage.setItem("theme", root.dataset.theme);
  dispatchEvent(new Event("resize")); // pictures take the new colours
});
