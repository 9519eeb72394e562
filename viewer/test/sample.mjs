// Made-up runs that look like physics: smooth motion, springs that carry the weight, torques that belong to them.
// `node test/sample.mjs FOLDER` writes one page a sample there, to look at.

import { writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const pack = values => Buffer.from(Float32Array.from(values).buffer).toString('base64');
const IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const about = { x: a => [[1, 0, 0], [0, Math.cos(a), -Math.sin(a)], [0, Math.sin(a), Math.cos(a)]], y: a => [[Math.cos(a), 0, Math.sin(a)], [0, 1, 0], [-Math.sin(a), 0, Math.cos(a)]] };

function body(joint, parent, translation, { axis = [0, 0, 1], rotation = IDENTITY, com = [0, 0, 0], mass = 1, kind = 'revolute', shapes = [], tip } = {}) {
  return { joint, kind, parent, rotation, translation, axis, com, mass, shapes, tip };
}

/** Joints follow offset + amplitude · sin(rate · t + phase); `error` and `load` are functions of joint and time. */
function run({ name, law = 'v-CBC', verdict, bodies, base_shapes = [], gravity = [0, 0, -9.81], limits = {}, seconds = 8, samples = 2000, wanted, stiffness, load, error = () => 0, push = null, events = [], nanFrom = Infinity, certificate = true }) {
  const t = Array.from({ length: samples }, (_, k) => seconds * k / (samples - 1)), joints = bodies.map((_, j) => j);
  const series = f => joints.map(j => pack(t.map((time, k) => (k >= nanFrom ? NaN : f(j, time)))));
  const pushed = (j, time) => (push && j === push.joint && time >= push.from && time <= push.to ? push.torque : 0);
  const spring = (j, time) => load(j, time) - pushed(j, time), link = (j, time) => wanted(j, time) + error(j, time);
  return {
    name, law, verdict, robot: { name, bodies, base_shapes, gravity, limits: { torque: joints.map(() => null), deflection: joints.map(() => null), lower: joints.map(() => null), upper: joints.map(() => null), velocity: joints.map(() => null), ...limits } }, samples,
    columns: {
      t: pack(t), q_l: series(link), q_m: series((j, time) => link(j, time) + spring(j, time) / stiffness[j]), spring: series(spring),
      u_m: series((j, time) => spring(j, time) * 1.03 + 0.02 * stiffness[j] * 1e-3 * Math.sin(40 * time)), q_ld: series(wanted), external: push ? series(pushed) : null,
      certificate: certificate ? pack(t.map((time, k) => (k >= nanFrom ? NaN : 3.5 + 0.4 * Math.sin(time)))) : null,
    },
    pushes: push ? [{ joint: push.joint, from: push.from, to: push.to, words: push.words }] : [], events,
  };
}

const decay = (time, from, size, rate = 3) => (time < from ? 0 : size * Math.exp(-rate * (time - from)) * Math.sin(9 * (time - from)));

export const LINKS = [0.4, 0.3];
export const elbow = (j, t) => [0.6 + 0.5 * Math.sin(1.2 * t), 0.4 + 0.6 * Math.sin(1.7 * t + 0.5)][j];

export function twoLink(changes = {}) {
  const axis = [0, -1, 0];
  const weight = (j, t) => { const a = elbow(0, t), b = a + elbow(1, t), tip = 9.81 * 0.9 * 0.15 * Math.cos(b); return j ? tip : tip + 9.81 * (1.5 * 0.2 + 0.9 * 0.4) * Math.cos(a); };
  return run({
    name: 'two-link-push', verdict: { good: true, words: 'follows its reference: rms link error 1.9 mrad, largest torque 71 % of the limit' },
    bodies: [body('shoulder', null, [0, 0, 0], { axis, com: [0.2, 0, 0], mass: 1.5 }), body('elbow', 0, [LINKS[0], 0, 0], { axis, com: [0.4 * LINKS[1], 0, 0], mass: 0.9, tip: [LINKS[1], 0, 0] })],
    limits: { torque: [9, 3] }, wanted: elbow, stiffness: [150, 60], load: weight,
    error: (j, t) => decay(t, 3, 0.03) + decay(t, 3.8, -0.02) + 2e-4 * Math.sin(3 * t),
    push: { joint: 1, from: 3, to: 3.8, torque: 2, words: 'push of 2 N m' },
    events: [{ t: 3.2, kind: 'limit', joint: 1, words: 'torque limit' }, { t: 5, kind: 'stop', joint: null, words: 'safe stop: error above 0.1 rad' }, { t: 6, kind: 'rejoin', joint: null, words: 'rejoins the reference' }],
    ...changes,
  });
}

const PANDA = [
  [[0, 0, 0.333], IDENTITY, [0.004, 0.002, -0.048]], [[0, 0, 0], about.x(-Math.PI / 2), [-0.003, -0.029, 0.003]], [[0, -0.316, 0], about.x(Math.PI / 2), [0.028, 0.039, -0.067]],
  [[0.0825, 0, 0], about.x(Math.PI / 2), [-0.053, 0.104, 0.027]], [[-0.0825, 0.384, 0], about.x(-Math.PI / 2), [-0.012, 0.041, -0.038]],
  [[0, 0, 0], about.x(Math.PI / 2), [0.06, -0.014, -0.01]], [[0.088, 0, 0], about.x(Math.PI / 2), [0.005, 0.001, 0.1]],
];
const HOME = [0, -0.6, 0, -1.8, 0, 1.5, 0.5];

export function panda(changes = {}) {
  return run({
    name: 'panda-sines', verdict: { good: true, words: 'follows its reference: rms link error 0.012 mrad, largest torque 61 % of the limit' },
    bodies: PANDA.map(([translation, rotation, com], j) => body(`panda_joint${j + 1}`, j ? j - 1 : null, translation, { rotation, com, mass: 3 })),
    limits: { torque: [87, 87, 87, 87, 12, 12, 12] },
    wanted: (j, t) => HOME[j] + 0.25 * Math.sin((0.9 + 0.13 * j) * t), stiffness: [14000, 14000, 9000, 9000, 5000, 5000, 4000],
    load: (j, t) => [0.4, -12, 3, 19, 0.6, 2.6, 0.1][j] * (1 + 0.35 * Math.sin((0.9 + 0.13 * j) * t + j)), error: (j, t) => 1.6e-5 * Math.sin(2.1 * t + j) * Math.exp(-0.2 * t), ...changes,
  });
}

export const pandaSoft = () => panda({ name: 'panda-sines-soft', law: 'PD', verdict: { good: false, words: 'leaves its reference: link error of 61 mrad, accepted are 30 mrad' }, seconds: 6, samples: 1400, certificate: false, error: (j, t) => 0.04 * Math.sin(1.3 * t + j) + 0.01 });

/** A torso with two arms of three and a head. */
export function branched() {
  const axis = [0, 1, 0], arm = (side, s) => [body(`${side}_shoulder`, 1, [0, s * 0.18, 0.3], { axis, com: [0, 0, -0.12] }), body(`${side}_elbow`, null, [0, s * 0.04, -0.26], { axis, com: [0, 0, -0.1] }), body(`${side}_wrist`, null, [0, 0, -0.22], { axis, com: [0, 0, -0.06] })];
  const bodies = [body('waist', null, [0, 0, 0.5], { com: [0, 0, 0.02] }), body('chest', 0, [0, 0, 0.12], { axis, com: [0, 0, 0.15] }), ...arm('left', 1), ...arm('right', -1)];
  [[3, 2], [4, 3], [6, 5], [7, 6]].forEach(([i, parent]) => { bodies[i].parent = parent; });
  return run({
    name: 'torso-two-arms', verdict: { good: true, words: 'follows its reference: rms link error 0.8 mrad' }, bodies, stiffness: bodies.map(() => 300),
    wanted: (j, t) => [0.4, 0.15, -0.6, -0.9, 0.2, -0.6, -0.9, 0.2][j] * (0.5 + 0.5 * Math.sin(1.1 * t + (j > 4 ? 1.6 : 0))), load: (j, t) => (8 - j) * Math.sin(1.1 * t + j), error: (j, t) => 1e-3 * Math.sin(2 * t + j) * (1 + j / 4),
    limits: { torque: bodies.map(() => 6) },
  });
}

export function pendulum() {
  return run({
    name: 'pendulum', verdict: { good: true, words: 'follows its reference: rms link error 0.3 µrad' }, certificate: false, samples: 400,
    bodies: [body('hinge', null, [0, 0, 0], { axis: [0, 1, 0], com: [0, 0, -0.06], mass: 0.4 })], wanted: (_, t) => 0.8 * Math.sin(1.5 * t), stiffness: [1.61], load: (_, t) => 0.24 * Math.sin(0.8 * Math.sin(1.5 * t)), error: (_, t) => 4e-7 * Math.sin(7 * t),
  });
}

/** An elbow that winds up until its numbers end. */
export const diverging = () => twoLink({
  name: 'two-link-diverging', verdict: { good: false, words: 'diverged at 4.81 s' }, push: null, certificate: false, error: (j, t) => 1e-4 * Math.exp(1.9 * t) * Math.sin(14 * t + j), nanFrom: 1203,
  events: [{ t: 4.2, kind: 'limit', joint: 1, words: 'torque limit' }],
});

/** Forty short links in a horizontal plane, as a snake. */
export function snake() {
  const bodies = Array.from({ length: 40 }, (_, j) => body(`segment_${j + 1}`, j ? j - 1 : null, j ? [0.05, 0, 0] : [0, 0, 0], { com: [0.025, 0, 0], mass: 0.1 }));
  return run({
    name: 'snake-40', verdict: { good: true, words: 'follows its reference: rms link error 0.05 mrad' }, bodies, gravity: [0, 0, 0], samples: 4000, stiffness: bodies.map(() => 20), wanted: (j, t) => 0.13 * Math.sin(1.2 * t - 0.25 * j),
    load: (j, t) => 0.05 * (1 - j / 50) * Math.sin(1.2 * t - 0.25 * j + 0.7), error: (j, t) => 1e-5 * (1 + j) * Math.sin(2 * t + j),
  });
}

/** A finger of 0.3 m whose joints cross a millimetre apart. */
export function finger() {
  const bodies = [0, 0.001, 0.11, 0.001, 0.1].map((x, j) => body(`finger_${j}`, j ? j - 1 : null, [x, 0, 0], { axis: j === 1 || j === 3 ? [0, 0, 1] : [0, -1, 0], com: j === 4 ? [0.044, 0, 0] : [0, 0, 0], mass: 0.02 }));
  return run({
    name: 'finger', verdict: { good: true, words: 'follows its reference: rms link error 0.4 mrad' }, bodies, certificate: false, stiffness: bodies.map(() => 2), wanted: (j, t) => [0.3, 0.15, 0.5, 0.1, 0.6][j] * (0.6 + 0.4 * Math.sin((1 + 0.1 * j) * t)),
    load: (j, t) => [0.06, 0.01, 0.03, 0.004, 0.01][j] * (1 + 0.4 * Math.sin(t + j)), error: (j, t) => 5e-4 * Math.sin(2 * t + j),
  });
}

/** A gantry: a slide, a hinge and a slide, with shapes of its own. */
export function gantry() {
  const grey = [0.55, 0.6, 0.66, 1];
  return run({
    name: 'gantry', verdict: { good: true, words: 'follows its reference: rms link error 0.2 mm' }, certificate: false,
    bodies: [
      body('rail', null, [0, 0, 0.6], { axis: [1, 0, 0], kind: 'prismatic', com: [0, 0, 0], shapes: [{ kind: 'box', size: [0.16, 0.16, 0.1], color: grey }] }),
      body('turret', 0, [0, 0, -0.1], { com: [0.15, 0, 0], shapes: [{ kind: 'cylinder', radius: 0.05, length: 0.1 }, { kind: 'box', size: [0.34, 0.05, 0.05], translation: [0.17, 0, 0] }, { kind: 'sphere', radius: 0.05, translation: [0.34, 0, 0] }] }),
      body('quill', 1, [0.34, 0, 0], { axis: [0, 0, -1], kind: 'prismatic', com: [0, 0, -0.12], shapes: [{ kind: 'cylinder', radius: 0.018, length: 0.3, translation: [0, 0, -0.1], color: [0.85, 0.55, 0.2, 1] }] }),
    ],
    base_shapes: [{ kind: 'box', size: [1.2, 0.08, 0.06], translation: [0, 0, 0.69], color: grey }, { kind: 'box', size: [0.07, 0.07, 0.66], translation: [-0.55, 0, 0.33] }, { kind: 'box', size: [0.07, 0.07, 0.66], translation: [0.55, 0, 0.33] }],
    wanted: (j, t) => [0.3 * Math.sin(t), 0.8 * Math.sin(1.4 * t), 0.05 + 0.05 * Math.sin(2 * t)][j], stiffness: [20000, 80, 30000], load: (j, t) => [30, 1.5, 12][j] * Math.sin((1 + 0.4 * j) * t), error: (j, t) => 2e-4 * Math.sin(3 * t + j),
  });
}

export const SAMPLES = { 'two-link': [twoLink], panda: [panda], two: [panda, pandaSoft], branched: [branched], pendulum: [pendulum], diverging: [diverging], snake: [snake], finger: [finger], gantry: [gantry], unlike: [twoLink, pendulum] };

export const json = makers => ({ format: 1, program: 'flexure 0.1.0', runs: makers.map(make => make()) });

/** Puts runs into the page as the program does. */
export function fill(page, data) {
  return page.replace('id="flexure-runs">null<', () => `id="flexure-runs">${JSON.stringify(data).replaceAll('<', '\\u003c')}<`);
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const { page } = await import('../build.mjs'), empty = await page();
  for (const [name, makers] of Object.entries(SAMPLES)) writeFileSync(`${process.argv[2]}/${name}.html`, fill(empty, json(makers)));
}
