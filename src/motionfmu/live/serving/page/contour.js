// How far a tool is from the way that it is commanded, of which points come one by one.

const BEND = Math.cos(Math.PI / 6); // a sharper corner is one, and not rounded
const FINE = 16; // pieces of a curve between two points
const SURE = 1e-3, SHORT = 0.5; // [mm] a distance that is known so well; a piece that hides nothing

const less = (a, b) => a.map((x, i) => x - b[i]);
const size = (a) => Math.hypot(...a);
const inner = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);

export function toSegment(p, a, b) {
  const way = less(b, a), whole = inner(way, way);
  const share = whole ? Math.max(0, Math.min(1, inner(less(p, a), way) / whole)) : 0;
  return size(less(p, a.map((x, i) => x + share * way[i])));
}

const straight = (a, b, c) => {
  const [u, v] = [less(b, a), less(c, b)], long = size(u) * size(v);
  return long > 0 && inner(u, v) > BEND * long;
};

// A cubic through b and c whose slopes there are those of a parabola through three points
// (Catmull and Rom, centripetal knots would differ little: points are nearly evenly spaced).
function between(a, b, c, d, s) {
  return b.map((_, i) => {
    const m = (c[i] - a[i]) / 2, n = (d[i] - b[i]) / 2, e = c[i] - b[i];
    return b[i] + s * (m + s * (3 * e - 2 * m - n + s * (m + n - 2 * e)));
  });
}

// Least distance of p from the curve through points, straight to a corner and where they end; NaN
// where the points are too far apart to tell it.
export function fromCommand(p, points) {
  if (points.length < 2) return points.length ? size(less(p, points[0])) : NaN;
  let nearest = 0, least = Infinity;
  for (let k = 0; k + 1 < points.length; k++) {
    const far = toSegment(p, points[k], points[k + 1]);
    if (far < least) [least, nearest] = [far, k];
  }
  let [found, doubt] = [Infinity, 0];
  for (let k = Math.max(0, nearest - 1); k <= Math.min(points.length - 2, nearest + 1); k++) {
    const [far, unsure] = toCurve(p, points.slice(Math.max(0, k - 1), k + 3), k > 0 ? 1 : 0);
    if (far < found) [found, doubt] = [far, unsure];
  }
  return doubt > Math.max(SURE, found / 4) ? NaN : found;
}

// The distance from one piece, and how far the way between its ends may be from what is assumed.
function toCurve(p, near, at) {
  const [b, c] = [near[at], near[at + 1]], [a, d] = [near[at - 1], near[at + 2]];
  if (!a || !d || !straight(a, b, c) || !straight(b, c, d)) {
    const long = size(less(c, b));
    return [toSegment(p, b, c), long < SHORT || (!a && !d) ? 0 : bow(a, b, c, d, long)];
  }
  let least = Infinity, from = b;
  for (let k = 1; k <= FINE; k++) {
    const to = between(a, b, c, d, k / FINE);
    least = Math.min(least, toSegment(p, from, to));
    from = to;
  }
  const turn = Math.max(angle(a, b, c), angle(b, c, d));
  return [least, size(less(c, b)) * turn ** 3 / 64]; // height of the bow, and what is left of it
}

const angle = (a, b, c) => {
  const [u, v] = [less(b, a), less(c, b)], long = size(u) * size(v);
  return long ? Math.acos(Math.max(-1, Math.min(1, inner(u, v) / long))) : 0;
};

// The height of a bow over a piece that turns as its neighbours do.
const bow = (a, b, c, d, long) => long * Math.max(a ? angle(a, b, c) : 0, d ? angle(b, c, d) : 0) / 8;
