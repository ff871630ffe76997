// The camera: it turns about a target, one axis always up. Lengths are the picture's: the mesh is
// within -1 and 1 along each axis.
"use strict";

const LENS = Math.tan(Math.PI / 12);  // half the height of what is seen at distance 1
const NEAREST = 1e-6, FARTHEST = 100;

class Camera {
  constructor(up) {
    this.up = up;
    this.reset();
  }

  reset() {
    this.yaw = -1.05;
    this.pitch = 0.45;
    this.target = [0, 0, 0];
    this.distance = 1.35 / LENS;
  }

  /// Unit vectors to the right, up, and towards the eye.
  axes() {
    const u = this.up, e = (u + 1) % 3, f = (u + 2) % 3;
    const right = [0, 0, 0], above = [0, 0, 0], back = [0, 0, 0];
    const [cy, sy, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    right[e] = -sy;
    right[f] = cy;
    back[e] = cp * cy;
    back[f] = cp * sy;
    back[u] = sp;
    above[e] = -sp * cy;
    above[f] = -sp * sy;
    above[u] = cp;
    return [right, above, back];
  }

  /// By a part of the picture's height to the right and down.
  turn(x, y) {
    this.yaw -= 3 * x;
    this.pitch = Math.min(Math.max(this.pitch + 3 * y, -Math.PI / 2), Math.PI / 2);
  }

  /// So that what is at the target goes by a part of the picture's height to the right and down.
  move(x, y) {
    const [right, above] = this.axes(), length = 2 * LENS * this.distance;
    this.target = this.target.map((c, i) => c + length * (y * above[i] - x * right[i]));
  }

  /// What is there, to the right and below the middle in heights of the picture, stays there.
  zoom(factor, x, y) {
    const before = this.distance;
    this.distance = Math.min(Math.max(before * factor, NEAREST), FARTHEST);
    const part = 1 - this.distance / before;
    this.move(-x * part * before / this.distance, -y * part * before / this.distance);
  }

  look(at, radius) {
    this.target = at;
    this.distance = Math.min(Math.max(radius / LENS, NEAREST), FARTHEST);
  }

  /// Where a point of the picture is: in heights of it, right of and below the middle; and how deep.
  project(point) {
    const [right, above, back] = this.axes();
    const from = point.map((c, i) => c - this.target[i]);
    const along = axis => axis[0] * from[0] + axis[1] * from[1] + axis[2] * from[2];
    const depth = this.distance - along(back);
    return [along(right) / (2 * LENS * depth), -along(above) / (2 * LENS * depth), depth];
  }
}
