// What the charts and the table show: which column, in which unit, with which limit.

import { usualPeak } from './data.js';
import { scaleFor } from './units.js';

const KINDS = [
  { key: 'deflection', title: 'Deflection', note: 'motor minus link', unit: ['rad', 'm'], limit: 'deflection', plainFrom: 3 },
  { key: 'u_m', title: 'Motor torque', note: 'as applied', unit: ['N m', 'N'], limit: 'torque', plainFrom: 0.1 },
  { key: 'error', title: 'Link error', note: 'link minus reference', unit: ['rad', 'm'], limit: null, plainFrom: 3 },
  { key: 'spring', title: 'Spring torque', note: '', unit: ['N m', 'N'], limit: null, plainFrom: 0.1 },
];

/** The quantities of these runs, each with one scale for all joints. */
export function quantitiesOf(runs) {
  const slides = runs.some(run => run.prismatic.includes(true)), turns = runs.some(run => run.prismatic.includes(false));
  const quantities = KINDS.map(kind => {
    const peak = Math.max(...runs.flatMap(run => run[kind.key].map(column => usualPeak(run, column)))), { factor, prefix } = scaleFor(peak, kind.plainFrom);
    const units = kind.unit.map(unit => prefix + unit);
    return { ...kind, factor, peak, units, words: units.filter((_, i) => (i === 0 ? turns : slides)).join(', ') };
  });
  if (runs.some(run => run.certificate)) quantities.push({ key: 'certificate', title: 'Contraction rate', note: 'certified', unit: null, limit: null, factor: 1, units: ['1/s', '1/s'], words: '1/s', whole: true });
  return quantities;
}
