// The live picture: fetched as 16-bit samples, stretched, drawn, zoomed and read here.

import { drawTruth } from "./overlay.js";
import { drawLine } from "./profile.js";

// Frames up to this size come whole, so that a frozen one can be looked at pixel by pixel; of larger ones
// come the part in view, reduced as the screen shows it.
const WHOLE_SAMPLES = 1.6e6;
const GRID_FROM = 12, VALUES_FROM = 44;  // device pixels per pixel

const STRETCHES = {
  linear: t => t,
  sqrt: Math.sqrt,
  log: t => Math.log1p(1000 * t) / Math.log1p(1000),
  asinh: t => Math.asinh(50 * t) / Math.asinh(50),
};

// The answer to GET /frame (docs/preview.md).
function decode(buffer) {
  const v = new DataView(buffer);
  const u32 = at => v.getUint32(at, true), i64 = at => v.getBigInt64(at, true), f64 = at => v.getFloat64(at, true);
  const text = (at, length) => new TextDecoder().decode(new Uint8Array(buffer, at, length)).replace(/\0/g, "");
  return {
    id: v.getBigUint64(8, true), frameWidth: u32(16), frameHeight: u32(20), x: u32(24), y: u32(28), width: u32(32),
    height: u32(36), step: u32(40), bits: u32(44), exposureMidTai: i64(48), poseTai: i64(56), exposureMid: i64(64),
    commandArrival: i64(72), exposure: f64(80), gain: f64(88), blackLevel: f64(96), faults: v.getBigUint64(104, true),
    poseSequence: u32(112), triggerSequence: u32(116), quality: u32(120), binning: [u32(124), u32(128)], pattern: text(132, 4),
    hasTruth: u32(136) === 1, exposureMidUtc: text(144, 32), poseUtc: text(176, 32), truth: null,
    samples: new Uint16Array(buffer, u32(4)),
  };
}

export class Picture {
  constructor(canvas, { onframe, onpixel, onview, onlink, online, onrefused }) {
    Object.assign(this, { canvas, onframe, onpixel, onview, onlink, online, onrefused });
    this.viewer = crypto.getRandomValues(new Uint32Array(1))[0];
    this.frame = null;
    this.frozen = false;
    this.stretch = "linear";
    this.auto = "99.95";
    this.black = 0;
    this.white = 4095;
    this.scale = 0;  // device pixels per frame pixel; 0: fit
    this.centre = null;
    this.cursor = null;
    this.light = "";          // the part of the light that is shown; empty: the picture
    this.layers = new Set();  // of truth, that are drawn
    this.drawn = null;        // how many of each
    this.line = null;         // of the profile, in the frame's pixels
    this.drawing = false;     // dragging draws it
    this.arrivals = [];
    this.sheet = document.createElement("canvas");
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.listen();
    this.poll();
    setInterval(() => this.hurry(), 100);
  }

  // --- Frames.
  async poll() {
    let after = 0n;
    this.asked = "";
    for (;;) {
      if (this.frozen || this.freezing || document.hidden) { await new Promise(r => setTimeout(r, 100)); continue; }
      const part = this.part(), light = this.light;
      if (part !== this.asked) after = 0n;  // another part of the same frame is news too
      this.asked = part;
      this.patience = new AbortController();
      try {
        const answer = await fetch(`frame?viewer=${this.viewer}&after=${after}${part}`, { signal: this.patience.signal });
        const why = answer.ok ? "" : (await answer.text()).trim();
        if (light && (answer.status === 400 || answer.status === 409)) { this.refuseLight(why); continue; }
        this.onlink(why);
        if (answer.status === 200) {
          const frame = await this.withTruth(decode(await answer.arrayBuffer()));
          after = frame.id;
          frame.light = light;
          if (!this.frozen && !this.freezing) this.take(frame);
        } else if (answer.status !== 204) await new Promise(r => setTimeout(r, 500));
      } catch (error) {
        if (error.name === "AbortError") continue;
        this.onlink("no answer");
        await new Promise(r => setTimeout(r, 1000));
      }
    }
  }
  // What is drawn over a frame is there when the frame is shown.
  async withTruth(frame) {
    if (!frame.hasTruth || !this.layers.size) return frame;
    const answer = await fetch(`truth?frame=${frame.id}`);
    if (answer.ok) frame.truth = await answer.json();
    return frame;
  }
  // Shows the newest frame, which the server keeps so that its numbers can be saved; without an answer, the one shown.
  async freeze() {
    if (this.freezing) return;
    this.freezing = true;
    this.patience?.abort();
    const light = this.light;
    try {
      for (let i = 0; i < 5; i++) {
        const answer = await fetch(`frame?viewer=${this.viewer}&hold=1${this.part()}`);
        if (answer.status === 200) {
          this.take(Object.assign(await this.withTruth(decode(await answer.arrayBuffer())), { light }));
          break;
        }
        await new Promise(r => setTimeout(r, 100));  // too many at once
      }
    } catch { this.onlink("no answer"); }
    this.frozen = true;
    this.freezing = false;
  }
  // This camera's frames are not taken apart: the picture is shown as before.
  refuseLight(why) {
    this.light = "";
    this.onlink("");
    this.onrefused(why);
  }
  // The view has moved on while a frame is waited for: ask for the new part.
  hurry() { if (this.asked !== this.part()) this.patience?.abort(); }
  part() {
    const f = this.frame, wishes = (this.light ? `&light=${this.light}` : "") + (this.layers.size ? "&truth=1" : "");
    if (!f || f.frameWidth * f.frameHeight <= WHOLE_SAMPLES) return wishes;
    const s = this.shownScale(), c = this.shownCentre();
    const w = this.canvas.width / s, h = this.canvas.height / s;
    const clamp = (value, most) => Math.max(0, Math.min(most, Math.floor(value)));
    const x = clamp(c.x - w / 2, f.frameWidth - 1), y = clamp(c.y - h / 2, f.frameHeight - 1);
    const step = Math.min(256, Math.max(1, Math.floor(1 / s)));
    return `&x=${x}&y=${y}&width=${Math.ceil(Math.min(f.frameWidth, w + 1))}&height=${Math.ceil(Math.min(f.frameHeight, h + 1))}&step=${step}${wishes}`;
  }
  take(frame) {
    const now = performance.now();
    if (!this.frame || this.frame.id !== frame.id) this.arrivals.push(now);
    this.frame = frame;
    this.count();
    this.draw();
    this.onframe(frame);
  }
  shownRate() {
    const since = performance.now() - 2000;
    this.arrivals = this.arrivals.filter(t => t > since);
    return this.arrivals.length / 2;
  }

