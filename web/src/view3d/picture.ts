/** The canvas as a file: it is transparent, so the page's background is drawn behind it. */
export function copyPicture(canvas: HTMLCanvasElement, host: HTMLElement): Promise<Blob | null> {
  const copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  const pen = copy.getContext("2d")!;
  const style = getComputedStyle(host);
  const shade = pen.createLinearGradient(0, 0, 0, copy.height);
  shade.addColorStop(0, style.getPropertyValue("--v-sky").trim());
  shade.addColorStop(1, style.getPropertyValue("--v-ground").trim());
  pen.fillStyle = shade;
  pen.fillRect(0, 0, copy.width, copy.height);
  pen.drawImage(canvas, 0, 0);
  return new Promise((resolve) => copy.toBlob(resolve, "image/png"));
}
