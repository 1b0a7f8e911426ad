// Two cursors, C1 and C2, on plots over time: they snap to samples, all plots of a group share them.

const NAMES = ["C1", "C2"];
const COLUMNS = ["Curve", "C1", "C2", "C2 \u2212 C1", "(C2 \u2212 C1)/\u0394t", "Least", "Largest",
  "Mean", "RMS"];
const RECIPROCAL = { s: "Hz", ms: "kHz" };

function made(parent, kind, set = {}, text = "") {
  const element = parent.appendChild(document.createElement(kind));
  for (const [name, value] of Object.entries(set)) element.setAttribute(name, value);
  if (text) element.textContent = text;
  return element;
}

function written(value, digits = 6) {
  if (!Number.isFinite(value)) return "\u2013";
  return String(Number(value.toPrecision(digits))).replace("-", "\u2212");
}

const typed = (t) => String(Number(t.toPrecision(12)));

const withoutMarks = (text) => {
  const html = new DOMParser().parseFromString(text.replaceAll("<br>", " "), "text/html");
  return html.body.textContent;
};
const unitOf = (axis) => /\[([^\]]*)\]/.exec(axis?.title?.text ?? "")?.[1] ?? "";

// The cursors of a group of plots: where they are, and whether they are shown.
class Cursors {
  constructor(plots) {
    this.on = false;
    this.at = [NaN, NaN];
    this.members = [];
    for (const plot of plots) this.members.push(new Measured(plot, this));
  }

  // Shown on all plots; one that is out of the view of the plot asked goes into it.
  show(on, { view: [from, to], snapped }) {
    this.on = on;
    this.at = this.at.map((t, k) =>
      (t >= from && t <= to ? t : snapped(from + (k + 1) / 3 * (to - from))));
    this.update();
  }

  move(which, t) {
    this.at[which] = t;
    this.update();
  }

  update() {
    if (this.waits) return;
    this.waits = requestAnimationFrame(() => {
      this.waits = 0;
      for (const member of this.members) member.update();
    });
  }
}

// The cursors on one plot, with what they read there.
class Measured {
  constructor(plot, cursors) {
    Object.assign(this, { plot, cursors, place: plot.place });
    this.unit = unitOf(plot.layout.xaxis);
    this.snapped = this.snapped.bind(this);
    const frame = this.place.parentElement;
    this.button = made(frame, "button", { type: "button", class: "measure", "aria-pressed": "false",
      title: "Two cursors: values, differences, time between" }, "Cursors");
    frame.prepend(this.button);
    this.button.addEventListener("click", () => cursors.show(!cursors.on, this));
    this.lines = NAMES.map((name, k) => this.line(name, k));
    this.readout = made(frame, "div", { class: "readout", hidden: "" });
    this.build();
    this.place.on("plotly_afterplot", () => this.lay());
    this.place.on("plotly_relayouting", () => this.lay());
    this.place.on("plotly_restyle", () => this.update());
    addEventListener("theme", () => this.update());
  }

  get view() { return this.plot.view; }

  // Times of the finest samples about a time.
  finest(t) {
    return this.plot.traces.map((own) => inView(own.curve, t, t).time)
      .reduce((a, b) => (b.length > a.length ? b : a));
  }

  // The nearest time at which there is a sample, within the run.
  snapped(t) {
    const time = this.finest(t), k = Math.min(Math.max(upTo(time, t), 1), time.length - 1);
    if (time.length < 2) return time[0];
    return t - time[k - 1] <= time[k] - t ? time[k - 1] : time[k];
  }

  // So many samples on.
  stepped(t, count) {
    const time = this.finest(t), k = upTo(time, t + near(t)) - 1 + count;
    return time[Math.min(Math.max(k, 0), time.length - 1)];
  }

  line(name, k) {
    const line = made(this.place, "div", { class: `cursor cursor-${name}`, role: "slider",
      tabindex: "0", hidden: "", "aria-label": `Cursor ${name}` });
    made(line, "span", {}, name);
    const go = (t) => this.cursors.move(k, this.snapped(t));
    line.addEventListener("pointerdown", (e) => {
      line.setPointerCapture(e.pointerId);
      line.focus({ preventScroll: true });
      e.preventDefault();
    });
    line.addEventListener("pointermove", (e) => {
      if (!line.hasPointerCapture(e.pointerId)) return;
      const axis = this.place._fullLayout.xaxis;
      const left = this.place.getBoundingClientRect().left + axis._offset;
      const [from, to] = this.view;
      go(Math.min(Math.max(axis.p2l(e.clientX - left), from), to));
    });
    line.addEventListener("keydown", (e) => {
      const [from, to] = this.view, t = this.cursors.at[k];
      const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[e.key];
      if (way && e.shiftKey) go(t + way * (to - from) / 100);
      else if (way) this.cursors.move(k, this.stepped(t, way));
      else if (e.key === "Home") go(from);
      else if (e.key === "End") go(to);
      else if (e.key === "Escape") { this.cursors.show(false, this); this.button.focus(); }
      else return;
      e.preventDefault();
    });
    return line;
  }