  // --- Stretch.
  count() {
    const { samples, bits } = this.frame;
    const counts = new Uint32Array(1 << bits);
    let sum = 0, squares = 0, saturated = 0, least = 65535, most = 0;
    const top = (1 << bits) - 1;
    for (const s of samples) {
      counts[Math.min(s, top)]++;
      sum += s; squares += s * s;
      if (s < least) least = s;
      if (s > most) most = s;
      if (s >= top) saturated++;
    }
    const mean = sum / samples.length;
    this.statistics = { least, most, mean, deviation: Math.sqrt(Math.max(0, squares / samples.length - mean * mean)), saturated };
    this.counts = counts;
    this.level();
  }
  // Black and white as `auto` says.
  level() {
    if (!this.frame || this.auto === "manual") return;
    const top = (1 << this.frame.bits) - 1, { least, most } = this.statistics;
    if (this.auto === "full") { this.black = 0; this.white = top; return; }
    const outside = (1 - this.auto / 100) * this.frame.samples.length;
    let black = least, white = most, seen = this.counts[black];
    while (seen <= outside && black < white) seen += this.counts[++black];
    seen = this.counts[white];
    while (seen <= outside && white > black) seen += this.counts[--white];
    // A few lit pixels in the dark are what is looked for.
    this.black = black;
    this.white = Math.min(top, white - black >= 8 ? white : Math.max(most, black + 8));
  }
  table() {
    const size = 1 << this.frame.bits, table = new Uint8ClampedArray(size), shape = STRETCHES[this.stretch];
    const range = Math.max(1, this.white - this.black);
    for (let v = 0; v < size; v++) table[v] = 255 * shape(Math.min(1, Math.max(0, (v - this.black) / range)));
    return table;
  }

