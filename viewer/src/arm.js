// The moving robot: links with coloured hubs, and the motor side as a translucent ghost of it.

import { Color, Group, Mesh, MeshStandardMaterial } from 'three';
import { bodiesOf } from './body.js';
import { FRAME, framesFor, place } from './kinematics.js';
import { linkSide, motorSide } from './form.js';
import { valueAt } from './data.js';
import { RAMP } from './theme.js';

const ramp = RAMP.map(colour => new Color(colour));

function rampColour(share, out) {
  const x = Math.min(1, Math.max(0, share)) * (ramp.length - 1), i = Math.min(ramp.length - 2, Math.floor(x));
  return out.lerpColors(ramp[i], ramp[i + 1], x - i);
}

export class Arm {
  constructor(run, form, springScale) {
    Object.assign(this, { run, form, springScale, group: new Group(), q: new Float64Array(run.n), frames: framesFor(form.chain) });
    const skin = new MeshStandardMaterial({ vertexColors: true, roughness: 0.5, metalness: 0.05 });
    // The ghost lies a little behind its links in depth: where both coincide only the links show, without flicker.
    const behind = { polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4, transparent: true };
    // First only the depth, then the colour of the nearest surface: its inner parts do not shine through.
    this.veil = new MeshStandardMaterial({ ...behind, colorWrite: false });
    this.ghost = new MeshStandardMaterial({ ...behind, depthWrite: false, roughness: 0.6 });
    this.links = []; this.ghosts = []; this.hubs = [];
    bodiesOf(run, form).forEach((body, j) => {
      const link = still(new Group()), shadow = still(new Group()), hub = new MeshStandardMaterial({ roughness: 0.42, metalness: 0.05 });
      for (const [geometry, material] of [[body.skin, skin], [body.hub, hub]]) {
        if (!geometry) continue;
        const solid = new Mesh(geometry, material);
        solid.castShadow = solid.receiveShadow = true;
        link.add(solid);
        for (const [order, side] of [[3, this.veil], [4, this.ghost]]) {
          const part = new Mesh(geometry, side);
          part.renderOrder = order;
          shadow.add(part);
        }
      }
      this.links[j] = link; this.ghosts[j] = shadow; this.hubs[j] = hub;
      this.group.add(link, shadow);
    });
  }

  theme(colours) {
    this.ghost.color.set(colours.ghost);
    this.ghost.opacity = colours.veil;
  }

  /** Moves links and ghost to a place in the run. */
  pose(at, magnification) {
    const { run, form, q, frames } = this;
    place(form.chain, motorSide(run, at, magnification, q), frames);
    for (let j = 0; j < run.n; j++) setFrame(this.ghosts[j], frames, j);
    place(form.chain, linkSide(run, at, q), frames);
    for (let j = 0; j < run.n; j++) {
      setFrame(this.links[j], frames, j);
      rampColour(Math.abs(valueAt(run.spring[j], at)) / this.springScale, this.hubs[j].color);
    }
  }
}

const still = object => { object.matrixAutoUpdate = false; return object; };

function setFrame(object, frames, j) {
  const o = FRAME * j;
  object.matrix.set(
    frames[o], frames[o + 1], frames[o + 2], frames[o + 9],
    frames[o + 3], frames[o + 4], frames[o + 5], frames[o + 10],
    frames[o + 6], frames[o + 7], frames[o + 8], frames[o + 11], 0, 0, 0, 1);
  object.matrixWorldNeedsUpdate = true;
}

/** The factor that shows the largest deflection as about 15° and keeps the whole robot below 60° together. */
export function autoMagnification(run, form, roundNearest) {
  let turn = 0, slide = 0, together = 0;
  for (let k = 0; k <= run.last; k++) {
    let sum = 0;
    for (let j = 0; j < run.n; j++) {
      const size = Math.abs(run.deflection[j][k]);
      if (run.prismatic[j]) slide = Math.max(slide, size); else { turn = Math.max(turn, size); sum += size; }
    }
    together = Math.max(together, sum);
  }
  const wanted = Math.min(turn > 0 ? Math.PI / 12 / turn : Infinity, together > 0 ? Math.PI / 3 / together : Infinity, slide > 0 ? 0.08 * form.reach / slide : Infinity);
  return Number.isFinite(wanted) ? Math.max(1, roundNearest(wanted)) : 1;
}
