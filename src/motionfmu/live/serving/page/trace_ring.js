// Samples of channels over steps: the latest so many, with the peaks of each block of them.

export const BLOCK = 64;

export class TraceRing {
  // rows: steps that are kept, a multiple of BLOCK.
  constructor(channels, rows) {
    Object.assign(this, { channels, rows, begin: 0, end: 0 });
    this.samples = channels.map(() => new Float64Array(rows));
    this.low = channels.map(() => new Float64Array(rows / BLOCK));
    this.high = channels.map(() => new Float64Array(rows / BLOCK));
  }

  // Samples row by row from a step on; a gap before them empties the ring.
  add(begin, rows, data) {
    const count = this.channels.length;
    if (begin !== this.end) this.begin = this.end = begin;
    for (let c = 0; c < count; c++) {
      const own = this.samples[c];
      for (let k = 0, at = begin % this.rows; k < rows; k++) {
        own[at] = data[k * count + c];
        if (++at === this.rows) at = 0;
      }
    }
    const first = Math.floor(begin / BLOCK), last = Math.floor((begin + rows - 1) / BLOCK);
    this.end = begin + rows;
    this.begin = Math.max(this.begin, this.end - this.rows);
    for (let block = first; block <= last; block++) this.blockOf(block);
  }

  blockOf(block) {
    const from = Math.max(block * BLOCK, this.begin), to = Math.min((block + 1) * BLOCK, this.end);
    const at = block % (this.rows / BLOCK);
    for (let c = 0; c < this.channels.length; c++) {
      const own = this.samples[c];
      let low = Infinity, high = -Infinity;
      for (let k = from; k < to; k++) {
        const v = own[k % this.rows];
        if (v < low) low = v;
        if (v > high) high = v;
      }
      this.low[c][at] = low;
      this.high[c][at] = high;
    }
  }

  at(channel, step) {
    return step >= this.begin && step < this.end ? this.samples[channel][step % this.rows] : NaN;
  }

  // Least and largest of a channel in [from, to), into peaks[0] and [1]; whole blocks by their peaks.
  peaks(channel, from, to, peaks) {
    const own = this.samples[channel], blocks = this.rows / BLOCK;
    let low = Infinity, high = -Infinity, k = Math.max(from, this.begin);
    const end = Math.min(to, this.end);
    while (k < end) {
      if (k % BLOCK === 0 && k + BLOCK <= end) {
        const block = (k / BLOCK) % blocks;
        if (this.low[channel][block] < low) low = this.low[channel][block];
        if (this.high[channel][block] > high) high = this.high[channel][block];
        k += BLOCK;
      } else {
        const v = own[k % this.rows];
        if (v < low) low = v;
        if (v > high) high = v;
        k++;
      }
    }
    [peaks[0], peaks[1]] = [low, high];
  }

  // The samples of a channel in [from, to) that are there.
  slice(channel, from, to) {
    const begin = Math.max(from, this.begin), end = Math.max(begin, Math.min(to, this.end));
    return Float64Array.from({ length: end - begin }, (_, k) => this.samples[channel][(begin + k) % this.rows]);
  }

  copy() {
    const other = new TraceRing(this.channels, this.rows);
    Object.assign(other, { begin: this.begin, end: this.end });
    for (const key of ["samples", "low", "high"]) this[key].forEach((own, c) => other[key][c].set(own));
    return other;
  }
}

// A ring that holds just these rows.
export function ringOf(channels, begin, rows, data) {
  const ring = new TraceRing(channels, BLOCK * (Math.ceil(rows / BLOCK) + 1));
  ring.begin = ring.end = begin;
  ring.add(begin, rows, data);
  return ring;
}

// Mean and RMS of samples, and their least and largest.
export function statistics(samples) {
  let [low, high, sum, squares] = [Infinity, -Infinity, 0, 0];
  for (const v of samples) {
    if (v < low) low = v;
    if (v > high) high = v;
    sum += v;
    squares += v * v;
  }
  const count = samples.length || NaN;
  return { low, high, mean: sum / count, rms: Math.sqrt(squares / count) };
}
