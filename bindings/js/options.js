// SPDX-License-Identifier: MIT
// Options of springs: checks, and the parameters that people know, as in src/spring/params.c.
import { abs, leastNormal, sqrt } from "./elementary.js";
import { Propagator } from "./propagator.js";
import { timeWithin } from "./settling.js";

/** Throws unless `holds`: `stiffness must be a finite number >= 0, got NaN`. */
export function check(holds, name, what, value, Kind = typeof value === "number" ? RangeError : TypeError) {
    if (holds) return;
    const shown = typeof value === "string" ? `"${value}"` : String(value);
    throw new Kind(`${name} must be ${what}, got ${shown}`);
}

export const isNumber = Number.isFinite;
export const checkFinite = (name, value) => check(isNumber(value), name, "a finite number", value);
const checkNotNegative = (name, value) =>
    check(isNumber(value) && value >= 0, name, "a finite number >= 0", value);
const checkPositive = (name, value) =>
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

export const checkFunction = (name, value) =>
    check(value === null || typeof value === "function", name, "a function or null", value, TypeError);

/** The name of the method whose result console.log() of Node shows. */
export const inspected = Symbol.for("nodejs.util.inspect.custom");

/** The size of a motion that begins at a distance from the target with a velocity. */
export const sizeOf = (p, distance, velocity) => abs(p.omega2 && distance) + abs(velocity) * p.reach;

/**
 * Of options: the propagator p, the explicit tolerances, and the tolerances of distance and speed in a motion of a size.
 * `others` are the names of further options.
 */
export function settings(options, others) {
    const { restDelta, restSpeed, ...rest } = options;
    checkNotNegative("restDelta", restDelta ?? 0);
    checkNotNegative("restSpeed", restSpeed ?? 0);
    const given = Object.keys(rest).filter((name) => rest[name] !== undefined && !others?.includes(name));
    let way = given.find((name) => Object.keys(ways).includes(name));
    if (!way && typeof options === "object" && given.every((name) => name === "bounce")) {
        way = "duration";
    }
    if (!way) throw new TypeError(`options must have one of ${Object.keys(ways).join(", ")}`);
    const [omegaOf, second] = ways[way];
    for (const name of given)
        if (name !== way && !ways[way].includes(name))
            throw new TypeError(`the option ${name} does not go with ${way}`);
    let { stiffness, damping, mass = 1 } = rest;
    if (omegaOf) {
        const { [way]: first = 0.5, [second]: given = second === "bounce" ? 0 : 1, tolerance = 1e-3 } = rest;
        checkPositive(way, first);
        check(tolerance > 0 && tolerance < 1, "tolerance", "a number > 0 and < 1", tolerance);
        let ratio = given;
        if (second === "bounce") {
            check(isNumber(given) && given > -1 && given <= 1, second, "a number > -1 and <= 1", given);
            ratio = given >= 0 ? 1 - given : 1 / (1 + given);
        } else (omegaOf.length > 1 ? checkPositive : checkNotNegative)(second, given);
        const omega = omegaOf(first, ratio, tolerance);
        stiffness = omega * omega;
        damping = 2 * ratio * omega;
        check(stiffness >= leastNormal, "stiffness", "no denormal number", stiffness);
    }
    checkNotNegative("stiffness", stiffness);
    checkNotNegative("damping", damping);
    checkPositive("mass", mass);
    checkFinite("stiffness / mass", stiffness / mass);
    checkFinite("damping / mass", damping / mass);
    const p = new Propagator(stiffness, damping, mass);
    const tolerances = (size) => [restDelta ?? size / 1e4, restSpeed ?? size / 1e3];
    return { p, restDelta, restSpeed, tolerances };
}
