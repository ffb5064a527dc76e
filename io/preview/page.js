// The page around the picture: figures of GET /status once a second, settings, trigger, faults.

import { Picture } from "./picture.js";

const $ = id => document.getElementById(id);
const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
function number(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  return Math.abs(value) >= 10 ** digits ? Math.round(value).toLocaleString("en") : Number(value.toPrecision(digits)).toString();
}
const ms = value => number(value) + " ms";
const tai = ns => ns === 0n ? "none" : new Date(Number(ns / 1000000n)).toISOString().slice(0, -1).replace("T", " ") + " TAI";
function pairs(list, entries) {
  list.replaceChildren(...entries.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
}
function rows(table, lines, head) {
  const row = (cell, cells) => make("tr", {}, ...cells.map(c => make(cell, {}, c)));
  table.replaceChildren(...(head ? [row("th", head)] : []), ...lines.map(line => row("td", line)));
}

let status = null, before = null, link = "connecting";

// --- The picture.
const picture = new Picture($("picture"), {
  onframe: showFrame,
  onpixel: showPixel,
  onview: scale => {
    const ratio = window.devicePixelRatio || 1, reduced = picture.frame.step > 1 ? `, every ${picture.frame.step} x ${picture.frame.step} pixels as their mean` : "";
    $("zoom").textContent = `${number(100 * scale / ratio)} %${reduced}`;
    for (const name of ["black", "white"]) if (document.activeElement !== $(name)) $(name).value = picture[name];
  },
  onlink: text => { link = text; showChips(); },
});
window.preview = picture;  // for the console and for tests

function gain() {  // DN per electron, of the frame that is shown
  const at0 = status?.camera.gain_dn_e_at_0_db;
  return at0 ? at0 * 10 ** (picture.frame.gain / 20) : null;
}
function showPixel(pixel) {
  if (!pixel) { $("pixel").textContent = "move over the picture to read pixels"; return; }
  let text = `x ${pixel.x}  y ${pixel.y}   ${pixel.value} DN`;
  const f = picture.frame, k = gain();
  // Binned, black level and gain are the camera's secret.
  if (k && f.binning[0] * f.binning[1] === 1) text += `   ${number((pixel.value - f.blackLevel) / k, 4)} e⁻`;
  if (f.pattern) text += `   ${f.pattern[(pixel.y % 2) * 2 + pixel.x % 2]}`;
  $("pixel").textContent = text;
}
function showFrame(f) {
  const struck = status ? [...status.faults, ...status.frame_flags].filter(x => f.faults >> BigInt(x.bit) & 1n).map(x => x.kind).join(", ") : "";
  pairs($("frame"), [
    ["Frame", f.id.toString()],
    ["Exposure", ms(1e3 * f.exposure)],
    ["Gain", number(f.gain) + " dB"],
    ["Black level", number(f.blackLevel) + " DN"],
    ["Exposed at", tai(f.exposureMidTai)],
    ["Pose", f.poseSequence ? "command " + f.poseSequence : "of the scenario"],
    ["Pose tag", tai(f.poseTai)],
    ...(f.triggerSequence ? [["Trigger", "command " + f.triggerSequence]] : []),
    ["Size", `${f.frameWidth} x ${f.frameHeight}, ${f.bits} bit${f.pattern ? ", " + f.pattern : ""}`],
    ["Faults", struck || "none"],
  ]);
  const s = picture.statistics, all = f.frameWidth * f.frameHeight, part = f.samples.length * f.step * f.step < 0.99 * all;
  $("histogram-of").textContent = part ? "of the part in view" : "";
  pairs($("statistics"), [
    ["Mean, deviation", `${number(s.mean, 4)}, ${number(s.deviation, 3)} DN`],
    ["Least, most", `${s.least}, ${s.most} DN`],
    ["At full scale", `${number(100 * s.saturated / f.samples.length)} %`],
  ]);
  drawHistogram();
  showChips();
}

// --- Plots.
function plot(canvas) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = width * ratio; canvas.height = height * ratio;
  const c = canvas.getContext("2d");
  c.scale(ratio, ratio);
  c.font = "11px system-ui, sans-serif";
  c.fillStyle = colour("--soft");
  return { c, width, height: height - 16 };
}
function drawHistogram() {
  const { c, width, height } = plot($("histogram")), counts = picture.counts, bins = Math.min(counts.length, 192);
  const sums = new Float64Array(bins);
  counts.forEach((n, value) => { sums[Math.floor(value * bins / counts.length)] += n; });
  const most = Math.log1p(Math.max(...sums));
  const at = value => value / counts.length * width;
  c.fillText("0", 0, height + 13);
  c.textAlign = "right";
  c.fillText(`${counts.length - 1} DN`, width, height + 13);
  c.fillStyle = colour("--accent");
  sums.forEach((n, i) => { const h = height * Math.log1p(n) / most; c.fillRect(i * width / bins, height - h, Math.max(1, width / bins - 0.5), h); });
  c.strokeStyle = colour("--second");
  c.setLineDash([3, 2]);
  for (const level of [picture.black, picture.white]) {
    const x = Math.min(width - 1, at(level)) + 0.5;
    c.beginPath(); c.moveTo(x, 0); c.lineTo(x, height); c.stroke();
  }
  c.strokeStyle = colour("--line");
  c.setLineDash([]);
  c.beginPath(); c.moveTo(0, height + 0.5); c.lineTo(width, height + 0.5); c.stroke();
}
const DELAYS = [["first_packet", "to the first packet", "--accent"], ["last_packet", "to the last packet", "--second"]];
function drawLatency() {
  const { c, width, height } = plot($("latency")), all = DELAYS.flatMap(([key]) => status.latency_ms[key].buckets);
  if (all.length === 0) {
    c.textAlign = "center";
    c.fillText("no command shown by a delivered frame yet", width / 2, height / 2);
  } else {
    const from = Math.floor(Math.log10(Math.min(...all.map(b => b[0])))), to = Math.ceil(Math.log10(1.19 * Math.max(...all.map(b => b[0]))));
    const most = Math.max(...all.map(b => b[1])), at = value => (Math.log10(value) - from) / (to - from) * width;
    c.strokeStyle = colour("--line");
    for (let decade = from; decade <= to; decade++) {
      const x = Math.min(width - 0.5, at(10 ** decade) + 0.5);
      c.beginPath(); c.moveTo(x, 0); c.lineTo(x, height); c.stroke();
      c.textAlign = decade === from ? "left" : decade === to ? "right" : "center";
      c.fillText(decade < 0 ? `${10 ** (decade + 3)} µs` : decade < 3 ? `${10 ** decade} ms` : `${10 ** (decade - 3)} s`, x, height + 13);
    }
    for (const [key, , name] of DELAYS) {
      c.fillStyle = colour(name);
      c.globalAlpha = 0.65;
      for (const [start, n] of status.latency_ms[key].buckets) {
        const h = height * n / most;
        c.fillRect(at(start), height - h, Math.max(1, at(start * 2 ** 0.25) - at(start) - 0.5), h);
      }
    }
    c.globalAlpha = 1;
  }
  rows($("latency-table"), DELAYS.map(([key, text, name]) => {
    const swatch = make("span", { className: "swatch" }), h = status.latency_ms[key];
    swatch.style.background = colour(name);
    return [make("span", {}, swatch, text), ...(h.count ? [ms(h.p50), ms(h.p99), ms(h.max)] : ["–", "–", "–"])];
  }), ["", "p50", "p99", "most"]);
}

