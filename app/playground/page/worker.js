// SPDX-License-Identifier: Apache-2.0
// Runs beside the page, behind the text of the WebAssembly module: a request comes, progress and frames go.
"use strict";

const PROGRESS_MS = 100;

/** The module calls this function while it computes advice. */
function adviceProgress(step, done, of) {
  postMessage({ what: "advice-progress", step, done, of });
}

createModels().then((models) => {
  const call = (name, result, types = [], values = []) => models.ccall(`playground_${name}`, result, types, values);
  const attempt = (name, types = [], values = []) => {
    if (!call(name, "number", types, values)) {
      throw new Error(call("error", "string"));
    }
  };
  const floats = (name, count) => {
    const begin = call(name, "number") / 4;
    return models.HEAPF32.slice(begin, begin + count);
  };

  /** Files that stand for the preset and the scene; null: none. */
  function take(sensor, depth, recording) {
    const bytes = recording ? new Uint8Array(new FileReaderSync().readAsArrayBuffer(recording.contents)) : new Uint8Array();
    const begin = call("take_recording", "number", ["string", "number", "number"],
      recording ? [recording.name, bytes.length, recording.binWidth] : ["", 0, 0]);
    models.HEAPU8.set(bytes, begin);
    attempt("take_sensor", ["string", "string"], sensor ? [sensor.name, sensor.text] : ["", ""]);
    const place = call("take_map", "number", ["number", "number", "string"], depth ? [depth.columns, depth.rows, depth.name] : [0, 0, ""]);
    if (depth) {
      models.HEAPF32.set(depth.metres, place / 4);
    }
  }

  function run({ text, readouts, sensor, depth, recording }) {
    take(sensor, depth, recording);
    attempt("begin", ["string"], [text]);
    const columns = call("columns", "number");
    const rows = call("rows", "number");
    const pixels = columns * rows;
    postMessage({ what: "scene", columns, rows, recorded: Boolean(recording), truth: floats("truth", pixels),
      brightness: floats("brightness", pixels) });
    attempt("calibrate");
    let reported = 0;
    for (let column = 0; column < columns; ++column) {
      attempt("read_column", ["number"], [column]);
      if (performance.now() - reported > PROGRESS_MS) {
        reported = performance.now();
        postMessage({ what: "progress", done: column + 1, of: columns });
      }
    }
    readouts.forEach((readout, index) => {
      attempt("frame", ["number"], [index]);
      const depth = floats("depth", pixels);
      const error = floats("error_map", pixels);
      const begin = call("results", "number") / 2;
      const results = models.HEAPU16.slice(begin, begin + 4 * pixels);
      const figures = call("figures", "string").split("\n");
      const phases = call("phases", "string", ["number"], [index]).split("\n").map((line) => line.split("\t"))
        .map(([end, name]) => ({ end: Number(end), name }));
      postMessage({ what: "frame", readout, depth, error, results, figures, phases });
    });
    postMessage({ what: "done" });
  }

  /** What the pixel's TDC delivered over the frame, an acquisition and a timestamp each. */
  function pixel({ column, row }) {
    attempt("pixel", ["number", "number"], [column, row]);
    const count = call("detections", "number");
    const place = call("detection", "number");
    const acquisition = Uint32Array.from({ length: count }, (_, i) => models.HEAPU32[place / 4 + 2 * i]);
    const timestamp = Uint16Array.from({ length: count }, (_, i) => models.HEAPU16[place / 2 + 4 * i + 2]);
    postMessage({ what: "pixel", column, row, acquisition, timestamp, acquisitions: call("acquisitions", "number"),
      codes: call("codes", "number") });
  }

  /** What a read-out has of the last pixel if the light ends before an acquisition. */
  function state({ readout, until, number }) {
    attempt("state", ["number", "number"], [readout, until]);
    const place = call("state_numbers", "number") / 2;
    const [code, fraction, confidence, second] = models.HEAPU16.slice(place, place + 4);
    attempt("candidates", ["number", "number"], [readout, until]);
    const begin = call("candidate", "number") / 4;
    const candidates = Array.from({ length: call("candidate_count", "number") }, (_, i) =>
      ({ cell: models.HEAP32[begin + 2 * i], score: models.HEAP32[begin + 2 * i + 1] }));
    const unit = 2 ** call("fraction_bits", "number", ["number"], [readout]);
    postMessage({ what: "state", number, until, position: code + fraction / unit, confidence, rival: second / unit, candidates });
  }

  /** The read-out that the C++ of `dtof design` recommends. */
  function advise({ sensor, text }) {
    take(sensor, null, null);
    attempt("advise", ["string"], [text]);
    postMessage({ what: "advice", text: call("advice_text", "string") });
  }

  onmessage = (event) => {
    try {
      if (event.data.what === "advise") {
        advise(event.data);
      } else if (event.data.what === "preset") {
        postMessage({ what: "preset", text: call("preset_text", "string", ["string"], [event.data.name]) });
      } else if (event.data.what === "pixel") {
        pixel(event.data);
      } else if (event.data.what === "state") {
        state(event.data);
      } else if (event.data.what === "recording") {
        take(null, null, event.data.recording);
        attempt("recognise");
        postMessage({ what: "recording", line: call("recording", "string") });
      } else if (event.data.what === "sensor") {
        take(event.data.sensor, null, null);
        postMessage({ what: "sensor", line: call("sensor", "string") });
      } else {
        run(event.data);
      }
    } catch (error) {
      postMessage({ what: "failed", sentence: error instanceof Error ? error.message : String(error) });
    }
  };
  postMessage({ what: "ready", catalogue: call("catalogue", "string") });
}).catch((error) => postMessage({ what: "failed", sentence: `The models did not start: ${error}` }));
