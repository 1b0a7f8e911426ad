// A robot's program beside its points and its arm: judged while it is written, saved whole.
/* global isDark, machineView, page */
import { pointsIn, pointsOf, stepAt, withWord } from "./point_table.js";

const part = (id) => document.getElementById(id);
const [text, pointsText, gutter, marks] = ["text", "points-text", "gutter", "marks"].map(part);
const token = new URLSearchParams(location.search).get("token") ?? sessionStorage.getItem("token") ?? "";
sessionStorage.setItem("token", token);
history.replaceState(null, "", location.pathname);

const PAUSE = 500; // [ms] without a key, after which it is judged
const COLUMNS = ["X", "Y", "Z", "A", "B", "C"];
const JOINTS = ["J1", "J2", "J3", "J4", "J5", "J6"];
let saved = { job: "", points: "" }, judged = { faults: [], steps: [] }, step = -1, timer = 0, hasPoints = false;

async function ask(path, body = {}) {
  const answer = await fetch(path, { method: "POST", headers: { authorization: `Bearer ${token}` }, body: JSON.stringify(body) });
  const kind = answer.headers.get("content-type") ?? "";
  const found = kind.includes("json") ? await answer.json() : { error: await answer.text() };
  return { ok: answer.ok, status: answer.status, found };
}

const texts = () => ({ job: text.value, points: pointsText.value });
const changed = () => text.value !== saved.job || pointsText.value !== saved.points;
const say = (words) => { part("told").textContent = words; };
const lines = () => text.value.split("\n");
const rowHeight = () => parseFloat(getComputedStyle(document.documentElement).getPropertyValue("--row"));

// The line that is shown: of the step, else none.
const shownLine = () => judged.steps[step]?.line ?? 0;

function drawLines() {
  const count = lines().length, faults = new Set(judged.faults.map((f) => f.line)), moves = new Set(judged.steps.map((s) => s.line));
  while (gutter.children.length > count) gutter.lastChild.remove();
  while (gutter.children.length < count) {
    const button = document.createElement("button"), line = gutter.children.length + 1;
    button.type = "button";
    button.tabIndex = -1;
    button.textContent = line;
    button.addEventListener("click", () => goTo(line));
    gutter.append(button);
  }
  [...gutter.children].forEach((button, k) => {
    const line = k + 1;
    button.className = faults.has(line) ? "fault" : line === shownLine() ? "now" : moves.has(line) ? "step" : "";
  });
  const rows = [...faults].filter((line) => line).map((line) => ["fault", line]);
  if (shownLine()) rows.push(["now", shownLine()]);
  marks.replaceChildren(...rows.map(([kind, line]) => {
    const row = document.createElement("i");
    row.className = kind;
    row.style.top = `${6 + (line - 1) * rowHeight() - text.scrollTop}px`;
    return row;
  }));
  gutter.scrollTop = text.scrollTop;
}

// Choose a line: the arm goes to its end.
function goTo(line) {
  step = stepAt(judged.steps, line);
  showStep();
}

function reveal(line) {
  const top = (line - 1) * rowHeight();
  if (top < text.scrollTop || top + 2 * rowHeight() > text.scrollTop + text.clientHeight) text.scrollTop = top - text.clientHeight / 2;
}

function showStep() {
  const now = judged.steps[step], view = part("view")?.machineView;
  part("back").disabled = step <= 0;
  part("on").disabled = step >= judged.steps.length - 1;
  part("where").textContent = now ? `${step + 1} of ${judged.steps.length}: line ${now.line}, ${lines()[now.line - 1]?.trim() ?? ""}` : "";
  part("pose").textContent = now ? `at ${now.end.toFixed(3)} s: tool ${now.place.map((x) => x.toFixed(1)).join(", ")} mm; joints ${now.joint.map((q) => q.toFixed(1)).join(", ")}°` : "";
  if (now) reveal(now.line);
  if (now && view) { view.play(false); view.go(now.end); }
  drawLines();
  const used = new Set(pointsIn(lines()[shownLine() - 1] ?? ""));
  const wrong = new Set(judged.faults.map((f) => String((f.points_line ?? 0) - 1)));
  for (const row of part("points").children) {
    row.className = wrong.has(row.dataset.place) ? "fault" : used.has(row.dataset.name) ? "now" : "";
  }
}

function drawFaults() {
  const { faults, steps, time = 0 } = judged;
  part("faults").replaceChildren(...faults.map(({ line, text: words }) => {
    const item = document.createElement("li"), button = document.createElement("button");
    button.type = "button";
    button.textContent = words;
    button.addEventListener("click", () => { if (line) { reveal(line); goTo(line); caretTo(line); } });
    item.append(button);
    return item;
  }));
  part("verdict").className = `pill ${faults.length ? "fail" : "pass"}`;
  part("verdict").textContent = faults.length ? `\u2717 ${faults.length} fault${faults.length > 1 ? "s" : ""}` : `\u2713 ${time.toFixed(1)} s, ${steps.length} moves`;
}

