// One 3-D panel: a run's robot on its stage, seen by a camera one can move.

import { Box3, Color, Group, Mesh, MeshStandardMaterial, PCFShadowMap, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Arm } from './arm.js';
import { baseOf } from './body.js';
import { Pushes } from './push.js';
import { Trails } from './trail.js';
import { floorOf, frameAll, Stage, sweptPoints, uprightOf, viewOf } from './stage.js';

export function canDraw() {
  try {
    return Boolean(document.createElement('canvas').getContext('webgl2'));
  } catch {
    return false;
  }
}

export class Panel {
  constructor(host, run, form, springScale, magnification, colours) {
    Object.assign(this, { host, run, form, dirty: true });
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    host.append(this.renderer.domElement);
    // A browser may take a context away and give it back, while nothing moves, too.
    this.renderer.domElement.addEventListener('webglcontextrestored', () => { this.dirty = true; });
    this.scene = new Scene();
    this.scene.background = new Color();
    this.camera = new PerspectiveCamera(30, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);

    const upright = uprightOf(form), robot = new Group(), r = form.thick;
    robot.quaternion.copy(upright);
    this.view = viewOf(run, form, upright);
    const towards = this.view.clone().applyQuaternion(upright.clone().invert()).toArray();
    this.arm = new Arm(run, form, springScale);
    this.trails = new Trails(run, form);
    this.pushes = new Pushes(run, form, host);
    robot.add(this.arm.group, this.trails.group, this.pushes.group);
    this.scene.add(robot);

    const points = sweptPoints(run, form, magnification, upright), baseMaterial = new MeshStandardMaterial({ vertexColors: true, roughness: 0.6 });
    let baseLow = null;
    const addBase = geometry => {
      const base = new Mesh(geometry, baseMaterial);
      base.castShadow = base.receiveShadow = true;
      robot.add(base);
      return base;
    };
    const standing = [];
    if (form.shaped) {
      const geometry = baseOf(run, form, 0, towards);
      if (geometry) {
        const { min, max } = new Box3().setFromObject(addBase(geometry));
        baseLow = min.z;
        for (const x of [min.x, max.x]) for (const y of [min.y, max.y]) for (const z of [min.z, max.z]) standing.push(new Vector3(x, y, z));
        // A hall around the robot must not make the robot small.
        if (min.distanceTo(max) > 4 * form.reach) standing.length = 0;
      }
    }
    const floor = floorOf(form, run, points, baseLow);
    if (!form.shaped) addBase(baseOf(run, form, floor, towards));

    // The picture holds all of the motion with the thickness of its parts, and the foot of the base.
    const base = new Vector3(...form.shift(0)).applyQuaternion(upright);
    this.points = points.flatMap(p => [1.6 * r, -1.6 * r].flatMap(d => [new Vector3(d, 0, 0), new Vector3(0, d, 0), new Vector3(0, 0, d)].map(way => way.add(p))));
    this.points.push(...standing, new Vector3(base.x + 1.5 * r, base.y, floor), new Vector3(base.x - 1.5 * r, base.y, floor));
    const box = new Box3().setFromPoints(this.points);
    this.stage = new Stage(Math.max(box.getSize(new Vector3()).length() / 1.5, form.reach), box.getCenter(new Vector3()), floor);
    this.scene.add(this.stage.group);

    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableDamping = false;
    this.controls.addEventListener('change', () => { this.dirty = true; });
    this.screen = new Vector3();
    this.project = (p, label, above) => {
      this.screen.copy(p).applyQuaternion(robot.quaternion).project(this.camera);
      const wide = label.element.offsetWidth;
      label.x = Math.max(8, Math.min((this.screen.x + 1) / 2 * this.width, this.width - wide - 8));
      label.y = Math.max(64, Math.min((1 - this.screen.y) / 2 * this.height, this.height - 60));
      // Words of pushes at neighbouring joints must not cover each other.
      if (above && Math.abs(label.y - above.y) < 28 && label.x < above.x + above.element.offsetWidth && above.x < label.x + wide) label.y = above.y + (above.y > this.height / 2 ? -28 : 28);
      label.element.style.transform = `translate(${label.x.toFixed(1)}px, ${label.y.toFixed(1)}px) translate(0, -50%)`;
    };
    this.theme(colours);
    this.resize();
    this.resetView();
  }

  theme(colours) {
    this.scene.background.set(colours.ground);
    for (const part of [this.stage, this.arm, this.trails, this.pushes]) part.theme(colours);
    this.dirty = true;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width && height && (width !== this.width || height !== this.height)) this.size(width, height);
  }

  size(width, height) {
    Object.assign(this, { width, height, dirty: true });
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.moved) this.resetView();
  }

  resetView() {
    if (!this.controls || !this.width) return;
    frameAll(this.camera, this.controls.target, this.points, this.view, this.camera.aspect);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.moved = false;
    this.dirty = true;
  }

  /** Takes over another panel's view, so that two runs of one robot are seen from the same side. */
  follow(other) {
    this.camera.position.copy(other.camera.position);
    this.controls.target.copy(other.controls.target);
    this.controls.update();
    this.moved = true;
  }

  pose(t, at, magnification) {
    this.arm.pose(at, magnification);
    this.trails.upTo(Math.min(t, this.run.end));
    this.pushes.show(t, at, this.arm.frames, this.project);
    this.dirty = true;
  }

  render() {
    if (!this.dirty) return;
    this.renderer.render(this.scene, this.camera);
    this.dirty = false;
  }

  /** A still picture for paper, in its own size. */
  picture(width, height) {
    const { renderer, camera } = this, ratio = renderer.getPixelRatio(), before = [this.width, this.height];
    renderer.setPixelRatio(2);
    this.size(width, height);
    renderer.render(this.scene, camera);
    const picture = renderer.domElement.toDataURL('image/png');
    renderer.setPixelRatio(ratio);
    this.size(...before);
    return picture;
  }

  /** Gives up shadows first, then sharpness, where the machine draws too slowly. */
  ease() {
    if (this.stage.sun.castShadow) this.stage.sun.castShadow = false;
    else this.renderer.setPixelRatio(Math.max(0.5, Math.min(1, this.renderer.getPixelRatio()) * 0.75));
    this.dirty = true;
  }
}
