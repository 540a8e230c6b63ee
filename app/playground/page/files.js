// SPDX-License-Identifier: Apache-2.0
// Files that are dropped on the page: a sensor file (TOML), a depth map (PNG of 8 or 16 bits, PFM, NPY) as `dtof frame --depth` reads it, or a
// recording as `dtof replay` reads it. The page unpacks gzip, NPZ and the variables of a MATLAB file; the models read all else.
"use strict";

const LARGEST_EXTENT = 65535;  // rows and columns of a map
const MILLIMETRE = 1e-3;  // a unit of a PNG of 16 bits
const MOST_PIXELS = 2 ** 24;  // of a map
const LONGEST_RECORDING = 256e6;  // bytes; the models need three to five times as many
const LONGEST_SENSOR = 1e6;  // bytes of a sensor file
const given = { sensor: null, depth: null, recording: null };  // what a run takes instead of a preset and a scene
let lastMap = null;  // the file, which another scale reads again
let lastRecording = null;  // likewise, for another bin width

const refuse = (reason) => { throw new Error(reason); };
const startsWith = (bytes, ...values) => values.every((value, i) => bytes[i] === value);
const isNpy = (bytes) => startsWith(bytes, 0x93, 0x4e, 0x55, 0x4d);

function checkExtent(columns, rows) {
  if (!(columns >= 1 && rows >= 1 && columns <= LARGEST_EXTENT && rows <= LARGEST_EXTENT)) {
    refuse(`${columns} x ${rows} pixels: each must be 1..${LARGEST_EXTENT}`);
  }
  if (columns * rows > MOST_PIXELS) {
    refuse(`${columns} x ${rows} pixels are more than ${MOST_PIXELS}, the most that this page takes; \`dtof frame\` takes more`);
  }
}

// ---- Maps: numbers row by row, row 0 on top -----------------------------------------------------------------------

function readPfm(bytes) {
  const header = /^Pf\s+(\d+)\s+(\d+)\s+(\S+?)(\r\n|\s)/.exec(String.fromCharCode(...bytes.slice(0, 100))) ?? refuse("no header of a PFM in grey (Pf)");
  const [columns, rows, scale] = header.slice(1, 4).map(Number);
  checkExtent(columns, rows);
  if (!Number.isFinite(scale) || scale === 0) {
    refuse(`PFM scale ${header[3]} is not a finite number other than 0`);
  }
  // A line end of CR LF is two characters, unless LF is the first byte of a number.
  let begin = header[0].length;
  if (header[4] === "\r\n" && bytes.length < begin + 4 * columns * rows) {
    begin -= 1;
  }
  if (bytes.length - begin !== 4 * columns * rows) {
    refuse(`${columns} x ${rows} pixels need ${4 * columns * rows} bytes, the file has ${bytes.length - begin}`);
  }
  const view = new DataView(bytes.buffer, bytes.byteOffset + begin);
  const values = Float64Array.from({ length: columns * rows }, (_, i) => {
    const row = rows - 1 - Math.floor(i / columns);  // PFM stores the bottom row first
    return Math.abs(scale) * view.getFloat32(4 * (row * columns + i % columns), scale < 0);
  });
  return { columns, rows, bits: 0, values };
}

const NPY_TYPES = { f4: [4, "getFloat32"], f8: [8, "getFloat64"], u1: [1, "getUint8"], u2: [2, "getUint16"], u4: [4, "getUint32"],
  i1: [1, "getInt8"], i2: [2, "getInt16"], i4: [4, "getInt32"] };

function npyHeader(bytes) {
  if (bytes.length < 12) {
    refuse("a damaged NPY");
  }
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const [length, begin] = bytes[6] === 1 ? [view.getUint16(8, true), 10] : [view.getUint32(8, true), 12];
  if (begin + length > bytes.length) {
    refuse("a damaged NPY");
  }
  return { view, data: begin + length, header: new TextDecoder("latin1").decode(bytes.slice(begin, begin + length)) };
}

