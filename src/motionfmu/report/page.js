"use strict";
const page = JSON.parse(document.getElementById("data").textContent);
const options = {
  responsive: true, displaylogo: false, displayModeBar: "hover",
  modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"],
};

function unpack(packed) {
  const text = atob(packed.bdata);
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  return packed.dtype === "i4" ? new Int32Array(bytes.buffer) : new Float32Array(bytes.buffer);
}

const plots = page.figures.map((figure) => {
  const place = document.getElementById(figure.id);
  Plotly.newPlot(place, figure.data, figure.layout, options);
  return { place, overTime: figure.over_time };
});

// All plots over time show the same stretch of it.
let linking = false;
const timed = plots.filter((p) => p.overTime).map((p) => p.place);
for (const source of timed) {
  source.on("plotly_relayout", (change) => {
    if (linking) return;
    const range = change["xaxis.range"] ||
      ("xaxis.range[0]" in change && [change["xaxis.range[0]"], change["xaxis.range[1]"]]);
    const reset = change["xaxis.autorange"];
    if (!range && !reset) return;
    linking = true;
    const same = reset ? { "xaxis.autorange": true } : { "xaxis.range": range };
    Promise.all(timed.filter((p) => p !== source).map((p) => Plotly.relayout(p, same)))
      .finally(() => { linking = false; });
  });
}

// Another magnification: the error's points and hairs are placed anew on the path.
const path = page.path;
const foot = path.foot.map(unpack);
const gap = path.gap.map(unpack);
const hair = unpack(path.hairs);
const place = document.getElementById("path");
const choice = document.getElementById("magnification");

function magnify(factor) {
  const change = {};
  ["x", "y", "z"].slice(0, foot.length).forEach((axis, i) => {
    const shown = Array.from(foot[i], (f, k) => f + factor * gap[i][k]);
    const hairs = [];
    for (const k of hair) hairs.push(foot[i][k], shown[k], NaN);
    change[axis] = [hairs, shown];
  });
  Plotly.restyle(place, change, [1, 3]);
  for (const e of document.querySelectorAll("[data-magnification]")) {
    e.textContent = factor.toLocaleString("en");
  }
}

choice.addEventListener("change", () => magnify(Number(choice.value)));
for (const [id, way] of [["less", -1], ["more", 1]]) {
  document.getElementById(id).addEventListener("click", () => {
    const next = choice.selectedIndex + way;
    if (next < 0 || next >= choice.options.length) return;
    choice.selectedIndex = next;
    magnify(Number(choice.value));
  });
}
