// Show one movement after the other: the body, its touch, its map and its trees, linked by what the reader points at.

const still = window.matchMedia("(prefers-reduced-motion: reduce)");

class Viewer {
  constructor(section) {
    this.section = section;
    this.find = selector => section.querySelector(selector);
    this.scenes = JSON.parse(this.find("script.data").textContent);
    [this.frame, this.marked, this.pointed, this.part, this.pointedPart] = [0, null, null, null, null];
    this.playing = false;
    this.#controls();
    this.#show(0);
    this.seek(liveliest(this.scene));
    // Motion begins by itself only for those who do not mind, and only where it is seen.
    if (!still.matches) {
      new IntersectionObserver((entries, observer) => {
        if (!entries.some(entry => entry.isIntersecting)) return;
        observer.disconnect();
        this.play(true);
      }).observe(section);
    }
    new ResizeObserver(() => this.draw()).observe(section);
  }

  // Goes to a frame, which may lie between two.
  seek(frame) {
    this.frame = Math.min(Math.max(frame, 0), this.scene.frames - 1);
    this.draw();
  }

  // Marks a sensor, or none.
  mark(sensor) {
    [this.marked, this.part] = [sensor, null];
    this.find(".sensor input").value = sensor ?? "";
    this.draw();
  }

  play(playing) {
    // One time cannot move.
    this.playing = playing &&= this.scene.frames > 1;
    const button = this.find(".play");
    button.textContent = playing ? "Pause" : "Play";
    if (!playing) {
      for (const space of this.spaces) space.detail = 1;
      this.draw();
    }
    let last = null, drawn = 0, since = 0;
    const tick = now => {
      if (!this.playing) return;
      if (!this.section.isConnected) return;
      const passed = last === null ? 0 : Math.min((now - last) / 1000, 0.2);
      last = now;
      // Samples of unknown length pass twenty a second, and none is shown for longer than half a second.
      const frames = passed * (this.scene.unit === "s" ? Math.max(1 / this.scene.step, 2) : 20);
      this.frame = (this.frame + frames) % Math.max(this.scene.frames - 1, 1);
      if (this.map && !still.matches && !this.turned) this.map.yaw += 0.15 * passed;
      this.draw();
      drawn += 1;
      if (now - since > 1000) {
        if (since > 0) this.pace(1000 * drawn / (now - since));
        [drawn, since] = [0, now];
      }
      requestAnimationFrame(tick);
    };
    if (playing) requestAnimationFrame(tick);
  }

  // Where fewer than 24 frames a second are drawn, each gets fewer pixels, until the body stands still.
  pace(framesPerSecond) {
    if (framesPerSecond < 24) for (const space of this.spaces) space.detail = Math.max(0.7 * space.detail, 0.4);
  }

  get spaces() {
    return [this.body, this.map].filter(space => space);
  }

  draw() {
    const { scene, frame } = this;
    const now = Math.round(frame), colours = this.#colours(now), marked = this.pointed ?? this.marked;
    if (this.body) {
      const { places, models } = this.pose(frame);
      this.body.draw(places, colours, this.body.radius / 48, marked, models, this.solidColours);
    }
    if (this.map) this.map.draw(this.mapPlaces, colours, this.map.radius / 36, this.known(marked) ? marked : null);
    if (this.raster) this.#drawRaster(marked);
    const slider = this.find(".time input"), time = this.clock(frame);
    slider.value = frame;
    slider.setAttribute("aria-valuetext", time);
    this.find(".clock").textContent = time;
    this.#say(marked, now);
    for (const { tree, of } of this.trees) tree.mark(this.chosen?.of === of ? this.chosen.part : marked === null ? null : of[marked]);
  }

  // The part whose sensors stand out, and the parts that it is of.
  get chosen() {
    return this.pointedPart ?? this.part;
  }

  clock(frame) {
    const { start, step, times, unit } = this.scene, time = times ? times[Math.round(frame)] : start + frame * step;
    return unit === "s" ? `${time.toFixed(1)} s` : `sample ${Math.round(time)}`;
  }

