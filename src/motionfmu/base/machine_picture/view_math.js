"use strict";
// Geometry of the moving picture: pure functions, lengths in mm, angles in rad.

// Numbers packed as 16-bit steps between their ends.
function numbers(packed) {
  const bytes = Uint8Array.from(atob(packed.bdata), (c) => c.charCodeAt(0));
  return Float64Array.from(new Uint16Array(bytes.buffer), (k) => packed.low + packed.step * k);
}

const add = (a, b, f = 1) => [a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const n = Math.hypot(...a) || 1; return [a[0] / n, a[1] / n, a[2] / n]; };
const times = (m, v) => [dot(m[0], v), dot(m[1], v), dot(m[2], v)];
const product = (m, n) => m.map((row) => [0, 1, 2].map((j) =>
  row[0] * n[0][j] + row[1] * n[1][j] + row[2] * n[2][j]));
const rotZ = (q) => [[Math.cos(q), -Math.sin(q), 0], [Math.sin(q), Math.cos(q), 0], [0, 0, 1]];
const rotY = (q) => [[Math.cos(q), 0, Math.sin(q)], [0, 1, 0], [-Math.sin(q), 0, Math.cos(q)]];

// Points of an arm with a spherical wrist, from its seven lengths (Brandstoetter, Angerer, Hofbaur
// 2014); th = sign q - offset. Frames are 3 x 3, axes in columns; the tool points along z.
function armPose(arm, q) {
  const [a1, a2, b, c1, c2, c3, c4] = arm.lengths;
  const th = q.map((x, i) => arm.signs[i] * x - arm.offsets[i]);
  const turned = rotZ(th[0]);
  const upper = product(turned, rotY(th[1]));
  const fore = product(turned, rotY(th[1] + th[2]));
  const hand = product(product(product(fore, rotZ(th[3])), rotY(th[4])), rotZ(th[5]));
  const column = [0, 0, c1];
  const shoulder = add(column, times(turned, [a1, b, 0]));
  const elbow = add(shoulder, times(upper, [0, 0, c2]));
  const forearm = add(elbow, times(fore, [a2, 0, 0]));
  const wrist = add(forearm, times(fore, [0, 0, c3]));
  const flange = add(wrist, times(hand, [0, 0, c4]));
  const tip = add(flange, times(hand, [0, 0, arm.pen]));
  return { column, shoulder, elbow, forearm, wrist, flange, tip, turned, fore, hand };
}

// A turn by q about a unit vector u, after Rodrigues.
function rotAbout(u, q) {
  const c = Math.cos(q), s = Math.sin(q), across = [[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]];
  return across.map((row, i) => row.map((x, j) => (i === j ? c : 0) + s * x + (1 - c) * u[i] * u[j]));
}

// Place and axis of each joint of an arm told by its axes: each turns all that lies behind it, or slides with it,
// but so many joints before a link that a linkage keeps level do not tilt it; its joint is on a hand.
function axesPose(arm, q) {
  let at = [0, 0, 0];
  const frames = [[[1, 0, 0], [0, 1, 0], [0, 0, 1]]];
  return arm.axes.map(([origin, direction, slides, level = 0, hand = [0, 0, 0]], i) => {
    const before = frames[i - level];
    at = add(add(at, times(frames[i], origin)), times(before, hand));
    const axis = times(before, direction);
    if (slides) at = add(at, axis, 1000 * q[i]);
    frames.push(slides ? before : product(before, rotAbout(direction, q[i])));
    return { at, axis };
  });
}

// Points of an arm, whatever tells it.
function armPoints(arm, q) {
  if (arm.axes.length) {
    const room = [0, 0, 0.15 * armReach(arm)[0]];
    return axesPose(arm, q).flatMap(({ at }) => [at, add(at, room)]);
  }
  const p = armPose(arm, q);
  return [p.shoulder, p.elbow, p.forearm, p.wrist, p.tip];
}

// How far an arm reaches from its shoulder, and how high that is.
function armReach(arm) {
  if (!arm.axes.length) return [arm.lengths[0] + arm.lengths[4] + arm.lengths[5], arm.lengths[3]];
  const ways = arm.axes.map(([origin]) => Math.hypot(...origin));
  return [ways.slice(1).reduce((sum, way) => sum + way, 0), Math.max(0, arm.axes[0][0][2])];
}

