// Numbers as people read them.

const two = (n) => String(n).padStart(2, "0");

/** 75 -> "1:15", 3675 -> "1:01:15". */
export function clock(seconds) {
  const s = Math.max(0, Math.floor(seconds));
  const h = Math.floor(s / 3600), m = Math.floor(s / 60) % 60;
  return h > 0 ? `${h}:${two(m)}:${two(s % 60)}` : `${m}:${two(s % 60)}`;
}

/** How long ago: "now", "8 s", "1:15 min", "2:05 h". */
export function age(seconds) {
  if (seconds < 1) return "now";
  if (seconds < 60) return `${Math.floor(seconds)} s`;
  if (seconds < 3600) return `${clock(seconds)} min`;
  return `${Math.floor(seconds / 3600)}:${two(Math.floor(seconds / 60) % 60)} h`;
}

export const ago = (seconds) => (seconds < 1 ? "now" : `${age(seconds)} ago`);

export function bytes(n) {
  if (n < 1000) return `${n} B`;
  if (n < 1e6) return `${(n / 1e3).toFixed(n < 1e4 ? 1 : 0)} kB`;
  return `${(n / 1e6).toFixed(n < 1e7 ? 1 : 0)} MB`;
}

export const mbit = (n) => (n >= 10 ? n.toFixed(0) : n.toFixed(1));

export const metres = (n) => n.toFixed(Math.abs(n) < 1000 ? 1 : 0);

/** "+1", "0", "−1". */
export const signed = (n) => (n > 0 ? `+${n}` : n < 0 ? `−${-n}` : "0");

export const count = (n, one, many = `${one}s`) => `${n} ${n === 1 ? one : many}`;

/** The time of day of seconds since 1970. */
export const timeOfDay = (seconds) => new Date(seconds * 1000).toLocaleTimeString("en-GB");
