// SPDX-License-Identifier: Apache-2.0
// The timestamps of the pixel under the mouse as a histogram that grows over the frame, with the true distance and what each read-out
// made of them.
"use strict";

const BARS = 128;
const watched = { pixel: null, next: null, waiting: false, counts: [] };

/** Asks the models for a pixel; the last one that was pointed at while they were busy comes next. */
function watchPixel(column, row) {
  if (document.body.dataset.state !== "done") {
    return;
  }
  watched.next = { column, row };
  askPixel();
}

function askPixel() {
  if (!watched.waiting && watched.next) {
    watched.waiting = true;
    worker.postMessage({ what: "pixel", ...watched.next });
    watched.next = null;
  }
}

/** After a run nothing is known of its pixels yet. */
function forgetPixel() {
  Object.assign(watched, { pixel: null, next: null, waiting: false, counts: [] });
  byId("watch").hidden = true;
}

hear.pixel = (message) => {
  watched.waiting = false;
  watched.pixel = message;
  byId("watch").hidden = false;
  paintPixel();
  askPixel();
};

function paintPixel() {
  const { column, row, acquisition, timestamp, acquisitions, codes } = watched.pixel;
  const time = byId("watch-time");
  const until = Math.round(acquisitions * time.value / time.max);
  const counts = Array(Math.min(BARS, codes)).fill(0);
  let seen = 0;
  acquisition.forEach((when, i) => {
    if (when < until) {
      counts[Math.floor(timestamp[i] * counts.length / codes)] += 1;
      seen += 1;
    }
  });
  watched.counts = counts;
  const index = row * scene.columns + column;
  const range = Number(sensor()[5]);
  const canvas = byId("watch-histogram");
  const context = canvas.getContext("2d");
  const style = getComputedStyle(document.body);
  const highest = Math.max(...counts, 1);
  const wide = canvas.width / counts.length;
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = style.getPropertyValue("--quiet");
  counts.forEach((count, i) => context.fillRect(i * wide, canvas.height * (1 - count / highest), wide - 1, canvas.height * count / highest));
  const line = (share, colour) => {
    context.fillStyle = colour;
    context.fillRect(share * canvas.width - 1, 0, 3, canvas.height);
  };
  const marks = frames.filter((frame) => !Number.isNaN(frame.depth[index])).map((frame) => [frame.results[4 * index] / codes, cost.readouts[frame.readout]?.colour ?? "#555555", readoutTitle(frame)]);
  if (!Number.isNaN(scene.truth[index])) {
    marks.push([scene.truth[index] / range, style.getPropertyValue("--text"), "true distance"]);
  }
  marks.forEach(([share, colour]) => line(share, colour));
  byId("watch-marks").replaceChildren("Lines: what each read-out made of the whole frame. ", ...marks.map(([, colour, title]) =>
    make("span", `\u25ae ${title}`, [], { style: `color: ${colour}` })));
  byId("watch-says").textContent = `Column ${column}, row ${row}: ${seen} timestamps in the first ${until} of ${acquisitions} acquisitions`;
  byId("watch-until").value = `${until} of ${acquisitions}`;
  byId("watch-ends").replaceChildren(make("span", "0 m"), make("span", `${(range / 2).toFixed(2)} m`), make("span", `${range.toFixed(2)} m`));
}

byId("watch-time").oninput = paintPixel;
byId("watch-close").onclick = () => { byId("watch").hidden = true; };