// --- Figures.
function chip(text, value, state = "") { return make("span", { className: "chip " + state }, text + " ", make("b", {}, value)); }
function showChips() {
  if (!status) return;
  const s = status.settings;
  const mode = !s.running ? ["stopped", "warn"] : status.camera.lockstep ? ["lockstep", "good"] : s.triggered ? ["triggered", "good"] : ["free-run", "good"];
  const rate = before ? 1e9 * (status.frames - before.frames) / (status.monotonic_ns - before.monotonic_ns) : NaN;
  $("chips").replaceChildren(
    ...(link ? [chip("link", link, "bad")] : []),
    ...(picture.frozen ? [chip("picture", "frozen", "warn")] : []),
    chip("mode", ...mode),
    ...(status.clock.stands ? [chip("time", "stands", "warn")] : status.clock.scale !== 1 ? [chip("time", number(status.clock.scale) + " times", "warn")] : []),
    chip("camera", number(rate) + " frames/s"),
    chip("shown", number(picture.shownRate()) + " frames/s"),
    chip("missed", number(status.deadline_misses), status.deadline_misses ? "warn" : ""),
    ...(status.quality?.levels > 1 ? [chip("quality level", number(status.quality.level), status.quality.level ? "warn" : "")] : []),
    ...(status.quality?.within_noise_budget != null ? [chip("within noise budget", number(100 * status.quality.within_noise_budget) + " %")] : []));
}
const STAGES = [["setup", "set up"], ["trace", "trace"], ["stars", "stars"], ["collapse", "collapse"], ["convolve", "convolve"],
  ["points", "points"], ["digitise", "digitise"], ["publish", "publish"], ["render", "render, all"], ["sense", "sense, all"]];
