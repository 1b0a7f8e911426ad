"use strict";
// A machine as it is drawn: faces with their corners, outward normals and colours.

// An arm at its joint angles [rad]; s: its size against one of 1.1 m; colours of body, joint, tool.
// base: where it stands, if it moves.
function armFaces(arm, joints, s, colours, tool, base) {
  if (!base) return facesFromBase(arm, joints, s, colours, tool);
  const faces = facesFromBase(arm, joints, s, colours, tool && add(tool, base, -1));
  return faces.map((face) => ({ ...face, corners: face.corners.map((corner) => add(corner, base)) }));
}

function facesFromBase(arm, joints, s, colours, tool) {
  if (arm.axes.length) return axesFaces(arm, joints, s, colours, tool);
  const p = armPose(arm, joints), faces = [];
  const put = (made, color) => made.forEach((f) => faces.push({ ...f, color }));
  const hub = (at, axis, half, r) => put(
    tube(add(at, axis, -half * s), add(at, axis, half * s), r * s), colours.joint);
  const side = [p.turned[0][1], p.turned[1][1], p.turned[2][1]];
  const fourth = arm.signs[3] * joints[3] - arm.offsets[3];
  const bend = times(product(p.fore, rotZ(fourth)), [0, 1, 0]);
  put(tube([0, 0, 0], [0, 0, 40 * s], 190 * s, 190 * s, 18), colours.joint);
  put(tube([0, 0, 40 * s], p.column, 130 * s, 105 * s, 16), colours.body);
  if (Math.hypot(...add(p.shoulder, p.column, -1)) > 1) {
    put(tube(p.column, p.shoulder, 95 * s, 85 * s), colours.body);
  }
  hub(p.shoulder, side, 110, 95);
  put(tube(p.shoulder, p.elbow, 78 * s, 62 * s), colours.body);
  hub(p.elbow, side, 88, 76);
  if (Math.hypot(...add(p.forearm, p.elbow, -1)) > 1) {
    put(tube(p.elbow, p.forearm, 66 * s, 58 * s), colours.body);
  }
  put(tube(p.forearm, p.wrist, 58 * s, 36 * s), colours.body);
  hub(p.wrist, bend, 46, 40);
  put(tube(p.wrist, p.flange, 30 * s, 26 * s), colours.body);
  const tip = arm.pen > 0 ? p.tip : tool;
  if (tip && Math.hypot(...add(tip, p.flange, -1)) > 20 * s) put(tube(p.flange, tip, 9 * s, 3 * s, 8), colours.tool);
  return faces;
}

// An arm told by its axes: a hub for each joint, links between them, the tool from the last one.
function axesFaces(arm, joints, s, colours, tool) {
  const pose = axesPose(arm, joints), faces = [];
  const put = (made, color) => made.forEach((f) => faces.push({ ...f, color }));
  put(tube([0, 0, 0], [0, 0, 40 * s], 190 * s, 190 * s, 18), colours.joint);
  let before = [0, 0, 0];
  pose.forEach(({ at, axis }, i) => {
    const r = (105 - 13 * i) * s;
    if (Math.hypot(...add(at, before, -1)) > 1) put(tube(before, at, 0.85 * r, 0.8 * r), colours.body);
    put(tube(add(at, axis, -1.15 * r), add(at, axis, 1.15 * r), r), colours.joint);
    before = at;
  });
  if (tool && Math.hypot(...add(tool, before, -1)) > 1) put(tube(before, tool, 24 * s, 6 * s, 8), colours.tool);
  return faces;
}

