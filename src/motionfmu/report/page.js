"use strict";
const page = JSON.parse(document.getElementById("data").textContent);
const options = {
  responsive: true, displaylogo: false, displayModeBar: "hover",
  modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"],
};

// On a telephone the tools of a plot would cover its legend, and a scene is seen from further away.
const narrow = document.documentElement.clientWidth < 500;
if (narrow) options.displayModeBar = false;

const plots = page.figures.map((figure) => {
  const place = document.getElementById(figure.id);
  const eye = narrow && figure.layout.scene?.camera?.eye;
  for (const axis in eye) eye[axis] *= 2;
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
