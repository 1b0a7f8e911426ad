// Amplitudes of samples over frequency: Hann window, FFT by powers of two (Cooley and Tukey 1965).

// In place, real and imaginary parts; their length is a power of two.
export function fft(re, im) {
  const n = re.length;
  for (let i = 1, j = 0; i < n; i++) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      [re[i], re[j]] = [re[j], re[i]];
      [im[i], im[j]] = [im[j], im[i]];
    }
  }
  for (let size = 2; size <= n; size <<= 1) {
    const half = size >> 1;
    for (let k = 0; k < half; k++) {
      const angle = -2 * Math.PI * k / size, c = Math.cos(angle), s = Math.sin(angle);
      for (let a = k; a < n; a += size) {
        const b = a + half, x = c * re[b] - s * im[b], y = s * re[b] + c * im[b];
        re[b] = re[a] - x;
        im[b] = im[a] - y;
        re[a] += x;
        im[a] += y;
      }
    }
  }
}

// Of the latest 2^k samples: a sine of amplitude 1 at a line gives 1 there; the mean is taken off.
export function spectrum(samples, step) {
  const n = 2 ** Math.floor(Math.log2(Math.max(samples.length, 1)));
  if (n < 4) return { frequency: [], amplitude: [] };
  const latest = samples.slice(samples.length - n), re = new Float64Array(n), im = new Float64Array(n);
  let mean = 0;
  for (const v of latest) mean += v / n;
  for (let k = 0; k < n; k++) re[k] = (latest[k] - mean) * (0.5 - 0.5 * Math.cos(2 * Math.PI * k / n));
  fft(re, im);
  const frequency = new Float64Array(n / 2), amplitude = new Float64Array(n / 2);
  for (let k = 0; k < n / 2; k++) {
    frequency[k] = k / (n * step);
    amplitude[k] = 4 * Math.hypot(re[k], im[k]) / n;
  }
  amplitude[0] /= 2;
  return { frequency, amplitude };
}
