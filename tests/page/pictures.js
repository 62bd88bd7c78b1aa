// What the map of a page looks like, so that two looks can be compared.
import { until } from "./box.js";

export const canvas = "#map .frame canvas";
export const picture = (page) => page.$eval(canvas, (node) => node.toDataURL());
/** The box of a layer. */
export const box = (page, name) => page.getByRole("checkbox", { name, exact: true });

/** The next picture that is not `before`. */
export const changed = (page, before, what) =>
  until(async () => {
    const now = await picture(page);
    return now !== before && now;
  }, what);
export const becomes = (page, whole, what = "the picture before") => until(async () => (await picture(page)) === whole, what);
