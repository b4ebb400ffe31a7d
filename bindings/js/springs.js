// SPDX-License-Identifier: MIT
// Many values, each with its own target: spring_batch_follow_moving() without a load.
import { check, checkFinite, inspected, isNumber, merged, settings, sizeOf } from "./options.js";
import { abs, epsilon, leastNormal, PI } from "./elementary.js";
import { lands } from "./propagator.js";
import { changed, listener, moves } from "./watch.js";

/** Settings of each value; if no option is an array, of all values. Replaces arrays in the options by copies. */
function settingsOf(options, count) {
    const lists = Object.entries(options).filter(
        ([name, value]) =>
            name !== "clamp" && name !== "onRest" && typeof value === "object" && value?.length >= 0,
    );
    for (const list of lists) {
        const [name, { length }] = list;
        check(length === count, `${name}.length`, `${count}`, length);
        list[1] = options[name] = Array.from(list[1], (each, i) => {
            check(typeof each === "number", `${name}[${i}]`, "a number", each, TypeError);
            return each;
        });
    }
    if (lists.length === 0) return settings(options);
    return Array.from({ length: count }, (_, i) => {
        try {
            return settings({
                ...options,
                ...Object.fromEntries(lists.map(([name, list]) => [name, list[i]])),
            });
        } catch (error) {
            error.message = `value ${i}: ${error.message}`;
            throw error;
        }
    });
}

/** Whether a value was on its target during a step: its distance was y0, and is y. */
const stopsAt = (y0, y, goal, moved) =>
    (y0 > 0 ? y <= 0 : y >= 0) || abs(y0) <= abs(moved && 4 * epsilon * (abs(goal) + abs(moved)));

export class Springs {
    #settings; // of all values, or an array
    #given = {}; // options
    #relative; // whether a tolerance depends on the size of a motion
    #target;
    #targetVelocity;
    #value;
    #velocity;
    #last; // values, velocities, targets and their velocities after the last step
    #sizes; // of the motions
    #failed = -1; // first value that has kept its state in a step
    #steered = false; // whether targets may have velocities
    #rested = []; // values that came to rest in a step
    [listener] = null;

    constructor(count, options = {}) {
        check(Number.isSafeInteger(count) && count >= 0, "count", "an integer >= 0", count);
        const zeros = () => new Float64Array(count);
        [this.#value, this.#velocity, this.#target, this.#targetVelocity] = [
            zeros(),
            zeros(),
            zeros(),
            zeros(),
        ];
        this.#last = this.#state.map(zeros);
        this.#sizes = zeros();
        this.set(options);
        if (new.target === Springs) Object.seal(this);
    }

    get #state() {
        return [this.#value, this.#velocity, this.#target, this.#targetVelocity];
    }

    // A caller that reads an array may write to it.

    get value() {
        changed(this);
        return this.#value;
    }

    get velocity() {
        changed(this);
        return this.#velocity;
    }

    get target() {
        changed(this);
        return this.#target;
    }

    get targetVelocity() {
        this.#steered = true;
        changed(this);
        return this.#targetVelocity;
    }

    settled(i) {
        const count = this.#value.length;
        check(Number.isInteger(i) && i >= 0 && i < count, "i", `the index of one of ${count} values`, i);
        return this.#rests(i);
    }

