// SPDX-License-Identifier: MIT
// The library as WebAssembly compared with a plain JavaScript loop over links in typed arrays.
//
// usage: node bench.mjs cloth|water FLAGS MODULE.wasm [--quick]       (called by tools/bench/wasm/run)
//
// Prints one row per process, because V8's type feedback from another scene makes plain functions slower.
import {readFileSync} from 'node:fs';

const MASS = 0.1, GRAVITY = -9.81, STEPS = 16; // [kg], [m/s^2], steps per call
const SIDE = 35;

async function load(path) {
    const module = await WebAssembly.compile(readFileSync(path));
    const imports = {}; // libc functions for printing and exiting, never called
    for (const {module: from, name} of WebAssembly.Module.imports(module))
        (imports[from] ??= {})[name] = () => { throw new Error(name); };
    const {exports} = await WebAssembly.instantiate(module, imports);
    exports._initialize?.();
    return exports;
}

// Functions with array arguments. Methods that read the arrays from an object take more than twice as long.
function forceCloth(links, a, b, rest, stiffness, x, f) {
    f.fill(0);
    for (let l = 0; l < links; l++) {
        const i = 3 * a[l], j = 3 * b[l];
        const dx = x[j] - x[i], dy = x[j + 1] - x[i + 1], dz = x[j + 2] - x[i + 2];
        const length = Math.sqrt(dx * dx + dy * dy + dz * dz);
        const pull = stiffness[l] * (length - rest[l]) / length;
        const fx = pull * dx, fy = pull * dy, fz = pull * dz;
        f[i] += fx;
        f[i + 1] += fy;
        f[i + 2] += fz;
        f[j] -= fx;
        f[j + 1] -= fy;
        f[j + 2] -= fz;
    }
}

function forceWater(links, a, b, rest, stiffness, x, f) {
    f.fill(0);
    for (let l = 0; l < links; l++) {
        const i = a[l], j = b[l];
        const pull = stiffness[l] * (x[j] - x[i] - rest[l]);
        f[i] += pull;
        f[j] -= pull;
    }
}

function kickCloth(h, inverseMass, f, v) {
    for (let i = 0, j = 0; i < inverseMass.length; i++, j += 3) {
        const w = inverseMass[i], g = w === 0 ? 0 : GRAVITY;
        v[j] += h * f[j] * w;
        v[j + 1] += h * (f[j + 1] * w + g);
        v[j + 2] += h * f[j + 2] * w;
    }
}

function kickWater(h, inverseMass, f, v) {
    for (let i = 0; i < inverseMass.length; i++) {
        const w = inverseMass[i];
        v[i] += h * (f[i] * w + (w === 0 ? 0 : GRAVITY));
    }
}

function drift(dt, v, x) {
    for (let i = 0; i < x.length; i++)
        x[i] += dt * v[i];
}

// The scene of a module in plain JavaScript: its positions, and a function that advances them.
function plainScene(c, water) {
    const particles = c.particles(), links = c.links(), size = (water ? 1 : 3) * particles;
    const x = new Float64Array(c.memory.buffer, c.positions(), size).slice();
    const v = new Float64Array(size), f = new Float64Array(size);
    const pinned = new Uint8Array(c.memory.buffer, c.pins(), particles);
    const inverseMass = Float64Array.from(pinned, (is) => is ? 0 : 1 / MASS);
    const a = Int32Array.from({length: links}, (_, l) => c.link_end(l, 0));
    const b = Int32Array.from({length: links}, (_, l) => c.link_end(l, 1));
    const rest = Float64Array.from({length: links}, (_, l) => c.link_rest(l));
    const stiffness = Float64Array.from({length: links}, (_, l) => c.link_stiffness(l));
    const force = water ? forceWater : forceCloth, kick = water ? kickWater : kickCloth;
    force(links, a, b, rest, stiffness, x, f);
    const advance = (dt, steps) => {
        for (let s = 0; s < steps; s++) {
            kick(dt / 2, inverseMass, f, v);
            drift(dt, v, x);
            force(links, a, b, rest, stiffness, x, f);
            kick(dt / 2, inverseMass, f, v);
        }
    };
    return {x, links, advance};
}

// Nanoseconds per link and step, the minimum of several runs, alternating between both.
function times(both, links, runs, calls) {
    const least = both.map(() => Infinity);
    for (let r = 0; r < runs; r++)
        both.forEach((advance, i) => {
            const start = process.hrtime.bigint();
            for (let c = 0; c < calls; c++)
                advance(STEPS);
            least[i] = Math.min(least[i], Number(process.hrtime.bigint() - start) / (calls * STEPS * links));
        });
    return least;
}

// The largest difference of positions [m]. It is due to the order of sums, and grows with the square of the steps.
function difference(c, plain) {
    const ours = new Float64Array(c.memory.buffer, c.state(), plain.x.length);
    return plain.x.reduce((most, x, i) => Math.abs(x - ours[i]) <= most ? most : Math.abs(x - ours[i]), 0);
}

const [scene, flags, path, quick] = process.argv.slice(2);
const water = scene === 'water', c = await load(path);
if (!c.make(SIDE, water, MASS, GRAVITY))
    throw new Error('no scene');
const plain = plainScene(c, water), dt = c.stable_step() / 4;
const ours = (steps) => {
    if (!c.advance(dt, steps))
        throw new Error('the scene did not advance');
};
const theirs = (steps) => plain.advance(dt, steps);
const compared = 160, longest = 3.5; // steps; [m], largest of all positions
ours(compared);
theirs(compared);
const off = difference(c, plain), bound = compared ** 2 * longest * Number.EPSILON;
if (!(off <= bound))
    throw new Error(`positions differ by ${off} m, more than ${bound}`);
const [ns, plainNs] = times([ours, theirs], plain.links, quick ? 2 : 30, quick ? 1 : 40);
console.log([scene, SIDE, flags, ns, plainNs, plainNs / ns, off].join('\t'));
