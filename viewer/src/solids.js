// Solids of which the robots are made. All of them carry colours per vertex, so that a body is one mesh.

import { BoxGeometry, BufferAttribute, BufferGeometry, Color, CylinderGeometry, LatheGeometry, Matrix4, Quaternion, SphereGeometry, Vector2, Vector3 } from 'three';
import { mergeGeometries } from 'three/examples/jsm/utils/BufferGeometryUtils.js';

export const SKIN = '#e9ebee', DARK_SKIN = '#6b727c';
const Y = new Vector3(0, 1, 0);

/** Turns the y axis to `direction` and moves the origin to `centre`. */
function pose(geometry, direction, centre) {
  const turn = new Quaternion().setFromUnitVectors(Y, new Vector3(...direction).normalize());
  return geometry.applyMatrix4(new Matrix4().compose(new Vector3(...centre), turn, new Vector3(1, 1, 1)));
}

export function paint(geometry, colour) {
  const plain = geometry.index ? geometry.toNonIndexed() : geometry, c = new Color(colour), count = plain.attributes.position.count;
  plain.deleteAttribute('uv');
  const colours = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) c.toArray(colours, 3 * i);
  return plain.setAttribute('color', new BufferAttribute(colours, 3));
}

/** Rods, drums and blocks; a robot of many joints gets them with fewer facets, as each is small. */
export function solidsFor(joints) {
  const around = joints > 10 ? 16 : 36, across = joints > 10 ? 8 : 14, bevel = joints > 10 ? 2 : 4;
  return {
    /** A rod with round ends from a to b. */
    rod(a, b, radiusA, radiusB, colour = SKIN) {
      const from = new Vector3(...a), way = new Vector3(...b).sub(from), length = way.length();
      const balls = [paint(new SphereGeometry(radiusA, around, across).translate(...a), colour), paint(new SphereGeometry(radiusB, around, across).translate(...b), colour)];
      if (length < 1e-9) return balls;
      const middle = from.addScaledVector(way, 0.5);
      return [paint(pose(new CylinderGeometry(radiusB, radiusA, length, around, 1, true), way.toArray(), middle.toArray()), colour), ...balls];
    },

    /** A drum along an axis, with rounded edges. */
    drum(centre, axis, radius, half, colour = SKIN) {
      const edge = 0.16 * Math.min(radius, half), profile = [new Vector2(0, -half)];
      for (const side of [-1, 1]) for (let s = 0; s <= bevel; s++) {
        const a = (side < 0 ? -Math.PI / 2 : 0) + s * Math.PI / 2 / bevel;
        profile.push(new Vector2(radius - edge + edge * Math.cos(a), side * (half - edge) + edge * Math.sin(a)));
      }
      profile.push(new Vector2(0, half));
      return [paint(pose(new LatheGeometry(profile, around), axis, centre), colour)];
    },

    block: (centre, axis, width, half, colour = SKIN) => [paint(pose(new BoxGeometry(width, 2 * half, width), axis, centre), colour)],
  };
}

/** A shape of the robot's description, in its link's frame. */
export function shape(description) {
  let geometry;
  if (description.kind === 'box') geometry = new BoxGeometry(...description.size);
  else if (description.kind === 'cylinder') geometry = new CylinderGeometry(description.radius, description.radius, description.length, 40).rotateX(Math.PI / 2);
  else if (description.kind === 'sphere') geometry = new SphereGeometry(description.radius, 36, 24);
  else if (description.kind === 'mesh') geometry = mesh(description.triangles);
  else return [];
  const r = description.rotation ?? [[1, 0, 0], [0, 1, 0], [0, 0, 1]], t = description.translation ?? [0, 0, 0];
  geometry.applyMatrix4(new Matrix4().set(...r[0], t[0], ...r[1], t[1], ...r[2], t[2], 0, 0, 0, 1));
  const [red, green, blue] = description.color ?? [];
  return [paint(geometry, red === undefined ? SKIN : new Color().setRGB(red, green, blue, 'srgb'))];
}

function mesh(base64) {
  const bytes = Uint8Array.from(atob(base64), c => c.charCodeAt(0)), view = new DataView(bytes.buffer), count = Math.floor(bytes.length / 36) * 9;
  const positions = new Float32Array(count);
  for (let i = 0; i < count; i++) positions[i] = view.getFloat32(4 * i, true);
  const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(positions, 3));
  geometry.computeVertexNormals();
  return geometry;
}

export const join = parts => (parts.length ? mergeGeometries(parts) : null);
