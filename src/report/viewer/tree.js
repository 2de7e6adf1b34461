// Draw a tree of parts, each a button that marks its sensors.

function drawTree(title, parts, colours, onPart) {
  const { of, tree } = parts;
  const box = document.createElement("div"), heading = document.createElement("h3");
  heading.textContent = title;
  box.append(heading);
  const sizes = new Map();
  of.filter(part => part !== null).forEach(part => sizes.set(part, (sizes.get(part) ?? 0) + 1));
  const numbers = [...sizes.keys()].sort((a, b) => a - b);
  const near = new Map(numbers.map(part => [part, []]));
  for (const { child, parent, support } of tree) {
    near.get(child).push([parent, support]);
    near.get(parent).push([child, support]);
  }
  const places = layout(numbers, near), values = [...places.values()];
  const across = 84, down = 64, margin = 24;
  const width = across * Math.max(...values.map(([x]) => x)) + 2 * margin;
  const height = down * Math.max(...values.map(([, y]) => y)) + 2 * margin;
  const at = part => places.get(part).map((x, axis) => margin + x * [across, down][axis]);
  const svg = element("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "group", "aria-label": title });
  const drawn = new Set();
  for (const part of numbers) {
    for (const [other, support] of near.get(part)) {
      const key = [part, other].sort((a, b) => a - b).join(" ");
      if (drawn.has(key)) continue;
      drawn.add(key);
      const [[x1, y1], [x2, y2]] = [at(part), at(other)], sure = support ?? 1;
      svg.append(element("line", { x1, y1, x2, y2, "stroke-width": 1 + 3 * sure, "stroke-dasharray": sure < 0.5 ? "4 4" : "none" }));
      if (support === null) continue;
      // Nearer to the lower end, where edges of one part are apart.
      const [upper, lower] = y1 < y2 ? [[x1, y1], [x2, y2]] : [[x2, y2], [x1, y1]];
      const [x, y] = [0, 1].map(axis => 0.45 * upper[axis] + 0.55 * lower[axis]);
      const words = element("text", { x, y: y + 4, class: "edge" });
      words.textContent = `${Math.round(100 * support)} %`;
      svg.append(words);
    }
  }
  const nodes = new Map();
  for (const part of numbers) {
    const [x, y] = at(part), words = `${partName(parts, part)}, ${sizes.get(part)} sensors`;
    const node = element("g", { tabindex: 0, role: "button", "aria-label": words, "aria-pressed": "false" });
    const name = element("text", { x, y: y + 4.5 });
    name.textContent = part;
    const hint = element("title", {});
    hint.textContent = words;
    node.append(hint, element("circle", { cx: x, cy: y, r: 16, stroke: css(partColour(colours.get(part))) }), name);
    node.addEventListener("pointerenter", () => onPart(part, false));
    node.addEventListener("pointerleave", () => onPart(null, false));
    node.addEventListener("click", () => onPart(part, true));
    node.addEventListener("keydown", event => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      onPart(part, true);
    });
    nodes.set(part, node);
    svg.append(node);
  }
  box.append(svg);
  return { box, mark: part => nodes.forEach((node, own) => node.setAttribute("aria-pressed", own === part)) };
}

// What a part is called: its number, and its name if it has one.
function partName({ names }, part) {
  const name = names?.[part];
  return name === undefined ? `part ${part}` : `part ${part} (${name})`;
}

// Column and row of each part: leaves side by side, each other part above the middle of those below it. The part with
// most edges is on top; parts that no edge reaches have trees of their own.
function layout(parts, near) {
  const places = new Map(), seen = new Set();
  let next = 0;
  const place = (part, row) => {
    seen.add(part);
    const below = near.get(part).map(([other]) => other).filter(other => !seen.has(other));
    const columns = below.map(other => place(other, row + 1));
    const column = columns.length ? (columns[0] + columns[columns.length - 1]) / 2 : next++;
    places.set(part, [column, row]);
    return column;
  };
  const roots = [...parts].sort((a, b) => near.get(b).length - near.get(a).length);
  for (const root of roots) if (!seen.has(root)) place(root, 0);
  return places;
}

function element(name, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}
