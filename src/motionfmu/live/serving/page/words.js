// Numbers and states of a machine in words.

const MINUS = "\u2212";

// A number with so many places, its sign a minus that is as wide as a plus.
export function fixed(value, places = 3) {
  if (!Number.isFinite(value)) return "\u2013";
  return (Math.abs(value) < 0.5 * 10 ** -places ? 0 : value).toFixed(places).replace("-", MINUS);
}

// A number with so many figures, for lists where sizes differ.
export function figures(value, count = 4) {
  if (typeof value === "boolean") return value ? "on" : "off";
  if (typeof value === "string") return value;
  if (!Number.isFinite(value)) return "\u2013";
  if (Number.isInteger(value) && Math.abs(value) < 1e9) return String(value).replace("-", MINUS);
  const size = Math.abs(value), text = size >= 1e6 || size < 1e-4
    ? Number(value.toPrecision(count)).toExponential() : String(Number(value.toPrecision(count)));
  return text.replace(/-/g, MINUS);
}

// Seconds as a clock reads them.
export function clock(seconds) {
  const whole = Math.floor(seconds), pad = (n) => String(n).padStart(2, "0");
  const hours = Math.floor(whole / 3600), rest = `${pad(Math.floor(whole / 60) % 60)}:${pad(whole % 60)}`;
  const parts = String(Math.floor((seconds - whole) * 1000)).padStart(3, "0");
  return `${hours ? `${hours}:` : ""}${rest}.${parts}`;
}

// What the number of a variable means.
export function meaning(variable, value) {
  if (value === undefined) return ""; // the machine has not told it yet
  if (variable?.type === "Boolean") return value ? "on" : "off";
  return variable?.words?.[value] ?? String(value);
}

export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

// What to do about the number of a variable.
export function advice(variable, value) {
  return variable?.advice?.[value] ?? "Find the cause, then reset.";
}
