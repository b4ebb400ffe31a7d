// SPDX-License-Identifier: MIT
// Options of springs: checks, and the parameters that people know, as in src/spring/params.c.
import { abs, leastNormal, sqrt } from "./elementary.js";
import { Propagator } from "./propagator.js";
import { timeWithin } from "./settling.js";

/** Throws unless `holds`: `stiffness must be a finite number >= 0, got NaN`. */
export function check(holds, name, what, value, Kind = typeof value === "number" ? RangeError : TypeError) {
    if (holds) return;
    let shown = String(value);
    if (typeof value === "string") shown = `"${value}"`;
    if (typeof value === "bigint") shown += "n";
    if (value?.join) shown = `[${value}]`;
    throw new Kind(`${name} must be ${what}, got ${shown}`);
}

export const isNumber = Number.isFinite;
export const checkFinite = (name, value) => check(isNumber(value), name, "a finite number", value);
export const checkNotNegative = (name, value) =>
    check(isNumber(value) && value >= 0, name, "a finite number >= 0", value);
export const checkPositive = (name, value) =>
    check(isNumber(value) && value > 0, name, "a finite number > 0", value);

/** The decay rate of the slowest mode, in units of omega. */
const slowest = (ratio) => (ratio <= 1 ? ratio : 1 / (ratio + sqrt(ratio - 1) * sqrt(ratio + 1)));

const twoPi = 2 * Math.PI;

// Ways to describe a spring: the option that each requires, omega from it and from the damping ratio, and further options.
const ways = {
    stiffness: [null, "damping", "mass"],
    response: [(time) => twoPi / time, "dampingFraction"],
    duration: [(time) => twoPi / time, "bounce"],
    hertz: [(frequency) => twoPi * frequency, "dampingRatio"],
    halfLife: [(time, ratio) => Math.LN2 / time / slowest(ratio), "dampingRatio"],
    settling: [
        // Settling times are inversely proportional to omega.
        (time, ratio, tolerance) => timeWithin(new Propagator(1, 2 * ratio, 1), 1, 0, tolerance) / time,
        "dampingRatio",
        "tolerance",
    ],
};

/** The name of the method whose result console.log() of Node shows. */
export const inspected = Symbol.for("nodejs.util.inspect.custom");

/** The size of a motion that begins at a distance from the target with a velocity. */
export const sizeOf = (p, distance, velocity) => abs(p.omega2 && distance) + abs(velocity) * p.reach;

const wayOf = (options) => Object.keys(ways).find((name) => name in options);

/** New options, and of those before them all but parameters in another way. An undefined option is not given. */
export function merged(options, before) {
    check(Object(options) === options, "options", "an object", options, TypeError);
    const given = {};
    for (const name in options) if (options[name] !== undefined) given[name] = options[name];
    const { restDelta, restSpeed, clamp, onRest } = before;
    const way = wayOf(given);
    return { ...(way && way !== wayOf(before) ? { restDelta, restSpeed, clamp, onRest } : before), ...given };
}

/**
 * Of new options, and options before them that stay: all of these as `given`, the propagator p, the tolerances of distance
 * and speed in a motion of a size, clamp and onRest.
 */
export function settings(options, before = {}, others = ["restDelta", "restSpeed", "clamp", "onRest"]) {
    const given = merged(options, before);
    const { restDelta = 0, restSpeed = 0, clamp = false, onRest = null } = given;
    checkNotNegative("restDelta", restDelta);
    checkNotNegative("restSpeed", restSpeed);
    const way = wayOf(given) ?? "duration";
    const [omegaOf, ...further] = ways[way];
    const [second] = further;
    const possible = [way, ...further, ...others];
    for (const name in options)
        if (options[name] !== undefined)
            check(possible.includes(name), "an option", `one of ${possible.join(", ")}`, name);
    check(typeof clamp === "boolean", "clamp", "a boolean", clamp, TypeError);
    check(onRest === null || typeof onRest === "function", "onRest", "a function or null", onRest, TypeError);
    let { stiffness, damping, mass = 1 } = given;
    if (omegaOf) {
        const { [way]: first = 0.5, [second]: shape = second === "bounce" ? 0 : 1, tolerance = 1e-3 } = given;
        checkPositive(way, first);
        check(tolerance > 0 && tolerance < 1, "tolerance", "a number > 0 and < 1", tolerance);
        let ratio = shape;
        if (second === "bounce") {
            check(isNumber(shape) && shape > -1 && shape <= 1, second, "a number > -1 and <= 1", shape);
            ratio = shape >= 0 ? 1 - shape : 1 / (1 + shape);
        } else (omegaOf.length > 1 ? checkPositive : checkNotNegative)(second, shape);
        const omega = omegaOf(first, ratio, tolerance);
        stiffness = omega * omega;
        damping = 2 * ratio * omega;
        check(stiffness >= leastNormal && isNumber(stiffness), way, "in range", first);
    }
    checkNotNegative("stiffness", stiffness);
    checkNotNegative("damping", damping);
    checkPositive("mass", mass);
    checkFinite("stiffness / mass", stiffness / mass);
    checkFinite("damping / mass", damping / mass);
    const p = new Propagator(stiffness, damping, mass);
    const tolerances = (size) => [given.restDelta ?? size / 1e4, given.restSpeed ?? size / 1e3];
    return { given, p, tolerances, clamp, onRest };
}
