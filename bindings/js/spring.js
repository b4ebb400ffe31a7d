// SPDX-License-Identifier: MIT
// One value that follows a target: spring_follow() with a load and a target velocity of 0.
import { check, checkFinite, isNumber, propagatorOf, tolerance } from "./options.js";
import { lands } from "./propagator.js";

const otherOptions = ["restDelta", "restSpeed", "clamp", "onRest"];

export class Spring {
    #propagator;
    #restDelta;
    #restSpeed;
    #onRest = null;
    #value;
    #velocity = 0;
    #target;
    #settled = true;
    clamp;

    constructor(value = 0, options = { duration: 0.5 }) {
        checkFinite("value", value);
        this.#propagator = propagatorOf(options, otherOptions);
        const { restDelta = 0.001, restSpeed = 0.01, clamp = false, onRest = null } = options;
        this.#restDelta = tolerance("restDelta", restDelta);
        this.#restSpeed = tolerance("restSpeed", restSpeed);
        this.clamp = clamp;
        this.onRest = onRest;
        this.#value = this.#target = value;
    }

    get value() {
        return this.#value;
    }

    get velocity() {
        return this.#velocity;
    }

    set velocity(velocity) {
        checkFinite("velocity", velocity);
        this.#velocity = velocity;
        this.#settled &&= velocity === 0;
    }

    get target() {
        return this.#target;
    }

    set target(target) {
        checkFinite("target", target);
        this.#settled &&= target === this.#target;
        this.#target = target;
    }

    get settled() {
        return this.#settled;
    }

    get onRest() {
        return this.#onRest;
    }

    set onRest(onRest) {
        check(
            onRest === null || typeof onRest === "function",
            "onRest",
            "a function or null",
            onRest,
            TypeError,
        );
        this.#onRest = onRest;
    }

    jump(value) {
        checkFinite("value", value);
        this.#value = this.#target = value;
        this.#velocity = 0;
        this.#settled = true;
    }

    step(dt) {
        checkFinite("dt", dt);
        if (this.#settled || dt === 0) return this.#value;
        const p = this.#propagator;
        p.prepare(dt);
        const target = this.#target;
        const to = p.omega2 === 0 ? 0 : target; // without stiffness a target has no effect
        const y0 = this.#value - to;
        const v0 = this.#velocity;
        const y = p.half * (p.F * y0 + p.H * v0);
        const v = p.half * (p.G * v0 - p.wH * y0);
        const x = to + y;
        if (!isNumber(x) || !isNumber(v))
            throw new RangeError(
                `value and velocity must stay finite, got ${x} and ${v}; they are unchanged`,
            );
        this.#value = x;
        this.#velocity = v;
        if (
            (Math.abs(x - target) <= this.#restDelta && Math.abs(v) <= this.#restSpeed) ||
            lands(x, to, y, v, p.share, p.omega2) ||
            (this.clamp && dt > 0 && this.#passed(y0, y))
        )
            this.#rest();
        return this.#value;
    }

    /** Whether the value was on its target during a step, from distance y0 to y. Zeros of an oscillation are pi apart. */
    #passed(y0, y) {
        const p = this.#propagator;
        return p.omega2 > 0 && ((y0 > 0 && y <= 0) || (y0 < 0 && y >= 0) || p.angle >= Math.PI);
    }

    #rest() {
        this.#value = this.#target;
        this.#velocity = 0;
        this.#settled = true;
        this.#onRest?.(this);
    }
}
