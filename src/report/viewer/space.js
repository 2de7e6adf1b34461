// Draw solids and points in a canvas by WebGL, from a side that the reader can choose.

const POINT_VERTEX = `
  attribute vec3 place; attribute vec3 colour; uniform mat4 view; uniform float size; varying vec3 shade;
  void main() { gl_Position = view * vec4(place, 1.0); gl_PointSize = size / gl_Position.w; shade = colour; }`;
const POINT_FRAGMENT = `
  precision mediump float; varying vec3 shade;
  void main() { if (length(gl_PointCoord - 0.5) > 0.5) discard; gl_FragColor = vec4(shade, 1.0); }`;
// Light comes from the reader's side.
const SOLID_VERTEX = `
  attribute vec3 place; attribute vec3 normal; uniform mat4 view; uniform mat4 model; uniform vec3 eye; varying float light;
  void main() {
    gl_Position = view * (model * vec4(place, 1.0));
    light = 0.6 + 0.4 * max(dot((model * vec4(normal, 0.0)).xyz, eye), 0.0);
  }`;
const SOLID_FRAGMENT = `
  precision mediump float; uniform vec3 colour; varying float light;
  void main() { gl_FragColor = vec4(colour * light, 1.0); }`;

class Space {
  // `radius` is that of a ball around everything; `onTurn` is called when the view changes.
  constructor(canvas, radius, onTurn) {
    this.canvas = canvas;
    this.shapes = [];
    this.#prepare();
    [this.radius, this.yaw, this.pitch, this.near, this.onTurn] = [radius, -1.1, 0.6, 1, onTurn];
    // The share of the pixels across and up that are drawn: fewer where drawing is slow.
    this.detail = 1;
    // A phone may take the memory of the picture away, and give it back.
    canvas.addEventListener("webglcontextlost", event => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      this.#prepare();
      this.setSolids(this.shapes);
      this.onTurn();
    });
    this.#listen();
  }

  #prepare() {
    const options = { antialias: true, preserveDrawingBuffer: true };
    const gl = this.gl = this.canvas.getContext("webgl", options);
    if (!gl) throw new Error("no WebGL");
    this.points = program(gl, POINT_VERTEX, POINT_FRAGMENT, ["place", "colour"], ["view", "size"]);
    this.surface = program(gl, SOLID_VERTEX, SOLID_FRAGMENT, ["place", "normal"], ["view", "model", "eye", "colour"]);
    this.placeBuffer = gl.createBuffer();
    this.colourBuffer = gl.createBuffer();
    this.solids = [];
  }

  // Sets the shapes of the solids.
  setSolids(shapes) {
    const gl = this.gl;
    this.shapes = shapes;
    this.solids = shapes.map(shape => {
      const { places, normals } = mesh(shape);
      const [placeBuffer, normalBuffer] = [places, normals].map(numbers => {
        const buffer = gl.createBuffer();
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STATIC_DRAW);
        return buffer;
      });
      return { placeBuffer, normalBuffer, count: places.length / 3 };
    });
  }

  // Draws solids with their models and colours, points with theirs, and a ring around a marked one.
  draw(places, colours, size, marked, models = [], solidColours = []) {
    if (this.gl.isContextLost()) return;
    const { gl, canvas } = this, ratio = this.detail * Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map(x => Math.max(1, Math.round(x * ratio)));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    this.#look(width / height);
    const surface = this.surface;
    gl.useProgram(surface.program);
    gl.uniformMatrix4fv(surface.view, false, this.view);
    gl.uniform3fv(surface.eye, this.eye);
    this.solids.forEach(({ placeBuffer, normalBuffer, count }, at) => {
      gl.uniformMatrix4fv(surface.model, false, models[at]);
      gl.uniform3fv(surface.colour, solidColours[at]);
      attribute(gl, surface.place, placeBuffer);
      attribute(gl, surface.normal, normalBuffer);
      gl.drawArrays(gl.TRIANGLES, 0, count);
    });
    const points = this.points;
    gl.useProgram(points.program);
    gl.uniformMatrix4fv(points.view, false, this.view);
    this.#fill(this.placeBuffer, points.place, places);
    this.#fill(this.colourBuffer, points.colour, colours);
    // Pixels of a point at distance 1; `size` is its diameter in the unit of the places.
    const unit = size * this.near / Math.tan(0.35) * Math.min(width, height) / 2;
    gl.uniform1f(points.size, unit);
    gl.drawArrays(gl.POINTS, 0, places.length / 3);
    this.places = places;
    if (marked === null) return;
    // A marked point shines through what hides it.
    gl.disable(gl.DEPTH_TEST);
    const place = places.slice(3 * marked, 3 * marked + 3), own = colours.slice(3 * marked, 3 * marked + 3);
    for (const [colour, larger] of [[[0, 0, 0], 2.8], [[1, 1, 1], 2.2], [own, 1.5]]) {
      this.#fill(this.placeBuffer, points.place, new Float32Array(place));
      this.#fill(this.colourBuffer, points.colour, new Float32Array(colour));
      gl.uniform1f(points.size, Math.max(larger * unit, 3 * larger * ratio * this.distance));
      gl.drawArrays(gl.POINTS, 0, 1);
    }
  }

  // Where in the canvas a place is, in CSS pixels, and how near.
  project(x, y, z) {
    const m = this.view, w = m[3] * x + m[7] * y + m[11] * z + m[15];
    const [u, v] = [0, 1].map(row => (m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row]) / w);
    return [(u + 1) / 2 * this.canvas.clientWidth, (1 - v) / 2 * this.canvas.clientHeight, w];
  }

  // The sensor at a place of the canvas; null if there is none. `faces` says which ones the reader sees.
  pick(left, top, reach, faces) {
    let best = null, least = reach;
    for (let at = 0; at < this.places.length / 3; at++) {
      if (!faces(at, this.eye)) continue;
      const [x, y] = this.project(...this.places.subarray(3 * at, 3 * at + 3));
      const far = Math.hypot(x - left, y - top);
      if (far < least) [best, least] = [at, far];
    }
    return best;
  }

  turn(across, up) {
    this.yaw -= across;
    this.pitch = Math.min(Math.max(this.pitch + up, -1.5), 1.5);
    this.onTurn();
  }

  bring(nearer) {
    this.near = Math.min(Math.max(this.near * nearer, 0.5), 6);
    this.onTurn();
  }

  // The matrix from places to the canvas, by columns.
  #look(aspect) {
    const [cy, sy, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    const right = [-sy, cy, 0], up = [-sp * cy, -sp * sy, cp], eye = this.eye = [cp * cy, cp * sy, sp];
    const half = Math.tan(0.35), far = this.distance = 1.05 * this.radius / Math.sin(0.35);
    const zoom = this.near / half, [fx, fy] = aspect > 1 ? [zoom / aspect, zoom] : [zoom, zoom * aspect];
    const [back, front] = [far + 1.5 * this.radius, far - 1.5 * this.radius];
    const depth = (front + back) / (front - back), shift = 2 * front * back / (front - back);
    this.view = new Float32Array(16);
    for (let axis = 0; axis < 3; axis++) {
      this.view.set([fx * right[axis], fy * up[axis], depth * eye[axis], -eye[axis]], 4 * axis);
    }
    this.view.set([0, 0, shift - depth * far, far], 12);
  }

  #fill(buffer, location, numbers) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
    attribute(gl, location, buffer);
  }

  #listen() {
    const canvas = this.canvas, held = new Map();
    let spread = 0;
    canvas.addEventListener("pointerdown", event => {
      held.set(event.pointerId, [event.clientX, event.clientY]);
      spread = 0;
    });
    canvas.addEventListener("pointermove", event => {
      const before = held.get(event.pointerId);
      if (!before) return;
      held.set(event.pointerId, [event.clientX, event.clientY]);
      if (held.size === 1) {
        this.turn((event.clientX - before[0]) / 120, (event.clientY - before[1]) / 120);
      } else {
        const [a, b] = [...held.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]);
        if (spread > 0) this.bring(now / spread);
        spread = now;
      }
    });
    for (const end of ["pointerup", "pointercancel", "pointerleave"]) {
      canvas.addEventListener(end, event => held.delete(event.pointerId));
    }
    canvas.addEventListener("wheel", event => {
      // Without a key held, the page scrolls.
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.bring(Math.exp(-event.deltaY / 500));
    }, { passive: false });
    canvas.addEventListener("keydown", event => {
      const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
      const nearer = { "+": 1.1, "=": 1.1, "-": 1 / 1.1 };
      if (turns[event.key]) this.turn(...turns[event.key]);
      else if (nearer[event.key]) this.bring(nearer[event.key]);
      else return;
      event.preventDefault();
    });
  }
}

