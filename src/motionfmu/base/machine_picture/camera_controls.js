"use strict";
// How a picture in 3D is turned, moved and zoomed: by mouse, fingers, wheel.
// sizes() gives the least and the largest distance of the camera.
function cameraControls(canvas, view, sizes, later) {
  const TURN = 0.008; // [rad per pixel]
  const controls = { zoom, turn, shift };

  function zoom(factor) {
    const [least, largest] = sizes();
    view.distance = Math.min(Math.max(view.distance * factor, least), largest);
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
  return controls;
}