/** Lengths of an array's axes. */
const npyShape = ({ header }) => (/'shape':\s*\(([^)]*)\)/.exec(header) ?? refuse("NPY without a shape"))[1]
  .split(",").filter((text) => text.trim()).map(Number);

function readNpy(bytes) {
  const { view, data, header } = npyHeader(bytes);
  const [, order, type] = /'descr':\s*'([<>|=]?)(\w+)'/.exec(header) ?? refuse("NPY without a type of numbers");
  const size = NPY_TYPES[type] ?? refuse(`NPY of ${type}: numbers are ${Object.keys(NPY_TYPES).join(", ")}`);
  if (/'fortran_order':\s*True/.test(header)) {
    refuse("NPY in the order of Fortran");
  }
  let shape = npyShape({ header });
  while (shape.length > 2 && shape.at(-1) === 1) {
    shape = shape.slice(0, -1);
  }
  while (shape.length > 2 && shape[0] === 1) {
    shape = shape.slice(1);
  }
  if (shape.length !== 2) {
    refuse(`NPY shape (${shape.join(", ")}): a map has rows and columns`);
  }
  const [rows, columns] = shape;
  checkExtent(columns, rows);
  if (bytes.length - data !== rows * columns * size[0]) {
    refuse(`${columns} x ${rows} numbers need ${rows * columns * size[0]} bytes, the file has ${bytes.length - data}`);
  }
  return { columns, rows, bits: 0,
    values: Float64Array.from({ length: rows * columns }, (_, i) => view[size[1]](data + i * size[0], order !== ">")) };
}

const tooLong = (bytes) => `${Math.ceil(bytes / 1e6)} MB; this page takes ${LONGEST_RECORDING / 1e6} MB, \`dtof\` more`;

