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
const checkTolerance = (name, value) =>
    check(typeof value === "number" && value >= 0, name, "a number >= 0", value);
const checkBounce = (name, value) =>
    check(isNumber(value) && value > -1 && value <= 1, name, "a number > -1 and <= 1", value);

const twoPi = 6.283185307179586;

/** The decay rate of the slowest mode, in units of omega. */
const slowest = (ratio) => (ratio <= 1 ? ratio : 1 / (ratio + Math.sqrt(ratio - 1) * Math.sqrt(ratio + 1)));

// Ways to describe a spring, by the option that they require: its check, another option, its check and its default;
// [omega, damping ratio] of both.
const ways = {
    response: [checkPositive, "dampingFraction", checkNotNegative, 1, (time, ratio) => [twoPi / time, ratio]],
    duration: [
        checkPositive,
        "bounce",
        checkBounce,
        0,
        (time, bounce) => [twoPi / time, bounce >= 0 ? 1 - bounce : 1 / (1 + bounce)],
    ],
    hertz: [checkNotNegative, "dampingRatio", checkNotNegative, 1, (hertz, ratio) => [twoPi * hertz, ratio]],
    halfLife: [
        checkPositive,
        "dampingRatio",
        checkPositive,
        1,
        (time, ratio) => [0.6931471805599453 / time / slowest(ratio), ratio],
    ],
};

/** The propagator and the tolerances of options. `others` are the names of further options. */
export function settings(options, others) {
    check(typeof options === "object" && options !== null, "options", "an object", options);
    const { restDelta = 0.001, restSpeed = 0.01, ...rest } = options;
    checkTolerance("restDelta", restDelta);
    checkTolerance("restSpeed", restSpeed);
    const given = Object.keys(rest).filter((name) => rest[name] !== undefined && !others.includes(name));
    const names = ["stiffness", ...Object.keys(ways)];
    const way = given.find((name) => names.includes(name));
    if (!way) throw new TypeError(`options must have one of ${names.join(", ")}`);
    let { stiffness, damping, mass = 1 } = rest;
    const [checkIt, second, checkSecond, byDefault, convert] = ways[way] ?? [];
    for (const name of given)
        if (!(name === way || (convert ? name === second : name === "damping" || name === "mass")))
            throw new TypeError(`the option ${name} does not go with ${way}`);
    if (convert) {
        const a = rest[way];
        const b = rest[second] ?? byDefault;
        checkIt(way, a);
        checkSecond(second, b);
        const [omega, ratio] = convert(a, b);
        stiffness = omega * omega;
        damping = 2 * ratio * omega;
        const normal = stiffness < Infinity && (omega === 0 || stiffness >= leastNormal);
        check(normal, "stiffness", "finite and not denormal", stiffness);
    }
    checkNotNegative("stiffness", stiffness);
    checkNotNegative("damping", damping);
    checkPositive("mass", mass);
    checkFinite("stiffness / mass", stiffness / mass);
    checkFinite("damping / mass", damping / mass);
    return { propagator: new Propagator(stiffness, damping, mass), restDelta, restSpeed };
}
