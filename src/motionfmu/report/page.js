// What the page's other scripts do once its data are there.
const ready = [];
let page, plots;
const options = {
  responsive: true, displaylogo: false, displayModeBar: true, doubleClick: "reset",
  modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d", "sendChartToCloud"],
};
const QUIET = { bgcolor: "rgba(0,0,0,0)", color: "#8a98a5", activecolor: "#0b5cad" };
// So much more than what is in view is drawn on either side, for those who shift it.
const BESIDE = 1;
const BELOW = 8, LOWEST = 200; // [pixel] of a plot of axes of one scale: beside it, its height

const BAR = 62; // [pixel] of a scale below a plot
const narrow = document.documentElement.clientWidth < 500;

// A telephone: a scene from further away, a scale below its plot, no taller than it needs to be;
// a finger scrolls the page until a tool of the plot is chosen.
function fitted({ data, layout }) {
  const eye = layout.scene?.camera?.eye;
  for (const axis in eye) eye[axis] *= 1.5;
  if (!layout.scene) layout.dragmode = false;
  const alike = layout.yaxis?.scaleanchor || layout.polar || layout.scene;
  if (alike) layout.height = Math.min(layout.height, layout.scene ? 360 : 440);
  for (const trace of data) {
    if (trace.orientation === "h") { // the names of bars in short lines
      trace.y = trace.y.map((name) => name.replace(/(.{8,}?) /g, "$1<br>"));
      Object.assign(layout.margin, { l: 20, r: 70 });
      layout.xaxis.nticks = 4;
    }
    const bar = trace.colorbar ?? trace.marker?.colorbar;
    if (!bar) continue;
    Object.assign(bar, { orientation: "h", x: 0.5, y: -0.02, len: 0.9, yanchor: "top", thickness: 10,
      nticks: 4, tickangle: 0 });
    if (!layout.scene) { // below the title of the axis, however tall the plot is
      Object.assign(bar, { yref: "container", y: 0, yanchor: "bottom" });
      layout.margin.b = BAR + (layout.margin.b ?? 0);
    }
    if (bar.title) bar.title.text = bar.title.text.replaceAll("<br>", " ");
    if (bar.tickvals) { // no closer than a number is wide
      const apart = (bar.tickvals.at(-1) - bar.tickvals[0]) / 3;
      let last = -Infinity;
      const kept = bar.tickvals.map((v) => (v - last >= apart ? ((last = v), true) : false));
      const thin = (_, i) => kept[i];
      [bar.ticktext, bar.tickvals] = [bar.ticktext.filter(thin), bar.tickvals.filter(thin)];
    }
  }
}

