// SPDX-License-Identifier: MIT
// One value that follows a target: spring_follow() with a load and a target velocity of 0.
import { check, checkFinite, isNumber, settings, sizeOf } from "./options.js";
import { lands } from "./propagator.js";

export class Spring {
    #settings;
    #value;
    #velocity = 0;
    #target;
    #settled = true;
    #resting = false; // during onRest()
    #size = 0; // of the motion since the target or the velocity was set
    clamp;
    onRest;

    constructor(value = 0, options = {}) {
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
        if (new.target === Spring) Object.seal(this); // `spring.stiffness = 300` throws
    }

    #moves() {
        this.#settled = false;
        this.#size = sizeOf(this.#settings.p, this.#target - this.#value, this.#velocity);
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
        if (velocity !== 0 || !this.#settled) this.#moves();
    }

    get target() {
        return this.#target;
    }

    set target(target) {
        checkFinite("target", target);
        // The same target again: in a motion its size stays, and onRest() is not called again for what it sets itself.
        if (target === this.#target && (!this.#settled || this.#resting)) return;
        this.#target = target;
        this.#moves();
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
        if (this.#value === this.#target && this.#velocity === 0) return this.#rest(this.#value);
        const { p, near } = this.#settings;
        p.prepare(dt);
        const target = this.#target;
        const attracts = p.omega2 > 0;
        const to = attracts ? target : 0; // without stiffness a target has no effect
        const y0 = this.#value - to;
        const v0 = this.#velocity;
        const y = p.half * (p.F * y0 + p.H * v0);
        const v = p.half * (p.G * v0 - p.wH * y0);
        const x = to + y;
        if (!isNumber(0 * x + 0 * v)) throw new RangeError("value or velocity overflows");
        // Whether the value was on its target during the step. Zeros of an oscillation are pi apart.
        const passed = y0 > 0 ? y <= 0 : y0 === 0 || y >= 0;
        const stops = this.clamp && dt > 0 && attracts && (passed || p.angle >= Math.PI);
        const left = Math.abs(attracts ? x - target : v * p.reach);
        if (stops || near(left, v, this.#size) || lands(x, to, y, v, p.fraction, p.omega2))
            return this.#rest(attracts ? target : x);
        this.#velocity = v;
        return (this.#value = x);
    }

    #rest(value) {
        this.#value = value;
        this.#velocity = 0;
        this.#settled = this.#resting = true;
        try {
            this.onRest?.(this);
        } finally {
            this.#resting = false;
        }
        return this.#value;
    }
}
