// SPDX-License-Identifier: Apache-2.0
// Advice for the sensor: `dtof design --quick` by the models, in a worker of its own, so that frames can be read meanwhile.
"use strict";

const adviceForm = byId("advice-controls");
let adviser = null;  // the worker

/** Options of `dtof design`, which are the request's lines, too. */
function adviceRequest() {
  const limits = ["max-mm2", "max-mw", "frame-rate", "clock-mhz"].filter((name) => adviceForm[name].value !== "")
    .map((name) => [name, adviceForm[name].value]);
  const said = [...limits, ["seed", form.seed.value]];
  const preset = given.sensor ? [] : [["sensor", form.sensor.value]];
  const name = given.sensor ? quoted(given.sensor.name) : form.sensor.value;
  return { what: "advise", sensor: given.sensor, text: [...preset, ...said].map((line) => line.join(" ")).join("\n"),
    name, command: `build/cpp/bin/dtof design --sensor ${name} --quick ${said.map(([option, value]) => `--${option} ${value}`).join(" ")}` };
}

function sayAdvice(text, failed = false) {
  byId("advice-status").textContent = text;
  byId("advice-status").classList.toggle("failed", failed);
  document.body.dataset.advice = failed ? "failed" : "running";
}

const list = (lines) => lines.map((line) => make("li", line));

/** The lines of playground/advice.hpp. */
function showAdvice(text, asked) {
  const lines = text.trim().split("\n").map((line) => line.split("\t"));
  const of = (kind) => lines.filter(([first]) => first === kind).map(([, ...fields]) => fields);
  const recommended = of("readout")[0][0];
  byId("advice-says").replaceChildren(...of("recommendation").map(([sentence]) => make("p", sentence)));
  byId("advice-table").tHead.replaceChildren(make("tr", "", of("head")[0].map((name) => make("th", name, [], { scope: "col" }))));
  byId("advice-table").tBodies[0].replaceChildren(...of("row").map(([title, ...cells]) =>
    make("tr", "", [make("th", title, [], { scope: "row" }), ...cells.map((cell) => make("td", cell))])));
  byId("advice-changes").replaceChildren(...list(of("change").map(([line]) => line)));
  byId("advice-clocks").replaceChildren(...list(of("clocks").map(([line]) => line)));
  byId("advice-left").replaceChildren(...list(of("left").map(([title, reason]) => `${title}: ${reason}`)));
  byId("advice-nothing-left").hidden = of("left").length > 0;
  byId("advice-command").textContent = `${asked.command}\nbuild/cpp/bin/dtof product --sensor ${asked.name} ${of("product")[0][0]} --out build/chip`;
  byId("advice").hidden = false;
  byId("advice").dataset.readout = recommended;
}

const adviserEvents = (asked) => ({
  ready() {
    adviser.postMessage({ what: asked.what, sensor: asked.sensor, text: asked.text });
  },
  "advice-progress"({ step, done, of }) {
    byId("advice-progress").value = done / of;
    sayAdvice(`Reading ${step}: ${done} of ${of} ...`);
  },
  advice({ text }) {
    byId("advice-progress").value = 1;
    showAdvice(text, asked);
    sayAdvice(`Advice for ${asked.name}.`);
    document.body.dataset.advice = "done";
  },
  failed({ sentence }) {
    byId("advice-progress").hidden = true;
    byId("advice").hidden = true;
    sayAdvice(sentence, true);
  },
});

/** Asks for advice; what was asked before is given up. */
function advise() {
  if (!adviceForm.reportValidity() || !form.seed.reportValidity()) {
    sayAdvice(wrongField(adviceForm) || wrongField(form), true);
    return;
  }
  if (adviser) {
    adviser.terminate();
  }
  const asked = adviceRequest();
  const events = adviserEvents(asked);
  byId("advice-progress").hidden = false;
  byId("advice-progress").removeAttribute("value");
  sayAdvice(`Estimating every set of parameters for ${asked.name} ...`);
  adviser = makeWorker((message) => events[message.what](message), (sentence) => events.failed({ sentence }));
}

// ---- A typed sensor -------------------------------------------------------------------------------------------------

let presetText = "";  // what the text began with

/** True if a sensor was typed that is not yet the sensor. */
function typedIsNew() {
  const { value } = byId("typed");
  return byId("typed").closest("details").open && value.trim() !== "" && value !== presetText && value !== given.sensor?.text;
}

/** Makes the typed sensor the sensor; the answer says whether that is possible. */
async function useTyped() {
  try {
    give({ sensor: await askSensor({ name: "typed.toml", text: byId("typed").value }) });
    return true;
  } catch ({ message }) {
    const sentence = message.startsWith("typed.toml:") ? message : `typed.toml: ${message}`;
    fail(sentence);
    sayAdvice(sentence, true);
    return false;
  }
}

adviceForm.onsubmit = async (event) => {
  event.preventDefault();
  if (!typedIsNew() || await useTyped()) {
    advise();
  }
};
byId("type-preset").onclick = async () => {
  presetText = (await askModels({ what: "preset", name: form.sensor.value })).text;
  byId("typed").value = presetText;
};
byId("type-use").onclick = useTyped;
