// Read the data of a movement: texts to numbers, poses to matrices, sizes, and the time to begin with.

// The frame at which most is felt, so that the first picture shows something.
function liveliest({ levels, frames, sensors }) {
  const felt = Array.from({ length: frames }, (_, frame) => levels.subarray(frame * sensors, (frame + 1) * sensors).reduce((sum, x) => sum + x, 0));
  return felt.indexOf(Math.max(...felt));
}

// Turns the texts of a scene into numbers.
function unpack(scene) {
  const bytes = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const numbers = ({ scale, data }) => Float32Array.from(new Int16Array(bytes(data).buffer), number => number * scale);
  scene.levels = bytes(scene.touch.data);
  if (scene.map) scene.map = numbers(scene.map);
  for (const name of ["places", "normals", "centres", "turns"]) if (scene.body) scene.body[name] = numbers(scene.body[name]);
  for (const solid of scene.body?.solids ?? []) if (solid.corners) solid.corners = numbers(solid.corners);
}

// The matrix of a solid, by columns, between two poses: turns from a and b, centres from c and d.
function model(turns, a, b, centres, c, d, share) {
  let dot = 0;
  for (let at = 0; at < 4; at++) dot += turns[a + at] * turns[b + at];
  // A quaternion and its opposite are one turn: the shorter way.
  const turn = [0, 1, 2, 3].map(at => (1 - share) * turns[a + at] + share * Math.sign(dot || 1) * turns[b + at]);
  const length = Math.hypot(...turn), [w, x, y, z] = turn.map(number => number / length);
  const centre = [0, 1, 2].map(at => (1 - share) * centres[c + at] + share * centres[d + at]);
  return new Float32Array([
    1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0,
    2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 0,
    2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y), 0,
    ...centre, 1,
  ]);
}

// The radius of a ball around everything that a body comes to fill.
function size({ centres, places }) {
  return spread(centres) + spread(places);
}

function spread(numbers) {
  let most = 1e-9;
  for (let at = 0; at < numbers.length; at += 3) most = Math.max(most, Math.hypot(numbers[at], numbers[at + 1], numbers[at + 2]));
  return most;
}
