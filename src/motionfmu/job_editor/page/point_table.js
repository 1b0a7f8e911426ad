// Points in the text of a file of points: a name, then words such as X=100.
const POINT = /^(\s*)([A-Z]+\d+)((?:\s+[A-Z]+\d?=\S+)+)\s*$/;

// Each point with the place of its line and its words by their names.
export function pointsOf(text) {
  return text.split("\n").flatMap((line, place) => {
    const found = POINT.exec(line);
    if (!found) return [];
    const words = found[3].trim().split(/\s+/).map((word) => word.split("="));
    return [{ place, name: found[2], words: Object.fromEntries(words) }];
  });
}

// The text with one word of the point at a place changed; its line stays as it is otherwise.
export function withWord(text, place, word, value) {
  const lines = text.split("\n");
  lines[place] = lines[place].replace(new RegExp(`(\\s${word}=)\\S+`), (_, head) => head + value);
  return lines.join("\n");
}

// Names of the points that a line of a program uses.
export function pointsIn(line) {
  return line.replace(/['/].*$/, "").match(/\b[A-Z]+\d+\b/g) ?? [];
}

// The step that a line belongs to: its first pass; of a line without moves the last one before.
export function stepAt(steps, line) {
  const own = steps.findIndex((s) => s.line === line);
  if (own >= 0) return own;
  const earlier = steps.map((s, k) => [s.line, k]).filter(([l]) => l < line);
  return earlier.length ? earlier.reduce((a, b) => (b[0] > a[0] ? b : a))[1] : -1;
}
