// SPDX-License-Identifier: Apache-2.0
// The timestamps of the pixel under the mouse as a histogram that grows over the frame, with the true distance and what each read-out
// made of them.
"use strict";

const BARS = 128;
const STEPS = 64, POOL_STEPS = 24;  // of a trace; a pool read-out reads a whole engine for each
const CELLS = 128;  // of candidates, over the range
const FEWEST_PIXELS = 48;  // of a phase that has its name above the trace
const watched = { ready: false, pixel: null, next: null, waiting: false, counts: [], states: [], trace: 0 };

/** Values of a pixel as `describe` has them, and its panel. */
function showPixel(column, row, describe) {
  [byId("pick-column").value, byId("pick-row").value] = [column, row];
  byId("pixel").textContent = `Column ${column}, row ${row}: ${describe(row * scene.columns + column)}`;
  watchPixel(column, row);
}

/** The pixel whose column and row are entered, as the read-out of the trace reads it. */
function pickPixel() {
  const [column, row] = [byId("pick-column"), byId("pick-row")];
  if (column.value !== "" && row.value !== "" && column.validity.valid && row.validity.valid) {
    const frame = frames[tracedFrame()];
    showPixel(Number(column.value), Number(row.value), describePixel(frame, readoutTitle(frame)));
  }
}

byId("pick-column").oninput = byId("pick-row").oninput = pickPixel;

/** Asks the models for a pixel; the last one that was pointed at while they were busy comes next. */
function watchPixel(column, row) {
  if (!watched.ready) {
    return;
  }
  watched.next = { column, row };
  askPixel();
}

function askPixel() {
  if (!watched.waiting && watched.next) {
    watched.waiting = true;
    watched.trace += 1;  // what comes of the last pixel is too late
    worker.postMessage({ what: "pixel", ...watched.next });
    watched.next = null;
  }
}

/** After a run nothing is known of its pixels yet. */
function forgetPixel() {
  stopPlaying();
  Object.assign(watched, { pixel: null, next: null, waiting: false, counts: [], states: [], trace: watched.trace + 1 });
  byId("watch").hidden = true;
  [byId("pick-column").max, byId("pick-row").max] = [scene.columns - 1, scene.rows - 1];
  const list = byId("trace-readout"), before = list.value;
  list.replaceChildren(...frames.map((frame) => make("option", readoutTitle(frame), [], { value: frame.readout })));
  list.value = frames.some((frame) => frame.readout === before) ? before : frames[0].readout;
}

hear.pixel = (message) => {
  watched.waiting = false;
  watched.pixel = message;
  byId("watch").hidden = false;
  paintPixel();
  askPixel();
  startTrace();
};

// ---- The state of a read-out over the acquisitions ------------------------------------------------------------------

function startTrace() {
  watched.trace += 1;
  watched.states = [];
  paintTrace();
  askState();
}

const tracedFrame = () => frames.findIndex((frame) => frame.readout === byId("trace-readout").value);
const isPool = () => byId("trace-readout").value.startsWith("pool");
const steps = () => Math.min(isPool() ? POOL_STEPS : STEPS, watched.pixel.acquisitions);

/** One at a time, so that another pixel need not wait for all of them. */
function askState() {
  if (watched.pixel && !watched.waiting && watched.states.length < steps()) {
    const until = Math.round(watched.pixel.acquisitions * (watched.states.length + 1) / steps());
    worker.postMessage({ what: "state", readout: tracedFrame(), until, number: watched.trace });
  }
}

hear.state = (message) => {
  if (message.number === watched.trace) {
    watched.states.push(message);
    paintTrace();
    askState();
  }
};

/** The state at the time that the slider has: the last one not after it. */
function stateNow() {
  const until = untilNow();
  return watched.states.filter((state) => state.until <= until).at(-1);
}

function paintTrace() {
  const { acquisitions, codes, column, row } = watched.pixel;
  const truth = scene.truth[row * scene.columns + column];
  const canvas = byId("trace"), context = canvas.getContext("2d"), style = getComputedStyle(canvas);
  const range = Number(sensor()[5]);
  const x = (acquisition) => acquisition / acquisitions * canvas.width, y = (share) => canvas.height * (1 - share);
  const rectangle = (colour, left, top, width, height) => {
    context.fillStyle = colour;
    context.fillRect(left, top, width, height);
  };
  context.clearRect(0, 0, canvas.width, canvas.height);
  const step = acquisitions / steps();
  watched.states.forEach(({ until, candidates }) => {
    const highest = Math.max(...candidates.map(({ score }) => score), 1);
    candidates.forEach(({ cell, score }) => {
      context.globalAlpha = 0.25 + 0.75 * score / highest;
      rectangle(style.getPropertyValue("--quiet"), x(until - step) + 1, y((cell + 2) / CELLS), x(step) - 2, 4 / CELLS * canvas.height);
    });
  });
  context.globalAlpha = 1;
  const phases = frames[tracedFrame()].phases;
  phases.slice(0, -1).forEach(({ end }) => {
    context.globalAlpha = 0.5;
    rectangle(style.getPropertyValue("--text"), Math.round(x(end)) - 1, 0, 2, canvas.height);
    context.globalAlpha = 1;
  });
  const stairs = (colour, height, value) => watched.states.forEach((state) =>
    rectangle(colour, x(state.until - step), y(value(state) / codes) - height / 2, x(step), height));
  if (isPool()) {
    stairs(style.getPropertyValue("--warn"), 2, (state) => state.rival);
  }
  stairs(style.getPropertyValue("--accent"), 4, (state) => state.position);
  rectangle(style.getPropertyValue("--text"), x(untilNow()) - 1, 0, 2, canvas.height);
  if (!Number.isNaN(truth)) {
    context.globalAlpha = 0.3;
    rectangle(style.getPropertyValue("--text"), 0, y((truth + pulseMetres()) / range) - 1, canvas.width, 2);
    context.globalAlpha = 1;
  }
  byId("trace-up").replaceChildren(...upward(place(0), "distance", place(1)));
  byId("trace-ends").replaceChildren(make("span", "0"), make("span", "acquisitions"), make("span", `${acquisitions}`));
  byId("trace-busy").textContent = watched.states.length < steps() ? `step ${watched.states.length + 1} of ${steps()} ...` : "";
  const now = stateNow();
  byId("trace-phases").replaceChildren(...phases.map(({ end, name }, i) => {
    const share = (end - (i === 0 ? 0 : phases[i - 1].end)) / acquisitions;
    return make("span", share * canvas.clientWidth < FEWEST_PIXELS ? "" : name, [],
      { style: `width: ${100 * share}%`, title: `${name}, ends at acquisition ${end}` });
  }));
  const known = !now ? "" : `After ${now.until} acquisitions: at ${placeOfCode(now.position)} (code ${Number(now.position.toFixed(2))}), confidence ` +
    `${now.confidence}${isPool() ? `, rival at ${placeOfCode(now.rival)}; candidates (score): ${now.candidates.map(({ cell, score }) =>
      `${place(cell / CELLS)} (${score})`).join(", ")}` : ""}. `;
  byId("trace-says").textContent = `${known}Blue: the result if no more light came from there on${
    isPool() ? "; grey: candidates, the darker the higher their score; red: the rival" : ""}${Number.isNaN(truth) ? "" : "; thin line across: the true distance"}.`;
}

