// Pictures of a page's map, for comparison.
import { until } from "./box.js";

export const canvas = "#map .frame canvas";
export const picture = (page) => page.$eval(canvas, (node) => node.toDataURL());
/** A layer's checkbox, which need not be visible to be checked. */
export function box(page, name) {
  const setChecked = (checked) => page.getByRole("checkbox", { name, exact: true, includeHidden: true }).evaluate((node, checked) => node.checked === checked || node.click(), checked);
  return { setChecked, check: () => setChecked(true), uncheck: () => setChecked(false) };
}

/** The next picture that differs from `before`. */
export const changed = (page, before, what) =>
  until(async () => {
    const now = await picture(page);
    return now !== before && now;
  }, what);
const FEW = 12;  // pixels; a layer drawn in pieces may round differently at an image's edge

/** The number of pixels that differ from those of the picture. */
const differences = (page, whole) =>
  page.$eval(canvas, async (node, whole) => {
    const bytes = Uint8Array.from(atob(whole.split(",")[1]), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    if (image.width !== node.width || image.height !== node.height) return Infinity;
    const other = new OffscreenCanvas(image.width, image.height).getContext("2d");
    other.drawImage(image, 0, 0);
    const [one, two] = [node.getContext("2d"), other].map((paint) => new Uint32Array(paint.getImageData(0, 0, image.width, image.height).data.buffer));
    return one.reduce((count, pixel, i) => count + (pixel !== two[i]), 0);
  }, whole);
export const becomes = (page, whole, what = "the picture before", few = FEW) => until(async () => (await differences(page, whole)) <= few, what);
