// The DN along a line that is drawn over the picture: the pixel that holds each point, a point a pixel.

export function samplesAlong(picture, line) {
  const across = line.x1 - line.x0, down = line.y1 - line.y0;
  const steps = Math.max(1, Math.ceil(Math.max(Math.abs(across), Math.abs(down))));
  return Array.from({ length: steps + 1 }, (_, i) =>
    picture.valueAt(Math.floor(line.x0 + across * i / steps), Math.floor(line.y0 + down * i / steps)));
}
export const lengthOf = line => Math.hypot(line.x1 - line.x0, line.y1 - line.y0);

export function drawLine(c, line, place) {
  const from = place(line.x0, line.y0), to = place(line.x1, line.y1);
  for (const [width, style] of [[4, "rgba(0, 0, 0, .6)"], [1.5, "#ff9f43"]]) {
    c.lineWidth = width;
    c.strokeStyle = style;
    c.beginPath();
    c.moveTo(from.x, from.y);
    c.lineTo(to.x, to.y);
    c.stroke();
  }
}
