// SPDX-License-Identifier: MIT
// The scenes of presets.h and the disturbances of disturbances.h in JavaScript, with springstep/scenes. Results are
// bit-identical to spring-scene; tests/js and tools/live --test check this.

/** The defaults of each scene, as in presets.c; null: the scene has no such parameter. */
const defaults = {
    rope: {
        size: 20,
        axes: 2,
        length: 2,
        mass: 0.05,
        endMass: 0.05,
        stiffness: 2000,
        drag: 0.01,
        gravity: 9.81,
    },
    cloth: { size: 25, axes: 3, length: 2, mass: 0.01, stiffness: 500, drag: 0.01, gravity: 9.81 },
    jelly: { size: 8, axes: 3, length: 0.7, mass: 0.01, stiffness: 40, drag: 0.005, gravity: 9.81 },
    chain: { size: 50, axes: 1, length: 5, mass: 0.1, stiffness: 100, drag: 0, gravity: 0 },
    water: { size: 25, axes: 1, length: 4, mass: 1, stiffness: 25000, drag: 0.5, gravity: 0 },
};

export const presetNames = Object.keys(defaults);

const given = (values) =>
    Object.fromEntries(Object.entries(values).filter(([, value]) => value !== undefined));

/** {scene, size, damping, drag, mass, endMass, stiffness}: all except the scene are optional. */
export function chosen(settings) {
    if (!Object.hasOwn(defaults, settings.scene)) throw new RangeError(`no scene "${settings.scene}"`);
    const usual = { damping: 0, ...defaults[settings.scene] };
    const all = { ...usual, ...given(settings) };
    if (settings.scene === "rope") all.endMass = settings.endMass ?? settings.mass ?? usual.endMass;
    return all;
}

/** [definition for Scene, particles along x y z, positions at the start as x y z with z up, settings] of a scene. */
export function preset(grid, settings) {
    const all = chosen(settings);
    const { scene, size: n, axes, length, mass, stiffness, damping, drag, gravity } = all;
    const families = ["structural", "shear", "bend"];
    const spacing = scene === "chain" ? length / (n + 1) : length / (n - 1);
    const common = { axes, spacing, stiffness, damping };
    const made = grid(
        {
            rope: () => ({ ...common, count: [n], pinned: ["firstX"] }),
            cloth: () => ({ ...common, count: [n, n], families }),
            jelly: () => ({ ...common, count: [n, n, n], families, pinned: ["firstZ"] }),
            chain: () => ({ ...common, count: [n + 2], pinned: ["firstX", "lastX"] }),
            water: () => ({
                ...common,
                count: [n, n],
                height: true,
                families,
                pinned: ["firstX", "lastX", "firstY", "lastY"],
            }),
        }[scene](),
    );
    const count = {
        rope: [n, 1, 1],
        cloth: [n, n, 1],
        jelly: [n, n, n],
        chain: [n + 2, 1, 1],
        water: [n, n, 1],
    }[scene];
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
