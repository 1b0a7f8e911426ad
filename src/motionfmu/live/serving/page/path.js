// The path in 3D: what is planned, what is done, the tool and its machine, the error as colour.
/* global add, armFaces, bounds, camera, cameraControls, colour, depthBuffer, floorSquares,
   gantryFaces, machineColours, round125, stroke, triad */
import { choice, part, put } from "./dom.js";
import { fetched, on } from "./link.js";
import { about, frame, values, watch } from "./machine.js";
import { fromCommand } from "./contour.js";

const MOST = 20000; // points that are done; beyond, every second one goes
const RECENT = 400; // commanded points that the tool may be near to
const LOOKS = { whole: ["Whole", -0.95, 0.42], top: ["Top", -Math.PI / 2, 1.57], front: ["Front", -Math.PI / 2, 0.05], side: ["Side", 0, 0.05] };
const AXES = ["#d0503a", "#3f9a3f", "#4a80d8"], ERRORS = ["#1d9a62", "#e0a020", "#d02838"];
const view = { azimuth: -0.95, elevation: 0.42, target: [0, 0, 0], distance: 300 };
const canvas = part("path"), pen = canvas.getContext("2d");
const solids = depthBuffer();
const [still, trail] = [document.createElement("canvas"), document.createElement("canvas")];

let scene = null, plan = [], done = [], command = [], scale = 0, largest = 0, error = NaN;
let stage = null, moved = false, dirty = true, drawn = 0, joints = null, tool = null, base = null, theme = {};

export async function pathOf() {
  scene = about.scene;
  canvas.closest("section").hidden = !scene;
  if (!scene) return;
  const { tool: [name], command: ordered, joints: angles, base: stands } = scene;
  watch("path", [name, ordered?.[0], angles?.[0], stands?.[0]].filter(Boolean));
  plan = [];
  clear();
  moved = false;
  try {
    plan = (await (await fetched("/planned")).json()).strokes;
  } catch { /* without the plan what is done is drawn */ }
  fit();
}

function clear() {
  [done, command, scale, largest, drawn, error] = [[], [], 0, 0, 0, NaN];
  dirty = true;
}

const point = ([name, factor]) => {
  const at = values(name);
  return at.length < 2 ? null : [0, 1, 2].map((k) => factor * (at[k] ?? 0));
};

// Take the place of the tool from each frame.
on("frame", () => {
  if (!scene) return;
  const from = point(scene.tool);
  if (!from) return;
  base = scene.base && point(scene.base);
  const now = base ? add(from, base) : from;
  if (done.length && frame.time < done.at(-1).time) undo();
  joints = scene.joints && values(scene.joints[0]).map((x) => x * scene.joints[1]);
  tool = now;
  if (scene.command) follow(point(scene.command));
  const last = done.at(-1);
  if (last && Math.hypot(...add(now, last.at, -1)) < 1e-3) return;
  error = command.length > 3 ? fromCommand(now, command) : NaN;
  if (error > largest) largest = error;
  done.push({ at: now, error, time: frame.time });
  if (done.length > MOST) {
    done = done.filter((_, k) => k % 2 === 0);
    dirty = true;
  }
  grow(now);
});

function follow(at) {
  const last = command.at(-1);
  if (last && Math.hypot(...add(at, last, -1)) < 1e-3) return;
  command.push(at);
  if (command.length > RECENT) command.shift();
}

function undo() {
  done = done.filter((one) => one.time <= frame.time);
  command = [];
  dirty = true;
}

// What is to be seen: the plan, what is done, some room about it; of an arm all it reaches.
function fit() {
  const points = [...plan.flatMap((s) => s.points), ...done.map((d) => d.at), tool ?? [0, 0, 0]];
  const arm = scene.arm;
  if (arm) {
    const [reach, height] = armReach(arm);
    points.push([-0.35 * reach, -0.5 * reach, 0], [0.8 * reach, 0.5 * reach, height + 0.8 * reach]);
  }
  stage = bounds(points);
  if (stage.radius < 25) stage = bounds([add(stage.centre, [30, 30, 0], -1), add(stage.centre, [30, 30, 15])]);
  if (!moved) lookFrom(part("path-look").value || "whole");
  dirty = true;
}

function grow(at) {
  const room = 0.02 * (stage?.radius ?? 1);
  if (stage && at.every((x, i) => x >= stage.low[i] - room && x <= stage.high[i] + room)) return;
  fit();
}

function lookFrom(name) {
  const [, azimuth, elevation] = LOOKS[name];
  const whole = scene.arm ? stage : bounds([add(stage.low, [0.3, 0.3, 0.1].map((f) => f * stage.radius), -1),
    add(stage.high, [0.3, 0.3, 0.6].map((f) => f * stage.radius))]);
  const tall = canvas.clientWidth < 1.2 * canvas.clientHeight;
  Object.assign(view, { azimuth, elevation, target: [...whole.centre], distance: (tall ? 3.8 : 3.0) * whole.radius });
  dirty = true;
}

