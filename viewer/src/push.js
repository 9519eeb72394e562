// External pushes: an arrow at the pushed link and its words, as long as the push acts.

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, Vector3 } from 'three';
import { FRAME, point } from './kinematics.js';
import { peakOf, valueAt } from './data.js';

const Y = new Vector3(0, 1, 0);

export class Pushes {
  constructor(run, form, host) {
    Object.assign(this, { run, form, host, group: new Group(), material: new MeshStandardMaterial({ roughness: 0.6 }) });
    const r = 0.32 * form.thick, shaft = new CylinderGeometry(r, r, 1, 20).translate(0, -0.5, 0), head = new ConeGeometry(2.4 * r, 5 * r, 28).translate(0, -2.5 * r, 0);
    this.headLength = 5 * r;
    this.arrows = run.pushes.filter(push => push.joint >= 0 && push.joint < run.n).map(push => {
      const arrow = new Group(), body = new Mesh(shaft, this.material), element = document.createElement('span');
      arrow.add(body, new Mesh(head, this.material));
      arrow.visible = false;
      this.group.add(arrow);
      element.className = 'push-words';
      element.textContent = push.words;
      element.hidden = true;
      host.append(element);
      return { push, arrow, body, label: { element, x: 0, y: 0 }, peak: run.external ? peakOf(run, run.external[push.joint]) : 0 };
    });
    this.handle = new Float64Array(3); this.hinge = new Float64Array(3); this.local = new Float64Array(3);
    this.head = new Vector3(); this.way = new Vector3(); this.arm = new Vector3(); this.axis = new Vector3(); this.turn = new Quaternion();
  }

  theme(colours) { this.material.color.set(colours.push); }

  /** Where the link of joint j is pushed: at its far end. */
  handleOf(j) {
    const { form, local } = this, leaf = form.leaves.indexOf(j);
    if (leaf >= 0) for (let r = 0; r < 3; r++) local[r] = 0.8 * form.ends[leaf][r];
    else { const c = form.children[j][0]; for (let r = 0; r < 3; r++) local[r] = 0.75 * form.chain.shift[3 * c + r]; }
    return local;
  }

  show(t, at, frames, project) {
    const { run, form } = this;
    let above = null;
    for (const { push, arrow, body, label, peak } of this.arrows) {
      const acts = t >= push.from && t <= push.to && t <= run.end;
      arrow.visible = acts;
      label.element.hidden = !acts;
      if (!acts) continue;
      const j = push.joint, o = FRAME * j, torque = run.external ? valueAt(run.external[j], at) : 1;
      point(frames, o, this.handleOf(j), 0, this.handle, 0);
      const [x, y, z] = form.axis(j);
      this.axis.set(frames[o] * x + frames[o + 1] * y + frames[o + 2] * z, frames[o + 3] * x + frames[o + 4] * y + frames[o + 5] * z, frames[o + 6] * x + frames[o + 7] * y + frames[o + 8] * z);
      this.head.fromArray(this.handle);
      if (form.chain.slides[j]) this.way.copy(this.axis);
      else {
        this.way.crossVectors(this.axis, this.arm.set(this.handle[0] - frames[o + 9], this.handle[1] - frames[o + 10], this.handle[2] - frames[o + 11]));
        if (this.way.lengthSq() < 1e-12 * form.reach ** 2) this.way.set(this.axis.y, this.axis.z, this.axis.x).cross(this.axis);
      }
      this.way.normalize().multiplyScalar(torque < 0 ? -1 : 1);
      const strength = peak > 0 ? Math.abs(torque) / peak : 1, long = form.reach * (0.1 + 0.14 * strength);
      // The arrow ends at the surface of the link, not inside of it.
      this.head.addScaledVector(this.way, -0.7 * form.radius[j]);
      arrow.position.copy(this.head);
      arrow.quaternion.copy(this.turn.setFromUnitVectors(Y, this.way));
      body.scale.y = Math.max(1e-3, long - this.headLength);
      body.position.y = -this.headLength;
      project(this.head.addScaledVector(this.way, -long), label, above);
      above = label;
    }
  }
}