  // --- View.
  fitScale() {
    const f = this.frame;
    return f ? Math.min(this.canvas.width / f.frameWidth, this.canvas.height / f.frameHeight) : 1;
  }
  shownScale() { return this.scale || this.fitScale(); }
  shownCentre() {
    return this.centre || { x: this.frame ? this.frame.frameWidth / 2 : 0, y: this.frame ? this.frame.frameHeight / 2 : 0 };
  }
  fit() { this.scale = 0; this.centre = null; this.draw(); }
  // `at`: the point of the canvas that stays where it is.
  zoom(scale, at = { x: this.canvas.width / 2, y: this.canvas.height / 2 }) {
    const before = this.toFrame(at);
    this.scale = Math.min(128, Math.max(this.fitScale() / 4, scale));
    const c = this.shownCentre(), after = this.toFrame(at);
    this.centre = { x: c.x + before.x - after.x, y: c.y + before.y - after.y };
    this.draw();
  }
  toFrame(at) {
    const s = this.shownScale(), c = this.shownCentre();
    return { x: (at.x - this.canvas.width / 2) / s + c.x, y: (at.y - this.canvas.height / 2) / s + c.y };
  }
  // A frame's pixel as it is shown, or null where there is none.
  valueAt(x, y) {
    const f = this.frame;
    if (!f) return null;
    const i = Math.floor((x - f.x) / f.step), j = Math.floor((y - f.y) / f.step);
    return i >= 0 && j >= 0 && i < f.width && j < f.height && x < f.frameWidth && y < f.frameHeight
      ? f.samples[j * f.width + i] : null;
  }
  resize() {
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(this.canvas.clientWidth * ratio);
    this.canvas.height = Math.round(this.canvas.clientHeight * ratio);
    this.draw();
  }
  draw() {
    const f = this.frame, context = this.canvas.getContext("2d");
    if (!f) return;
    const table = this.table(), top = table.length - 1;
    if (this.sheet.width !== f.width || this.sheet.height !== f.height) {
      this.sheet.width = f.width; this.sheet.height = f.height;
    }
    const sheet = this.sheet.getContext("2d"), image = sheet.createImageData(f.width, f.height);
    const out = new Uint32Array(image.data.buffer);
    for (let i = 0; i < out.length; i++) out[i] = 0xff000000 | 0x010101 * table[Math.min(f.samples[i], top)];
    sheet.putImageData(image, 0, 0);
    const s = this.shownScale(), c = this.shownCentre();
    const left = this.canvas.width / 2 - c.x * s, upper = this.canvas.height / 2 - c.y * s;
    context.fillStyle = "#000";
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    context.imageSmoothingEnabled = s * f.step < 1;
    context.drawImage(this.sheet, left + f.x * s, upper + f.y * s, f.width * f.step * s, f.height * f.step * s);
    context.strokeStyle = "#5b6570";
    context.strokeRect(left - 0.5, upper - 0.5, f.frameWidth * s + 1, f.frameHeight * s + 1);
    if (s >= GRID_FROM && f.step === 1) this.drawPixels(context, s, left, upper, table);
    const place = (x, y) => ({ x: left + x * s, y: upper + y * s });
    this.drawn = f.truth && this.layers.size
      ? drawTruth(context, f.truth, this.layers, { place, scale: s, ratio: window.devicePixelRatio || 1 }) : null;
    if (this.line) drawLine(context, this.line, place);
    this.readPixel();
    this.onview(s);
  }
  // Lines between pixels, and their values where there is room.
  drawPixels(context, s, left, upper, table) {
    const f = this.frame, first = this.toFrame({ x: 0, y: 0 }), last = this.toFrame({ x: this.canvas.width, y: this.canvas.height });
    const x0 = Math.max(f.x, Math.floor(first.x)), x1 = Math.min(f.x + f.width, Math.ceil(last.x));
    const y0 = Math.max(f.y, Math.floor(first.y)), y1 = Math.min(f.y + f.height, Math.ceil(last.y));
    context.strokeStyle = "rgba(128, 140, 155, .35)";
    context.lineWidth = 1;
    context.beginPath();
    for (let x = x0; x <= x1; x++) { const at = Math.round(left + x * s) + 0.5; context.moveTo(at, upper + y0 * s); context.lineTo(at, upper + y1 * s); }
    for (let y = y0; y <= y1; y++) { const at = Math.round(upper + y * s) + 0.5; context.moveTo(left + x0 * s, at); context.lineTo(left + x1 * s, at); }
    context.stroke();
    if (s < VALUES_FROM) return;
    context.font = `${Math.round(s * 0.28)}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    for (let y = y0; y < y1; y++)
      for (let x = x0; x < x1; x++) {
        const value = this.valueAt(x, y);
        context.fillStyle = table[Math.min(value, table.length - 1)] > 128 ? "#000" : "#fff";
        context.fillText(value, left + (x + 0.5) * s, upper + (y + 0.5) * s);
      }
  }

  // --- Hands.
  readPixel() {
    if (!this.cursor || !this.frame) return this.onpixel(null);
    const p = this.toFrame(this.cursor), x = Math.floor(p.x), y = Math.floor(p.y), value = this.valueAt(x, y);
    this.onpixel(value === null ? null : { x, y, value });
  }
  // Points of the canvas; from null: where it began.
  setLine(from, to) {
    const begin = from ? this.toFrame(from) : { x: this.line.x0, y: this.line.y0 }, end = this.toFrame(to);
    this.line = { x0: begin.x, y0: begin.y, x1: end.x, y1: end.y };
    this.draw();
    this.online();
  }
  listen() {
    const ratio = () => window.devicePixelRatio || 1, c = this.canvas;
    const at = event => ({ x: event.offsetX * ratio(), y: event.offsetY * ratio() });
    let held = null;
    c.addEventListener("pointerdown", e => {
      held = at(e);
      c.setPointerCapture(e.pointerId);
      if (this.drawing && this.frame) this.setLine(held, held);
    });
    c.addEventListener("pointerup", () => { held = null; });
    c.addEventListener("pointermove", e => {
      this.cursor = at(e);
      if (!held) return this.readPixel();
      if (this.drawing && this.line) return this.setLine(null, this.cursor);
      const s = this.shownScale(), centre = this.shownCentre();
      this.scale = s;
      this.centre = { x: centre.x - (this.cursor.x - held.x) / s, y: centre.y - (this.cursor.y - held.y) / s };
      held = this.cursor;
      this.draw();
    });
    c.addEventListener("pointerleave", () => { this.cursor = null; this.readPixel(); });
    c.addEventListener("wheel", e => { e.preventDefault(); this.zoom(this.shownScale() * 2 ** (-e.deltaY / 300), at(e)); }, { passive: false });
    c.addEventListener("dblclick", () => this.fit());
  }
}
