// SPDX-License-Identifier: MIT
// Settling times: src/spring/settling.c with the same operations, so that the decision whether a value rests is the same on
// every engine.
import { abs, max, PI } from "./elementary.js";

/** The first time in (before .. after] at which `holds`, which does not hold at `before`. */
function firstTime(holds, before, after) {
    let middle;
    while ((middle = before + (after - before) / 2) > before && middle < after)
        if (holds(middle)) after = middle;
        else before = middle;
    return after;
}

/** The first time after `from` at which `holds`, which it does from then on, as at infinity. Tests multiples of `step` first. */
function lastTime(holds, from, step) {
    let before = 0;
    let after = 1;
    for (; !holds(from + after * step); after *= 2) before = after;
    return firstTime(holds, from + before * step, from + after * step);
}

/** The time between turning points, or without oscillation, of decay. */
const stride = (p) => (p.overdamped || p.split === 0 ? 1 / p.b : PI / p.split);

/** When the velocity of a spring at a distance y0 from rest changes its sign, or becomes 0. */
export function turningTime(p, y0, v0) {
    if (v0 === 0) return 0;
    const turned = (t) => !(p.after(t, y0, v0)[1] * v0 > 0);
    return lastTime(turned, 0, stride(p));
}

/** The time after which a spring that starts at a distance y0 from rest with the velocity v0 stays within `tolerance`. */
export function timeWithin(p, y0, v0, tolerance) {
    const free = p.omega2 === 0;
    if (tolerance === 0 || (free && p.b === 0)) return v0 || (y0 && !free) ? Infinity : 0;
    const within = (t) => {
        const [y, v] = p.after(t, y0, v0);
        return !(abs(free ? v * p.reach : y) > tolerance);
    };
    // Between turning points, which have equal distances in time, the spring comes closer or goes away.
    const first = turningTime(p, y0, v0);
    if (within(first)) return within(0) ? 0 : firstTime(within, 0, first);
    return p.b === 0 ? Infinity : lastTime(within, first, stride(p));
}

/** The time after which distance and velocity both stay within their tolerances. */
export const restTime = (p, y, v, restDelta, restSpeed) =>
    max(timeWithin(p, y, v, restDelta), timeWithin(p, v, -p.omega2 * y - 2 * p.b * v, restSpeed));
