// SPDX-License-Identifier: BSD-3-Clause
// Zooms and moves the figures of a page by their viewBox. Only the selected figure answers to the wheel, so that a page
// can be scrolled past its figures.
"use strict";
for (const figure of document.querySelectorAll("svg.zoom")) {
  const whole = figure.getAttribute("viewBox").split(/\s+/).map(Number);
  const fingers = new Map();
  let view = [...whole];

  const show = () => {
    figure.setAttribute("viewBox", view.join(" "));
    figure.classList.toggle("near", view[2] < whole[2]);
  };
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
  const place = (x, y) => { // of the screen in units of the figure
    const point = new DOMPoint(x, y).matrixTransform(figure.getScreenCTM().inverse());
    return [point.x, point.y];
  };
  const keepInside = () => {
    for (const k of [0, 1]) view[k] = clamp(view[k], whole[k], whole[k] + whole[k + 2] - view[k + 2]);
  };
  const zoom = (factor, [x, y]) => { // about a place that stays where it is
    const width = clamp(view[2] / factor, whole[2] / 40, whole[2]), share = width / view[2];
    view = [x - (x - view[0]) * share, y - (y - view[1]) * share, width, view[3] * share];
    keepInside();
    show();
  };
  const move = (dx, dy) => {
    view = [view[0] + dx, view[1] + dy, view[2], view[3]];
    keepInside();
    show();
  };
  const reset = () => { view = [...whole]; show(); };
  const middle = () => [view[0] + view[2] / 2, view[1] + view[3] / 2];

  figure.addEventListener("wheel", event => {
    if (document.activeElement !== figure) return;
    event.preventDefault();
    zoom(Math.exp(-clamp(event.deltaY, -100, 100) / 400), place(event.clientX, event.clientY));
  }, { passive: false });
  figure.addEventListener("dblclick", reset);
  figure.addEventListener("pointerdown", event => {
    figure.focus({ preventScroll: true });
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (view[2] < whole[2] || fingers.size > 1) figure.setPointerCapture(event.pointerId);
  });
  figure.addEventListener("pointermove", event => {
    if (!fingers.has(event.pointerId)) return;
    const before = [...fingers.values()], others = [...fingers].filter(([id]) => id !== event.pointerId);
    const was = fingers.get(event.pointerId), now = [event.clientX, event.clientY];
    fingers.set(event.pointerId, now);
    if (others.length === 1) {
      const other = others[0][1], length = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
      zoom(length(now, other) / Math.max(length(was, other), 1), place((now[0] + other[0]) / 2, (now[1] + other[1]) / 2));
    } else if (before.length === 1 && view[2] < whole[2]) {
      const from = place(...was), to = place(...now);
      move(from[0] - to[0], from[1] - to[1]);
    }
  });
  for (const name of ["pointerup", "pointercancel"])
    figure.addEventListener(name, event => fingers.delete(event.pointerId));
  figure.addEventListener("touchmove", event => { // two fingers belong to the figure, one scrolls the page
    if (event.touches.length > 1) event.preventDefault();
  }, { passive: false });
  figure.addEventListener("keydown", event => {
    const step = view[2] / 8;
    const keys = { "+": () => zoom(1.25, middle()), "=": () => zoom(1.25, middle()), "-": () => zoom(0.8, middle()),
                   "0": reset, ArrowLeft: () => move(-step, 0), ArrowRight: () => move(step, 0),
                   ArrowUp: () => move(0, -step), ArrowDown: () => move(0, step) };
    const scrolls = event.key.startsWith("Arrow") && view[2] >= whole[2];
    if (!(event.key in keys) || scrolls || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  });
}
