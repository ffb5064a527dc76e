// The page around the picture: figures of GET /status once a second, settings, trigger, faults.

import { FaultBoard } from "./faults.js";
import { LAYERS } from "./overlay.js";
import { Picture } from "./picture.js";
import { colour, DELAYS, drawHistogram, drawLatency, drawProfile, number } from "./plots.js";
import { lengthOf, samplesAlong } from "./profile.js";
import { saveNumbers, saveView } from "./save.js";
import { keepView, readView } from "./view_state.js";

const $ = id => document.getElementById(id);
function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
const ms = value => number(value) + " ms";
// TAI has no leap seconds, so its nanoseconds are a calendar; UTC is the server's to tell.
const tai = ns => new Date(Number(ns / 1000000n)).toISOString().slice(0, -1).replace("T", " ");
const clocks = (name, utc, ns) => ns === 0n ? [[name, "none"]]
  : [[name, utc.replace("T", " ").replace("Z", " UTC")], ["", tai(ns) + " TAI"]];
function pairs(list, entries) {
  list.replaceChildren(...entries.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
}
function rows(table, lines, head) {
  const row = (cell, cells) => make("tr", {}, ...cells.map(c => make(cell, {}, c)));
  table.replaceChildren(...(head ? [row("th", head)] : []), ...lines.map(line => row("td", line)));
}

let status = null, before = null, link = "connecting", latest = null;  // latest: of the poses that frames have shown
const histogram = { logarithmic: true };

// --- The picture.
const picture = new Picture($("picture"), {
  onframe: showFrame,
  onpixel: showPixel,
  onview: scale => {
    const ratio = window.devicePixelRatio || 1, reduced = picture.frame.step > 1 ? `, every ${picture.frame.step} x ${picture.frame.step} pixels as their mean` : "";
    $("zoom").textContent = `${number(100 * scale / ratio)} %${reduced}`;
    for (const name of ["black", "white"]) if (document.activeElement !== $(name)) $(name).value = picture[name];
    keepView(picture, histogram);
  },
  online: showProfile,
  onlink: text => { link = text; showChips(); },
  onrefused: why => { showLight(why); keepView(picture, histogram); },
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
  if (document.body.classList.contains("no-frame")) showWaiting();  // before what draws into boxes that were hidden
  const struck = status ? [...status.faults, ...status.frame_flags].filter(x => f.faults >> BigInt(x.bit) & 1n).map(x => x.kind).join(", ") : "";
  pairs($("frame"), [
    ["Frame", f.id.toString()],
    ["Exposure", ms(1e3 * f.exposure)],
    ["Gain", number(f.gain) + " dB"],
    ["Black level", number(f.blackLevel) + " DN"],
    ...clocks("Exposed at", f.exposureMidUtc, f.exposureMidTai),
    ["Pose", f.poseSequence ? "command " + f.poseSequence : "of the scenario"],
    ...clocks("Pose tag", f.poseUtc, f.poseTai),
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
  // What is saved are numbers of frames, not of a part of their light.
  for (const format of ["png", "tiff"]) $("save-" + format).disabled = !!f.light;
  if (f.poseSequence) latest = f.poseSequence;
  showTruthNote();
  showHistogram();
  showProfile();
  showChips();
}
// The next frame comes with it; a frozen one does not get it any more.
function showTruthNote() {
  $("truth-note").textContent = picture.layers.size && !picture.frame.truth && picture.frozen ? "no truth of this frame " : "";
}
function showHistogram() { drawHistogram($("histogram"), picture, histogram.logarithmic); }
function showProfile() {
  $("profile-card").hidden = !picture.line;
  if (!picture.line || !picture.frame) return;
  const values = samplesAlong(picture, picture.line), known = values.filter(v => v !== null), line = picture.line;
  const spread = known.length ? `, ${Math.min(...known)} to ${Math.max(...known)} DN` : "";
  $("profile-of").textContent = `from x ${number(line.x0, 4)} y ${number(line.y0, 4)} to x ${number(line.x1, 4)} y ${number(line.y1, 4)}${spread}`;
  drawProfile($("profile"), values, lengthOf(line));
}

// --- Latency.
function showLatency() {
  const times = status.outputs.some(o => /^(gige|v4l2|uvc|usb)/.test(o.name));
  drawLatency($("latency"), status.latency_ms,
    !latest ? ["no frame has shown a command yet"]
      : times ? ["commands are shown, but nobody takes", "the frames, so none is delivered"]
        : ["commands are shown; deliveries are timed", "by outputs.gige, v4l2 and uvc, not here"]);
  rows($("latency-table"), DELAYS.map(([key, text, name]) => {
    const swatch = make("span", { className: "swatch" }), h = status.latency_ms[key];
    swatch.style.background = colour(name);
    return [make("span", {}, swatch, text), ...(h.count ? [ms(h.p50), ms(h.p99), ms(h.max)] : ["–", "–", "–"])];
  }), ["", "p50", "p99", "most"]);
}

// --- What the page waits for, in the picture's place, until there is one.
const opened = performance.now();
function waitsFor() {
  if (picture.frame) return "";
  if (!status) {
    if (link === "no answer") return "the camera does not answer: is 'hilcam run' still up?";
    return `waiting for the camera's first answer: loading, ${Math.floor((performance.now() - opened) / 1000)} s`;
  }
  if (!status.settings.running) return "no frame yet: the camera is stopped";
  if (status.camera.lockstep) return "no frame yet: in lockstep each 'expose' takes one";
  if (status.settings.triggered) return "no frame yet: the camera waits for a trigger";
  return "no frame yet: the first is being made";
}
function showWaiting() {
  $("waiting").textContent = waitsFor();
  document.body.classList.toggle("no-status", !status);
  document.body.classList.toggle("no-frame", !picture.frame);
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
    ...(picture.frame?.light ? [chip("light", picture.frame.light, "warn")] : []),
    chip("mode", ...mode),
    ...(status.clock.stands ? [chip("time", "stands", "warn")] : status.clock.scale !== 1 ? [chip("time", number(status.clock.scale) + " times", "warn")] : []),
    chip("camera", number(rate) + " frames/s"),
    chip("shown", number(picture.shownRate()) + " frames/s"),
    chip("missed", number(status.deadline_misses), status.deadline_misses ? "warn" : ""),
    ...(status.quality?.levels > 1 ? [chip("quality level", number(status.quality.level), status.quality.level ? "warn" : "")] : []),
    ...(status.quality?.light_made != null ? [chip("light between surfaces", number(100 * status.quality.light_made, 2) + " % made", "warn")] : []));
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
      .filter(([name, value]) => name === "frames" || value !== 0)
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
const faults = new FaultBoard($("faults"), fields => order("fault", fields, $("fault-answer")),
  () => ({ rate: $("rate").value, value: $("value").value, frames: $("frames").value, duration_s: $("duration").value }));
$("clear").addEventListener("click", () => order("fault", { clear_all: 1 }, $("fault-answer")));
$("order").addEventListener("submit", event => event.preventDefault());
function showFaults() {
  const count = faults.show(status.faults, picture.frame?.id ?? 0n);
  $("faults-active").textContent = count ? count + " in force" : "";
}

// --- The bench's cameras, each with a page of its own; how the picture is looked at goes along.
function showCameras() {
  const pages = status.cameras.filter(camera => camera.port);
  if (pages.length < 2 || $("camera-choice").childElementCount) return;
  $("camera-choice").replaceChildren(...pages.map(camera =>
    make("option", { value: camera.port, selected: camera.own }, `${camera.number} ${camera.name}`)));
  $("cameras").hidden = false;
}
$("camera-choice").addEventListener("change", () => {
  const to = new URL(location.href);
  to.port = $("camera-choice").value;
  location.assign(to);
});

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
    showWaiting();
    return showChips();
  }
  document.title = `${status.camera.name || "camera"} – hilcam`;
  $("camera").textContent = status.camera.name || "hilcam";
  $("scenario").textContent = status.scenario;
  showWaiting();  // before what draws into boxes that were hidden
  showSettings(); showFigures(); showLatency(); showFaults(); showCameras(); showChips();
}

async function freeze() {
  if (picture.frozen) picture.frozen = false;
  else await picture.freeze();
  $("freeze").setAttribute("aria-pressed", picture.frozen);
  showChips();
}
function one() { picture.zoom(window.devicePixelRatio || 1); }
$("freeze").addEventListener("click", freeze);
$("fit").addEventListener("click", () => picture.fit());
$("one").addEventListener("click", one);
function showLight(why) {
  $("light").value = picture.light;
  $("light-answer").textContent = why;
}
// --- How the picture is looked at.
function showView() {
  showLight("");
  $("stretch").value = picture.stretch;
  $("auto").value = picture.auto;
  for (const layer of LAYERS) $("show-" + layer).checked = picture.layers.has(layer);
  $("histogram-log").checked = histogram.logarithmic;
  showProfile();
}
for (const layer of LAYERS)
  $("show-" + layer).addEventListener("change", () => {
    picture.layers[$("show-" + layer).checked ? "add" : "delete"](layer);
    if (!picture.frame) return;
    picture.draw();
    showTruthNote();
  });
$("light").addEventListener("change", () => {
  picture.light = $("light").value;
  showLight(picture.frozen ? "the frame that is frozen stays as it is" : "");
  keepView(picture, histogram);
});
$("histogram-log").addEventListener("change", () => {
  histogram.logarithmic = $("histogram-log").checked;
  if (picture.frame) showHistogram();
  keepView(picture, histogram);
});
// On: dragging draws the line; off: there is none.
function setProfile(on) {
  picture.drawing = on;
  if (!on) picture.line = null;
  $("profile-tool").setAttribute("aria-pressed", on);
  showProfile();
  if (picture.frame) picture.draw();
}
$("profile-tool").addEventListener("click", () => setProfile(!picture.drawing));
$("save-view").addEventListener("click", () => { if (picture.frame) saveView(picture); });
for (const format of ["png", "tiff"])
  $("save-" + format).addEventListener("click", async () => {
    if (picture.frame) $("save-answer").textContent = await saveNumbers(picture, format);
  });
function takeAddress() {
  readView(picture, histogram);
  if (![...$("light").options].some(option => option.value === picture.light)) picture.light = "";
  picture.drawing = !!picture.line;
  $("profile-tool").setAttribute("aria-pressed", picture.drawing);
  showView();
  if (!picture.frame) return;
  picture.level();
  picture.draw();
  showHistogram();
}
window.addEventListener("hashchange", takeAddress);
takeAddress();
$("stretch").addEventListener("change", () => { picture.stretch = $("stretch").value; picture.draw(); });
$("auto").addEventListener("change", () => { picture.auto = $("auto").value; picture.level(); picture.draw(); });
for (const name of ["black", "white"])
  $(name).addEventListener("input", () => {
    $("auto").value = picture.auto = "manual";
    picture[name] = Math.max(0, Number($(name).value));
    picture.draw();
    if (picture.frame) showHistogram();
  });
document.addEventListener("keydown", event => {
  if (event.target.matches(event.key === " " ? "input, select, button" : "input, select") || event.ctrlKey || event.metaKey || event.altKey) return;
  const act = { " ": freeze, f: () => picture.fit(), F: () => picture.fit(), 1: one, "+": () => picture.zoom(picture.shownScale() * 2),
    "-": () => picture.zoom(picture.shownScale() / 2), Escape: () => setProfile(false) }[event.key];
  if (!act) return;
  event.preventDefault();
  act();
});
showWaiting();
refresh();
setInterval(() => { showWaiting(); refresh(); }, 1000);