    #propagator(i) {
        return (Array.isArray(this.#settings) ? this.#settings[i] : this.#settings).p;
    }

    /** Without stiffness, a value rests anywhere. */
    #rests(i) {
        if (this.#velocity[i] !== 0 || this.#targetVelocity[i] !== 0) return false;
        const [value, target] = [this.#value[i], this.#target[i]];
        if (!isNumber(value) || !isNumber(target)) return false;
        return value === target || !this.#propagator(i).omega2;
    }

    get clamp() {
        return this.#given.clamp ?? false;
    }

    set clamp(clamp) {
        this.set({ clamp: clamp ?? null });
    }

    get onRest() {
        return this.#given.onRest ?? null;
    }

    set onRest(onRest) {
        this.set({ onRest: onRest ?? null });
    }

    set(options) {
        const given = merged(options, this.#given);
        for (let i = 0; this.#settings && i < this.#value.length; i++)
            if (this.#rests(i)) this.#last[0][i] = NaN; // if this gives it stiffness, a motion begins
        this.#settings = settingsOf(given, this.#value.length);
        this.#given = given;
        this.#relative = given.restDelta == null || given.restSpeed == null;
        changed(this);
    }

    finish() {
        this.#failed = -1;
        for (let i = 0; i < this.#value.length; i++) {
            if (this.#rests(i)) continue;
            const [x, v, goal, speed] = [
                this.#value[i],
                this.#velocity[i],
                this.#target[i],
                this.#targetVelocity[i],
            ];
            const place = this.#propagator(i).restPlace(x, v - speed, goal);
            if (!isNumber(place + 0 * goal + 0 * speed)) {
                if (this.#failed < 0) this.#failed = i;
                continue;
            }
            this.#value[i] = place;
            this.#velocity[i] = speed;
            if (this.#velocity[i] === 0) this.#rested.push(i);
        }
        changed(this);
        this.#tell();
        this.#complain();
    }

    step(dt) {
        checkFinite("dt", dt);
        const each = this.#settings;
        const count = this.#value.length;
        let moving = 0;
        this.#failed = -1;
        if (!Array.isArray(each)) moving = this.#advance(each, 0, count, dt);
        else for (let i = 0; i < count; i++) moving += this.#advance(each[i], i, i + 1, dt);
        if (this.#relative) this.#state.forEach((now, k) => this.#last[k].set(now));
        this.#tell();
        this.#complain();
        return moving;
    }

    [moves]() {
        const [value, velocity, target, speed] = this.#state;
        return value.some(
            (x, i) => !this.#rests(i) && isNumber(0 * x + 0 * velocity[i] + 0 * target[i] + 0 * speed[i]),
        );
    }

    /** Throws what is wrong with the first value that has kept its state. The others have been advanced. */
    #complain() {
        const failed = this.#failed;
        if (failed < 0) return;
        for (const name of ["target", "targetVelocity", "value", "velocity"])
            checkFinite(`${name}[${failed}]`, this[name][failed]);
        throw new RangeError(`value[${failed}] or velocity[${failed}] overflows`);
    }

    /** Calls onRest() for each value that rests, and then throws the first error of these calls. */
    #tell() {
        const rested = this.#rested;
        this.#rested = [];
        let failure;
        for (const i of rested)
            try {
                this.onRest?.(i, this);
            } catch (error) {
                failure ??= { error };
            }
        if (failure) throw failure.error;
    }

    /** Computes the sizes of motions whose state was written since the last step. Returns the largest size of all. */
    #measure(p, from, end) {
        const [value, velocity, target, speed] = this.#state;
        const [lastValue, lastVelocity, lastTarget, lastSpeed] = this.#last;
        const sizes = this.#sizes;
        let largest = 0;
        for (let i = from; i < end; i++) {
            if (
                target[i] !== lastTarget[i] ||
                value[i] !== lastValue[i] ||
                velocity[i] !== lastVelocity[i] ||
                speed[i] !== lastSpeed[i]
            )
                sizes[i] = sizeOf(p, target[i] - value[i], velocity[i] - speed[i]);
            if (sizes[i] > largest) largest = sizes[i];
        }
        return largest;
    }

    /** Advances values with equal settings, and returns how many of them move. */
    #advance({ p, tolerances }, from, end, dt) {
        const [value, velocity, target, targetVelocity] = this.#state;
        const sizes = this.#sizes;
        const [mostDelta] = tolerances(this.#relative ? this.#measure(p, from, end) : 0);
        const attracts = p.omega2 > 0; // without stiffness, only the velocity of a target has an effect
        const near = (left, speed, size) => {
            const [byDelta, bySpeed] = tolerances(size);
            return (attracts ? left : abs(speed) * p.reach) <= byDelta && abs(speed) <= bySpeed;
        };
        let resting = 0;
        if (dt === 0) {
            for (let i = from; i < end; i++) {
                const speed = targetVelocity[i];
                resting += speed === 0 && near(abs(value[i] - target[i]), velocity[i], sizes[i]);
            }
            return end - from - resting;
        }
        p.prepare(dt);
        const { half, F, G, H, fraction, omega2, angle } = p;
        const wH = omega2 * H;
        const clamp = this.clamp && dt > 0 && attracts;
        const steered = this.#steered;
        const turns = angle >= PI;
        const tells = this.onRest !== null;
        // A spring with |y| > slope |target| + least neither lands nor settles: see follow_limit in src/kernels.
        const slope = (4 * epsilon) / (fraction || 1);
        const least = attracts ? (slope / epsilon) * leastNormal + 2 * mostDelta : Infinity;
        for (let i = from; i < end; i++) {
            const goal = target[i];
            const speed = steered ? targetVelocity[i] : 0;
            const moved = speed !== 0 ? speed * dt : 0;
            const to = attracts ? goal : moved;
            const u0 = velocity[i] - speed;
            const y0 = value[i] - (attracts ? goal - moved : 0);
            const y = half * (F * y0 + H * u0);
            const u = half * (G * u0 - wH * y0);
            const x = to + y;
            const v = speed !== 0 ? speed + u : u;
            const passed = clamp && (turns || stopsAt(y0, y, goal, moved));
            if (passed || !(abs(y) > slope * abs(to) + least && abs(x + v) < Infinity)) {
                if (!isNumber(0 * x + 0 * v + 0 * goal)) {
                    if (this.#failed < 0) this.#failed = i;
                    continue;
                }
                if (passed || near(abs(x - goal), u, sizes[i]) || lands(x, to, y, u, fraction, omega2)) {
                    if (tells && speed === 0 && !this.#rests(i)) this.#rested.push(i);
                    value[i] = attracts ? goal : x;
                    velocity[i] = speed;
                    resting += speed === 0;
                    continue;
                }
            }
            value[i] = x;
            velocity[i] = v;
        }
        return end - from - resting;
    }

    [inspected]() {
        const { value, velocity, target, targetVelocity } = this;
        return { value, velocity, target, targetVelocity };
    }
}