const NEAR = 0.05; // part of the camera's distance from which on something is seen

// A camera looks at a point from a distance; azimuth from x, elevation from the floor.
function camera(view, width, height) {
  const [ca, sa] = [Math.cos(view.azimuth), Math.sin(view.azimuth)];
  const [ce, se] = [Math.cos(view.elevation), Math.sin(view.elevation)];
  const eye = [ce * ca, ce * sa, se], right = [-sa, ca, 0], up = [-se * ca, -se * sa, ce];
  const focus = 1.9 * Math.min(width, height);
  const near = NEAR * view.distance;
  return (p) => {
    const d = add(p, view.target, -1);
    const depth = view.distance - dot(d, eye);
    const scale = focus / Math.max(depth, near);
    return [width / 2 + scale * dot(d, right), height / 2 - scale * dot(d, up), depth,
      depth > near];
  };
}

// Faces of a tube from a to b, each with its corners and outward normal; radii at both ends.
function tube(a, b, radius, end = radius, sides = 14) {
  const axis = unit(add(b, a, -1));
  const u = unit(cross(axis, Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
  const v = cross(axis, u);
  const [low, high] = [[a, radius], [b, end]].map(([centre, r]) =>
    Array.from({ length: sides }, (_, k) => {
      const t = 2 * Math.PI * k / sides;
      return add(add(centre, u, r * Math.cos(t)), v, r * Math.sin(t));
    }));
  const faces = [{ corners: low, normal: axis.map((x) => -x) }, { corners: high, normal: axis }];
  for (let k = 0; k < sides; k++) {
    const n = (k + 1) % sides, t = 2 * Math.PI * (k + 0.5) / sides;
    const normal = add(add([0, 0, 0], u, Math.cos(t)), v, Math.sin(t));
    faces.push({ corners: [low[k], low[n], high[n], high[k]], normal });
  }
  return faces;
}

// Faces of a box between two corners.
function box(low, high) {
  const at = (i, j, k) => [i ? high[0] : low[0], j ? high[1] : low[1], k ? high[2] : low[2]];
  const sides = [[0, 1, 2], [1, 2, 0], [2, 0, 1]], faces = [];
  for (const [n, u, v] of sides) {
    for (const s of [0, 1]) {
      const corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(([p, q]) => {
        const bits = [0, 0, 0];
        bits[n] = s; bits[u] = p; bits[v] = q;
        return at(...bits);
      });
      const normal = [0, 0, 0];
      normal[n] = s ? 1 : -1;
      faces.push({ corners, normal });
    }
  }
  return faces;
}

// Colour a share 0 .. 1 of the way through a list of hex colours.
function colour(stops, share) {
  const x = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(x), stops.length - 2), f = x - k;
  const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
  const [a, b] = [rgb(stops[k]), rgb(stops[k + 1])];
  return `rgb(${a.map((c, i) => Math.round(c + f * (b[i] - c))).join(",")})`;
}

// Last place of an increasing list that is not above a value.
function before(list, value) {
  let low = 0, high = list.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (list[middle] <= value) low = middle; else high = middle - 1;
  }
  return low;
}

// Values of several series at a time between two of their samples.
function sampled(time, series, now) {
  const k = Math.min(before(time, now), Math.max(time.length - 2, 0));
  const span = time[k + 1] - time[k];
  const f = span > 0 ? Math.min(Math.max((now - time[k]) / span, 0), 1) : 0;
  return series.map((s) => s[k] + f * ((s[k + 1] ?? s[k]) - s[k]));
}

// Centre and radius of what is to be seen.
function bounds(points) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const p of points) {
    for (let i = 0; i < 3; i++) {
      low[i] = Math.min(low[i], p[i]);
      high[i] = Math.max(high[i], p[i]);
    }
  }
  const centre = low.map((x, i) => (x + high[i]) / 2);
  return { low, high, centre, radius: Math.hypot(...add(high, low, -1)) / 2 };
}

// 1, 2 or 5 times a power of ten, not above a value.
function round125(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map((m) => m * power).find((x) => x <= value * (1 + 1e-9));
}