function showFigures() {
  const stages = status.stages_ms, most = Math.max(...STAGES.map(([key]) => stages[key]?.p50 ?? 0));
  rows($("stages"), STAGES.filter(([key]) => stages[key]).map(([key, name]) => {
    const bar = make("i"), level = make("span", { className: "level" }, bar);
    bar.style.width = `${100 * stages[key].p50 / most}%`;
    return [name, level, ms(stages[key].p50), ms(stages[key].p99)];
  }), ["", "", "p50", "p99"]);
  const all = status.commands, links = all.links;
  const counts = c => [c.clients, c.received, c.refused, c.lost].map(n => number(n, 9));
  rows($("commands"), [...links.map(l => [l.name, ...counts(l)]), ...(links.length === 1 ? [] : [["all", ...counts(all)]])],
    ["", "clients", "received", "refused", "lost"]);
  $("outputs").replaceChildren(...status.outputs.map(o => make("div", { className: "output" },
    make("div", {}, o.name),
    make("div", { className: "figures" }, [["frames", o.frames], ["dropped", o.dropped], ...Object.entries(o.figures)]
      .map(([name, value]) => `${name.replaceAll("_", " ")} ${number(value, 4)}`).join(" · ")),
    ...(o.fault ? [make("div", { className: "bad" }, o.fault)] : []))));
}

// --- Orders.
async function order(path, fields, answer) {
  const body = Object.entries(fields).map(([key, value]) => `${key}=${value}`).join("&");
  try {
    const response = await fetch(path, { method: "POST", body });
    answer.textContent = response.ok ? "" : (await response.text()).trim();
  } catch { answer.textContent = "no answer"; }
  await refresh();
}