// A gantry with its tool at a place, about the bounds of a path.
function gantryFaces(place, { low, high, radius }, colours) {
  const faces = [], put = (made, color) => made.forEach((f) => faces.push({ ...f, color }));
  const r = radius || 1, t = 0.05 * r, top = high[2] + 0.45 * r;
  const [left, right] = [low[0] - 0.3 * r, high[0] + 0.3 * r];
  const [front, back] = [low[1] - 0.3 * r, high[1] + 0.3 * r], floor = low[2] - 0.08 * r;
  for (const x of [left, right]) {
    put(box([x - t, front, floor], [x + t, back, floor + t]), colours.joint);
    put(box([x - t, place[1] - t, floor + t], [x + t, place[1] + t, top]), colours.body);
  }
  put(box([left - t, place[1] - t, top], [right + t, place[1] + t, top + 2 * t]), colours.body);
  put(box([place[0] - 2 * t, place[1] - 2 * t, top - t],
    [place[0] + 2 * t, place[1] - t, top + 2.6 * t]), colours.joint);
  const ram = [place[0], place[1] - 1.5 * t];
  put(box([ram[0] - t, ram[1] - 0.5 * t, place[2] + 4 * t],
    [ram[0] + t, ram[1] + 1.5 * t, top + 6 * t + place[2] - high[2]]), colours.body);
  put(tube(place, [place[0], place[1], place[2] + 4 * t], 0.1 * t, 0.7 * t, 8), colours.tool);
  return faces;
}

function machineColours(dark) {
  return { body: [142, 160, 180], joint: dark ? [104, 124, 146] : [62, 80, 100],
    tool: [190, 40, 60], cell: dark ? [118, 108, 92] : [206, 192, 168] };
}

// Bodies of a cell: boxes by their corners, bars with their ends and radius.
function cellFaces(bodies, color) {
  return bodies.flatMap(({ turn, half, centre, bar, radius }) => {
    const made = bar ? tube(bar[0], bar[1], radius, radius, 18) : box(half.map((x) => -x), half).map((f) => ({
      corners: f.corners.map((p) => add(centre, times(turn, p))), normal: times(turn, f.normal) }));
    return made.map((f) => ({ ...f, color }));
  });
}

// Colour of a face in the light: red, green, blue.
function shade(color, normal) {
  const light = 0.62 + 0.38 * dot(normal, unit([0.35, -0.5, 0.8]));
  return color.map((c) => Math.round(Math.min(255, c * (0.45 + 0.62 * light))));
}

// A line through points on the screen; where one is behind the camera it is broken.
function stroke(pen, points, color, width, alpha = 1) {
  pen.beginPath();
  let open = false;
  for (const p of points) {
    if (!p[3]) { open = false; continue; }
    if (open) pen.lineTo(p[0], p[1]); else pen.moveTo(p[0], p[1]);
    open = true;
  }
  pen.globalAlpha = alpha;
  pen.strokeStyle = color;
  pen.lineWidth = width;
  pen.lineJoin = "round";
  pen.lineCap = alpha < 1 ? "butt" : "round"; // else two ends show where pieces meet
  pen.stroke();
  pen.globalAlpha = 1;
}

// Squares of a floor at a height between two corners; the length of a side.
function floorSquares(pen, look, { low, high, radius }, z, color) {
  const step = round125(Math.max(radius, 1e-9) / 4);
  const from = low.map((x) => Math.floor(x / step) * step);
  const to = high.map((x) => Math.ceil(x / step) * step);
  const cut = (a, b) => Array.from({ length: 9 }, (_, k) => look(add(a, add(b, a, -1), k / 8)));
  for (let x = from[0]; x <= to[0] + step / 2; x += step) {
    stroke(pen, cut([x, from[1], z], [x, to[1], z]), color, 1);
  }
  for (let y = from[1]; y <= to[1] + step / 2; y += step) {
    stroke(pen, cut([from[0], y, z], [to[0], y, z]), color, 1);
  }
  return step;
}

// The directions X, Y, Z in the corner.
function triad(pen, view, height, colours) {
  const look = camera({ ...view, target: [0, 0, 0], distance: 9 }, 120, 120);
  const move = (p) => [p[0] - 10, height - 110 + p[1], p[2], true];
  const origin = move(look([0, 0, 0]));
  ["X", "Y", "Z"].forEach((name, i) => {
    const end = [0, 0, 0];
    end[i] = 1;
    const tip = move(look(end)), text = move(look(end.map((x) => 1.35 * x)));
    stroke(pen, [origin, tip], colours[i], 2);
    pen.fillStyle = colours[i];
    pen.font = "600 12px sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(name, text[0], text[1]);
  });
}
