// SPDX-License-Identifier: MIT
// Options of springs: checks, and the parameters that people know, as in src/spring/params.c.
import { leastNormal } from "./elementary.js";
import { Propagator } from "./propagator.js";

/** Throws unless `holds`: `stiffness must be a finite number >= 0, got NaN`. */
export function check(holds, name, what, value, Kind = typeof value === "number" ? RangeError : TypeError) {
    if (holds) return;
    const shown = typeof value === "string" ? JSON.stringify(value) : String(value);
    throw new Kind(`${name} must be ${what}, got ${shown}`);
}

export const isNumber = (value) => typeof value === "number" && value - value === 0;
export const checkFinite = (name, value) => check(isNumber(value), name, "a finite number", value);
const checkNotNegative = (name, value) =>
    check(isNumber(value) && value >= 0, name, "a finite number >= 0", value);
const checkPositive = (name, value) =>
    check(isNumber(value) && value > 0, name, "a finite number > 0", value);

const twoPi = 2 * Math.PI;

// Ways to describe a spring: the option that each requires, and the one that goes with it.
const ways = {
    stiffness: "damping",
    response: "dampingFraction",
    duration: "bounce",
    hertz: "dampingRatio",
    halfLife: "dampingRatio",
};

/** The decay rate of the slowest mode, in units of omega. */
const slowest = (ratio) => (ratio <= 1 ? ratio : 1 / (ratio + Math.sqrt(ratio - 1) * Math.sqrt(ratio + 1)));

/** The undamped angular frequency and the damping ratio of a way other than stiffness and damping. */
function omegaAndRatio(way, first, name, second) {
    checkPositive(way, first);
    if (way === "hertz") {
        checkNotNegative(name, second);
        return [twoPi * first, second];
    }
    if (way === "halfLife") {
        checkPositive(name, second);
        return [Math.LN2 / first / slowest(second), second];
    }
    if (way === "response") checkNotNegative(name, second);
    else {
        check(isNumber(second) && second > -1 && second <= 1, name, "a number > -1 and <= 1", second);
        second = second >= 0 ? 1 - second : 1 / (1 + second);
    }
    return [twoPi / first, second];
}

/** The size of a motion that begins at a distance from the target with a velocity. */
export const sizeOf = (p, distance, velocity) =>
    Math.abs(p.omega2 && distance) + Math.abs(velocity) * p.reach;

/**
 * Of options: the propagator p, the explicit tolerances, and near(left, speed, size), which is whether a value is at rest at a
 * distance and a speed, in a motion of a size. `others` are the names of further options.
 */
export function settings(options, others) {
    const { restDelta, restSpeed, ...rest } = options;
    checkNotNegative("restDelta", restDelta ?? 0);
    checkNotNegative("restSpeed", restSpeed ?? 0);
    const given = Object.keys(rest).filter((name) => rest[name] !== undefined && !others.includes(name));
    let way = given.find((name) => Object.hasOwn(ways, name));
    if (!way && typeof options === "object" && given.every((name) => name === "bounce")) {
        way = "duration";
        rest.duration = 0.5;
    }
    if (!way) throw new TypeError(`options must have one of ${Object.keys(ways).join(", ")}`);
    const second = ways[way];
    for (const name of given)
        if (name !== way && name !== second && (name !== "mass" || way !== "stiffness"))
            throw new TypeError(`the option ${name} does not go with ${way}`);
    let { stiffness, damping, mass = 1 } = rest;
    if (way !== "stiffness") {
        const byDefault = second === "bounce" ? 0 : 1;
        const [omega, ratio] = omegaAndRatio(way, rest[way], second, rest[second] ?? byDefault);
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
    const near = (left, speed, size) =>
        left <= (restDelta ?? size / 1e4) && Math.abs(speed) <= (restSpeed ?? size / 1e3);
    return { p, restDelta, restSpeed, near };
}