  level(sensor, frame) {
    return this.scene.levels[frame * this.scene.sensors + sensor];
  }

  // Whether a sensor has a place on the map.
  known(sensor) {
    const map = this.scene.map;
    return sensor !== null && map !== null && [0, 1, 2].some(axis => map[3 * sensor + axis] !== 0);
  }

  // Places and normals of the sensors, and matrices of the solids, at a time between two frames.
  pose(frame) {
    const { centres, turns, solids, solid, places, normals } = this.scene.body;
    const before = Math.min(Math.floor(frame), this.scene.frames - 1), after = Math.min(before + 1, this.scene.frames - 1);
    const models = solids.map((_, at) => {
      const [a, b] = [before, after].map(time => 4 * (time * solids.length + at));
      const [c, d] = [before, after].map(time => 3 * (time * solids.length + at));
      return model(turns, a, b, centres, c, d, frame - before);
    });
    const moved = this.moved ??= { places: new Float32Array(places.length), normals: new Float32Array(places.length) };
    for (let at = 0; at < solid.length; at++) {
      const m = models[solid[at]], lift = 0.004 * this.body.radius;
      for (let row = 0; row < 3; row++) {
        let [place, normal] = [m[12 + row], 0];
        for (let axis = 0; axis < 3; axis++) {
          place += m[4 * axis + row] * places[3 * at + axis];
          normal += m[4 * axis + row] * normals[3 * at + axis];
        }
        // A little above the surface, so that this does not hide it.
        moved.places[3 * at + row] = place + lift * normal;
        moved.normals[3 * at + row] = normal;
      }
    }
    return { places: moved.places, models };
  }

