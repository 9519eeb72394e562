// Numbers as people read them: a prefix by size, three digits, a true minus sign.

const PREFIXES = [[1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n']];

/** The prefix in which `peak` is at least 0.3: { factor, prefix }; a torque keeps its plain unit as long as it can. */
export function scaleFor(peak, plainFrom = 1) {
  for (const [size, prefix] of PREFIXES) if (peak >= size * (size === 1 ? plainFrom : 0.3)) return { factor: 1 / size, prefix };
  return peak > 0 ? { factor: 1e9, prefix: 'n' } : { factor: 1e3, prefix: 'm' };
}

const minus = text => text.replace('-', '\u2212');

const RAISED = { 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹' };

function power(value) {
  const [number, exponent] = value.toExponential(1).split('e');
  return `${minus(number)}·10${[...exponent.replace('+', '')].map(c => RAISED[c]).join('')}`;
}

/** Three digits that count, without an exponent as long as the number is of everyday size. */
export function digits(value) {
  if (!Number.isFinite(value)) return '\u2013';
  const size = Math.abs(value);
  if (size === 0) return '0';
  if (size >= 1e5) return power(value);
  // Next to the largest value, in whose unit all are, this is nothing.
  if (size < 5e-4) return '0.000';
  return minus(value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3));
}

export const seconds = t => minus(t.toFixed(2)) + ' s';

/** The largest of 1, 1.5, 2, 3, 5 times a power of ten that is not above x. */
export function roundBelow(x, steps = [5, 3, 2, 1.5, 1]) {
  const power = 10 ** Math.floor(Math.log10(x) + 1e-9);
  return power * (steps.find(step => step * power <= x * (1 + 1e-9)) ?? 1);
}

export function roundNearest(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  let best = power;
  for (const step of [1, 1.5, 2, 3, 5, 10]) if (Math.abs(Math.log(step * power / x)) < Math.abs(Math.log(best / x))) best = step * power;
  return Number(best.toPrecision(2));
}

export const lengthWords = metres => (metres >= 1 ? `${Number(metres.toPrecision(2))} m` : metres >= 0.01 ? `${Number((100 * metres).toPrecision(2))} cm` : `${Number((1000 * metres).toPrecision(2))} mm`);
