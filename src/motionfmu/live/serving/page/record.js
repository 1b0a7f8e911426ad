// A record of the oscilloscope's channels in a file, for as long as one likes; the machine's computer writes it.
import { part, put } from "./dom.js";
import { act } from "./link.js";
import { about, frame } from "./machine.js";
import { told } from "./header.js";
import { figures } from "./words.js";

part("record-form").addEventListener("submit", (event) => {
  event.preventDefault();
  act("record", { file: part("record-file").value.trim() });
});
part("record-end").addEventListener("click", async () => {
  const files = await act("record");
  if (files) told(`Written: ${files.join(", ")}`, "good");
});

export function showRecord() {
  const writing = frame.scope.recording, seconds = ({ rows }) => figures(rows * about.step, 4);
  put(part("record-state"), writing.map((r) => `${r.file}, ${seconds(r)} s`).join("; ") || "off");
  part("record-end").disabled = !writing.length;
}