  #colours(frame) {
    const { sensors } = this.scene, { chosen, colouring } = this;
    const colours = this.colourNumbers ??= new Float32Array(3 * sensors);
    for (let at = 0; at < sensors; at++) {
      let colour = LEVELS[this.level(at, frame)];
      if (colouring !== "pressure") {
        const part = this.scene[colouring].of[at];
        colour = partColour(part === null ? -1 : this.partColours[colouring].get(part));
      }
      if (chosen && chosen.of[at] !== chosen.part) colour = mix(colour, [1, 1, 1], 0.8);
      colours.set(colour, 3 * at);
    }
    return colours;
  }

  // Shows a movement.
  #show(at) {
    const scene = this.scene = this.scenes[at], frames = scene.frames;
    if (!scene.levels) unpack(scene);
    [this.moved, this.colourNumbers] = [null, null];
    const own = (kind, has) => {
      const panel = this.find(`.panel.${kind}`);
      panel.hidden = !has;
      return has;
    };
    this.body = this.map = this.raster = null;
    try {
      if (scene.body) {
        this.body = this.bodySpace ??= this.#space(".panel.body canvas", size(scene.body), (at, eye) => this.#faces(at, eye));
        this.body.radius = size(scene.body);
        this.body.setSolids(scene.body.solids);
        this.solidColours = scene.body.solids.map(() => [0.93, 0.93, 0.93]);
      }
      if (scene.map) {
        this.map = this.mapSpace ??= this.#space(".panel.map canvas", 1, at => this.known(at));
        this.map.radius = spread(scene.map);
        // A sensor without a place is put where nobody looks.
        this.mapPlaces = scene.map.map((number, at) => this.known(Math.floor(at / 3)) ? number : 1e6 * this.map.radius);
      }
    } catch {
      [this.body, this.map] = [null, null];
      this.find(".webgl").hidden = false;
    }
    own("body", this.body !== null);
    own("map", this.map !== null);
    if (own("raster", this.body === null)) this.#raster();
    this.partColours = {
      truth: scene.truth && coloursOf(scene.truth.of),
      estimate: scene.estimate && coloursOf(scene.estimate.of, scene.truth?.of),
    };
    const box = this.find(".trees");
    box.replaceChildren();
    this.trees = [];
    for (const [kind, title] of [["estimate", "Estimated tree"], ["truth", "True tree"]]) {
      const parts = scene[kind];
      if (!parts || parts.of.every(part => part === null)) continue;
      const onPart = (part, keep) => {
        const chosen = part === null ? null : { of: parts.of, names: parts.names, part };
        if (!keep) this.pointedPart = chosen;
        else this.part = this.part?.of === parts.of && this.part.part === part ? null : chosen;
        this.draw();
      };
      const tree = drawTree(title, parts, this.partColours[kind], onPart);
      box.append(tree.box);
      this.trees.push({ tree, of: parts.of });
    }
    box.hidden = this.trees.length === 0;
    const choices = [["pressure", "pressure"], ["truth", "true part"], ["estimate", "estimated part"]].filter(([kind]) => kind === "pressure" ? !scene.still : scene[kind]);
    const select = this.find(".colouring select");
    select.replaceChildren(...choices.map(([kind, words]) => new Option(words, kind)));
    this.colouring = choices.some(([kind]) => kind === this.colouring) ? this.colouring : choices[0][0];
    select.value = this.colouring;
    this.#legend();
    const slider = this.find(".time input");
    slider.max = frames - 1;
    this.find(".play").disabled = frames < 2;
    for (const name of [".play", ".time", ".clock"]) this.find(name).hidden = scene.still;
    this.find(".sensor input").max = scene.sensors - 1;
    this.seek(this.frame);
  }

  #space(selector, radius, faces) {
    const canvas = this.find(selector);
    const space = new Space(canvas, radius, () => {
      this.turned ||= canvas === this.mapSpace?.canvas;
      this.draw();
    });
    const at = (event, reach) => {
      const box = canvas.getBoundingClientRect();
      return space.pick(event.clientX - box.left, event.clientY - box.top, reach, faces);
    };
    let pressed = null;
    canvas.addEventListener("pointerdown", event => { pressed = [event.clientX, event.clientY]; });
    canvas.addEventListener("pointermove", event => {
      if (event.buttons || event.pointerType === "touch") return;
      this.#point(at(event, 12));
    });
    canvas.addEventListener("pointerleave", () => this.#point(null));
    canvas.addEventListener("pointerup", event => {
      // Else it was a turn.
      const tapped = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 6;
      if (tapped) this.mark(at(event, event.pointerType === "touch" ? 24 : 12));
    });
    return space;
  }

  #point(sensor) {
    if (sensor === this.pointed) return;
    this.pointed = sensor;
    this.draw();
  }

  // Whether a sensor is on the side of the body that the reader sees.
  #faces(at, eye) {
    const normals = this.moved.normals;
    return [0, 1, 2].reduce((sum, axis) => sum + eye[axis] * normals[3 * at + axis], 0) > 0;
  }

  // Draws what each sensor feels over time, once; a row is a sensor, ordered by part.
  #raster() {
    const { scene } = this, parts = (scene.estimate ?? scene.truth)?.of;
    const rank = sensor => parts?.[sensor] ?? Infinity;
    this.order = Array.from({ length: scene.sensors }, (_, at) => at).sort((a, b) => rank(a) - rank(b) || a - b);
    const image = new ImageData(scene.frames, scene.sensors);
    this.order.forEach((sensor, row) => {
      for (let frame = 0; frame < scene.frames; frame++) {
        image.data.set([...LEVELS[this.level(sensor, frame)].map(x => 255 * x), 255], 4 * (row * scene.frames + frame));
      }
    });
    const [shown, canvas] = [document.createElement("canvas"), this.find(".raster canvas")];
    [shown.width, shown.height] = [scene.frames, scene.sensors];
    shown.getContext("2d").putImageData(image, 0, 0);
    this.raster = { canvas, shown };
    if (this.rasterListens) return;
    this.rasterListens = true;
    canvas.addEventListener("click", event => {
      const box = canvas.getBoundingClientRect();
      const share = (x, length, most) => Math.min(Math.floor(x / length * most), most - 1);
      this.frame = share(event.clientX - box.left, box.width, this.scene.frames);
      this.mark(this.order[share(event.clientY - box.top, box.height, this.scene.sensors)]);
    });
    canvas.addEventListener("keydown", event => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (!step) return;
      event.preventDefault();
      const row = this.marked === null ? 0 : this.order.indexOf(this.marked) + step[1];
      this.frame = Math.min(Math.max(Math.round(this.frame) + step[0], 0), this.scene.frames - 1);
      this.mark(this.order[Math.min(Math.max(row, 0), this.scene.sensors - 1)]);
    });
  }

  #drawRaster(marked) {
    const { canvas, shown } = this.raster, context = canvas.getContext("2d");
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    if (width === 0) return;
    context.imageSmoothingEnabled = false;
    context.drawImage(shown, 0, 0, width, height);
    const line = (x, y, wide, high) => {
      context.fillStyle = "#fff";
      context.fillRect(x - 1, y - 1, wide + 2, high + 2);
      context.fillStyle = "#000";
      context.fillRect(x, y, wide, high);
    };
    line((this.frame + 0.5) / this.scene.frames * width, 0, 1, height);
    if (marked !== null) line(0, (this.order.indexOf(marked) + 0.5) / this.scene.sensors * height, width, 1);
  }

  // Says in words what is marked. Each frame anew would be too much for who listens.
  #say(marked, frame) {
    let words = "Point at a sensor, or at a part of a tree.";
    if (marked !== null) {
      const { truth, estimate, touch } = this.scene;
      const part = (name, parts) => parts ? `, ${name} ${partName(parts, parts.of[marked] ?? "none")}` : "";
      const share = this.level(marked, frame) / 255;
      const most = this.level(marked, frame) === 255 ? "at least " : "";
      const felt = this.playing || this.scene.still ? "" : `, feels ${most}${Number((share * share * touch.greatest).toPrecision(2))}${this.scene.body ? " Pa" : ""}`;
      words = `Sensor ${marked}${part("true", truth)}${part("estimated", estimate)}${felt}`;
    } else if (this.chosen) {
      const name = partName(this.chosen, this.chosen.part);
      words = `P${name.slice(1)}: ${this.chosen.of.filter(part => part === this.chosen.part).length} sensors`;
    }
    const status = this.find(".status");
    if (status.textContent !== words) status.textContent = words;
  }

  #legend() {
    const box = this.find(".scale"), { colouring, scene } = this;
    const key = (colour, words) => {
      const [item, mark] = [document.createElement("span"), document.createElement("span")];
      mark.className = "key";
      mark.style.background = css(colour);
      item.append(mark, ` ${words}`);
      return item;
    };
    if (colouring === "pressure") {
      const ramp = document.createElement("span");
      ramp.className = "ramp";
      ramp.style.background = `linear-gradient(to right, ${RAMP.map(css).join(", ")})`;
      const unit = scene.body ? " Pa" : "";
      box.replaceChildren("Pressure (square-root scale): 0 ", ramp, ` ${Number(scene.touch.greatest.toPrecision(2))}${unit} or more`);
      return;
    }
    const colours = [...this.partColours[colouring]].sort((a, b) => a[0] - b[0]);
    box.replaceChildren(...colours.map(([part, at]) => key(partColour(at), partName(scene[colouring], part))));
    if (scene[colouring].of.includes(null)) box.append(key(NO_PART, "no part"));
  }

  #controls() {
    this.find(".play").addEventListener("click", () => this.play(!this.playing));
    this.find(".time input").addEventListener("input", event => this.seek(Number(event.target.value)));
    this.find(".time input").addEventListener("keydown", event => {
      const step = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
      if (!step) return;
      event.preventDefault();
      this.seek(Math.round(this.frame) + step);
    });
    this.find(".scenes select").addEventListener("change", event => this.#show(Number(event.target.value)));
    this.find(".colouring select").addEventListener("change", event => {
      this.colouring = event.target.value;
      this.#legend();
      this.draw();
    });
    this.find(".sensor input").addEventListener("input", event => {
      const sensor = Math.round(Number(event.target.value));
      const known = event.target.value !== "" && sensor >= 0 && sensor < this.scene.sensors;
      [this.marked, this.part] = [known ? sensor : null, null];
      this.draw();
    });
  }
}

for (const section of document.querySelectorAll("section.viewer")) section.viewer = new Viewer(section);
