// The job: opened here, drawn with its speeds and the live tool, sent into the card. What changes
// here is told to the page by an event "job".
import { part, post } from "./link.js";
import { draw } from "./picture.js";

const pictures = new Map(); // by the job's hash; null: the server has none
const sendings = new Map(); // by card: what the last upload said
const openings = new Map(); // by card: what was opened for it
const files = new Map(); // by card: its file, of which another page may be wanted
let last = null, card = null, wrong = "", opening = "";
let early = null; // a file that was opened before a card was known

// The picture to be shown: what was opened for the card, else its job, else what was opened last.
const picture = () => openings.get(card?.id) || pictures.get(card?.job) || last;

// Pulses per mm of each axis, as the job in the card has them.
export function scaleOf(one) {
  return (pictures.get(one.job) || last)?.pulses_per_mm;
}

export function showJob(now) {
  if (card?.id !== now.id) wrong = "";
  card = now;
  if (early) {
    const file = early;
    early = null;
    open(file);
  }
  if (card.job && !pictures.has(card.job)) fetchPicture(card.job);
  const shown = picture(), upload = card.upload;
  part("job-name").textContent = shown ? shown.name : "Job";
  const several = openings.get(card.id)?.pages > 1;
  part("pages").hidden = !several;
  if (several) {
    const { page, pages } = openings.get(card.id);
    [part("page").max, part("of").textContent] = [pages, `of ${pages}`];
    if (document.activeElement !== part("page")) part("page").value = page;
  }
  const inCard = shown && shown.job === card.job;
  part("send").disabled = !shown || !!upload || (inCard && card.connected);
  part("sending").hidden = !upload;
  if (upload) {
    [part("progress").max, part("progress").value] = [upload.pages, upload.taken];
    const waits = card.connected ? upload.waits : "the card is not connected";
    part("sent").textContent = `${upload.taken} of ${upload.pages} pages`
      + (waits ? `, waits: ${waits}` : "");
  }
  const sent = upload ? "" : sendings.get(card.id) || "";
  const words = shown ? described(shown) + (inCard && !sent ? " In the card." : "")
    : card.job ? `The card has job ${card.job.slice(0, 8)}; open its file to see it.`
      : "A drawing (PLT) is planned with the configuration; a job file (mcj) is taken as it is.";
  const about = opening ? `${opening} …` : [wrong || words, sent].filter(Boolean).join(" ");
  if (part("job-about").textContent !== about) part("job-about").textContent = about;
  part("job-about").classList.toggle("bad", !!wrong);
  part("scale").hidden = !shown;
  if (shown) part("fastest").textContent = `${shown.fastest.toFixed(0)} mm/s`;
  show();
}

function show() {
  const shown = picture(), s = card?.connected && card.status;
  const per = shown?.pulses_per_mm;
  const tool = s && shown && per[0] && per[1]
    ? [s.position[0] / per[0], s.position[1] / per[1]] : null;
  const runs = ["RUNNING", "PAUSING", "PAUSED", "STOPPING"].includes(card?.state);
  draw(part("picture"), shown, tool, s && runs && shown?.job === card.job ? s.frame : null);
}

const metres = (mm) => `${(mm / 1000).toFixed(2)} m`;

function described(p) {
  const time = p.time < 100 ? `${p.time.toFixed(1)} s`
    : `${Math.floor(p.time / 60)} min ${Math.round(p.time % 60)} s`;
  const [w, h] = [0, 1].map((k) => (p.high[k] - p.low[k]).toFixed(1));
  const more = p.notes.length > 1 ? ` and ${p.notes.length - 1} more` : "";
  const notes = p.notes.length ? ` Note: ${p.notes[0]}${more}.` : "";
  const lines = p.lines === 1 ? "1 line" : `${p.lines} lines`;
  return `${time}, ${w} × ${h} mm, ${lines}, ${metres(p.drawn)} drawn, `
    + `${metres(p.moved)} with the tool up, ${(p.bytes / 1024).toFixed(0)} kB.${notes}`;
}

async function fetchPicture(job) {
  pictures.set(job, null);
  try {
    pictures.set(job, await post("/picture", { job }));
    dispatchEvent(new Event("job"));
  } catch { /* the server is away */ }
}

async function open(file, page = 1) {
  if (!card) {
    early = file;
    return;
  }
  const { id } = card;
  [wrong, opening] = ["", file.name];
  dispatchEvent(new Event("job"));
  try {
    last = await post(`/open?name=${encodeURIComponent(file.name)}&page=${page}`, file);
    pictures.set(last.job, last);
    openings.set(id, last);
    files.set(id, file);
    sendings.delete(id);
  } catch (error) {
    wrong = error.message;
  }
  opening = "";
  dispatchEvent(new Event("job"));
}

part("file").addEventListener("change", (event) => {
  const [file] = event.target.files;
  if (file) open(file);
  event.target.value = ""; // the same file may be opened again
});

part("page").addEventListener("change", (event) => {
  const file = files.get(card.id);
  if (file && event.target.validity.valid && event.target.value) open(file, event.target.value);
});

const drop = document.querySelector(".job");
for (const kind of ["dragover", "drop"]) {
  drop.addEventListener(kind, (event) => {
    event.preventDefault();
    if (kind === "drop" && event.dataTransfer.files.length) open(event.dataTransfer.files[0]);
  });
}

part("send").addEventListener("click", async () => {
  const { id } = card, { job, name } = picture();
  sendings.set(id, "");
  part("send").disabled = true;
  try {
    const result = await post(`/cards/${id}/job`, { job });
    const refused = `${name} was refused: ${result.text}. ${result.advice}`;
    sendings.set(id, result.ok ? `${name} is in the card.` : refused.trim());
  } catch (error) {
    sendings.set(id, error.message);
  }
  dispatchEvent(new Event("job"));
});

addEventListener("resize", show);
