// How the picture is looked at, in the page's address behind #: kept over a reload, and sent to somebody else as a link.

import { LAYERS } from "./overlay.js";

const STRETCHES = ["linear", "sqrt", "log", "asinh"], LEVELS = ["98", "99.5", "99.95", "100", "full", "manual"];
const tidy = value => String(Number(value.toPrecision(7)));

export function readView(picture, histogram) {
  const words = new URLSearchParams(location.hash.slice(1));
  const finite = key => { const v = words.get(key); return v !== null && v !== "" && Number.isFinite(Number(v)) ? Number(v) : null; };
  if (STRETCHES.includes(words.get("stretch"))) picture.stretch = words.get("stretch");
  if (LEVELS.includes(words.get("levels"))) picture.auto = words.get("levels");
  if (picture.auto === "manual") {
    picture.black = Math.max(0, finite("black") ?? picture.black);
    picture.white = Math.max(1, finite("white") ?? picture.white);
  }
  const scale = finite("zoom"), x = finite("x"), y = finite("y");
  picture.scale = scale !== null && scale > 0 ? Math.min(128, scale) : 0;
  picture.centre = picture.scale && x !== null && y !== null ? { x, y } : null;
  picture.light = words.get("light") ?? "";
  picture.layers = new Set((words.get("show") ?? "").split(",").filter(layer => LAYERS.includes(layer)));
  const line = (words.get("profile") ?? "").split(",").map(Number);
  picture.line = line.length === 4 && line.every(Number.isFinite) ? { x0: line[0], y0: line[1], x1: line[2], y1: line[3] } : null;
  histogram.logarithmic = words.get("histogram") !== "linear";
}

export function viewWords(picture, histogram) {
  const words = new URLSearchParams();
  if (picture.stretch !== "linear") words.set("stretch", picture.stretch);
  if (picture.auto !== "99.95") words.set("levels", picture.auto);
  if (picture.auto === "manual") { words.set("black", picture.black); words.set("white", picture.white); }
  if (picture.scale) {
    words.set("zoom", tidy(picture.scale));
    if (picture.centre) { words.set("x", tidy(picture.centre.x)); words.set("y", tidy(picture.centre.y)); }
  }
  if (picture.light) words.set("light", picture.light);
  if (picture.layers.size) words.set("show", [...picture.layers].join(","));
  if (picture.line) words.set("profile", ["x0", "y0", "x1", "y1"].map(key => tidy(picture.line[key])).join(","));
  if (!histogram.logarithmic) words.set("histogram", "linear");
  return words.toString().replaceAll("%2C", ",");
}

// Soon, not with every move: browsers allow some hundred changes of an address in half a minute.
let timer = 0;
export function keepView(picture, histogram) {
  timer ||= setTimeout(() => {
    timer = 0;
    const words = viewWords(picture, histogram);
    if (words !== location.hash.slice(1)) history.replaceState(null, "", words ? "#" + words : location.pathname);
  }, 300);
}
