// SPDX-License-Identifier: Apache-2.0
// Draws the live plots with Chart.js, from plots_data.js. Check boxes choose read-outs and lights of all plots.
"use strict";

(() => {
  const { readouts, lights, plots } = window.plotsData;
  const form = document.getElementById("filters");
  const HOLLOW_FROM = 50;  // klux: marks for this light and more are hollow where one plot has several lights at one place
  const charts = window.charts = {};  // by plot

  // ---- Marks ----------------------------------------------------------------------------------------------

  // By gnuplot's pointtype: the shape and its turn, in degrees.
  const SHAPES = { 1: ["cross", 0], 2: ["crossRot", 0], 3: ["star", 0], 4: ["rect", 0], 5: ["rect", 0], 6: ["circle", 0], 7: ["circle", 0],
    8: ["triangle", 0], 9: ["triangle", 0], 10: ["triangle", 180], 11: ["triangle", 180], 12: ["rectRot", 0], 13: ["rectRot", 0],
    14: ["rectRounded", 0], 15: ["rectRounded", 0] };
  const OPEN = [4, 6, 8, 10, 12, 14];

  const mark = (readout, hollow, size) => ({
    pointStyle: SHAPES[readout.marker][0], pointRotation: SHAPES[readout.marker][1], pointRadius: size, pointHoverRadius: size + 2,
    pointHitRadius: 8, pointBorderWidth: 2, pointBorderColor: readout.colour, borderColor: readout.colour,
    pointBackgroundColor: hollow ? "#ffffff" : readout.colour });

  // ---- Filters --------------------------------------------------------------------------------------------

  function make(tag, properties = {}, children = []) {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  }

  /** The mark of a read-out, as the plots with lines draw it. */
  function chip(readout) {
    const canvas = make("canvas", { className: "chip", width: 20, height: 20 });
    const { pointStyle, pointRotation, pointBackgroundColor } = mark(readout, OPEN.includes(readout.marker), 6);
    const context = canvas.getContext("2d");
    Object.assign(context, { strokeStyle: readout.colour, fillStyle: pointBackgroundColor });
    Chart.helpers.drawPoint(context, { pointStyle, rotation: pointRotation, radius: 6, borderWidth: 2 }, 10, 10);
    canvas.setAttribute("aria-hidden", "true");
    return canvas;
  }

  function boxes(name, legend, values) {
    const button = (text, on) => make("button", { type: "button", textContent: text, onclick: () => {
      form.querySelectorAll(`[name=${name}]`).forEach((box) => { box.checked = on; });
      draw();
    } });
    return make("fieldset", {}, [make("legend", { textContent: legend }),
      ...values.map(([value, title, readout]) => make("label", {}, [make("input", { type: "checkbox", name, value, checked: true }),
        ...(readout ? [chip(readout)] : []), title])), button("all", true), button("none", false)]);
  }

  const chosen = (name) => new Set([...form.querySelectorAll(`[name=${name}]:checked`)].map((box) => box.value));

  // ---- What is under the mouse ----------------------------------------------------------------------------

  function number(value) {
    return value === 0 ? "0" : Number(value.toPrecision(3)).toString();
  }

  /** The sentences of a row: its figure, where that comes from, and the command. */
  function describeRow(plot, row) {
    const index = plot.measures.indexOf(settings(plot).measure);
    const [value, low, high] = row.values[index];
    const interval = low === null ? "" : ` [${number(low)}, ${number(high)}]`;
    const measure = plot.measures[index];
    const lines = [make("strong", { textContent: row.label }),
      make("span", { textContent: `${number(value)} %${interval} ${measure}` }),
      make("span", { textContent: [`${row.light} klux`, typeof row.x === "string" ? row.x : "", row.note].filter(Boolean).join(", ") }),
      make("code", { textContent: plot.command }),
      make("small", { textContent: row.figures?.[index] ? `${row.figures[index]} in reports/figures.json` : plot.table }),
      make("small", { textContent: `inputs ${plot.inputs}, commit ${plot.commit}` })];
    if (plot.stale.length > 0) {
      lines.push(make("small", { className: "old", textContent: "Measured before what lies here now." }));
    }
    return lines;
  }

  function tip(plot, { chart, tooltip }) {
    const box = chart.canvas.parentNode.querySelector(".tip");
    box.hidden = tooltip.opacity === 0;
    if (box.hidden) {
      return;
    }
    box.replaceChildren(...tooltip.dataPoints.slice(0, 1).flatMap((point) => describeRow(plot, point.raw.row)));
    const width = chart.canvas.clientWidth;
    box.style.maxWidth = `${Math.min(320, width)}px`;
    box.style.left = `${Math.max(0, Math.min(tooltip.caretX + 12, width - box.offsetWidth))}px`;
    const above = tooltip.caretY - box.offsetHeight - 12;
    box.style.top = `${above >= 0 ? above : tooltip.caretY + 16}px`;
  }

  /** Intervals as bars. */
  const bars = { id: "bars", beforeDatasetsDraw(chart) {
    const { left, right, top, bottom } = chart.chartArea;
    const across = (value) => Math.min(Math.max(chart.scales.x.getPixelForValue(value), left), right);
    const down = (value) => Math.min(Math.max(chart.scales.y.getPixelForValue(value), top), bottom);
    chart.data.datasets.forEach((set, i) => chart.getDatasetMeta(i).data.forEach((point, j) => {
      const { low, high } = set.data[j];
      if (low === null || low === undefined) {
        return;
      }
      const context = chart.ctx;
      context.save();
      context.strokeStyle = set.borderColor;
      context.lineWidth = 1.5;
      context.beginPath();
      if (chart.scales.y.type === "category") {
        context.moveTo(across(low), point.y);
        context.lineTo(across(high), point.y);
      } else {
        context.moveTo(point.x, down(low));
        context.lineTo(point.x, down(high));
      }
      context.stroke();
      context.restore();
    }));
  } };

  // ---- Plots ----------------------------------------------------------------------------------------------

  const section = (plot) => document.getElementById(plot.name);

  function settings(plot) {
    const found = { at: {} };
    section(plot).querySelectorAll(".choices [name]").forEach((element) => {
      if (element.name === "measure") {
        found.measure = element.value;
      } else if (element.name === "log") {
        found.log = element.checked;
      } else {
        found.at[element.name] = element.value;
      }
    });
    return found;
  }

  function shown(plot) {
    const { at } = settings(plot);
    const names = chosen("readout"), klux = chosen("light");
    return plot.rows.filter((row) => names.has(row.readout) && klux.has(String(row.light)) &&
      Object.entries(at).every(([name, value]) => row.at[name] === value));
  }

  /** On a logarithmic axis nothing is drawn at 0: such a figure stands at the axis's low end, and says that it is 0. */
  function lowest(values) {
    return Math.min(...values.filter((value) => value > 0), 1) / 2;
  }

  function datasets(plot) {
    const { measure, log } = settings(plot);
    const index = plot.measures.indexOf(measure);
    const rows = shown(plot);
    const least = log ? lowest(rows.map((row) => row.values[index][0])) : -Infinity;
    const sets = new Map();
    for (const row of rows) {
      const key = plot.kind === "lines" ? row.label : `${row.label} at ${row.light} klux`;
      if (!sets.has(key)) {
        const readout = readouts.find(({ title }) => title === row.readout);
        const hollow = plot.kind === "lines" ? OPEN.includes(readout.marker) : row.light >= HOLLOW_FROM;
        sets.set(key, { label: key, readout: row.readout, light: row.light, data: [], showLine: plot.kind === "lines", borderWidth: 2,
          borderDash: row.label === row.readout ? [] : [6, 4], ...mark(readout, hollow, row.small ? 3 : 6) });
      }
      const [value, low, high] = row.values[index];
      const clipped = Math.max(value, least);
      const interval = { low: low === null ? null : Math.max(low, least), high: high === null ? null : Math.max(high, least) };
      sets.get(key).data.push({ ...(plot.kind === "rows" ? { x: clipped, y: row.x } : { x: row.x, y: clipped }), ...interval, row });
    }
    return [...sets.values()];
  }

  const power = (value) => Math.log10(value);

  /** The ticks of a logarithmic axis: 1, 2 and 5 of each decade; where those are too close, 1 alone. An axis within a decade keeps its own. */
  function keepRoundTicks(scale) {
    const room = scale.isHorizontal() ? scale.chart.width / 45 : scale.chart.height / 20;
    const digits = 3 * power(scale.max / scale.min) <= room ? [1, 2, 5] : [1];
    const round = scale.ticks.filter(({ value }) => digits.some((digit) => Math.abs(power(value / digit) - Math.round(power(value / digit))) < 1e-6));
    scale.ticks = round.length > 1 ? round : scale.ticks;
  }

  function axis(title, log, more = {}) {
    const shared = { title: { display: Boolean(title), text: title }, ...more };
    return log ? { type: "logarithmic", ...shared, afterBuildTicks: keepRoundTicks, ticks: { callback: number, autoSkip: true, maxRotation: 0 } } :
      { type: "linear", ...shared };
  }

  function scales(plot) {
    const { measure, log } = settings(plot);
    const figure = axis(`${measure.startsWith("off") ? "pixels " : ""}${measure}, in %`, log, log ? {} : { min: 0 });
    if (plot.kind === "rows") {
      const labels = [...new Set(shown(plot).map((row) => row.x))];
      return { x: figure, y: { type: "category", labels, offset: true, ticks: { autoSkip: false } } };
    }
    return { x: axis(plot.xTitle, true), y: figure };
  }

  function update(plot) {
    const chart = charts[plot.name];
    chart.data.datasets = datasets(plot);
    chart.options.scales = scales(plot);
    chart.update("none");
    section(plot).querySelector(".none").hidden = chart.data.datasets.length > 0;
  }

  const draw = () => plots.filter((plot) => plot.rows.length > 0).forEach(update);

  function choices(plot) {
    const list = (name, values) => make("label", {}, [`${name} `, make("select", { name, onchange: () => update(plot) },
      values.map((value) => make("option", { value, textContent: value })))]);
    return [list("measure", plot.measures), ...Object.entries(plot.choices).map(([name, values]) => list(name, values)),
      make("label", {}, [make("input", { type: "checkbox", name: "log", checked: true, onchange: () => update(plot) }), "logarithmic"])];
  }

  function begin(plot) {
    const place = section(plot).querySelector(".live");
    place.hidden = false;
    section(plot).querySelector(".choices").append(...choices(plot));
    const canvas = place.querySelector("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${plot.title}. Arrow keys go from mark to mark; the report has the figures as tables.`);
    charts[plot.name] = new Chart(canvas, { type: "scatter", data: { datasets: datasets(plot) }, plugins: [bars], options: {
      animation: false, maintainAspectRatio: false, scales: scales(plot), interaction: { mode: "nearest", intersect: true },
      plugins: { legend: { display: false }, tooltip: { enabled: false, external: (context) => tip(plot, context) } } } });
    followKeys(charts[plot.name]);
  }

  /** Arrow keys show one mark after the other, as the mouse over a mark does. */
  function followKeys(chart) {
    let at = null;
    const show = (marks) => {
      chart.tooltip.setActiveElements(marks, { x: 0, y: 0 });
      chart.update("none");
    };
    chart.canvas.tabIndex = 0;
    chart.canvas.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      const marks = chart.data.datasets.flatMap((set, datasetIndex) => set.data.map((_, index) => ({ datasetIndex, index })));
      if (step && marks.length > 0) {
        event.preventDefault();
        at = at === null ? (step > 0 ? 0 : marks.length - 1) : (at + step + marks.length) % marks.length;
        show([marks[at]]);
      }
    });
    chart.canvas.addEventListener("blur", () => {
      at = null;
      show([]);
    });
  }

  Chart.defaults.color = "#1b1f24";
  Chart.defaults.font.size = 13;
  form.append(boxes("readout", "Read-outs", readouts.map((readout) => [readout.title, readout.title, readout])),
    boxes("light", "Light", lights.map((klux) => [String(klux), `${klux} klux`])));
  form.addEventListener("change", draw);
  form.hidden = false;
  plots.filter((plot) => plot.rows.length > 0).forEach(begin);
})();
