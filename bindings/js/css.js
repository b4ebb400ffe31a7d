// SPDX-License-Identifier: MIT
// @ts-self-types="./css.d.ts"
// A spring as an easing of CSS: linear() through points of the exact solution.
import { abs, epsilon, max, min, sqrt } from "./elementary.js";
import { checkFinite, settings } from "./options.js";
import { restTime } from "./settling.js";

const cells = 2500; // into which the duration is divided; a point is at the end of a cell
const tolerance = 0.0018; // of the way; the rest of 0.002 is for the digits of a point, and for the curve within a cell

export function linear(options = {}, velocity = 0) {
    checkFinite("velocity", velocity);
    const { p } = settings(options, {}, []);
    const seconds = restTime(p, -1, velocity, 1e-3, 3e-3 * sqrt(p.omega2));
    if (!(seconds > 0 && seconds < 1e6)) throw new RangeError("the spring does not settle");
    const valueAt = (i) => 1 + p.after((i / cells) * seconds, -1, velocity)[0];
    // Within a cell an easing is straight. Only extreme motions bend there: fast oscillations, or a fast start, whose error is
    // largest early in the first cell.
    const bend = (i, part) => abs(valueAt(i + part) - (1 - part) * valueAt(i) - part * valueAt(i + 1));
    p.prepare(seconds / cells);
    let most = p.angle > 1 ? 1 : 0; // an oscillation by this angle per cell has errors above 0.1
    for (let i = 0; i < cells; i++) most = max(most, bend(i, 0.5));
    for (let part = 0.25; part > epsilon; part /= 2) most = max(most, bend(0, part));
    if (!(most <= 0.05)) throw new RangeError("the motion is too fast for an easing of its duration");
    const points = ["0"];
    // From each point on, the longest line that stays within the tolerance. The slopes of such lines are an interval.
    for (let from = 0, start = 0; from < cells;) {
        let least = -Infinity;
        let most = Infinity;
        let to = from;
        for (let i = from + 1; i <= cells; i++) {
            const [value, room] = i < cells ? [valueAt(i), tolerance] : [1, 0];
            const low = max(least, (value - room - start) / (i - from));
            const high = min(most, (value + room - start) / (i - from));
            if (low > high) break;
            [least, most, to] = [low, high, i];
        }
        start = +(start + ((least + most) / 2) * (to - from)).toFixed(4);
        from = to;
        points.push(from < cells ? `${start} ${+((100 * from) / cells).toFixed(2)}%` : "1");
    }
    return { duration: +(1000 * seconds).toPrecision(6), easing: `linear(${points.join(", ")})` };
}
