// Fewer points for the charts without losing a peak: least and largest value of every pixel.

/** Times and values of many columns between two times: { x, y: [per column] }; each source is { t, last, values, factor }. */
export function decimate(sources, from, to, pixels) {
  const ranges = sources.map(({ t, last }) => [Math.max(0, firstAfter(t, last, from) - 1), Math.min(last, firstAfter(t, last, to))]);
  const most = Math.max(...ranges.map(([a, b]) => b - a + 1));
  return most <= 2 * pixels ? exact(sources, ranges) : buckets(sources, ranges, from, to, pixels);
}

function firstAfter(t, last, time) {
  let low = 0, high = last + 1;
  while (low < high) { const middle = (low + high) >> 1; if (t[middle] < time) low = middle + 1; else high = middle; }
  return low;
}

/** All samples; columns of another run are read between their own samples, so that they share one time axis. */
function exact(sources, ranges) {
  const times = new Set();
  sources.forEach(({ t }, s) => { for (let k = ranges[s][0]; k <= ranges[s][1]; k++) times.add(t[k]); });
  const x = [...times].sort((a, b) => a - b);
  const y = sources.map(({ t, last, values, factor }) => {
    let k = 0;
    return x.map(time => {
      if (time < t[0] || time > t[last]) return null;
      while (k < last && t[k + 1] <= time) k++;
      const share = k < last && time > t[k] ? (time - t[k]) / (t[k + 1] - t[k]) : 0;
      return number(factor * (share > 0 ? values[k] + share * (values[k + 1] - values[k]) : values[k]));
    });
  });
  return { x, y };
}

function buckets(sources, ranges, from, to, pixels) {
  const wide = (to - from) / pixels, x = new Array(2 * pixels);
  for (let b = 0; b < pixels; b++) { x[2 * b] = from + (b + 0.25) * wide; x[2 * b + 1] = from + (b + 0.75) * wide; }
  const y = sources.map(({ t, values, factor, last }, s) => {
    const out = new Array(2 * pixels).fill(null);
    let k = ranges[s][0];
    for (let b = 0; b < pixels && k <= ranges[s][1]; b++) {
      const until = from + (b + 1) * wide;
      let low = Infinity, high = -Infinity, lowAt = 0, highAt = 0, found = false;
      for (; k <= ranges[s][1] && t[k] < until; k++) {
        const v = values[k];
        if (!Number.isFinite(v)) continue;
        found = true;
        if (v < low) { low = v; lowAt = k; }
        if (v > high) { high = v; highAt = k; }
      }
      if (!found) {
        // A pixel between two samples still belongs to the line.
        if (k > 0 && k <= last) low = high = values[k - 1] + (values[k] - values[k - 1]) * Math.min(1, Math.max(0, (until - wide / 2 - t[k - 1]) / (t[k] - t[k - 1] || 1)));
        else continue;
      }
      out[2 * b] = number(factor * (lowAt <= highAt ? low : high));
      out[2 * b + 1] = number(factor * (lowAt <= highAt ? high : low));
    }
    return out;
  });
  return { x, y };
}

const number = value => (Number.isFinite(value) ? value : null);
