// Samples as files: CSV, and NumPy's .npz, which is a ZIP of .npy without compression.

// Columns of equal length; numbers as they are, each to its last bit.
export function csv(columns) {
  const names = columns.map(({ name }) => (/[",\n]/.test(name) ? `"${name.replace(/"/g, '""')}"` : name));
  const lines = [names.join(",")];
  for (let k = 0; k < columns[0].data.length; k++) lines.push(columns.map(({ data }) => data[k]).join(","));
  return `${lines.join("\n")}\n`;
}

const text = (words) => Uint8Array.from(unescape(encodeURIComponent(words)), (c) => c.charCodeAt(0));

function joined(parts) {
  const whole = new Uint8Array(parts.reduce((sum, p) => sum + p.length, 0));
  let at = 0;
  for (const p of parts) {
    whole.set(p, at);
    at += p.length;
  }
  return whole;
}

// Little-endian numbers of [bytes, value].
function packed(...fields) {
  const bytes = new Uint8Array(fields.reduce((sum, [size]) => sum + size, 0)), look = new DataView(bytes.buffer);
  let at = 0;
  for (const [size, value] of fields) {
    if (size === 2) look.setUint16(at, value, true); else look.setUint32(at, value, true);
    at += size;
  }
  return bytes;
}

// https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html, version 1.0
export function npy(data) {
  const about = `{'descr': '<f8', 'fortran_order': False, 'shape': (${data.length},), }`;
  const room = 64 - ((10 + about.length + 1) % 64);
  const head = text(`${about}${" ".repeat(room % 64)}\n`);
  return joined([new Uint8Array([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0]), packed([2, head.length]), head,
    new Uint8Array(Float64Array.from(data).buffer)]);
}

const CRC = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let k = 0; k < 8; k++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n >>> 0;
});
export function crc32(bytes) {
  let sum = 0xffffffff;
  for (const b of bytes) sum = CRC[(sum ^ b) & 255] ^ (sum >>> 8);
  return (sum ^ 0xffffffff) >>> 0;
}

export function npz(columns) {
  const parts = [], places = [];
  let at = 0;
  for (const { name, data } of columns) {
    const file = text(`${name}.npy`), body = npy(data), sum = crc32(body);
    // Version 2.0, names in UTF-8, stored, 1 January 1980.
    const facts = packed([2, 20], [2, 0x800], [2, 0], [2, 0], [2, 0x21], [4, sum], [4, body.length], [4, body.length], [2, file.length], [2, 0]);
    parts.push(packed([4, 0x04034b50]), facts, file, body);
    places.push(packed([4, 0x02014b50], [2, 20]), facts, packed([2, 0], [2, 0], [2, 0], [4, 0], [4, at]), file);
    at += 4 + facts.length + file.length + body.length;
  }
  const size = places.reduce((sum, p) => sum + p.length, 0), count = columns.length;
  return joined([...parts, ...places, packed([4, 0x06054b50], [2, 0], [2, 0], [2, count], [2, count], [4, size], [4, at], [2, 0])]);
}
