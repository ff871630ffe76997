// The camera turns about a target with one axis up. In its units the mesh is in [-1, 1] on each
// axis.
"use strict";

const LENS = Math.tan(Math.PI / 12);  // half the visible height at distance 1
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

  /// Turns by x to the right and y down, in heights of the picture.
  turn(x, y) {
    this.yaw -= 3 * x;
    this.pitch = Math.min(Math.max(this.pitch + 3 * y, -Math.PI / 2), Math.PI / 2);
  }

  /// Moves the picture by x to the right and y down, in its heights, at the target's depth.
  move(x, y) {
    const [right, above] = this.axes(), length = 2 * LENS * this.distance;
    this.target = this.target.map((c, i) => c + length * (y * above[i] - x * right[i]));
  }

  /// Zooms about the point x to the right of and y below the middle, in heights of the picture.
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

  /// Returns a point's position, right of and below the middle in heights of the picture, and depth.
  project(point) {
    const [right, above, back] = this.axes();
    const from = point.map((c, i) => c - this.target[i]);
    const along = axis => axis[0] * from[0] + axis[1] * from[1] + axis[2] * from[2];
    const depth = this.distance - along(back);
    return [along(right) / (2 * LENS * depth), -along(above) / (2 * LENS * depth), depth];
  }
}
