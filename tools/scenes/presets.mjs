// SPDX-License-Identifier: MIT
// The scenes of presets.h and the disturbances of disturbances.h in JavaScript, with springstep/scenes. Results are
// bit-identical to spring-scene; tests/js and tools/live --test check this.

const usual = new Map(); // defaults of each scene; undefined: the scene has no such parameter
const fields = [
    "kind",
    "size",
    "axes",
    "families",
    "length",
    "mass",
    "endMass",
    "stiffness",
    "damping",
    "drag",
    "gravity",
];
const shapes = new Map(); // { dimensions, ends, pinned } of each scene

/** Reads the tables in the text of presets.c, which has to come first. Returns the names of the scenes. */
export function readPresets(source) {
    for (const [, kind, row] of source.matchAll(/ \[PRESET_(\w+)\] = \{(.*)\},/g)) {
        const scene = kind.toLowerCase();
        const words = row.split(", ");
        if (words.length > fields.length) {
            const numbers = fields.map((field, i) => [field, Number(words[i])]);
            const all = Object.fromEntries(numbers.filter(([, number]) => !Number.isNaN(number)));
            all.families = words[3] === "all_families" ? ["structural", "shear", "bend"] : ["structural"];
            usual.set(scene, all);
        } else {
            const faces = Array.from(
                row.matchAll(/(FIRST|LAST)_(.)/g),
                ([, end, axis]) => end.toLowerCase() + axis,
            );
            shapes.set(scene, { dimensions: Number(words[0]), ends: Number(words[1]), pinned: faces });
        }
    }
    if (usual.size === 0 || usual.size !== shapes.size)
        throw new Error("presets.c has no tables of this form");
    return [...usual.keys()];
}

/** [definition for Scene, particles along x y z, positions at the start as x y z with z up, settings] of a scene. Settings
    are {scene, size, damping, drag, mass, endMass, stiffness}; all except the scene are optional. */
export function preset(grid, settings) {
    if (!usual.has(settings.scene)) throw new RangeError(`no scene "${settings.scene}"`);
    const all = { ...usual.get(settings.scene) };
    for (const [name, value] of Object.entries(settings)) if (value !== undefined) all[name] = value;
    if (settings.scene === "rope") all.endMass = settings.endMass ?? settings.mass ?? all.endMass;
    const { scene, axes, length, families, mass, stiffness, damping, drag, gravity = 0 } = all;
    const { dimensions, ends, pinned } = shapes.get(scene);
    const n = all.size + ends;
    const spacing = length / (n - 1);
    const count = Array.from({ length: 3 }, (_, i) => (i < dimensions ? n : 1));
    const height = scene === "water";
    const made = grid({ axes, count, spacing, families, stiffness, damping, pinned, height });
    const start = new Float64Array(3 * count[0] * count[1] * count[2]);
    for (let k = 0, at = 0; k < count[2]; k++)
        for (let j = 0; j < count[1]; j++)
            for (let i = 0; i < count[0]; i++, at += 3)
                start.set([i * spacing, j * spacing, k * spacing], at);
    if (scene === "cloth") made.pinned[0] = made.pinned[n - 1] = 1;
    const end = count[0] - 1;
    for (let i = 0; scene === "chain" && i <= end; i++) {
        const aside = (spacing * (2 * i < end ? i : end - i)) / end;
        made.position[i] += aside;
        start[3 * i] += aside;
    }
    const down = [0, 0, 0];
    down[axes - 1] = -gravity;
    const masses = () => Array.from({ length: n }, (_, i) => (i < n - 1 ? mass : all.endMass));
    const definition = {
        ...made,
        mass: scene === "rope" && all.endMass !== mass ? masses() : mass,
        gravity: down,
        drag,
    };
    return { definition, count, start, settings: all };
}

export const pushDuration = 0.02; // [s]

export const peakOf = (momentum, duration = pushDuration) => momentum / ((128 / 315) * duration);

/** Round pushes on a preset, downwards along its last axis. */
export class Pushes {
    #preset;
    #list = []; // sorted by start

    constructor(preset) {
        this.#preset = preset;
    }

    /** Adds the default poke of height-field water at the start. */
    pokeWater() {
        const { start, settings } = this.#preset;
        const [x, y] = [start.at(-3) / 2, start.at(-2) / 2];
        this.add({ start: 0, x, y, peak: 1e5, area: (settings.length * settings.length) / 64 });
    }

    /** {start [s], x, y [m], peak [N], area [m^2], duration [s]} */
    add(push) {
        const { start, definition } = this.#preset;
        const { x, y, area } = push;
        const shares = [];
        let sum = 0;
        let least = Infinity;
        let nearest = 0;
        for (let i = 0; i < definition.pinned.length; i++) {
            if (definition.pinned[i]) continue;
            const dx = start[3 * i] - x;
            const dy = start[3 * i + 1] - y;
            const relative = ((dx * dx + dy * dy) * Math.PI) / area;
            const weight = relative < 1 ? (1 - relative) * (1 - relative) : 0;
            if (dx * dx + dy * dy < least) [least, nearest] = [dx * dx + dy * dy, i];
            if (weight > 0) shares.push([i, weight]);
            sum += weight;
        }
        if (shares.length === 0 && least < Infinity) {
            shares.push([nearest, 1]);
            sum = 1;
        }
        const particles = Uint32Array.from(shares, ([i]) => i);
        const parts = Float64Array.from(shares, ([, weight]) => weight / sum);
        let at = this.#list.length;
        while (at > 0 && this.#list[at - 1].start > push.start) at--;
        this.#list.splice(at, 0, { duration: pushDuration, ...push, particles, parts });
    }

    get any() {
        return this.#list.length > 0;
    }

    /** Empties the list if all pushes have ended. */
    forget(t) {
        if (this.#list.every((push) => push.start + push.duration <= t)) this.#list = [];
    }

    /** The callback of a scene. */
    force = (t, position, force) => {
        const down = force.at(-1);
        for (const { start, duration, peak, particles, parts } of this.#list) {
            if (start >= t) break;
            if (start + duration <= t) continue;
            const u = (t - start) / duration;
            const s = 4 * u * (1 - u);
            const strength = peak * (s * s) * (s * s);
            for (let k = 0; k < particles.length; k++) down[particles[k]] -= strength * parts[k];
        }
    };
}

/** FNV-1a over positions and velocities, as spring-scene --hash prints it. */
export function hashOf(scene) {
    let high = 0xcbf29ce4;
    let low = 0x84222325;
    for (const quantity of ["position", "velocity"])
        for (const byte of new Uint8Array(scene.get(quantity).buffer)) {
            low = (low ^ byte) >>> 0;
            // times 0x100000001b3 = 2^40 + 0x1b3
            const product = low * 0x1b3;
            high = (high * 0x1b3 + Math.floor(product / 2 ** 32) + low * 256) % 2 ** 32;
            low = product >>> 0;
        }
    return [high, low].map((word) => word.toString(16).padStart(8, "0")).join("");
}

/** Takes steps while positions, velocities and the energy are finite; returns the number of steps taken. */
export function takeSteps(scene, method, dt, steps) {
    const take = (n) => {
        const saved = scene.snapshot();
        try {
            scene.advance(method, dt, n);
            if (Number.isFinite(scene.energy.total)) return true;
        } catch (error) {
            if (!error.code) throw error;
        }
        scene.restore(saved);
        return false;
    };
    if (take(steps)) return steps;
    let taken = 0;
    while (taken < steps && take(1)) taken++;
    return taken;
}
