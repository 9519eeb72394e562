// The place where a robot stands: which way is up, floor with a grid, light, and the camera that sees all of the motion.

import { Color, DirectionalLight, Group, HemisphereLight, Mesh, PlaneGeometry, Quaternion, ShaderMaterial, ShadowMaterial, Vector3 } from 'three';
import { framesFor, place, point, turned, FRAME } from './kinematics.js';
import { linkSide, motorSide, reference } from './form.js';
import { locate } from './data.js';
import { roundBelow } from './units.js';

/** Turns the base frame so that gravity points down the page's z axis. */
export function uprightOf(form) {
  return new Quaternion().setFromUnitVectors(new Vector3(...form.up), new Vector3(0, 0, 1));
}

/** All points that links, motor side and reference pass, in the world. */
export function sweptPoints(run, form, magnification, upright) {
  const points = [], frames = framesFor(form.chain), q = new Float64Array(run.n), at = { k: 0, f: 0 }, p = [0, 0, 0];
  const many = Math.max(12, Math.min(160, Math.floor(4000 / run.n)));
  const add = () => points.push(new Vector3(...p).applyQuaternion(upright));
  for (let s = 0; s < many; s++) {
    locate(run, run.begin + (run.end - run.begin) * s / (many - 1), at);
    for (const side of [linkSide, reference, (r, a, out) => motorSide(r, a, magnification, out)]) {
      place(form.chain, side(run, at, q), frames);
      if (!frames.every(Number.isFinite)) continue;
      for (let i = 0; i < run.n; i++) { for (let r = 0; r < 3; r++) p[r] = frames[FRAME * i + 9 + r]; add(); }
      form.leaves.forEach((i, k) => { point(frames, FRAME * i, form.ends[k], 0, p, 0); add(); });
    }
  }
  return points;
}

/** The height of the floor: at the base where the first joint stands above it, else below all that moves. */
export function floorOf(form, run, points, baseLow) {
  const lowest = Math.min(...points.map(p => p.z)), r = form.thick;
  if (baseLow !== null) return Math.min(baseLow, lowest - 1.2 * r);
  const first = run.robot.bodies.findIndex(body => body.parent === null);
  const height = form.up.reduce((sum, u, c) => sum + u * (form.shift(first)[c]), 0);
  if (height > 2.4 * r && lowest > -0.2 * r) return Math.min(0, lowest - 1.2 * r);
  return Math.min(0, lowest) - Math.max(0.14 * form.reach, 2.5 * r);
}

/** From where to look: along the axis of a planar robot, from above if it moves on a table, else from a corner. */
export function viewOf(run, form, upright) {
  const frames = framesFor(form.chain), at = locate(run, (run.begin + run.end) / 2, { k: 0, f: 0 });
  place(form.chain, linkSide(run, at, new Float64Array(run.n)), frames);
  const axes = run.robot.bodies.map((_, i) => new Vector3(...turned(frames, FRAME * i, form.axis(i))).applyQuaternion(upright));
  const hinges = axes.filter((_, i) => !form.chain.slides[i]), slides = axes.filter((_, i) => form.chain.slides[i]);
  const normal = hinges[0], planar = normal && hinges.every(axis => Math.abs(axis.dot(normal)) > 0.99) && slides.every(axis => Math.abs(axis.dot(normal)) < 0.1);
  if (!planar) return new Vector3(0.95, -1.15, 0.55).normalize();
  if (Math.abs(normal.z) > 0.7) return new Vector3(-0.25, -0.85, 0.95).normalize();
  const side = normal.clone().setZ(0).normalize(), right = new Vector3(0, 0, 1).cross(side);
  // x to the right on the screen, as in the text books.
  if (right.x < -1e-6 || (Math.abs(right.x) < 1e-6 && right.y < 0)) side.negate();
  return side.clone().addScaledVector(new Vector3(0, 0, 1), 0.26).addScaledVector(new Vector3(0, 0, 1).cross(side), 0.42).normalize();
}

/** Moves the camera along `view` until all points are in the picture. */
export function frameAll(camera, target, points, view, aspect) {
  const back = view, right = new Vector3(0, 0, 1).cross(back).normalize(), up = back.clone().cross(right);
  const tall = Math.tan(camera.fov * Math.PI / 360) * 0.86, wide = tall * aspect;
  const spans = [right, up].map(axis => { const along = points.map(p => p.dot(axis)); return (Math.min(...along) + Math.max(...along)) / 2; });
  const depths = points.map(p => p.dot(back)), middle = (Math.min(...depths) + Math.max(...depths)) / 2;
  target.set(0, 0, 0).addScaledVector(right, spans[0]).addScaledVector(up, spans[1]).addScaledVector(back, middle);
  const distance = Math.max(...points.map(p => Math.max(Math.abs(p.dot(right) - spans[0]) / wide, Math.abs(p.dot(up) - spans[1]) / tall) + p.dot(back) - middle));
  camera.position.copy(target).addScaledVector(back, distance);
  camera.near = distance / 200;
  camera.far = distance * 40;
}

const GRID = {
  vertexShader: 'varying vec2 at; void main() { at = position.xy; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
  fragmentShader: `uniform vec3 colour; uniform float cell, radius; varying vec2 at;
    float lines(float size) { vec2 g = at / size, d = abs(fract(g - 0.5) - 0.5) / fwidth(g); return 1.0 - min(min(d.x, d.y), 1.0); }
    void main() { float fade = 1.0 - smoothstep(0.25, 1.0, length(at) / radius);
      gl_FragColor = vec4(colour, fade * max(0.32 * lines(cell), 0.55 * lines(cell * 5.0)));
      #include <colorspace_fragment>
    }`,
};

/** Floor, grid and lights about a robot of this size. */
export class Stage {
  constructor(size, centre, floor) {
    this.group = new Group();
    this.cell = roundBelow(size / 5, [5, 2, 1]);
    const wide = 6 * size;
    this.grid = new Mesh(new PlaneGeometry(wide, wide), new ShaderMaterial({ ...GRID, transparent: true, depthWrite: false, uniforms: { colour: { value: new Color() }, cell: { value: this.cell }, radius: { value: wide / 2 } } }));
    this.shade = new Mesh(new PlaneGeometry(wide, wide), new ShadowMaterial({ depthWrite: false }));
    this.shade.receiveShadow = true;
    this.shade.renderOrder = -2; this.grid.renderOrder = -1;
    // The grid keeps to round numbers of the base frame, so it stays where it is under any robot.
    for (const plane of [this.grid, this.shade]) plane.position.z = floor;
    this.sky = new HemisphereLight('#ffffff', '#c3c8cf', 1.9);
    this.sun = new DirectionalLight('#ffffff', 1.9);
    this.sun.position.copy(centre).add(new Vector3(0.5, -0.55, 1.25).multiplyScalar(2.2 * size));
    this.sun.target.position.copy(centre);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.radius = 4;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.004 * size;
    const reach = 1.35 * size;
    Object.assign(this.sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.2 * size, far: 7 * size });
    const fill = new DirectionalLight('#dfe8ff', 0.5);
    fill.position.copy(centre).add(new Vector3(-1, 0.6, 0.5).multiplyScalar(size));
    fill.target.position.copy(centre);
    this.group.add(this.shade, this.grid, this.sky, this.sun, this.sun.target, fill, fill.target);
  }

  theme(colours) {
    this.grid.material.uniforms.colour.value.set(colours.grid);
    this.shade.material.opacity = colours.shadow;
  }
}

