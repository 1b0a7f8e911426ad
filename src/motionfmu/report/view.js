// The moving picture: a machine in 3D on a canvas, with its path.
ready.push(() => page.views.forEach(machineView));

function machineView(data) {
  const root = document.getElementById(data.id);
  const canvas = root.querySelector("canvas"), pen = canvas.getContext("2d");
  const part = (name) => root.querySelector(`[data-view="${name}"]`);
  const time = numbers(data.time), tool = data.tool.map(numbers);
  const joints = data.joints && data.joints.map(numbers);
  const path = { time: numbers(data.path.time), speed: numbers(data.path.speed) };
  const xyz = data.path.point.map(numbers);
  path.point = Array.from(path.time, (_, k) => xyz.map((c) => c[k]));
  const lines = data.lines.map((l) => {
    const [foot, gap] = [l.foot.map(numbers), l.gap.map(numbers)];
    return Array.from(foot[0], (_, k) => ({
      foot: foot.map((c) => c[k]), gap: gap.map((c) => c[k]) }));
  });
  const onPath = bounds(path.point);
  const size = onPath.radius || 1;
  const whole = machineBounds();
  const first = time[0], last = time[time.length - 1];
  const TURN = 0.008, STEP = 0.02; // [rad per pixel], share of the run per key
  let now = last, playing = false, stamp = 0, pending = false;
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
      const p = armPose(data.arm, joints.map((s) => s[k]));
      points.push(p.shoulder, p.elbow, p.forearm, p.wrist, p.tip);
    }
    return bounds(points);
  }

  // Faces of the machine at a time, each with a colour.
  function machine() {
    const place = sampled(time, tool, now);
    const faces = [];
    const put = (made, color) => made.forEach((f) => faces.push({ ...f, color }));
    if (data.arm) {
      const p = armPose(data.arm, sampled(time, joints, now)), s = whole.radius / 1100;
      const hub = (at, axis, half, r) => put(
        tube(add(at, axis, -half * s), add(at, axis, half * s), r * s), theme.joint);
      const side = [p.turned[0][1], p.turned[1][1], p.turned[2][1]];
      const bend = times(product(p.fore, rotZ(joint(3))), [0, 1, 0]);
      put(tube([0, 0, 0], [0, 0, 40 * s], 190 * s, 190 * s, 18), theme.joint);
      put(tube([0, 0, 40 * s], p.column, 130 * s, 105 * s, 16), theme.body);
      if (Math.hypot(...add(p.shoulder, p.column, -1)) > 1) {
        put(tube(p.column, p.shoulder, 95 * s, 85 * s), theme.body);
      }
      hub(p.shoulder, side, 110, 95);
      put(tube(p.shoulder, p.elbow, 78 * s, 62 * s), theme.body);
      hub(p.elbow, side, 88, 76);
      if (Math.hypot(...add(p.forearm, p.elbow, -1)) > 1) {
        put(tube(p.elbow, p.forearm, 66 * s, 58 * s), theme.body);
      }
      put(tube(p.forearm, p.wrist, 58 * s, 36 * s), theme.body);
      hub(p.wrist, bend, 46, 40);
      put(tube(p.wrist, p.flange, 30 * s, 26 * s), theme.body);
      if (data.arm.pen > 0) put(tube(p.flange, p.tip, 9 * s, 3 * s, 8), theme.tool);
    } else {
      const { low, high } = onPath, r = size, t = 0.05 * r, top = high[2] + 0.45 * r;
      const [left, right] = [low[0] - 0.3 * r, high[0] + 0.3 * r];
      const [front, back] = [low[1] - 0.3 * r, high[1] + 0.3 * r], floor = low[2] - 0.08 * r;
      for (const x of [left, right]) {
        put(box([x - t, front, floor], [x + t, back, floor + t]), theme.joint);
        put(box([x - t, place[1] - t, floor + t], [x + t, place[1] + t, top]), theme.body);
      }
      put(box([left - t, place[1] - t, top], [right + t, place[1] + t, top + 2 * t]), theme.body);
      put(box([place[0] - 2 * t, place[1] - 2 * t, top - t],
        [place[0] + 2 * t, place[1] - t, top + 2.6 * t]), theme.joint);
      const ram = [place[0], place[1] - 1.5 * t];
      put(box([ram[0] - t, ram[1] - 0.5 * t, place[2] + 4 * t],
        [ram[0] + t, ram[1] + 1.5 * t, top + 6 * t + place[2] - high[2]]), theme.body);
      put(tube(place, [place[0], place[1], place[2] + 4 * t], 0.1 * t, 0.7 * t, 8), theme.tool);
    }
    return faces;

    function joint(i) {
      return data.arm.signs[i] * sampled(time, [joints[i]], now)[0] - data.arm.offsets[i];
    }
  }

  let theme = {};
  function readTheme() {
    const style = getComputedStyle(root), colors = isDark() ? page.dark : {};
    const get = (name) => style.getPropertyValue(name).trim();
    const own = (list) => list.map((color) => other(color, colors));
    theme = { body: [142, 160, 180], joint: isDark() ? [104, 124, 146] : [62, 80, 100], tool: [190, 40, 60],
      ink: get("--ink"), muted: get("--muted"), line: get("--floor"), accent: get("--accent"),
      colours: own(data.colours), curves: own(data.curves) };
  }

  function shade(color, normal) {
    const light = 0.62 + 0.38 * dot(normal, unit([0.35, -0.5, 0.8]));
    return `rgb(${color.map((c) => Math.round(Math.min(255, c * (0.45 + 0.62 * light)))).join(",")})`;
  }

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
    const items = pathItems(look);
    const factor = Number(part("magnify")?.value ?? 0);
    lines.forEach((line, j) => items.push(...deviation(line, j, 10 ** factor, look)));
    if (part("machine").checked) items.push(...machineItems(look));
    items.sort((a, b) => b.depth - a.depth).forEach((item) => item.draw());
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
    triad(width, height);
    part("time").textContent = `${now.toFixed(last > 100 ? 1 : 2)} s`;
    part("scrub").value = String(1000 * (now - first) / (last - first || 1));
    for (const e of root.querySelectorAll('[data-view="factor"]')) {
      e.textContent = `\u00d7 ${shownFactor(10 ** factor)}`;
    }
  }

  const shownFactor = (f) => Number(f.toPrecision(2)).toLocaleString("en");

  function stroke(points, color, width, alpha = 1) {
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

  function floor(look) {
    const z = data.arm ? 0 : onPath.low[2] - 0.08 * size;
    const base = data.arm ? bounds([[whole.low[0], whole.low[1], 0], [whole.high[0], whole.high[1], 0]])
      : bounds([[onPath.low[0] - 0.5 * size, onPath.low[1] - 0.5 * size, z],
        [onPath.high[0] + 0.5 * size, onPath.high[1] + 0.5 * size, z]]);
    const step = round125(Math.max(base.radius, 1e-9) / 4);
    const from = base.low.map((x) => Math.floor(x / step) * step);
    const to = base.high.map((x) => Math.ceil(x / step) * step);
    const cut = (a, b) => Array.from({ length: 9 }, (_, k) => look(add(a, add(b, a, -1), k / 8)));
    for (let x = from[0]; x <= to[0] + step / 2; x += step) {
      stroke(cut([x, from[1], z], [x, to[1], z]), theme.line, 1);
    }
    for (let y = from[1]; y <= to[1] + step / 2; y += step) {
      stroke(cut([from[0], y, z], [to[0], y, z]), theme.line, 1);
    }
    part("grid").textContent = step >= 1000 ? `${step / 1000} m` : `${step} mm`;
    // The paper under a flat path.
    const thick = onPath.high[2] - onPath.low[2];
    if (thick < 0.02 * size) {
      const m = 0.12 * size, [l, h] = [onPath.low, onPath.high];
      const sheet = [[l[0] - m, l[1] - m], [h[0] + m, l[1] - m], [h[0] + m, h[1] + m],
        [l[0] - m, h[1] + m]].map(([x, y]) => look([x, y, l[2]]));
      if (sheet.every((p) => p[3])) {
        pen.beginPath();
        sheet.forEach((p, k) => (k ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1])));
        pen.closePath();
        pen.fillStyle = theme.line;
        pen.globalAlpha = 0.45;
        pen.fill();
        pen.globalAlpha = 1;
      }
    }
  }

  // The path in pieces of one colour, so that the machine may stand before and behind it.
  function pathItems(look) {
    const items = [], shown = path.point.map(look), done = before(path.time, now);
    const level = (k) => Math.round(15 * (path.speed[k] / (data.fastest || 1)));
    const faded = lines.length ? 0.55 : 1;
    for (let a = 0; a < shown.length - 1;) {
      let b = a + 1;
      const visited = a < done;
      while (b < shown.length - 1 && b - a < 24 && level(b) === level(a) && (b < done) === visited) b++;
      const piece = shown.slice(a, b + 1);
      const color = colour(theme.colours, level(a) / 15);
      items.push({ depth: piece[piece.length >> 1][2],
        draw: () => stroke(piece, color, visited ? 2.6 : 1.6, visited ? faded : 0.22) });
      a = b;
    }
    return items;
  }

  function deviation(line, number, factor, look) {
    const shown = line.map((p) => look(add(p.foot, p.gap, factor)));
    const color = theme.curves[number % theme.curves.length], items = [];
    for (let a = 0; a < shown.length - 1; a += 12) {
      const piece = shown.slice(a, a + 13);
      items.push({ depth: piece[piece.length >> 1][2] - 1e-3 * size,
        draw: () => stroke(piece, color, 1.4, 0.95) });
    }
    return items;
  }

  function machineItems(look) {
    const items = [];
    const alpha = part("solid").checked ? 1 : 0.28;
    const eye = [Math.cos(view.elevation) * Math.cos(view.azimuth),
      Math.cos(view.elevation) * Math.sin(view.azimuth), Math.sin(view.elevation)];
    const from = add(view.target, eye, view.distance);
    for (const face of machine()) {
      const middle = face.corners.reduce((s, p) => add(s, p, 1 / face.corners.length), [0, 0, 0]);
      if (dot(face.normal, add(from, middle, -1)) <= 0) continue;
      const shown = face.corners.map(look);
      if (!shown.every((p) => p[3])) continue;
      const color = shade(face.color, face.normal);
      items.push({ depth: look(middle)[2], draw: () => {
        pen.beginPath();
        shown.forEach((p, k) => (k ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1])));
        pen.closePath();
        pen.globalAlpha = alpha;
        pen.fillStyle = pen.strokeStyle = color;
        pen.lineWidth = 0.7;
        pen.fill();
        if (alpha === 1) pen.stroke();
        pen.globalAlpha = 1;
      } });
    }
    return items;
  }

  function triad(width, height) {
    const look = camera({ ...view, target: [0, 0, 0], distance: 9 }, 120, 120);
    const move = (p) => [p[0] - 10, height - 110 + p[1], p[2], true];
    const origin = move(look([0, 0, 0]));
    ["X", "Y", "Z"].forEach((name, i) => {
      const end = [0, 0, 0];
      end[i] = 1;
      const tip = move(look(end)), text = move(look(end.map((x) => 1.35 * x)));
      stroke([origin, tip], data.axes[i], 2);
      pen.fillStyle = data.axes[i];
      pen.font = "600 12px sans-serif";
      pen.textAlign = "center";
      pen.textBaseline = "middle";
      pen.fillText(name, text[0], text[1]);
    });
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
    whole: () => [whole, -0.95, 0.42], path: () => [onPath, -0.95, 0.75],
    top: () => [onPath, -Math.PI / 2, Math.PI / 2 - 1e-3], front: () => [whole, -Math.PI / 2, 0.05],
    side: () => [whole, 0, 0.05],
  };
  function lookFrom(name) {
    const [what, azimuth, elevation] = WAYS[name]();
    Object.assign(view, { azimuth, elevation, target: [...what.centre],
      distance: (canvas.clientWidth < canvas.clientHeight ? 4 : 3.2) * (what.radius || 1) });
    later();
  }

  function zoom(factor) {
    view.distance = Math.min(Math.max(view.distance * factor, 0.02 * size), 40 * whole.radius);
    later();
  }

  function turn(dx, dy) {
    view.azimuth -= TURN * dx;
    view.elevation = Math.min(Math.max(view.elevation + TURN * dy, -1.55), 1.57);
    later();
  }

  function shift(dx, dy) {
    const [ca, sa] = [Math.cos(view.azimuth), Math.sin(view.azimuth)];
    const [ce, se] = [Math.cos(view.elevation), Math.sin(view.elevation)];
    const scale = view.distance / (1.9 * Math.min(canvas.clientWidth, canvas.clientHeight));
    view.target = add(view.target, [sa, -ca, 0], scale * dx);
    view.target = add(view.target, [-se * ca, -se * sa, ce], scale * dy);
    later();
  }

  // One pointer turns, with shift or the right button moves; two pinch.
  const down = new Map();
  const apart = () => { const [a, b] = [...down.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
  canvas.addEventListener("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({ preventScroll: true });
    down.set(e.pointerId, { x: e.clientX, y: e.clientY });
  });
  canvas.addEventListener("pointermove", (e) => {
    const at = down.get(e.pointerId);
    if (!at) return;
    const wide = down.size === 2 ? apart() : 0;
    const [dx, dy] = [e.clientX - at.x, e.clientY - at.y];
    Object.assign(at, { x: e.clientX, y: e.clientY });
    if (wide) { zoom(wide / Math.max(apart(), 1)); shift(dx / 2, dy / 2); }
    else if (e.shiftKey || e.buttons & 6) shift(dx, dy);
    else turn(dx, dy);
  });
  for (const gone of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(gone, (e) => down.delete(e.pointerId));
  }
  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  // The wheel scrolls the page until the picture has been clicked.
  canvas.addEventListener("wheel", (e) => {
    if (document.activeElement !== canvas) return;
    e.preventDefault();
    zoom(Math.exp(0.0015 * e.deltaY));
  }, { passive: false });
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
  lookFrom("whole");
  // For those who write in the console, and for tests.
  root.machineView = { view, go, play, lookFrom, zoom, turn, draw };
}