// The colour that replaces another one, which may be seen through.
function other(color, colors) {
  const [r, g, b, part] = /^rgba\(/.test(color) ? color.match(/[\d.]+/g).map(Number) : [];
  if (part === undefined) return colors[color] ?? color;
  const solid = `#${[r, g, b].map((c) => c.toString(16).padStart(2, "0")).join("")}`;
  return colors[solid] ? clear(colors[solid], part) : color;
}

// The same plot with other colours; numbers are left alone.
function recolored(part, colors) {
  for (const [key, value] of Object.entries(part)) {
    if (typeof value === "string") part[key] = other(value, colors);
    else if (value && typeof value === "object" && !ArrayBuffer.isView(value) && !(value.length > 99)) {
      recolored(value, colors);
    }
  }
  return part;
}

// What replaces the colours of a light page on a dark one, or the other way.
const palette = (dark) => Object.fromEntries(
  Object.entries(page.dark).map((pair) => (dark ? pair : pair.toReversed())));

const clear = (color, part) => {
  const parts = [1, 3, 5].map((k) => parseInt(color.slice(k, k + 2), 16));
  return `rgba(${parts.join(",")},${part})`;
};

class Plot {
  constructor({ id, data, layout, over_time, cursors }, clocks) {
    Object.assign(this, { place: document.getElementById(id), data, layout, cursors });
    this.overTime = over_time;
    this.span = layout.xaxis?.range;
    this.traces = data.map((trace, k) => [trace, k]).filter(([trace]) => trace.samples)
      .map(([trace, k]) => ({ trace, k, packed: trace.samples, clock: clocks }));
    layout.modebar = QUIET;
    this.place.style.minHeight = `${layout.height}px`;
  }

  // Samples are unpacked, and a band stands behind each curve, for where it swings.
  async open() {
    for (const own of this.traces) {
      const { trace, packed } = own;
      own.curve = { time: await own.clock[packed.time], values: await unwoven(packed.values),
        lines: packed.lines && await unwoven(packed.lines), steps: packed.steps, dots: packed.dots,
        more: packed.more };
      own.band = this.data.push({ type: "scatter", mode: "lines", fill: "toself", x: [], y: [],
        fillcolor: clear(trace.line.color, 0.2), line: { color: clear(trace.line.color, 0.6),
          width: 0.8 }, hoverinfo: "skip", showlegend: false, legendgroup: `${own.k}`,
        yaxis: trace.yaxis ?? "y" }) - 1;
      Object.assign(trace, { legendgroup: `${own.k}`, x: [], y: [] });
      delete trace.samples;
    }
    if (this.traces.length && !this.span) {
      const ends = this.traces.map(({ curve: { time } }) => [time[0], time.at(-1)]);
      this.span = [Math.min(...ends.map((e) => e[0])), Math.max(...ends.map((e) => e[1]))];
      this.layout.xaxis.range = [...this.span];
    }
    await Plotly.newPlot(this.place, this.data, this.layout, options);
    await this.close();
    if (!this.traces.length) return;
    this.note = this.place.parentElement.appendChild(document.createElement("p"));
    this.note.className = "note band";
    this.note.textContent = "Bands reach from the least to the largest value, the line in them is"
      + " the mean; zoomed in, single values show.";
    await this.refine(this.span);
    this.place.on("plotly_relayout", (change) => {
      const range = change["xaxis.range"] ?? ("xaxis.range[0]" in change
        ? [change["xaxis.range[0]"], change["xaxis.range[1]"]] : null);
      if (change["xaxis.autorange"]) Plotly.relayout(this.place, { "xaxis.range": [...this.span] });
      else if (range) { this.refined = this.refine(range); this.moved?.(range); }
    });
  }

  // Axes of one scale that leave room above and below them: the plot is made as low as they are.
  async close() {
    const { yaxis, _size } = this.place._fullLayout;
    if (!this.layout.yaxis?.scaleanchor) return;
    const height = this.layout.height - Math.round(_size.h - yaxis._length);
    if (height > this.layout.height - BELOW) return;
    this.place.style.minHeight = `${Math.max(height, LOWEST)}px`;
    await Plotly.relayout(this.place, { height: Math.max(height, LOWEST) });
  }

  get view() { return this.place._fullLayout.xaxis.range.map(Number); }

  // Draw what is between two times; the latest of many calls counts.
  async refine([from, to]) {
    const turn = this.turn = (this.turn ?? 0) + 1, beside = BESIDE * (to - from);
    const long = this.traces.map((own) => own.curve).filter((curve) => curve.more);
    const found = await Promise.all(long.map((c) => allOf(c, from - beside, to + beside)));
    if (turn !== this.turn) return;
    long.forEach((curve, k) => { curve.all = found[k] === curve ? null : found[k]; });
    await this.draw(from, to);
  }

  async draw(from, to) {
    const beside = BESIDE * (to - from), columns = Math.max(200, this.place.clientWidth);
    const ends = [Math.max(this.span[0], from - beside), Math.min(this.span[1], to + beside)];
    const share = Math.max(1, (ends[1] - ends[0]) / (to - from || 1));
    const change = { x: [], y: [], mode: [], "line.shape": [], customdata: [], hovertemplate: [] };
    const which = [];
    let bands = false;
    for (const { trace, k, band, curve } of this.traces) {
      const axis = this.layout["yaxis" + (trace.yaxis ?? "y").slice(1)];
      const height = axis.range ? axis.range[1] - axis.range[0] : 0;
      const shown = drawn(inView(curve, from, to), ...ends, Math.round(columns * share), height);
      const dotted = curve.dots && !shown.band;
      bands ||= shown.band !== null;
      which.push(k, band);
      change.x.push(shown.x, shown.band?.x ?? []);
      change.y.push(shown.y, shown.band?.y ?? []);
      change.mode.push(dotted ? "markers" : "lines", "lines");
      change["line.shape"].push(curve.steps && !shown.band ? "hv" : "linear", "linear");
      change.customdata.push(shown.custom, null);
      change.hovertemplate.push(shown.band
        ? "mean %{y:.5g}, %{customdata[0]:.5g} to %{customdata[1]:.5g}" : trace.hovertemplate, "");
    }
    this.note.hidden = !bands;
    await Plotly.restyle(this.place, change, which);
  }
}

// All plots over time show the same stretch of it.
function linked(plots) {
  let linking = false;
  for (const source of plots) {
    source.moved = (range) => {
      if (linking) return;
      linking = true;
      const others = plots.filter((p) => p !== source);
      Promise.all(others.map((p) => Plotly.relayout(p.place, { "xaxis.range": [...range] })))
        .finally(() => { linking = false; });
    };
  }
}

// On paper a plot is as wide as the paper, and light.
const PAPER = 720;
function printed(on) {
  root.classList.toggle("paper", on);
  themed(!on && isDark());
  for (const { place } of plots) {
    Plotly.relayout(place, on ? { width: Math.min(PAPER, place.clientWidth) } : { width: null });
  }
}

// A plot as a picture, a file of its own: it goes into documents, so it is light.
addEventListener("click", ({ target }) => {
  const [name, format] = target.dataset?.save?.split(".") ?? [];
  const place = name && document.getElementById(name);
  if (place) {
    const { data, layout } = place, shown = structuredClone({ data, layout });
    Plotly.downloadImage(plotsDark ? recolored(shown, palette(false)) : shown, { format, filename: name,
      width: place.clientWidth, height: place.clientHeight, scale: format === "png" ? 2 : 1 });
  }
});

// The plots as dark as they are to be; what is in view stays.
let plotsDark = false;
function themed(dark) {
  if (dark === plotsDark) return;
  plotsDark = dark;
  for (const { place } of plots) {
    recolored([place.data, place.layout], palette(dark));
    Plotly.redraw(place);
  }
  dispatchEvent(new Event("theme"));
}

document.getElementById("theme").addEventListener("click", () => {
  root.dataset.theme = isDark() ? "light" : "dark";
  try { localStorage.setItem("theme", root.dataset.theme); } catch { /* for this page alone */ }
  themed(isDark());
});
system.addEventListener("change", () => themed(isDark()));

// The contents stand beside a wide page, open, and say where the reader is.
const contents = document.querySelector(".contents details");
const wide = matchMedia("(min-width: 1100px)");
const unfold = () => { contents.open = wide.matches; };
unfold();
wide.addEventListener("change", unfold);
const ways = new Map([...contents.querySelectorAll("a")]
  .map((a) => [document.getElementById(a.hash.slice(1)), a]));
const seen = new Set();
const watch = new IntersectionObserver((changes) => {
  for (const { target, isIntersecting } of changes) seen[isIntersecting ? "add" : "delete"](target);
  const [first] = [...ways.keys()].filter((section) => seen.has(section));
  for (const [section, a] of ways) a.classList.toggle("here", section === first);
});
for (const section of ways.keys()) watch.observe(section);
contents.addEventListener("click", ({ target }) => { if (target.hash) unfold(); });

// What the page has packed under a name, as text.
async function unpacked(name) {
  const packed = Uint8Array.from(atob(document.getElementById(name).textContent), (c) => c.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
}

// What was drawn is on the screen; of a page behind others it is when somebody looks.
function onScreen() {
  const looked = new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
  return Promise.race([looked, new Promise((done) => setTimeout(done, 500))]);
}

async function open() {
  if (!("DecompressionStream" in window)) {
    document.getElementById("unable").hidden = false;
    return;
  }
  const script = document.createElement("script");
  [page, script.textContent] = await Promise.all([unpacked("data").then(JSON.parse), unpacked("plotly")]);
  document.head.append(script);
  if (narrow) page.figures.forEach(fitted);
  plotsDark = isDark();
  if (plotsDark) recolored(page.figures, palette(true));
  const clocks = page.times.map(timesOf);
  plots = page.figures.map((figure) => new Plot(figure, clocks));
  // Scenes in space take as long as all the rest, so the rest is shown before they begin.
  const [flat, deep] = [false, true].map((d) => plots.filter((p) => "scene" in p.layout === d));
  await Promise.all(flat.map((p) => p.open()));
  if (deep.length && flat.length) await onScreen();
  await Promise.all(deep.map((p) => p.open()));
  linked(plots.filter((p) => p.overTime));
  measured(plots.filter((p) => p.cursors && p.traces.length));
  addEventListener("beforeprint", () => printed(true));
  addEventListener("afterprint", () => printed(false));
  for (const begin of ready) begin();
}

// For tests: everything is drawn.
const opened = open();
