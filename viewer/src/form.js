// The proportions of a robot: how far it reaches, how thick its hubs are, where they sit and where its tips are.
// A robot without shapes gets its body from these numbers alone, so all of them scale with the robot.

import { chainOf, framesFor, place, point, turned, FRAME } from './kinematics.js';
import { locate, valueAt } from './data.js';

const length = v => Math.hypot(v[0], v[1], v[2]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export function formOf(run) {
  const bodies = run.robot.bodies, n = bodies.length, chain = chainOf(run.robot);
  const children = bodies.map((_, i) => bodies.flatMap((body, c) => (body.parent === i ? [c] : [])));
  const shift = i => [...chain.shift.subarray(3 * i, 3 * i + 3)], axis = i => [...chain.axis.subarray(3 * i, 3 * i + 3)];
  const depth = [], along = [];
  bodies.forEach((body, i) => {
    depth[i] = body.parent === null ? 0 : depth[body.parent] + 1;
    along[i] = length(shift(i)) + (body.parent === null ? 0 : along[body.parent]);
  });
  const arms = Math.max(...along, 0), leaves = bodies.flatMap((_, i) => (children[i].length ? [] : [i]));

  // A leaf whose tip is not known ends at twice the way to its centre of mass, as an even rod does.
  const ends = leaves.map(i => {
    if (bodies[i].tip && length(bodies[i].tip) > 0) return bodies[i].tip;
    const com = bodies[i].com ?? [0, 0, 0], far = 2 * length(com);
    if (far > 0.02 * arms && far > 0) return com.map(x => 2 * x);
    const side = Math.abs(axis(i)[0]) < 0.9 ? [1, 0, 0] : [0, 0, 1];
    return side.map(x => x * (arms > 0 ? 0.12 * arms : 0.2));
  });
  const reach = Math.max(...leaves.map((i, k) => along[i] + length(ends[k])));
  const links = [...bodies.map((_, i) => length(shift(i))), ...ends.map(length)].filter(l => l > 0);
  // The mean over the length, not over the links: many very short links must not make a thin robot.
  const typical = links.reduce((sum, l) => sum + l * l, 0) / links.reduce((sum, l) => sum + l, 0);
  const thick = Math.min((0.05 + 0.025 / n) * reach, 0.45 * typical), deepest = Math.max(1, ...depth);
  const radius = depth.map(d => thick * (1 - 0.3 * d / deepest));

  // A hub may sit anywhere on its axis. Where the next joint has the same origin, it moves back so that both show.
  const station = bodies.map((_, i) => {
    const a = axis(i), crossed = children[i].some(c => length(shift(c)) < 1.3 * radius[i] && Math.abs(dot(a, turned(chain.turn, 9 * c, axis(c)))) < 0.9);
    if (!crossed || chain.slides[i]) return [0, 0, 0];
    const back = -dot(turned(chain.turn, 9 * i, a), shift(i));
    const way = Math.abs(back) > 0.5 * radius[i] ? Math.sign(back) * Math.min(2.1 * radius[i], 0.75 * Math.abs(back)) : -2.1 * radius[i];
    return a.map(x => x * way);
  });

  const gravity = run.robot.gravity ?? [0, 0, 0], pull = length(gravity);
  const up = pull > 1e-6 ? gravity.map(x => -x / pull) : [0, 0, 1];
  return { n, chain, children, axis, shift, leaves, ends, reach, radius, thick, station, up, shaped: bodies.some(body => body.shapes?.length) || Boolean(run.robot.base_shapes?.length) };
}

/** Joint positions at a place in the run: the links, the reference or the motor side with its deflection magnified. */
export function linkSide(run, at, q) { for (let j = 0; j < run.n; j++) q[j] = valueAt(run.q_l[j], at); return q; }
export function reference(run, at, q) { for (let j = 0; j < run.n; j++) q[j] = valueAt(run.q_ld[j], at); return q; }
export function motorSide(run, at, magnification, q) {
  for (let j = 0; j < run.n; j++) q[j] = valueAt(run.q_l[j], at) + magnification * valueAt(run.deflection[j], at);
  return q;
}

/** Tip positions, one a leaf, in the base frame. */
export function tipsOf(form, frames) {
  return form.leaves.map((i, k) => point(frames, FRAME * i, form.ends[k], 0, [0, 0, 0], 0));
}

/** The path of every tip at evenly spaced times: 3 numbers a point, with `count` points. */
export function tipPaths(run, form, positions, count) {
  const paths = form.leaves.map(() => new Float32Array(3 * count)), q = new Float64Array(run.n), frames = framesFor(form.chain), at = { k: 0, f: 0 };
  for (let c = 0; c < count; c++) {
    const t = run.begin + (run.end - run.begin) * (count > 1 ? c / (count - 1) : 0);
    place(form.chain, positions(run, locate(run, t, at), q), frames);
    form.leaves.forEach((i, k) => point(frames, FRAME * i, form.ends[k], 0, paths[k], 3 * c));
  }
  return paths;
}
