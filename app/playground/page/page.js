// SPDX-License-Identifier: Apache-2.0
"use strict";

const LARGEST_ERROR_M = 0.25;  // of the colours, as in the pictures of `dtof frame`
const SIZES = [1, 2, 4];  // parts of the sensor's columns and rows

const byId = (id) => document.getElementById(id);
const form = byId("controls");
const cost = JSON.parse(byId("cost").textContent);
const catalogue = { readout: [], scene: [], sensor: [], figure: [] };

let worker = null;
let asking = false;  // the worker was asked; each works for one run
let scene = null;  // what it said of its scene
let frames = [];
let begun = 0;

/** An element with a text and children. */
function make(tag, text = "", children = [], attributes = {}) {
  const element = document.createElement(tag);
  element.textContent = text;
  element.append(...children);
  for (const [name, value] of Object.entries(attributes)) {
    element.setAttribute(name, value);
  }
  return element;
}

// ---- Colours: those of the pictures that C++ draws ----------------------------------------------------------------

function viridis(position) {
  const coefficients = [
    [0.2777273272234177, 0.005407344544966578, 0.3340998053353061],
    [0.1050930431085774, 1.404613529898575, 1.384590162594685],
    [-0.3308618287255563, 0.214847559468213, 0.09509516302823659],
    [-4.634230498983486, -5.799100973351585, -19.33244095627987],
    [6.228269936347081, 14.17993336680509, 56.69055260068105],
    [4.776384997670288, -13.74514537774601, -65.35303263337234],
    [-5.435455855934631, 4.645852612178535, 26.3124352495832]];
  const t = Math.min(Math.max(position, 0), 1);
  return [0, 1, 2].map((channel) => 255 * coefficients.reduceRight((sum, c) => sum * t + c[channel], 0));
}

function blueWhiteRed(position) {
  const nodes = [[5, 48, 97], [67, 147, 195], [247, 247, 247], [214, 96, 77], [103, 0, 31]];
  const scaled = Math.min(Math.max(position, 0), 1) * 4;
  const node = Math.min(Math.floor(scaled), 3);
  return nodes[node].map((from, channel) => from + (nodes[node + 1][channel] - from) * (scaled - node));
}

const grey = (position) => Array(3).fill(255 * position);
const UNKNOWN = [128, 128, 128];

function paint(canvas, values, colour) {
  const context = canvas.getContext("2d");
  const image = context.createImageData(canvas.width, canvas.height);
  values.forEach((value, i) => {
    const [red, green, blue] = Number.isNaN(value) ? UNKNOWN : colour(value);
    image.data.set([red, green, blue, 255], 4 * i);
  });
  context.putImageData(image, 0, 0);
}

const ramp = Array.from({ length: 256 }, (_, i) => i / 255);
const errorColour = (error) => blueWhiteRed(0.5 + 0.5 * error / LARGEST_ERROR_M);
const depthColour = (depth) => viridis((depth - scene.near) / (scene.far - scene.near));

// ---- Controls -------------------------------------------------------------------------------------------

function fillControls() {
  for (const [name, summary] of catalogue.scene) {
    form.scene.append(make("option", name, [], { value: name, title: summary }));
  }
  for (const [name] of catalogue.sensor) {
    form.sensor.append(make("option", name, [], { value: name }));
  }
  for (const [name, title, summary] of catalogue.readout) {
    const box = make("input", "", [], { type: "checkbox", name: "readout", value: name });
    box.checked = true;
    byId("readouts").append(make("label", "", [box, make("span", title)], { title: summary }));
  }
  form.scene.value = "room";
  takeSensor();
}

const sensor = () => given.sensor ? given.sensor.line : catalogue.sensor.find(([name]) => name === form.sensor.value);

