// SPDX-License-Identifier: MIT
// Many values with the same parameters, each with its own target: spring_batch_follow() without a load.
import { check, checkFinite, isNumber, settings, sizeOf } from "./options.js";
import { epsilon, leastNormal } from "./elementary.js";
import { lands } from "./propagator.js";

const { abs } = Math;

export class Springs {
    #settings;
    #targets; // of the last step
    #sizes; // of the motions to these targets

    constructor(count, options = {}) {
        check(Number.isSafeInteger(count) && count >= 0, "count", "an integer >= 0", count);
        this.#settings = settings(options, []);
        this.target = new Float64Array(count);
        this.value = new Float64Array(count);
        this.velocity = new Float64Array(count);
        this.#targets = new Float64Array(count);
        this.#sizes = new Float64Array(count);
        if (new.target === Springs) Object.seal(this);
    }

    /** A motion begins at a new target, and at a value on its target. Returns the largest tolerance of a distance. */
    #measure() {
        const { target, value, velocity } = this;
        const { p, restDelta, restSpeed } = this.#settings;
        if (restDelta >= 0 && restSpeed >= 0) return restDelta;
        const targets = this.#targets;
        const sizes = this.#sizes;
        let largest = 0;
        for (let i = 0; i < value.length; i++) {
            const goal = target[i];
            if (goal !== targets[i] || (goal === value[i] && velocity[i] !== 0)) {
                targets[i] = goal;
                sizes[i] = sizeOf(p, goal - value[i], velocity[i]);
            }
            if (sizes[i] > largest) largest = sizes[i];
        }
        return restDelta ?? largest / 1e4;
    }

    step(dt) {
        checkFinite("dt", dt);
        const { target, value, velocity } = this;
        const count = value.length;
        const { p, near } = this.#settings;
        const mostDelta = this.#measure();
        const sizes = this.#sizes;
        if (dt === 0) return value.filter((x, i) => !near(abs(x - target[i]), velocity[i], sizes[i])).length;
        p.prepare(dt);
        const { half, F, G, H, wH, fraction, omega2 } = p;
        const attracts = omega2 > 0;
        const origin = attracts ? target : new Float64Array(count); // without stiffness a target has no effect
        // A spring with |y| > slope |target| + least neither lands nor settles: see follow_limit in src/kernels.
        const slope = (4 * epsilon) / (fraction || 1);
        const least = attracts ? (slope / epsilon) * leastNormal + 2 * mostDelta : Infinity;
        let resting = 0;
        let failed = -1;
        for (let i = 0; i < count; i++) {
            const to = origin[i];
            const v0 = velocity[i];
            const y0 = value[i] - to;
            const y = half * (F * y0 + H * v0);
            const v = half * (G * v0 - wH * y0);
            const x = to + y;
            if (!(abs(y) > slope * abs(to) + least && abs(x + v) < Infinity)) {
                const goal = target[i];
                if (!isNumber(0 * x + 0 * v + 0 * goal)) {
                    if (failed < 0) failed = i;
                    continue;
                }
                if (near(abs(x - goal), v, sizes[i]) || lands(x, to, y, v, fraction, omega2)) {
                    value[i] = goal;
                    velocity[i] = 0;
                    resting++;
                    continue;
                }
            }
            value[i] = x;
            velocity[i] = v;
        }
        if (failed >= 0) {
            // The others have been advanced.
            for (const name of ["target", "value", "velocity"])
                checkFinite(`${name}[${failed}]`, this[name][failed]);
            throw new RangeError(`value[${failed}] or velocity[${failed}] overflows`);
        }
        return count - resting;
    }
}
