// Colours of pressures and parts, as red, green and blue from 0 to 1.

// Okabe and Ito's colours, which the colour-blind tell apart, as in the figures.
const PALETTE = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#1a1a1a"].map(rgb);
const NO_PART = rgb("#bbbbbb");
// From no pressure to the greatest: each is darker than the one before.
const RAMP = ["#d4d4d4", "#f5c24c", "#e07b1a", "#a8283c", "#3d0f45"].map(rgb);

function rgb(text) {
  return [1, 3, 5].map(at => parseInt(text.slice(at, at + 2), 16) / 255);
}

function css(colour) {
  return `rgb(${colour.map(x => Math.round(255 * x)).join(" ")})`;
}

function mix(a, b, share) {
  return a.map((x, at) => x + share * (b[at] - x));
}

// The colour of series number `at`; after those of the palette, paler and darker ones in turns.
function partColour(at) {
  if (at < 0) return NO_PART;
  const round = Math.floor(at / PALETTE.length);
  const share = round === 0 ? 0 : Math.min(0.4 + 0.15 * Math.floor((round - 1) / 2), 0.75);
  return mix(PALETTE[at % PALETTE.length], round % 2 ? [1, 1, 1] : [0, 0, 0], share);
}

// The colour of a level, 0 to 255.
const LEVELS = Array.from({ length: 256 }, (_, level) => {
  const at = level / 255 * (RAMP.length - 1), below = Math.min(Math.floor(at), RAMP.length - 2);
  return mix(RAMP[below], RAMP[below + 1], at - below);
});

// The number of a colour for each part: an estimated part has that of the true part that most of its sensors are on, if no
// larger one has it.
function coloursOf(parts, truth) {
  const names = of => [...new Set(of.filter(part => part !== null))].sort((a, b) => a - b);
  const colours = new Map();
  if (!truth) {
    names(parts).forEach((part, at) => colours.set(part, at));
    return colours;
  }
  const own = coloursOf(truth), pairs = new Map();
  parts.forEach((part, sensor) => {
    if (part === null || truth[sensor] === null) return;
    const key = part + " " + truth[sensor];
    pairs.set(key, (pairs.get(key) ?? 0) + 1);
  });
  const taken = new Set();
  for (const [key] of [...pairs].sort((a, b) => b[1] - a[1])) {
    const [part, other] = key.split(" ").map(Number);
    if (colours.has(part) || taken.has(own.get(other))) continue;
    colours.set(part, own.get(other));
    taken.add(own.get(other));
  }
  let next = own.size;
  for (const part of names(parts)) if (!colours.has(part)) colours.set(part, next++);
  return colours;
}
