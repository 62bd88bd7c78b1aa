// The little of the DOM that the page needs. Text is only ever put in as text: names are anybody's.

/** An element with classes ("li.robot.quiet") and children, each a node or a text. A button submits no form, and a glyph is only seen. */
export function make(what, ...children) {
  const [tag, ...classes] = what.split(".");
  const node = document.createElement(tag);
  if (tag === "button") node.type = "button";
  if (classes[0] === "glyph") node.setAttribute("aria-hidden", "true");
  if (classes.length) node.className = classes.join(" ");
  node.append(...children);
  return node;
}

/** A picture of the size `box`, with a path for each of `paths`, their attributes. It is only seen: whoever shows it writes words beside it. */
export function draw(box, looks, ...paths) {
  const create = (tag, attributes, ...children) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    node.append(...children);
    return node;
  };
  return create("svg", { viewBox: box, "aria-hidden": "true", ...looks }, ...paths.map((path) => create("path", path)));
}

/** Lines of 24 x 24 units, in the colour of the text. */
export const drawLines = (d) => draw("0 0 24 24", { class: "icon" }, { d });

/** Sets a text where it differs, so that nothing is read out or laid out again for nothing. */
export function say(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Sets properties where they differ, for the same reason: presses.js looks at all that can be pressed after each change. */
export function set(node, values) {
  for (const [name, value] of Object.entries(values)) if (node[name] !== value) node[name] = value;
}

/** The same of an attribute. */
export function attribute(node, name, value) {
  if (node.getAttribute(name) !== value) node.setAttribute(name, value);
}

export function mark(node, name, value) {
  if (node.dataset[name] !== value) node.dataset[name] = value;
}

/** A shape and a word for a level, so that colour is never all that tells: see page.css for the shapes. */
export function badge(node, level, word) {
  if (!node.firstChild) node.append(make("span.glyph"), " ", make("span.text"));
  mark(node.querySelector(".glyph"), "level", level);
  say(node.querySelector(".text"), word);
  return node;
}

/** Makes the children of `parent` those of `items`, in order. Keeps and updates known ones (by `key`), and moves them only if
 *  the order changed, because a moved element loses the focus. */
export function list(parent, items, key, create, update) {
  const names = items.map((item) => String(key(item)));
  const known = new Map([...parent.children].map((node) => [node.dataset.key, node]));
  const going = new Set([...known.keys()].filter((name) => !names.includes(name)));
  for (const name of going) {
    const node = known.get(name), focused = document.activeElement;
    if (node.contains(focused)) giveFocus(heirOf(node, focused, going));
    node.remove();
  }
  let before = parent.firstElementChild;
  items.forEach((item, i) => {
    let node = known.get(names[i]);
    if (!node) {
      node = create(item);
      node.dataset.key = names[i];
    }
    update(node, item);
    if (node === before) before = before.nextElementSibling;
    else parent.insertBefore(node, before);
  });
}

/** Whether the node has a place on the screen (the floor has no checkVisibility). */
export const isShown = (node) => node.getClientRects().length > 0;

const usable = (node) => [...node.querySelectorAll("button:enabled")].filter(isShown);

/** What has the focus once an item went with it: the same control of the next item, or of the one before; else the title. */
function heirOf(node, focused, going) {
  const items = [...node.parentNode.children], at = items.indexOf(node);
  const near = [...items.slice(at), ...items.slice(0, at).reverse()].filter(({ dataset }) => !going.has(dataset.key));
  const heirs = near.flatMap(usable);
  // Where the item is a button of a row:
  const row = node.parentNode.closest("li");
  if (row) heirs.push(...usable(row).filter((button) => button !== node));
  return heirs.find(({ className }) => className === focused.className) ?? heirs[0] ?? node.closest("section")?.querySelector("h2, h3");
}

// ms: as long as presses.js ignores presses on a control that has just appeared
const TWICE = 500;

/** Gives the focus to what nobody chose. As long as it is marked, presses.js lets no key act on it: it may be one pressed twice. */
export function giveFocus(node) {
  if (!node) return;
  // A title:
  if (node.tabIndex < 0) node.tabIndex = -1;
  node.dataset.given = "";
  setTimeout(() => delete node.dataset.given, TWICE);
  node.focus();
}