// --- Settings: [key, label, unit, units per SI] or [key, label, choices].
const SETTINGS = [
  ["exposure_s", "Exposure", "ms", 1e3], ["gain_db", "Gain", "dB", 1], ["black_level_dn", "Black level", "DN", 1],
  ["frame_rate_hz", "Frame rate", "Hz", 1], ["trigger_delay_s", "Trigger delay", "ms", 1e3], ["burst_frames", "Frames of a trigger", "", 1],
  ["triggered", "Trigger mode", [["0", "free-run"], ["1", "triggered"]]],
  ["trigger_source", "Trigger source", [["software", "software"], ["line0", "line 0 (expose)"], ["action1", "action 1"]]],
  ["test_pattern", "Test pattern", [["off", "off"], ["black", "black"], ["white", "white"], ["ramp_horizontal", "ramp across"],
    ["ramp_vertical", "ramp down"], ["ramp_horizontal_moving", "moving ramp"]]],
];
const inputs = {};
function isOwn(key) {
  const l = status.limits;
  return (key === "exposure_s" && (l.exposure_is_own || status.settings.automatic_exposure)) || (key === "gain_db" && l.gain_is_own) ||
    (key === "frame_rate_hz" && l.frame_rate_is_own) || (key === "triggered" && status.camera.lockstep);
}
function buildSettings() {
  const form = $("settings"), change = (key, value) => order("settings", { [key]: value }, $("settings-answer"));
  for (const [key, label, kind, factor] of SETTINGS) {
    const id = "set-" + key, choices = Array.isArray(kind);
    const input = choices
      ? make("select", { id }, ...kind.map(([value, text]) => make("option", { value }, text)))
      : make("input", { id, type: "number", step: "any" });
    input.addEventListener("change", () => { if (input.value !== "") change(key, choices ? input.value : Number(input.value) / factor); });
    const range = make("span", { className: "range" });
    if (!choices && status.limits[key]) {
      const [least, most] = status.limits[key].map(v => v * factor);
      range.textContent = `${number(least)} to ${number(most, 4)} ${kind}`;
    }
    form.append(make("label", { htmlFor: id }, label), input, range);
    inputs[key] = { input, factor: choices ? null : factor };
  }
  const flags = make("div", { className: "wide" });
  for (const [key, label, there] of [["automatic_exposure", "auto exposure", status.limits.has_automatic_exposure],
    ["reverse_x", "reverse x", status.limits.reversible], ["reverse_y", "reverse y", status.limits.reversible]]) {
    if (!there) continue;
    const input = make("input", { type: "checkbox", id: "set-" + key });
    input.addEventListener("change", () => change(key, input.checked ? 1 : 0));
    inputs[key] = { input };
    flags.append(make("label", {}, input, " " + label));
  }
  if (status.limits.binning[1] > 1) {
    const values = [1, 2, 4, 8].filter(b => b <= status.limits.binning[1]);
    const input = make("select", { id: "set-binning_x" }, ...values.map(b => make("option", { value: b }, `${b} x ${b}`)));
    input.addEventListener("change", () => order("settings", { binning_x: input.value, binning_y: input.value }, $("settings-answer")));
    form.append(make("label", { htmlFor: input.id }, "Binning"), input, make("span"));
    inputs.binning_x = { input, factor: 1 };
  }
  const run = make("button", { type: "button", id: "run" });
  run.addEventListener("click", () => change("running", status.settings.running ? 0 : 1));
  const trigger = make("button", { type: "button", id: "trigger", className: "primary" }, "Trigger");
  trigger.addEventListener("click", () => order("trigger", { source: status.camera.lockstep ? "line0" : status.settings.trigger_source }, $("settings-answer")));
  if (flags.childElementCount) form.append(flags);
  form.append(make("div", { className: "wide" }, run, trigger));
  form.addEventListener("submit", event => event.preventDefault());
}
function showSettings() {
  if (!inputs.exposure_s) buildSettings();
  for (const [key, { input, factor }] of Object.entries(inputs)) {
    const value = status.settings[key];
    input.disabled = isOwn(key);
    if (document.activeElement === input) continue;
    if (input.type === "checkbox") input.checked = value;
    else input.value = typeof value === "boolean" ? (value ? "1" : "0") : factor ? Number((value * factor).toPrecision(6)) : value;
  }
  $("run").textContent = status.settings.running ? "Stop the camera" : "Start the camera";
  $("trigger").disabled = !status.settings.triggered || !status.settings.running;
}

// --- Faults.
const GROUPS = [[20, "Stream packets"], [30, "Frames"], [40, "Time stamps"], [50, "Control channel"], [60, "Device"], [70, "V4L2"],
  [80, "USB"], [256, "Picture"]];
