// Plots beside the picture: histogram, profile along a line, latency. Values are drawn, nothing is kept here.

export const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export function number(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  return Math.abs(value) >= 10 ** digits ? Math.round(value).toLocaleString("en") : Number(value.toPrecision(digits)).toString();
}

// A canvas and the rectangle that axes enclose on it [CSS px].
function frameOf(canvas, left = 0) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = width * ratio; canvas.height = height * ratio;
  const c = canvas.getContext("2d");
  c.scale(ratio, ratio);
  c.font = "11px system-ui, sans-serif";
  c.fillStyle = colour("--soft");
  return { c, left, top: 8, width: width - left, height: height - 24, below: height - 4 };
}

// 1, 2 or 5 times a power of ten, for some four lines up to `most`.
function stepOf(most) {
  const rough = most / 4, power = 10 ** Math.floor(Math.log10(rough));
  return power * [1, 2, 5, 10].find(k => k * power >= rough);
}
function short(value) {
  return value >= 1e6 ? `${number(value / 1e6)} M` : value >= 1e4 ? `${number(value / 1e3)} k` : number(value, 5);
}

// Lines across at `values`, each with its figure, and the axis's name along it.
function verticalAxis({ c, left, top, width, height }, values, at, name) {
  c.strokeStyle = colour("--line");
  c.fillStyle = colour("--soft");
  c.textAlign = "right";
  c.textBaseline = "middle";
  for (const value of values) {
    const y = Math.round(top + height - at(value) * height) + 0.5;
    c.beginPath(); c.moveTo(left, y); c.lineTo(left + width, y); c.stroke();
    c.fillText(short(value), left - 5, y);
  }
  c.save();
  c.translate(8, top + height / 2);
  c.rotate(-Math.PI / 2);
  c.textAlign = "center";
  c.fillText(name, 0, 0);
  c.restore();
  c.textBaseline = "alphabetic";
}

export function drawHistogram(canvas, picture, logarithmic) {
  const plot = frameOf(canvas, 52), { c, left, top, width, height, below } = plot;
  canvas.setAttribute("aria-label", `pixels over DN, ${logarithmic ? "logarithmic" : "linear"}`);
  const counts = picture.counts, bins = Math.min(counts.length, 192);
  const sums = new Float64Array(bins);
  counts.forEach((n, value) => { sums[Math.floor(value * bins / counts.length)] += n; });
  const most = Math.max(1, ...sums), ticks = [];
  if (logarithmic) for (let n = 1; n <= most; n *= 10) ticks.push(n);
  else for (let n = 0, step = Math.max(1, stepOf(most)); n <= most; n += step) ticks.push(n);
  // A bin with one pixel is to be seen: logarithms begin at half a pixel.
  const at = n => logarithmic ? (n > 0 ? Math.log(2 * n) / Math.log(2 * most) : 0) : n / most;
  const shown = ticks.length > 6 ? ticks.filter((_, i) => i % 2 === 0) : ticks;
  const perBin = counts.length / bins;
  verticalAxis(plot, shown, at, `pixels${perBin > 1 ? ` per ${number(perBin, 4)} DN` : ""} (${logarithmic ? "log" : "linear"})`);
  c.textAlign = "left";
  c.fillText("0", left, below);
  c.textAlign = "right";
  c.fillText(`${counts.length - 1} DN`, left + width, below);
  c.fillStyle = colour("--accent");
  sums.forEach((n, i) => {
    const h = height * at(n);
    c.fillRect(left + i * width / bins, top + height - h, Math.max(1, width / bins - 0.5), h);
  });
  c.strokeStyle = colour("--second");
  c.setLineDash([3, 2]);
  for (const level of [picture.black, picture.white]) {
    const x = left + Math.min(width - 1, level / counts.length * width) + 0.5;
    c.beginPath(); c.moveTo(x, top); c.lineTo(x, top + height); c.stroke();
  }
  c.setLineDash([]);
}

// values: of the pixels along the line, null where none is shown; length: of the line [px].
export function drawProfile(canvas, values, length) {
  const plot = frameOf(canvas, 52), { c, left, top, width, height, below } = plot;
  const known = values.filter(v => v !== null);
  if (known.length === 0) {
    c.textAlign = "center";
    c.fillText("the line lies outside the picture", left + width / 2, top + height / 2);
    return;
  }
  const step = Math.max(1, stepOf(Math.max(4, Math.max(...known) - Math.min(...known))));
  const from = Math.floor(Math.min(...known) / step) * step, to = Math.max(from + step, Math.ceil(Math.max(...known) / step) * step);
  const at = value => (value - from) / (to - from), ticks = [];
  for (let value = from; value <= to; value += step) ticks.push(value);
  verticalAxis(plot, ticks, at, "DN");
  c.textAlign = "left";
  c.fillText("0", left, below);
  c.textAlign = "right";
  c.fillText(`${number(length, 4)} px along the line`, left + width, below);
  c.strokeStyle = colour("--accent");
  c.lineWidth = 1.5;
  c.beginPath();
  let drawing = false;
  values.forEach((value, i) => {
    const x = left + i / Math.max(1, values.length - 1) * width, y = top + height - (value === null ? 0 : at(value)) * height;
    if (value === null) drawing = false;
    else if (drawing) c.lineTo(x, y);
    else { c.moveTo(x, y); drawing = true; }
  });
  c.stroke();
}

export const DELAYS = [["first_packet", "to the first packet", "--accent"], ["last_packet", "to the last packet", "--second"]];

// why: what to say where there is nothing to draw.
export function drawLatency(canvas, latency, why) {
  const { c, width, height, top, below } = frameOf(canvas), all = DELAYS.flatMap(([key]) => latency[key].buckets);
  canvas.setAttribute("aria-label", all.length ? "histogram of the times" : why.join(" "));
  if (all.length === 0) {
    c.textAlign = "center";
    why.forEach((line, i) => c.fillText(line, width / 2, top + height / 2 + 15 * (i - (why.length - 1) / 2)));
    return;
  }
  const from = Math.floor(Math.log10(Math.min(...all.map(b => b[0])))), to = Math.ceil(Math.log10(1.19 * Math.max(...all.map(b => b[0]))));
  const most = Math.max(...all.map(b => b[1])), at = value => (Math.log10(value) - from) / (to - from) * width;
  c.strokeStyle = colour("--line");
  for (let decade = from; decade <= to; decade++) {
    const x = Math.min(width - 0.5, at(10 ** decade) + 0.5);
    c.beginPath(); c.moveTo(x, top); c.lineTo(x, top + height); c.stroke();
    c.textAlign = decade === from ? "left" : decade === to ? "right" : "center";
    c.fillText(decade < 0 ? `${10 ** (decade + 3)} µs` : decade < 3 ? `${10 ** decade} ms` : `${10 ** (decade - 3)} s`, x, below);
  }
  c.globalAlpha = 0.65;
  for (const [key, , name] of DELAYS) {
    c.fillStyle = colour(name);
    for (const [start, n] of latency[key].buckets) {
      const h = height * n / most;
      c.fillRect(at(start), top + height - h, Math.max(1, at(start * 2 ** 0.25) - at(start) - 0.5), h);
    }
  }
  c.globalAlpha = 1;
}
