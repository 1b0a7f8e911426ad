// The moving picture: a machine in 3D on a canvas, with its path.
ready.push(() => page.views.forEach(machineView));

function machineView(data) {
  const root = document.getElementById(data.id);
  const canvas = root.querySelector("canvas"), pen = canvas.getContext("2d");
  const part = (name) => root.querySelector(`[data-view="${name}"]`);
  const time = numbers(data.time), tool = data.tool.map(numbers);
  const joints = data.joints && data.joints.map(numbers), base = data.base && data.base.map(numbers);
  const path = { time: numbers(data.path.time), speed: numbers(data.path.speed) };
  const xyz = data.path.point.map(numbers);
  path.point = Array.from(path.time, (_, k) => xyz.map((c) => c[k]));
  path.rapid = new Uint8Array(path.time.length);
  for (const [from, to] of data.path.rapid) path.rapid.fill(1, from, to + 1);
  const lines = data.lines.map((l) => {
    const [foot, gap] = [l.foot.map(numbers), l.gap.map(numbers)];
    return Array.from(foot[0], (_, k) => ({
      foot: foot.map((c) => c[k]), gap: gap.map((c) => c[k]) }));
  });
  const onPath = bounds(path.point);
  const size = onPath.radius || 1;
  const worked = path.point.filter((_, k) => !path.rapid[k]);
  const onWork = worked.length ? bounds(worked) : onPath;
  const whole = machineBounds();
  const first = time[0], last = time[time.length - 1];
  const STEP = 0.02; // share of the run per key
  const FLAT = 0.05; // height of strokes that are on paper, in their size
  const SMALL = 0.25; // of the machine's size: strokes that would not be legible beside it
  let now = data.begin ?? last, playing = false, stamp = 0, pending = false;
  const view = { azimuth: -0.95, elevation: 0.42, target: [0, 0, 0], distance: 1 };

  function machineBounds() {
    if (!data.arm) {
      const r = size;
      return bounds([add(onPath.low, [0.35 * r, 0.35 * r, 0.1 * r], -1),
        add(onPath.high, [0.35 * r, 0.35 * r, 0.75 * r])]);
    }
    const points = [[0, 0, 0], ...path.point];
    const stride = Math.max(1, Math.floor(time.length / 60));
    for (let k = 0; k < time.length; k += stride) {
      const stands = base ? base.map((c) => c[k]) : [0, 0, 0];
      points.push(...armPoints(data.arm, joints.map((s) => s[k])).map((p) => add(p, stands)));
    }
    for (const face of cellFaces(data.cell, [0, 0, 0])) points.push(...face.corners);
    return bounds(points);
  }

  // Faces of the machine at a time, each with a colour.
  function machine() {
    if (!data.arm) return gantryFaces(sampled(time, tool, now), onPath, theme);
    return armFaces(data.arm, sampled(time, joints, now), whole.radius / 1100, theme, sampled(time, tool, now),
      base && sampled(time, base, now));
  }

  let theme = {}, cell = [];
  function readTheme() {
    const style = getComputedStyle(root), colors = isDark() ? page.dark : {};
    const get = (name) => style.getPropertyValue(name).trim();
    const own = (list) => list.map((color) => other(color, colors));
    theme = { ...machineColours(isDark()), ink: get("--ink"), muted: get("--muted"), line: get("--floor"), accent: get("--accent"),
      colours: own(data.colours), curves: own(data.curves), rapid: other(data.rapid, colors),
      paper: isDark() ? [44, 57, 69] : [222, 228, 234] };
    cell = cellFaces(data.cell, theme.cell);
  }

  const solids = depthBuffer();

  function draw() {
    pending = false;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width) return;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const look = camera(view, width, height);
    floor(look);
    const shown = part("machine").checked, solid = part("solid").checked;
    solids.size(width, height, ratio);
    if (shown && !solid) {
      solids.faces([...cell, ...machine()], view, look);
      solids.paint(pen, 0.28);
      solids.size(width, height, ratio);
    }
    solids.faces(shown && solid ? [...paper(), ...cell, ...machine()] : paper(), view, look);
    solids.paint(pen, 1);
    paths(look);
    const factor = Number(part("magnify")?.value ?? 0);
    lines.forEach((line, j) => deviation(line, j, 10 ** factor, look));
    const tip = look(sampled(time, tool, now));
    if (tip[3]) {
      pen.beginPath();
      pen.arc(tip[0], tip[1], 4, 0, 2 * Math.PI);
      pen.fillStyle = theme.accent;
      pen.fill();
      pen.lineWidth = 1.5;
      pen.strokeStyle = "#fff";
      pen.stroke();
    }
    triad(pen, view, height, data.axes);
    part("time").textContent = `${now.toFixed(last > 100 ? 1 : 2)} s`;
    part("scrub").value = String(1000 * (now - first) / (last - first || 1));
    for (const e of root.querySelectorAll('[data-view="factor"]')) {
      e.textContent = `\u00d7 ${shownFactor(10 ** factor)}`;
    }
  }

  const shownFactor = (f) => Number(f.toPrecision(2)).toLocaleString("en");

  function floor(look) {
    const z = data.floor ?? (data.arm ? 0 : onPath.low[2] - 0.08 * size);
    const base = data.arm ? bounds([[whole.low[0], whole.low[1], 0], [whole.high[0], whole.high[1], 0]])
      : bounds([[onPath.low[0] - 0.5 * size, onPath.low[1] - 0.5 * size, z],
        [onPath.high[0] + 0.5 * size, onPath.high[1] + 0.5 * size, z]]);
    const step = floorSquares(pen, look, base, z, theme.line);
    part("grid").textContent = step >= 1000 ? `${step / 1000} m` : `${step} mm`;
  }

  // The paper under strokes that lie in a plane, but for some at which a pen comes and goes.
  function paper() {
    const [l, h] = [onWork.low, onWork.high], m = 0.12 * onWork.radius;
    const heights = worked.map((p) => p[2]).sort((a, b) => a - b);
    const [z, top] = [0.1, 0.8].map((share) => heights[Math.floor(share * heights.length)]);
    if (!heights.length || top - z > FLAT * onWork.radius || !onWork.radius) return [];
    const corners = [[l[0] - m, l[1] - m, z], [h[0] + m, l[1] - m, z], [h[0] + m, h[1] + m, z], [l[0] - m, h[1] + m, z]];
    return [{ corners, normal: [0, 0, 1], color: theme.paper, both: true, lift: -slack() / 2 }];
  }

  const slack = () => 0.004 * view.distance; // by which a line may lie in a face

  // The path: strokes by their speed, rapids thin and dashed; what is to come is faint.
  function paths(look) {
    const shown = path.point.map(look), done = before(path.time, now);
    const level = (k) => Math.round(15 * Math.min(1, path.speed[k] / (data.fastest || 1)));
    const style = (k) => (path.rapid[k] ? -1 : level(k));
    for (let a = 0; a < shown.length - 1;) {
      let b = a + 1;
      const visited = a < done;
      while (b < shown.length - 1 && style(b) === style(a) && (b < done) === visited) b++;
      const rapid = path.rapid[a], color = rapid ? theme.rapid : colour(theme.colours, level(a) / 15);
      const width = rapid ? 1.2 : visited ? 2.6 : 1.6;
      pen.setLineDash(rapid ? [3, 3] : []);
      line3d(shown.slice(a, b + 1), color, width, visited ? (lines.length ? 0.55 : 1) : 0.22);
      a = b;
    }
    pen.setLineDash([]);
  }

  function line3d(points, color, width, alpha) {
    const hides = part("machine").checked && part("solid").checked;
    for (const piece of hides ? shownPieces(points, solids, slack()) : [points]) {
      stroke(pen, piece, color, width, alpha);
    }
  }

  function deviation(line, number, factor, look) {
    line3d(line.map((p) => look(add(p.foot, p.gap, factor))), theme.curves[number % theme.curves.length], 1.4, 0.95);
  }

  function later() {
    if (!pending) { pending = true; requestAnimationFrame(draw); }
  }

  function tick(at) {
    if (!playing) return;
    const passed = Math.min((at - stamp) / 1000, 0.1);
    stamp = at;
    now += passed * Number(part("speed").value);
    if (now >= last) { now = last; play(false); }
    draw();
    requestAnimationFrame(tick);
  }

  function play(on) {
    playing = on;
    part("play").textContent = on ? "\u275a\u275a" : "\u25b6";
    part("play").setAttribute("aria-label", on ? "pause" : "play");
    if (!on) return;
    if (now >= last) now = first;
    requestAnimationFrame((at) => { stamp = at; tick(at); });
  }

  function go(to) {
    now = Math.min(Math.max(to, first), last);
    later();
  }

  const WAYS = {
    whole: () => [whole, -0.95, 0.42], path: () => [onWork, -0.95, 0.75],
    top: () => [onWork, -Math.PI / 2, Math.PI / 2 - 1e-3], front: () => [whole, -Math.PI / 2, 0.05],
    side: () => [whole, 0, 0.05],
  };
  function lookFrom(name) {
    const [what, azimuth, elevation] = WAYS[name]();
    Object.assign(view, { azimuth, elevation, target: [...what.centre],
      distance: (canvas.clientWidth < canvas.clientHeight ? 5 : what === whole ? 3.2 : 4.2) * (what.radius || 1) });
    later();
  }

  const limits = () => [0.02 * (onWork.radius || size), 40 * whole.radius];
  const { zoom, turn } = cameraControls(canvas, view, limits, later);
  canvas.addEventListener("dblclick", () => lookFrom("whole"));
  const keys = {
    " ": () => play(!playing),
    ArrowRight: (e) => (e.shiftKey ? turn(-20, 0) : go(now + STEP * (last - first))),
    ArrowLeft: (e) => (e.shiftKey ? turn(20, 0) : go(now - STEP * (last - first))),
    ArrowUp: (e) => (e.shiftKey ? turn(0, 20) : zoom(0.85)),
    ArrowDown: (e) => (e.shiftKey ? turn(0, -20) : zoom(1 / 0.85)),
    Home: () => go(first), End: () => go(last),
    "+": () => zoom(0.85), "-": () => zoom(1 / 0.85),
  };
  canvas.addEventListener("keydown", (e) => {
    if (!keys[e.key]) return;
    e.preventDefault();
    keys[e.key](e);
  });
  part("play").addEventListener("click", () => play(!playing));
  part("scrub").addEventListener("input", (e) =>
    go(first + (last - first) * Number(e.target.value) / 1000));
  part("look").addEventListener("change", (e) => lookFrom(e.target.value));
  for (const name of ["machine", "solid", "magnify"]) part(name)?.addEventListener("input", later);
  new ResizeObserver(later).observe(canvas);
  addEventListener("theme", () => { readTheme(); later(); });
  readTheme();
  // Strokes that are small beside the machine are what is to be read at first.
  const begin = data.arm && onWork.radius < SMALL * whole.radius ? "path" : "whole";
  part("look").value = begin;
  lookFrom(begin);
  // For those who write in the console, and for tests.
  root.machineView = { view, go, play, lookFrom, zoom, turn, draw };
}
