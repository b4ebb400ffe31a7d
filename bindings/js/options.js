// SPDX-License-Identifier: MIT
// Options of springs: checks, and the parameters that people know, as in src/spring/params.c.
import { leastNormal } from "./elementary.js";
import { Propagator } from "./propagator.js";

const show = (value) => (typeof value === "string" ? JSON.stringify(value) : String(value));

/** Throws unless `holds`: `stiffness must be a finite number >= 0, got NaN`. */
export function check(holds, name, what, value, Kind = typeof value === "number" ? RangeError : TypeError) {
    if (holds) return;
    throw new Kind(`${name} must be ${what}, got ${show(value)}`);
}

export const isNumber = (value) => typeof value === "number" && value - value === 0;
export const checkFinite = (name, value) => check(isNumber(value), name, "a finite number", value);
const checkNotNegative = (name, value) =>
    check(isNumber(value) && value >= 0, name, "a finite number >= 0", value);
const checkPositive = (name, value) =>
    check(isNumber(value) && value > 0, name, "a finite number > 0", value);

const twoPi = 6.283185307179586;

/** omega [1/s] -> [stiffness, damping, mass] */
function unitMass(omega, dampingRatio) {
    const stiffness = omega * omega;
    const normal = stiffness < Infinity && (omega === 0 || stiffness >= leastNormal);
    check(normal, "stiffness", "finite and not denormal", stiffness);
    return [stiffness, 2 * dampingRatio * omega, 1];
}

// Each way to describe a spring, by the option that it cannot do without.
const ways = {
    stiffness({ stiffness, damping, mass = 1 }) {
        return [stiffness, damping, mass];
    },
    response({ response, dampingFraction = 1 }) {
        checkPositive("response", response);
        checkNotNegative("dampingFraction", dampingFraction);
        return unitMass(twoPi / response, dampingFraction);
    },
    duration({ duration, bounce = 0 }) {
        checkPositive("duration", duration);
        check(isNumber(bounce) && bounce > -1 && bounce <= 1, "bounce", "a number > -1 and <= 1", bounce);
        return unitMass(twoPi / duration, bounce >= 0 ? 1 - bounce : 1 / (1 + bounce));
    },
    hertz({ hertz, dampingRatio = 1 }) {
        checkNotNegative("hertz", hertz);
        checkNotNegative("dampingRatio", dampingRatio);
        return unitMass(twoPi * hertz, dampingRatio);
    },
    halfLife({ halfLife, dampingRatio = 1 }) {
        checkPositive("halfLife", halfLife);
        checkPositive("dampingRatio", dampingRatio);
        const z = dampingRatio;
        const rate = z <= 1 ? z : 1 / (z + Math.sqrt(z - 1) * Math.sqrt(z + 1));
        return unitMass(0.6931471805599453 / halfLife / rate, z);
    },
};
const belongs = {
    stiffness: ["damping", "mass"],
    response: ["dampingFraction"],
    duration: ["bounce"],
    hertz: ["dampingRatio"],
    halfLife: ["dampingRatio"],
};

/** The propagator of options; `others` are the names of options that are not about stiffness and damping. */
export function propagatorOf(options, others) {
    check(typeof options === "object" && options !== null, "options", "an object", options);
    const given = Object.keys(options).filter(
        (name) => options[name] !== undefined && !others.includes(name),
    );
    const way = given.find((name) => Object.hasOwn(ways, name));
    if (way === undefined) throw new TypeError(`options must have one of ${Object.keys(ways).join(", ")}`);
    for (const name of given)
        if (name !== way && !belongs[way].includes(name))
            throw new TypeError(`the option ${name} does not go with ${way}`);
    const [stiffness, damping, mass] = ways[way](options);
    checkNotNegative("stiffness", stiffness);
    checkNotNegative("damping", damping);
    checkPositive("mass", mass);
    checkFinite("stiffness / mass", stiffness / mass);
    checkFinite("damping / mass", damping / mass);
    return new Propagator(stiffness, damping, mass);
}

/** A tolerance. */
export function tolerance(name, value) {
    check(typeof value === "number" && value >= 0, name, "a number >= 0", value);
    return value;
}
