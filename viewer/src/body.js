// The solids of every body: those of the robot's description, or hubs and rods from its proportions.

import { Vector3 } from 'three';
import { join, shape, solidsFor, DARK_SKIN } from './solids.js';
import { peakOf } from './data.js';
import { turned } from './kinematics.js';

const plus = (a, b, s = 1) => a.map((x, r) => x + s * b[r]);

/** Per body { skin, hub }: geometries in the link's frame; the hub is what takes the colour of the spring torque. */
export function bodiesOf(run, form) {
  const parts = run.robot.bodies.map(() => ({ skin: [], hub: [] }));
  run.robot.bodies.forEach((body, i) => {
    if (form.shaped) body.shapes?.forEach(description => parts[i].skin.push(...shape(description)));
    else grow(run, form, i, parts);
  });
  if (form.shaped) run.robot.bodies.forEach((_, i) => parts[i].hub.push(...collar(form, i, parts)));
  return parts.map(({ skin, hub }) => ({ skin: join(skin), hub: join(hub) }));
}

function grow(run, form, i, parts) {
  const { block, drum, rod } = solidsFor(form.n);
  const r = form.radius[i], seat = form.station[i], axis = form.axis(i), { skin, hub } = parts[i];
  if (form.chain.slides[i]) {
    hub.push(...block(seat, axis, 1.9 * r, 1.2 * r));
  } else {
    hub.push(...drum(seat, axis, r, 1.02 * r));
    // Darker caps show the axis and leave the coloured band between them.
    for (const side of [-1, 1]) skin.push(...drum(plus(seat, axis, side * 1.06 * r), axis, 0.74 * r, 0.07 * r, DARK_SKIN));
  }
  for (const c of form.children[i]) {
    const turn = form.chain.turn, along = turned(turn, 9 * c, form.axis(c));
    let seatOfChild = plus(form.shift(c), turned(turn, 9 * c, form.station[c]));
    if (form.chain.slides[c]) {
      const [from, to] = travel(run, c), w = form.radius[c];
      skin.push(...block(plus(seatOfChild, along, (from + to) / 2), along, 1.1 * w, (to - from) / 2 + 1.6 * w, DARK_SKIN));
      seatOfChild = plus(seatOfChild, along, Math.max(from, Math.min(to, 0)));
    }
    skin.push(...rod(seat, seatOfChild, 0.66 * r, 0.66 * form.radius[c]));
  }
  const leaf = form.leaves.indexOf(i);
  if (leaf >= 0) {
    const end = form.ends[leaf], slim = Math.min(0.5 * r, 0.45 * Math.hypot(...end));
    skin.push(...rod(seat, end, 0.62 * r, slim));
  }
}

/** Between which positions a slide moves, for the length of its rail. */
export function travel(run, j) {
  let low = Infinity, high = -Infinity;
  for (const column of [run.q_l[j], run.q_ld[j]]) for (let k = 0; k <= run.last; k++) { low = Math.min(low, column[k]); high = Math.max(high, column[k]); }
  return [low, high];
}

/** A ring just outside of the shapes around the joint: it shows the spring torque where a hub would be hidden. */
function collar(form, i, parts) {
  const axis = new Vector3(...form.axis(i)), r = form.radius[i], vertex = new Vector3();
  let widest = 0;
  for (const geometry of parts[i].skin) {
    const positions = geometry.attributes.position;
    for (let v = 0; v < positions.count; v++) {
      vertex.fromBufferAttribute(positions, v);
      const along = vertex.dot(axis);
      if (Math.abs(along) < r) widest = Math.max(widest, Math.sqrt(Math.max(0, vertex.lengthSq() - along * along)));
    }
  }
  const outer = Math.min(Math.max(1.05 * widest, 0.6 * r), 1.3 * r);
  return solidsFor(form.n).drum([0, 0, 0], form.axis(i), outer, 0.3 * r);
}

/** Everything that does not move: the base, and what carries it down to the floor. */
export function baseOf(run, form, floor, towardsViewer) {
  if (run.robot.base_shapes?.length) return join(run.robot.base_shapes.flatMap(shape));
  if (form.shaped) return null;
  const { block, drum, rod } = solidsFor(form.n), up = form.up, height = p => p[0] * up[0] + p[1] * up[1] + p[2] * up[2], parts = [];
  const down = (p, level) => plus(p, up, level - height(p));
  const seen = new Set();
  run.robot.bodies.forEach((body, i) => {
    if (body.parent !== null) return;
    const r = form.radius[i], turn = form.chain.turn, axis = turned(turn, 9 * i, form.axis(i));
    let seat = plus(form.shift(i), turned(turn, 9 * i, form.station[i]));
    const key = seat.map(x => Math.round(x / r)).join();
    if (seen.has(key)) return;
    seen.add(key);
    if (form.chain.slides[i]) {
      const [from, to] = travel(run, i);
      parts.push(...block(plus(seat, axis, (from + to) / 2), axis, 1.1 * r, (to - from) / 2 + 1.6 * r, DARK_SKIN));
      seat = plus(seat, axis, (from + to) / 2);
    } else if (Math.abs(height(axis)) < 0.7) {
      // A horizontal first axis leans on a post behind the arm, so that the links can swing past it.
      const side = axis[0] * towardsViewer[0] + axis[1] * towardsViewer[1] + axis[2] * towardsViewer[2] > 0 ? -1 : 1;
      const post = plus(seat, axis, side * 3.1 * r);
      parts.push(...drum(plus(seat, axis, side * 1.9 * r), axis, 0.5 * r, 1.2 * r, DARK_SKIN));
      seat = post;
    }
    const foot = down(seat, floor), tall = height(seat) - floor;
    if (tall > 0.2 * r) parts.push(...rod(seat, plus(foot, up, 0.3 * r), 0.72 * r, 0.95 * r, DARK_SKIN));
    parts.push(...drum(plus(foot, up, 0.14 * r), up, 2 * r, 0.14 * r, DARK_SKIN));
  });
  return join(parts);
}

/** How much of a joint's spring torque counts as full colour: the largest of all runs. */
export const largestSpring = runs => Math.max(0, ...runs.flatMap(run => run.spring.map(column => peakOf(run, column))));
