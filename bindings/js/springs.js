// SPDX-License-Identifier: MIT
// Many values with the same parameters, each with its own target: spring_batch_follow() without a load.
import { check, checkFinite, isNumber, propagatorOf, tolerance } from "./options.js";
import { lands } from "./propagator.js";

export class Springs {
    #propagator;
    #restDelta;
    #restSpeed;

    constructor(count, options = { duration: 0.5 }) {
        check(Number.isSafeInteger(count) && count >= 0, "count", "an integer >= 0", count);
        this.#propagator = propagatorOf(options, ["restDelta", "restSpeed"]);
        const { restDelta = 0.001, restSpeed = 0.01 } = options;
        this.#restDelta = tolerance("restDelta", restDelta);
        this.#restSpeed = tolerance("restSpeed", restSpeed);
        for (const name of ["target", "value", "velocity"])
            Object.defineProperty(this, name, { value: new Float64Array(count), enumerable: true });
    }

    step(dt) {
        checkFinite("dt", dt);
        const { target, value, velocity } = this;
        const count = value.length;
        const restDelta = this.#restDelta;
        const restSpeed = this.#restSpeed;
        const p = this.#propagator;
        if (dt !== 0) p.prepare(dt);
        const { half, F, G, H, wH, share, omega2 } = p;
        let moving = 0;
        let failed = -1;
        for (let i = 0; i < count; i++) {
            const goal = target[i];
            const to = omega2 === 0 ? goal - goal : goal;
            const v0 = velocity[i];
            const y0 = value[i] - to;
            const y = dt === 0 ? y0 : half * (F * y0 + H * v0);
            const v = dt === 0 ? v0 : half * (G * v0 - wH * y0);
            const x = dt === 0 ? value[i] : to + y;
            if (x - x !== 0 || v - v !== 0) {
                if (failed < 0) failed = i;
                moving++;
                continue;
            }
            const settled = Math.abs(x - goal) <= restDelta && Math.abs(v) <= restSpeed;
            if (dt !== 0) {
                const rests = settled || lands(x, to, y, v, share, omega2);
                value[i] = rests ? goal : x;
                velocity[i] = rests ? 0 : v;
                moving += rests ? 0 : 1;
            } else moving += settled ? 0 : 1;
        }
        if (failed >= 0) this.#fail(failed);
        return moving;
    }

    /** Says why spring i keeps its state. The others have been advanced. */
    #fail(i) {
        for (const name of ["target", "value", "velocity"])
            if (!isNumber(this[name][i])) checkFinite(`${name}[${i}]`, this[name][i]);
        throw new RangeError(`value[${i}] and velocity[${i}] must stay finite; they are unchanged`);
    }
}