/** What a sensor has of its own. */
function takeSensor() {
  const [, columns, rows, reflectivity, acquisitions, range] = sensor();
  form.reflectivity.value = reflectivity;
  form.acquisitions.value = acquisitions;
  for (const name of ["distance", "near", "far"]) {
    form[name].max = Number(range) - 0.01;
  }
  const sizes = new Set(SIZES.map((part) => [columns, rows].map((extent) => Math.max(1, Math.floor(extent / part))).join(" ")));
  form.size.replaceChildren(...[...sizes].map((size, i) =>
    make("option", `${size.replace(" ", " x ")}${i === 0 ? "" : ", quicker"}`, [], { value: size })));
  showControls();
}

const sceneSummary = () => given.recording ? `${given.recording.name}, a recording` :
  given.depth ? `${given.depth.name}, ${given.depth.columns} x ${given.depth.rows} pixels` :
  catalogue.scene.find(([name]) => name === form.scene.value)[1];

/** Texts and fields that follow from other fields. */
function showControls() {
  byId("scene-summary").textContent = sceneSummary();
  byId("klux-text").value = form.klux.value;
  byId("reflectivity-text").value = form.reflectivity.value;
  for (const label of form.querySelectorAll("[data-scenes]")) {
    label.hidden = Boolean(given.depth || given.recording) || !label.dataset.scenes.split(" ").includes(form.scene.value);
    label.querySelector("input").disabled = label.hidden;
  }
}

/** A file's name as a word of a shell. */
const quoted = (name) => /^[\w./-]+$/.test(name) ? name : `'${name.replaceAll("'", "'\\''")}'`;

/** Options of `dtof frame`, and what the worker is asked for. */
function request() {
  const readouts = [...form.querySelectorAll("[name=readout]:checked")].map((box) => box.value);
  const [columns, rows] = form.size.value.split(" ");
  const said = { scene: form.scene.value, sensor: form.sensor.value, columns, rows, klux: form.klux.value,
    reflectivity: form.reflectivity.value, acquisitions: form.acquisitions.value, seed: form.seed.value };
  for (const name of ["distance", "near", "far", "steps"]) {
    if (!form[name].disabled) {
      said[name] = form[name].value;
    }
  }
  const every = readouts.length === catalogue.readout.length;
  const chosen = `--readout ${every ? "all" : readouts.join(",")}`;
  const lines = (fields) => [...Object.entries(fields), ...readouts.map((name) => ["readout", name])].map((line) => line.join(" ")).join("\n");
  const { sensor: own, depth, recording } = given;
  if (recording) {
    const [, , , , , , np, slots, time] = sensor();
    const { sensor: preset, acquisitions, seed } = said;
    const thinned = Object.fromEntries(["photons", "shift"].map((name) => [name, form[name].value]).filter(([, value]) => value !== ""));
    const options = { ...(recording.binWidth > 0 ? { "bin-width": recording.binWidth } : {}), ...thinned, acquisitions, seed };
    const drawn = recording.drawn ? [Object.entries(options).map(([name, value]) => `--${name} ${value}`).join(" ")] : [];
    return { what: "run", readouts, sensor: own, depth: null, recording,
      text: lines(recording.drawn ? { sensor: preset, ...thinned, acquisitions, seed } : { sensor: preset }),
      command: [`build/cpp/bin/dtof replay ${quoted(recording.name)}`, ...drawn, `--t-int ${time} --np ${np} --slots ${slots}`, chosen].join(" \\\n    ") };
  }
  const option = { columns: "array-columns", rows: "array-rows" };
  const command = [depth ? `--depth ${quoted(depth.name)}${depth.scale === "" ? "" : ` --depth-scale ${depth.scale}`}` : `--scene ${said.scene}`,
    `--sensor ${own ? quoted(own.name) : said.sensor}`,
    ...Object.entries(said).slice(2).map(([name, value]) => `--${option[name] ?? name} ${value}`)];
  return { what: "run", readouts, sensor: own, depth, recording: null, text: lines(said),
    command: [`build/cpp/bin/dtof frame ${command.slice(0, 4).join(" ")}`, command.slice(4).join(" "), chosen].join(" \\\n    ") };
}

