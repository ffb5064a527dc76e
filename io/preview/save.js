// Files out of the page: the picture as it is shown, and the frame's numbers as the server has them.

function download(href, name) {
  const link = Object.assign(document.createElement("a"), { href, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

// The canvas with its stretch, its overlays and its zoom.
export async function saveView(picture) {
  const blob = await new Promise(done => picture.canvas.toBlob(done, "image/png"));
  const address = URL.createObjectURL(blob);
  download(address, `view_frame${picture.frame.id}.png`);
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

// format: png or tiff, 16 bits. A frozen frame is kept by the server; else it is the newest. Gives why not, or nothing.
export async function saveNumbers(picture, format) {
  const frame = picture.frozen ? picture.frame.id : 0n;
  try {
    const answer = await fetch(`numbers?viewer=${picture.viewer}&frame=${frame}&format=${format}`);
    if (!answer.ok) return (await answer.text()).trim();
    const name = /filename="([^"]+)"/.exec(answer.headers.get("Content-Disposition"))?.[1] ?? `frame.${format}`;
    const address = URL.createObjectURL(await answer.blob());
    download(address, name);
    setTimeout(() => URL.revokeObjectURL(address), 10000);
    return "";
  } catch { return "no answer"; }
}