/** The bytes, unpacked; refuses more than `most`, and says `damaged` of what cannot be unpacked. */
async function inflate(bytes, format, damaged, most = LONGEST_RECORDING) {
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format)).getReader();
  const parts = [];
  let length = 0;
  for (let part = await reader.read().catch(() => refuse(damaged)); !part.done; part = await reader.read().catch(() => refuse(damaged))) {
    length += part.value.length;
    if (length > most) {
      await reader.cancel();
      refuse(most < LONGEST_RECORDING ? damaged : `unpacked, it has more than ${tooLong(most)}`);
    }
    parts.push(part.value);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

/** Paeth's predictor of PNG. */
function paeth(left, above, corner) {
  const guess = left + above - corner;
  const [a, b, c] = [left, above, corner].map((value) => Math.abs(guess - value));
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

async function readPng(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const parts = [];
  let columns = 0, rows = 0, bits = 0;
  for (let at = 8; at + 12 <= bytes.length;) {
    const length = view.getUint32(at), name = String.fromCharCode(...bytes.slice(at + 4, at + 8));
    if (name === "IHDR") {
      [columns, rows, bits] = [view.getUint32(at + 8), view.getUint32(at + 12), bytes[at + 16]];
      checkExtent(columns, rows);
      if (bytes[at + 17] !== 0 || bytes[at + 20] !== 0 || ![8, 16].includes(bits)) {
        refuse("a PNG here is greyscale of 8 or 16 bits, without alpha and not interlaced; `dtof frame` reads more");
      }
    } else if (name === "tRNS") {
      refuse("a PNG here has no transparent pixels; `dtof frame` reads them");
    } else if (name === "IDAT") {
      parts.push(bytes.slice(at + 8, at + 8 + length));
    }
    at += 12 + length;
  }
  const pixel = bits / 8, line = columns * pixel;
  const data = await inflate(await new Blob(parts).arrayBuffer(), "deflate", "a damaged PNG", rows * (line + 1));
  if (data.length !== rows * (line + 1)) {
    refuse("a damaged PNG");
  }
  const plain = new Uint8Array(rows * line);
  for (let row = 0; row < rows; ++row) {
    const filter = data[row * (line + 1)];
    for (let i = 0; i < line; ++i) {
      const to = row * line + i;
      const left = i >= pixel ? plain[to - pixel] : 0, above = row > 0 ? plain[to - line] : 0;
      const corner = i >= pixel && row > 0 ? plain[to - line - pixel] : 0;
      const guess = [0, left, above, (left + above) >> 1, paeth(left, above, corner)][filter] ?? refuse("a damaged PNG");
      plain[to] = data[row * (line + 1) + 1 + i] + guess;
    }
  }
  const numbers = new DataView(plain.buffer);
  return { columns, rows, bits,
    values: Float64Array.from({ length: rows * columns }, (_, i) => bits === 16 ? numbers.getUint16(2 * i) : plain[i]) };
}

const NO_KNOWN_FILE = "neither a sensor file (.toml) nor a depth map (PNG, PFM, NPY) nor a recording (CSV, NPY, NPZ, MAT, PTU, HT3, HT2, logs of " +
  "TMF8820, TMF8821, TMF8828, TMF8829, VL53L8CH); `dtof convert` makes these of other files";

/** A depth map in metres; 0 is unknown. `scale`: metres a unit, or NaN for the format's own. */
async function readMap(bytes, scale) {
  const map = startsWith(bytes, 0x89, 0x50, 0x4e, 0x47) ? await readPng(bytes) : startsWith(bytes, 0x50, 0x66) ? readPfm(bytes) :
    isNpy(bytes) ? readNpy(bytes) : refuse(NO_KNOWN_FILE);
  if (map.bits === 8 && Number.isNaN(scale)) {
    refuse("a depth map of 8 bits needs its scale: give the metres that one unit stands for");
  }
  const unit = Number.isNaN(scale) ? (map.bits === 16 ? MILLIMETRE : 1) : scale;
  const metres = Float32Array.from(map.values, (value) => Number.isFinite(value) ? value * unit : 0);
  const wrong = metres.findIndex((value) => value < 0);
  if (wrong >= 0) {
    refuse(`column ${wrong % map.columns}, row ${Math.floor(wrong / map.columns)}: a negative depth`);
  }
  return { columns: map.columns, rows: map.rows, metres };
}

// ---- Recordings ---------------------------------------------------------------------------------------------------

/** The members of a ZIP archive, packed. */
function zipMembers(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  let end = bytes.length - 22;
  while (end >= 0 && view.getUint32(end, true) !== 0x06054b50) {
    end -= 1;
  }
  if (end < 0) {
    refuse("a damaged NPZ");
  }
  const members = new Map();
  for (let i = 0, at = view.getUint32(end + 16, true); i < view.getUint16(end + 10, true); ++i) {
    const [method, size, name, extra, comment, place] = [view.getUint16(at + 10, true), view.getUint32(at + 20, true), view.getUint16(at + 28, true),
      view.getUint16(at + 30, true), view.getUint16(at + 32, true), view.getUint32(at + 42, true)];
    const begin = place + 30 + view.getUint16(place + 26, true) + view.getUint16(place + 28, true);
    members.set(new TextDecoder().decode(bytes.slice(at + 46, at + 46 + name)).replace(/\.npy$/, ""),
      { method, packed: bytes.slice(begin, begin + size) });
    at += 46 + name + extra + comment;
  }
  return members;
}

const unpack = ({ method, packed }) => method === 0 ? packed : method === 8 ? inflate(packed, "deflate-raw", "a damaged NPZ") : refuse("an NPZ that is packed unusually");

/** Histograms and the width of their bins in an archive, as `dtof convert` writes it; else its only array. */
async function readNpz(bytes) {
  const members = await Promise.resolve(bytes).then(zipMembers).catch(() => refuse("a damaged NPZ"));
  const named = members.get("histograms") ?? (members.size === 1 ? [...members.values()][0] : refuse("an NPZ without an array \"histograms\""));
  const width = members.get("bin_width_ps");
  const number = width ? npyHeader(await unpack(width)) : null;
  return { contents: await unpack(named), width: number ? number.view.getFloat64(number.data, true) : NaN };
}

/** Axes that a depth map does not have: more than rows and columns of more than one. */
const hasBins = (bytes) => isNpy(bytes) && npyShape(npyHeader(bytes)).filter((length) => length > 1).length > 2;

/** A MATLAB file of version 5 whose variables are not packed: `save -v6` of the one that is given. */
async function unpackMat(bytes) {
  const HEADER = 128, PACKED = 15;
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const parts = [bytes.slice(0, HEADER)];
  for (let at = HEADER; at < bytes.length;) {
    const [kind, size] = at + 8 <= bytes.length ? [view.getUint32(at, true), view.getUint32(at + 4, true)] : [0, Infinity];
    if (kind !== PACKED || at + 8 + size > bytes.length) {  // the models read it, or say what is wrong
      parts.push(bytes.slice(at, at + 8 + size));
    } else {
      parts.push(await inflate(bytes.slice(at + 8, at + 8 + size), "deflate", `damaged: the variable at byte ${at} does not decompress`));
    }
    at += 8 + size;
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

const NO_DETECTIONS = /^acquisition,column,row,timestamp\s*$/;
const isMat = (bytes) => new TextDecoder("latin1").decode(bytes.slice(0, 10)) === "MATLAB 5.0";
const isMap = (bytes) => startsWith(bytes, 0x89, 0x50, 0x4e, 0x47) || startsWith(bytes, 0x50, 0x66) || (isNpy(bytes) && !hasBins(bytes));

/** A recording of this name, or null if the file is none. The models say what kind it is. */
async function readRecording(name, file) {
  let bytes = file, binWidth = form["bin-width"].value === "" ? 0 : Number(form["bin-width"].value);
  if (startsWith(bytes, 0x1f, 0x8b)) {
    bytes = await inflate(bytes, "gzip", "damaged gzip data");
  }
  if (startsWith(bytes, 0x50, 0x4b)) {
    const { contents, width } = await readNpz(bytes);
    bytes = contents;
    binWidth = binWidth > 0 || Number.isNaN(width) ? binWidth : width;
  } else if (isMap(bytes)) {
    return null;
  } else if (isMat(bytes)) {
    bytes = await unpackMat(bytes);
  }
  if (bytes.length === 0) {
    refuse("empty");
  }
  if (NO_DETECTIONS.test(new TextDecoder("latin1").decode(bytes.slice(0, 200)))) {
    refuse("no detections below the header");
  }
  const recording = { name, contents: new Blob([bytes]), binWidth };
  const { line } = await askModels({ what: "recording", recording });
  if (line === "") {
    return null;
  }
  const [, drawn, width] = line.split("\t");
  return { ...recording, drawn: drawn === "1", binWidth: width === "no" ? 0 : binWidth, lacksWidth: width === "must" && !(binWidth > 0) };
}

// ---- What was given -----------------------------------------------------------------------------------------------

function showGiven() {
  for (const kind of ["sensor", "depth", "recording"]) {
    const button = byId(`drop-${kind}`);
    button.hidden = !given[kind];
    button.textContent = given[kind] ? `${given[kind].name} \u00d7` : "";
    button.setAttribute("aria-label", given[kind] ? `remove ${given[kind].name}` : "");
  }
  form.sensor.disabled = Boolean(given.sensor);
  form.scene.disabled = Boolean(given.depth || given.recording);
  for (const name of ["reflectivity", "klux", "size"]) {
    form[name].disabled = Boolean(given.recording);
  }
  for (const name of ["acquisitions", "seed"]) {  // what a TDC stream has of its own
    form[name].disabled = Boolean(given.recording && !given.recording.drawn);
  }
}

/** What a file is, as a part of `given`. */
async function read(file) {
  const isSensor = /\.toml$/i.test(file.name);
  if (file.size === 0) {
    refuse("the file is empty");
  }
  if (file.size > LONGEST_RECORDING) {
    refuse(tooLong(file.size));
  }
  if (isSensor && file.size > LONGEST_SENSOR) {
    refuse(`${Math.ceil(file.size / 1e6)} MB; a sensor file has at most ${LONGEST_SENSOR / 1e6} MB`);
  }
  const bytes = new Uint8Array(await file.arrayBuffer().catch(() => refuse("it cannot be read; a folder is no file")));
  if (isSensor) {
    return { sensor: await askSensor({ name: file.name, text: new TextDecoder().decode(bytes) }) };
  }
  const recording = await readRecording(file.name, bytes);
  if (recording) {
    lastRecording = recording.drawn ? file : null;
    if (recording.lacksWidth) {
      refuse("histograms need the width of their bins: give it in ps");
    }
    return { depth: null, recording };
  }
  lastMap = file;
  const typed = form["depth-scale"].value;
  return { depth: { name: file.name, scale: typed, ...await readMap(bytes, typed === "" ? NaN : Number(typed)) }, recording: null };
}

/** Runs with what is given now. A map and a recording take each other's place. */
function give(what) {
  Object.assign(given, what);
  showGiven();
  if ("sensor" in what) {
    takeSensor();
  }
  showControls();
  run();
}

/** Takes all of the files, or none of them if one is refused. */
async function takeAll(files) {
  if (catalogue.readout.length === 0) {
    fail("The models are still starting.");
    return;
  }
  const taken = {}, refused = [];
  for (const file of files) {
    say(`Reading ${file.name} ...`);
    try {
      Object.assign(taken, await read(file));
    } catch ({ message }) {
      refused.push(message.startsWith(`${file.name}:`) ? message : `${file.name}: ${message}`);
    }
  }
  if (refused.length > 0) {
    fail(refused.join(" "));
  } else if (files.length > 0) {
    give(taken);
  }
}

let taking = Promise.resolve();  // files that are dropped meanwhile come next

function takeFiles(files) {
  taking = taking.then(() => takeAll(files));
}

/** The models say what the sensor has, or what is wrong with its file. */
async function askSensor(sensor) {
  if (sensor.text.trim() === "") {
    refuse("the file is empty");
  }
  if (sensor.text.includes("\0")) {
    refuse("no text, so no sensor file");
  }
  const { line } = await askModels({ what: "sensor", sensor });
  return { ...sensor, line: line.trim().split("\t").slice(1) };
}

function drop(kind) {
  lastMap = kind === "depth" ? null : lastMap;
  lastRecording = kind === "recording" ? null : lastRecording;
  give({ [kind]: null });
}

byId("drop-sensor").onclick = () => drop("sensor");
byId("drop-depth").onclick = () => drop("depth");
byId("drop-recording").onclick = () => drop("recording");
form["depth-scale"].onchange = (event) => {
  event.stopPropagation();
  takeFiles(lastMap ? [lastMap] : []);
};
form["bin-width"].onchange = (event) => {
  event.stopPropagation();
  takeFiles(lastRecording ? [lastRecording] : []);
};
byId("file").onchange = (event) => {
  event.stopPropagation();  // a change of the form runs the models
  takeFiles([...event.target.files]);
  event.target.value = "";
};
document.ondragover = (event) => {
  event.preventDefault();
  document.body.classList.add("over");
};
document.ondragleave = () => document.body.classList.remove("over");
document.ondrop = (event) => {
  event.preventDefault();
  document.body.classList.remove("over");
  if (event.dataTransfer.files.length === 0) {
    fail("What was dropped is no file.");
  }
  takeFiles([...event.dataTransfer.files]);
};