// ---- A run ----------------------------------------------------------------------------------------------

function say(text) {
  byId("status").textContent = text;
  byId("status").classList.remove("failed");
}

function fail(sentence) {
  say(sentence);
  byId("status").classList.add("failed");
  byId("progress").value = 0;
  document.body.dataset.state = "failed";
}

const workerText = URL.createObjectURL(new Blob([byId("worker-text").textContent], { type: "text/javascript" }));

/** A worker with the models. `failed` takes a sentence. */
function makeWorker(heard, failed) {
  const made = new Worker(workerText);
  made.onmessage = (event) => heard(event.data);
  made.onerror = (event) => {
    console.error(event.message);
    failed(`The models stopped: ${event.message}`);
  };
  return made;
}

function startWorker() {
  worker = makeWorker((message) => hear[message.what](message), fail);
}

function restartWorker(ready) {
  worker.terminate();
  startWorker();
  hear.ready = ready;
}

/** Asks a worker of its own, so that the frame and its pixels stay: a promise of the answer. */
function askModels(question) {
  return new Promise((resolve, reject) => {
    const failed = (sentence) => {
      asked.terminate();
      reject(new Error(sentence));
    };
    const asked = makeWorker((message) => {
      if (message.what === "ready") {
        asked.postMessage(question);
      } else if (message.what === "failed") {
        failed(message.sentence);
      } else {
        asked.terminate();
        resolve(message);
      }
    }, failed);
  });
}

/** What is wrong with the first field of a form that is outside its limits; "" if none is. */
function wrongField(fields) {
  const wrong = [...fields.elements].find((field) => !field.validity.valid);
  if (!wrong) {
    return "";
  }
  const { min, max, step, value } = wrong;
  const limits = max === "" ? `of ${min} or more` : `from ${min} to ${max}`;
  return `${wrong.closest("label").firstChild.textContent.trim()}: ${value === "" ? "what is there" : value} is no ` +
    `${step === "1" ? "whole number" : "number"} ${limits}.`;
}

/** Begins a run; one that is under way is given up. */
function run() {
  if (!form.reportValidity()) {
    fail(wrongField(form));
    return;
  }
  const asked = request();
  if (asked.readouts.length === 0) {
    fail("Choose at least one read-out.");
    return;
  }
  if (asking) {
    restartWorker(() => worker.postMessage(asked));
  } else {
    worker.postMessage(asked);
  }
  asking = true;
  watched.ready = false;
  document.body.dataset.state = "running";
  begun = performance.now();
  frames = [];
  byId("command").textContent = asked.command;
  byId("shown").classList.add("stale");
  byId("progress").removeAttribute("value");
  say(asked.recording ? "Reading the recording ..." : "Calibrating the read-outs on flat targets ...");
}

const hear = {
  ready(message) {
    for (const line of message.catalogue.trim().split("\n")) {
      const [kind, ...fields] = line.split("\t");
      catalogue[kind].push(fields);
    }
    fillControls();
    run();
  },
  scene(message) {
    scene = message;
    const known = message.truth.filter((metres) => !Number.isNaN(metres));
    scene.near = known.reduce((least, metres) => Math.min(least, metres), Infinity);
    scene.far = known.reduce((most, metres) => Math.max(most, metres), 0);
    if (known.length === 0) {  // a recording has no truth
      [scene.near, scene.far] = [0, Number(sensor()[5])];
    }
    if (scene.far - scene.near < 0.2) {  // a flat scene: room for what is measured around it
      scene.near = Math.max(0, scene.near - 0.5);
      scene.far += 0.5;
    }
  },
  progress(message) {
    byId("progress").value = message.done / message.of;
    say(`Reading out: column ${message.done} of ${message.of} ...`);
  },
  frame(message) {
    frames.push(message);
  },
  done() {
    byId("progress").value = 1;
    const pixels = scene.columns * scene.rows;
    const seconds = (performance.now() - begun) / 1000;
    say(`${frames.length} read-out${frames.length === 1 ? "" : "s"} of ${pixels.toLocaleString("en")} pixels in ${seconds.toFixed(1)} s.`);
    show();
    watched.ready = true;
    document.body.dataset.state = "done";
  },
  failed(message) {
    fail(message.sentence);
  },
};

