// The little of the DOM that the page needs. Text is only ever put in as text: names are anybody's.

/** An element with classes ("li.robot.quiet") and children, each a node or a text. */
export function make(what, ...children) {
  const [tag, ...classes] = what.split(".");
  const node = document.createElement(tag);
  if (classes.length) node.className = classes.join(" ");
  node.append(...children);
  return node;
}

/** Sets a text where it differs, so that nothing is read out or laid out again for nothing. */
export function say(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

export function mark(node, name, value) {
  if (node.dataset[name] !== value) node.dataset[name] = value;
}

/** A shape and a word for a level, so that colour is never all that tells: see page.css for the shapes. */
export function badge(node, level, word) {
  if (!node.firstChild) {
    const glyph = make("span.glyph");
    glyph.setAttribute("aria-hidden", "true");
    node.append(glyph, " ", make("span.text"));
  }
  mark(node.querySelector(".glyph"), "level", level);
  say(node.querySelector(".text"), word);
  return node;
}

/** Makes the children of `parent` those of `items`, in order: known ones (by `key`) are kept and updated. */
export function list(parent, items, key, create, update) {
  const known = new Map([...parent.children].map((node) => [node.dataset.key, node]));
  let before = parent.firstElementChild;
  for (const item of items) {
    const name = String(key(item));
    let node = known.get(name);
    if (node) {
      known.delete(name);
    } else {
      node = create(item);
      node.dataset.key = name;
    }
    update(node, item);
    if (node === before) before = before.nextElementSibling;
    else parent.insertBefore(node, before);
  }
  for (const node of known.values()) node.remove();
}
