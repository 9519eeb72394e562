// Where the bodies are at given joint positions. Plain numbers, so that tips and paths need no 3-D library.

/** Frames are 12 numbers a body: the rotation row by row, then the origin, all in the base frame. */
export const FRAME = 12;

export function chainOf(robot) {
  const bodies = robot.bodies, n = bodies.length;
  const chain = { n, parent: new Int32Array(n), turn: new Float64Array(9 * n), shift: new Float64Array(3 * n), axis: new Float64Array(3 * n), slides: bodies.map(body => body.kind === 'prismatic') };
  bodies.forEach((body, i) => {
    chain.parent[i] = body.parent ?? -1;
    chain.turn.set((body.rotation ?? [[1, 0, 0], [0, 1, 0], [0, 0, 1]]).flat(), 9 * i);
    chain.shift.set(body.translation ?? [0, 0, 0], 3 * i);
    const [x, y, z] = body.axis ?? [0, 0, 1], length = Math.hypot(x, y, z) || 1;
    chain.axis.set([x / length, y / length, z / length], 3 * i);
  });
  return chain;
}

export const framesFor = chain => new Float64Array(FRAME * chain.n);

const joint = new Float64Array(FRAME), own = new Float64Array(9);
const BASE = Float64Array.of(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0);

/** Writes the link frames at the joint positions q into `frames`. */
export function place(chain, q, frames) {
  for (let i = 0; i < chain.n; i++) {
    const above = chain.parent[i] < 0 ? BASE : frames, a = chain.parent[i] < 0 ? 0 : FRAME * chain.parent[i], o = FRAME * i;
    multiply(above, a, chain.turn, 9 * i, joint, 0);
    point(above, a, chain.shift, 3 * i, joint, 9);
    const x = chain.axis[3 * i], y = chain.axis[3 * i + 1], z = chain.axis[3 * i + 2];
    if (chain.slides[i]) {
      for (let c = 0; c < 9; c++) frames[o + c] = joint[c];
      for (let r = 0; r < 3; r++) frames[o + 9 + r] = joint[9 + r] + q[i] * (joint[3 * r] * x + joint[3 * r + 1] * y + joint[3 * r + 2] * z);
    } else {
      const c = Math.cos(q[i]), s = Math.sin(q[i]), v = 1 - c;
      own[0] = c + x * x * v; own[1] = x * y * v - z * s; own[2] = x * z * v + y * s;
      own[3] = x * y * v + z * s; own[4] = c + y * y * v; own[5] = y * z * v - x * s;
      own[6] = x * z * v - y * s; own[7] = y * z * v + x * s; own[8] = c + z * z * v;
      multiply(joint, 0, own, 0, frames, o);
      for (let r = 0; r < 3; r++) frames[o + 9 + r] = joint[9 + r];
    }
  }
  return frames;
}

function multiply(a, i, b, j, out, o) {
  for (let r = 0; r < 3; r++) for (let c = 0; c < 3; c++)
    out[o + 3 * r + c] = a[i + 3 * r] * b[j + c] + a[i + 3 * r + 1] * b[j + 3 + c] + a[i + 3 * r + 2] * b[j + 6 + c];
}

/** A direction of a body's frame in the base frame; also turns by a bare rotation matrix. */
export const turned = (frames, i, v) => [0, 1, 2].map(r => frames[i + 3 * r] * v[0] + frames[i + 3 * r + 1] * v[1] + frames[i + 3 * r + 2] * v[2]);

/** A point of a body's frame (frame at index i) in the base frame. */
export function point(frames, i, p, j, out, o) {
  for (let r = 0; r < 3; r++) out[o + r] = frames[i + 3 * r] * p[j] + frames[i + 3 * r + 1] * p[j + 1] + frames[i + 3 * r + 2] * p[j + 2] + frames[i + 9 + r];
  return out;
}
