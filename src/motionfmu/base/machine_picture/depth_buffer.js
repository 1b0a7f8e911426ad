"use strict";
// Faces on a canvas with a depth for each pixel, so that none shows through another.

const SHARP = 2.2e6; // pixels from which on edges are not smoothed

// A picture of a width and height in pixels of the page, `ratio` pixels of the screen each.
function depthBuffer() {
  const sheet = document.createElement("canvas"), pen = sheet.getContext("2d");
  let width = 0, height = 0, scale = 1, near = null, image = null, words = null;

  function size(w, h, ratio) {
    const fine = w * h * ratio * ratio * 4 <= SHARP ? 2 * ratio : ratio;
    const [wide, high] = [Math.ceil(w * fine), Math.ceil(h * fine)];
    if (wide !== width || high !== height || !near) {
      [sheet.width, sheet.height] = [width, height] = [wide, high];
      near = new Float32Array(width * height);
      image = pen.createImageData(width, height);
      words = new Uint32Array(image.data.buffer);
    }
    scale = fine;
    near.fill(0);
    words.fill(0);
  }

  // Faces with corners, normal, colour, seen from a view; those that look away are left out.
  function faces(list, view, look) {
    const eye = [Math.cos(view.elevation) * Math.cos(view.azimuth),
      Math.cos(view.elevation) * Math.sin(view.azimuth), Math.sin(view.elevation)];
    const from = add(view.target, eye, view.distance), least = NEAR * view.distance;
    const depth = (p) => dot(add(from, p, -1), eye);
    for (const face of list) {
      if (!face.both && dot(face.normal, add(from, face.corners[0], -1)) <= 0) continue;
      const [r, g, b] = shade(face.color, face.normal);
      const corners = clipped(face.corners, depth, least).map((p) => {
        const [x, y, z] = look(p);
        return [x * scale, y * scale, 1 / Math.max(z - (face.lift ?? 0), least)];
      });
      fillFace(near, width, height, corners, words, (255 << 24 | b << 16 | g << 8 | r) >>> 0);
    }
  }

  // Whether a point of the picture, [x, y, depth], lies behind a face by more than a slack.
  function hidden([x, y, depth], slack) {
    const [i, j] = [Math.floor(x * scale), Math.floor(y * scale)];
    if (i < 0 || j < 0 || i >= width || j >= height) return false;
    return near[j * width + i] > 1 / Math.max(depth - slack, 1e-9);
  }

  function paint(onto, alpha) {
    pen.putImageData(image, 0, 0);
    onto.globalAlpha = alpha;
    onto.imageSmoothingQuality = "high";
    onto.drawImage(sheet, 0, 0, width, height, 0, 0, width / scale, height / scale);
    onto.globalAlpha = 1;
  }

  return { size, faces, hidden, paint };
}

// The part of a convex face that is far enough from the camera.
function clipped(corners, depth, least) {
  const kept = [];
  corners.forEach((p, k) => {
    const q = corners[(k + 1) % corners.length], [a, b] = [depth(p) - least, depth(q) - least];
    if (a >= 0) kept.push(p);
    if ((a < 0) !== (b < 0)) kept.push(add(p, add(q, p, -1), a / (a - b)));
  });
  return kept;
}

// Fill a convex face, corners [x, y, 1/depth], where nothing nearer is. 1/depth is linear over the
// picture of a plane.
function fillFace(near, width, height, corners, words, word) {
  const plane = slopes(corners);
  if (!plane) return;
  const [dx, dy, at] = plane, ys = corners.map((c) => c[1]);
  const top = Math.max(0, Math.ceil(Math.min(...ys) - 0.5));
  const bottom = Math.min(height - 1, Math.ceil(Math.max(...ys) - 0.5) - 1);
  for (let row = top; row <= bottom; row++) {
    const y = row + 0.5;
    let left = Infinity, right = -Infinity;
    for (let k = 0; k < corners.length; k++) {
      const [a, b] = [corners[k], corners[(k + 1) % corners.length]];
      if ((a[1] <= y) === (b[1] <= y)) continue;
      const x = a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]);
      left = Math.min(left, x);
      right = Math.max(right, x);
    }
    const first = Math.max(0, Math.ceil(left - 0.5));
    const last = Math.min(width - 1, Math.ceil(right - 0.5) - 1);
    let depth = at + dx * (first + 0.5) + dy * y, k = row * width + first;
    for (let i = first; i <= last; i++, k++, depth += dx) {
      if (depth > near[k]) { near[k] = depth; words[k] = word; }
    }
  }
}

// 1/depth of a face as at + dx x + dy y, from its widest three corners; nothing of one seen edgeways.
function slopes(corners) {
  let best = null, size = 1e-9;
  const a = corners[0];
  for (let k = 1; k + 1 < corners.length; k++) {
    const [b, c] = [corners[k], corners[k + 1]];
    const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if (Math.abs(area) > size) { size = Math.abs(area); best = [b, c, area]; }
  }
  if (!best) return null;
  const [b, c, area] = best, [u, v] = [b[2] - a[2], c[2] - a[2]];
  const dx = (u * (c[1] - a[1]) - v * (b[1] - a[1])) / area;
  const dy = (v * (b[0] - a[0]) - u * (c[0] - a[0])) / area;
  return [dx, dy, a[2] - dx * a[0] - dy * a[1]];
}

// Pieces of a line that nothing hides, cut where a face begins to; points [x, y, depth, there].
function shownPieces(points, buffer, slack) {
  const pieces = [];
  let open = null;
  const take = (p) => {
    if (!p[3] || buffer.hidden(p, slack)) { open = null; return; }
    if (!open) pieces.push(open = []);
    open.push(p);
  };
  points.forEach((p, k) => {
    const q = points[k - 1];
    if (q && q[3] && p[3]) {
      const cuts = Math.min(200, Math.floor(Math.hypot(p[0] - q[0], p[1] - q[1]) / 4));
      for (let i = 1; i <= cuts; i++) {
        const f = i / (cuts + 1), w = (1 - f) / q[2] + f / p[2];
        take([q[0] + f * (p[0] - q[0]), q[1] + f * (p[1] - q[1]), 1 / w, true]);
      }
    }
    take(p);
  });
  return pieces;
}
