// The picture, in WebGL 2: faces, wires and pairs between the two frames, and the chosen pair. The
// graphics card interpolates the vertices, so a new time costs one number.
const BODIES = [[.88, .82, .68], [.56, .68, .84], [.70, .82, .66], [.84, .68, .72], [.74, .70, .86], [.78, .78, .78]];
const KINDS = [[.79, .15, .10], [.04, .31, .77], [.54, .17, .69], [.10, .50, .22], [.60, .36, 0]];
const CHOSEN = [1, .55, 0], WIRE = [.2, .2, .25];

// The position of a vertex at a time, and its projection.
const PROJECTION = `#version 300 es
precision highp float;
uniform float time, eye, bias;
uniform vec3 target;
uniform mat3 rotation;
uniform vec2 lens, range;
vec3 turned(vec3 before, vec3 after) {
  return rotation * (mix(before, after, time) - target) - vec3(0, 0, eye);
}
vec4 projected(vec3 p) {
  float z = ((range.y + range.x) * p.z + 2. * range.x * range.y) / (range.x - range.y);
  return vec4(lens * p.xy, z + bias * p.z, -p.z);
}`;

const MESH_VERTICES = PROJECTION + `
in vec3 before, after;
in float part;
uniform vec3 palette[6];
uniform vec3 dot_size;  // in pixels at distance 1, at least, at most
out vec3 place, colour;
void main() {
  place = turned(before, after);
  colour = palette[int(part)];
  gl_Position = projected(place);
  gl_PointSize = clamp(dot_size.x / -place.z, dot_size.y, dot_size.z);
}`;

const MESH_PIXELS = `#version 300 es
precision highp float;
in vec3 place, colour;
uniform float opacity, shaded, is_round;
out vec4 pixel;
void main() {
  if (is_round > 0. && length(gl_PointCoord - .5) > .5) discard;
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  float facing = abs(dot(normal, normalize(vec3(.35, .55, 1))));
  float light = shaded > 0. && facing >= 0. ? .45 + .55 * facing : 1.;
  pixel = vec4(light * colour, opacity);
}`;

// Lines of any width: a rectangle each, clipped in front of the eye.
const LINE_VERTICES = PROJECTION + `
in vec3 a_before, a_after, b_before, b_after;
uniform vec2 screen;
uniform float width;
void main() {
  vec3 a = turned(a_before, a_after), b = turned(b_before, b_after);
  float front = -range.x;
  if (a.z > front && b.z <= front) a = mix(a, b, (a.z - front) / (a.z - b.z));
  if (b.z > front && a.z <= front) b = mix(b, a, (b.z - front) / (b.z - a.z));
  vec4 p = projected(a), q = projected(b);
  vec2 along = screen * (q.xy / q.w - p.xy / p.w);
  vec2 across = along == vec2(0) ? vec2(0) : normalize(vec2(-along.y, along.x));
  vec4 end = (gl_VertexID & 2) == 0 ? p : q;
  end.xy += float((gl_VertexID & 1) * 2 - 1) * width * across / screen * end.w;
  gl_Position = end;
}`;

const LINE_PIXELS = `#version 300 es
precision highp float;
uniform vec3 colour;
uniform float opacity;
out vec4 pixel;
void main() { pixel = vec4(colour, opacity); }`;

class Picture {
  /// Throws an Error if the browser lacks WebGL 2.
  constructor(canvas, scene) {
    this.gl = canvas.getContext("webgl2", {antialias: true});
    if (!this.gl) throw new Error("This browser shows no picture: it has no WebGL 2.");
    this.canvas = canvas;
    this.scene = scene;
    const mesh = ["before", "after", "part"], line = ["a_before", "a_after", "b_before", "b_after"];
    this.mesh = this.program(MESH_VERTICES, MESH_PIXELS, mesh);
    this.line = this.program(LINE_VERTICES, LINE_PIXELS, line);
    this.vertices = this.points(scene.before, scene.after, scene.parts);
    this.marks = this.points(scene.marks.before, scene.marks.after, scene.marks.kinds);
    for (const name of ["faces", "points", "struck"]) this[name] = this.indices(scene[name]);
    for (const name of ["rods", "crossed", "meeting"]) this[name] = this.segments(scene[name]);
    this.wires = null;  // made at the first use
  }

