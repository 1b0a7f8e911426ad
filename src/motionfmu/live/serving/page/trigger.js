// The trigger of the oscilloscope: the machine looks for it at every step, so none is missed.
import { choice, part, put } from "./dom.js";
import { act } from "./link.js";
import { about } from "./machine.js";
import { figures } from "./words.js";

const KINDS = { rise: "rises through", fall: "falls through", either: "passes", level: "is above", window: "leaves", change: "changes" };
const MODES = { single: "once", normal: "again and again", auto: "again, or without" };
const LENGTHS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10], PRES = [0, 0.1, 0.25, 0.5, 0.75, 0.9];

choice(part("trigger-kind"), Object.entries(KINDS), "rise");
choice(part("trigger-mode"), Object.entries(MODES), "single");
choice(part("trigger-length"), LENGTHS.map((s) => [s, s < 1 ? `${1e3 * s} ms` : `${s} s`]), 0.5);
choice(part("trigger-pre"), PRES.map((p) => [p, `${100 * p} %`]), 0.25);
part("trigger-kind").addEventListener("change", ({ target }) => {
  part("trigger-high-label").hidden = target.value !== "window";
  part("trigger-level").closest("label").hidden = target.value === "change";
});
addEventListener("channels", ({ detail }) => {
  const had = part("trigger-channel").value;
  choice(part("trigger-channel"), detail.map((name) => [name, name]), detail.includes(had) ? had : detail[0]);
  put(part("trigger-state"), "off");
});
part("trigger-form").addEventListener("submit", async (event) => {
  event.preventDefault();
  const number = (id) => Number(part(id).value);
  const asked = { channel: part("trigger-channel").value, kind: part("trigger-kind").value, level: number("trigger-level"),
    high: number("trigger-high"), pre: number("trigger-pre"), length: Math.round(number("trigger-length") / about.step), mode: part("trigger-mode").value };
  if (await act("trigger", asked) !== undefined) put(part("trigger-state"), `waits until ${asked.channel} ${KINDS[asked.kind]} ${asked.kind === "change" ? "" : figures(asked.level)}`);
});
part("trigger-off").addEventListener("click", () => act("trigger").then((done) => { if (done !== undefined) put(part("trigger-state"), "off"); }));
addEventListener("triggered", ({ detail }) => put(part("trigger-state"), `triggered at ${figures(detail, 8)} s`));
