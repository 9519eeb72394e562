// Paths of the tips: the reference, faint where it is still to come, and what the tip really did.

import { Group, Mesh, MeshBasicMaterial, SphereGeometry } from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { linkSide, reference, tipPaths } from './form.js';

const POINTS = 1500;
/** More tips than this only clutter the picture. */
const TIPS = 4;

export class Trails {
  constructor(run, form) {
    this.run = run;
    this.group = new Group();
    const line = (width, opacity) => new LineMaterial({ linewidth: width, transparent: true, opacity, depthWrite: false });
    this.materials = { future: line(2, 0.4), past: line(4.5, 0.95), tip: line(1.8, 1), mark: new MeshBasicMaterial() };
    const wanted = tipPaths(run, form, reference, POINTS), actual = tipPaths(run, form, linkSide, POINTS), ball = new SphereGeometry(0.3 * form.thick, 20, 14);
    this.lines = wanted.slice(0, TIPS).map((path, i) => {
      this.add(path, this.materials.future, 0);
      const past = this.add(path, this.materials.past, 1), tip = this.add(actual[i], this.materials.tip, 2), mark = new Mesh(ball, this.materials.mark);
      this.group.add(mark);
      return { past, tip, mark, path };
    });
  }

  add(path, material, order) {
    const line = new Line2(new LineGeometry().setPositions(path), material);
    line.renderOrder = order;
    line.frustumCulled = false;
    this.group.add(line);
    return line;
  }

  theme(colours) {
    const { future, past, tip, mark } = this.materials;
    for (const material of [future, past, mark]) material.color.set(colours.reference);
    tip.color.set(colours.trail);
  }

  /** Shows the paths up to time t; only counts change, the buffers stay as they are. */
  upTo(t) {
    const { begin, end } = this.run, share = end > begin ? Math.min(1, Math.max(0, (t - begin) / (end - begin))) : 1;
    const drawn = Math.round(share * (POINTS - 1));
    for (const { past, tip, mark, path } of this.lines) {
      past.geometry.instanceCount = tip.geometry.instanceCount = drawn;
      past.visible = tip.visible = drawn > 0;
      mark.position.fromArray(path, 3 * drawn);
    }
  }
}