  program(vertices, pixels, attributes) {
    const gl = this.gl, made = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertices], [gl.FRAGMENT_SHADER, pixels]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    attributes.forEach((name, i) => gl.bindAttribLocation(made, i, name));
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost())
      throw new Error("This browser shows no picture: " + gl.getProgramInfoLog(made));
    const places = {};
    for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); ++i) {
      const name = gl.getActiveUniform(made, i).name.replace("[0]", "");
      places[name] = gl.getUniformLocation(made, name);
    }
    return {made, places};
  }

  buffer(target, data) {
    const made = this.gl.createBuffer();
    this.gl.bindBuffer(target, made);
    this.gl.bufferData(target, data, this.gl.STATIC_DRAW);
    return made;
  }

  points(before, after, parts) {
    const gl = this.gl, layout = gl.createVertexArray();
    gl.bindVertexArray(layout);
    const buffers = [[before, 3, gl.FLOAT], [after, 3, gl.FLOAT], [parts, 1, gl.UNSIGNED_BYTE]].map(([data, size, type], i) => {
      const made = this.buffer(gl.ARRAY_BUFFER, data);
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, size, type, false, 0, 0);
      return made;
    });
    gl.bindVertexArray(null);
    return {layout, buffers, count: before.length / 3};
  }

  indices(data) {
    return {buffer: this.buffer(this.gl.ELEMENT_ARRAY_BUFFER, data), count: data.length};
  }

  positionsOf(ends) {
    const {before, after} = this.scene, data = new Float32Array(6 * ends.length);
    ends.forEach((v, i) => {
      data.set(before.subarray(3 * v, 3 * v + 3), 6 * i);
      data.set(after.subarray(3 * v, 3 * v + 3), 6 * i + 3);
    });
    return data;
  }

  /// Takes new positions from the scene.
  update() {
    const gl = this.gl, {before, after, marks} = this.scene;
    const fill = (buffer, data) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    };
    [before, after].forEach((data, i) => fill(this.vertices.buffers[i], data));
    [marks.before, marks.after].forEach((data, i) => fill(this.marks.buffers[i], data));
    for (const lines of [this.rods, this.crossed, this.meeting, this.chosen && this.chosen.lines])
      if (lines) fill(lines.buffer, this.positionsOf(lines.ends));
  }

  /// Wide lines: the ends of each, by vertex.
  segments(ends) {
    const gl = this.gl, layout = gl.createVertexArray();
    gl.bindVertexArray(layout);
    const buffer = this.buffer(gl.ARRAY_BUFFER, this.positionsOf(ends));
    for (let i = 0; i < 4; ++i) {
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 48, 12 * i);
      gl.vertexAttribDivisor(i, 1);
    }
    gl.bindVertexArray(null);
    return {layout, buffer, ends, count: ends.length / 2};
  }

  use(program) {
    const gl = this.gl, {camera, time} = this.shown, {width, height} = this.canvas;
    const at = program.places, [right, above, back] = camera.axes();
    gl.useProgram(program.made);
    gl.uniform1f(at.time, time);
    gl.uniform1f(at.eye, camera.distance);
    gl.uniform1f(at.bias, 0);
    gl.uniform3fv(at.target, camera.target);
    gl.uniformMatrix3fv(at.rotation, false, [0, 1, 2].flatMap(i => [right[i], above[i], back[i]]));
    gl.uniform2f(at.lens, height / (width * LENS), 1 / LENS);
    const reach = 2 + Math.hypot(...camera.target), near = Math.max(camera.distance - reach, .02 * camera.distance);
    gl.uniform2f(at.range, Math.max(near, this.shown.cut), camera.distance + reach);
    if (at.screen) gl.uniform2f(at.screen, width, height);
    return at;
  }

  /// Draws the mesh or the marks. `look`: colours (one or six), opacity, shaded, bias, size of dots.
  draw(points, mode, indices, look) {
    const gl = this.gl, at = this.use(this.mesh);
    const colours = Array.from({length: 6}, (_, i) => look.colours[i % look.colours.length]);
    gl.uniform3fv(at.palette, colours.flat());
    gl.uniform1f(at.opacity, look.opacity ?? 1);
    gl.uniform1f(at.shaded, look.shaded ? 1 : 0);
    gl.uniform1f(at.is_round, mode === gl.POINTS ? 1 : 0);
    gl.uniform1f(at.bias, look.bias ?? 0);
    gl.uniform3fv(at.dot_size, look.dots ?? [0, 1, 1]);
    gl.bindVertexArray(points.layout);
    if (indices) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices.buffer);
      gl.drawElements(mode, indices.count, gl.UNSIGNED_INT, 0);
    } else {
      gl.drawArrays(mode, 0, points.count);
    }
    gl.bindVertexArray(null);
  }

  drawLines(segments, colour, width, opacity, bias) {
    const gl = this.gl, at = this.use(this.line);
    gl.uniform3fv(at.colour, colour);
    gl.uniform1f(at.width, width * this.scale);
    gl.uniform1f(at.opacity, opacity);
    gl.uniform1f(at.bias, bias);
    gl.bindVertexArray(segments.layout);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, segments.count);
    gl.bindVertexArray(null);
  }

  drawMesh(show) {
    const gl = this.gl;
    if (show.faces) {
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(1, 1);
      this.draw(this.vertices, gl.TRIANGLES, this.faces, {colours: BODIES, shaded: true});
      gl.disable(gl.POLYGON_OFFSET_FILL);
    }
    if (show.wires) {
      this.wires ??= this.indices(wiresOf(this.scene.faces));
      this.draw(this.vertices, gl.LINES, this.wires, {colours: [WIRE], opacity: show.faces ? .5 : 1});
    }
    this.drawLines(this.rods, WIRE, 2, 1, 0);
    this.draw(this.vertices, gl.POINTS, this.points, {colours: [WIRE], dots: this.dots(.3, 3, 9)});
  }

  /// Sizes of dots: a width in typical edges, bounded below and above in pixels.
  dots(edges, least, most) {
    const unit = this.canvas.height / (2 * LENS) * this.scene.edgeLength;
    return [edges * unit, least * this.scale, most * this.scale];
  }

  drawPairs(opacity) {
    const gl = this.gl, bias = 1e-5;
    this.draw(this.vertices, gl.TRIANGLES, this.struck, {colours: [KINDS[0]], opacity: .7 * opacity, shaded: true});
    this.drawLines(this.crossed, KINDS[1], 1.6, opacity, bias);
    this.drawLines(this.meeting, KINDS[4], 1.6, opacity, bias);
    this.draw(this.marks, gl.POINTS, null, {colours: KINDS, opacity, bias, dots: this.dots(.25, 1.5, 9)});
  }

  /// Sets the chosen pair, if any: its vertices, edges and face, its middle and radius.
  choose(elements, middle, radius) {
    const gl = this.gl;
    if (this.chosen) {
      for (const made of [this.chosen.dots, this.chosen.face, this.chosen.lines]) gl.deleteBuffer(made.buffer);
      gl.deleteVertexArray(this.chosen.lines.layout);
    }
    this.chosen = elements && {
      middle, radius,
      dots: this.indices(new Uint32Array(elements.flat())),
      face: this.indices(new Uint32Array(elements.filter(e => e.length === 3).flat())),
      lines: this.segments(new Uint32Array(elements.flatMap(edgesOf))),
    };
  }

  drawChosen() {
    const gl = this.gl;
    this.draw(this.vertices, gl.TRIANGLES, this.chosen.face, {colours: [CHOSEN], opacity: .7});
    this.drawLines(this.chosen.lines, CHOSEN, 3, 1, 0);
    this.draw(this.vertices, gl.POINTS, this.chosen.dots, {colours: [CHOSEN], dots: this.dots(0, 8, 8)});
  }

  /// Draws the picture. `show` has a switch for each part.
  show(camera, time, show) {
    const gl = this.gl;
    this.scale = window.devicePixelRatio || 1;
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * this.scale));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * this.scale));
    const cut = show.cut && this.chosen ? camera.project(this.chosen.middle)[2] - this.chosen.radius : 0;
    this.shown = {camera, time, cut};
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    this.drawMesh(show);
    gl.depthMask(false);
    if (show.pairs) this.drawPairs(this.chosen ? .5 : 1);
    gl.disable(gl.DEPTH_TEST);
    if (show.pairs && show.through) this.drawPairs(this.chosen ? .06 : .18);
    if (this.chosen) this.drawChosen();
    gl.depthMask(true);
  }
}

/// The edges of an element, by vertex: none of a vertex, one of an edge, three of a face.
function edgesOf(element) {
  return element.length === 3 ? [0, 1, 1, 2, 2, 0].map(i => element[i]) : element.length === 2 ? element : [];
}

function wiresOf(faces) {
  const wires = new Uint32Array(2 * faces.length);
  for (let i = 0; i < faces.length; i += 3)
    wires.set([faces[i], faces[i + 1], faces[i + 1], faces[i + 2], faces[i + 2], faces[i]], 2 * i);
  return wires;
}