function readTheme() {
  const style = getComputedStyle(canvas), get = (name) => style.getPropertyValue(name).trim();
  theme = { ...machineColours(get("--dark") === "1"), floor: get("--floor"), plan: get("--plan"), rapid: get("--rapid"),
    done: get("--accent"), ink: get("--ink") };
}

function sized() {
  const ratio = devicePixelRatio || 1, [w, h] = [canvas.clientWidth, canvas.clientHeight];
  const [width, height] = [Math.round(w * ratio), Math.round(h * ratio)];
  if (canvas.width !== width || canvas.height !== height) {
    for (const c of [canvas, still, trail]) [c.width, c.height] = [width, height];
    dirty = true;
  }
  return [w, h, ratio];
}

export function showPath() {
  if (!scene || !stage || !canvas.clientWidth) return;
  const [w, h, ratio] = sized(), look = camera(view, w, h);
  rescale();
  if (dirty) {
    readTheme();
    drawn = 0;
    layer(trail, ratio);
    const pen = layer(still, ratio), z = scene.arm ? 0 : stage.low[2] - 0.08 * stage.radius;
    const room = 0.3 * stage.radius;
    const base = { low: add(stage.low, [room, room, 0], -1), high: add(stage.high, [room, room, 0]), radius: stage.radius };
    const step = floorSquares(pen, look, base, z, theme.floor);
    put(part("path-grid"), step >= 1000 ? `${step / 1000} m` : `${step} mm`);
    for (const { rapid, points } of plan) {
      pen.setLineDash(rapid ? [3, 4] : []);
      stroke(pen, points.map(look), rapid ? theme.rapid : theme.plan, rapid ? 1 : 1.3);
    }
    pen.setLineDash([]);
    triad(pen, view, h, AXES);
    dirty = false;
  }
  trailOn(look, ratio);
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.clearRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(still, 0, 0);
  pen.drawImage(trail, 0, 0);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  if (part("path-machine").checked && tool) machineOn(look);
  if (tool) toolOn(look(tool));
  tellError();
}

function layer(image, ratio) {
  const pen = image.getContext("2d");
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.clearRect(0, 0, image.width, image.height);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  return pen;
}

// The scale of the errors grows in round steps, and then all is coloured anew.
function rescale() {
  if (!(largest > scale)) return;
  scale = [1, 2, 2.5, 5].map((f) => f * round125(largest)).find((s) => s >= largest);
  dirty = true;
}

const SHADES = 24;
function trailOn(look) {
  const pen = trail.getContext("2d");
  const shade = (one) => (Number.isNaN(one.error) || !scale ? -1 : Math.round(SHADES * Math.min(1, one.error / scale)));
  while (drawn < done.length - 1) {
    const first = drawn, level = shade(done[first + 1]);
    let last = first + 1;
    while (last < done.length - 1 && shade(done[last + 1]) === level) last++;
    stroke(pen, done.slice(first, last + 1).map((d) => look(d.at)), level < 0 ? theme.done : colour(ERRORS, level / SHADES), 2.4);
    drawn = last;
  }
}

function machineOn(look) {
  const faces = scene.arm ? joints?.length && armFaces(scene.arm, joints, stage.radius / 1100, theme, tool, base) : gantryFaces(tool, stage, theme);
  if (!faces) return;
  solids.size(canvas.clientWidth, canvas.clientHeight, devicePixelRatio || 1);
  solids.faces(faces, view, look);
  solids.paint(pen, scene.arm ? 0.85 : 0.3);
}

function toolOn(tip) {
  if (!tip[3]) return;
  pen.beginPath();
  pen.arc(tip[0], tip[1], 5, 0, 2 * Math.PI);
  pen.fillStyle = theme.done;
  pen.fill();
  pen.lineWidth = 2;
  pen.strokeStyle = "#fff";
  pen.stroke();
}

const micrometres = (x) => (x >= 1 ? `${x.toFixed(2)} mm` : `${(1e3 * x).toFixed(x < 0.01 ? 1 : 0)} µm`);
function tellError() {
  part("path-scale").hidden = !scale;
  put(part("path-error"), Number.isNaN(error) ? "" : `error ${micrometres(error)}, largest ${micrometres(largest)}`);
  put(part("path-most"), scale ? micrometres(scale) : "\u2013");
}

const later = () => { dirty = moved = true; };
const { zoom, turn } = cameraControls(canvas, view, () => [0.02 * stage.radius, 40 * stage.radius], later);
canvas.addEventListener("dblclick", () => { moved = false; fit(); });
canvas.addEventListener("keydown", (event) => {
  const keys = { ArrowRight: () => turn(-20, 0), ArrowLeft: () => turn(20, 0), ArrowUp: () => turn(0, 20), ArrowDown: () => turn(0, -20),
    "+": () => zoom(0.85), "-": () => zoom(1 / 0.85), Home: () => { moved = false; fit(); } };
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
});
choice(part("path-look"), Object.entries(LOOKS).map(([key, [words]]) => [key, words]), "whole");
part("path-look").addEventListener("change", () => { moved = false; lookFrom(part("path-look").value); });
part("path-clear").addEventListener("click", () => { clear(); fit(); });
addEventListener("theme", () => { dirty = true; });
