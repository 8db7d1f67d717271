#include "validation/report_script.h"

namespace scc::validation {

const char* const report_script = R"js("use strict";
(() => {
const differenceScale = 1024;
function halves(text) {
  const bytes = atob(text), values = new Float32Array(bytes.length / 2);
  for (let i = 0; i < values.length; ++i) {
    const h = bytes.charCodeAt(2 * i) | bytes.charCodeAt(2 * i + 1) << 8;
    const e = h >> 10 & 31, m = h & 1023, s = h & 32768 ? -1 : 1;
    values[i] = s * (e === 31 ? Infinity : e === 0 ? m * 2 ** -24 : (1024 + m) * 2 ** (e - 25));
  }
  return values;
}
function srgb(v) {
  v = Math.min(Math.max(v, 0), 1);
  return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
}
// Errors of 1e-7 and below are black, of 1 and above white.
const stops = [[0, 0, 0], [40, 0, 120], [190, 20, 90], [250, 130, 10], [250, 230, 60], [255, 255, 255]];
function heat(error) {
  const p = Math.min(Math.max((Math.log10(error) + 7) / 7, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(p), stops.length - 2);
  return stops[i].map((c, k) => c + (p - i) * (stops[i + 1][k] - c));
}
function element(parent, name, properties) {
  return parent.appendChild(Object.assign(document.createElement(name), properties));
}
function shown(values) { return values.map(v => v.toPrecision(4)).join(" "); }

function openViewer(viewer) {
  const width = +viewer.dataset.width, height = +viewer.dataset.height, block = +viewer.dataset.block;
  const reference = halves(document.getElementById(viewer.dataset.reference).textContent);
  const difference = halves(viewer.dataset.difference).map(v => v / differenceScale);
  const bar = element(viewer, "div", {className: "bar"});
  const mode = element(bar, "select", {title: "what is shown"});
  for (const name of ["wipe", "flip", "difference"]) element(mode, "option", {textContent: name});
  const wipe = element(bar, "input", {type: "range", min: 0, max: width, value: width / 2, title: "where the other begins"});
  const flip = element(bar, "button", {type: "button", textContent: "flip"});
  const zoom = element(bar, "select", {title: "zoom"});
  for (const z of [1, 2, 4, 8, 16]) element(zoom, "option", {textContent: z + "x", value: z});
  zoom.value = width <= 160 ? 4 : width <= 320 ? 2 : 1;
  const readout = element(bar, "output", {textContent: "point at a pixel"});
  const scale = element(viewer, "div", {className: "heat"});
  for (let e = -7; e <= 0; ++e) {
    const label = element(scale, "b", {textContent: "1e" + e});
    const c = heat(10 ** e).map(Math.round);
    label.style.background = "rgb(" + c + ")";
    label.style.color = e < -2 ? "#fff" : "#000";
  }
  const frame = element(viewer, "div", {className: "frame"});
  const canvas = element(frame, "canvas", {width, height});
  const context = canvas.getContext("2d"), picture = context.createImageData(width, height);
  let other = true;
  function draw() {
    for (let i = 0; i < width * height; ++i) {
      const at = [3 * i, 3 * i + 1, 3 * i + 2];
      const showOther = mode.value === "flip" ? other : i % width >= +wipe.value;
      const color = mode.value === "difference" ? heat(Math.max(...at.map(k => Math.abs(difference[k]))))
          : at.map(k => srgb(reference[k] + (showOther ? difference[k] : 0)));
      picture.data.set([...color, 255], 4 * i);
    }
    context.putImageData(picture, 0, 0);
    canvas.style.width = width * +zoom.value + "px";
    wipe.hidden = mode.value !== "wipe";
    flip.hidden = mode.value !== "flip";
    flip.textContent = other ? "shows the other: flip" : "shows the reference: flip";
    scale.hidden = mode.value !== "difference";
  }
  for (const control of [mode, wipe, zoom]) control.addEventListener("input", draw);
  flip.addEventListener("click", () => { other = !other; draw(); });
  canvas.addEventListener("mousemove", event => {
    const x = Math.floor(event.offsetX / +zoom.value), y = Math.floor(event.offsetY / +zoom.value);
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    const at = [0, 1, 2].map(c => 3 * (y * width + x) + c);
    readout.textContent = "(" + x * block + ", " + y * block + ")" + (block > 1 ? " and its block" : "") + ": reference " +
        shown(at.map(k => reference[k])) + ", other " + shown(at.map(k => reference[k] + difference[k])) +
        ", difference " + shown(at.map(k => difference[k]));
  });
  draw();
}
for (const viewer of document.querySelectorAll(".viewer")) {
  const button = element(viewer, "button", {type: "button", textContent: "compare: wipe, flip, difference, zoom"});
  button.addEventListener("click", () => { button.remove(); openViewer(viewer); });
}

function key(row, column) {
  const text = row.cells[column] ? row.cells[column].textContent : "", number = parseFloat(text);
  return text === "\u221e" ? Infinity : isNaN(number) ? text : number;
}
function order(a, b) {
  if (typeof a === typeof b) return a < b ? -1 : a > b ? 1 : 0;
  return typeof a === "number" ? -1 : 1;
}
for (const table of document.querySelectorAll("table.sortable"))
  [...table.rows[0].cells].forEach((head, column) => head.addEventListener("click", () => {
    const sign = head.dataset.sorted === "up" ? -1 : 1;
    for (const other of table.rows[0].cells) delete other.dataset.sorted;
    head.dataset.sorted = sign > 0 ? "up" : "down";
    const rows = [...table.rows].slice(1).sort((a, b) => sign * order(key(a, column), key(b, column)));
    rows.forEach(row => row.parentNode.appendChild(row));
  }));
})();
)js";

} // namespace scc::validation
