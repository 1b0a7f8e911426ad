// A job on a canvas: the way of the tool, its speed as colour, where the tool is now.

const SLOW_TO_FAST = [[233, 84, 96], [240, 160, 48], [64, 180, 120], [45, 140, 230]];
const SHADES = 24, ROOM = 34; // colours; pixels around the drawing
const kept = { job: null, key: "", base: null };

export function colour(share) {
  const at = Math.min(Math.max(share, 0), 1) * (SLOW_TO_FAST.length - 1);
  const k = Math.min(Math.floor(at), SLOW_TO_FAST.length - 2);
  const mix = SLOW_TO_FAST[k].map((c, i) => Math.round(c + (at - k) * (SLOW_TO_FAST[k + 1][i] - c)));
  return `rgb(${mix})`;
}

// Distance of the grid [mm]: 1, 2 or 5 times a power of ten, not closer than 45 pixels.
export function gridStep(scale) {
  const least = 45 / scale, ten = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((f) => f * ten).find((s) => s >= least);
}

export function draw(canvas, picture, tool, frame) {
  const box = canvas.getBoundingClientRect(), dense = devicePixelRatio || 1;
  const [w, h] = [Math.round(box.width), Math.round(box.height)];
  if (!w || !h) return;
  const css = getComputedStyle(canvas);
  const key = [w, h, dense, css.color, picture?.job].join();
  if (kept.key !== key) {
    Object.assign(kept, { key, base: base(picture, w, h, dense, css) });
  }
  if (canvas.width !== w * dense || canvas.height !== h * dense) {
    [canvas.width, canvas.height] = [w * dense, h * dense];
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.clearRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(kept.base.image, 0, 0);
  if (!picture) return;
  pen.setTransform(dense, 0, 0, dense, 0, 0);
  const { place } = kept.base;
  if (frame !== null) done(pen, picture, place, frame, css);
  if (tool) cross(pen, place(...tool), css);
}

const signed = (number) => String(number).replace("-", "\u2212");

// All that does not move.
function base(picture, w, h, dense, css) {
  const image = document.createElement("canvas");
  [image.width, image.height] = [w * dense, h * dense];
  const pen = image.getContext("2d");
  pen.scale(dense, dense);
  const [low, high] = picture ? span(picture) : [[0, 0], [100, 60]];
  const size = [0, 1].map((k) => Math.max(high[k] - low[k], 1));
  const scale = Math.min((w - 2 * ROOM) / size[0], (h - 2 * ROOM) / size[1]);
  const left = (w - scale * size[0]) / 2, foot = (h + scale * size[1]) / 2;
  const place = (x, y) => [left + scale * (x - low[0]), foot - scale * (y - low[1])];
  grid(pen, [w, h], place, low, scale, css);
  if (picture) way(pen, picture, place, css);
  return { image, place };
}

function span(p) {
  const low = [0, 0], high = [0, 0];
  p.x.forEach((x, k) => {
    [low[0], high[0]] = [Math.min(low[0], x), Math.max(high[0], x)];
    [low[1], high[1]] = [Math.min(low[1], p.y[k]), Math.max(high[1], p.y[k])];
  });
  return [low, high];
}

function grid(pen, [w, h], place, low, scale, css) {
  const step = gridStep(scale), [x0, y0] = place(0, 0);
  pen.font = "11px system-ui, sans-serif";
  pen.lineWidth = 1;
  pen.strokeStyle = css.getPropertyValue("--grid");
  pen.fillStyle = css.getPropertyValue("--muted");
  pen.beginPath();
  pen.textAlign = "center";
  for (let k = Math.ceil(-x0 / (step * scale)); x0 + k * step * scale < w; k++) {
    const x = Math.round(x0 + k * step * scale) + 0.5;
    pen.moveTo(x, 0);
    pen.lineTo(x, h);
    if (x > 24 && x < w - 24) pen.fillText(signed(+(k * step).toPrecision(6)), x, h - 5);
  }
  pen.textAlign = "left";
  for (let k = Math.ceil((y0 - h) / (step * scale)); y0 - k * step * scale > 0; k++) {
    const y = Math.round(y0 - k * step * scale) + 0.5;
    pen.moveTo(0, y);
    pen.lineTo(w, y);
    if (y > 16 && y < h - 18) pen.fillText(signed(+(k * step).toPrecision(6)), 5, y - 3);
  }
  pen.stroke();
}

// Lines of one colour are one stroke: a path of 12,000 points takes a few milliseconds.
function way(pen, p, place, css) {
  const strokes = new Map();
  for (let k = 1; k < p.x.length; k++) {
    const share = p.fastest > 0 ? p.speed[k] / p.fastest : 0;
    const key = p.down[k] ? Math.round(share * SHADES) : -1;
    if (!strokes.has(key)) strokes.set(key, new Path2D());
    const path = strokes.get(key);
    path.moveTo(...place(p.x[k - 1], p.y[k - 1]));
    path.lineTo(...place(p.x[k], p.y[k]));
  }
  pen.lineCap = "round";
  for (const [key, path] of [...strokes].sort((a, b) => a[0] - b[0])) {
    pen.setLineDash(key < 0 ? [2, 5] : []);
    pen.lineWidth = key < 0 ? 1 : 1.8;
    pen.strokeStyle = key < 0 ? css.getPropertyValue("--up") : colour(key / SHADES);
    pen.stroke(path);
  }
  pen.setLineDash([]);
}

// What the tool has behind it is veiled.
function done(pen, p, place, frame, css) {
  pen.beginPath();
  for (let k = 1; k < p.x.length && p.frame[k] <= frame; k++) {
    if (!p.down[k]) continue;
    pen.moveTo(...place(p.x[k - 1], p.y[k - 1]));
    pen.lineTo(...place(p.x[k], p.y[k]));
  }
  pen.lineWidth = 4.5;
  pen.lineCap = "round";
  pen.strokeStyle = css.getPropertyValue("--done");
  pen.stroke();
}

function cross(pen, [x, y], css) {
  pen.strokeStyle = css.color;
  pen.lineWidth = 2;
  pen.beginPath();
  pen.arc(x, y, 8, 0, 2 * Math.PI);
  for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
    pen.moveTo(x + 5 * dx, y + 5 * dy);
    pen.lineTo(x + 15 * dx, y + 15 * dy);
  }
  pen.stroke();
}
