// SPDX-License-Identifier: MIT
// The velocity of a pointer, by least squares.
import { checkFinite } from "./options.js";

const recent = 100; // [ms]

export class VelocityTracker {
    #samples = []; // [ms, position] of the last 100 ms

    add(position, time) {
        checkFinite("position", position);
        checkFinite("time", time);
        this.#samples = this.#samples.filter(([before]) => before > time - recent && before <= time);
        this.#samples.push([time, position]);
    }

    velocity(time) {
        const last = this.#samples.at(-1);
        if (!last) return 0;
        checkFinite("time", (time ??= last[0]));
        const samples = this.#samples.filter(([before]) => before > time - recent);
        if (time > last[0]) samples.push([time, last[1]]); // it has not moved since
        const mean = (of) => samples.reduce((sum, sample) => sum + of(sample), 0) / samples.length;
        const meanTime = mean(([t]) => t);
        const slope =
            mean(([t, x]) => (t - meanTime) * (x - last[1])) / mean(([t]) => (t - meanTime) * (t - meanTime));
        return samples.length > 1 && slope - slope === 0 ? 1000 * slope : 0;
    }
}