// ---- Results --------------------------------------------------------------------------------------------

/** A map with the values of the pixel that is pointed at. `title` says of what, to those who do not see it. */
function map(values, colour, title, label, describe) {
  const canvas = make("canvas", "", [], { width: scene.columns, height: scene.rows, role: "img", "aria-label": `${title}: ${label}` });
  paint(canvas, values, colour);
  canvas.onpointermove = canvas.onpointerdown = (event) => {
    const box = canvas.getBoundingClientRect();
    const column = Math.floor((event.clientX - box.left) / box.width * scene.columns);
    const row = Math.floor((event.clientY - box.top) / box.height * scene.rows);
    if (column >= 0 && row >= 0 && column < scene.columns && row < scene.rows) {
      showPixel(column, row, describe);
    }
  };
  return make("figure", "", [canvas, make("figcaption", label)]);
}

const metres = (value) => Number.isFinite(value) ? `${value.toFixed(3)} m` : "unknown";

function describePixel(frame, title) {
  return (i) => {
    const [code, , confidence] = frame.results.subarray(4 * i, 4 * i + 4);
    const truth = scene.truth[i];
    const off = Number.isNaN(frame.error[i]) ? "" : `, off by ${(100 * frame.error[i] / truth).toFixed(1)} %`;
    return `${title} measured ${metres(frame.depth[i])}${scene.recorded ? "" : `, true ${metres(truth)}${off}`}; code ${code}, confidence ${confidence}`;
  };
}

/** Figures of a read-out: those of the frame, and what the silicon costs. A recording has no true distance. */
function figuresOf(frame) {
  const [rmse, bias, , above3, above10] = frame.figures;
  const silicon = cost.readouts[frame.readout];
  const judged = scene.recorded ? [["no distance", `${frame.depth.filter(Number.isNaN).length} pixels`]] :
    [["off by > 3 %", above3], ["off by > 10 %", above10], ["rmse", `${rmse} mm`], ["bias", `${bias} mm`]];
  return [...judged, ["area", silicon ? `${silicon.mm2}\u00a0mm\u00b2${silicon.note ? "\u00a0*" : ""}` : "-"], ["power", silicon ? `${silicon.mw}\u00a0mW` : "-"]];
}

/** The first card: how many detections each pixel of a recording has. */
function recordingCard(brightest) {
  const detections = scene.brightness.reduce((sum, value) => sum + value, 0);
  return make("article", "", [
    make("h3", "The recording"),
    make("p", sceneSummary(), [], { class: "hint" }),
    make("div", "", [map(scene.brightness, (value) => grey(value / Math.max(brightest, 1)), "The recording", `detections, black 0, white ${brightest}`,
      (i) => `${scene.brightness[i]} detections`)], { class: "maps" }),
    make("dl", "", [["pixels", `${scene.columns} x ${scene.rows}`], ["detections", detections.toLocaleString("en")]].map(([name, value]) =>
      make("div", "", [make("dt", name), make("dd", value)]))),
  ]);
}

/** The first card: distances and reflectivity of a scene. */
function sceneCard(brightest) {
  const describeTruth = (i) => `true ${metres(scene.truth[i])}, reflectivity ${scene.brightness[i].toFixed(2)}`;
  const distances = Float32Array.from(scene.truth).filter((value) => !Number.isNaN(value)).sort();
  return make("article", "", [
    make("h3", "The scene"),
    make("p", sceneSummary(), [], { class: "hint" }),
    make("div", "", [
      map(scene.truth, depthColour, "The scene", "depth", describeTruth),
      map(scene.brightness, (value) => grey(value / brightest), "The scene", `reflectivity, black 0, white ${brightest.toFixed(2)}`, describeTruth),
    ], { class: "maps" }),
    make("dl", "", [["nearest", metres(distances[0])], ["middle", metres(distances[distances.length >> 1])],
      ["farthest", metres(distances[distances.length - 1])]].map(([name, value]) =>
      make("div", "", [make("dt", name), make("dd", value)]))),
  ]);
}