/** Metres by which a scene's echo is later than its distance, because Eq. 3.11 subtracts the pulse's width; recordings have no such width. */
const pulseMetres = () => scene.recorded ? 0 : Number(sensor()[9]);
/** Distance of a part of the range, as text. */
const place = (share) => `${(share * Number(sensor()[5]) - pulseMetres()).toFixed(2)} m`;
/** Distance of a position in codes, whose middle counts. */
const placeOfCode = (position) => place((position + 0.5) / watched.pixel.codes);

/** The labels of an axis that goes up. */
const upward = (least, title, most) => [make("span", most), make("span", title, [], { class: "title" }), make("span", least)];

/** Acquisitions of the frame up to the slider. */
const untilNow = () => Math.round(watched.pixel.acquisitions * byId("watch-time").value / byId("watch-time").max);

// ---- Timestamps -----------------------------------------------------------------------------------------------------

function paintPixel() {
  const { column, row, acquisition, timestamp, acquisitions, codes } = watched.pixel;
  const until = untilNow();
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
  const style = getComputedStyle(canvas);
  const highest = Math.max(...counts, 1);
  const wide = canvas.width / counts.length;
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = style.getPropertyValue("--quiet");
  counts.forEach((count, i) => context.fillRect(i * wide, canvas.height * (1 - count / highest), wide - 1, canvas.height * count / highest));
  const line = (share, colour) => {
    context.fillStyle = colour;
    context.fillRect(share * canvas.width - 1, 0, 3, canvas.height);
  };
  const marks = frames.filter((frame) => !Number.isNaN(frame.depth[index])).map((frame) => [(frame.results[4 * index] + 0.5) / codes, cost.readouts[frame.readout]?.colour ?? "#555555", readoutTitle(frame)]);
  if (!Number.isNaN(scene.truth[index])) {
    marks.push([(scene.truth[index] + pulseMetres()) / range, style.getPropertyValue("--text"), "true distance"]);
  }
  marks.forEach(([share, colour]) => line(share, colour));
  byId("watch-marks").replaceChildren("Lines in the histogram: what each read-out made of the whole frame. ", ...marks.map(([, colour, title]) =>
    make("span", "", [make("b", "\u25ae", [], { style: `color: ${colour}` }), ` ${title}`])));
  byId("watch-says").textContent = `Column ${column}, row ${row}: ${seen} timestamps in the first ${until} of ${acquisitions} acquisitions`;
  byId("watch-until").value = `${until} of ${acquisitions}`;
  byId("watch-up").replaceChildren(...upward("0", "events a bar", `${highest}`));
  byId("watch-ends").replaceChildren(make("span", place(0)), make("span", "distance of a timestamp"), make("span", place(1)));
}

byId("watch-time").oninput = () => {
  paintPixel();
  paintTrace();
};
byId("trace-readout").oninput = startTrace;

// ---- The frame as it goes on ----------------------------------------------------------------------------------------

const PLAY_MS = 4000, PLAY_STEP_MS = 50;  // of a whole frame, and between two of its pictures
let playing = 0;  // the timer; 0: none

function stopPlaying() {
  clearInterval(playing);
  playing = 0;
  byId("watch-play").textContent = "play the frame";
}

/** Moves the slider from the frame's begin, or from where it stopped, to the end. */
function play() {
  const time = byId("watch-time");
  time.value = time.value === time.max ? 0 : time.value;
  byId("watch-play").textContent = "stop";
  playing = setInterval(() => {
    time.value = Number(time.value) + time.max * PLAY_STEP_MS / PLAY_MS;
    time.oninput();
    if (time.value === time.max) {
      stopPlaying();
    }
  }, PLAY_STEP_MS);
}

byId("watch-play").onclick = () => playing === 0 ? play() : stopPlaying();

function closePixel() {
  stopPlaying();
  byId("watch").hidden = true;
}

byId("watch-close").onclick = closePixel;
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") {
    closePixel();
  }
});
