// SPDX-License-Identifier: MIT
// One value that follows a target: spring_follow() without a load.
import { abs, epsilon, min, PI } from "./elementary.js";
import { checkFinite, inspected, isNumber, settings, sizeOf } from "./options.js";
import { lands } from "./propagator.js";
import { restTime, turningTime } from "./settling.js";
import { changed, listener } from "./watch.js";

export class Spring {
    #settings = {};
    #value;
    #velocity = 0;
    #target;
    #targetVelocity = 0;
    #settled = true;
    #resting = false; // during onRest()
    #size = 0; // of the motion since the target or the velocity was set
    #finished = null; // the promise
    #finish;
    [listener] = null;

    constructor(value = 0, options = {}) {
        checkFinite("value", value);
        this.#value = this.#target = value;
        this.set(options);
        if (new.target === Spring) Object.seal(this); // `spring.stiffness = 300` throws
    }

    #moves() {
        this.#settled = false;
        this.#size = sizeOf(
            this.#settings.p,
            this.#target - this.#value,
            this.#velocity - this.#targetVelocity,
        );
        changed(this);
    }

    get value() {
        return this.#value;
    }

    set value(value) {
        checkFinite("value", value);
        if (value === this.#value && this.#resting) return; // as for the target
        this.#value = value;
        this.#moves();
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

    get targetVelocity() {
        return this.#targetVelocity;
    }

    set targetVelocity(velocity) {
        checkFinite("targetVelocity", velocity);
        if (velocity === this.#targetVelocity) return;
        this.#targetVelocity = velocity + 0; // no -0
        this.#moves();
    }

    get settled() {
        return this.#settled;
    }

    get finished() {
        if (this.#settled) return Promise.resolve();
        return (this.#finished ??= new Promise((resolve) => (this.#finish = resolve)));
    }

    get clamp() {
        return this.#settings.clamp;
    }

    set clamp(clamp) {
        this.set({ clamp: clamp ?? null });
    }

    get onRest() {
        return this.#settings.onRest;
    }

    set onRest(onRest) {
        this.set({ onRest: onRest ?? null });
    }

    set(options) {
        this.#settings = settings(options, this.#settings.given);
        if (!this.#settled) changed(this);
        else if (this.#value !== this.#target && this.#settings.p.omega2) this.#moves(); // it had no stiffness
    }

    jump(value) {
        checkFinite("value", value);
        this.#target = value;
        this.#targetVelocity = 0;
        this.#place(value, false);
        changed(this);
    }

    release(velocity, target = this.#target) {
        checkFinite("target", target);
        this.velocity = velocity;
        this.target = target;
    }

    finish() {
        if (this.#settled) return;
        changed(this); // before onRest(), which may throw
        this.#place(
            this.#settings.p.restPlace(this.#value, this.#velocity - this.#targetVelocity, this.#target),
        );
    }

    settlingTime() {
        if (this.#settled) return 0;
        if (this.#targetVelocity) return Infinity;
        const { p, tolerances } = this.#settings;
        const y = this.#value - this.#target;
        const v = this.#velocity;
        const time = restTime(p, y, v, ...tolerances(this.#size));
        if (!this.clamp || p.omega2 === 0) return time;
        // It stops where it reaches the target. The distance is a velocity, of its integral.
        return min(time, turningTime(p, -(v + 2 * p.b * y) / p.omega2, y));
    }

    step(dt) {
        checkFinite("dt", dt);
        if (this.#settled || dt === 0) return this.#value;
        const target = this.#target;
        const speed = this.#targetVelocity;
        if (this.#value === target && this.#velocity === 0 && speed === 0) return this.#place(target);
        const { p, tolerances } = this.#settings;
        const attracts = p.omega2; // without stiffness, only the velocity of a target has an effect
        const moved = speed && speed * dt;
        const to = attracts ? target : moved;
        const y0 = this.#value - (attracts ? target - moved : 0);
        const u0 = this.#velocity - speed;
        const [y, u] = p.after(dt, y0, u0);
        const x = to + y;
        const v = speed ? speed + u : u;
        if (!isNumber(0 * x + 0 * v)) throw new RangeError("value or velocity overflows");
        let stops = lands(x, to, y, u, p.fraction, p.omega2);
        if (this.clamp && dt > 0 && attracts) {
            // Whether the value was on its target during the step. Zeros of an oscillation are pi apart.
            const on = speed && 4 * epsilon * (abs(target) + abs(moved));
            stops ||= abs(y0) <= on || (y0 > 0 ? y <= 0 : y >= 0) || p.angle >= PI;
        }
        const [restDelta, restSpeed] = tolerances(this.#size);
        const left = attracts && x - target;
        if (abs(left) <= restDelta && abs(u) <= restSpeed)
            stops ||= restTime(p, left, u, restDelta, restSpeed) === 0;
        if (stops) return this.#place(attracts ? target : x);
        this.#velocity = v;
        return (this.#value = x);
    }

    /** Places the value where it rests, or moves along with its target. */
    #place(value, tells = true) {
        this.#value = value;
        this.#velocity = this.#targetVelocity;
        if (this.#velocity) return value;
        const resting = this.#resting; // jump() and finish() in onRest()
        this.#settled = this.#resting = true;
        this.#finished = null;
        this.#finish?.();
        try {
            if (tells) this.onRest?.(this);
        } finally {
            this.#resting = resting;
        }
        return this.#value;
    }

    [inspected]() {
        const { value, velocity, target, targetVelocity, settled } = this;
        return { value, velocity, target, targetVelocity, settled };
    }
}