/** Links to the parts of the page that are there. */
function showParts() {
  for (const link of document.querySelectorAll("#state [data-part]")) {
    link.hidden = byId(link.dataset.part).hidden;
  }
}

/** Without true distances, the colours span what was measured, but for the nearest and the farthest 2 %. */
function spanMeasured() {
  const measured = Float32Array.from(frames.flatMap((frame) => [...frame.depth].filter((value) => !Number.isNaN(value)))).sort();
  if (measured.length > 0) {
    scene.near = measured[Math.floor(0.02 * (measured.length - 1))];
    scene.far = Math.max(measured[Math.ceil(0.98 * (measured.length - 1))], scene.near + 0.2);
  }
}

function show() {
  if (scene.recorded) {
    spanMeasured();
  }
  const brightest = scene.brightness.reduce((most, value) => Math.max(most, value), 0);
  const cards = [scene.recorded ? recordingCard(brightest) : sceneCard(brightest)];
  byId("error-ramp").hidden = scene.recorded;
  byId("same-figures").hidden = scene.recorded;
  const rows = [];
  for (const frame of frames) {
    const [, title, summary] = catalogue.readout.find(([name]) => name === frame.readout);
    const describe = describePixel(frame, title);
    const figures = figuresOf(frame);
    cards.push(make("article", "", [
      make("h3", title),
      make("p", summary, [], { class: "hint" }),
      make("div", "", [map(frame.depth, depthColour, title, "depth", describe),
        ...scene.recorded ? [] : [map(frame.error, errorColour, title, "error", describe)]], { class: "maps" }),
      make("dl", "", figures.map(([name, value]) => make("div", "", [make("dt", name), make("dd", value)]))),
    ], { "data-readout": frame.readout, style: `border-top: 0.3rem solid ${cost.readouts[frame.readout]?.colour ?? "var(--line)"}` }));
    const bits = cost.readouts[frame.readout]?.bits ?? "-";
    rows.push(make("tr", "", [make("th", title, [], { scope: "row" }),
      ...[...figures.map(([, value]) => value), bits].map((value) => make("td", value))]));
  }
  byId("cards").replaceChildren(...cards);
  const heads = ["read-out", ...figuresOf(frames[0]).map(([name]) => name), "bits a pixel"];
  byId("table").tHead.replaceChildren(make("tr", "", heads.map((name) => make("th", name, [], { scope: "col" }))));
  byId("table").tBodies[0].replaceChildren(...rows);
  byId("notes").textContent = cost.note;
  byId("depth-ends").replaceChildren(...[scene.near, (scene.near + scene.far) / 2, scene.far].map((m) => make("span", `${m.toFixed(2)} m`)));
  paint(byId("depth-legend"), ramp, viridis);
  paint(byId("error-legend"), ramp, blueWhiteRed);
  showComparison();
  forgetPixel();
  byId("shown").hidden = false;
  showParts();
  byId("shown").classList.remove("stale");
}

form.onsubmit = (event) => {
  event.preventDefault();
  run();
};
form.oninput = (event) => {
  if (event.target.name === "sensor") {
    takeSensor();
  }
  showControls();
};
form.onchange = run;
const checkAll = (checked) => form.querySelectorAll("[name=readout]").forEach((box) => { box.checked = checked; });
byId("all").onclick = () => {
  checkAll(true);
  run();
};
byId("none").onclick = () => {
  checkAll(false);
  say("Choose read-outs.");
};
window.onerror = (message) => fail(`The page stopped: ${message}`);
