// SPDX-License-Identifier: MIT
// One value that follows a target: spring_follow() with a load and a target velocity of 0.
import { check, checkFinite, isNumber, settings } from "./options.js";
import { lands } from "./propagator.js";

export class Spring {
    #settings;
    #value;
    #velocity = 0;
    #target;
    #settled = true;
    clamp;
    onRest;

    constructor(value = 0, options = { duration: 0.5 }) {
        checkFinite("value", value);
        this.#settings = settings(options, ["clamp", "onRest"]);
        this.clamp = options.clamp ?? false;
        const { onRest = null } = options;
        check(
            onRest === null || typeof onRest === "function",
            "onRest",
            "a function or null",
            onRest,
            TypeError,
        );
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

    jump(value) {
        checkFinite("value", value);
        this.#value = this.#target = value;
        this.#velocity = 0;
        this.#settled = true;
    }

    step(dt) {
        checkFinite("dt", dt);
        if (this.#settled || dt === 0) return this.#value;
        const { propagator: p, restDelta, restSpeed } = this.#settings;
        p.prepare(dt);
        const target = this.#target;
        const to = p.omega2 === 0 ? 0 : target; // without stiffness a target has no effect
        const y0 = this.#value - to;
        const v0 = this.#velocity;
        const y = p.half * (p.F * y0 + p.H * v0);
        const v = p.half * (p.G * v0 - p.wH * y0);
        const x = to + y;
        if (!isNumber(0 * x + 0 * v)) throw new RangeError("value or velocity overflows");
        // Whether the value was on its target during the step. Zeros of an oscillation are pi apart.
        const passed = y0 > 0 ? y <= 0 : y0 < 0 && y >= 0;
        const stops = this.clamp && dt > 0 && p.omega2 > 0 && (passed || p.angle >= Math.PI);
        const near = Math.abs(x - target) <= restDelta && Math.abs(v) <= restSpeed;
        this.#settled = stops || near || lands(x, to, y, v, p.share, p.omega2);
        this.#value = this.#settled ? target : x;
        this.#velocity = this.#settled ? 0 : v;
        if (this.#settled) this.onRest?.(this);
        return this.#value;
    }
}
