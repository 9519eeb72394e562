// Reads the runs out of the page and derives what every part of it needs: deflections, errors, the last sample that counts.

const KINDS = ['revolute', 'prismatic'];

/** The text between the script tags → runs; throws an Error whose message is a sentence for the reader. */
export function readRuns(text) {
  let page;
  try {
    page = JSON.parse(text);
  } catch {
    throw new Error('The runs in this page cannot be read: they are not valid JSON. The file may be cut off; write it again with flexure run … --view.');
  }
  if (page === null) throw new Error('This page holds no run. flexure run SCENARIO --view writes a page with one.');
  if (page.format !== 1) throw new Error(`This page shows format 1, the runs are in format ${JSON.stringify(page.format)}. Page and program have to be of one version.`);
  if (!Array.isArray(page.runs) || page.runs.length < 1) throw new Error('This page holds no run: its list of runs is empty.');
  return page.runs.map((run, i) => {
    try {
      return readRun(run);
    } catch (error) {
      throw new Error(`Run ${i + 1}${run?.name ? ` (${run.name})` : ''} cannot be shown: ${error.message}.`);
    }
  });
}

function readRun(raw) {
  const bodies = raw?.robot?.bodies;
  if (!Array.isArray(bodies) || bodies.length === 0) throw new Error('its robot has no joints');
  const n = bodies.length, samples = raw.samples;
  bodies.forEach((body, i) => {
    if (!KINDS.includes(body.kind)) throw new Error(`joint ${body.joint} is neither revolute nor prismatic`);
    if (body.parent !== null && !(body.parent >= 0 && body.parent < i)) throw new Error(`joint ${body.joint} hangs on a body that does not come before it`);
  });
  const columns = raw.columns ?? {};
  const column = (data, name) => {
    const values = floats(data);
    if (values.length !== samples) throw new Error(`column ${name} has ${values.length} numbers for ${samples} samples`);
    return values;
  };
  const perJoint = name => {
    if (columns[name]?.length !== n) throw new Error(`column ${name} does not have one entry a joint`);
    return columns[name].map(data => column(data, name));
  };
  if (!(samples >= 1) || !columns.t) throw new Error('it has no samples');
  const t = column(columns.t, 't');
  const [q_l, q_m, spring, u_m, q_ld] = ['q_l', 'q_m', 'spring', 'u_m', 'q_ld'].map(perJoint);
  const last = lastFinite([t, ...q_l, ...q_m]);
  if (last < 0) throw new Error('none of its samples is a number');
  return {
    name: raw.name, law: raw.law, verdict: raw.verdict ?? null, robot: raw.robot, n, samples, t, q_l, q_m, spring, u_m, q_ld,
    names: bodies.map(body => body.joint), prismatic: bodies.map(body => body.kind === 'prismatic'),
    external: columns.external ? perJoint('external') : null,
    certificate: columns.certificate ? column(columns.certificate, 'certificate') : null,
    deflection: q_l.map((link, j) => difference(q_m[j], link)),
    // Where the errors are far below the resolution of 32 bits, the program writes them as a column of their own.
    error: columns.e_l ? perJoint('e_l') : q_l.map((link, j) => difference(link, q_ld[j])),
    limits: raw.robot.limits ?? {}, pushes: raw.pushes ?? [], events: eventsOf(raw.events ?? [], t, last, samples),
    last, begin: t[0], end: t[last], until: t[lastFinite([t])], diverged: last < samples - 1,
  };
}

/** A run that ends in numbers that are none has diverged, whether or not the program listed that. */
function eventsOf(events, t, last, samples) {
  // What ends a run may be told of an instant after the last that there is, if only by the digits of 32 bits.
  const sorted = events.filter(event => Number.isFinite(event.t)).map(event => ({ ...event, t: Math.min(event.t, t[last]) })).sort((a, b) => a.t - b.t);
  if (last < samples - 1 && !sorted.some(event => event.kind === 'diverged')) sorted.push({ t: t[last], kind: 'diverged', joint: null, words: 'diverged' });
  return sorted;
}

function floats(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  const count = bytes.length >> 2, view = new DataView(bytes.buffer), values = new Float32Array(count);
  for (let i = 0; i < count; i++) values[i] = view.getFloat32(4 * i, true);
  return values;
}

function lastFinite(columns) {
  const ends = columns[0].length;
  for (let k = 0; k < ends; k++) if (columns.some(values => !Number.isFinite(values[k]))) return k - 1;
  return ends - 1;
}

const difference = (a, b) => a.map((value, k) => value - b[k]);

/** Where time t lies between the samples: index and share of the way to the next one, written into `at`. */
export function locate(run, t, at) {
  const times = run.t, last = run.last;
  if (!(t > times[0])) { at.k = 0; at.f = 0; return at; }
  if (t >= times[last]) { at.k = last; at.f = 0; return at; }
  let low = 0, high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle; else high = middle;
  }
  at.k = low;
  at.f = times[high] > times[low] ? (t - times[low]) / (times[high] - times[low]) : 0;
  return at;
}

export function valueAt(column, at) {
  const here = column[at.k];
  return at.f > 0 ? here + at.f * (column[at.k + 1] - here) : here;
}

/** Largest magnitude among the samples that count. */
export function peakOf(run, column) {
  let peak = 0;
  for (let k = 0; k <= run.last; k++) {
    const size = Math.abs(column[k]);
    if (size > peak && size < Infinity) peak = size;
  }
  return peak;
}

/** The same, but of a run that diverged what most of its time shows, as its end dwarfs all else. */
export function usualPeak(run, column) {
  if (!run.diverged) return peakOf(run, column);
  const sizes = column.slice(0, run.last + 1).map(Math.abs).filter(Number.isFinite).sort();
  return sizes.length ? sizes[Math.floor(0.94 * (sizes.length - 1))] : 0;
}

export const rmsOf = (run, column) => {
  let sum = 0;
  for (let k = 0; k <= run.last; k++) if (Number.isFinite(column[k])) sum += column[k] ** 2;
  return Math.sqrt(sum / (run.last + 1));
};