const faults = {};
function isActive(fault) {
  const o = fault.order, newest = picture.frame?.id ?? 0n;
  return !!o && (!o.frames || newest < BigInt(o.from_frame) + BigInt(o.frames));
}
function buildFaults() {
  let group = 0, box = null;
  for (const fault of status.faults) {
    if (!box || fault.number >= GROUPS[group][0]) {
      while (fault.number >= GROUPS[group][0]) group++;
      box = make("div", {}, make("h3", {}, GROUPS[group][1]));
      $("faults").append(box);
    }
    const strikes = make("span", { className: "strikes" });
    const button = make("button", { type: "button" });
    const kind = fault.kind;
    button.addEventListener("click", () => order("fault", faults[kind].active ? { kind, rate: 0 }
      : { kind, rate: $("rate").value, value: $("value").value, frames: $("frames").value, duration_s: $("duration").value }, $("fault-answer")));
    const row = make("div", { className: "fault", id: "fault-" + kind },
      make("span", { className: "name" }, kind.replaceAll("_", " ")), strikes, button, make("p", {}, fault.meaning));
    box.append(row);
    faults[kind] = { row, strikes, button, active: false };
  }
  $("clear").addEventListener("click", () => order("fault", { clear_all: 1 }, $("fault-answer")));
  $("order").addEventListener("submit", event => event.preventDefault());
}
function showFaults() {
  if ($("faults").childElementCount === 0) buildFaults();
  let count = 0;
  for (const fault of status.faults) {
    const shown = faults[fault.kind];
    shown.active = isActive(fault);
    count += shown.active;
    shown.row.classList.toggle("active", shown.active);
    shown.button.textContent = shown.active ? "End" : "Strike";
    shown.strikes.textContent = fault.strikes ? number(fault.strikes, 6) + " x" : "";
  }
  $("faults-active").textContent = count ? count + " in force" : "";
}

// --- The clock of the page.
async function refresh() {
  try {
    const answer = await fetch("status");
    if (!answer.ok) throw new Error((await answer.text()).trim());
    const news = await answer.json();
    if (!status || news.monotonic_ns - status.monotonic_ns > 5e8) before = status;
    status = news;
    if (link === "connecting") link = "";
  } catch (error) {
    link = "no answer";
    return showChips();
  }
  document.title = `${status.camera.name || "camera"} – hilcam`;
  $("camera").textContent = status.camera.name || "hilcam";
  $("scenario").textContent = status.scenario;
  showSettings(); showFigures(); drawLatency(); showFaults(); showChips();
}

function freeze() {
  picture.frozen = !picture.frozen;
  $("freeze").setAttribute("aria-pressed", picture.frozen);
  showChips();
}
function one() { picture.zoom(window.devicePixelRatio || 1); }
$("freeze").addEventListener("click", freeze);
$("fit").addEventListener("click", () => picture.fit());
$("one").addEventListener("click", one);
$("stretch").addEventListener("change", () => { picture.stretch = $("stretch").value; picture.draw(); });
$("auto").addEventListener("change", () => { picture.auto = $("auto").value; picture.level(); picture.draw(); });
for (const name of ["black", "white"])
  $(name).addEventListener("input", () => {
    $("auto").value = picture.auto = "manual";
    picture[name] = Math.max(0, Number($(name).value));
    picture.draw();
    if (picture.frame) drawHistogram();
  });
document.addEventListener("keydown", event => {
  if (event.target.matches(event.key === " " ? "input, select, button" : "input, select") || event.ctrlKey || event.metaKey || event.altKey) return;
  const act = { " ": freeze, f: () => picture.fit(), F: () => picture.fit(), 1: one, "+": () => picture.zoom(picture.shownScale() * 2),
    "-": () => picture.zoom(picture.shownScale() / 2) }[event.key];
  if (!act) return;
  event.preventDefault();
  act();
});
refresh();
setInterval(refresh, 1000);
