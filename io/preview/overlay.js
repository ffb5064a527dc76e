// Truth drawn over the picture (docs/truth.md): boxes, names, stars, the boresight. Each can be switched.

export const LAYERS = ["boxes", "names", "stars", "boresight"];
const OBJECT = "#ffd23f", BODY = "#5ad1ff", STAR = "#8dff9a", CROSS = "#ff6b9d";
const FAINTEST_NAMED_STAR = 4;  // magnitudes; more names than these hide the picture

// A dark rim keeps lines and words readable on a bright picture.
function words(c, text, x, y) {
  c.lineWidth = 3;
  c.strokeStyle = "rgba(0, 0, 0, .75)";
  c.strokeText(text, x, y);
  c.fillText(text, x, y);
}
function outline(c, colour, draw) {
  for (const [width, style] of [[3, "rgba(0, 0, 0, .6)"], [1.2, colour]]) {
    c.lineWidth = width;
    c.strokeStyle = style;
    c.beginPath();
    draw();
    c.stroke();
  }
}

// place: from the frame's pixels to the canvas's. ratio: canvas pixels per CSS pixel. Gives what was drawn, for tests.
export function drawTruth(c, truth, layers, { place, scale, ratio }) {
  const drawn = { boxes: 0, names: 0, stars: 0, boresight: 0 };
  c.save();
  c.font = `${Math.round(12 * ratio)}px system-ui, sans-serif`;
  c.textAlign = "left";
  c.textBaseline = "bottom";
  const things = [...truth.bodies.map(t => [t, BODY]), ...truth.objects.map(t => [t, OBJECT])];
  for (const [thing, colour] of things) {
    const box = thing.visible_box_px, at = box ? place(box[0], box[1]) : thing.center_px && place(...thing.center_px);
    if (box && layers.has("boxes")) {
      outline(c, colour, () => c.rect(at.x, at.y, box[2] * scale, box[3] * scale));
      drawn.boxes++;
    }
    if (layers.has("names") && box) {
      c.fillStyle = colour;
      words(c, thing.name, Math.max(4, at.x), Math.max(14 * ratio, at.y - 3 * ratio));
      drawn.names++;
    }
  }
  if (layers.has("stars")) for (const star of truth.stars ?? []) {
    const at = place(...star.position_px);
    // Brighter ones have larger circles.
    const radius = Math.min(9, Math.max(2.5, 8 - star.magnitude_v)) * ratio;
    outline(c, STAR, () => c.arc(at.x, at.y, radius, 0, 2 * Math.PI));
    drawn.stars++;
    if (!layers.has("names") || star.magnitude_v > FAINTEST_NAMED_STAR || !star.hip) continue;
    c.fillStyle = STAR;
    words(c, `HIP ${star.hip}`, at.x + 8 * ratio, at.y - 4 * ratio);
    drawn.names++;
  }
  if (layers.has("boresight")) {
    const at = place(...truth.image.principal_point_px), arm = 14 * ratio, gap = 4 * ratio;
    outline(c, CROSS, () => {
      for (const [x, y] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        c.moveTo(at.x + x * gap, at.y + y * gap);
        c.lineTo(at.x + x * arm, at.y + y * arm);
      }
    });
    drawn.boresight++;
  }
  c.restore();
  return drawn;
}