  build() {
    const row = made(this.readout, "div", { class: "control" });
    this.inputs = NAMES.map((name, k) => {
      const label = made(row, "label", {}, `${name} `);
      const input = made(label, "input", { type: "number", step: "any", "aria-label": `Time of ${name}` });
      label.append(` ${this.unit}`);
      input.addEventListener("change", () => {
        const t = Number(input.value);
        const at = input.value && Number.isFinite(t) ? this.snapped(t) : this.cursors.at[k];
        this.cursors.move(k, at);
        input.value = typed(at);
      });
      return input;
    });
    this.length = made(row, "span", { class: "number" });
    const zoom = made(row, "button", { type: "button" }, "Zoom to C1 \u2026 C2");
    zoom.addEventListener("click", () => {
      const [from, to] = this.cursors.at.toSorted((a, b) => a - b);
      if (to > from) Plotly.relayout(this.place, { "xaxis.range": [from, to] });
    });
    const table = made(made(this.readout, "div", { class: "scroll" }), "table");
    const head = made(made(table, "thead"), "tr");
    COLUMNS.forEach((text, k) => made(head, "th", { class: k ? "n" : "key" }, text));
    const body = made(table, "tbody");
    this.rows = this.plot.traces.map(({ trace, packed, curve, k }) => {
      const tr = made(body, "tr"), name = made(tr, "td", { class: "key" });
      const axis = this.plot.layout["yaxis" + (trace.yaxis ?? "y").slice(1)];
      const unit = unitOf(axis), title = unit ? ` [${unit}]` : "";
      const swatch = made(name, "i", { class: "swatch" });
      name.append(withoutMarks(trace.name || axis?.title?.text || "") + title);
      if (!packed.all) made(name, "div", { class: "sub" }, curve.more
        ? "peaks; zoomed in, all samples" : "peaks of a longer recording");
      const cells = COLUMNS.slice(1).map(() => made(tr, "td", { class: "n" }));
      return { tr, cells, curve, k, swatch };
    });
    if (this.cursors.members.length) return; // said once
    made(this.readout, "p", { class: "note" }, "Least, largest, mean and RMS are those of the"
      + " samples from C1 to C2. Drag a cursor, or move it with \u2190 \u2192: a sample, with shift a"
      + " hundredth of what is in view; Home and End go to its ends.");
  }

  update() {
    const { on, at } = this.cursors, dt = at[1] - at[0];
    this.button.setAttribute("aria-pressed", String(on));
    this.readout.hidden = !on;
    this.lay();
    if (!on) return;
    this.inputs.forEach((input, k) => { // but not under the hands of who types
      if (input !== document.activeElement) input.value = typed(at[k]);
    });
    const rate = RECIPROCAL[this.unit] ?? `1/${this.unit}`;
    this.length.textContent = `\u0394t = ${written(dt, 9)} ${this.unit}, 1/\u0394t = `
      + (dt ? `${written(1 / Math.abs(dt))} ${rate}` : "\u2013");
    const [from, to] = [Math.min(...at), Math.max(...at)];
    for (const { tr, cells, curve, k, swatch } of this.rows) {
      swatch.style.background = this.place.data[k].line.color;
      tr.hidden = this.place.data[k].visible === "legendonly";
      if (tr.hidden) continue;
      const [a, b] = at.map((t) => valueAt(curve, t));
      const { least, largest, mean, rms } = between(curve, from, to);
      const shown = [a, b, b - a, dt ? (b - a) / dt : NaN, least, largest, mean, rms];
      shown.forEach((value, i) => { cells[i].textContent = written(value, 7); });
    }
  }

  // The lines on the plot, hidden where they are out of view.
  lay() {
    const { xaxis, _size } = this.place._fullLayout, [from, to] = this.view;
    this.lines.forEach((line, k) => {
      const t = this.cursors.at[k];
      line.hidden = !this.cursors.on || t < from - near(from) || t > to + near(to);
      if (line.hidden) return;
      line.style.left = `${xaxis._offset + xaxis.l2p(t)}px`;
      line.style.top = `${_size.t}px`;
      line.style.height = `${_size.h}px`;
      const set = { "aria-valuemin": from, "aria-valuemax": to, "aria-valuenow": t,
        "aria-valuetext": `${written(t, 9)} ${this.unit}` };
      for (const [name, value] of Object.entries(set)) line.setAttribute(name, value);
    });
  }
}

function measured(plots) {
  for (const name of new Set(plots.map((p) => p.cursors))) {
    new Cursors(plots.filter((p) => p.cursors === name));
  }
}
