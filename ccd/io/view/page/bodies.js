// Bodies that turn: their vertices' positions at a time, as in ccd/bodies/motion.hpp.

const MOTION = 25;  // numbers of a body: 1 and q0 q1 centre, or 0 and the rows of A0 A1; from 19 p0 p1

/// The matrix and the centre of a body at t: x(t) = A (X - centre) + p(t).
function placeOfBody(m, t) {
  const mix = (from, to) => (1 - t) * from + t * to;
  if (m[0] === 0) return {a: Array.from({length: 9}, (_, i) => mix(m[1 + i], m[10 + i])), centre: [0, 0, 0]};
  const unit = q => q.map(c => c / Math.hypot(...q)), size = Math.hypot(...m.subarray(1, 9));
  const [w, x, y, z] = unit([1, 2, 3, 4].map(i => mix(m[i] / size, m[4 + i] / size)));
  return {a: [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], centre: m.subarray(9, 12)};
}

function positionsAt(step, t) {
  const at = new Float64Array(step.rest.length);
  for (let b = 0, v = 0; b < step.ends.length; ++b) {
    const m = step.motions.subarray(MOTION * b, MOTION * (b + 1)), {a, centre} = placeOfBody(m, t);
    const p = [0, 1, 2].map(i => (1 - t) * m[19 + i] + t * m[22 + i]);
    for (; v < step.ends[b]; ++v) {
      const x = [0, 1, 2].map(i => step.rest[3 * v + i] - centre[i]);
      for (let i = 0; i < 3; ++i) at[3 * v + i] = a[3 * i] * x[0] + a[3 * i + 1] * x[1] + a[3 * i + 2] * x[2] + p[i];
    }
  }
  return at;
}