function caretTo(line) {
  const place = lines().slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
  text.focus();
  text.setSelectionRange(place, place);
}

// The picture anew, seen from where the old one was.
function drawView() {
  const before = part("view")?.machineView?.view;
  const look = part("view")?.querySelector('[data-view="look"]').value;
  part("stage").replaceChildren();
  if (!judged.view) {
    part("stage").textContent = judged.faults.length ? "The arm is shown when the program runs dry: mend what is red first." : "Nothing moves yet.";
    return;
  }
  page.dark = judged.dark;
  part("stage").append(part("view-template").content.cloneNode(true));
  part("fastest").textContent = judged.view.fastest.toPrecision(3);
  machineView(judged.view);
  if (before) {
    Object.assign(part("view").machineView.view, before);
    part("view").querySelector('[data-view="look"]').value = look;
  }
}

async function judge() {
  const given = texts();
  part("verdict").className = "pill";
  part("verdict").textContent = "\u2026";
  const { ok, status, found } = await ask("/judge", given);
  if (status === 409) return;
  if (!ok) { say(found.error); return; }
  say("");
  const line = shownLine();
  judged = found;
  step = line ? stepAt(judged.steps, line) : judged.steps.length - 1;
  drawFaults();
  drawView();
  showStep();
}

function later() {
  drawLines();
  showSave("Save");
  clearTimeout(timer);
  timer = setTimeout(judge, PAUSE);
}

function drawPoints() {
  part("points").replaceChildren(...pointsOf(pointsText.value).map(({ place, name, words }) => {
    const row = document.createElement("tr"), head = document.createElement("td"), rest = document.createElement("td");
    row.dataset.name = head.textContent = name;
    row.dataset.place = place;
    const columns = JOINTS[0] in words ? JOINTS : COLUMNS;
    row.append(head, ...columns.map((column) => cell(place, column, words[column])));
    rest.textContent = Object.entries(words).filter(([w]) => !columns.includes(w)).map((pair) => pair.join("=")).join(" ");
    row.append(rest);
    return row;
  }));
}

function cell(place, column, value) {
  const field = document.createElement("td");
  if (value === undefined) return field;
  const input = document.createElement("input");
  input.value = value;
  input.inputMode = "decimal";
  input.required = true;
  input.pattern = "[+\\-]?(\\d+\\.?\\d*|\\.\\d+)";
  input.setAttribute("aria-label", `${column} of ${part("points-text").value.split("\n")[place].trim().split(/\s/)[0]}`);
  input.addEventListener("input", () => {
    if (!input.validity.valid) return;
    pointsText.value = withWord(pointsText.value, place, column, input.value);
    later();
  });
  if (JOINTS.includes(column)) field.append(column, " ");
  field.append(input);
  return field;
}

function showSave(words) {
  part("save").disabled = !changed();
  part("save").textContent = changed() ? "Save" : words;
}

async function save(over = false) {
  const given = texts();
  part("save").disabled = true;
  const { ok, found } = await ask("/save", { ...given, over });
  if (!ok) {
    part("save").disabled = false;
    say(found.error);
    if (/somebody else/.test(found.error ?? "") && confirm(`${found.error}. Save over it?`)) await save(true);
    return;
  }
  saved = given;
  say("");
  showSave("Saved");
}

text.addEventListener("input", later);
text.addEventListener("scroll", drawLines);
text.addEventListener("click", () => goTo(text.value.slice(0, text.selectionStart).split("\n").length));
pointsText.addEventListener("input", () => { drawPoints(); later(); });
part("save").addEventListener("click", () => save());
part("back").addEventListener("click", () => { step = Math.max(0, step - 1); showStep(); });
part("on").addEventListener("click", () => { step = Math.min(judged.steps.length - 1, step + 1); showStep(); });
addEventListener("keydown", (event) => {
  if ((event.ctrlKey || event.metaKey) && event.key === "s") { event.preventDefault(); if (changed()) save(); }
  if (event.altKey && (event.key === "ArrowUp" || event.key === "ArrowDown")) {
    event.preventDefault();
    part(event.key === "ArrowDown" ? "on" : "back").click();
  }
});
addEventListener("beforeunload", (event) => { if (changed()) event.preventDefault(); });
part("theme").addEventListener("click", () => {
  document.documentElement.dataset.theme = isDark() ? "light" : "dark";
  dispatchEvent(new Event("theme"));
});

const { ok, found } = await ask("/open");
if (ok) {
  saved = { job: found.job, points: found.points };
  [text.value, pointsText.value] = [found.job, found.points];
  document.title = part("name").textContent = found.file;
  hasPoints = Boolean(found.points_file);
  part("points-file").textContent = found.points_file ?? `none: a file ${found.file.replace(/\.[^.]*$/, "")}.points beside the program would have them, with its tools`;
  part("table").classList.toggle("none", !hasPoints);
  drawPoints();
  await judge();
} else {
  say(found.error);
}
