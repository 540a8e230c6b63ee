// SPDX-License-Identifier: Apache-2.0
// Two read-outs in one map: left of the line what the first one made, right of it the second one.
"use strict";

const compared = { left: byId("compare-left"), right: byId("compare-right"), measure: byId("compare-measure"), split: byId("compare-split"),
  canvas: byId("compare-map") };

const comparedFrames = () => [compared.left, compared.right].map((list) => frames.find((frame) => frame.readout === list.value));
const readoutTitle = (frame) => catalogue.readout.find(([name]) => name === frame.readout)[1];

/** First column of the right one. */
const splitColumn = () => Math.round(compared.split.value / compared.split.max * scene.columns);

function paintComparison() {
  const [left, right] = comparedFrames();
  const isError = !scene.recorded && compared.measure.value === "error";
  const [one, two] = [left, right].map((frame) => isError ? frame.error : frame.depth);
  const first = splitColumn();
  paint(compared.canvas, one.map((value, i) => i % scene.columns < first ? value : two[i]), isError ? errorColour : depthColour);
  byId("compare-line").style.left = `${100 * first / scene.columns}%`;
  compared.split.setAttribute("aria-valuetext", `${first} columns of ${readoutTitle(left)}, ${scene.columns - first} of ${readoutTitle(right)}`);
  byId("compare-names").replaceChildren(make("span", `left: ${readoutTitle(left)}`), make("span", `right: ${readoutTitle(right)}`));
}

/** After a run; what was chosen stays where the run has it. */
function showComparison() {
  byId("compare").hidden = frames.length < 2;
  compared.measure.parentElement.hidden = scene.recorded;  // without true distances there is the depth alone
  if (byId("compare").hidden) {
    return;
  }
  [compared.left, compared.right].forEach((list, place) => {
    const before = list.value;
    list.replaceChildren(...frames.map((frame) => make("option", readoutTitle(frame), [], { value: frame.readout })));
    list.value = frames.some((frame) => frame.readout === before) ? before : frames[place === 0 ? 0 : frames.length - 1].readout;
  });
  compared.canvas.setAttribute("aria-label", "map with the first read-out on the left of the line, the second on the right");
  compared.canvas.width = scene.columns;
  compared.canvas.height = scene.rows;
  paintComparison();
}

for (const element of [compared.left, compared.right, compared.measure, compared.split]) {
  element.oninput = paintComparison;
}

/** The line follows a pressed mouse or finger; any pointer shows the pixel under it as both read it. */
compared.canvas.onpointermove = compared.canvas.onpointerdown = (event) => {
  const box = compared.canvas.getBoundingClientRect();
  const across = (event.clientX - box.left) / box.width, down = (event.clientY - box.top) / box.height;
  if (event.buttons > 0) {
    compared.canvas.setPointerCapture(event.pointerId);
    compared.split.value = across * compared.split.max;
    paintComparison();
  }
  const column = Math.floor(across * scene.columns), row = Math.floor(down * scene.rows);
  if (column >= 0 && row >= 0 && column < scene.columns && row < scene.rows) {
    const descriptions = comparedFrames().map((frame) => describePixel(frame, readoutTitle(frame))(row * scene.columns + column));
    if (event.buttons === 0) {  // the panel of the pixel would cover the line's slider
      watchPixel(column, row);
    }
    byId("compare-pixel").textContent = `Column ${column}, row ${row}: ${descriptions.join("; ")}`;
  }
};
