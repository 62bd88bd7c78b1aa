// Numbers as people read them.

const two = (n) => String(n).padStart(2, "0");

/** Minutes and seconds, as a run is spoken of: 75 -> "1:15", 3675 -> "61:15". */
export function clock(seconds) {
  const s = Math.max(0, Math.floor(seconds));
  return `${Math.floor(s / 60)}:${two(s % 60)}`;
}

const FRESH = 10; // seconds

/** An endpoint's last answer: whether its figures are no longer fresh, and since when, "" if they are. */
export const isOldAnswer = ({ answered }) => answered !== null && answered > FRESH;
export const answeredWords = (row) => (isOldAnswer(row) ? ago(row.answered) : "");

/** How long ago: "now", "8 s", "12 min", "2:05 h". */
export function age(seconds) {
  if (seconds < 1) return "now";
  if (seconds < 60) return `${Math.floor(seconds)} s`;
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min`;
  return `${Math.floor(seconds / 3600)}:${two(Math.floor(seconds / 60) % 60)} h`;
}

export const ago = (seconds) => (seconds < 1 ? "now" : `${age(seconds)} ago`);

export function bytes(n) {
  if (n < 1000) return `${n} B`;
  if (n < 1e6) return `${(n / 1e3).toFixed(n < 1e4 ? 1 : 0)} kB`;
  return `${(n / 1e6).toFixed(n < 1e7 ? 1 : 0)} MB`;
}

export const ms = (value) => (value === null ? "–" : `${value.toFixed(value < 10 ? 1 : 0)} ms`);

export const mbit = (n) => (n >= 1e5 ? n.toExponential(0) : n.toFixed(n >= 10 ? 0 : 1));

/** A number as people type it, or copy it from this page: with a decimal comma or a true minus sign. NaN: it is none. */
export function numberIn(text) {
  const plain = text.trim().replace("−", "-").replace(",", ".");
  return /^[-+]?(\d+\.?\d*|\.\d+)$/.test(plain) ? Number(plain) : NaN;
}

/** A true minus sign is as wide as a plus; past any cave a number keeps to its size. */
export const metres = (n) => (Math.abs(n) < 1e6 ? n.toFixed(1) : n.toExponential(1)).replace(/^-(0\.0$)?/, (_, zero) => zero ?? "−");

/** Where a report's artifact is; one without a position is one that damage took from the ledger. */
export const placeOf = ({ position }) => (position ? `${metres(position.x)}, ${metres(position.y)}, ${metres(position.z)} m` : "lost from the ledger");

/** "+1", "0", "−1". */
export const signed = (n) => (n > 0 ? `+${n}` : n < 0 ? `−${-n}` : "0");

/** The order of names: numbers in them by their value, r2 before r10. */
export const byName = (a, b) => a.localeCompare(b, "en", { numeric: true });

/** Anybody's text, cut where it would push all else off the page. */
export const clip = (text, most = 240) => (text.length > most ? `${text.slice(0, most)}…` : text);

/** The time of day of seconds since 1970. */
export const timeOfDay = (seconds) => new Date(seconds * 1000).toLocaleTimeString("en-GB");