function program(gl, vertex, fragment, attributes, uniforms) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  // Both programs have the same two places for what they read.
  attributes.forEach((name, at) => gl.bindAttribLocation(made, at, name));
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const found = { program: made };
  attributes.forEach((name, at) => { found[name] = at; });
  for (const name of uniforms) found[name] = gl.getUniformLocation(made, name);
  return found;
}

function attribute(gl, location, buffer) {
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(location);
  gl.vertexAttribPointer(location, 3, gl.FLOAT, false, 0, 0);
}

// The normals of triangles, the same for the three corners of each.
function flat(corners) {
  const normals = new Float32Array(corners.length);
  for (let at = 0; at < corners.length; at += 9) {
    const [u, v] = [3, 6].map(from => [0, 1, 2].map(axis => corners[at + from + axis] - corners[at + axis]));
    const across = [0, 1, 2].map(axis => u[(axis + 1) % 3] * v[(axis + 2) % 3] - u[(axis + 2) % 3] * v[(axis + 1) % 3]);
    const length = Math.hypot(...across) || 1;
    for (let corner = 0; corner < 3; corner++) normals.set(across.map(x => x / length), at + 3 * corner);
  }
  return normals;
}

// The surface of a shape as triangles.
function mesh(shape) {
  if (shape.kind === "mesh") return { places: shape.corners, normals: flat(shape.corners) };
  const places = [], normals = [];
  const add = (corners, outward) => {
    for (const at of [0, 1, 2, 0, 2, 3]) {
      places.push(...corners[at]);
      normals.push(...outward[at]);
    }
  };
  if (shape.kind === "box") {
    for (let axis = 0; axis < 3; axis++) {
      for (const side of [-1, 1]) {
        const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([u, v]) => {
          const corner = [];
          [corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]] = [side, u, v];
          return corner.map((x, at) => x * shape.sides[at] / 2);
        });
        const outward = [0, 1, 2].map(at => at === axis ? side : 0);
        add(corners, [outward, outward, outward, outward]);
      }
    }
    return { places, normals };
  }
  // Others are a line turned around z: distance from it, height, and the normal's two numbers.
  const { radius, length } = shape, half = length / 2, lines = [];
  lines.push([[radius, -half, 1, 0], [radius, half, 1, 0]]);
  for (const end of [-1, 1]) {
    if (shape.kind === "cylinder") {
      lines.push([[0, end * half, 0, end], [radius, end * half, 0, end]]);
      continue;
    }
    const arc = Array.from({ length: 9 }, (_, at) => [Math.cos(at * Math.PI / 16), end * Math.sin(at * Math.PI / 16)]);
    const point = ([out, up]) => [radius * out, end * half + radius * up, out, up];
    for (let at = 0; at < 8; at++) lines.push([point(arc[at]), point(arc[at + 1])]);
  }
  const sides = 32;
  for (const [from, to] of lines) {
    for (let side = 0; side < sides; side++) {
      const turned = (out, up, at) => [out * Math.cos(2 * Math.PI * at / sides), out * Math.sin(2 * Math.PI * at / sides), up];
      const around = [[from, side], [from, side + 1], [to, side + 1], [to, side]];
      add(around.map(([line, at]) => turned(line[0], line[1], at)), around.map(([line, at]) => turned(line[2], line[3], at)));
    }
  }
  return { places, normals };
}
